#pragma once
// MC_ReadDigitalInput, MC_ReadDigitalOutput, MC_WriteDigitalOutput: PLCopen Part 1 v2.0, 3.21 to 3.23. Real-time safe.
// The reference names a point of the machine, whose bits the numbers select (a BOOL point has bit 0), or an axis, whose drive's inputs
// and outputs they select (bits of 60FDh and 60FEh, 0 to 31).

#include <cstdint>
#include <span>
#include <string_view>

#include "fb_library/motion/enable_core.hpp"
#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

namespace detail {

inline constexpr std::int32_t point_bits = 64, drive_bits = 32;

/// What one digital point says; error while there is none of that number.
struct Level {
    bool value = false;
    ErrorId error = ErrorId::none;
};

[[nodiscard]] inline Level bit_of(std::uint64_t word, std::int32_t number, std::int32_t bits) noexcept {
    if (number < 0 || number >= bits) return {false, ErrorId::invalid_output};
    return {((word >> static_cast<unsigned>(number)) & 1u) != 0, ErrorId::none};
}

/// A point of the machine wins over the axis' drive. `word` is the drive's, from its view.
template <class Points>
[[nodiscard]] Level level_of(std::uint16_t point, Points points, const axes::AxisView* view, std::uint32_t axes::AxisView::*word,
                             std::int32_t number) noexcept {
    constexpr std::uint16_t none = 0xFFFF;
    if (point != none) {
        if (point >= points.size()) return {false, ErrorId::invalid_output};
        return bit_of(static_cast<std::uint64_t>(points[point]), number, point_bits);
    }
    if (view == nullptr) return {false, ErrorId::invalid_axis};
    if (!view->online) return {false, ErrorId::drive_not_ready};
    return bit_of(view->*word, number, drive_bits);
}

}  // namespace detail

/// The level of each scan: a pulse between two scans is not seen.
struct MC_ReadDigitalInput : EnableBlock<MC_ReadDigitalInput> {
    InputRef Input{};
    bool Enable = false;
    std::int32_t InputNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool Value = false;

    static constexpr std::string_view summary = "Gives the level of a digital input of the machine or of a drive.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(in_out<&Self::Input>("", "a point of the machine, or an axis for its drive's inputs"), shared<&Self::Enable>(),
                         in<&Self::InputNumber>("", "which bit of them"), reading<Self>(), out<&Self::Value>("", "FALSE while not Valid"));
    }

    /// Not for programs: what the core calls.
    Reading read(const MotionContext& ctx) noexcept {
        const auto level = detail::level_of(Input.point, ctx.inputs, ctx.view(Input.axis), &axes::AxisView::digital_inputs, InputNumber);
        Value = level.value;
        return Reading::unless(level.error);
    }

private:
    friend EnableBlock<MC_ReadDigitalInput>;
    void clear() noexcept { Value = false; }
};

/// What was written last, by whomever.
struct MC_ReadDigitalOutput : EnableBlock<MC_ReadDigitalOutput> {
    OutputRef Output{};
    bool Enable = false;
    std::int32_t OutputNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool Value = false;

    static constexpr std::string_view summary = "Gives the level of a digital output of the machine or of a drive.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(in_out<&Self::Output>("", "a point of the machine, or an axis for its drive's outputs"), shared<&Self::Enable>(),
                         in<&Self::OutputNumber>("", "which bit of them"), reading<Self>(), out<&Self::Value>("", "FALSE while not Valid"));
    }

    /// Not for programs: what the core calls.
    Reading read(const MotionContext& ctx) noexcept {
        const auto level =
            detail::level_of(Output.point, ctx.outputs, ctx.view(Output.axis), &axes::AxisView::digital_outputs, OutputNumber);
        Value = level.value;
        return Reading::unless(level.error);
    }

private:
    friend EnableBlock<MC_ReadDigitalOutput>;
    void clear() noexcept { Value = false; }
};

/// mcQueued is for the outputs of an axis' drive: a point of the machine has no motion to wait for and is refused with not_supported.
struct MC_WriteDigitalOutput : SettingBlock<MC_WriteDigitalOutput> {
    OutputRef Output{};
    bool Execute = false;
    std::int32_t OutputNumber = 0;
    bool Value = false;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    [[nodiscard]] axes::WriteOutput setting() const noexcept { return {OutputNumber, Value}; }

    static constexpr std::string_view summary = "Writes a digital output of the machine or of a drive once.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(in_out<&Self::Output>("", "a point of the machine, or an axis for its drive's outputs"), shared<&Self::Execute>(),
                         in<&Self::OutputNumber>("", "which bit of them"), in<&Self::Value>("", "the level"),
                         shared<&Self::ExecutionMode>(), out<&Self::Done>("", "written"), outcome<Self>());
    }

private:
    friend ExecuteBlock<MC_WriteDigitalOutput>;
    void start(const MotionContext& ctx) noexcept {
        constexpr std::uint16_t none = 0xFFFF;
        if (Output.point == none) return SettingBlock::start(ctx);
        if (ExecutionMode != mcImmediately) return core_.refuse(ErrorId::not_supported);
        if (Output.point >= ctx.outputs.size() || OutputNumber < 0 || OutputNumber >= detail::point_bits ||
            (ctx.output_mask(Output.point) >> static_cast<unsigned>(OutputNumber)) == 0)
            return core_.refuse(ErrorId::invalid_output);
        auto& word = ctx.outputs[Output.point];
        const auto bit = std::uint64_t{1} << static_cast<unsigned>(OutputNumber);
        const auto before = static_cast<std::uint64_t>(word);
        word = static_cast<std::int64_t>(Value ? before | bit : before & ~bit);
        start_at_once(ctx);
    }
};

}  // namespace taktwerk::fb

#pragma once
// MC_ReadParameter, MC_ReadBoolParameter, MC_WriteParameter, MC_WriteBoolParameter: PLCopen Part 1 v2.0, 3.19, 3.20. Real-time safe.
// The numbers: axes/axis/parameters.hpp, docs/reference/parameters.md. A BOOL parameter reads as 0 or 1 through the REAL block and is
// written by it with 0 or 1; the BOOL blocks take BOOL parameters only.

#include <cstdint>
#include <string_view>

#include "axes/axis/parameters.hpp"
#include "fb_library/motion/enable_core.hpp"
#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_ReadParameter : EnableBlock<MC_ReadParameter> {
    AxisRef Axis{};
    bool Enable = false;
    std::int32_t ParameterNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double Value = 0;

    static constexpr std::string_view summary = "Gives the value of a parameter of the axis in each call.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(), in<&Self::ParameterNumber>("", "which one; another one at any time"),
                         reading<Self>(), out<&Self::Value>("as listed", "its value; BOOL as 0 or 1; 0 while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadParameter>;
    Reading read(const axes::AxisView& view) noexcept {
        const auto* entry = axes::find_parameter(ParameterNumber);
        if (!entry) return Reading::unless(ErrorId::unknown_parameter);
        Value = entry->read(view);
        return Reading::valid();
    }
    void clear() noexcept { Value = 0; }
};

struct MC_ReadBoolParameter : EnableBlock<MC_ReadBoolParameter> {
    AxisRef Axis{};
    bool Enable = false;
    std::int32_t ParameterNumber = 0;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool Value = false;

    static constexpr std::string_view summary = "Gives the value of a BOOL parameter of the axis in each call.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Enable>(),
                         in<&Self::ParameterNumber>("", "which one; invalid_parameter when it is no BOOL"), reading<Self>(),
                         out<&Self::Value>("", "its value; FALSE while not Valid"));
    }

private:
    friend EnableBlock<MC_ReadBoolParameter>;
    Reading read(const axes::AxisView& view) noexcept {
        const auto* entry = axes::find_parameter(ParameterNumber);
        if (!entry) return Reading::unless(ErrorId::unknown_parameter);
        if (entry->type != axes::ParameterType::boolean) return Reading::unless(ErrorId::invalid_parameter);
        Value = entry->read(view) != 0;
        return Reading::valid();
    }
    void clear() noexcept { Value = false; }
};

struct MC_WriteParameter : SettingBlock<MC_WriteParameter> {
    AxisRef Axis{};
    bool Execute = false;
    std::int32_t ParameterNumber = 0;
    double Value = 0;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    [[nodiscard]] axes::WriteParameter setting() const noexcept { return {ParameterNumber, Value}; }

    static constexpr std::string_view summary = "Writes a parameter of the axis once. It holds until the runtime starts again.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::ParameterNumber>("", "which one"),
                         in<&Self::Value>("as listed", "its new value; 0 or 1 for a BOOL"), shared<&Self::ExecutionMode>(),
                         out<&Self::Done>("", "written"), outcome<Self>());
    }
};

struct MC_WriteBoolParameter : SettingBlock<MC_WriteBoolParameter> {
    AxisRef Axis{};
    bool Execute = false;
    std::int32_t ParameterNumber = 0;
    bool Value = false;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    [[nodiscard]] axes::WriteParameter setting() const noexcept { return {ParameterNumber, Value ? 1.0 : 0.0}; }

    static constexpr std::string_view summary = "Writes a BOOL parameter of the axis once. It holds until the runtime starts again.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            shared<&Self::Axis, &Self::Execute>(), in<&Self::ParameterNumber>("", "which one; invalid_parameter when it is no BOOL"),
            in<&Self::Value>("", "its new value"), shared<&Self::ExecutionMode>(), out<&Self::Done>("", "written"), outcome<Self>());
    }

private:
    friend ExecuteBlock<MC_WriteBoolParameter>;
    void start(const MotionContext& ctx) noexcept {
        const auto* entry = axes::find_parameter(ParameterNumber);
        if (ctx.view(Axis) != nullptr && entry != nullptr && entry->type != axes::ParameterType::boolean)
            return core_.refuse(ErrorId::invalid_parameter);
        SettingBlock::start(ctx);
    }
};

}  // namespace taktwerk::fb

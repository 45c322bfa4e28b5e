#pragma once
// The rules that all blocks share, for tests over tables of blocks: which rule is for which block of the list, and how to drive any of them. Blocks
// are bytes and pins here: a rule is compiled once and not for each of a hundred types.

#include <algorithm>
#include <cstring>
#include <memory>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "fb_library/block_types.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {

/// What a rule has to know of a block and its pins do not say.
struct RuledBlock {
    const BlockType* type = nullptr;
    bool is_command = false;                                    ///< gives the axis a command that the axis keeps until its end
    std::ptrdiff_t in_target = -1;                              ///< where its Inxxx lies
    axes::AxisCommand (*command)(const void* block) = nullptr;  ///< that its inputs ask for, of one with ContinuousUpdate

    [[nodiscard]] bool has(std::string_view pin) const { return type->pin(pin) != nullptr; }
    [[nodiscard]] bool is(std::string_view name) const { return type->name == name; }
    [[nodiscard]] bool is_jog() const { return has("JogForward"); }
    friend void PrintTo(const RuledBlock& block, std::ostream* out) { *out << block.type->name; }
};

template <class B>
RuledBlock ruled() {
    RuledBlock block{.type = find_block_type(block_name<B>())};
    block.is_command = block.is_jog() || requires { B::kind; };
    if constexpr (requires { B::in_target_pin; }) {
        static constexpr B fresh{};
        block.in_target = reinterpret_cast<const char*>(&(fresh.*B::in_target_pin)) - reinterpret_cast<const char*>(&fresh);
    }
    if constexpr (requires(const B b) { b.command(), b.ContinuousUpdate; })
        block.command = [](const void* bytes) { return static_cast<const B*>(bytes)->command(); };
    return block;
}
template <class... Blocks>
std::vector<RuledBlock> ruled(BlockList<Blocks...>) {
    return {ruled<Blocks>()...};
}
inline const std::vector<RuledBlock>& all_ruled() {
    static const std::vector<RuledBlock> all = ruled(AllBlocks{});
    return all;
}
template <class Wanted>
std::vector<RuledBlock> which(const Wanted& wanted) {
    std::vector<RuledBlock> found;
    std::copy_if(all_ruled().begin(), all_ruled().end(), std::back_inserter(found), wanted);
    return found;
}

// --- which rule is for which block ---------------------------------------------------------------------------------------

/// Of Part 1 and its neighbours, of Part 5: those of groups act on no axis of their own, and their rules are shown on a group
/// (tests/fb_library/groups).
inline bool is_of_an_axis(const RuledBlock& block) {
    const auto in = [&](std::span<const BlockType> part) { return block.type >= part.data() && block.type < part.data() + part.size(); };
    return in(motion_block_types()) || in(homing_block_types());
}
inline bool starts_work(const RuledBlock& b) {
    return is_of_an_axis(b) && ((b.has("Execute") && b.has("Busy") && b.has("ErrorID")) || b.is_jog());
}
inline std::vector<RuledBlock> work_blocks() { return which(starts_work); }  // Execute blocks and MC_Jog
/// Those that command an axis.
inline std::vector<RuledBlock> command_blocks() {
    return which([](const RuledBlock& b) { return b.is_command; });
}
/// Without MC_Jog, whose inputs are levels.
inline std::vector<RuledBlock> execute_blocks() {
    return which([](const RuledBlock& b) { return b.is_command && b.has("Execute"); });
}
inline std::vector<RuledBlock> enable_blocks() {
    return which([](const RuledBlock& b) { return b.has("Enable") && !b.has("AxesGroup"); });
}
inline std::vector<RuledBlock> continuous_update_blocks() {
    return which([](const RuledBlock& b) { return b.has("ContinuousUpdate"); });
}
inline std::vector<RuledBlock> in_target_blocks() {
    return which([](const RuledBlock& b) { return b.in_target >= 0; });
}
inline std::vector<RuledBlock> setting_blocks() {
    return which([](const RuledBlock& b) { return is_of_an_axis(b) && b.has("ExecutionMode"); });
}
inline std::string name_of(const testing::TestParamInfo<RuledBlock>& info) { return std::string{info.param.type->name}; }

// --- driving any of them -------------------------------------------------------------------------------------------------

/// An instance whose pins go by name. One that the block does not have is a place that nobody else sees.
class AnyBlock {
public:
    explicit AnyBlock(const BlockType& type) : type_(&type) {
        if (type.alignment > alignof(std::max_align_t)) throw std::logic_error("more aligned than memory is");
        std::memcpy(bytes(), type.prototype, type.size);
    }
    AnyBlock(const AnyBlock&) = delete;
    AnyBlock& operator=(const AnyBlock&) = delete;

    void operator()(const axes::MotionContext& context) noexcept { type_->run(bytes(), context); }
    void warm_start(Instant now) noexcept { type_->warm_start(bytes(), now); }
    void become(const AnyBlock& other) { std::memcpy(bytes(), other.memory_.get(), type_->size); }
    [[nodiscard]] std::byte* bytes() { return memory_.get(); }
    [[nodiscard]] const BlockType& type() const { return *type_; }

    [[nodiscard]] bool has(std::string_view pin) const { return type_->pin(pin) != nullptr; }
    template <class T>
    [[nodiscard]] T& at(std::string_view name) {
        const Pin* pin = type_->pin(name);
        if (pin == nullptr) return *new (&absent_[next_absent_++ * sizeof(std::max_align_t)]) T{};
        if (pin->size != sizeof(T)) throw std::logic_error(std::string{name} + " has another type");
        return *reinterpret_cast<T*>(bytes() + pin->offset);
    }

private:
    const BlockType* type_;
    std::unique_ptr<std::byte[]> memory_{new std::byte[type_->size]};
    alignas(std::max_align_t) std::byte absent_[16 * sizeof(std::max_align_t)]{};
    std::size_t next_absent_ = 0;

public:
    bool &Execute = at<bool>("Execute"), &Enable = at<bool>("Enable"), &JogForward = at<bool>("JogForward"),
         &ContinuousUpdate = at<bool>("ContinuousUpdate");
    bool &Done = at<bool>("Done"), &Busy = at<bool>("Busy"), &Active = at<bool>("Active"), &CommandAborted = at<bool>("CommandAborted"),
         &Error = at<bool>("Error"), &Valid = at<bool>("Valid"), &Enabled = at<bool>("Enabled"), &InOperation = at<bool>("InOperation");
    ErrorId& ErrorID = at<ErrorId>("ErrorID");
    MC_BufferMode& BufferMode = at<MC_BufferMode>("BufferMode");
    MC_ExecutionMode& ExecutionMode = at<MC_ExecutionMode>("ExecutionMode");
};

class Bench : public testing::TestWithParam<RuledBlock> {
protected:
    Bench() {
        if (has("Master")) block.at<AxisRef>("Master") = {1};
        aim(0);
        if (has("Velocity") && block.type().pin("Velocity")->direction == PinDirection::in) block.at<double>("Velocity") = 10;
        if (kind.is("MC_Reset")) axes.axis().state = axes::AxisState::ErrorStop;
        if (kind.is_jog()) block.at<MC_JogMode>("Mode") = mcJogContinuous;
        if (has("ParameterNumber")) block.at<std::int32_t>("ParameterNumber") = axes::enable_limit_positive;  // a BOOL
        if (has("Input")) block.at<axes::InputRef>("Input").axis = {0};
        if (has("Output")) block.at<axes::OutputRef>("Output").axis = {0};
        if (has("Switches")) {
            axes.context.tables = &tables;
            const axes::CamSwitch cams[]{{.track = 1, .first = 0, .last = 1}};
            block.at<axes::CamSwitchRef>("Switches") = tables.add_cam_switches(cams);
        }
        if (kind.is("MC_ExtSetPointGenDisable")) axes.axis(0).active_kind = axes.axis(1).active_kind = axes::CommandKind::external;
        axes.next_scan();
    }
    [[nodiscard]] bool has(std::string_view pin) const { return block.has(pin); }
    /// Which axis it acts on.
    void aim(std::uint16_t index) {
        if (has("CamTable")) block.at<AxisRef>("Master") = {index};  // either of the two will do
        if (has("Slave")) block.at<AxisRef>("Slave") = {index};
        else if (has("Axis")) block.at<AxisRef>("Axis") = {index};
    }
    [[nodiscard]] bool names_an_axis() const { return has("Slave") || has("Axis"); }
    /// Another number on every input that is one.
    void change_inputs(std::int32_t value) {
        const double real = value;
        for (const Pin& pin : block.type().pins) {
            if (pin.direction != PinDirection::in) continue;
            auto* const place = block.bytes() + pin.offset;
            if (pin.type.kind == PinKind::LREAL) std::memcpy(place, &real, sizeof real);
            if (pin.type.kind == PinKind::DINT || pin.type.kind == PinKind::UDINT) std::memcpy(place, &value, sizeof value);
        }
    }
    bool in_target() { return kind.in_target >= 0 && block.bytes()[kind.in_target] != std::byte{0}; }
    void trigger(bool level) { (kind.is_jog() ? block.JogForward : block.Execute) = level; }
    void scan() {
        if (kind.is("MC_ExtSetPointGenDisable")) axes.axis().active_kind = axes::CommandKind::external;
        axes.next_scan();
        block(axes.context);
    }
    /// Starts the work and lets it become active.
    void begin() {
        trigger(true);
        block(axes.context);
        scan();
    }
    /// The block's work ends well; seen in the next scan.
    void complete() {
        if (kind.is("MC_Reset")) axes.axis().state = axes::AxisState::Standstill;
        else if (kind.in_target >= 0) axes.axis().active_in_target = true;
        else if (kind.is_command) axes.finish(axes::Outcome::done);
    }

    [[nodiscard]] bool aborted() const { return block.CommandAborted; }
    /// CommandAborted, or on a block without it the error that says so.
    [[nodiscard]] bool shows_abortion() const {
        return can_be_aborted ? block.CommandAborted : block.ErrorID == ErrorId::aborted_by_command;
    }
    [[nodiscard]] bool done() const { return block.Done; }
    [[nodiscard]] bool active() const { return has_active ? block.Active : block.Busy; }
    /// Valid, or what the block has in its place.
    [[nodiscard]] bool valid() const { return has("Valid") ? block.Valid : has("Enabled") ? block.Enabled : block.InOperation; }
    [[nodiscard]] bool quiet() const { return !done() && !block.Busy && !aborted() && !block.Error && block.ErrorID == ErrorId::none; }

    FakeAxes axes{2};
    axes::MotionTables tables;
    const RuledBlock kind = GetParam();
    AnyBlock block{*kind.type};
    const bool can_be_aborted = has("CommandAborted"), has_active = has("Active"), has_done = has("Done");
};

}  // namespace taktwerk::fb

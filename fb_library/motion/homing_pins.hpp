#pragma once
// Types of pins of PLCopen Part 5. Its enumerations are scoped, as their names are also those of MC_DIRECTION.

#include <array>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

using axes::MC_HomeDirection;
using axes::MC_SwitchMode;

/// MC_REF_SIGNAL_REF: a switch or pulse of the drive, or an input of the machine; `falling`: a switch that is normally closed.
struct ReferenceSignal : axes::TriggerRef {};

inline constexpr ReferenceSignal home_switch_signal{{.source = axes::TriggerSource::home_switch}};
inline constexpr ReferenceSignal index_pulse_signal{{.source = axes::TriggerSource::index_pulse}};

namespace detail {
inline constexpr std::array<std::string_view, 4> home_direction_names{"mcPositiveDirection", "mcNegativeDirection", "mcSwitchPositive",
                                                                      "mcSwitchNegative"};
inline constexpr std::array<std::string_view, 6> switch_mode_names{
    "mcOn", "mcOff", "mcRisingEdge", "mcFallingEdge", "mcEdgeSwitchPositive", "mcEdgeSwitchNegative"};

/// What searching steps share, behind their own inputs: limits, queue and outputs.
template <class Block>
consteval auto step_dynamics() {
    return pin_table(in<&Block::Velocity>("u/s", "of the search, > 0"), shared<&Block::Acceleration, &Block::Deceleration, &Block::Jerk>());
}
template <class Block>
consteval auto step_limits() {
    return pin_table(in<&Block::TorqueLimit>("rated", "more torque than this ends the step with Error; 0 = no limit"),
                     in<&Block::TimeLimit>("", "a step that takes longer ends with Error; 0 = no limit"),
                     in<&Block::DistanceLimit>("u", "further than this from its start it ends with Error; 0 = no limit"),
                     shared<&Block::BufferMode>());
}
template <class Block>
consteval auto step_end() {
    return pin_table(out<&Block::Done>("", "found, standing; the axis stays in Homing"), outcome<Block>());
}

/// The latch of a step's inputs, whichever it has.
template <class Block>
[[nodiscard]] axes::HomingStepDetails step_details(const Block& block) noexcept {
    axes::HomingStepDetails details{.step = Block::step};
    if constexpr (requires { block.Direction; }) details.direction = block.Direction;
    if constexpr (requires { block.SwitchMode; }) details.switch_mode = block.SwitchMode;
    if constexpr (requires { block.LimitSwitchMode; }) details.switch_mode = block.LimitSwitchMode;
    if constexpr (requires { block.ReferenceSignal; }) details.reference = block.ReferenceSignal;
    if constexpr (requires { block.SetPosition; }) details.set_position = block.SetPosition;
    if constexpr (requires { block.TorqueLimit; }) details.torque_limit = block.TorqueLimit;
    if constexpr (requires { block.TimeLimit; }) details.time_limit = block.TimeLimit;
    if constexpr (requires { block.DistanceLimit; }) details.distance_limit = block.DistanceLimit;
    if constexpr (requires { block.DetectionVelocityLimit; }) {
        details.detection_velocity_limit = block.DetectionVelocityLimit;
        details.detection_velocity_time = block.DetectionVelocityTime;
    }
    return details;
}
}  // namespace detail

/// A block that is one step of homing: `static constexpr auto step`.
template <class Block>
struct StepBlock : CommandBlock<Block> {
    static constexpr auto kind = axes::CommandKind::homing_step;
    [[nodiscard]] axes::HomingStepDetails details() const noexcept { return detail::step_details(static_cast<const Block&>(*this)); }
};

// clang-format off
template <> struct PinTypeOf<ReferenceSignal> { static constexpr PinType value{PinKind::HANDLE, "MC_REF_SIGNAL_REF"}; };
template <> struct PinTypeOf<MC_HomeDirection> {
    static constexpr PinType value{PinKind::ENUM, "MC_HOME_DIRECTION", detail::home_direction_names};
};
template <> struct PinTypeOf<MC_SwitchMode> { static constexpr PinType value{PinKind::ENUM, "MC_SWITCH_MODE", detail::switch_mode_names}; };
// clang-format on

}  // namespace taktwerk::fb

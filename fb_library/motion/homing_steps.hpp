#pragma once
// The searching steps of PLCopen Part 5. From the first step on the axis is in Homing and not homed; MC_FinishHoming ends that. A step that
// finds its reference gives that very place SetPosition (NaN: the coordinates stay), then stands. Real-time safe.

#include <string_view>

#include "fb_library/motion/homing_pins.hpp"

namespace taktwerk::fb {

struct MC_StepAbsoluteSwitch : StepBlock<MC_StepAbsoluteSwitch> {
    AxisRef Axis{};
    bool Execute = false;
    MC_HomeDirection Direction = MC_HomeDirection::mcPositiveDirection;
    MC_SwitchMode SwitchMode = MC_SwitchMode::mcRisingEdge;
    fb::ReferenceSignal ReferenceSignal = home_switch_signal;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    double SetPosition = 0, TorqueLimit = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::absolute_switch;
    static constexpr std::string_view summary = "Homing: searches a switch on the way; a limit switch turns the search once.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Direction>("", "where the search begins"),
                         in<&Self::SwitchMode>("", "what ends it"), in<&Self::ReferenceSignal>("", "the switch; by default the drive's"),
                         detail::step_dynamics<Self>(), in<&Self::SetPosition>("u", "coordinate of the edge"), detail::step_limits<Self>(),
                         detail::step_end<Self>());
    }
};

struct MC_StepLimitSwitch : StepBlock<MC_StepLimitSwitch> {
    AxisRef Axis{};
    bool Execute = false;
    MC_HomeDirection Direction = MC_HomeDirection::mcPositiveDirection;
    MC_SwitchMode LimitSwitchMode = MC_SwitchMode::mcOn;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    double SetPosition = 0, TorqueLimit = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::limit_switch;
    static constexpr std::string_view summary = "Homing: searches the limit switch at one end.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Direction>("", "at which end the switch is"),
                         in<&Self::LimitSwitchMode>("", "what ends the search: mcOn, mcOff, mcRisingEdge or, coming back, mcFallingEdge"),
                         detail::step_dynamics<Self>(), in<&Self::SetPosition>("u", "coordinate of the edge"), detail::step_limits<Self>(),
                         detail::step_end<Self>());
    }
};

struct MC_StepBlock : StepBlock<MC_StepBlock> {
    AxisRef Axis{};
    bool Execute = false;
    MC_HomeDirection Direction = MC_HomeDirection::mcPositiveDirection;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    double SetPosition = 0, DetectionVelocityLimit = 0;
    Duration DetectionVelocityTime{};
    double TorqueLimit = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::block;
    static constexpr std::string_view summary = "Homing: drives against a fixed stop. The drive's torque is limited where it can be.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Direction>("", "where the stop is: positive or negative"),
                         detail::step_dynamics<Self>(), in<&Self::SetPosition>("u", "coordinate of the stop"),
                         in<&Self::DetectionVelocityLimit>("u/s", "slower than this it is at the stop, > 0 ..."),
                         in<&Self::DetectionVelocityTime>("", "... when that and the torque have lasted so long"),
                         in<&Self::TorqueLimit>("rated", "torque that is reached at the stop, > 0"),
                         in<&Self::TimeLimit>("", "a step that takes longer ends with Error; 0 = no limit"),
                         in<&Self::DistanceLimit>("u", "further than this from its start it ends with Error; 0 = no limit"),
                         shared<&Self::BufferMode>(), detail::step_end<Self>());
    }
};

struct MC_StepReferencePulse : StepBlock<MC_StepReferencePulse> {
    AxisRef Axis{};
    bool Execute = false;
    MC_HomeDirection Direction = MC_HomeDirection::mcPositiveDirection;
    fb::ReferenceSignal ReferenceSignal = index_pulse_signal;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    double SetPosition = 0, TorqueLimit = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::reference_pulse;
    static constexpr std::string_view summary = "Homing: searches the zero mark of the encoder.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Direction>("", "positive or negative"),
                         in<&Self::ReferenceSignal>("", "the pulse; by default the encoder's index, latched by the drive"),
                         detail::step_dynamics<Self>(), in<&Self::SetPosition>("u", "coordinate of the pulse"), detail::step_limits<Self>(),
                         detail::step_end<Self>());
    }
};

struct MC_StepDistanceCoded : StepBlock<MC_StepDistanceCoded> {
    AxisRef Axis{};
    bool Execute = false;
    MC_HomeDirection Direction = MC_HomeDirection::mcPositiveDirection;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    double TorqueLimit = 0;
    Duration TimeLimit{};
    double DistanceLimit = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::distance_coded;
    static constexpr std::string_view summary =
        "Homing: passes two marks of a distance-coded scale (homing.marks of the axis), which tell where it is.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Direction>("", "positive or negative"),
                         detail::step_dynamics<Self>(), detail::step_limits<Self>(), detail::step_end<Self>());
    }
};

}  // namespace taktwerk::fb

#pragma once
// What ends homing by PLCopen Part 5: then the axis is homed and in Standstill. Real-time safe.

#include <string_view>

#include "fb_library/motion/homing_pins.hpp"

namespace taktwerk::fb {

struct MC_HomeDirect : StepBlock<MC_HomeDirect> {
    AxisRef Axis{};
    bool Execute = false;
    double SetPosition = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::direct;
    static constexpr std::string_view summary = "Homing without motion: where the axis stands becomes SetPosition.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::SetPosition>("u", "coordinate of the present position"),
                         shared<&Self::BufferMode>(), out<&Self::Done>("", "homed, in Standstill"), outcome<Self>());
    }
};

struct MC_HomeAbsolute : StepBlock<MC_HomeAbsolute> {
    AxisRef Axis{};
    bool Execute = false;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::absolute;
    static constexpr std::string_view summary = "Homing without motion: the absolute encoder's zero is at homing.offset of the axis.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::BufferMode>(), out<&Self::Done>("", "homed, in Standstill"),
                         outcome<Self>());
    }
};

struct MC_FinishHoming : StepBlock<MC_FinishHoming> {
    AxisRef Axis{};
    bool Execute = false;
    double Distance = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto step = axes::HomingStep::finish;
    static constexpr std::string_view summary = "Ends homing by steps: moves away if wanted, then the axis is homed and in Standstill.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Distance>("u", "relative move, such as off a switch; 0 = none"),
                         in<&Self::Velocity>("u/s", "of that move, > 0"), shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk>(),
                         shared<&Self::BufferMode>(), out<&Self::Done>("", "homed, in Standstill"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb

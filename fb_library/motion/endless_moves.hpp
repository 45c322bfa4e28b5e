#pragma once
// Moves without an end: MC_MoveVelocity, MC_MoveContinuousAbsolute, MC_MoveContinuousRelative. PLCopen Part 1 v2.0, 3.10 to 3.12.
// Real-time safe.
//
// Only another command ends them. InVelocity and InEndVelocity follow the set-point, never the actual value; they are FALSE for at least
// the call of a new edge, also with the same velocity.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_MoveVelocity : CommandBlock<MC_MoveVelocity> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InVelocity = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::move_velocity;
    static constexpr bool MC_MoveVelocity::*in_target_pin = &MC_MoveVelocity::InVelocity;
    static constexpr std::string_view summary = "Runs the axis at a velocity until something else takes it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::Velocity>("u/s", "signed; the sense times Direction; 0 is allowed"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk>(),
                         in<&Self::Direction>("", "positive, negative or current; shortest way is an error"), shared<&Self::BufferMode>(),
                         out<&Self::InVelocity>("", "the set velocity is the commanded one"), outcome<Self>());
    }
};

struct MC_MoveContinuousAbsolute : CommandBlock<MC_MoveContinuousAbsolute> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Position = 0, EndVelocity = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InEndVelocity = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::move_continuous_absolute;
    static constexpr bool MC_MoveContinuousAbsolute::*in_target_pin = &MC_MoveContinuousAbsolute::InEndVelocity;
    static constexpr std::string_view summary =
        "Moves the axis to an absolute position, arrives there with a velocity and goes on with it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),  //
                         in<&Self::Position>("u", "target"), in<&Self::EndVelocity>("u/s", "signed; at the target and after it"),
                         in<&Self::Velocity>("u/s", "largest velocity on the way, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk>(),
                         in<&Self::Direction>("", "for modulo axes; a linear axis ignores it"), shared<&Self::BufferMode>(),
                         out<&Self::InEndVelocity>("", "target reached, running at EndVelocity"), outcome<Self>());
    }
};

struct MC_MoveContinuousRelative : CommandBlock<MC_MoveContinuousRelative> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Distance = 0, EndVelocity = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool InEndVelocity = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::move_continuous_relative;
    static constexpr bool MC_MoveContinuousRelative::*in_target_pin = &MC_MoveContinuousRelative::InEndVelocity;
    static constexpr std::string_view summary = "Moves the axis by a distance, arrives with a velocity and goes on with it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::Distance>("u", "signed; from the set position at the start"),
                         in<&Self::EndVelocity>("u/s", "signed; after the distance"),
                         in<&Self::Velocity>("u/s", "largest velocity on the way, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::InEndVelocity>("", "distance covered, running at EndVelocity"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb

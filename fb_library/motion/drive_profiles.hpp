#pragma once
// The drive's own profiles: Drive_MoveAbsolute, Drive_MoveRelative (PP), Drive_MoveVelocity (PV), Drive_Torque (PT). Not of PLCopen; pins in the
// form of its moves, without Jerk and ContinuousUpdate. Real-time safe.
//
// The drive plans, not the runtime: no blending, no coupling, no override, and Done, InVelocity, InTorque are the drive's word. They begin at
// standstill: an axis that moves stops first. mcAborting takes over in the drive where it can (docs/motion/drive-profiles.md), mcBuffered waits, in
// the drive as far as its buffer goes; blending is an error. A drive without the mode answers not_supported.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct Drive_MoveAbsolute : CommandBlock<Drive_MoveAbsolute> {
    AxisRef Axis{};
    bool Execute = false;
    double Position = 0, Velocity = 0, Acceleration = 0, Deceleration = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::drive_move_absolute;
    static constexpr std::string_view summary = "Lets the drive move the axis to an absolute position by a profile of its own (PP).";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Position>("u", "target"),
                         in<&Self::Velocity>("u/s", "of the drive's profile, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration>(),
                         in<&Self::Direction>("", "for modulo axes; a linear axis ignores it"), shared<&Self::BufferMode>(),
                         out<&Self::Done>("", "the drive says that the target is reached, and stands"), outcome<Self>());
    }
};

struct Drive_MoveRelative : CommandBlock<Drive_MoveRelative> {
    AxisRef Axis{};
    bool Execute = false;
    double Distance = 0, Velocity = 0, Acceleration = 0, Deceleration = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::drive_move_relative;
    static constexpr std::string_view summary = "Lets the drive move the axis by a distance, by a profile of its own (PP).";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::Distance>("u", "signed; from the actual position, buffered behind another one from its target"),
                         in<&Self::Velocity>("u/s", "of the drive's profile, > 0; need not be reached"),
                         shared<&Self::Acceleration, &Self::Deceleration, &Self::BufferMode>(),
                         out<&Self::Done>("", "the drive says that the target is reached, and stands"), outcome<Self>());
    }
};

struct Drive_MoveVelocity : CommandBlock<Drive_MoveVelocity> {
    AxisRef Axis{};
    bool Execute = false;
    double Velocity = 0, Acceleration = 0, Deceleration = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InVelocity = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::drive_move_velocity;
    static constexpr bool Drive_MoveVelocity::*in_target_pin = &Drive_MoveVelocity::InVelocity;
    static constexpr std::string_view summary =
        "Lets the drive run the axis at a velocity by ramps of its own (PV) until something else takes it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::Velocity>("u/s", "signed; the sense times Direction; 0 is allowed"),
                         shared<&Self::Acceleration, &Self::Deceleration>(),
                         in<&Self::Direction>("", "positive, negative or current; shortest way is an error"), shared<&Self::BufferMode>(),
                         out<&Self::InVelocity>("", "the drive says that it has the velocity"), outcome<Self>());
    }
};

struct Drive_Torque : CommandBlock<Drive_Torque> {
    AxisRef Axis{};
    bool Execute = false;
    double Torque = 0, TorqueRamp = 0, Velocity = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InTorque = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::drive_torque;
    static constexpr bool Drive_Torque::*in_target_pin = &Drive_Torque::InTorque;
    static constexpr std::string_view summary =
        "Lets the drive exert a torque by a ramp of its own (PT) until something else takes the axis.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::Torque>("1", "fraction of the rated torque, signed; the sense times Direction"),
                         in<&Self::TorqueRamp>("1/s", "rate of the set torque, in fractions of the rated one; 0 = at once"),
                         in<&Self::Velocity>("u/s", "limit that the drive keeps (607Fh), >= 0, in both senses; 0 = the axis' limit"),
                         in<&Self::Direction>("", "sense of the torque: positive, negative or current"), shared<&Self::BufferMode>(),
                         out<&Self::InTorque>("", "the drive says that it has the torque"), outcome<Self>());
    }

    [[nodiscard]] axes::TorqueDetails details() const noexcept { return {Torque, TorqueRamp}; }
};

}  // namespace taktwerk::fb

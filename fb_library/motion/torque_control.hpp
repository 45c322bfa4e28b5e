#pragma once
// MC_TorqueControl: PLCopen Part 1 v2.0, 3.13. Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Velocity, Acceleration and Deceleration are limits that hold the torque back when the load gives way; Jerk has no effect.
struct MC_TorqueControl : CommandBlock<MC_TorqueControl> {
    AxisRef Axis{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    double Torque = 0, TorqueRamp = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_Direction Direction = mcPositiveDirection;
    MC_BufferMode BufferMode = mcAborting;

    bool InTorque = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::torque;
    static constexpr bool MC_TorqueControl::*in_target_pin = &MC_TorqueControl::InTorque;
    static constexpr std::string_view summary = "Exerts a torque or force until something else takes the axis.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::Torque>("1", "fraction of the rated torque, signed; the sense times Direction"),
                         in<&Self::TorqueRamp>("1/s", "largest rate of the set torque, in fractions of the rated one; 0 = at once"),
                         in<&Self::Velocity>("u/s", "limit, >= 0, in both senses; 0 = the axis' limit"),
                         in<&Self::Acceleration>("u/s2", "limit while torque and velocity have one sign; 0 = the axis' default"),
                         in<&Self::Deceleration>("u/s2", "limit while their signs differ; 0 = the axis' default"),
                         in<&Self::Jerk>("u/s3", "no effect: the torque changes by TorqueRamp"),
                         in<&Self::Direction>("", "sense of the torque: positive, negative or current"), shared<&Self::BufferMode>(),
                         out<&Self::InTorque>("", "the set torque is the commanded one"), outcome<Self>());
    }

    [[nodiscard]] axes::TorqueDetails details() const noexcept { return {Torque, TorqueRamp}; }
};

}  // namespace taktwerk::fb

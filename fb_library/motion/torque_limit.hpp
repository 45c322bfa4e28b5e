#pragma once
// MC_SetTorqueLimit: how much torque the drive may give in each direction. Not part of PLCopen's Part 1; vendors have it under this name. Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// In any state, beside whatever the axis does. The limits hold until others are set, also without power; they never pass what is configured
/// (limits.torque). An axis that its limit keeps from its set-point falls behind it: the watch of the following error sees that.
struct MC_SetTorqueLimit : CommandBlock<MC_SetTorqueLimit> {
    AxisRef Axis{};
    bool Execute = false;
    double PositiveLimit = 0, NegativeLimit = 0;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::set_torque_limit;
    static constexpr std::string_view summary = "Limits the torque of the drive in each direction.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::PositiveLimit>("1", "fraction of the rated torque, 0.001 or more; 0 = as configured"),
                         in<&Self::NegativeLimit>("1", "the same in negative direction, without sign"),
                         out<&Self::Done>("", "the drive has these limits"), outcome<Self>());
    }

    [[nodiscard]] axes::TorqueLimitDetails details() const noexcept { return {PositiveLimit, NegativeLimit}; }
};

}  // namespace taktwerk::fb

#pragma once
// MC_SetControllerMode: which loop the drive closes. Name as in RTmotion (CODESYS: SMC_SetControllerMode); not part of PLCopen.
// Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Only at standstill, and only a mode that the drive has. Motion commands mean the same in position and velocity mode: in the latter the
/// position loop is closed here.
struct MC_SetControllerMode : CommandBlock<MC_SetControllerMode> {
    AxisRef Axis{};
    bool Execute = false;
    MC_ControllerMode Mode = mcPositionControl;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::set_controller_mode;
    static constexpr std::string_view summary = "Changes which loop the drive closes: position, velocity or torque.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Mode>("", "which loop"),
                         out<&Self::Done>("", "the drive is in the mode"), outcome<Self>());
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = kind, .position = static_cast<double>(static_cast<std::uint8_t>(drive_mode()))};
    }

private:
    [[nodiscard]] axes::DriveMode drive_mode() const noexcept {
        switch (Mode) {
            case mcPositionControl: return axes::DriveMode::cyclic_position;
            case mcVelocityControl: return axes::DriveMode::cyclic_velocity;
            case mcTorqueControl: return axes::DriveMode::cyclic_torque;
        }
        return axes::DriveMode::none;
    }
};

}  // namespace taktwerk::fb

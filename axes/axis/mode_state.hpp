#pragma once
// The mode that the drive runs in, and the one it is on its way to. Who leads it there: drive_modes.hpp.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/drive_profile_run.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/torque_control.hpp"

namespace taktwerk::axes {

/// The last three: the drive makes the profile (drive_profiles.hpp).
enum class ModePhase : std::uint8_t { steady, entering, torque, leaving, changing, profile_entering, profile, profile_halting };

struct ModeState {
    ModeState(const AxisBody& of_axis, const HomingRuns& homing);

    const AxisBody& body;
    const HomingRuns& runs;
    DriveMode own;     ///< position or velocity: of every motion
    DriveMode former;  ///< before set_controller_mode
    ModePhase phase = ModePhase::steady;
    Instant since{}, seen_at{};
    DriveMode asked_for;  ///< what the drive was told last, and from when on
    Instant asked_at{};
    bool was_another = false;  ///< since then the drive has shown another one: what it shows now is no word of before
    bool waits = false;        ///< for standstill of the motor, before it is asked for
    bool seen = false;         ///< the drive shows the wanted mode
    bool motor_leads = false;  ///< since the last steady cycle the drive was in a mode that takes no set-point
    bool torque_idle = false;  ///< set_controller_mode has chosen torque: without a command it is 0
    bool halt = false;         ///< bit 8, until the drive is back in the axis' own mode
    DriveProfileRun run;
    double torque_velocity = 0;  ///< u/s, limit of the torque command
    TorqueControl torque;

    [[nodiscard]] DriveMode wanted() const noexcept { return phase == ModePhase::steady && !runs.drive.busy() ? own : on_the_way(); }
    [[nodiscard]] DriveMode torque_mode() const noexcept { return body.slow_line ? DriveMode::profile_torque : DriveMode::cyclic_torque; }
    [[nodiscard]] bool changes() const noexcept {
        return phase == ModePhase::entering || phase == ModePhase::leaving || phase == ModePhase::changing ||
               phase == ModePhase::profile_entering;
    }
    [[nodiscard]] bool in_torque() const noexcept { return phase == ModePhase::entering || phase == ModePhase::torque; }
    [[nodiscard]] bool in_profile() const noexcept { return phase >= ModePhase::profile_entering; }
    [[nodiscard]] bool torque_wanted() const noexcept {
        if (body.queue.active().command.kind == CommandKind::torque) return true;
        return torque_idle && !body.queue.has_active() && body.state == AxisState::Standstill;
    }
    void go(ModePhase to) noexcept {
        if (phase == ModePhase::steady) motor_leads = false;
        phase = to;
        since = body.now;
        seen = waits = false;
    }
    /// The drive is in the axis' own mode, or has no power.
    void end_profile() noexcept {
        phase = ModePhase::steady;
        halt = false;
        run.end();
    }

private:
    [[nodiscard]] DriveMode on_the_way() const noexcept;
};

}  // namespace taktwerk::axes

#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

namespace {

/// The mode it runs in for every motion. A drive that takes no set-point each cycle makes its own ramps.
DriveMode own_mode(const AxisBody& body) {
    if (body.config.control.mode == ControlMode::position) return DriveMode::cyclic_position;
    return body.slow_line ? DriveMode::profile_velocity : DriveMode::cyclic_velocity;
}

/// Bounds of velocity that act through a slow line would come too late: there the drive keeps them.
double torque_inertia(const AxisBody& body) { return body.slow_line ? 0 : body.config.control.inertia(); }

/// A tenth of the cycle rate: see TorqueControl.
double torque_bandwidth(Duration cycle) { return cycle > Duration::zero() ? 0.1 / to_seconds(cycle) : 0; }

}  // namespace

ModeState::ModeState(const AxisBody& of_axis, const HomingRuns& homing)
    : body(of_axis),
      runs(homing),
      own(own_mode(body)),
      former(own),
      asked_for(own),
      torque(torque_inertia(body), torque_bandwidth(body.cycle)) {}

DriveMode ModeState::on_the_way() const noexcept {
    if (runs.drive.busy()) return runs.drive.mode();
    if (waits) return phase == ModePhase::changing ? former : own;
    if (in_profile()) return run.mode();
    return in_torque() ? torque_mode() : own;
}

}  // namespace taktwerk::axes

#pragma once
// The searches of a homing that may be under way, whoever began them: what an error or a stop has to end.

#include <utility>

#include "axes/axis/axis_body.hpp"
#include "axes/homing/drive_homing.hpp"
#include "axes/homing/drive_latch.hpp"
#include "axes/homing/step_run.hpp"
#include "axes/homing/switch_homing.hpp"

namespace taktwerk::axes {

struct HomingRuns {
    explicit HomingRuns(const AxisBody& of_axis) : body(of_axis) {}

    const AxisBody& body;
    DriveHoming drive;
    SwitchHoming by_switch;
    StepRun step;
    DriveLatch latch;
    bool step_succeeded = false;  ///< the last one; without it the procedure cannot be finished
    bool squares = false;         ///< the reference is found; one side of the portal is led to the other
    double block_torque = 0;      ///< fraction of rated torque while pressing against a block

    /// The drive takes no set-point from here: it has no power, or homes by itself.
    [[nodiscard]] bool motor_leads() const noexcept { return body.power.follows_actual() || drive.busy(); }
    /// Some kind of homing is under way, apart from that by the drive and passive homing.
    [[nodiscard]] bool search() const noexcept {
        return step.busy() || by_switch.busy() || squares || body.queue.active().command.kind == CommandKind::homing_step;
    }
    void abort() noexcept {
        if (step.busy() || by_switch.phase() == SwitchHoming::Phase::finished) latch.release();
        if (std::exchange(squares, false)) body.port.stop_squaring();
        by_switch.cancel();
        step.cancel();
        if (body.power.follows_actual()) drive.cancel();
        else drive.abort(body.now);
    }
};

}  // namespace taktwerk::axes

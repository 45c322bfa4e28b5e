#pragma once
// What a configuration may say, and hardly anybody means: a unit taken for another, a window that never closes, two programs on one axis.
// Not errors: the machine runs. `taktwerk check` tells them. Not real-time.

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

/// Turns of the motor in a minute at this velocity of the axis (u/s).
[[nodiscard]] double motor_rpm(const axes::AxisConfig& axis, double velocity) noexcept;
/// Seconds from one software limit to the other at the limits of velocity and acceleration, jerk apart; nothing without limits.
[[nodiscard]] std::optional<double> stroke_seconds(const axes::AxisConfig& axis) noexcept;

/// Subjects name the field ("axes.x.limits.velocity"), codes begin with "remark.". `layout`: of the machine that was built from it;
/// `cpus`: how many this computer has.
[[nodiscard]] std::vector<Error> remarks(const MachineConfig& config, const MachineLayout& layout, unsigned cpus);

/// A simulated bus without a slave: a machine of virtual axes alone. It is checked like any other and does not run, since no frame comes back: `run` refuses it with this.
[[nodiscard]] std::optional<Error> nothing_answers(const MachineConfig& config);

}  // namespace taktwerk::runtime

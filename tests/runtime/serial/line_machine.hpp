#pragma once
// A machine with a drive on a serial line, for tests.

#include "tests/axes/drives/xp200/plain_profile.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {

inline constexpr std::uint16_t u = 1;  ///< the axis of with_line()

/// x on the bus as ever; u on a line of 38400 baud, 10 mm a turn, watched over by output `u_stop` on the terminal, wired to DI6 (EMG).
inline MachineConfig with_line(MachineConfig m) {
    SerialDriveConfig drive;
    drive.drive.name = "u_drive";
    drive.drive.profile = axes::xp200::plain_profile();
    drive.drive.parameters = {{97, 33}, {105, -15}, {108, 9}, {136, 1}, {164, 1}, {63, 200}};
    drive.watchdog_output = "u_stop";
    SerialLineConfig line;
    line.name = "rs485";
    line.settings.baud = 38400;
    line.drives.push_back(drive);
    m.serial.push_back(line);

    AxisBinding binding;
    auto& axis = binding.axis;
    axis.name = "u";
    axis.gearing = {.counts_per_revolution = 10000, .feed = 10};
    axis.limits = {.velocity = 100,
                   .acceleration = 200,
                   .deceleration = 200,
                   .jerk = std::numeric_limits<double>::infinity(),
                   .stop_deceleration = 400};
    axis.control = {.mode = axes::ControlMode::velocity, .kv = 3};
    axis.windows = {.in_position = 0.05, .in_position_time = 10ms, .standstill_velocity = 0.1};
    axis.following = {.window = 10, .time = 50ms};
    axis.homing.kind = axes::HomingKind::set_here;
    binding.drive = "u_drive";
    binding.profile = drive.drive.profile;
    m.axes.push_back(binding);

    IoPoint point;
    point.name = "u_stop";
    point.direction = IoDirection::output;
    point.slave = "io";
    point.index = 0x7000;
    point.sub = 2;
    m.io.push_back(point);
    return m;
}

}  // namespace taktwerk::runtime::testing

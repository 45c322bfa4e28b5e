#include "runtime/machine/machine_layout.hpp"

#include "axes/group/group_arm.hpp"
#include "axes/group/workspace.hpp"

namespace taktwerk::runtime {

namespace {

MachineLayout::AxisInfo axis_info(const MachineBody& body, const MachineDrives& drives, std::size_t axis) {
    const auto& binding = body.config.axes[axis];
    const bool on_line = !binding.drive.empty() && !binding.axis.simulated;
    MachineLayout::AxisInfo info;
    info.name = binding.axis.name;
    info.unit = binding.axis.unit;
    info.disabled = binding.axis.disabled;
    info.simulated = !drives.on_bus(axis) && !on_line;
    info.jog_slow = body.views[axis].manual_slow;
    info.jog_fast = body.views[axis].manual_fast;
    info.drive_axis = binding.drive_axis;
    info.position_min = binding.axis.limits.position_min;
    info.position_max = binding.axis.limits.position_max;
    info.velocity_limit = binding.axis.limits.velocity;
    info.acceleration_limit = binding.axis.limits.acceleration;
    info.deceleration = binding.axis.limits.deceleration;
    info.jerk_limit = binding.axis.limits.jerk;
    info.following_window = binding.axis.following.window;
    info.in_position_window = binding.axis.windows.in_position;
    info.modulo = binding.axis.modulo;
    info.homing = binding.axis.homing.kind;
    if (drives.on_bus(axis)) info.group = body.bus.slave(drives.slave_of(axis)).hot_connect;
    if (drives.on_bus(axis)) info.drive = binding.slave;
    else if (on_line && drives.serial().has_lines()) info.drive = binding.drive;
    if (!info.drive.empty() && binding.profile) info.profile = binding.profile->name;
    return info;
}

MachineLayout::GroupInfo group_info(const MachineBody& body, const axes::AxisGroup& group) {
    MachineLayout::GroupInfo info;
    info.name = group.config().name;
    info.unit = group.config().unit;
    for (const auto& name : group.config().members)
        for (std::size_t i = 0; i < body.config.axes.size(); ++i)
            if (body.config.axes[i].axis.name == name) info.members.push_back(static_cast<std::uint16_t>(i));
    info.arm = group.config().kinematics != nullptr;
    if (info.arm) {
        info.commands = axes::commands_of(*group.config().kinematics);
        info.setup_velocity = axes::setup_velocity_of(group.config());
    }
    if (group.config().workspace)
        for (const auto& room : group.config().workspace->rooms) info.rooms.push_back({room.name, room.kept_free});
    return info;
}

}  // namespace

MachineLayout layout_of(const MachineBody& body, const MachineDrives& drives, const ProgramHost& programs) {
    const auto& config = body.config;
    MachineLayout layout;
    layout.machine = config.name;
    layout.cycle = config.cycle;
    for (std::size_t i = 0; i < config.axes.size(); ++i) layout.axes.push_back(axis_info(body, drives, i));
    for (std::size_t i = 0; i < body.axis_groups.size(); ++i) layout.groups.push_back(group_info(body, body.axis_groups[i]));
    layout.interface = config.bus.interface;
    for (const auto& line : config.serial)
        if (!line.device.empty()) layout.serial_devices.push_back(line.device);
    for (std::size_t s = 0; s < body.bus.slave_count(); ++s) layout.slaves.push_back(body.bus.slave(s).name);
    layout.inputs = body.io.names(IoDirection::input);
    layout.outputs = body.io.names(IoDirection::output);
    for (std::size_t i = 0; i < layout.inputs.size(); ++i) layout.input_units.push_back(body.io.point(IoDirection::input, i).unit);
    for (std::size_t i = 0; i < layout.outputs.size(); ++i) layout.output_units.push_back(body.io.point(IoDirection::output, i).unit);
    layout.kept_inputs = body.kept.inputs;
    layout.kept_outputs = body.kept.outputs;
    programs.describe(layout);
    return layout;
}

}  // namespace taktwerk::runtime

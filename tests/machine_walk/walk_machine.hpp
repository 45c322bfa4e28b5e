#pragma once
// The machine that walks run on: three axes on servos that know every mode, as different as a seed makes them.

#include <algorithm>

#include "tests/axes/axis/walk_axes.hpp"
#include "tests/machines/add_program.hpp"
#include "tests/machines/plain_machine.hpp"

namespace taktwerk::runtime::testing {

using namespace std::chrono_literals;

/// The plain servo with 60FFh, 6071h, 60B1h and 607Fh mapped and ramps of its own: all cyclic and all profile modes.
inline std::shared_ptr<const ecat::DeviceDescription> servo_of_all_modes() {
    auto device = std::make_shared<ecat::DeviceDescription>(*servo_device());
    const auto add = [&](std::uint16_t index, ecat::DataType type, std::uint8_t bits) {
        auto object = *std::find_if(device->objects.begin(), device->objects.end(), [](const auto& o) { return o.index == 0x607A; });
        object.index = index;
        object.type = type;
        device->objects.push_back(object);
        if (bits != 0) device->rx_pdos[0].entries.push_back({index, 0, bits});
    };
    add(0x60FF, ecat::DataType::I32, 32);
    add(0x6071, ecat::DataType::I16, 16);
    add(0x60B1, ecat::DataType::I32, 32);
    add(0x607F, ecat::DataType::U32, 32);
    add(0x6081, ecat::DataType::U32, 0);
    add(0x6083, ecat::DataType::U32, 0);
    add(0x6084, ecat::DataType::U32, 0);
    add(0x6087, ecat::DataType::U32, 0);
    return device;
}

inline std::shared_ptr<const axes::DriveProfile> profile_of_all_modes(axes::test::Dice& dice) {
    using axes::DriveMode;
    auto profile = std::make_shared<axes::DriveProfile>(*servo_profile());
    for (const auto mode : {DriveMode::cyclic_velocity, DriveMode::cyclic_torque, DriveMode::profile_position, DriveMode::profile_velocity,
                            DriveMode::profile_torque})
        profile->modes.push_back(mode);
    if (dice.once_in(3)) profile->mode_rules.change_delay = 2ms;
    if (dice.once_in(3)) profile->enable_delay = 50ms;
    return profile;
}

/// The second axis is a modulo axis. `program`: in automatic, else by hand.
inline MachineConfig walk_machine(axes::test::Dice& dice, const ProgramEntry* (*program)()) {
    auto config = machine_config(3);
    const auto device = servo_of_all_modes();
    for (std::size_t i = 0; i < config.axes.size(); ++i) {
        config.bus.slaves[i].device = device;
        auto& axis = config.axes[i].axis;
        auto& simulation = config.axes[i].simulation;
        config.axes[i].profile = profile_of_all_modes(dice);
        axis.limits.velocity = 150;
        axis.limits.acceleration = axis.limits.deceleration = 2000;
        axis.limits.jerk = dice.once_in(3) ? std::numeric_limits<double>::infinity() : 100'000;
        if (dice.once_in(2)) axis.limits.stop_deceleration = 4000;
        axis.limits.position_min = -300;
        axis.limits.position_max = 800;
        axis.following.window = 20;
        axis.require_homed = false;
        axis.homing.kind = dice.once_in(2) ? axes::HomingKind::drive : axes::HomingKind::set_here;
        if (dice.once_in(3)) axis.control.mode = axes::ControlMode::velocity;
        axis.control.kv = 50;
        axis.control.feed_forward = dice.once_in(3) ? 0 : 1;
        axis.control.rated_acceleration = 10106;  // tests/runtime/control_modes_machine.cpp
        axis.gearing.inverted = axis.homing.kind == axes::HomingKind::set_here && dice.once_in(3);
        axis.patience.jog_lease = 200ms;
        simulation.start = 50;
        simulation.negative_limit = -2000;
        simulation.positive_limit = 2000;
        simulation.negative_stop = -2100;
        simulation.positive_stop = 2100;
    }
    auto& turning = config.axes[1].axis;
    turning.modulo = 360;
    turning.limits.position_min = -std::numeric_limits<double>::infinity();
    turning.limits.position_max = std::numeric_limits<double>::infinity();
    turning.homing.kind = axes::HomingKind::set_here;
    if (program == nullptr) return config;
    add_program(config, "walker", program);
    config.start_mode = Mode::automatic;
    return config;
}

}  // namespace taktwerk::runtime::testing

#include "tests/machines/plain_machine.hpp"

#include <string>

#include "ecat/sim/digital_terminal.hpp"

namespace taktwerk::runtime::testing {

namespace {

using ecat::Access;
using ecat::DataType;
using ecat::Mappable;

ecat::ObjectEntry object(std::uint16_t index, std::uint8_t sub, DataType type, Access access, Mappable mappable, std::int64_t value = 0) {
    ecat::ObjectEntry e;
    e.index = index;
    e.sub = sub;
    e.name = "object";
    e.type = type;
    e.access = access;
    e.mappable = mappable;
    e.value = value;
    return e;
}

}  // namespace

std::shared_ptr<const ecat::DeviceDescription> servo_device() {
    auto d = std::make_shared<ecat::DeviceDescription>();
    d->name = d->device_name = "test servo";
    d->identity = {0x1234, 0x402, 1, 0};
    d->mailbox = ecat::MailboxDescription{};
    d->sync_managers = {{ecat::SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                        {ecat::SmUse::mailbox_in, 0x1080, 0x80, 0x22},
                        {ecat::SmUse::outputs, 0x1100, 0, 0x64},
                        {ecat::SmUse::inputs, 0x1400, 0, 0x20}};
    d->rx_pdos = {{0x1600, false, {{0x6040, 0, 16}, {0x6060, 0, 8}, {0x607A, 0, 32}}}};
    d->tx_pdos = {{0x1A00,
                   false,
                   {{0x6041, 0, 16}, {0x6061, 0, 8}, {0x6064, 0, 32}, {0x606C, 0, 32}, {0x6077, 0, 16}, {0x603F, 0, 16}, {0x60FD, 0, 32}}}};
    d->rx_assigned = {0x1600};
    d->tx_assigned = {0x1A00};
    d->dc = {true, true, true, 250us, 250us};
    d->objects = {object(0x1000, 0, DataType::U32, Access::ro, Mappable::no, 0x00020192),
                  object(0x603F, 0, DataType::U16, Access::ro, Mappable::tx),
                  object(0x6040, 0, DataType::U16, Access::rw, Mappable::rx),
                  object(0x6041, 0, DataType::U16, Access::ro, Mappable::tx),
                  object(0x6060, 0, DataType::I8, Access::rw, Mappable::rx),
                  object(0x6061, 0, DataType::I8, Access::ro, Mappable::tx),
                  object(0x6062, 0, DataType::I32, Access::ro, Mappable::tx),
                  object(0x6064, 0, DataType::I32, Access::ro, Mappable::tx),
                  object(0x606C, 0, DataType::I32, Access::ro, Mappable::tx),
                  object(0x6077, 0, DataType::I16, Access::ro, Mappable::tx),
                  object(0x607A, 0, DataType::I32, Access::rw, Mappable::rx),
                  object(0x607C, 0, DataType::I32, Access::rw, Mappable::no),
                  object(0x6098, 0, DataType::I8, Access::rw, Mappable::no, 20),
                  object(0x6099, 1, DataType::U32, Access::rw, Mappable::no, 100),
                  object(0x6099, 2, DataType::U32, Access::rw, Mappable::no, 100),
                  object(0x609A, 0, DataType::U32, Access::rw, Mappable::no, 100),
                  object(0x60F4, 0, DataType::I32, Access::ro, Mappable::tx),
                  object(0x60FD, 0, DataType::U32, Access::ro, Mappable::tx)};
    return d;
}

std::shared_ptr<const axes::DriveProfile> servo_profile() {
    auto p = std::make_shared<axes::DriveProfile>();
    p->name = "test servo";
    p->modes = {axes::DriveMode::cyclic_position, axes::DriveMode::homing};
    p->homing_methods = {17, 18, 19, 20, 21, 22};
    p->minimum_cycle_csp = 250us;
    axes::DriveAlarmText phase;
    phase.code = 0x3130;
    phase.panel = "E.999", phase.english = "phase failure", phase.chinese = "缺相";
    phase.cause = "a phase is missing", phase.remedy = "check the supply";
    p->alarms = {phase};
    return p;
}

MachineConfig machine_config(std::size_t axes) {
    MachineConfig m;
    m.name = "test";
    m.cycle = 1ms;
    m.bus.cycle = 1ms;
    const auto device = servo_device();
    const auto profile = servo_profile();
    for (std::size_t i = 0; i < axes; ++i) {
        const std::string name = i < 3 ? std::string(1, static_cast<char>('x' + i)) : "a" + std::to_string(i);
        ecat::SlaveConfig slave;
        slave.name = name + "_drive";
        slave.device = device;
        slave.position = static_cast<std::uint16_t>(i);
        slave.dc = true;
        m.bus.slaves.push_back(slave);

        AxisBinding binding;
        auto& axis = binding.axis;
        axis.name = name;
        axis.gearing.counts_per_revolution = 10000;
        axis.gearing.feed = 10;
        axis.limits.velocity = 500;
        axis.limits.acceleration = axis.limits.deceleration = 5000;
        axis.limits.jerk = 100000;
        axis.limits.position_min = 0;
        axis.limits.position_max = 800;
        axis.following.window = 5;
        axis.windows.in_position = 0.05;
        axis.homing.kind = axes::HomingKind::drive;
        axis.homing.method = 19;
        axis.homing.search_velocity = 100;
        axis.homing.latch_velocity = 5;
        axis.homing.acceleration = 1000;
        axis.manual = {50, 200, 50};
        binding.slave = slave.name;
        binding.profile = profile;
        binding.simulation.start = -60;
        binding.simulation.negative_limit = -100;
        binding.simulation.positive_limit = 850;
        binding.simulation.negative_stop = -120;
        binding.simulation.positive_stop = 870;
        binding.simulation.home_from = 0;
        binding.simulation.home_to = 20;
        m.axes.push_back(binding);
    }
    ecat::SlaveConfig io;
    io.name = "io";
    io.device = std::make_shared<ecat::DeviceDescription>(ecat::sim::digital_input_output_terminal(8, 8));
    io.position = static_cast<std::uint16_t>(axes);
    m.bus.slaves.push_back(io);
    const auto point = [&](std::string name, IoDirection direction, std::uint8_t channel, std::optional<std::int64_t> simulated = {}) {
        IoPoint p;
        p.name = std::move(name);
        p.direction = direction;
        p.slave = "io";
        p.index = direction == IoDirection::input ? 0x6000 : 0x7000;
        p.sub = channel;
        p.simulated = simulated;
        m.io.push_back(p);
    };
    point("estop_ok", IoDirection::input, 1, 1);
    point("button", IoDirection::input, 2, 0);
    point("lamp", IoDirection::output, 1);
    m.emergency_stop.input = "estop_ok";
    m.emergency_stop.power_off_after = 500ms;
    return m;
}

}  // namespace taktwerk::runtime::testing

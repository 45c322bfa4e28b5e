#include "runtime/machine/machine_body.hpp"

#include <algorithm>

#include "axes/drives/cia402/homing_startup.hpp"
#include "axes/drives/cia402/own_modes.hpp"
#include "runtime/present_slaves.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

/// What the axes need of the bus beyond what the file says: SDOs of drive homing, and no slave for an axis that is simulated.
ecat::BusConfig bus_of(const MachineConfig& config) {
    auto bus = config.bus;
    bus.cycle = config.cycle;
    bus.slaves = present_slaves(config);
    for (const auto& binding : config.axes) {
        if (binding.slave.empty() || !binding.profile || binding.axis.disabled) continue;
        for (auto& slave : bus.slaves) {
            if (slave.name != binding.slave) continue;
            const auto more = axes::cia402::homing_startup(binding.axis, *binding.profile, binding.drive_axis);
            slave.startup.insert(slave.startup.end(), more.begin(), more.end());
        }
    }
    for (const auto& side : sides_of(config.axes)) {
        if (!side.profile || side.axis.disabled) continue;
        for (auto& slave : bus.slaves) {
            if (slave.name != side.slave) continue;
            const auto given = axes::cia402::given_to(side.axis, *side.profile, exchange_period(bus, slave));
            slave.startup.insert(slave.startup.begin(), given.begin(), given.end());
            slave.asked = axes::cia402::asked_of(*side.profile);
        }
    }
    // Without real time a stall of the host must not trip the slaves' watchdogs before it is even counted.
    if (config.simulation.supervision == Supervision::relaxed) {
        bus.lost_frames_limit = static_cast<std::uint16_t>(std::min(supervised_limit(config, bus.lost_frames_limit), 60000u));
        for (auto& slave : bus.slaves)
            if (slave.sm_watchdog == Duration{}) slave.sm_watchdog = relaxed_watchdog;
        bus.lock_required = false;
    }
    return bus;
}

}  // namespace

MachineBody::MachineBody(MachineConfig machine, ecat::Transport& transport)
    : config(std::move(machine)),
      bus_config(bus_of(config)),
      wire(transport),
      bus(wire, bus_config),
      io(config.io, config.cycle),
      kept(kept_points(config, io)),
      views(config.axes.size()),
      following_peaks(config.axes.size()),
      mode(config.start_mode) {}

void MachineBody::raise(const AlarmFact& fact, std::span<const AlarmInfo> table) noexcept {
    if (const auto* info = find_alarm(table, fact.id)) log.raise(fact, info->reaction, info->reset, now);
}

void MachineBody::shut_down(std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    if (auto* group = axis_groups.leader_of(ref)) group->shut_down(ref);
    else axes[axis].shut_down();
}

void MachineBody::raise(MachineAlarm alarm, AlarmSource source, std::uint16_t index, double a, double b) noexcept {
    raise({id(alarm), source, index, a, b}, machine_alarms);
}

}  // namespace taktwerk::runtime

#include "ecat/bringup/hand_over.hpp"

#include <algorithm>

namespace taktwerk::ecat {

namespace {

bool exchanged_alone(const Bus& bus, std::size_t slave) {
    if (slave >= bus.plan.slaves.size() || !bus.plan.slaves[slave].unit) return false;
    return bus.plan.units[*bus.plan.slaves[slave].unit].slaves.size() == 1;
}

/// In the order of positions, so that parents come before their children.
std::vector<FaultSlave> fault_slaves(const Bus& bus) {
    std::vector<FaultSlave> slaves;
    for (const auto& slave : bus.slaves) {
        const Duration watchdog = sm_watchdog(bus.config, *slave->config) - bus.config.cycle;  // a frame had just come when the gap began
        const auto cycles = static_cast<std::uint32_t>(std::max<std::int64_t>(2, watchdog / bus.config.cycle));
        slaves.push_back({slave->index, FaultSlave::none, slave->config->on_loss, bus.reference == slave->index,
                          exchanged_alone(bus, slave->index), cycles, watchdog});
    }
    const auto position = [&](const FaultSlave& s) { return std::size_t{bus.slaves[s.index]->found.position}; };
    std::sort(slaves.begin(), slaves.end(), [&](const FaultSlave& a, const FaultSlave& b) { return position(a) < position(b); });
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        if (position(slaves[i]) >= bus.topology.slaves.size()) {  // the tree could not be read: take it for a line
            if (i > 0) slaves[i].parent = i - 1;
            continue;
        }
        for (auto up = bus.topology.slaves[position(slaves[i])].parent; up && slaves[i].parent == FaultSlave::none;
             up = bus.topology.slaves[*up].parent)
            for (std::size_t k = 0; k < i; ++k)
                if (position(slaves[k]) == *up) slaves[i].parent = k;
    }
    return slaves;
}

}  // namespace

std::unique_ptr<CyclePlan> cycle_plan(const Bus& bus) {
    std::vector<CycleSlave> slaves;
    for (const auto& slave : bus.slaves)
        slaves.push_back({&slave->link, &slave->mailbox.emergency, exchange_period(bus.config, *slave->config), slave->dc_delay});
    const auto on_cable = static_cast<std::uint16_t>(std::max(bus.found.size(), bus.slaves.size()));
    auto plan =
        std::make_unique<CyclePlan>(bus.plan, std::move(slaves), FaultFinder{fault_slaves(bus), on_cable, bus.config.lost_frames_limit});
    plan->state_wkc = on_cable;
    if (bus.reference) plan->reference = bus.slaves[*bus.reference]->found.station;
    return plan;
}

}  // namespace taktwerk::ecat

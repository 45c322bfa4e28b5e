#include "ecat/bringup/hand_over.hpp"

#include <algorithm>
#include <optional>

#include "ecat/dc/sync0_budget.hpp"

namespace taktwerk::ecat {

namespace {

std::size_t shared_unit(const Bus& bus, std::size_t slave) {
    if (slave >= bus.plan.slaves.size() || !bus.plan.slaves[slave].unit) return FaultSlave::none;
    const std::size_t unit = *bus.plan.slaves[slave].unit;
    return bus.plan.units[unit].slaves.size() > 1 ? unit : FaultSlave::none;
}

/// A coupler has nothing to exchange.
bool exchanges(const Bus& bus, std::size_t slave) {
    return slave >= bus.plan.slaves.size() || bus.plan.slaves[slave].outputs.size + bus.plan.slaves[slave].inputs.size > 0;
}

/// In the order of positions, so that parents come before their children.
std::vector<FaultSlave> fault_slaves(const Bus& bus) {
    std::vector<FaultSlave> slaves;
    for (const auto& slave : bus.slaves) {
        const Duration watchdog = sm_watchdog(bus.config, *slave->config) - bus.config.cycle;  // a frame had just come when the gap began
        const auto cycles = static_cast<std::uint32_t>(std::max<std::int64_t>(2, watchdog / bus.config.cycle));
        slaves.push_back({slave->index, FaultSlave::none, slave->config->guest() ? LossPolicy::stop_own_axes : slave->config->on_loss,
                          bus.reference == slave->index, slave->config->dc && slave->dc, slave->found.position,
                          shared_unit(bus, slave->index), cycles, watchdog, slave->found.station, exchanges(bus, slave->index),
                          slave->config->guest()});
    }
    const auto position = [&](const FaultSlave& s) { return std::size_t{bus.slaves[s.index]->found.position}; };
    std::sort(slaves.begin(), slaves.end(), [&](const FaultSlave& a, const FaultSlave& b) { return position(a) < position(b); });
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        if (slaves[i].guest) continue;
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

/// By position. A slave without a clock stands as far behind the one before it as that one's neighbour with a clock says, or where it is.
std::vector<std::int64_t> delays_by_position(const Bus& bus) {
    std::vector<std::optional<std::int64_t>> known(bus.found.size());
    for (const auto& slave : bus.slaves)
        if (slave->dc && slave->found.position < known.size()) known[slave->found.position] = slave->dc_delay;
    std::vector<std::int64_t> delays(known.size(), 0);
    std::size_t before = 0;
    for (std::size_t p = 0; p < known.size(); ++p) {
        if (!known[p]) continue;
        for (std::size_t between = before + 1; known[before] && between < p; ++between)
            delays[between] = *known[before] + (*known[p] - *known[before]) * static_cast<std::int64_t>(between - before) /
                                                   static_cast<std::int64_t>(p - before);
        delays[p] = *known[p];
        before = p;
    }
    for (std::size_t p = before + 1; p < delays.size(); ++p) delays[p] = delays[p - 1] + usual_hop.count();
    return delays;
}

}  // namespace

std::unique_ptr<CyclePlan> cycle_plan(const Bus& bus) {
    std::vector<CycleSlave> slaves;
    for (const auto& slave : bus.slaves)
        slaves.push_back({&slave->link, &slave->mailbox.emergency, exchange_period(bus.config, *slave->config), slave->dc_delay});
    const auto residents = static_cast<std::size_t>(
        std::count_if(bus.slaves.begin(), bus.slaves.end(), [](const auto& slave) { return !slave->config->guest(); }));
    const auto on_cable = static_cast<std::uint16_t>(std::max(bus.found.size() - bus.link.line.guests.load(), residents));
    auto plan =
        std::make_unique<CyclePlan>(bus.plan, std::move(slaves), FaultFinder{fault_slaves(bus), on_cable, bus.config.lost_frames_limit});
    plan->state_wkc = on_cable;
    if (bus.reference) {
        plan->reference = bus.slaves[*bus.reference]->found.station;
        plan->reference_position = bus.slaves[*bus.reference]->found.position;
    }
    if (bus.config.ring) plan->ring_delays = delays_by_position(bus);
    return plan;
}

}  // namespace taktwerk::ecat

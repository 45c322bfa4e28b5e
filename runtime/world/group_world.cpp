#include "runtime/world/group_world.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/group_presence.hpp"
#include "runtime/present_slaves.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::runtime {

void GroupWorld::build(const MachineConfig& config) {
    for (const auto& name : group_names(config.bus)) {
        Group group;
        const auto& all = config.simulation.groups;
        if (const auto found = std::ranges::find(all, name, &GroupSimulation::group); found != all.end()) group.simulation = *found;
        group.simulation.group = name;
        for (const auto& slave : present_slaves(config))
            if (slave.hot_connect == name) group.slaves.push_back(slave.name);
        for (const auto& binding : config.axes)
            if (binding.axis.name == group.simulation.axis) group.counts_per_unit = binding.axis.gearing.counts_per_unit();
        if (!group.simulation.connected) plug(group, false);
        groups_.push_back(std::move(group));
    }
}

void GroupWorld::plug(Group& group, bool plugged) {
    if (group.connected == plugged || group.slaves.empty()) return;
    group.connected = plugged;
    for (const auto& slave : group.slaves) world_.set_slave_power(slave, plugged);
    world_.set_cable(group.slaves.front(), plugged);
}

bool GroupWorld::reached(const Group& group) const {
    if (group.simulation.axis.empty()) return true;
    const auto* drive = world_.drive(group.simulation.axis);
    return drive != nullptr && std::abs(drive->plant().position() / group.counts_per_unit - group.simulation.at) <= group.simulation.within;
}

void GroupWorld::step() {
    for (auto& group : groups_) {
        if (group.simulation.released_by.empty()) continue;
        const bool output = world_.output(group.simulation.released_by);
        if (output && !group.output) plug(group, false);
        if (!output && group.output && reached(group)) plug(group, true);
        group.output = output;
    }
}

void GroupWorld::connect(std::string_view name, bool plugged) {
    for (auto& group : groups_)
        if (group.simulation.group == name) plug(group, plugged);
}

bool GroupWorld::connected(std::string_view name) const noexcept {
    return std::ranges::any_of(groups_, [&](const Group& group) { return group.simulation.group == name && group.connected; });
}

}  // namespace taktwerk::runtime

#include "ecat/diagnosis/running_survey.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/presence.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

void set_ports(SurveyedSlave& slave) {
    for (unsigned p = 0; p < ports_per_slave; ++p) {
        slave.ports[p].link = dl_signal(slave.found.dl_status, p);
        slave.ports[p].open = dl_port_open(slave.found.dl_status, p);
    }
}

Script<void> look_at(DatagramPort& port, SurveyedSlave& slave) {
    if (slave.found.error) co_return;
    const Reply status = co_await port.fprd(slave.found.station, reg::dl_status, 2);
    const bool counted = co_await read_counters(port, slave);
    if (!status.ok() || !counted) {
        slave.found.error = unanswered(fmt::format("slave {}", slave.found.position), "its ports (0110h) and counters (0300h)", status);
        co_return;
    }
    slave.found.dl_status = status.u16();
    set_ports(slave);
}

/// As the ports say now; what was, where they contradict each other: a cable is being pulled or plugged.
void build_tree(Survey& survey) {
    std::vector<std::uint16_t> links;
    for (const auto& slave : survey.slaves) {
        if (slave.found.error) return;
        links.push_back(slave.found.dl_status);
    }
    const bool ring = survey.ring.shape != RingShape::none;
    Result<Topology> tree = ring ? build_ring_topology(links, reached_from_first(survey.ring, links.size())) : build_topology(links);
    if (tree) survey.topology = std::move(*tree);
}

}  // namespace

const BusSlave* slave_at(const Bus& bus, std::size_t position) {
    for (const auto& slave : bus.slaves)
        if (!slave->away() && slave->position_now == position) return slave.get();
    return nullptr;
}

Survey known_survey(const Bus& bus) {
    Survey survey;
    survey.ring = bus.link.ring.load();
    const std::size_t count = bus.counted != 0 ? bus.counted : bus.found.size();
    survey.slaves.resize(count);
    bool as_found = count == bus.found.size();
    for (std::size_t position = 0; position < count; ++position) {
        auto& slave = survey.slaves[position];
        if (const auto* known = slave_at(bus, position)) {
            slave.found = known->found;
            slave.name = known->config->name;
            slave.expected = known->config->device ? known->config->device->name : std::string{};
            const auto al = known->link.al.load();
            slave.state = al_state(static_cast<std::uint16_t>(al & 0xFFFFu));
            slave.al_error = (al & al_status_error) != 0;
            slave.al_code = static_cast<std::uint16_t>(al >> 16);
            as_found = as_found && known->found.station == bus.found[position].station;
        } else if (position < bus.found.size() && as_found) {
            slave.found = bus.found[position];
        } else {
            slave.found.error = Error{"bus.unknown_slave", fmt::format("slave {}", position), "nobody knows yet who this is", ""};
        }
        slave.found.position = static_cast<std::uint16_t>(position);
        set_ports(slave);
    }
    if (as_found && bus.topology.slaves.size() == count) survey.topology = bus.topology;
    return survey;
}

Script<void> look_at_ports(Bus& bus, Survey& survey) {
    std::vector<Script<void>> scripts;
    for (auto& slave : survey.slaves) scripts.push_back(look_at(bus.port, slave));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    build_tree(survey);
}

}  // namespace taktwerk::ecat

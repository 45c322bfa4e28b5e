#include "ecat/bringup/presence.hpp"

#include <fmt/format.h>

#include <utility>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

Script<void> read_ports(Bus& bus, std::uint16_t position, std::optional<std::uint16_t>& dl_status) {
    const Reply reply = co_await bus.port.aprd(position, reg::dl_status, 2);
    if (reply.ok()) dl_status = reply.u16();
}

}  // namespace

std::vector<std::optional<std::size_t>> places_now(const Topology& known, const Topology& now) {
    std::vector<std::optional<std::size_t>> places(known.slaves.size());
    if (known.slaves.empty() || now.slaves.empty()) return places;
    places[0] = 0;
    for (std::size_t position = 0; position < known.slaves.size(); ++position) {  // parents come before their children
        if (!places[position]) continue;
        const SlavePlace& before = known.slaves[position];
        const SlavePlace& present = now.slaves[*places[position]];
        for (unsigned port = 0; port < ports_per_slave; ++port)
            if (before.child[port] && present.child[port]) places[*before.child[port]] = *present.child[port];
    }
    return places;
}

Script<void> take_census(Bus& bus) {
    for (auto& slave : bus.slaves) slave->position_now.reset();
    bus.census_wanted = true;
    const Reply count = co_await bus.port.brd(reg::type, 1);
    if (count.lost || count.wkc == 0) co_return;
    bus.counted = count.wkc;

    std::vector<std::optional<std::uint16_t>> answers(count.wkc);
    std::vector<Script<void>> scripts;
    for (std::uint16_t position = 0; position < count.wkc; ++position) scripts.push_back(read_ports(bus, position, answers[position]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    std::vector<std::uint16_t> dl_status;
    for (const auto& answer : answers) {
        if (!answer) co_return;  // somebody left meanwhile
        dl_status.push_back(*answer);
    }
    const Result<Topology> now = build_topology(dl_status);
    if (!now) co_return;
    const auto places = places_now(bus.topology, *now);
    for (auto& slave : bus.slaves) {
        const std::size_t position = slave->found.position;
        if (position < places.size() && places[position]) slave->position_now = static_cast<std::uint16_t>(*places[position]);
    }
    bus.census_wanted = false;
    ++bus.census;
}

std::string sender_text(const CycleLink& link) {
    const std::uint64_t source = link.foreign_source.load();
    std::string text = "its network address is ";
    for (int shift = 40; shift >= 0; shift -= 8) text += fmt::format("{:02x}{}", (source >> shift) & 0xFFu, shift > 0 ? ":" : "");
    return text + " (the slaves set 02h in its first byte)";
}

std::string connection_text(const Bus& bus, const BusSlave& slave) {
    const std::size_t position = slave.found.position;
    if (position >= bus.topology.slaves.size()) return {};
    const SlavePlace& place = bus.topology.slaves[position];
    if (!place.parent) return "between the master and " + slave.subject;
    std::string before = fmt::format("slave {}", *place.parent);
    for (const auto& other : bus.slaves)
        if (other->found.position == *place.parent) before = other->subject;
    return fmt::format("between {} port {} and {}", before, place.parent_port, slave.subject);
}

}  // namespace taktwerk::ecat

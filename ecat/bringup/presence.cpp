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

Result<Topology> topology_now(const Bus& bus, const std::vector<std::uint16_t>& dl_status) {
    if (!bus.config.ring) return build_topology(dl_status);
    return build_ring_topology(dl_status, reached_from_first(bus.link.ring.load(), dl_status.size()));
}

}  // namespace

std::size_t reached_from_first(const RingState& ring, std::size_t slaves) noexcept {
    switch (ring.shape) {
        case RingShape::open: return ring.before_break;
        case RingShape::first_silent: return 0;
        default: return slaves;
    }
}

std::vector<std::uint16_t> positions_now(const RingState& ring, std::uint16_t answering) {
    const auto before = std::min<std::size_t>(reached_from_first(ring, answering), answering);
    const std::size_t behind = answering - before;
    const std::size_t second = ring.whole >= answering ? ring.whole - behind : before;
    std::vector<std::uint16_t> positions;
    for (std::size_t i = 0; i < answering; ++i) positions.push_back(static_cast<std::uint16_t>(i < before ? i : second + (i - before)));
    return positions;
}

std::vector<std::optional<std::size_t>> places_now(const Topology& known, const Topology& now) {
    std::vector<std::optional<std::size_t>> places(known.slaves.size());
    if (known.slaves.empty() || now.slaves.empty()) return places;
    // Of a broken ring the slaves behind the break are found from its other end.
    if (now.behind_break < now.slaves.size()) places[0] = 0;
    if (known.ring_end && now.ring_end) {
        std::optional<std::size_t> was = known.ring_end->slave, is = now.ring_end->slave;
        while (was && is && !places[*was]) {
            places[*was] = *is;
            const bool same_way =
                known.slaves[*was].parent && now.slaves[*is].parent && known.slaves[*was].parent_port == now.slaves[*is].parent_port;
            was = same_way ? known.slaves[*was].parent : std::nullopt;
            is = same_way ? now.slaves[*is].parent : std::nullopt;
        }
    }
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

    const auto positions = positions_now(bus.link.ring.load(), count.wkc);
    std::vector<std::optional<std::uint16_t>> answers(count.wkc);
    std::vector<Script<void>> scripts;
    for (std::size_t i = 0; i < positions.size(); ++i) scripts.push_back(read_ports(bus, positions[i], answers[i]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    std::vector<std::uint16_t> dl_status;
    for (const auto& answer : answers) {
        if (!answer) co_return;  // somebody left meanwhile
        dl_status.push_back(*answer);
    }
    const Result<Topology> now = topology_now(bus, dl_status);
    if (!now) co_return;
    const auto places = places_now(bus.topology, *now);
    for (auto& slave : bus.slaves) {
        const std::size_t position = slave->found.position;
        if (position < places.size() && places[position]) slave->position_now = positions[*places[position]];
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

namespace {

std::string subject_at(const Bus& bus, std::size_t position) {
    for (const auto& slave : bus.slaves)
        if (slave->found.position == position) return slave->subject;
    return fmt::format("slave {}", position);
}

}  // namespace

std::string break_text(const Bus& bus, const RingState& ring) {
    const auto& places = bus.topology.slaves;
    if (places.empty()) return {};
    if (ring.shape == RingShape::one_way)
        return "closed, but nothing comes back of what the second interface sends: the next break takes slaves away";
    if (ring.shape == RingShape::exchanged) return "closed, but the plugs of the two interfaces are exchanged";
    const std::size_t all = places.size();
    if (ring.shape == RingShape::first_silent)
        return fmt::format("between the first interface and {} port {}", subject_at(bus, 0), places[0].entry_port);
    if (ring.shape == RingShape::second_silent) {
        const RingEnd end = bus.topology.ring_end.value_or(RingEnd{all - 1, 1});
        return fmt::format("between {} port {} and the second interface", subject_at(bus, end.slave), end.port);
    }
    const std::size_t answering = std::size_t{ring.before_break} + ring.behind_break;
    const std::size_t behind = all - std::min<std::size_t>(ring.behind_break, all);  // counted from the far end: somebody may be missing
    if (ring.before_break == 0 || behind >= all) return {};
    if (answering < all)
        return fmt::format("between {} and {}: who stands between them does not answer", subject_at(bus, ring.before_break - 1u),
                           subject_at(bus, behind));
    const SlavePlace& place = places[behind];
    return fmt::format("between {} port {} and {} port {}", place.parent ? subject_at(bus, *place.parent) : subject_at(bus, behind - 1),
                       place.parent_port, subject_at(bus, behind), place.entry_port);
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

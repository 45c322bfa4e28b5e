#include "ecat/topology/topology.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

Error broken(std::size_t position, std::string what) {
    return Error{"bus.topology", fmt::format("slave {}", position), std::move(what),
                 "a cable is half plugged, or the bus changed while it was read: check the cables at this slave and scan again"};
}

}  // namespace

unsigned SlavePlace::open_ports() const noexcept { return static_cast<unsigned>(std::count(open.begin(), open.end(), true)); }

std::vector<unsigned> SlavePlace::exits() const {
    std::vector<unsigned> ports;
    for (unsigned port = next_port(entry_port); port != entry_port; port = next_port(port))
        if (open[port]) ports.push_back(port);
    return ports;
}

std::vector<std::size_t> Topology::behind(std::size_t position) const {
    std::vector<std::size_t> result;
    if (position >= slaves.size()) return result;
    result.push_back(position);
    // Positions behind a slave follow it without a gap: the frame goes around its branches before it returns.
    for (std::size_t p = position + 1; p < slaves.size() && slaves[p].depth > slaves[position].depth; ++p) result.push_back(p);
    return result;
}

namespace {

/// Lays slaves out in the order in which they process a frame.
class TreeBuilder {
public:
    /// `root`: nothing stands between it and an interface.
    std::optional<Error> add(std::uint16_t dl_status, bool root) {
        const std::size_t position = topology_.slaves.size();
        SlavePlace place;
        for (unsigned port = 0; port < ports_per_slave; ++port) place.open[port] = dl_port_open(dl_status, port);
        const auto entry = std::find_if(port_order.begin(), port_order.end(), [&](unsigned port) { return place.open[port]; });
        if (entry == port_order.end()) return broken(position, fmt::format("answers, but no port is open (DL status {:04X}h)", dl_status));
        place.entry_port = *entry;
        if (!root) {
            if (waiting_.empty()) return broken(position, "answers, but no open port of a slave before it leads to it");
            const RingEnd branch = waiting_.back();
            waiting_.pop_back();
            place.parent = branch.slave;
            place.parent_port = branch.port;
            place.depth = topology_.slaves[branch.slave].depth + 1;
            topology_.slaves[branch.slave].child[branch.port] = position;
        }
        const std::vector<unsigned> exits = place.exits();
        for (auto port = exits.rbegin(); port != exits.rend(); ++port) waiting_.push_back({position, *port});
        topology_.slaves.push_back(place);
        return std::nullopt;
    }
    /// The slave next to a break: what was its entry is closed, and all its open ports lead on.
    std::optional<Error> add_behind_break(std::uint16_t dl_status) {
        SlavePlace place;
        for (unsigned port = 0; port < ports_per_slave; ++port) place.open[port] = dl_port_open(dl_status, port);
        const std::vector<unsigned> exits = place.exits();
        if (exits.empty())
            return broken(topology_.slaves.size(), fmt::format("answers, but no port is open (DL status {:04X}h)", dl_status));
        for (auto port = exits.rbegin(); port != exits.rend(); ++port) waiting_.push_back({topology_.slaves.size(), *port});
        topology_.slaves.push_back(place);
        return std::nullopt;
    }
    /// Every open port leads to a slave.
    [[nodiscard]] std::optional<Error> complete() const {
        if (waiting_.empty()) return std::nullopt;
        return broken(waiting_.back().slave, fmt::format("port {} is open, but no slave behind it answers", waiting_.back().port));
    }
    /// All but one, which leads to the second interface.
    [[nodiscard]] std::optional<Error> end_ring() {
        if (waiting_.empty())
            return broken(topology_.slaves.empty() ? 0 : topology_.slaves.size() - 1, "no open port leads to the second interface");
        topology_.ring_end = waiting_.front();
        waiting_.erase(waiting_.begin());
        return complete();
    }
    Topology take() { return std::move(topology_); }

private:
    Topology topology_;
    std::vector<RingEnd> waiting_;  // exits that still need a slave; the next to be taken is last
};

}  // namespace

namespace {

/// A slave in the line whose cable from the master is in an OUT socket: the frame goes on through its port 0 before it is processed there, so
/// it comes last, behind slaves that are a whole tree without it, and has a way in and a way on.
std::optional<Error> plugs_exchanged(const TreeBuilder& others, std::size_t position, std::uint16_t dl_status) {
    std::vector<unsigned> open;
    for (unsigned port = 0; port < ports_per_slave; ++port)
        if (dl_port_open(dl_status, port)) open.push_back(port);
    if (position == 0 || others.complete() || open.size() != 2 || open[0] != 0) return std::nullopt;
    return Error{"bus.plugs_exchanged", fmt::format("slave {}", position),
                 fmt::format("its plugs are exchanged: the cable from the master is in its port {} (OUT), and port 0 (IN) leads on; so it "
                             "processes frames last, and positions are not the order of the cable",
                             open[1]),
                 "exchange the two plugs at this slave"};
}

}  // namespace

Result<Topology> build_topology(std::span<const std::uint16_t> dl_status) {
    TreeBuilder tree;
    for (std::size_t position = 0; position < dl_status.size(); ++position) {
        const bool last = position + 1 == dl_status.size();
        if (auto exchanged = last ? plugs_exchanged(tree, position, dl_status[position]) : std::nullopt) return *exchanged;
        if (auto error = tree.add(dl_status[position], position == 0)) return *error;
    }
    if (auto error = tree.complete()) return *error;
    return tree.take();
}

Result<Topology> build_ring_topology(std::span<const std::uint16_t> dl_status, std::size_t before_break) {
    TreeBuilder tree;
    const bool closed = before_break >= dl_status.size();
    for (std::size_t position = 0; position < dl_status.size(); ++position) {
        if (position == before_break && position > 0)
            if (auto error = tree.complete()) return *error;
        auto error = position == before_break ? tree.add_behind_break(dl_status[position]) : tree.add(dl_status[position], position == 0);
        if (error) return *error;
    }
    // Without carrier on the cable of the second interface its port is closed, and the ring is a line.
    const bool line = closed && !tree.complete();
    if (line) return tree.take();
    if (auto error = tree.end_ring()) return *error;
    Topology topology = tree.take();
    topology.behind_break = closed ? 0 : dl_status.size() - before_break;
    return topology;
}

}  // namespace taktwerk::ecat

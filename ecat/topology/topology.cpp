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

Result<Topology> build_topology(std::span<const std::uint16_t> dl_status) {
    Topology topology;
    struct Branch {
        std::size_t slave;
        unsigned port;
    };
    std::vector<Branch> waiting;  // exits that still need a slave; the next to be taken is last
    for (std::size_t position = 0; position < dl_status.size(); ++position) {
        SlavePlace place;
        for (unsigned port = 0; port < ports_per_slave; ++port) place.open[port] = dl_port_open(dl_status[position], port);
        const auto entry = std::find_if(port_order.begin(), port_order.end(), [&](unsigned port) { return place.open[port]; });
        if (entry == port_order.end())
            return broken(position, fmt::format("answers, but no port is open (DL status {:04X}h)", dl_status[position]));
        place.entry_port = *entry;
        if (position > 0) {
            if (waiting.empty()) return broken(position, "answers, but no open port of a slave before it leads to it");
            const Branch branch = waiting.back();
            waiting.pop_back();
            place.parent = branch.slave;
            place.parent_port = branch.port;
            place.depth = topology.slaves[branch.slave].depth + 1;
            topology.slaves[branch.slave].child[branch.port] = position;
        }
        const std::vector<unsigned> exits = place.exits();
        for (auto port = exits.rbegin(); port != exits.rend(); ++port) waiting.push_back({position, *port});
        topology.slaves.push_back(place);
    }
    if (!waiting.empty())
        return broken(waiting.back().slave, fmt::format("port {} is open, but no slave behind it answers", waiting.back().port));
    return topology;
}

}  // namespace taktwerk::ecat

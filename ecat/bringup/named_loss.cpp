#include "ecat/bringup/named_loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ecat/bringup/cable_watch.hpp"
#include "ecat/bringup/port_counters.hpp"

namespace taktwerk::ecat {

namespace {

struct Asked {
    bool silent = false;
    std::optional<SlaveCounters> counters;
};

const BusSlave* known_at(const Bus& bus, std::size_t position) noexcept {
    for (const auto& slave : bus.slaves)
        if (slave->found.position == position && !slave->away()) return slave.get();
    return nullptr;
}

Script<void> ask_at(Bus& bus, std::size_t position, Asked& asked) {
    const auto* slave = known_at(bus, position);  // one of a group has an address of its own
    const std::uint16_t station = slave != nullptr ? slave->found.station : bus.found[position].station;
    const Reply reply = co_await bus.port.fprd(station, reg::al_status, 2);
    asked.silent = !reply.lost && reply.wkc == 0;
    if (!asked.silent) asked.counters = co_await read_port_counters(bus.port, station);
}

std::string named(const Bus& bus, std::size_t position) {
    const auto* slave = known_at(bus, position);
    return slave != nullptr ? slave->subject : fmt::format("slave {}", position);
}

std::string cable_to(const Bus& bus, std::size_t position) {
    const SlavePlace& place = bus.topology.slaves[position];
    if (!place.parent) return "between the master and " + named(bus, position);
    return fmt::format("between {} port {} and {}", named(bus, *place.parent), place.parent_port, named(bus, position));
}

Error nothing_comes_back(const Bus& bus) {
    constexpr const char* remedy = "check the cable between this computer and the first slave, and the power of that slave";
    if (!bus.link.line.link_up.load()) return Error{"bus.no_link", "bus", "the network port lost its link while the bus came up", remedy};
    return Error{"bus.no_frame", "bus", "frames stopped coming back while the bus came up", remedy};
}

std::optional<Error> first_silent(const Bus& bus, const std::vector<Asked>& asked) {
    const auto gone = std::count_if(asked.begin(), asked.end(), [](const Asked& one) { return one.silent; });
    for (std::size_t position = 0; position < asked.size(); ++position) {
        const auto parent = bus.topology.slaves[position].parent;
        if (!asked[position].silent || (parent && asked[*parent].silent)) continue;
        return Error{"bus.no_slave", named(bus, position),
                     fmt::format("it fell silent while the bus came up: {}{}", cable_to(bus, position),
                                 gone > 1 ? fmt::format("; {} slaves do not answer, it is the first of them", gone) : ""),
                     "check its power and the cable that is named"};
    }
    return std::nullopt;
}

/// A frame that came damaged is counted at the end of the cable where it came in.
std::optional<Error> damaging_cable(const Bus& bus, const std::vector<Asked>& asked) {
    const auto errors_at = [&](std::size_t position, unsigned port) {
        return asked[position].counters ? asked[position].counters->ports[port].own_errors() : 0u;
    };
    unsigned worst = 0;
    std::size_t at = 0;
    for (std::size_t position = 0; position < asked.size(); ++position) {
        const SlavePlace& place = bus.topology.slaves[position];
        const unsigned errors = errors_at(position, place.entry_port) + (place.parent ? errors_at(*place.parent, place.parent_port) : 0u);
        if (errors > worst) worst = errors, at = position;
    }
    if (!CableRise{.errors = worst}.worth_telling()) return std::nullopt;
    return Error{"bus.cable_errors", named(bus, at),
                 fmt::format("frames get lost: {} were damaged on the cable {} while the bus came up", worst, cable_to(bus, at)),
                 "replace the cable that is named, and look at its plugs, its shield and its way"};
}

}  // namespace

Script<Error> named_loss(Bus& bus, Error failure) {
    const bool lost = failure.code == "bus.no_frame";
    if ((!lost && failure.code != "bus.no_slave") || bus.config.ring) co_return failure;
    if (bus.found.empty() || bus.topology.slaves.size() != bus.found.size()) co_return failure;
    const Reply count = co_await bus.port.brd(reg::type, 1);
    if (count.lost) co_return nothing_comes_back(bus);
    std::vector<Asked> asked(bus.found.size());
    std::vector<Script<void>> scripts;
    for (std::size_t position = 0; position < asked.size(); ++position) scripts.push_back(ask_at(bus, position, asked[position]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    if (count.wkc < bus.found.size())
        if (auto silent = first_silent(bus, asked)) co_return std::move(*silent);
    if (!lost) co_return failure;  // all are there: one has lost its address
    if (auto cable = damaging_cable(bus, asked)) co_return std::move(*cable);
    if (failure.subject == "bus") co_return failure;
    // Whose datagram it was that got lost says nothing about him.
    co_return Error{"bus.no_frame", "bus",
                    fmt::format("frames get lost, and no slave counted a damaged one ({}: {})", failure.subject, failure.what),
                    "check the cable between this computer and the first slave, and the network port; a computer that stood still says so "
                    "(late_wakeups)"};
}

}  // namespace taktwerk::ecat

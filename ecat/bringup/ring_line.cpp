#include "ecat/bringup/ring_line.hpp"

#include <fmt/format.h>

namespace taktwerk::ecat {

namespace {

/// Two bits a port in 0101h.
constexpr unsigned closed = 3;

Script<void> read_ports_at(Bus& bus, std::uint16_t position, std::optional<std::uint16_t>& dl_status) {
    const Reply reply = co_await bus.port.aprd(position, reg::dl_status, 2);
    if (reply.ok()) dl_status = reply.u16();
}

/// `slaves`: that answer.
Error ring_broken(const RingState& ring, std::uint16_t slaves) {
    if (ring.shape == RingShape::exchanged)
        return Error{"bus.ring_exchanged", "bus",
                     "the plugs of the two interfaces are exchanged: the first slave's cable is in the second interface",
                     "exchange the plugs, or `interface` and `interface2` in the machine file"};
    if (ring.shape == RingShape::one_way)
        return Error{"bus.ring_broken", "bus", "nothing comes back of what the second interface sends, although the ring is closed",
                     "check that interface: the next break would take slaves away"};
    const std::string where = ring.shape == RingShape::first_silent ? "in front of the first slave"
                              : ring.shape == RingShape::second_silent
                                  ? fmt::format("behind slave {}, the last that answers", slaves - 1)
                                  : fmt::format("between slave {} and slave {}", ring.before_break - 1, ring.before_break);
    return Error{
        "bus.ring_broken", "bus", "the ring is broken " + where,
        "mend the cable: the bring-up measures the whole ring. To start on the line that is left, remove `ring` and plug the cables "
        "so that one interface reaches all slaves"};
}

/// The ports contradict each other, or somebody is silent: it broke while they were read.
Script<Error> broken_meanwhile(Bus& bus, std::uint16_t slaves, Error failure) {
    co_await bus.port.brd(reg::type, 1);
    const RingState ring = bus.link.ring.load();
    co_return ring.shape == RingShape::closed ? std::move(failure) : ring_broken(ring, slaves);
}

}  // namespace

Script<Result<void>> make_line(Bus& bus, std::uint16_t slaves) {
    if (!bus.config.ring) co_return Result<void>{};
    bus.progress = "measuring the ring";
    const RingState ring = bus.link.ring.load();
    if (ring.shape != RingShape::closed) co_return ring_broken(ring, slaves);
    std::vector<std::optional<std::uint16_t>> answers(slaves);
    std::vector<Script<void>> scripts;
    for (std::uint16_t position = 0; position < slaves; ++position) scripts.push_back(read_ports_at(bus, position, answers[position]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    std::vector<std::uint16_t> dl_status;
    for (std::uint16_t position = 0; position < slaves; ++position) {
        if (!answers[position])
            co_return co_await broken_meanwhile(
                bus, slaves,
                Error{"bus.no_slave", fmt::format("slave {}", position), "did not answer when its ports were asked for",
                      "the bus changed while it was read: start again"});
        dl_status.push_back(*answers[position]);
    }
    const Result<Topology> tree = build_ring_topology(dl_status, slaves);
    if (!tree) co_return co_await broken_meanwhile(bus, slaves, tree.error());
    bus.ring_end = tree->ring_end;
    bus.line_of = slaves;
    if (!bus.ring_end) co_return ring_broken({RingShape::second_silent, slaves, 0, 0}, slaves);
    const auto position = static_cast<std::uint16_t>(bus.ring_end->slave);
    const Reply shut =
        co_await bus.port.apwr(position, reg::dl_control_loops, static_cast<std::uint8_t>(closed << (2 * bus.ring_end->port)));
    if (!shut.ok())
        co_return Error{"bus.no_slave", fmt::format("slave {}", position), "did not close its port to the second interface (0101h)",
                        "start again; should it stay so, its controller does not let ports be closed"};
    co_return Result<void>{};
}

Script<Result<void>> make_ring(Bus& bus) {
    if (!bus.ring_end) co_return Result<void>{};
    const auto position = static_cast<std::uint16_t>(bus.ring_end->slave);
    const Reply opened = co_await bus.port.apwr(position, reg::dl_control_loops, std::uint8_t{0});
    // A port that stays closed is a break that no cable mends.
    if (!opened.ok()) co_return unanswered(fmt::format("slave {}", position), "its port to the second interface (0101h)", opened);
    bus.topology.ring_end = bus.ring_end;
    bus.ring_end.reset();
    co_return Result<void>{};
}

Script<Error> named_break(Bus& bus, Error failure) {
    if (!bus.ring_end) co_return failure;
    const Reply count = co_await bus.port.brd(reg::type, 1);
    if (count.lost) co_return ring_broken({RingShape::first_silent, 0, 0, 0}, bus.line_of);
    if (count.wkc == 0 || count.wkc >= bus.line_of) co_return failure;
    co_return ring_broken({RingShape::open, count.wkc, 0, 0}, bus.line_of);
}

}  // namespace taktwerk::ecat

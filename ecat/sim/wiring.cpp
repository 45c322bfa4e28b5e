#include "ecat/sim/wiring.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::ecat::sim {

namespace {

bool linked(const Place& place) noexcept {
    return place.plugged && place.slave->powered() && (place.parent == nullptr || place.parent->slave->powered());
}

}  // namespace

Place& Wiring::add(std::unique_ptr<SimSlave> slave, Place* parent, unsigned port, unsigned entry_port, const SlaveDelays& delays,
                   Duration cable) {
    places_.push_back(std::make_unique<Place>());
    Place& place = *places_.back();
    place.slave = std::move(slave);
    place.parent = parent;
    place.parent_port = port;
    place.entry_port = entry_port;
    place.delays = delays;
    place.cable = cable;
    place.slave->controller().add_socket(entry_port);
    if (parent != nullptr) {
        parent->child[port] = &place;
        parent->slave->controller().add_socket(port);
    }
    order_.clear();
    count(*places_.front());
    for (auto& route : routes_) route.visits.reserve(places_.size());
    return place;
}

Place* Wiring::find(const SimSlave& slave) const noexcept {
    const auto at = std::find_if(places_.begin(), places_.end(), [&](const auto& place) { return place->slave.get() == &slave; });
    return at == places_.end() ? nullptr : at->get();
}

void Wiring::close_ring(Place& last, unsigned port, Duration cable) {
    ring_ = {&last, port};
    ring_cable_ = cable;
    last.slave->controller().add_socket(port);
}

void Wiring::count(Place& place) {
    // Once around the ring from the entry; the slave itself counts where the frame passes its processing unit.
    unsigned port = place.entry_port;
    do {
        if (port != place.entry_port && place.child[port] != nullptr) count(*place.child[port]);
        if (port == 0) order_.push_back(&place);
        port = next_port(port);
    } while (port != place.entry_port);
}

bool Wiring::ring_linked() const noexcept { return ring_.place != nullptr && ring_plugged_ && ring_.place->slave->powered(); }

std::uint8_t Wiring::links_of(const Place& place) const noexcept {
    unsigned links = linked(place) ? 1u << place.entry_port : 0u;
    for (unsigned p = 0; p < ports_per_slave; ++p)
        if (place.child[p] != nullptr && linked(*place.child[p])) links |= 1u << p;
    if (ring_.place == &place && ring_linked()) links |= 1u << ring_.number;
    return static_cast<std::uint8_t>(links);
}

void Wiring::update() noexcept {
    for (const auto& place : places_) {
        place->passage = {};
        if (place->slave->powered()) place->slave->set_links(links_of(*place));
    }
    for (const auto end : {CableEnd::first, CableEnd::second}) follow(end);
}

/// Inside a slave, from the port where the frame came in to the one where it leaves; closed ones send it on.
unsigned Wiring::pass(Place& place, unsigned port, Duration& at, Route& route) noexcept {
    const Ports& ports = place.slave->controller().ports();
    const Duration arrived = at;
    Duration delay = place.delays.back;
    unsigned out = port;
    do {
        if (out == 0) {
            route.visits.push_back({&place, arrived, ports.closed_itself(0)});
            delay = place.delays.forward;
        }
        out = next_port(out);
    } while (out != port && !ports.open(out));
    at += delay;
    return out;
}

void Wiring::follow(CableEnd from) noexcept {
    Route& route = routes_[number(from)];
    route.visits.clear();
    route.flight.reset();
    route.enters = false;
    if (places_.empty()) return;
    Place& first = *places_.front();
    const bool plugged = from == CableEnd::first ? linked(first) : ring_linked();
    Port to = from == CableEnd::first ? Port{&first, first.entry_port} : ring_;
    Duration at = from == CableEnd::first ? first.cable : ring_cable_;
    if (!plugged) return;
    for (;;) {
        // The neighbour keeps its side shut: nobody sends the frame back.
        if (!to.place->slave->controller().ports().takes_frame(to.number)) return;
        route.enters = true;
        auto& passage = to.place->passage[number(from)];
        passage.arrival[to.number] = at;
        passage.arrives = static_cast<std::uint8_t>(passage.arrives | (1u << to.number));
        Place& here = *to.place;
        const unsigned out = pass(here, to.number, at, route);
        if (ring_.place == &here && out == ring_.number) {
            if (!ring_linked()) return;
            route.flight = at + ring_cable_;
            route.leaves = CableEnd::second;
            return;
        }
        if (out == here.entry_port) {
            if (!linked(here)) return;
            at += here.cable;
            to = {here.parent, here.parent_port};
            if (to.place != nullptr) continue;
            route.flight = at;
            route.leaves = CableEnd::first;
            return;
        }
        Place* child = here.child[out];
        if (child == nullptr || !linked(*child)) return;  // held open without a neighbour
        at += child->cable;
        to = {child, child->entry_port};
    }
}

}  // namespace taktwerk::ecat::sim

#include "ecat/sim/wiring.hpp"

#include <algorithm>
#include <utility>

namespace taktwerk::ecat::sim {

namespace {

bool linked(const Place& place) noexcept {
    return place.plugged && place.slave->powered() && (place.parent == nullptr || place.parent->slave->powered());
}

std::uint8_t links_of(const Place& place) noexcept {
    unsigned links = linked(place) ? 1u << place.entry_port : 0u;
    for (unsigned p = 0; p < ports_per_slave; ++p)
        if (place.child[p] != nullptr && linked(*place.child[p])) links |= 1u << p;
    return static_cast<std::uint8_t>(links);
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
    number(*places_.front());
    route_.reserve(places_.size());
    return place;
}

Place* Wiring::find(const SimSlave& slave) const noexcept {
    const auto at = std::find_if(places_.begin(), places_.end(), [&](const auto& place) { return place->slave.get() == &slave; });
    return at == places_.end() ? nullptr : at->get();
}

void Wiring::number(Place& place) {
    // Once around the ring from the entry; the slave itself counts where the frame passes its processing unit.
    unsigned port = place.entry_port;
    do {
        if (port != place.entry_port && place.child[port] != nullptr) number(*place.child[port]);
        if (port == 0) order_.push_back(&place);
        port = next_port(port);
    } while (port != place.entry_port);
}

void Wiring::update() noexcept {
    for (const auto& place : places_) {
        place->arrives = 0;
        if (place->slave->powered()) place->slave->set_links(links_of(*place));
    }
    route_.clear();
    flight_.reset();
    if (places_.empty()) return;
    Place& first = *places_.front();
    if (!linked(first) || !first.slave->controller().ports().takes_frame(first.entry_port)) return;
    if (const auto back = walk(first, first.cable)) flight_ = *back + first.cable;
}

std::optional<Duration> Wiring::walk(Place& place, Duration at) noexcept {
    const auto arrive = [&](unsigned port, Duration when) {
        place.arrival[port] = when;
        place.arrives = static_cast<std::uint8_t>(place.arrives | (1u << port));
    };
    const Ports& ports = place.slave->controller().ports();
    unsigned port = place.entry_port;
    arrive(port, at);
    for (;;) {
        // On to the next open port; closed ones send the frame on inside.
        Duration delay = place.delays.back;
        do {
            if (port == 0) {
                route_.push_back({&place, at, ports.closed_itself(0)});
                delay = place.delays.forward;
            }
            port = next_port(port);
        } while (port != place.entry_port && !ports.open(port));
        at += delay;
        if (port == place.entry_port) return at;

        Place* child = place.child[port];
        // Held open without a neighbour, or the neighbour keeps its side shut: nobody sends the frame back.
        if (child == nullptr || !linked(*child) || !child->slave->controller().ports().takes_frame(child->entry_port)) return std::nullopt;
        const auto back = walk(*child, at + child->cable);
        if (!back) return std::nullopt;
        at = *back + child->cable;
        arrive(port, at);
    }
}

}  // namespace taktwerk::ecat::sim

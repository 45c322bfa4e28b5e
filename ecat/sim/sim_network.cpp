#include "ecat/sim/sim_network.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/bytes.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::uint16_t circulating_bit = 1u << 14;  // of a datagram's length word

void mark_circulating(MutableDatagram& datagram) noexcept {
    store_le<std::uint16_t>(datagram.header, 6, static_cast<std::uint16_t>(load_le<std::uint16_t>(datagram.header, 6) | circulating_bit));
    datagram.circulating = true;
}

}  // namespace

SimSlave& SimNetwork::add(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options) {
    const unsigned port = last_ != nullptr && last_->entry_port == 1 ? 0 : 1;
    return install(last_, port, std::make_unique<SimSlave>(std::move(description), std::move(model), std::move(options)), 0);
}

SimSlave& SimNetwork::add_behind(SimSlave& parent, unsigned port, std::shared_ptr<const DeviceDescription> description,
                                 std::unique_ptr<DeviceModel> model, SlaveOptions options, unsigned entry_port) {
    assert(port_free(parent, port) && entry_port < ports_per_slave);
    return install(wiring_.find(parent), port, std::make_unique<SimSlave>(std::move(description), std::move(model), std::move(options)),
                   entry_port);
}

SimSlave& SimNetwork::install(Place* parent, unsigned port, std::unique_ptr<SimSlave> slave, unsigned entry_port) {
    slave->power_on(now_);
    last_ = &wiring_.add(std::move(slave), parent, port, entry_port, timing_.slave, timing_.cable);
    wiring_.update();
    schedule();
    return *last_->slave;
}

bool SimNetwork::port_free(const SimSlave& parent, unsigned port) const noexcept {
    const Place* place = wiring_.find(parent);
    return place != nullptr && port < ports_per_slave && port != place->entry_port && place->child[port] == nullptr;
}

std::size_t SimNetwork::position(const SimSlave& slave) const noexcept {
    const auto places = wiring_.places();
    const auto at = std::find_if(places.begin(), places.end(), [&](const Place* place) { return place->slave.get() == &slave; });
    return static_cast<std::size_t>(at - places.begin());
}

void SimNetwork::set_power(SimSlave& slave, bool on) {
    if (on == slave.powered()) return;
    if (on) slave.power_on(now_);
    else slave.power_off(now_);
    wiring_.update();
    schedule();
}

void SimNetwork::set_cable(const SimSlave& slave, bool plugged) {
    wiring_.find(slave)->plugged = plugged;
    wiring_.update();
}

FrameSink& SimNetwork::close_ring(const SimSlave& last, unsigned port) {
    assert(port_free(last, port));
    wiring_.close_ring(*wiring_.find(last), port, timing_.cable);
    wiring_.update();
    return second_end_;
}

void SimNetwork::set_ring_cable(bool plugged) {
    wiring_.plug_ring(plugged);
    wiring_.update();
}

void SimNetwork::set_cable_delay(const SimSlave& slave, Duration one_way) {
    wiring_.find(slave)->cable = one_way;
    wiring_.update();
}

void SimNetwork::set_delays(const SimSlave& slave, const SlaveDelays& delays) {
    wiring_.find(slave)->delays = delays;
    wiring_.update();
}

void SimNetwork::disturb(const SimSlave& slave, std::uint32_t frames) noexcept {
    damaged_ = wiring_.find(slave);
    damage_ = frames;
}

void SimNetwork::count_damage(const Place& where, CableEnd from) noexcept {
    const Duration since = where.passage[number(from)].arrival[where.entry_port];
    for (const Place* place : wiring_.places()) {
        const auto& passage = place->passage[number(from)];
        for (unsigned p = 0; p < ports_per_slave; ++p) {
            if ((passage.arrives & (1u << p)) == 0 || passage.arrival[p] < since) continue;
            if (place == &where && p == where.entry_port) place->slave->controller().count_receive_error(p);
            else place->slave->controller().count_forwarded_error(p);
        }
    }
}

void SimNetwork::fire_until(Instant now) noexcept {
    schedule();  // a test may have touched a slave directly
    while (next_event_ <= now) {
        // The earliest event anywhere; of two at the same instant the slave nearer to the master first.
        SimSlave* first = wiring_.places().front()->slave.get();
        for (const Place* place : wiring_.places())
            if (place->slave->next_event() < first->next_event()) first = place->slave.get();
        first->fire(first->next_event());
        if (first->controller().take_loop_change()) wiring_.update();
        schedule();
    }
    now_ = std::max(now_, now);
}

void SimNetwork::schedule() noexcept {
    next_event_ = never;
    for (const Place* place : wiring_.places()) next_event_ = std::min(next_event_, place->slave->next_event());
}

void SimNetwork::advance(Instant now) noexcept {
    if (now < now_) return;
    fire_until(now);
    for (const Place* place : wiring_.places()) place->slave->settle(now);
}

std::optional<std::size_t> SimNetwork::take_apart(std::span<std::byte> frame) noexcept {
    if (frame.size() > max_frame_size) return std::nullopt;
    FrameEditor editor{frame};
    std::size_t n = 0;
    while (n < datagrams_.size()) {
        const auto datagram = editor.next();
        if (!datagram) break;
        datagrams_[n++] = *datagram;
    }
    if (editor.error() != FrameError::none) return std::nullopt;
    return n;
}

std::optional<Duration> SimNetwork::process(std::span<std::byte> frame, Instant now, CableEnd from) noexcept {
    fire_until(now);
    last_left_elsewhere_ = false;
    const Route& route = wiring_.route(from);
    if (lose_ > 0) {
        --lose_;
        return std::nullopt;
    }
    if (!route.enters || frame.size() < ethernet_header_size) return std::nullopt;

    // A frame with a defect passes: the controllers count it and execute only what is sound as a whole.
    const auto sound = take_apart(frame);
    const std::span<MutableDatagram> datagrams{datagrams_.data(), sound.value_or(0)};
    // A damaged frame does nothing from the place of the damage on.
    const bool damaged = damage_ > 0 && damaged_->passage[number(from)].arrives != 0;
    const Duration good_until = damaged ? damaged_->passage[number(from)].arrival[damaged_->entry_port] : Duration::max();
    bool loops_changed = false, destroyed = damaged;
    for (const Visit& visit : route.visits) {
        if (visit.at >= good_until) break;
        if (visit.port_0_shut) {
            // The second time a frame finds port 0 shut it would go round for ever.
            if (!datagrams.empty() && datagrams.front().circulating) {
                destroyed = true;
                break;
            }
            for (auto& datagram : datagrams) mark_circulating(datagram);
        }
        SimSlave& slave = *visit.place->slave;
        if (!sound) slave.controller().count_processing_unit_error();
        slave.process(datagrams, now + visit.at);
        loops_changed |= slave.controller().take_loop_change();
    }
    for (const Visit& visit : route.visits) {
        const auto& passage = visit.place->passage[number(from)];
        visit.place->slave->frame_passed(now, passage.arrival, passage.arrives);
    }
    if (damaged) {
        --damage_;
        count_damage(*damaged_, from);
    }
    // Every processing unit marks what it forwards: locally administered source address.
    if (!route.visits.empty()) frame[6] |= std::byte{0x02};
    const auto flight = destroyed ? std::nullopt : route.flight;
    last_left_elsewhere_ = route.leaves != from;
    if (loops_changed) wiring_.update();
    schedule();
    return flight;
}

}  // namespace taktwerk::ecat::sim

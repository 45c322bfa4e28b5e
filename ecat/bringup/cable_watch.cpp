#include "ecat/bringup/cable_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ecat/bringup/presence.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration look_period = std::chrono::seconds{60} / CableHistory::looks;

/// Each counter stops, and begins at 0 when its slave does.
std::uint8_t rise(unsigned now, unsigned before) noexcept {
    return static_cast<std::uint8_t>(std::min(now > before ? now - before : 0u, 255u));
}

/// What would make counters rise that are no matter of a bad cable, as one number that changes with it.
struct Quiet {
    std::uint32_t census = 0;
    std::uint16_t answering = 0;
    bool ring_broken = false;
    friend bool operator==(const Quiet&, const Quiet&) = default;
};

Quiet quiet_of(const Bus& bus) noexcept { return {bus.census, bus.link.slaves_answering.load(), bus.link.ring.load().broken()}; }

}  // namespace

void CableHistory::add(const SlaveCounters& now) noexcept {
    auto& slot = rises_[next_];
    next_ = (next_ + 1) % looks;
    slot = {};
    for (std::size_t p = 0; based_ && p < ports_per_slave; ++p) {
        slot[p].errors = rise(now.ports[p].own_errors(), base_.ports[p].own_errors());
        slot[p].lost_links = rise(now.ports[p].lost_links, base_.ports[p].lost_links);
    }
    base_ = now;
    based_ = true;
}

bool CableHistory::full() const noexcept {
    return based_ && std::any_of(base_.ports.begin(), base_.ports.end(), [](const PortCounters& p) {
               return std::max({p.invalid_frames, p.rx_errors, p.forwarded_errors, p.lost_links}) >= nearly_full;
           });
}

CableRise CableHistory::lately(unsigned port) const noexcept {
    CableRise sum;
    for (const auto& look : rises_) {
        sum.lost_links += look[port].lost_links;
        sum.errors += look[port].errors;
    }
    return sum;
}

namespace {

class CableWatch {
public:
    explicit CableWatch(Bus& bus) : bus_(bus), histories_(bus.slaves.size()), at_(bus.topology.slaves.size()) {
        for (std::size_t i = 0; i < bus.slaves.size(); ++i)
            if (bus.slaves[i]->found.position < at_.size()) at_[bus.slaves[i]->found.position] = i;
    }
    Script<void> run();

private:
    Script<void> look();
    void forget_bases() noexcept {
        for (auto& history : histories_) history.forget_base();
    }
    void tell() noexcept;
    [[nodiscard]] CableErrors worst_at(std::size_t slave) const noexcept;
    [[nodiscard]] const CableHistory* history_at(std::optional<std::size_t> position) const noexcept {
        return position && *position < at_.size() && at_[*position] ? &histories_[*at_[*position]] : nullptr;
    }

    Bus& bus_;
    std::vector<CableHistory> histories_;
    std::vector<std::optional<std::size_t>> at_;  // by position: index of the slave; none: nobody configured it
    Quiet quiet_{};
};

Script<void> CableWatch::run() {
    Instant looked = co_await time();
    quiet_ = quiet_of(bus_);
    co_await look();  // where the counters stand
    for (;;) {
        const Instant now = co_await pause(look_period / 10);
        if (quiet_of(bus_) != quiet_) forget_bases();
        quiet_ = quiet_of(bus_);
        if (now - looked < look_period || bus_.link.lost_in_a_row.load() != 0) continue;
        looked = now;
        co_await look();
        // Whoever fell or came back while they were read has an alarm of its own.
        if (quiet_of(bus_) == quiet_) tell();
    }
}

/// One slave after the other: there is no hurry, and others want datagrams, too.
Script<void> CableWatch::look() {
    for (std::size_t i = 0; i < histories_.size(); ++i) {
        const auto& slave = *bus_.slaves[i];
        std::optional<SlaveCounters> counters;
        if (slave.link.presence.load() == Presence::answers) counters = co_await read_port_counters(bus_.port, slave.found.station);
        if (quiet_of(bus_) != quiet_) co_return;
        if (!counters) {
            histories_[i].forget_base();
            continue;
        }
        histories_[i].add(*counters);
        if (!histories_[i].full()) continue;
        co_await clear_port_counters(bus_.port, slave.found.station);
        histories_[i].forget_base();
    }
}

void CableWatch::tell() noexcept {
    for (std::size_t i = 0; i < histories_.size(); ++i) bus_.slaves[i]->link.cable.store(worst_at(i));
}

/// A cable is told once, at its end away from the master, with what both ends counted: each counts what arrives, and both count a lost link.
CableErrors CableWatch::worst_at(std::size_t slave) const noexcept {
    const auto position = bus_.slaves[slave]->found.position;
    if (position >= at_.size()) return {};
    const auto& place = bus_.topology.slaves[position];
    CableRise worst;
    unsigned worst_port = 0;
    for (unsigned p = 0; p < ports_per_slave; ++p) {
        if (p != place.entry_port && history_at(place.child[p]) != nullptr) continue;
        auto rise = histories_[slave].lately(p);
        if (const auto* other = p == place.entry_port ? history_at(place.parent) : nullptr) {
            const auto there = other->lately(place.parent_port);
            rise = {std::max(rise.lost_links, there.lost_links), rise.errors + there.errors};
        }
        if (!rise.worth_telling() || !rise.worse_than(worst)) continue;
        worst = rise;
        worst_port = p;
    }
    return {static_cast<std::uint8_t>(worst_port), static_cast<std::uint8_t>(std::min(worst.lost_links, 255u)),
            static_cast<std::uint16_t>(std::min(worst.errors, 0xFFFFu))};
}

}  // namespace

Script<void> watch_cables(Bus& bus) {
    CableWatch watch{bus};
    co_await watch.run();
}

std::string cable_text(const Bus& bus, const BusSlave& slave, unsigned port) {
    if (slave.found.position >= bus.topology.slaves.size()) return {};
    const SlavePlace& place = bus.topology.slaves[slave.found.position];
    if (port == place.entry_port) return "the cable " + connection_text(bus, slave);
    for (const auto& other : bus.slaves)
        if (port < ports_per_slave && place.child[port] == other->found.position) return "the cable " + connection_text(bus, *other);
    if (bus.ring_end == RingEnd{slave.found.position, port})
        return "the cable from its port " + std::to_string(port) + " to the second interface";
    return "the plug at its port " + std::to_string(port);
}

}  // namespace taktwerk::ecat

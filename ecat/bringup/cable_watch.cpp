#include "ecat/bringup/cable_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ecat/bringup/presence.hpp"

namespace taktwerk::ecat {

namespace {

/// From one look to the next: three damaged frames or a lost link are told within two seconds.
constexpr Duration look_period = std::chrono::milliseconds{500};
/// Of a long bus a look takes its time; then others have the wire for as long.
constexpr std::int64_t share_of_looks = 2;
/// What is read is in the cycle's next frame; some more, because that one may get lost.
constexpr Duration least_settling = std::chrono::milliseconds{20};
constexpr std::int64_t settling_cycles = 5;

/// Each counter stops, and begins at 0 when its slave does.
std::uint16_t rise(unsigned now, unsigned before) noexcept { return static_cast<std::uint16_t>(now > before ? now - before : 0u); }

void add_to(std::uint16_t& sum, unsigned more) noexcept { sum = static_cast<std::uint16_t>(std::min(sum + more, 0xFFFFu)); }

std::int64_t number_of_span(Instant at) noexcept { return at.time_since_epoch() / CableHistory::span; }

/// What would make counters rise that are no matter of a bad cable, as numbers that change with it: also when it is over again.
struct Quiet {
    std::uint32_t census = 0, upheavals = 0;
    std::uint32_t silences = 0;  ///< frames that get lost may be damaged ones; a link that was away then has its alarm
    [[nodiscard]] bool same_slaves(const Quiet& other) const noexcept { return census == other.census && upheavals == other.upheavals; }
    friend bool operator==(const Quiet&, const Quiet&) = default;
};

Quiet quiet_of(const Bus& bus) noexcept { return {bus.census, bus.link.line.upheavals.load(), bus.link.line.silences.load()}; }

}  // namespace

CableHistory::Span& CableHistory::span_of(Instant at) noexcept {
    const std::int64_t number = number_of_span(at);
    auto& there = spans_[static_cast<std::size_t>(number) % spans];
    if (there.number != number) there = {.number = number, .ports = {}};
    return there;
}

void CableHistory::add(const SlaveCounters& now, Instant at) noexcept {
    auto& here = span_of(at);
    for (std::size_t p = 0; p < ports_per_slave; ++p) {
        if (based_) add_to(here.ports[p].errors, rise(now.ports[p].own_errors(), base_.ports[p].own_errors()));
        if (links_based_) add_to(here.ports[p].lost_links, rise(now.ports[p].lost_links, base_.ports[p].lost_links));
    }
    base_ = now;
    based_ = links_based_ = true;
}

bool CableHistory::full() const noexcept {
    return based_ && std::any_of(base_.ports.begin(), base_.ports.end(), [](const PortCounters& p) {
               return std::max({p.invalid_frames, p.rx_errors, p.forwarded_errors, p.lost_links}) >= nearly_full;
           });
}

CableRise CableHistory::lately(unsigned port, Instant now) const noexcept {
    const std::int64_t oldest = number_of_span(now) - static_cast<std::int64_t>(spans) + 1;
    CableRise sum;
    for (const auto& one : spans_) {
        if (one.number < oldest) continue;
        sum.lost_links += one.ports[port].lost_links;
        sum.errors += one.ports[port].errors;
    }
    return sum;
}

namespace {

class CableWatch {
public:
    explicit CableWatch(Bus& bus) : bus_(bus), histories_(bus.slaves.size()), read_(bus.slaves.size()), at_(bus.topology.slaves.size()) {
        for (std::size_t i = 0; i < bus.slaves.size(); ++i)
            if (bus.slaves[i]->found.position < at_.size()) at_[bus.slaves[i]->found.position] = i;
    }
    Script<void> run();

private:
    Script<void> look();
    Script<void> read(std::size_t slave);
    Script<void> settle();
    void forget_what_is_explained() noexcept;
    void take(Instant now) noexcept;
    Script<void> clear_the_full();
    void tell(Instant now) noexcept;
    [[nodiscard]] Duration period() const noexcept;
    [[nodiscard]] CableErrors worst_at(std::size_t slave, Instant now) const noexcept;
    [[nodiscard]] const CableHistory* history_at(std::optional<std::size_t> position) const noexcept {
        return position && *position < at_.size() && at_[*position] ? &histories_[*at_[*position]] : nullptr;
    }

    Bus& bus_;
    std::vector<CableHistory> histories_;
    std::vector<std::optional<SlaveCounters>> read_;  // of this look; none: it did not answer
    std::vector<std::optional<std::size_t>> at_;      // by position: index of the slave; none: nobody configured it
    Quiet quiet_{};                                   // when this look began
};

/// So many slaves are asked side by side as the cycle takes datagrams; each answer is two cycles under way.
Duration CableWatch::period() const noexcept {
    const auto at_once = std::max<std::int64_t>(bus_.config.acyclic_per_cycle, 1);
    const Duration sweep = 2 * static_cast<std::int64_t>(bus_.slaves.size()) * bus_.config.cycle / at_once;
    return std::max(look_period, share_of_looks * sweep);
}

Script<void> CableWatch::run() {
    Instant looked = co_await time();
    quiet_ = quiet_of(bus_);
    co_await look();  // where the counters stand
    for (;;) {
        const Instant now = co_await pause(look_period / 10);
        if (now - looked < period() || bus_.link.lost_in_a_row.load() != 0) continue;
        looked = now;
        co_await look();
    }
}

Script<void> CableWatch::look() {
    forget_what_is_explained();
    std::vector<Script<void>> scripts;
    for (std::size_t i = 0; i < histories_.size(); ++i) scripts.push_back(read(i));
    co_await all(std::move(scripts), std::max<std::size_t>(bus_.config.acyclic_per_cycle, 1));
    co_await settle();
    // Whoever fell or came back meanwhile has an alarm of its own. What else rose shows at the next look.
    if (quiet_of(bus_) != quiet_) co_return;
    const Instant now = co_await time();
    take(now);
    tell(now);
    co_await clear_the_full();
}

/// Since the look before. A plug that is tried while the ring is broken loses its link again, and that is said.
void CableWatch::forget_what_is_explained() noexcept {
    const Quiet now = quiet_of(bus_);
    const bool broken = bus_.link.ring.load().broken();
    for (auto& history : histories_) {
        if (!now.same_slaves(quiet_)) history.forget_base();
        else if (now != quiet_ || broken) history.forget_links();
    }
    quiet_ = now;
}

Script<void> CableWatch::read(std::size_t slave) {
    const auto& of = *bus_.slaves[slave];
    read_[slave].reset();
    if (!of.away() && of.link.presence.load() == Presence::answers) read_[slave] = co_await read_port_counters(bus_.port, of.found.station);
}

/// Until a frame has come back that was sent behind everything that was read.
Script<void> CableWatch::settle() {
    const Duration least = std::max(least_settling, settling_cycles * bus_.config.cycle);
    do co_await pause(least);
    while (bus_.link.lost_in_a_row.load() != 0);
}

void CableWatch::take(Instant now) noexcept {
    for (std::size_t i = 0; i < histories_.size(); ++i) {
        if (read_[i]) histories_[i].add(*read_[i], now);
        else histories_[i].forget_base();
    }
}

Script<void> CableWatch::clear_the_full() {
    for (std::size_t i = 0; i < histories_.size(); ++i) {
        if (!histories_[i].full()) continue;
        co_await clear_port_counters(bus_.port, bus_.slaves[i]->found.station);
        histories_[i].forget_base();
    }
}

void CableWatch::tell(Instant now) noexcept {
    for (std::size_t i = 0; i < histories_.size(); ++i) bus_.slaves[i]->link.cable.store(worst_at(i, now));
}

/// A cable is told once, at its end away from the master, with what both ends counted: each counts what arrives, and both count a lost link.
CableErrors CableWatch::worst_at(std::size_t slave, Instant now) const noexcept {
    const auto position = bus_.slaves[slave]->found.position;
    if (position >= at_.size()) return {};
    const auto& place = bus_.topology.slaves[position];
    CableRise worst;
    unsigned worst_port = 0;
    for (unsigned p = 0; p < ports_per_slave; ++p) {
        if (p != place.entry_port && history_at(place.child[p]) != nullptr) continue;
        auto rise = histories_[slave].lately(p, now);
        if (const auto* other = p == place.entry_port ? history_at(place.parent) : nullptr) {
            const auto there = other->lately(place.parent_port, now);
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

#include "ecat/bringup/cable_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ecat/bringup/presence.hpp"

namespace taktwerk::ecat {

namespace {

/// Who moved by less is written nothing: measuring again gives a few nanoseconds more or less.
constexpr std::uint32_t moved_ns = 100;
/// How long nobody new is spoken to while somebody who is always there is missed: it may have lost its address.
constexpr Duration patience = std::chrono::seconds{1};

/// Two bytes of a register. Frames get lost in just these moments.
Script<Reply> heard(Bus& bus, bool by_position, std::uint16_t who, std::uint16_t address) {
    constexpr int attempts = 10;
    Reply reply;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (by_position) reply = co_await bus.port.aprd(who, address, 2);
        else reply = co_await bus.port.fprd(who, address, 2);
        if (!reply.lost) break;
    }
    co_return reply;
}

Error changed_meanwhile() {
    return Error{"bus.no_slave", "bus", "slaves came or left while they were counted", "they are counted again by themselves"};
}

}  // namespace

Script<void> CableSurvey::ask(Bus& bus, std::uint16_t position, Seen& seen) {
    const Reply station = co_await bus.port.aprd(position, reg::station_address, 2);
    const Reply ports = co_await bus.port.aprd(position, reg::dl_status, 2);
    const Reply info = co_await bus.port.aprd(position, reg::features, 2);
    const Reply state = co_await bus.port.aprd(position, reg::al_status, 2);
    if (!station.ok() || !ports.ok() || !info.ok() || !state.ok()) co_return;
    seen = {station.u16(), ports.u16(), info.u16(), al_state(state.u16()) == AlState::op, true, nullptr};
}

Script<Result<void>> CableSurvey::take(Bus& bus) {
    const Reply count = co_await bus.port.brd(reg::type, 1);
    if (count.lost || count.wkc == 0) co_return unanswered("bus", "the count of slaves", count);
    seen_.assign(count.wkc, {});
    std::vector<Script<void>> scripts;
    for (std::uint16_t position = 0; position < count.wkc; ++position) scripts.push_back(ask(bus, position, seen_[position]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    const Reply again = co_await bus.port.brd(reg::type, 1);
    const bool all_answered = std::all_of(seen_.begin(), seen_.end(), [](const Seen& one) { return one.answered; });
    if (!all_answered || again.lost || again.wkc != count.wkc) co_return changed_meanwhile();

    recognise(bus);
    const bool somebody_missed = std::any_of(bus.slaves.begin(), bus.slaves.end(), [&](const auto& slave) {
        return !slave->away() && !slave->config->guest() && !is_seen(*slave);
    });
    if (somebody_missed) {
        // Without its address it is known by its place only.
        co_await take_census(bus);
        bool unplaced = false;
        for (const auto& slave : bus.slaves) {
            if (slave->away() || slave->config->guest() || is_seen(*slave)) continue;
            const auto place = slave->position_now;
            if (place && *place < seen_.size() && seen_[*place].slave == nullptr) seen_[*place].slave = slave.get();
            else unplaced = true;
        }
        const Instant now = co_await time();
        if (!missed_since_) missed_since_ = now;
        // One of the newcomers may be it: those are set up anew.
        if (unplaced && now - *missed_since_ < patience) co_return changed_meanwhile();
    } else {
        missed_since_.reset();
    }
    newcomers_.clear();
    guests_ = 0;
    const auto places = static_cast<std::uint16_t>(seen_.size());
    for (std::uint16_t position = 0; position < places; ++position) {
        const auto* slave = seen_[position].slave;
        if (slave == nullptr) newcomers_.push_back(position);
        guests_ = static_cast<std::uint16_t>(guests_ + (slave == nullptr || slave->config->guest() ? 1 : 0));
    }
    co_return Result<void>{};
}

bool CableSurvey::is_seen(const BusSlave& slave) const noexcept {
    return std::any_of(seen_.begin(), seen_.end(), [&](const Seen& one) { return one.slave == &slave; });
}

/// By address. Of two that have the same one it is who is in OP: no newcomer is.
void CableSurvey::recognise(Bus& bus) {
    for (const auto& slave : bus.slaves) {
        if (slave->away()) continue;
        Seen* known = nullptr;
        for (auto& one : seen_)
            if (one.station == slave->found.station && (known == nullptr || (one.in_op && !known->in_op))) known = &one;
        if (known != nullptr) known->slave = slave.get();
    }
}

/// Who would stand in this position if newcomers up to it had left: those behind, as many as there are newcomers.
Script<bool> CableSurvey::all_there(Bus& bus, std::uint16_t position) {
    const Reply count = co_await bus.port.brd(reg::type, 1);
    if (count.lost || count.wkc != seen_.size()) co_return false;
    std::size_t left = newcomers_.size() + 1;
    for (std::size_t p = position; p < seen_.size() && left > 0; ++p) {
        if (seen_[p].slave == nullptr) continue;
        const Reply own = co_await bus.port.fprd(seen_[p].slave->found.station, reg::station_address, 2);
        if (own.wkc == 0) co_return false;
        --left;
    }
    co_return true;
}

/// Who is in OP is no newcomer: both may have got the address, when a frame was sent twice and the newcomer was there for one of them.
Script<void> CableSurvey::give_back(Bus& bus, std::uint16_t station) {
    const BusSlave* robbed = nullptr;
    for (const auto& slave : bus.slaves) {
        if (slave->away()) continue;
        const Reply own = co_await heard(bus, false, slave->found.station, reg::station_address);
        if (!own.lost && own.wkc == 0) robbed = slave.get();
    }
    if (robbed == nullptr) co_return;
    const auto places = static_cast<std::uint16_t>(seen_.size());
    for (std::uint16_t position = 0; position < places; ++position) {
        const Reply held = co_await heard(bus, true, position, reg::station_address);
        const Reply state = co_await heard(bus, true, position, reg::al_status);
        if (!held.ok() || held.u16() != station || !state.ok() || al_state(state.u16()) != AlState::op) continue;
        co_await bus.port.apwr(position, reg::station_address, robbed->found.station);
        co_return;
    }
}

Script<Result<void>> CableSurvey::give_address(Bus& bus, std::uint16_t position, std::uint16_t station) {
    const AddressHold hold{bus};
    const Reply written = co_await bus.port.apwr(position, reg::station_address, station);
    const bool there = co_await all_there(bus, position);
    if (written.ok() && there) co_return Result<void>{};
    co_await give_back(bus, station);
    co_return changed_meanwhile();
}

Script<void> CableSurvey::read_latched(Bus& bus, std::uint16_t position, std::optional<LatchedTimes>& times) {
    const Reply ports = co_await bus.port.aprd(position, reg::dc_receive_times, 16);
    const Reply unit = co_await bus.port.aprd(position, reg::dc_receive_time_unit, 8);
    if (!ports.ok() || !unit.ok()) co_return;
    times = LatchedTimes{true, {ports.u32(0), ports.u32(4), ports.u32(8), ports.u32(12)}, unit.u64()};
}

/// Somebody else's recovery may latch in between: then not all times are of one frame, and it is done again.
Script<Result<std::vector<LatchedTimes>>> CableSurvey::latch(Bus& bus, std::size_t reference) {
    constexpr int attempts = 4;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        std::vector<std::optional<LatchedTimes>> read(seen_.size());
        const Reply latched = co_await bus.port.bwr(reg::dc_receive_times, std::uint32_t{0});
        if (latched.lost) co_return unanswered("bus", "the latch of the receive times (0900h)", latched);
        co_await read_latched(bus, static_cast<std::uint16_t>(reference), read[reference]);
        std::vector<Script<void>> scripts;
        for (std::size_t p = 0; p < seen_.size(); ++p)
            if (p != reference && (seen_[p].features & feature::dc) != 0)
                scripts.push_back(read_latched(bus, static_cast<std::uint16_t>(p), read[p]));
        co_await all(std::move(scripts), DatagramPort::slaves_at_once);
        std::optional<LatchedTimes> after;
        co_await read_latched(bus, static_cast<std::uint16_t>(reference), after);
        const bool all_read = std::all_of(seen_.begin(), seen_.end(), [&](const Seen& one) {
            return (one.features & feature::dc) == 0 || read[static_cast<std::size_t>(&one - seen_.data())].has_value();
        });
        if (!all_read || !after) co_return changed_meanwhile();
        if (after->unit != read[reference]->unit) continue;
        std::vector<LatchedTimes> times;
        for (const auto& one : read) times.push_back(one.value_or(LatchedTimes{}));
        co_return times;
    }
    co_return Error{"bus.clock", "bus", "receive times (0918h) are never of one frame", "it is tried again by itself"};
}

Script<Result<void>> CableSurvey::measure_delays(Bus& bus) {
    if (!bus.reference) co_return Result<void>{};
    const auto& reference = *bus.slaves[*bus.reference];
    const auto at = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& one) { return one.slave == &reference; });
    if (at == seen_.end()) co_return Result<void>{};
    const auto reference_at = static_cast<std::size_t>(at - seen_.begin());
    std::vector<std::uint16_t> dl_status;
    for (const auto& one : seen_) dl_status.push_back(one.dl_status);
    const Result<Topology> tree = build_topology(dl_status);
    if (!tree) co_return tree.error();
    const Result<std::vector<LatchedTimes>> times = co_await latch(bus, reference_at);
    if (!times) co_return times.error();
    const PropagationDelays delays = propagation_delays(*tree, *times);
    for (std::size_t p = 0; p < seen_.size(); ++p) {
        const BusSlave* known = seen_[p].slave;
        if (known == nullptr || known == &reference || !known->dc) continue;
        auto& slave = *bus.slaves[known->index];
        if (p < reference_at && slave.config->guest() && slave.config->dc)
            co_return Error{
                "bus.hot_connect", slave.subject,
                fmt::format("it runs SYNC0 and was plugged in before {}, the reference clock, whose time does not reach it there",
                            reference.subject),
                "plug it in behind that slave"};
        // Counted from the reference of now.
        const std::int64_t ns = std::int64_t{delays.ns[p]} - delays.ns[reference_at] + reference.dc_delay;
        const auto delay = static_cast<std::uint32_t>(std::max<std::int64_t>(ns, 0));
        const bool moved = std::max(delay, slave.dc_delay) - std::min(delay, slave.dc_delay) >= moved_ns;
        if (!slave.away() && !moved) continue;
        slave.dc_delay = delay;
        if (slave.away() || delay < reference.dc_delay) continue;  // who joins gets it with its offset
        const Reply written = co_await bus.port.fpwr(slave.found.station, reg::dc_system_delay, delay - reference.dc_delay);
        if (!written.ok()) co_return unanswered(slave.subject, "its propagation delay (0928h)", written);
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

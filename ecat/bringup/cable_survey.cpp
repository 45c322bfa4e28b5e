#include "ecat/bringup/cable_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ecat/bringup/presence.hpp"

namespace taktwerk::ecat {

namespace {

/// Who moved by less is written nothing: measuring again gives a few nanoseconds more or less.
constexpr std::uint32_t moved_ns = 100;

Error changed_meanwhile() {
    return Error{"bus.no_slave", "bus", "slaves came or left while they were counted", "they are counted again by themselves"};
}

}  // namespace

Script<void> CableSurvey::ask(Bus& bus, std::uint16_t position, Seen& seen) {
    const Reply station = co_await bus.port.aprd(position, reg::station_address, 2);
    const Reply ports = co_await bus.port.aprd(position, reg::dl_status, 2);
    const Reply info = co_await bus.port.aprd(position, reg::features, 2);
    if (!station.ok() || !ports.ok() || !info.ok()) co_return;
    seen = {station.u16(), ports.u16(), info.u16(), true, nullptr};
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
        return !slave->away() && std::none_of(seen_.begin(), seen_.end(), [&](const Seen& one) { return one.slave == slave.get(); });
    });
    if (somebody_missed) {
        // Without its address it is known by its place only.
        co_await take_census(bus);
        for (const auto& slave : bus.slaves)
            if (!slave->away() && slave->position_now && *slave->position_now < seen_.size() &&
                seen_[*slave->position_now].slave == nullptr)
                seen_[*slave->position_now].slave = slave.get();
    }
    newcomers_.clear();
    guests_ = 0;
    for (std::uint16_t position = 0; position < seen_.size(); ++position) {
        const auto* slave = seen_[position].slave;
        if (slave == nullptr) newcomers_.push_back(position);
        guests_ = static_cast<std::uint16_t>(guests_ + (slave == nullptr || slave->config->guest() ? 1 : 0));
    }
    co_return Result<void>{};
}

/// By address. Of two that have the same one the slave of the bring-up is who stands nearest to its place.
void CableSurvey::recognise(Bus& bus) {
    for (const auto& slave : bus.slaves) {
        if (slave->away()) continue;
        const auto distance = [&](const Seen& one) {
            return slave->config->guest() ? 0 : std::abs((&one - seen_.data()) - std::ptrdiff_t{slave->found.position});
        };
        Seen* nearest = nullptr;
        for (auto& one : seen_)
            if (one.station == slave->found.station && (nearest == nullptr || distance(one) < distance(*nearest))) nearest = &one;
        if (nearest != nullptr) nearest->slave = slave.get();
    }
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

#include "ecat/bringup/reference_role.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/clocks.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration glance = std::chrono::milliseconds{20};
constexpr std::uint32_t missing_limit = 10;  ///< cycles without its time until the reference is asked whether it is there

/// By position.
std::vector<BusSlave*> clocks_of(Bus& bus) {
    std::vector<BusSlave*> result;
    for (auto& slave : bus.slaves)
        if (slave->dc && !slave->config->guest()) result.push_back(slave.get());
    std::sort(result.begin(), result.end(), [](const BusSlave* a, const BusSlave* b) { return a->found.position < b->found.position; });
    return result;
}

/// Its system time, as a frame that leaves now finds it, is the bus' to within an offset that the drift control takes out.
Script<bool> shows_system_time(Bus& bus, const BusSlave& slave) {
    constexpr std::int64_t believable_ns = 50'000;
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::dc_system_time, 8);
    if (!reply.ok()) co_return false;
    const std::int64_t expected = reply.sent_at.time_since_epoch().count() + bus.link.dc_time.offset_ns.load();
    co_return std::abs(static_cast<std::int64_t>(reply.u64()) - expected) < believable_ns + bus.config.cycle.count();
}

Script<void> replace_reference(Bus& bus) {
    BusSlave& lost = *bus.slaves[*bus.reference];
    const Reply there = co_await bus.port.fprd(lost.found.station, reg::dc_system_time, 8);
    if (there.lost || there.wkc > 0) co_return;  // no frame comes back at all, or it answers again
    for (BusSlave* candidate : clocks_of(bus)) {
        if (candidate == &lost) continue;
        const bool fit = co_await shows_system_time(bus, *candidate);
        if (!fit) continue;
        const Result<void> serves = co_await serve_as_reference(bus, *candidate);
        if (!serves) continue;
        bus.remember(fmt::format("{} does not answer: {} is the reference clock now", lost.subject, candidate->subject));
        co_return;
    }
}

/// One that stands before the present reference is in OP again without having lost its clock (it had lost its address).
Script<void> give_role_back(Bus& bus) {
    const BusSlave& present = *bus.slaves[*bus.reference];
    for (BusSlave* slave : clocks_of(bus)) {
        if (slave->found.position >= present.found.position) co_return;
        if ((slave->link.al.load() & 0x1Fu) != static_cast<std::uint32_t>(AlState::op)) continue;
        const bool fit = co_await shows_system_time(bus, *slave);
        if (!fit) continue;
        const Result<void> set = co_await restore_clock(bus, *slave);
        if (set) co_return;
    }
}

}  // namespace

Script<Result<void>> serve_as_reference(Bus& bus, BusSlave& slave) {
    const ClockHold hold{bus};
    co_await pause(frames_under_way * bus.config.cycle);
    const Reply own = co_await bus.port.fpwr(slave.found.station, reg::dc_system_delay, std::uint32_t{0});
    if (!own.ok()) co_return unanswered(slave.subject, "its propagation delay (0928h)", own);
    for (BusSlave* other : clocks_of(bus))
        if (other->found.position > slave.found.position)
            co_await bus.port.fpwr(other->found.station, reg::dc_system_delay, other->dc_delay - slave.dc_delay);
    bus.reference = slave.index;
    bus.link.reference.store(slave.found.station | (std::uint64_t{slave.dc_delay} << 16));
    co_await pause(frames_under_way * bus.config.cycle);
    co_return Result<void>{};
}

Script<void> watch_reference(Bus& bus) {
    if (!bus.reference) co_return;
    const std::size_t first = *bus.reference;
    for (;;) {
        co_await pause(glance);
        if (bus.link.dc_missing.load() >= missing_limit) co_await replace_reference(bus);
        else if (*bus.reference != first) co_await give_role_back(bus);
    }
}

}  // namespace taktwerk::ecat

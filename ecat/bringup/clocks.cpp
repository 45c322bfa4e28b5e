#include "ecat/bringup/clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ecat/bringup/reference_role.hpp"
#include "ecat/dc/propagation.hpp"
#include "ecat/dc/reference_clock.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration settle_time = std::chrono::seconds{10};
constexpr Duration lock_patience = std::chrono::seconds{5};
constexpr std::int64_t tolerable_phase = 8;  ///< an eighth of the cycle: the way a frame has to go before SYNC0 is longer
constexpr Duration least_margin = std::chrono::milliseconds{100};
constexpr std::uint64_t end_of_time = std::uint64_t{1} << 62;  ///< ns since 2000: in the year 2146
constexpr std::int64_t margin_cycles = 50;                     ///< six register accesses, each of two or three cycles, and reserve
constexpr unsigned frames_per_round = 8;                       ///< reference times sent between two looks at 092Ch, while no cycle runs

std::int64_t nanoseconds(Instant t) noexcept { return t.time_since_epoch().count(); }

/// Machine time -> system time.
std::int64_t system_time(const Bus& bus, Instant now) noexcept { return nanoseconds(now) + bus.link.dc_time.offset_ns.load(); }

/// System time of a cycle start in which the slave's sync unit is exchanged, modulo its period: SYNC0 then comes at the same
/// distance behind the frame as in every cycle.
Duration unit_phase(const Bus& bus, const BusSlave& slave, std::int64_t dc_phase) {
    const std::int64_t cycle = bus.config.cycle.count();
    const auto unit = bus.plan.slaves[slave.index].unit;
    const std::int64_t exchanged =
        bus.link.first_send_ns.load() + bus.link.dc_time.offset_ns.load() + (unit ? bus.plan.units[*unit].phase : 0) * cycle;
    const std::int64_t whole_cycles = (exchanged - dc_phase + cycle / 2) / cycle;
    return Duration{(dc_phase + whole_cycles * cycle) % exchange_period(bus.config, *slave.config).count()};
}

std::vector<BusSlave*> slaves_with_clock(Bus& bus) {
    std::vector<BusSlave*> result;
    for (auto& slave : bus.slaves) {
        if (slave->config->guest()) continue;  // not before it joins (hot_connect.hpp)
        slave->dc = (slave->found.features & feature::dc) != 0;
        if (slave->dc) result.push_back(slave.get());
    }
    std::sort(result.begin(), result.end(), [](const BusSlave* a, const BusSlave* b) { return a->found.position < b->found.position; });
    return result;
}

Script<Result<LatchedTimes>> read_latched(Bus& bus, std::uint16_t station, std::string subject) {
    const Reply ports = co_await bus.port.fprd(station, reg::dc_receive_times, 16);
    if (!ports.ok()) co_return unanswered(subject, "its receive times (0900h)", ports);
    const Reply unit = co_await bus.port.fprd(station, reg::dc_receive_time_unit, 8);
    if (!unit.ok()) co_return unanswered(subject, "its receive time (0918h)", unit);
    co_return LatchedTimes{true, {ports.u32(0), ports.u32(4), ports.u32(8), ports.u32(12)}, unit.u64()};
}

Script<void> keep_latched(Bus& bus, std::uint16_t station, std::string subject, bool known, LatchedTimes& times,
                          std::optional<Error>& error) {
    const Result<LatchedTimes> latched = co_await read_latched(bus, station, std::move(subject));
    if (latched) times = *latched;
    else if (known) error = latched.error();
}

/// Of every slave on the cable, also of those that nobody configured: their clocks measure their branches.
Script<Result<std::vector<LatchedTimes>>> read_all_latched(Bus& bus) {
    std::vector<LatchedTimes> times(bus.found.size());
    std::vector<std::optional<Error>> errors(bus.found.size());
    std::vector<Script<void>> scripts;
    for (std::size_t p = 0; p < bus.found.size(); ++p) {
        if ((bus.found[p].features & feature::dc) == 0) continue;
        const auto configured = std::find_if(bus.slaves.begin(), bus.slaves.end(), [&](const auto& s) { return s->found.position == p; });
        const bool known = configured != bus.slaves.end();
        const std::string subject = known ? (*configured)->subject : fmt::format("slave {}", p);
        scripts.push_back(keep_latched(bus, bus.found[p].station, subject, known, times[p], errors[p]));
    }
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    for (const auto& error : errors)
        if (error) co_return *error;
    co_return times;
}

/// The tree as the scan found it.
Result<void> learn_topology(Bus& bus) {
    if (bus.topology.slaves.size() == bus.found.size() && !bus.found.empty()) return {};
    bus.found.clear();
    for (const auto& slave : bus.slaves) bus.found.push_back(slave->found);
    std::sort(bus.found.begin(), bus.found.end(), [](const auto& a, const auto& b) { return a.position < b.position; });
    std::vector<std::uint16_t> dl_status;
    for (const auto& slave : bus.found) dl_status.push_back(slave.dl_status);
    Result<Topology> tree = build_topology(dl_status);
    if (!tree) return tree.error();
    bus.topology = std::move(*tree);
    return {};
}

/// From now on the cycle keeps the phase it has now, in system time.
void fix_phase(Bus& bus) {
    if (bus.dc_phase) return;
    const std::int64_t cycle = bus.config.cycle.count();
    bus.dc_phase = (((bus.link.send_phase_ns.load() + bus.link.dc_time.offset_ns.load()) % cycle) + cycle) % cycle;
    bus.link.dc_phase_ns.store(*bus.dc_phase);
}

Script<Result<void>> write_clock(Bus& bus, BusSlave& slave) {
    // From the reference of now; one before it gets none: it will be the reference itself.
    const std::uint32_t first = bus.slaves[*bus.reference]->dc_delay;
    const std::uint32_t behind = slave.dc_delay > first ? slave.dc_delay - first : 0;
    const Reply delay = co_await bus.port.fpwr(slave.found.station, reg::dc_system_delay, behind);
    if (!delay.ok()) co_return unanswered(slave.subject, "its propagation delay (0928h)", delay);
    const Reply offset = co_await bus.port.fpwr(slave.found.station, reg::dc_system_offset, slave.dc_offset);
    if (!offset.ok()) co_return unanswered(slave.subject, "its clock offset (0920h)", offset);
    const Reply speed = co_await bus.port.fpwr(slave.found.station, reg::dc_speed_start, std::uint16_t{0x1000});
    if (!speed.ok()) co_return unanswered(slave.subject, "its drift control (0930h)", speed);
    co_return Result<void>{};
}

Script<Result<void>> write_clock_if_any(Bus& bus, BusSlave& slave) {
    if (!slave.dc) co_return Result<void>{};
    co_return co_await write_clock(bus, slave);
}

Script<void> keep_difference(Bus& bus, BusSlave& slave, std::optional<Error>& error) {
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::dc_difference, 4);
    if (reply.ok()) slave.dc_difference = std::abs(static_cast<std::int64_t>(dc_difference_ns(reply.u32())));
    else error = unanswered(slave.subject, "its clock difference (092Ch)", reply);
}

}  // namespace

Duration sync0_shift(const BusConfig& bus, const SlaveConfig& slave) noexcept {
    if (slave.sync0_shift != Duration{}) return slave.sync0_shift;
    return bus.sync0_shift != Duration{} ? bus.sync0_shift : bus.cycle / 2;
}

Script<Result<void>> setup_clocks(Bus& bus) {
    bus.reference.reset();
    bus.dc_phase.reset();
    bus.link.dc_phase_ns.store(-1);
    const std::vector<BusSlave*> clocks = slaves_with_clock(bus);
    if (clocks.empty()) co_return Result<void>{};
    bus.progress = fmt::format("measuring the clocks of {} slaves", clocks.size());
    bus.reference = clocks.front()->index;
    bus.link.reference.store(clocks.front()->found.station);

    if (const Result<void> known = learn_topology(bus); !known) co_return known.error();
    const Reply latch = co_await bus.port.bwr(reg::dc_receive_times, std::uint32_t{0});
    if (latch.lost) co_return unanswered("bus", "the latch of the receive times (0900h)", latch);
    const Result<std::vector<LatchedTimes>> times = co_await read_all_latched(bus);
    if (!times) co_return times.error();
    const PropagationDelays delays = propagation_delays(bus.topology, *times);
    for (BusSlave* slave : clocks) {
        const std::size_t p = slave->found.position;
        slave->dc_delay = delays.ns[p];
        slave->dc_offset = system_offset((*times)[p].unit, delays.ns[p], static_cast<std::uint64_t>(nanoseconds(latch.sent_at)));
        if (std::find(delays.estimated.begin(), delays.estimated.end(), p) != delays.estimated.end())
            bus.remember(
                fmt::format("{}: its propagation delay of {} ns is a guess: no slave with a clock stands before the branch that "
                            "it is in; put one first on the cable",
                            slave->subject, slave->dc_delay));
    }
    co_return co_await for_each_slave(bus, &write_clock_if_any);
}

namespace {

/// Local time of the reference less that of the slave, both when one frame passed them. Of a ring one half may miss the frame that latches, and
/// somebody else's recovery may latch in between: then the two times are not of one frame.
Script<Result<std::uint64_t>> ahead_of(Bus& bus, const BusSlave& reference, const BusSlave& slave) {
    constexpr int attempts = 4;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const Result<LatchedTimes> master_before = co_await read_latched(bus, reference.found.station, reference.subject);
        if (!master_before) co_return master_before.error();
        const Result<LatchedTimes> own_before = co_await read_latched(bus, slave.found.station, slave.subject);
        if (!own_before) co_return own_before.error();
        const Reply latch = co_await bus.port.bwr(reg::dc_receive_times, std::uint32_t{0});
        if (latch.lost) co_return unanswered(slave.subject, "the latch of the receive times (0900h)", latch);
        const Result<LatchedTimes> master = co_await read_latched(bus, reference.found.station, reference.subject);
        if (!master) co_return master.error();
        const Result<LatchedTimes> own = co_await read_latched(bus, slave.found.station, slave.subject);
        if (!own) co_return own.error();
        const Result<LatchedTimes> master_after = co_await read_latched(bus, reference.found.station, reference.subject);
        if (!master_after) co_return master_after.error();
        if (master->unit != master_before->unit && own->unit != own_before->unit && master->unit == master_after->unit)
            co_return master->unit - own->unit;
    }
    co_return Error{"bus.clock", slave.subject, "its receive time (0918h) and that of the reference are never of one frame",
                    "frames get lost: check the cables; it is tried again by itself"};
}

}  // namespace

Script<Result<void>> restore_clock(Bus& bus, BusSlave& slave) {
    if (!slave.dc || !bus.reference) co_return Result<void>{};
    auto& reference = *bus.slaves[*bus.reference];
    if (&reference == &slave) {
        const std::uint16_t position = slave.position_now.value_or(slave.found.position);
        // Without its station address it took the others' part: the frames pulled at its clock. Start its control anew.
        const Reply calm = co_await bus.port.apwr(position, reg::dc_speed_start, std::uint16_t{0x1000});
        if (!calm.ok()) co_return unanswered(slave.subject, "its drift control (0930h)", calm);
        const Reply local = co_await bus.port.aprd(position, reg::dc_system_time, 8);
        if (!local.ok()) co_return unanswered(slave.subject, "its system time (0910h)", local);
        const Reply old = co_await bus.port.aprd(position, reg::dc_system_offset, 8);
        if (!old.ok()) co_return unanswered(slave.subject, "its clock offset (0920h)", old);
        slave.dc_offset = old.u64() + static_cast<std::uint64_t>(system_time(bus, local.sent_at)) - local.u64();
        const Reply written = co_await bus.port.apwr(position, reg::dc_system_offset, slave.dc_offset);
        if (!written.ok()) co_return unanswered(slave.subject, "its clock offset (0920h)", written);
        co_return Result<void>{};
    }
    // Before the reference the time in a datagram is not yet the reference's: nothing to follow until it serves itself.
    std::optional<ClockHold> hold;
    if (slave.found.position < reference.found.position) {
        hold.emplace(bus);
        co_await pause(frames_under_way * bus.config.cycle);
    }
    const Result<std::uint64_t> ahead = co_await ahead_of(bus, reference, slave);
    if (!ahead) co_return ahead.error();
    slave.dc_offset = *ahead + reference.dc_offset + std::uint64_t{slave.dc_delay} - reference.dc_delay;
    const Result<void> written = co_await write_clock(bus, slave);
    if (!written || slave.found.position > reference.found.position) co_return written;
    co_return co_await serve_as_reference(bus, slave);
}

namespace {

constexpr Duration wrong_quartz_shows = std::chrono::seconds{1};

/// The estimate is limited to what two quartzes cannot be apart. Where it stays there no lock will come, and the cycle is not to blame.
Error wrong_quartz(const Bus& bus, std::int64_t drift_ppb) {
    return Error{"bus.dc_not_locked", bus.slaves[*bus.reference]->subject,
                 fmt::format("its clock, the reference of the bus, runs {} by {} ppm and more: two quartzes differ by 200 ppm at most",
                             drift_ppb > 0 ? "fast" : "slow", std::abs(drift_ppb) / 1000),
                 "replace it, or put another slave with a clock in front of it on the cable"};
}

}  // namespace

Script<Result<void>> await_clocks(Bus& bus) {
    if (!bus.reference) co_return Result<void>{};
    bus.progress = "waiting for the clocks to agree";
    const std::vector<BusSlave*> clocks = slaves_with_clock(bus);
    const std::uint16_t reference = bus.slaves[*bus.reference]->found.station;
    const Instant started = co_await time();
    Instant believable = started;
    for (;;) {
        for (unsigned i = 0; i < frames_per_round; ++i) co_await bus.port.frmw(reference, reg::dc_system_time, 8);
        const BusSlave* worst = nullptr;
        std::int64_t worst_ns = 0;
        std::vector<std::optional<Error>> errors(clocks.size());
        std::vector<Script<void>> scripts;
        for (std::size_t i = 0; i < clocks.size(); ++i)
            if (clocks[i]->found.station != reference) scripts.push_back(keep_difference(bus, *clocks[i], errors[i]));
        co_await all(std::move(scripts), DatagramPort::slaves_at_once);
        for (const auto& error : errors)
            if (error) co_return *error;
        for (const BusSlave* slave : clocks) {
            if (slave->found.station == reference || slave->dc_difference < worst_ns) continue;
            worst = slave;
            worst_ns = slave->dc_difference;
        }
        bus.link.dc_difference_ns.store(worst_ns);
        const Instant now = co_await time();
        const bool measured = bus.link.cycles.load() == 0 || bus.link.dc_time.measured.load();
        if (measured && worst_ns <= clock_limit.count()) {
            fix_phase(bus);
            co_return Result<void>{};
        }
        // A reference that runs wild leaves the others behind: they are not to blame.
        const std::int64_t drift = bus.link.dc_time.drift_ppb.load();
        if (std::abs(drift) < ReferenceClock::largest_drift_ppb) believable = now;
        if (now - believable >= wrong_quartz_shows) co_return wrong_quartz(bus, drift);
        if (now - started > settle_time) {
            if (worst == nullptr)
                co_return Error{"bus.clock", bus.slaves[*bus.reference]->subject,
                                "the reference clock does not answer in the cyclic frames",
                                "a slave has lost its station address: restart the bus"};
            co_return Error{"bus.clock", worst->subject,
                            fmt::format("its clock is still {} ns off after {} s (limit {} ns)", worst_ns,
                                        settle_time / std::chrono::seconds{1}, clock_limit.count()),
                            "check that the cycle runs evenly; a clock that drifts by more than 100 ppm is defective"};
        }
    }
}

Script<Result<void>> await_lock(Bus& bus) {
    const bool needed = std::any_of(bus.slaves.begin(), bus.slaves.end(), [](const auto& slave) { return slave->config->dc && slave->dc; });
    const bool required = bus.reference && needed && bus.config.lock_required;
    bus.link.runs_sync0.store(required);
    if (!required) co_return Result<void>{};
    bus.progress = "waiting for the cycle to lock to the reference clock";
    const Instant started = co_await time();
    Instant believable = started;
    for (;;) {
        const DcLock lock = bus.link.dc_lock.load();
        if (lock == DcLock::locked || lock == DcLock::coasting) co_return Result<void>{};
        const Instant now = co_await pause(bus.config.cycle);
        const std::int64_t drift = bus.link.dc_time.drift_ppb.load();
        if (std::abs(drift) < ReferenceClock::largest_drift_ppb) believable = now;
        if (now - believable >= wrong_quartz_shows) co_return wrong_quartz(bus, drift);
        if (now - started < lock_patience) continue;
        const std::int64_t error = bus.link.dc_phase_error_ns.load();
        const std::string what = fmt::format("the master's cycle does not lock to it: {}, {} ns off in phase", name(lock), error);
        const bool known = lock == DcLock::acquiring;
        if (known && std::abs(error) <= bus.config.cycle.count() / tolerable_phase) {
            bus.remember(bus.slaves[*bus.reference]->subject + ": " + what);  // the alarm dc_not_locked stands; frames are in time
            co_return Result<void>{};
        }
        co_return Error{"bus.dc_not_locked", bus.slaves[*bus.reference]->subject, what,
                        "the cycle runs unevenly or ignores the correction: check its lateness (real-time priority, CPU isolation)"};
    }
}

Script<Result<void>> start_sync_before_safeop(Bus& bus, BusSlave& slave) {
    if (slave.config->sync_start == SyncStart::before_safeop) co_return co_await start_sync0(bus, slave);
    co_return Result<void>{};
}

Script<Result<void>> start_sync_in_safeop(Bus& bus, BusSlave& slave) {
    if (slave.config->sync_start == SyncStart::in_safeop) co_return co_await start_sync0(bus, slave);
    co_return Result<void>{};
}

Script<Result<void>> start_sync0(Bus& bus, BusSlave& slave) {
    if (!slave.config->dc) co_return Result<void>{};
    if (!slave.dc)
        co_return Error{"bus.no_clock", slave.subject, "SYNC0 is configured, but its controller has no distributed clock",
                        "set dc: false for this slave"};
    bus.note(slave, "starting SYNC0");
    const Duration sync0_period = exchange_period(bus.config, *slave.config);
    const std::uint16_t station = slave.found.station;
    Duration margin = std::max(least_margin, margin_cycles * bus.config.cycle);
    bool believable = true;
    for (unsigned attempt = 0; attempt < 3; ++attempt, margin *= 2) {
        const Reply off = co_await bus.port.fpwr(station, reg::dc_activation, std::uint8_t{0});
        if (!off.ok()) co_return unanswered(slave.subject, "SYNC0 activation (0981h)", off);
        co_await bus.port.fpwr(station, reg::dc_cyclic_control, std::uint8_t{0});
        fix_phase(bus);
        const Reply now = co_await bus.port.fprd(station, reg::dc_system_time, 8);
        if (!now.ok()) co_return unanswered(slave.subject, "its system time (0910h)", now);
        believable = now.u64() < end_of_time;
        if (!believable) continue;
        const std::uint64_t start =
            sync0_start(now.u64(), margin, sync0_period, unit_phase(bus, slave, *bus.dc_phase), sync0_shift(bus.config, *slave.config));
        const Reply first = co_await bus.port.fpwr(station, reg::dc_start_time, start);
        const Reply period = co_await bus.port.fpwr(station, reg::dc_sync0_cycle, static_cast<std::uint32_t>(sync0_period.count()));
        const auto behind_sync0 = static_cast<std::uint32_t>(slave.config->sync1.value_or(Duration{}).count());
        const Reply sync1 = co_await bus.port.fpwr(station, reg::dc_sync1_cycle, behind_sync0);
        const auto units = dc_activate::cyclic | dc_activate::sync0 | (slave.config->sync1 ? dc_activate::sync1 : 0);
        const Reply on = co_await bus.port.fpwr(station, reg::dc_activation, static_cast<std::uint8_t>(units));
        if (!first.ok() || !period.ok() || !sync1.ok() || !on.ok())
            co_return unanswered(slave.subject, "SYNC0 (0990h, 09A0h, 0981h)", on.ok() ? first : on);
        const Reply after = co_await bus.port.fprd(station, reg::dc_system_time, 8);
        if (!after.ok()) co_return unanswered(slave.subject, "its system time (0910h)", after);
        // Start and wait come of two readings of one clock: a damaged one must not make the bus wait for years.
        believable = after.u64() >= now.u64();
        if (believable && after.u64() < start) {
            slave.link.sync0_start.store(static_cast<std::int64_t>(start));
            // The drive must have seen SYNC0 when SAFEOP is asked for.
            co_await pause(Duration{static_cast<std::int64_t>(start - after.u64())} + 2 * sync0_period);
            co_return Result<void>{};
        }
    }
    if (!believable)
        co_return Error{"bus.clock_not_believable", slave.subject,
                        "its system time (0910h) jumped while SYNC0 was being started, three times",
                        "power-cycle it; if that does not help, its controller or its cable is defective"};
    co_return Error{"bus.sync0_late", slave.subject, "the start of SYNC0 had passed before it was activated, three times",
                    "the service thread stalls for hundreds of milliseconds: give it more CPU time"};
}

Script<Result<void>> stop_sync0(Bus& bus, BusSlave& slave) {
    slave.link.sync0_start.store(0);
    if (slave.config->dc && slave.dc) co_await bus.port.fpwr(slave.found.station, reg::dc_activation, std::uint8_t{0});
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

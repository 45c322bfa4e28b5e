#include "ecat/bringup/bring_up.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/named_loss.hpp"
#include "ecat/bringup/own_word.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/recovery.hpp"
#include "ecat/bringup/ring_line.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_setup.hpp"
#include "ecat/dc/sync0_budget.hpp"
#include "ecat/layout/frame_schedule.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration valid_outputs_timeout = std::chrono::seconds{3};
constexpr std::uint64_t foreign_limit = 3;  ///< frames: fewer may be our own with a bit flipped in the address

Script<Result<void>> to_safeop(Bus& bus, BusSlave& slave) { return set_state(bus, slave, AlState::safeop); }
Script<Result<void>> to_op(Bus& bus, BusSlave& slave) { return set_state(bus, slave, AlState::op); }

Result<ProcessDataPlan> plan_bus(const Bus& bus) {
    std::vector<PlanSlave> inputs;
    for (const auto& slave : bus.slaves) inputs.push_back(plan_input(*slave));
    return plan_process_data(inputs, bus.config.sync_units);
}

std::string slaves_of(const Bus& bus, const DatagramPlan& datagram) {
    std::string text;
    for (const std::size_t s : datagram.slaves) text += (text.empty() ? "" : ", ") + bus.slaves[s]->subject;
    return text;
}

/// Frames that go out and do not come back before the next cycle: is there time for them at all?
Error no_answer_in_time(const Bus& bus) {
    const auto load = fullest_cycle(bus.plan);
    const auto us = [](Duration d) { return to_seconds(d) * 1e6; };
    const Duration way = load.wire + static_cast<std::int64_t>(bus.found.size()) * usual_hop;
    std::string what = fmt::format("process data does not come back within the cycle of {:.6g} us", us(bus.config.cycle));
    if (way < bus.config.cycle * 3 / 4)
        return Error{
            "bus.no_frame", "bus", what + fmt::format("; on the wire its way takes some {:.0f} us", us(way)),
            "this computer sends or receives too late (see late_wakeups, another load, power saving of the NIC), or the link loses "
            "frames: check cable and NIC, or lengthen the cycle"};
    return Error{
        "bus.no_frame", "bus",
        what + fmt::format(": {} frame(s) of {} bytes in all are {:.0f} us on the wire at 100 Mbit/s, and pass {} slaves", load.frames,
                           load.bytes, us(load.wire), bus.found.size()),
        fmt::format("the cycle is too short for this bus: choose at least {:.0f} us, put slaves into slower sync units, or use two buses",
                    us(way * 4 / 3))};
}

/// Drives want valid outputs before OP (pain 2 of the reference).
Script<Result<void>> await_valid_outputs(Bus& bus) {
    bus.progress = "waiting for valid process data";
    const Instant started = co_await time();
    const std::uint64_t cycles_before = bus.link.cycles.load();
    std::uint32_t slowest = 1;
    for (const auto& unit : bus.plan.units) slowest = std::max<std::uint32_t>(slowest, unit.divisor);
    for (;;) {
        if (bus.link.good_in_a_row.load() >= valid_cycles * slowest) co_return Result<void>{};
        const Instant now = co_await time();
        if (now - started > valid_outputs_timeout + 2 * valid_cycles * slowest * bus.config.cycle) {
            if (bus.link.cycles.load() - cycles_before < valid_cycles)
                co_return Error{"bus.no_cycle", "bus", "all slaves are in SAFEOP, but no cycle sends process data",
                                "start the machine's cycle before the bus is brought to OP"};
            // As long as frames are missing nobody can say what the slaves would have added to them.
            if (bus.link.lost_in_a_row.load() > 0) co_return no_answer_in_time(bus);
            const std::size_t d = bus.link.worst_datagram.load();
            if (d < bus.plan.datagrams.size() && bus.link.worst_wkc.load() != bus.plan.datagrams[d].expected_wkc)
                co_return Error{"bus.working_counter", slaves_of(bus, bus.plan.datagrams[d]),
                                fmt::format("process data comes back with working counter {}, expected {}", bus.link.worst_wkc.load(),
                                            bus.plan.datagrams[d].expected_wkc),
                                "the slave does not take part: check its sync managers and FMMUs, and that it is the device configured"};
            co_return no_answer_in_time(bus);
        }
        co_await pause(bus.config.cycle);
    }
}

/// SYNC0 shortly before the next frame: whatever lateness is left moves that frame in front of it, and two come between two SYNC0.
void remark_late_sync0(Bus& bus) {
    constexpr std::int64_t least_rest = 10;  // a tenth of the cycle
    for (const auto& slave : bus.slaves) {
        if (!slave->config->dc) continue;
        const Duration rest = bus.config.cycle - sync0_shift(bus.config, *slave->config);
        if (rest >= bus.config.cycle / least_rest) continue;
        bus.remember(fmt::format(
            "{}: SYNC0 comes only {:.6g} us before the next frame (sync0_shift {:.6g} us of {:.6g} us): a frame that "
            "is early, or clocks that drift, put two frames between two SYNC0; choose at most nine tenths of the cycle",
            slave->subject, to_seconds(rest) * 1e6, to_seconds(bus.config.cycle - rest) * 1e6, to_seconds(bus.config.cycle) * 1e6));
    }
}

/// Nothing fails by it: lists take longer. Who wonders why the start is slow finds it here.
void remark_complete_access(Bus& bus) {
    for (const auto& slave : bus.slaves)
        if (!slave->away() && slave->has_coe() && slave->device().mailbox->complete_access && !slave->mailbox.complete_access)
            bus.remember(slave->subject +
                         ": its firmware refuses complete access, which its profile promises: lists are written entry by entry; "
                         "set `complete_access: false` in its profile");
}

Script<Result<void>> climb(Bus& bus) {
    bus.phase.store(BusPhase::scanning);
    Result<void> done = co_await scan(bus);
    if (!done) co_return done;

    for (auto& slave : bus.slaves)
        if (!slave->away()) take_own_word(bus, *slave);
    remark_late_sync0(bus);
    bus.phase.store(BusPhase::preop);
    done = co_await for_each_slave(bus, &enter_preop);
    if (!done) co_return done;

    bus.phase.store(BusPhase::configuring);
    done = co_await for_each_slave(bus, &compare_identity);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &prepare_process_data);
    if (!done) co_return done;
    remark_complete_access(bus);
    Result<ProcessDataPlan> plan = plan_bus(bus);
    if (!plan) co_return plan.error();
    bus.plan = std::move(*plan);
    done = co_await setup_clocks(bus);
    if (!done) done = co_await named_break(bus, done.error());
    const Result<void> whole = co_await make_ring(bus);
    if (!done || !whole) co_return done ? whole : done;
    done = co_await for_each_slave(bus, &program_process_data);
    if (!done) co_return done;
    for (auto& slave : bus.slaves) slave->in_line = true;
    bus.publish();
    co_await pause(3 * bus.config.cycle);  // lets a running cycle show itself
    done = co_await await_clocks(bus);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &start_sync_before_safeop);
    if (!done) co_return done;

    bus.phase.store(BusPhase::safeop);
    done = co_await for_each_slave(bus, &to_safeop);
    if (!done) co_return done;
    bus.link.supervise.store(true);
    done = co_await for_each_slave(bus, &start_sync_in_safeop);
    if (!done) co_return done;
    done = co_await await_valid_outputs(bus);
    if (!done) co_return done;
    done = co_await await_lock(bus);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &write_startup_op);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &to_op);
    co_return done;
}

/// Whoever is above this state comes down to it; who does not, stands in the notes.
template <AlState state>
Script<Result<void>> down_to(Bus& bus, BusSlave& slave) {
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status || al_state(*status) <= state) co_return Result<void>{};
    const Result<void> down = co_await set_state(bus, slave, state);
    if (!down) bus.remember(down.error().text());
    if (state == AlState::preop) {
        const Result<void> quiet = co_await stop_sync0(bus, slave);
        if (!quiet) bus.remember(quiet.error().text());
    }
    co_return Result<void>{};
}

/// Whoever writes to the slaves beside us makes them fail in many ways: then it is he, and not whom he disturbed. That the slaves are not the
/// configured ones has no master to do with.
Error disturbed(const Bus& bus, std::uint64_t foreign_before, Error failure) {
    const std::uint64_t heard = bus.link.foreign_frames.load() - foreign_before;
    if (heard < foreign_limit || bus.slaves.empty() || failure.code == "bus.foreign_master") return failure;
    return Error{"bus.foreign_master", "bus",
                 fmt::format("another EtherCAT master sent {} frames on this cable while the bus came up: {}; then {}: {}", heard,
                             sender_text(bus.link), failure.subject, failure.what),
                 "end that master, or connect the bus to this computer only, and start again"};
}

}  // namespace

Script<Result<void>> bring_up(Bus& bus) {
    bus.link.supervise.store(false);
    bus.link.good_in_a_row.store(0);
    const std::uint64_t foreign_before = bus.link.foreign_frames.load();
    Result<void> done = co_await climb(bus);
    if (!done) done = co_await named_break(bus, done.error());
    if (!done) done = co_await named_loss(bus, done.error());
    if (!done) done = disturbed(bus, foreign_before, done.error());
    bus.phase.store(done ? BusPhase::operational : BusPhase::failed);
    bus.progress = done ? std::string{"operational"} : done.error().text();
    co_return done;
}

Script<Result<void>> take_down(Bus& bus) {
    bus.phase.store(BusPhase::stopping);
    (void)co_await for_each_slave(bus, &down_to<AlState::safeop>);
    bus.link.supervise.store(false);
    (void)co_await for_each_slave(bus, &down_to<AlState::preop>);
    (void)co_await for_each_slave(bus, &down_to<AlState::init>);
    bus.phase.store(BusPhase::stopped);
    bus.progress = "stopped";
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

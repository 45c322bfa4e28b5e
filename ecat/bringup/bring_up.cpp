#include "ecat/bringup/bring_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_setup.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration watch_period = std::chrono::milliseconds{100};
constexpr Duration watch_glance = std::chrono::milliseconds{5};       ///< how soon a state the cycle saw is noticed
constexpr Duration watch_suspicious = std::chrono::milliseconds{20};  ///< instead of watch_period, while one slave is not in OP
constexpr Duration retry_period = std::chrono::milliseconds{500};     ///< between two attempts to get a slave back
constexpr Duration valid_outputs_timeout = std::chrono::seconds{3};
constexpr std::uint32_t valid_cycles = 5;

Script<Result<void>> to_safeop(Bus& bus, BusSlave& slave) { return set_state(bus, slave, AlState::safeop); }
Script<Result<void>> to_op(Bus& bus, BusSlave& slave) { return set_state(bus, slave, AlState::op); }

Script<Result<void>> prepare(Bus& bus, BusSlave& slave) {
    const Result<void> written = co_await write_startup_safeop(bus, slave);
    if (!written) co_return written;
    co_return co_await assign_pdos(bus, slave);
}

Result<ProcessDataPlan> plan_bus(const Bus& bus) {
    std::vector<PlanSlave> inputs;
    for (const auto& slave : bus.slaves) inputs.push_back(plan_input(*slave));
    return plan_process_data(inputs);
}

std::string slaves_of(const Bus& bus, const DatagramPlan& datagram) {
    std::string text;
    for (const std::size_t s : datagram.slaves) text += (text.empty() ? "" : ", ") + bus.slaves[s]->subject;
    return text;
}

/// Drives want valid outputs before OP (pain 2 of the reference).
Script<Result<void>> await_valid_outputs(Bus& bus) {
    bus.progress = "waiting for valid process data";
    const Instant started = co_await time();
    const std::uint64_t cycles_before = bus.link.cycles.load();
    for (;;) {
        if (bus.link.good_in_a_row.load() >= valid_cycles) co_return Result<void>{};
        const Instant now = co_await time();
        if (now - started > valid_outputs_timeout) {
            if (bus.link.cycles.load() - cycles_before < valid_cycles)
                co_return Error{"bus.no_cycle", "bus", "all slaves are in SAFEOP, but no cycle sends process data",
                                "start the machine's cycle before the bus is brought to OP"};
            const std::size_t d = bus.link.worst_datagram.load();
            if (d < bus.plan.datagrams.size() && bus.link.worst_wkc.load() != bus.plan.datagrams[d].expected_wkc)
                co_return Error{"bus.working_counter", slaves_of(bus, bus.plan.datagrams[d]),
                                fmt::format("process data comes back with working counter {}, expected {}", bus.link.worst_wkc.load(),
                                            bus.plan.datagrams[d].expected_wkc),
                                "the slave does not take part: check its sync managers and FMMUs, and that it is the device configured"};
            co_return Error{
                "bus.no_frame", "bus", "process data frames do not come back in time",
                "the cycle is too short for the way out and back, or the link loses frames: check cable and NIC, or lengthen the cycle"};
        }
        co_await pause(bus.config.cycle);
    }
}

Script<Result<void>> climb(Bus& bus) {
    bus.phase.store(BusPhase::scanning);
    Result<void> done = co_await scan(bus);
    if (!done) co_return done;

    bus.phase.store(BusPhase::preop);
    done = co_await for_each_slave(bus, &enter_preop);
    if (!done) co_return done;

    bus.phase.store(BusPhase::configuring);
    done = co_await for_each_slave(bus, &prepare);
    if (!done) co_return done;
    Result<ProcessDataPlan> plan = plan_bus(bus);
    if (!plan) co_return plan.error();
    bus.plan = std::move(*plan);
    done = co_await setup_clocks(bus);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &program_process_data);
    if (!done) co_return done;
    for (auto& slave : bus.slaves) slave->in_line = true;
    bus.publish();
    co_await pause(3 * bus.config.cycle);  // lets a running cycle show itself
    done = co_await await_clocks(bus);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &start_sync0);
    if (!done) co_return done;

    bus.phase.store(BusPhase::safeop);
    done = co_await for_each_slave(bus, &to_safeop);
    if (!done) co_return done;
    bus.link.supervise.store(true);
    done = co_await await_valid_outputs(bus);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &write_startup_op);
    if (!done) co_return done;
    done = co_await for_each_slave(bus, &to_op);
    co_return done;
}

/// While it lives the cycle gives the reference time to nobody.
class ClockHold {
public:
    explicit ClockHold(Bus& bus) : bus_(bus) { bus_.link.hold_clock.store(true); }
    ~ClockHold() { bus_.link.hold_clock.store(false); }
    ClockHold(const ClockHold&) = delete;
    ClockHold& operator=(const ClockHold&) = delete;

private:
    Bus& bus_;
};

/// The slave at this position has another (or no) station address: was it power-cycled, or is it another device?
Script<Result<void>> readdress(Bus& bus, BusSlave& slave) {
    const std::uint16_t position = slave.found.position;
    const Reply address = co_await bus.port.aprd(position, reg::station_address, 2);
    if (!address.ok()) co_return unanswered(slave.subject, "its station address (0010h)", address);
    if (address.u16() == slave.found.station) co_return Result<void>{};
    if (bus.reference == slave.index) {
        const ClockHold hold{bus};
        co_await pause(3 * bus.config.cycle);  // frames under way
        const Result<void> clock = co_await restore_clock(bus, slave);
        if (!clock) co_return clock;
        const Reply addressed = co_await bus.port.apwr(position, reg::station_address, slave.found.station);
        if (!addressed.ok()) co_return unanswered(slave.subject, "its station address (0010h)", addressed);
    }
    const Reply written = co_await bus.port.apwr(position, reg::station_address, slave.found.station);
    if (!written.ok()) co_return unanswered(slave.subject, "its station address (0010h)", written);
    const FoundSlave found = co_await read_slave(bus.port, position, slave.subject);
    if (found.error) co_return *found.error;
    const Result<void> identity = check_identity(slave.subject, slave.device(), found.identity);
    if (!identity) co_return identity;
    slave.found.dl_status = found.dl_status;
    co_return Result<void>{};
}

Script<void> watch(Bus& bus, BusSlave& slave) {
    bool reported = false;
    Instant look = co_await time();
    Instant last_difference = look;
    for (;;) {
        Instant now = co_await pause(watch_glance);
        constexpr auto all_op = static_cast<std::uint32_t>(AlState::op);
        const bool suspicious = bus.link.states_seen.load() != all_op;
        if (now < look && !(suspicious && now >= look - watch_period + watch_suspicious)) continue;
        look = now + watch_period;

        const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
        if (!status) slave.al.store(0);
        if (status && *status == all_op) {
            reported = false;
            if (slave.dc && bus.reference != slave.index && now - last_difference >= std::chrono::seconds{1}) {
                last_difference = now;
                const Reply reply = co_await bus.port.fprd(slave.found.station, reg::dc_difference, 4);
                if (reply.ok()) slave.dc_difference = std::abs(static_cast<std::int64_t>(dc_difference_ns(reply.u32())));
                std::int64_t worst = 0;
                for (const auto& other : bus.slaves) worst = std::max(worst, other->dc_difference);
                bus.link.dc_difference_ns.store(worst);
            }
            continue;
        }
        if (!reported)
            bus.remember(status ? fmt::format("{} left OP: status 0x{:04X}, code 0x{:04X} {}", slave.subject, *status,
                                              slave.al.load() >> 16, al_status_info(static_cast<std::uint16_t>(slave.al.load() >> 16)).text)
                                : status.error().text());
        const Result<void> back = co_await recover(bus, slave);
        if (back) {
            slave.recoveries.fetch_add(1);
            bus.remember(slave.subject + " is back in OP");
            reported = false;
        } else {
            if (!reported) bus.remember(back.error().text());
            reported = true;
            co_await pause(retry_period);
        }
    }
}

}  // namespace

Script<Result<void>> bring_up(Bus& bus) {
    bus.link.supervise.store(false);
    bus.link.good_in_a_row.store(0);
    const Result<void> done = co_await climb(bus);
    bus.phase.store(done ? BusPhase::operational : BusPhase::failed);
    bus.progress = done ? std::string{"operational"} : done.error().text();
    co_return done;
}

Script<Result<void>> recover(Bus& bus, BusSlave& slave) {
    Result<void> done = co_await readdress(bus, slave);
    if (!done) co_return done;
    Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();

    // After INIT everything is gone. In SAFEOP (watchdog, synchronisation lost) and PREOP the slave still has its settings.
    const AlState state = al_state(*status);
    if (state == AlState::init || state == AlState::boot || state == AlState::unknown) {
        done = co_await set_state(bus, slave, AlState::init);
        if (!done) co_return done;
        done = co_await stop_sync0(bus, slave);
        if (!done) co_return done;
        done = co_await enter_preop(bus, slave);
        if (!done) co_return done;
    }
    if (state != AlState::safeop && state != AlState::op) {
        done = co_await prepare(bus, slave);
        if (!done) co_return done;
        const auto& plan = bus.plan.slaves[slave.index];
        const bool same = (mapped_bits(slave.rx) + 7) / 8 == plan.outputs.size && (mapped_bits(slave.tx) + 7) / 8 == plan.inputs.size;
        if (slave.has_mailbox() && !same)
            co_return Error{"bus.pdo_mismatch", slave.subject, "it came back with other PDOs than before", "restart the machine"};
        if (bus.reference != slave.index) {
            done = co_await restore_clock(bus, slave);
            if (!done) co_return done;
        }
        done = co_await program_process_data(bus, slave);
        if (!done) co_return done;
        done = co_await start_sync0(bus, slave);
        if (!done) co_return done;
        done = co_await set_state(bus, slave, AlState::safeop);
        if (!done) co_return done;
    } else if (state == AlState::safeop) {
        done = co_await set_state(bus, slave, AlState::safeop);  // acknowledges the error
        if (!done) co_return done;
    }
    done = co_await write_startup_op(bus, slave);
    if (!done) co_return done;
    co_await pause(static_cast<std::int64_t>(valid_cycles) * bus.config.cycle);
    co_return co_await set_state(bus, slave, AlState::op);
}

Script<void> keep_alive(Bus& bus) {
    std::vector<Script<void>> scripts;
    for (auto& slave : bus.slaves) scripts.push_back(watch(bus, *slave));
    co_await all(std::move(scripts));
}

Script<Result<void>> take_down(Bus& bus) {
    bus.phase.store(BusPhase::stopping);
    static constexpr std::array down_to{AlState::safeop, AlState::preop, AlState::init};
    for (const AlState state : down_to) {
        if (state == AlState::preop) bus.link.supervise.store(false);
        for (auto& slave : bus.slaves) {
            const Result<std::uint16_t> status = co_await read_al_status(bus, *slave);
            if (!status || al_state(*status) <= state) continue;
            const Result<void> down = co_await set_state(bus, *slave, state);
            if (!down) bus.remember(down.error().text());
            if (state == AlState::preop) {
                const Result<void> quiet = co_await stop_sync0(bus, *slave);
                if (!quiet) bus.remember(quiet.error().text());
            }
        }
    }
    bus.phase.store(BusPhase::stopped);
    bus.progress = "stopped";
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

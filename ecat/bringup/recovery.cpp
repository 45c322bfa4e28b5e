#include "ecat/bringup/recovery.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_match.hpp"
#include "ecat/bringup/slave_setup.hpp"

namespace taktwerk::ecat {

namespace {

Error not_there(const BusSlave& slave) {
    return Error{"bus.no_slave", slave.subject, "was not there when the slaves on the cable were counted last",
                 "they are counted again by themselves; when it stays away check its power and its cable"};
}

Script<Result<void>> write_address(Bus& bus, BusSlave& slave, std::uint16_t position, std::uint16_t station) {
    const Reply written = co_await bus.port.apwr(position, reg::station_address, station);
    if (!written.ok()) co_return unanswered(slave.subject, "its station address (0010h)", written);
    co_return Result<void>{};
}

/// Takes the slave's station address from everybody who has it and does not stand in its place.
Script<void> free_address(Bus& bus, BusSlave& slave) {
    for (const std::uint16_t position : positions_now(bus.link.ring.load(), bus.counted)) {
        if (position == slave.position_now) continue;
        const Reply address = co_await bus.port.aprd(position, reg::station_address, 2);
        if (address.ok() && address.u16() == slave.found.station) (void)co_await write_address(bus, slave, position, 0);
    }
}

/// Gives the slave its station address where it stands now. The reference gets its time before: once it has the address, its
/// clock is everybody's.
Script<Result<void>> give_address(Bus& bus, BusSlave& slave, std::uint16_t position) {
    if (bus.reference != slave.index) co_return co_await write_address(bus, slave, position, slave.found.station);
    const ClockHold hold{bus};
    co_await pause(3 * bus.config.cycle);  // frames under way
    const Result<void> clock = co_await restore_clock(bus, slave);
    if (!clock) co_return clock;
    co_return co_await write_address(bus, slave, position, slave.found.station);
}

/// Somewhere else stands a slave with `other`'s address: was it plugged there? Not when its own place is taken as well; then
/// somebody has written addresses, and places count.
Script<bool> moved_here(Bus& bus, const BusSlave& other) {
    if (!other.position_now) co_return true;
    const Reply address = co_await bus.port.aprd(*other.position_now, reg::station_address, 2);
    co_return !address.ok() || address.u16() == other.found.station;
}

/// The slave does not answer to its station address: was it power-cycled, is it another device, or did somebody change the
/// address? Whoever has the address of another configured slave is left alone.
Script<Result<void>> readdress(Bus& bus, BusSlave& slave) {
    const Reply own = co_await bus.port.fprd(slave.found.station, reg::station_address, 2);
    if (own.lost) co_return unanswered(slave.subject, "its station address (0010h)", own);
    if (own.ok() && slave.identified) co_return Result<void>{};
    if (!slave.position_now) co_return not_there(slave);
    const std::uint16_t position = *slave.position_now;
    if (own.wkc > 1) co_await free_address(bus, slave);

    const Reply address = co_await bus.port.aprd(position, reg::station_address, 2);
    if (!address.ok()) co_return unanswered(slave.subject, "its station address (0010h)", address);
    for (const auto& other : bus.slaves) {
        if (other.get() == &slave || address.u16() != other->found.station) continue;
        const bool moved = co_await moved_here(bus, *other);
        if (moved)
            co_return Error{"bus.wrong_place", slave.subject, fmt::format("in its place stands {}", other->subject),
                            "the cables were swapped: plug them back, or restart the bus"};
    }
    const Result<void> given = co_await give_address(bus, slave, position);
    if (!given) co_return given;
    const FoundSlave found = co_await read_slave(bus.port, position, slave.found.station, slave.subject);
    const Result<void> identity = found.error ? Result<void>{*found.error}
                                  : slave.own ? check_identity(slave.subject, *slave.own, found.identity)
                                              : check_identity(slave.subject, *slave.config, found.identity);
    if (!identity) {
        (void)co_await write_address(bus, slave, position, 0);  // whatever stands there must not be taken for this slave
        co_return identity;
    }
    slave.identified = true;
    slave.found.dl_status = found.dl_status;
    co_return Result<void>{};
}

/// The same objects at the same bits, whatever PDOs carry them.
bool same_entries(const std::vector<PdoDescription>& a, const std::vector<PdoDescription>& b) {
    return std::ranges::equal(a, b, [](const auto& one, const auto& other) { return one.entries == other.entries; });
}

/// Nothing: it does not answer.
Script<std::optional<bool>> reads_as(Bus& bus, std::uint16_t station, std::uint16_t address, const std::vector<std::byte>& wanted) {
    const Reply reply = co_await bus.port.fprd(station, address, wanted.size());
    if (!reply.ok()) co_return std::nullopt;
    co_return reply.data == wanted;
}

}  // namespace

Script<Result<void>> recover(Bus& bus, BusSlave& slave) {
    Result<void> done = co_await readdress(bus, slave);
    if (!done) co_return done;
    slave.link.presence.store(Presence::answers);  // it has its address again: from here on what it does is its own
    Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();

    // After INIT everything is gone. In SAFEOP (watchdog, synchronisation lost) and PREOP the slave still has its settings.
    AlState state = al_state(*status);
    if (state == AlState::safeop) {
        const Result<std::string> changed = co_await changed_setting(bus, slave);
        if (changed && !changed->empty()) {
            slave.not_exchanged = *changed + " is not as it was written: something wrote to it";
            slave.link.taken_down.store(true);
            bus.remember(slave.subject + ": " + slave.not_exchanged + "; it is set up again");
            state = AlState::init;
        }
    }
    if (state == AlState::init || state == AlState::boot || state == AlState::unknown) {
        done = co_await set_state(bus, slave, AlState::init);
        if (!done) co_return done;
        done = co_await stop_sync0(bus, slave);
        if (!done) co_return done;
        done = co_await enter_preop(bus, slave);
        if (!done) co_return done;
    }
    if (state != AlState::safeop && state != AlState::op) {
        const auto rx_before = slave.rx, tx_before = slave.tx;
        done = co_await prepare_process_data(bus, slave);
        if (!done) co_return done;
        const auto& plan = bus.plan.slaves[slave.index];
        const auto mapping = map_slave(plan_input(slave));
        const bool same = mapping && mapping->outputs.bytes == plan.outputs.size && mapping->inputs.bytes == plan.inputs.size;
        const bool same_objects = same_entries(rx_before, slave.rx) && same_entries(tx_before, slave.tx);
        if (slave.has_coe() && (!same || !same_objects)) {
            slave.rx = rx_before, slave.tx = tx_before;  // what the next attempt is held against
            co_return slave.config->guest()
                ? Error{"bus.pdo_mismatch", slave.subject, "its process data is not what its description says",
                        "correct the description: `taktwerk bus init` reads what the device has"}
                : Error{"bus.pdo_mismatch", slave.subject, "it came back with other PDOs than before", "restart the machine"};
        }
        if (bus.reference != slave.index) {
            done = co_await restore_clock(bus, slave);
            if (!done) co_return done;
        }
        done = co_await program_process_data(bus, slave);
        if (!done) co_return done;
        done = co_await start_sync_before_safeop(bus, slave);
        if (!done) co_return done;
        done = co_await set_state(bus, slave, AlState::safeop);
        if (!done) co_return done;
        done = co_await start_sync_in_safeop(bus, slave);
        if (!done) co_return done;
    } else if (state == AlState::safeop) {
        done = co_await set_state(bus, slave, AlState::safeop);  // acknowledges the error
        if (!done) co_return done;
    }
    done = co_await write_startup_op(bus, slave);
    if (!done) co_return done;
    co_await pause(static_cast<std::int64_t>(valid_cycles) * exchange_period(bus.config, *slave.config));
    co_return co_await set_state(bus, slave, AlState::op);
}

Script<Result<std::string>> changed_setting(Bus& bus, BusSlave& slave) {
    const auto& plan = bus.plan.slaves[slave.index];
    const std::uint16_t station = slave.found.station;
    std::string changed;
    // What the master writes of a sync manager: start, length, control; status and the slave's own bits change by themselves.
    constexpr std::size_t settings_of_sm = 5;
    for (const auto& sm : plan.sync_managers) {
        std::vector<std::byte> bytes(SyncManager::size);
        encode(sm.registers, std::span<std::byte, SyncManager::size>{bytes});
        bytes.resize(settings_of_sm);
        const std::optional<bool> same = co_await reads_as(bus, station, reg::sync_manager_at(sm.number), bytes);
        if (!same) co_return not_there(slave);
        if (!*same && changed.empty()) changed = fmt::format("SM{}", sm.number);
    }
    for (std::size_t n = 0; n < plan.fmmus.size(); ++n) {
        std::vector<std::byte> bytes(Fmmu::size);
        encode(plan.fmmus[n], std::span<std::byte, Fmmu::size>{bytes});
        const std::optional<bool> same = co_await reads_as(bus, station, reg::fmmu_at(static_cast<unsigned>(n)), bytes);
        if (!same) co_return not_there(slave);
        if (!*same && changed.empty()) changed = fmt::format("FMMU{}", n);
    }
    co_return changed;
}

}  // namespace taktwerk::ecat

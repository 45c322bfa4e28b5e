#include "ecat/bringup/recovery.hpp"

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/clocks.hpp"
#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_setup.hpp"

namespace taktwerk::ecat {

namespace {

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

}  // namespace

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
        done = co_await prepare_process_data(bus, slave);
        if (!done) co_return done;
        const auto& plan = bus.plan.slaves[slave.index];
        const auto mapping = map_slave(plan_input(slave));
        const bool same = mapping && mapping->outputs.bytes == plan.outputs.size && mapping->inputs.bytes == plan.inputs.size;
        if (slave.has_coe() && !same)
            co_return Error{"bus.pdo_mismatch", slave.subject, "it came back with other PDOs than before", "restart the machine"};
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

}  // namespace taktwerk::ecat

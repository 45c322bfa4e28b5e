#include "ecat/firmware/boot_state.hpp"

#include <fmt/format.h>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/mailbox_setup.hpp"
#include "ecat/bringup/presence.hpp"
#include "ecat/mailbox/take_over.hpp"
#include "ecat/wire/foe.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration return_poll = std::chrono::milliseconds{20};

Script<Result<void>> set_up_mailbox(Bus& bus, BusSlave& slave, std::uint8_t number, SiiMailbox where, std::uint8_t control) {
    SyncManager sm;
    sm.activate = SyncManager::enable;
    sm.start = where.start;
    sm.length = where.size;
    sm.control = control;
    co_return co_await write_sync_manager(bus, slave, number, sm);
}

/// Left in BOOT by an update that broke off: its mailboxes stand in its sync managers.
Script<Result<void>> stay_in_boot(Bus& bus, BusSlave& slave) {
    slave.mailbox.reset();
    const Result<bool> found = co_await find_mailboxes(bus, slave);
    if (!found) co_return found.error();
    if (!*found)
        co_return Error{"foe.no_boot", slave.subject, "is in BOOT without mailboxes", "take it to INIT first: taktwerk bus state init"};
    co_return co_await take_over(bus.port, slave.mailbox);
}

/// A controller that was reset has no station address: 0010h reads 0.
Script<void> give_address_again(Bus& bus, BusSlave& slave) {
    co_await take_census(bus);
    if (!slave.position_now) co_return;
    const std::uint16_t position = *slave.position_now;
    const Reply address = co_await bus.port.aprd(position, reg::station_address, 2);
    if (!address.ok() || address.u16() != 0) co_return;
    const Reply written = co_await bus.port.apwr(position, reg::station_address, slave.found.station);
    (void)written;  // whether it has it now is seen when it is asked by it
}

}  // namespace

Script<Result<void>> clear_mailboxes(Bus& bus, BusSlave& slave) {
    const std::vector<std::byte> off(2 * SyncManager::size);
    const Reply reply = co_await bus.port.fpwr(slave.found.station, reg::sync_manager, off);
    if (!reply.ok()) co_return unanswered(slave.subject, "its mailbox sync managers (0800h)", reply);
    co_return Result<void>{};
}

Script<Result<void>> enter_boot(Bus& bus, BusSlave& slave) {
    const SiiMailbox out = slave.found.sii.boot_mailbox_out, in = slave.found.sii.boot_mailbox_in;
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    if (al_state(*status) == AlState::boot && (*status & al_status_error) == 0) co_return co_await stay_in_boot(bus, slave);
    if (foe_room(out.size) == 0 || foe_room(in.size) == 0)
        co_return Error{"foe.no_boot", slave.subject,
                        fmt::format("its EEPROM names no mailboxes for BOOT (words 14h to 17h: {} and {} bytes)", out.size, in.size),
                        "it takes its firmware another way: see its manual; some take it in PREOP (taktwerk bus file write)"};
    const Result<void> down = co_await set_state(bus, slave, AlState::init);
    if (!down) co_return down;
    slave.mailbox.reset();
    place_mailboxes(slave, out, in);
    Result<void> written = co_await clear_mailboxes(bus, slave);
    if (!written) co_return written;
    written = co_await set_up_mailbox(bus, slave, 0, out, SyncManager::usual_mailbox_out);
    if (!written) co_return written;
    written = co_await set_up_mailbox(bus, slave, 1, in, SyncManager::usual_mailbox_in);
    if (!written) co_return written;
    co_return co_await set_state(bus, slave, AlState::boot);
}

Script<Result<void>> await_back(Bus& bus, BusSlave& slave, Duration patience) {
    const Instant started = co_await time();
    for (;;) {
        const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
        if (status) co_return Result<void>{};
        const Instant now = co_await time();
        if (now - started >= patience)
            co_return Error{"firmware.not_back", slave.subject,
                            fmt::format("it has not answered for {} s", (now - started) / std::chrono::seconds{1}),
                            "check its power and its cable; switch it off and on, then see with `taktwerk bus scan`"};
        co_await give_address_again(bus, slave);
        co_await pause(return_poll);
    }
}

Script<Result<void>> leave_boot(Bus& bus, BusSlave& slave, Duration patience) {
    const Result<void> asked = co_await set_state(bus, slave, AlState::init);
    const bool silent = !asked && (asked.error().code == "bus.no_slave" || asked.error().code == "bus.no_frame");
    if (!asked && !silent) co_return asked;
    co_return co_await await_back(bus, slave, patience);
}

}  // namespace taktwerk::ecat

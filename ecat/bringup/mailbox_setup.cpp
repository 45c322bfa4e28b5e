#include "ecat/bringup/mailbox_setup.hpp"

#include <fmt/format.h>

#include <array>

#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/slave_objects.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t least_mailbox = 16;     ///< header 6, CoE 2, SDO 8
constexpr std::uint16_t least_mailbox_any = 8;  ///< header 6 and something in it

const SyncManagerDescription* find_mailbox(const DeviceDescription& device, SmUse use, std::uint8_t& number) {
    for (std::size_t n = 0; n < device.sync_managers.size(); ++n)
        if (device.sync_managers[n].use == use) {
            number = static_cast<std::uint8_t>(n);
            return &device.sync_managers[n];
        }
    return nullptr;
}

Result<void> locate_mailbox(Bus& bus, BusSlave& slave) {
    auto& mailbox = slave.mailbox;
    mailbox.subject = slave.subject;
    mailbox.slave = slave.index;
    mailbox.log = &bus.emergencies;
    if (const auto& described = slave.device().mailbox) {
        mailbox.max_pending = described->max_pending;
        mailbox.complete_access = described->complete_access;
    }
    mailbox.station = slave.found.station;
    const auto* out = find_mailbox(slave.device(), SmUse::mailbox_out, mailbox.out_sm);
    const auto* in = find_mailbox(slave.device(), SmUse::mailbox_in, mailbox.in_sm);
    mailbox.out_start = out != nullptr && out->size != 0 ? out->start : slave.found.mailbox[0];
    mailbox.out_size = out != nullptr && out->size != 0 ? out->size : slave.found.mailbox[1];
    mailbox.in_start = in != nullptr && in->size != 0 ? in->start : slave.found.mailbox[2];
    mailbox.in_size = in != nullptr && in->size != 0 ? in->size : slave.found.mailbox[3];
    const std::uint16_t least = slave.has_coe() ? least_mailbox : least_mailbox_any;
    if (mailbox.out_size < least || mailbox.in_size < least)
        return Error{"bus.no_mailbox", slave.subject,
                     fmt::format("its mailboxes are {} and {} bytes: neither profile nor EEPROM give usable sizes", mailbox.out_size,
                                 mailbox.in_size),
                     "enter the mailbox sync managers in its profile"};
    return {};
}

}  // namespace

void place_mailboxes(BusSlave& slave, SiiMailbox out, SiiMailbox in) {
    auto& mailbox = slave.mailbox;
    mailbox.subject = slave.subject;
    mailbox.station = slave.found.station;
    mailbox.slave = slave.index;
    mailbox.out_start = out.start;
    mailbox.out_size = out.size;
    mailbox.in_start = in.start;
    mailbox.in_size = in.size;
    mailbox.out_sm = 0;
    mailbox.in_sm = 1;
}

Script<Result<bool>> find_mailboxes(Bus& bus, BusSlave& slave) {
    const Reply reply = co_await bus.port.fprd(slave.found.station, reg::sync_manager, 2 * SyncManager::size);
    if (!reply.ok()) co_return unanswered(slave.subject, "its mailbox sync managers (0800h)", reply);
    const std::span<const std::byte> bytes{reply.data};
    const SyncManager out = decode_sync_manager(bytes.first<SyncManager::size>());
    const SyncManager in = decode_sync_manager(bytes.subspan<SyncManager::size, SyncManager::size>());
    if (!out.enabled() || !in.enabled() || !out.is_mailbox() || !in.is_mailbox()) co_return false;
    place_mailboxes(slave, {out.start, out.length}, {in.start, in.length});
    slave.mailbox.repeat_toggle = (in.activate & SyncManager::repeat_request) != 0;
    co_return true;
}

Script<Result<void>> write_sync_manager(Bus& bus, BusSlave& slave, std::uint8_t number, SyncManager registers) {
    std::vector<std::byte> bytes(SyncManager::size);
    encode(registers, std::span<std::byte, SyncManager::size>{bytes});
    const Reply reply = co_await bus.port.fpwr(slave.found.station, reg::sync_manager_at(number), bytes);
    if (!reply.ok()) co_return unanswered(slave.subject, fmt::format("sync manager {}", number), reply);
    co_return Result<void>{};
}

Script<Result<void>> enter_preop(Bus& bus, BusSlave& slave) {
    slave.mailbox.reset();
    if (slave.has_mailbox()) {
        const Result<void> located = locate_mailbox(bus, slave);
        if (!located) co_return located;
        SyncManager sm;
        sm.activate = SyncManager::enable;
        sm.start = slave.mailbox.out_start;
        sm.length = slave.mailbox.out_size;
        sm.control = SyncManager::usual_mailbox_out;
        Result<void> written = co_await write_sync_manager(bus, slave, slave.mailbox.out_sm, sm);
        if (!written) co_return written;
        sm.start = slave.mailbox.in_start;
        sm.length = slave.mailbox.in_size;
        sm.control = SyncManager::usual_mailbox_in;
        written = co_await write_sync_manager(bus, slave, slave.mailbox.in_sm, sm);
        if (!written) co_return written;
    }
    co_return co_await set_state(bus, slave, AlState::preop);
}

Script<Result<void>> compare_identity(Bus& bus, BusSlave& slave) {
    if (!slave.has_coe()) co_return Result<void>{};
    const std::array<std::uint32_t, 3> eeprom{slave.found.identity.vendor, slave.found.identity.product, slave.found.identity.revision};
    const std::array<const char*, 3> what{"vendor", "product", "revision"};
    for (std::size_t i = 0; i < eeprom.size(); ++i) {
        const auto sub = static_cast<std::uint8_t>(i + 1);
        const Result<std::uint32_t> value = co_await read_number(bus, slave, 0x1018, sub);
        if (!value && is_absent(value.error())) co_return Result<void>{};
        if (!value) co_return value.error();
        if (*value != eeprom[i])
            bus.remember(fmt::format("{}: its EEPROM says {} {:08X}h, its object 1018h:{:02X} says {:08X}h; the EEPROM counts",
                                     slave.subject, what[i], eeprom[i], sub, *value));
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

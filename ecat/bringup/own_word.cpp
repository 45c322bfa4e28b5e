#include "ecat/bringup/own_word.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/effective_pdos.hpp"
#include "ecat/bringup/slave_match.hpp"
#include "ecat/bringup/slave_objects.hpp"

namespace taktwerk::ecat {

namespace {

bool uses(const std::vector<SyncManagerDescription>& managers, SmUse use) {
    return std::ranges::any_of(managers, [&](const auto& sm) { return sm.use == use; });
}

/// The mailbox of the EEPROM's header, where its list of sync managers leaves sizes open.
void place_mailboxes(std::vector<SyncManagerDescription>& managers, const std::array<std::uint16_t, 4>& header) {
    for (auto& sm : managers) {
        const bool out = sm.use == SmUse::mailbox_out;
        if (!out && sm.use != SmUse::mailbox_in) continue;
        const auto start = header[out ? 0 : 2], size = header[out ? 1 : 3];
        if (size != 0) sm.start = start, sm.size = size;
    }
}

// 1C32h:04 (ETG.1020 table 85): bit 0 free run, bit 1 by the sync manager, bits 2 to 4 by SYNC0 or SYNC1 in their variants.
constexpr std::uint16_t sync_parameters = 0x1C32;
constexpr std::uint8_t supported_types = 4;
constexpr std::uint32_t by_clock = 0x1C;

}  // namespace

void take_own_word(Bus& bus, BusSlave& slave) {
    const auto& described = *slave.config->device;
    slave.own.reset();
    if (described.stated.identity && described.stated.controller) return;
    auto& own = slave.own.emplace(described);
    if (!described.stated.identity) {
        own.identity = slave.found.identity;
        own.stated.identity = true;  // it is the one from now on
        bus.remember(fmt::format("{}: taken for it is {}", slave.subject, found_text(slave.found)));
    }
    if (described.stated.controller) return;
    auto in_eeprom = sync_managers_in_eeprom(slave.found.sii);
    if (uses(in_eeprom, SmUse::outputs) && uses(in_eeprom, SmUse::inputs)) own.sync_managers = std::move(in_eeprom);
    else
        bus.remember(fmt::format("{}: its EEPROM lists no sync managers for process data; those of '{}' are assumed", slave.subject,
                                 described.name));
    place_mailboxes(own.sync_managers, slave.found.mailbox);
}

Script<Result<void>> ask(Bus& bus, BusSlave& slave) {
    slave.answers.assign(slave.config->asked.size(), std::nullopt);
    if (!slave.has_coe()) co_return Result<void>{};
    for (std::size_t i = 0; i < slave.config->asked.size(); ++i) {
        const AskedObject object = slave.config->asked[i];
        const Result<std::uint32_t> value = co_await read_number(bus, slave, object.index, object.sub);
        if (value) slave.answers[i] = *value;
        else if (value.error().code != "sdo.abort") co_return value.error();
    }
    if (slave.config->device->stated.process_data || !slave.config->dc) co_return Result<void>{};
    const Result<std::uint32_t> types = co_await read_number(bus, slave, sync_parameters, supported_types);
    if (!types && types.error().code != "sdo.abort") co_return types.error();
    if (types && *types != 0 && (*types & by_clock) == 0)
        co_return Error{"bus.no_sync0", slave.subject,
                        fmt::format("it does not work by SYNC0: its 1C32h:04 is {:04X}h, {}", *types,
                                    (*types & 2) != 0 ? "by arriving process data" : "free running"),
                        "set `dc: false` at this slave"};
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

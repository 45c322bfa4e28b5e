#include "ecat/bringup/slave_setup.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/effective_pdos.hpp"
#include "ecat/bringup/modules.hpp"
#include "ecat/bringup/own_word.hpp"
#include "ecat/bringup/watchdogs.hpp"

namespace taktwerk::ecat {

namespace {

/// Sync managers of a slave that cannot be asked: the EEPROM's sizes where it states them, else the description's, else what
/// the PDOs need.
std::vector<SyncManagerDescription> plain_sync_managers(const BusSlave& slave) {
    const auto in_eeprom = sync_managers_in_eeprom(slave.found.sii);
    std::vector<SyncManagerDescription> managers = slave.device().sync_managers;
    if (managers.empty()) managers = in_eeprom;
    for (std::size_t n = 0; n < managers.size(); ++n) {
        auto& sm = managers[n];
        if (sm.use != SmUse::outputs && sm.use != SmUse::inputs) continue;
        if (n < in_eeprom.size() && in_eeprom[n].use == sm.use && in_eeprom[n].size != 0) sm.size = in_eeprom[n].size;
        if (sm.size != 0) continue;
        std::size_t bits = 0;
        for (const auto& pdo : sm.use == SmUse::outputs ? slave.rx : slave.tx)
            if (pdo.sync_manager.value_or(n) == n) bits += mapped_bits({&pdo, 1});
        sm.size = static_cast<std::uint16_t>((bits + 7) / 8);
    }
    return managers;
}

}  // namespace

Script<Result<void>> prepare_process_data(Bus& bus, BusSlave& slave) {
    const Result<void> modules = co_await configure_modules(bus, slave);
    if (!modules) co_return modules;
    const Result<void> written = co_await write_startup_safeop(bus, slave);
    if (!written) co_return written;
    const Result<void> asked = co_await ask(bus, slave);
    if (!asked) co_return asked;
    co_return co_await assign_pdos(bus, slave);
}

Script<Result<void>> program_process_data(Bus& bus, BusSlave& slave) {
    const auto& plan = bus.plan.slaves[slave.index];
    bus.note(slave, "programming sync managers and FMMUs");
    for (const auto& sm : plan.sync_managers) {
        const Result<void> written = co_await write_sync_manager(bus, slave, sm.number, sm.registers);
        if (!written) co_return written;
    }
    for (std::size_t n = 0; n < plan.fmmus.size(); ++n) {
        std::vector<std::byte> bytes(Fmmu::size);
        encode(plan.fmmus[n], std::span<std::byte, Fmmu::size>{bytes});
        const Reply reply = co_await bus.port.fpwr(slave.found.station, reg::fmmu_at(static_cast<unsigned>(n)), bytes);
        if (!reply.ok()) co_return unanswered(slave.subject, fmt::format("FMMU {}", n), reply);
    }
    if (plan.mailbox_bit) slave.mailbox.flag = {&bus.link.mailbox.words[*plan.mailbox_bit / 64], *plan.mailbox_bit % 64};
    co_return co_await program_watchdogs(bus, slave);
}

PlanSlave plan_input(const BusSlave& slave) {
    PlanSlave input;
    input.subject = slave.subject;
    input.sync_unit = slave.config->sync_unit;
    input.coe = slave.has_coe();
    input.sync_managers = input.coe ? slave.device().sync_managers : plain_sync_managers(slave);
    input.rx = slave.rx;
    input.tx = slave.tx;
    input.fmmus = slave.found.fmmus;
    input.sync_manager_count = slave.found.sync_managers;
    input.lrw = (slave.found.features & feature::no_lrw) == 0;
    input.bitwise_fmmu = (slave.found.features & feature::fmmu_not_bitwise) == 0;
    // The bit of one that is away would make nobody's certain.
    if (input.coe && !slave.config->guest()) input.mailbox_in = slave.mailbox.in_sm;
    return input;
}

}  // namespace taktwerk::ecat

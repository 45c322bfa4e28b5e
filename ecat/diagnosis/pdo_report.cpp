#include "ecat/diagnosis/pdo_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/al_control.hpp"
#include "ecat/diagnosis/mailbox_access.hpp"
#include "ecat/diagnosis/object_value.hpp"

namespace taktwerk::ecat {

namespace {

/// An unsigned object of up to 4 bytes.
Script<Result<std::uint32_t>> read_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    const Result<std::vector<std::byte>> bytes = co_await read_object(bus, slave, index, sub);
    if (!bytes) co_return bytes.error();
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, bytes->size()); ++i) value |= static_cast<std::uint32_t>((*bytes)[i]) << (8 * i);
    co_return value;
}

void place(SyncManagerReport& sm) {
    std::uint32_t offset = 0;
    for (auto& pdo : sm.pdos)
        for (auto& entry : pdo.entries) {
            entry.bit_offset = offset;
            offset += entry.bits;
        }
    sm.mapped_bytes = (offset + 7) / 8;
}

/// Which PDOs the slave has assigned to the sync manager, in its own words.
Script<Result<std::vector<PdoMapReport>>> read_assigned(Bus& bus, BusSlave& slave, std::uint8_t sm) {
    std::vector<PdoMapReport> pdos;
    const auto assignment = static_cast<std::uint16_t>(0x1C10 + sm);
    const Result<std::uint32_t> count = co_await read_number(bus, slave, assignment, 0);
    if (!count) co_return count.error();
    for (unsigned i = 1; i <= (*count & 0xFFu); ++i) {
        const Result<std::uint32_t> index = co_await read_number(bus, slave, assignment, static_cast<std::uint8_t>(i));
        if (!index) co_return index.error();
        PdoMapReport pdo;
        pdo.index = static_cast<std::uint16_t>(*index);
        const Result<std::uint32_t> entries = co_await read_number(bus, slave, pdo.index, 0);
        if (!entries) co_return entries.error();
        for (unsigned k = 1; k <= (*entries & 0xFFu); ++k) {
            const Result<std::uint32_t> raw = co_await read_number(bus, slave, pdo.index, static_cast<std::uint8_t>(k));
            if (!raw) co_return raw.error();
            PdoEntryReport entry;
            entry.index = static_cast<std::uint16_t>(*raw >> 16);
            entry.sub = static_cast<std::uint8_t>(*raw >> 8);
            entry.bits = static_cast<std::uint8_t>(*raw);
            pdo.entries.push_back(std::move(entry));
        }
        pdos.push_back(std::move(pdo));
    }
    co_return pdos;
}

/// The same for a slave without CoE: its description (from a profile or its EEPROM) is all there is.
std::vector<PdoMapReport> described_pdos(const DeviceDescription& device, std::uint8_t sm, SmUse use) {
    const auto first = std::find_if(device.sync_managers.begin(), device.sync_managers.end(), [&](const auto& s) { return s.use == use; });
    const auto first_number = static_cast<std::uint8_t>(first - device.sync_managers.begin());
    const auto& pdos = use == SmUse::outputs ? device.rx_pdos : device.tx_pdos;
    const auto& assigned = use == SmUse::outputs ? device.rx_assigned : device.tx_assigned;
    std::vector<PdoMapReport> result;
    for (const auto& pdo : pdos) {
        if (pdo.sync_manager.value_or(first_number) != sm) continue;
        if (!assigned.empty() && std::find(assigned.begin(), assigned.end(), pdo.index) == assigned.end()) continue;
        PdoMapReport report;
        report.index = pdo.index;
        for (const auto& e : pdo.entries) {
            PdoEntryReport entry;
            entry.index = e.index;
            entry.sub = e.sub;
            entry.bits = e.bits;
            report.entries.push_back(std::move(entry));
        }
        result.push_back(std::move(report));
    }
    return result;
}

void name_entries(const DeviceDescription& device, SyncManagerReport& sm) {
    for (auto& pdo : sm.pdos)
        for (auto& entry : pdo.entries) {
            const auto object = std::find_if(device.objects.begin(), device.objects.end(),
                                             [&](const ObjectEntry& o) { return o.index == entry.index && o.sub == entry.sub; });
            if (object == device.objects.end() || entry.index == 0) continue;
            entry.name = object->name;
            if (bit_size(object->type) == entry.bits) entry.type = type_number(object->type);
        }
}

/// Inputs lie in the slave's buffer. Outputs cannot be read there: the slave is asked for the objects.
Script<void> read_values(Bus& bus, BusSlave& slave, SyncManagerReport& sm) {
    if (sm.use == SmUse::inputs && sm.registers.length > 0) {
        const Reply buffer = co_await bus.port.fprd(slave.found.station, sm.registers.start, sm.registers.length);
        if (!buffer.ok()) co_return;
        for (auto& pdo : sm.pdos)
            for (auto& entry : pdo.entries)
                if (entry.index != 0) entry.value = bits_of(buffer.data, entry.bit_offset, entry.bits);
    } else if (sm.use == SmUse::outputs && slave.has_coe()) {
        for (auto& pdo : sm.pdos)
            for (auto& entry : pdo.entries) {
                if (entry.index == 0) continue;
                Result<std::vector<std::byte>> value = co_await read_object(bus, slave, entry.index, entry.sub);
                if (value) entry.value = std::move(*value);
            }
    }
}

}  // namespace

Script<Result<ControllerTables>> read_tables(Bus& bus, BusSlave& slave) {
    ControllerTables tables;
    constexpr unsigned at_once = 8;
    for (unsigned n = 0; n < slave.found.sync_managers; n += at_once) {
        const unsigned count = std::min(at_once, slave.found.sync_managers - n);
        const Reply reply = co_await bus.port.fprd(slave.found.station, reg::sync_manager_at(n), count * SyncManager::size);
        if (!reply.ok()) co_return unanswered(slave.subject, "its sync managers (0800h)", reply);
        for (unsigned i = 0; i < count; ++i)
            tables.sync_managers.push_back(
                decode_sync_manager(std::span<const std::byte>{reply.data}.subspan(i * SyncManager::size).first<SyncManager::size>()));
    }
    for (unsigned n = 0; n < slave.found.fmmus; n += at_once) {
        const unsigned count = std::min(at_once, slave.found.fmmus - n);
        const Reply reply = co_await bus.port.fprd(slave.found.station, reg::fmmu_at(n), count * Fmmu::size);
        if (!reply.ok()) co_return unanswered(slave.subject, "its FMMUs (0600h)", reply);
        for (unsigned i = 0; i < count; ++i)
            tables.fmmus.push_back(decode_fmmu(std::span<const std::byte>{reply.data}.subspan(i * Fmmu::size).first<Fmmu::size>()));
    }
    co_return tables;
}

Script<Result<PdoReport>> read_pdos(Bus& bus, BusSlave& slave) {
    PdoReport report;
    report.subject = slave.subject;
    report.position = slave.found.position;
    const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
    if (!status) co_return status.error();
    report.state = al_state(*status);
    Result<ControllerTables> tables = co_await read_tables(bus, slave);
    if (!tables) co_return tables.error();
    for (unsigned n = 0; n < tables->fmmus.size(); ++n)
        if (tables->fmmus[n].active) report.fmmus.emplace_back(n, tables->fmmus[n]);

    const auto& device = slave.device();
    for (std::size_t n = 0; n < tables->sync_managers.size(); ++n) {
        SyncManagerReport sm;
        sm.number = static_cast<std::uint8_t>(n);
        sm.registers = tables->sync_managers[n];
        if (n < device.sync_managers.size()) sm.use = device.sync_managers[n].use;
        const bool process_data = sm.use == SmUse::outputs || sm.use == SmUse::inputs;
        if (!sm.registers.enabled() && !process_data) continue;
        if (process_data && !slave.has_coe()) {
            sm.pdos = described_pdos(device, sm.number, *sm.use);
        } else if (process_data && !report.error) {
            Result<std::vector<PdoMapReport>> pdos = co_await read_assigned(bus, slave, sm.number);
            if (pdos) sm.pdos = std::move(*pdos);
            else report.error = pdos.error();
        }
        place(sm);
        name_entries(device, sm);
        if (report.state == AlState::safeop || report.state == AlState::op) co_await read_values(bus, slave, sm);
        report.sync_managers.push_back(std::move(sm));
    }
    co_return report;
}

}  // namespace taktwerk::ecat

// Sync managers and PDOs.

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/esi_import/import_parts.hpp"

namespace taktwerk::config {

namespace {

using namespace ecat::esi;
using ecat::SmUse;

constexpr std::uint16_t first_pdo = 0x1600, last_pdo = 0x1BFF;
constexpr std::uint16_t first_sync_manager_start = 0x0900;
constexpr std::uint32_t most_bits = 255;  // of one entry of a mapping object: its length is a byte

Error unusable(const EsiDevice& device, std::string what, std::string remedy) {
    return {"esi.unusable", device.heading.type, std::move(what), std::move(remedy)};
}

bool speaks_coe(const EsiDevice& device) { return device.mailbox && device.mailbox->coe; }

bool is_mailbox(SmUse use) { return use == SmUse::mailbox_out || use == SmUse::mailbox_in; }

/// Bytes of all PDOs that are assigned to a sync manager.
std::uint32_t assigned_bytes(const EsiDevice& device, std::size_t sm) {
    std::uint32_t bits = 0;
    for (const auto* pdos : {&device.rx, &device.tx})
        for (const auto& pdo : *pdos)
            if (pdo.sync_manager && *pdo.sync_manager == sm)
                for (const auto& entry : pdo.entries) bits += entry.bits;
    return (bits + 7) / 8;
}

/// Without those at the end that have no address and carry nothing.
std::size_t used_sync_managers(const EsiDevice& device) {
    auto count = device.sync_managers.size();
    const auto carries = [&](std::size_t n) {
        const auto here = [&](const EsiPdo& pdo) { return pdo.sync_manager && *pdo.sync_manager == n; };
        return std::any_of(device.rx.begin(), device.rx.end(), here) || std::any_of(device.tx.begin(), device.tx.end(), here);
    };
    while (count > 0 && device.sync_managers[count - 1].start == 0 && !carries(count - 1)) --count;
    return count;
}

Result<ecat::SyncManagerDescription> import_sync_manager(const EsiDevice& device, std::size_t n, EsiImport& to) {
    const auto& from = device.sync_managers[n];
    if (!from.use) return unusable(device, fmt::format("nothing says what sync manager {} is for", n), "ask the vendor for a newer file");
    ecat::SyncManagerDescription sm{*from.use, from.start, 0, from.control};
    if (sm.start < first_sync_manager_start)
        return unusable(device, fmt::format("sync manager {} begins at {:04X}h, inside the controller's registers", n, from.start),
                        "ask the vendor for a newer file");
    if (is_mailbox(sm.use)) {
        sm.size = from.size;
        if (sm.size == 0)
            return unusable(device, fmt::format("the mailbox in sync manager {} has no size", n), "ask the vendor for a newer file");
    } else if (!speaks_coe(device)) {
        const auto bytes = assigned_bytes(device, n);
        sm.size = from.size != 0 ? from.size : static_cast<std::uint16_t>(std::min<std::uint32_t>(bytes, 0xFFFF));
        if (from.size != 0 && from.size < bytes)
            to.leftovers.push_back({fmt::format("SM{}: {} bytes by itself, {} by its PDOs", n, from.size, bytes),
                                    "the sync manager counts; the EEPROM of the device may say otherwise"});
    }
    if (!from.enable)
        to.leftovers.push_back(
            {fmt::format("SM{} is not enabled from the factory", n), "the master enables it when it carries process data"});
    if (from.is_virtual) to.leftovers.push_back({fmt::format("SM{} is virtual", n), "it is treated as a real one"});
    if (from.op_only) to.leftovers.push_back({fmt::format("SM{} works in OP only", n), "the master enables it from SAFEOP on"});
    return sm;
}

void import_mailbox(const EsiDevice& from, EsiImport& to) {
    auto& device = to.file.device;
    const bool has_one = std::any_of(from.sync_managers.begin(), from.sync_managers.end(),
                                     [](const EsiSyncManager& sm) { return sm.use && is_mailbox(*sm.use); });
    if (!from.mailbox && !has_one) return;
    device.mailbox.emplace();
    device.mailbox->coe = speaks_coe(from);
    if (!from.mailbox)
        to.leftovers.push_back({"it has sync managers for a mailbox, and nothing says what it speaks", "taken as a mailbox without CoE"});
    if (!from.mailbox) return;
    if (!from.mailbox->other_protocols.empty())
        to.leftovers.push_back({fmt::format("{}", fmt::join(from.mailbox->other_protocols, ", ")), "nobody here speaks that"});
    if (!from.mailbox->coe) return;
    const auto& coe = *from.mailbox->coe;
    device.mailbox->complete_access = coe.complete_access;
    device.mailbox->sdo_info = coe.sdo_info;
    if (!coe.pdo_assign && (!from.rx.empty() || !from.tx.empty()))
        to.leftovers.push_back({"its PDOs cannot be assigned (PdoAssign)", "leave `pdo:` away at the slave"});
    if (coe.pdo_upload) to.leftovers.push_back({"its PDOs are to be read from it (PdoUpload)", "the bring-up compares them with the file"});
}

}  // namespace

Result<ecat::PdoDescription> import_pdo(const EsiPdo& from, const EsiDevice& device, EsiImport& to) {
    if (from.index < first_pdo || from.index > last_pdo)
        return unusable(
            device, fmt::format("'{}' has the number {:04X}h; PDOs have {:04X}h to {:04X}h", from.name, from.index, first_pdo, last_pdo),
            device.mailbox && !device.mailbox->coe ? "this device does not speak CoE: it cannot be used here"
                                                   : "correct the file, or ask the vendor for a newer one");
    ecat::PdoDescription pdo;
    pdo.index = from.index;
    pdo.fixed = from.fixed || !speaks_coe(device) || !device.mailbox->coe->pdo_config;
    pdo.sync_manager = from.sync_manager;
    for (const auto& entry : from.entries) {
        if (entry.bits == 0) {
            to.leftovers.push_back({fmt::format("{:04X}h: entry '{}' without a length", from.index, entry.name), "it carries nothing"});
            continue;
        }
        const bool is_gap = entry.index == 0;
        if (!is_gap && entry.bits <= most_bits) {
            pdo.entries.push_back({entry.index, entry.sub, static_cast<std::uint8_t>(entry.bits)});
            continue;
        }
        if (!is_gap)
            to.leftovers.push_back(
                {fmt::format("{:04X}h: '{}' ({:04X}h:{:02X}) of {} bits", from.index, entry.name, entry.index, entry.sub, entry.bits),
                 "no object of a PDO has more than 255: its place is kept, its value cannot be named"});
        for (auto left = entry.bits; left > 0; left -= std::min(left, most_bits))
            pdo.entries.push_back({0, 0, static_cast<std::uint8_t>(std::min(left, most_bits))});
    }
    if (!from.excludes.empty()) {
        std::vector<std::string> others;
        for (const auto other : from.excludes) others.push_back(fmt::format("{:04X}h", other));
        to.leftovers.push_back({fmt::format("{:04X}h excludes {}", from.index, fmt::join(others, ", ")),
                                "nobody here compares that: choose one of them with `pdo:`"});
    }
    if (from.oversampling)
        to.leftovers.push_back({fmt::format("{:04X}h: {} samples a cycle", from.index, *from.oversampling),
                                "oversampling is not known here: one is exchanged"});
    if (from.is_virtual) to.leftovers.push_back({fmt::format("{:04X}h is virtual", from.index), "it is treated as a real one"});
    if (from.mandatory && !from.sync_manager)
        to.leftovers.push_back({fmt::format("{:04X}h is mandatory, and assigned to no sync manager", from.index),
                                "choose it with `pdo:` if the device wants it"});
    return pdo;
}

Result<void> import_process_data(const EsiDevice& from, EsiImport& to) {
    auto& device = to.file.device;
    import_mailbox(from, to);
    const auto used = used_sync_managers(from);
    if (used < from.sync_managers.size())
        to.leftovers.push_back({fmt::format("the last {} of {} sync managers", from.sync_managers.size() - used, from.sync_managers.size()),
                                "without an address, and no PDO is assigned to them"});
    for (std::size_t n = 0; n < used; ++n) {
        auto sm = import_sync_manager(from, n, to);
        if (!sm) return sm.error();
        device.sync_managers.push_back(*sm);
    }
    const auto bounded = [](unsigned count) { return static_cast<std::uint8_t>(std::clamp(count, 1u, 16u)); };
    if (from.controller.fmmus) device.fmmus = bounded(*from.controller.fmmus);
    if (from.controller.sync_managers) device.sync_manager_count = bounded(*from.controller.sync_managers);
    device.sync_manager_count = std::max(device.sync_manager_count, bounded(static_cast<unsigned>(device.sync_managers.size())));
    for (const bool rx : {true, false})
        for (const auto& one : rx ? from.rx : from.tx) {
            if (!one.sync_manager && (one.index < first_pdo || one.index > last_pdo)) {
                to.leftovers.push_back(
                    {fmt::format("'{}' with the number {:04X}h", one.name, one.index), "not assigned, and no number of a PDO: left out"});
                continue;
            }
            auto pdo = import_pdo(one, from, to);
            if (!pdo) return pdo.error();
            if (pdo->sync_manager && *pdo->sync_manager >= device.sync_managers.size())
                return unusable(from,
                                fmt::format("{:04X}h goes through sync manager {}, and it has {}", pdo->index, *pdo->sync_manager,
                                            device.sync_managers.size()),
                                "correct the file, or ask the vendor for a newer one");
            (rx ? to.file.rx : to.file.tx).push_back({std::move(*pdo), one.sync_manager.has_value()});
        }
    return {};
}

}  // namespace taktwerk::config

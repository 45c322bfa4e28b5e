#include "ecat/bringup/effective_pdos.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/coe/sdo_client.hpp"
#include "ecat/layout/slave_mapping.hpp"

namespace taktwerk::ecat {

namespace {

std::string entry_text(const PdoEntry& entry) {
    return entry.index == 0 ? fmt::format("gap/{}", entry.bits) : fmt::format("{}/{}", object_text(entry.index, entry.sub), entry.bits);
}

/// Sizes of the entries one after the other, gaps as what they are.
std::vector<int> layout(const std::vector<PdoDescription>& pdos) {
    std::vector<int> bits;
    for (const auto& pdo : pdos)
        for (const auto& entry : pdo.entries) bits.push_back(entry.index == 0 ? -entry.bits : entry.bits);
    return bits;
}

}  // namespace

const PdoDescription* find_pdo(const std::vector<PdoDescription>& pdos, std::uint16_t index) noexcept {
    const auto it = std::find_if(pdos.begin(), pdos.end(), [&](const PdoDescription& p) { return p.index == index; });
    return it == pdos.end() ? nullptr : &*it;
}

std::vector<PdoDescription> assigned_in_eeprom(const std::vector<SiiPdo>& pdos) {
    std::vector<PdoDescription> result;
    for (const auto& pdo : pdos) {
        if (pdo.sync_manager == SiiPdo::not_assigned) continue;
        PdoDescription out{pdo.index, true, {}, pdo.sync_manager};
        for (const auto& entry : pdo.entries) out.entries.push_back({entry.index, entry.sub, entry.bits});
        result.push_back(std::move(out));
    }
    return result;
}

bool lists_all_pdos(const Sii& sii) noexcept {
    return !sii.has(SiiDefect::bad_pdo) && !sii.has(SiiDefect::truncated_category) && !sii.has(SiiDefect::unreadable);
}

std::vector<PdoDescription> assigned_by_default(const std::vector<PdoDescription>& pdos, const std::vector<std::uint16_t>& assigned) {
    if (assigned.empty()) return pdos;
    std::vector<PdoDescription> result;
    for (const auto index : assigned)
        if (const auto* pdo = find_pdo(pdos, index)) result.push_back(*pdo);
    return result;
}

EffectivePdos without_coe(const std::vector<PdoDescription>& eeprom, const std::vector<PdoDescription>& configured,
                          const std::string& direction) {
    if (eeprom.empty())
        return {configured, configured.empty()
                                ? ""
                                : fmt::format("{} are mapped as the configuration says: its EEPROM does not list its PDOs", direction)};
    if (configured.empty() || layout(eeprom) == layout(configured)) return {configured.empty() ? eeprom : configured, ""};
    return {eeprom, fmt::format("{} are mapped as its EEPROM says ({} bits); the configuration has another layout ({} bits)", direction,
                                mapped_bits(eeprom), mapped_bits(configured))};
}

std::vector<SyncManagerDescription> sync_managers_in_eeprom(const Sii& sii) {
    std::vector<SyncManagerDescription> result;
    for (const auto& sm : sii.sync_managers) {
        const auto use = static_cast<unsigned>(sm.use);
        const bool used = use >= 1 && use <= static_cast<unsigned>(SiiSyncManagerUse::inputs);
        // One that is not used keeps its number: without size it is left alone.
        if (used) result.push_back({static_cast<SmUse>(use - 1), sm.start, sm.length, sm.control});
        else result.push_back({SmUse::outputs, sm.start, 0, sm.control});
    }
    return result;
}

Result<void> compare_pdos(const std::string& subject, std::uint16_t assignment, const std::vector<PdoDescription>& wanted,
                          const std::vector<PdoDescription>& got) {
    const auto mismatch = [&](std::string what) {
        return Error{
            "bus.pdo_mismatch", subject,
            fmt::format("{}; configured are {} bytes, the slave has {}", std::move(what), (mapped_bits(wanted) + 7) / 8,
                        (mapped_bits(got) + 7) / 8),
            "choose a PDO this firmware offers with exactly these entries, or correct the PDO in the profile to what the slave reports"};
    };
    for (std::size_t i = 0; i < std::max(wanted.size(), got.size()); ++i) {
        if (i >= got.size()) return mismatch(fmt::format("{:04X}h was not assigned to {:04X}h", wanted[i].index, assignment));
        if (i >= wanted.size())
            return mismatch(fmt::format("the slave has {:04X}h assigned to {:04X}h in addition", got[i].index, assignment));
        if (wanted[i].index != got[i].index)
            return mismatch(fmt::format("{:04X}h holds {:04X}h, not {:04X}h", assignment, got[i].index, wanted[i].index));
        const auto& a = wanted[i].entries;
        const auto& b = got[i].entries;
        for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
            if (k < a.size() && k < b.size() && a[k] == b[k]) continue;
            return mismatch(fmt::format("entry {} of {:04X}h is {} in the slave, configured is {}", k + 1, wanted[i].index,
                                        k < b.size() ? entry_text(b[k]) : "missing", k < a.size() ? entry_text(a[k]) : "nothing"));
        }
    }
    return {};
}

}  // namespace taktwerk::ecat

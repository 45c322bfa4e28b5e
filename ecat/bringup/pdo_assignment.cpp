#include "ecat/bringup/pdo_assignment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/effective_pdos.hpp"
#include "ecat/bringup/pdo_objects.hpp"
#include "ecat/bringup/pdo_search.hpp"
#include "ecat/bringup/slave_objects.hpp"
#include "ecat/description/module_pdos.hpp"

namespace taktwerk::ecat {

namespace {

/// One direction of one slave: what it offers, what is wanted of it, what its EEPROM says.
struct Direction {
    SmUse use = SmUse::outputs;
    const char* name = "outputs";
    std::vector<PdoDescription> known, wanted, by_default, eeprom;
    std::vector<PdoEntry> required;           ///< not empty: nobody stated its PDOs
    std::vector<std::uint8_t> sync_managers;  ///< of this direction
    [[nodiscard]] std::uint8_t sync_manager_of(const PdoDescription& pdo) const {
        const auto* own = find_pdo(known, pdo.index);
        const std::uint8_t first = sync_managers.empty() ? std::uint8_t{0} : sync_managers.front();
        return pdo.sync_manager ? *pdo.sync_manager : own != nullptr && own->sync_manager ? *own->sync_manager : first;
    }
    /// Those of `pdos` that belong to one sync manager.
    [[nodiscard]] std::vector<PdoDescription> of(const std::vector<PdoDescription>& pdos, std::uint8_t sync_manager) const {
        std::vector<PdoDescription> result;
        for (const auto& pdo : pdos)
            if (sync_manager_of(pdo) == sync_manager) result.push_back(pdo);
        for (auto& pdo : result) pdo.sync_manager = sync_manager;
        return result;
    }
};

Direction direction_of(const BusSlave& slave, SmUse use) {
    const bool outputs = use == SmUse::outputs;
    const auto& config = *slave.config;
    const DevicePdos pdos = pdos_of(slave.device(), config.modules);
    Direction d;
    d.use = use;
    d.name = outputs ? "outputs" : "inputs";
    d.known = outputs ? pdos.rx : pdos.tx;
    d.by_default = assigned_by_default(d.known, outputs ? pdos.rx_assigned : pdos.tx_assigned);
    d.wanted = (outputs ? config.rx : config.tx).assigned;
    if (!slave.device().stated.process_data) d.required = (outputs ? config.rx : config.tx).required;
    if (d.wanted.empty() && !config.modules.empty()) d.wanted = d.by_default;  // a module is chosen with all its PDOs
    d.eeprom = assigned_in_eeprom(outputs ? slave.found.sii.rx_pdos : slave.found.sii.tx_pdos);
    if (!lists_all_pdos(slave.found.sii) && !d.by_default.empty()) d.eeprom.clear();
    const auto& managers = slave.device().sync_managers;
    for (std::size_t n = 0; n < managers.size(); ++n)
        if (managers[n].use == use) d.sync_managers.push_back(static_cast<std::uint8_t>(n));
    return d;
}

Script<Result<void>> write_assignment(Bus& bus, BusSlave& slave, const Direction& direction, std::uint16_t assignment,
                                      const std::vector<PdoDescription>& wanted) {
    Result<void> written = co_await write_number(bus, slave, assignment, 0, 0, 1);
    if (!written) co_return written;
    for (const auto& pdo : wanted) {
        const auto* own = find_pdo(direction.known, pdo.index);
        if (pdo.fixed || pdo.entries.empty() || (own != nullptr && own->fixed)) continue;
        written = co_await write_mapping(bus, slave, pdo);
        if (!written) co_return written;
    }
    co_return co_await write_assigned(bus, slave, assignment, wanted);
}

/// Which PDOs the slave has assigned, and which entries they have, in its own words. A PDO whose mapping object it does not
/// show has the entries that EEPROM or profile give it.
Script<Result<std::vector<PdoDescription>>> read_assigned(Bus& bus, BusSlave& slave, const Direction& direction, std::uint16_t assignment) {
    std::vector<PdoDescription> pdos;
    const Result<std::vector<std::uint16_t>> numbers = co_await read_assignment(bus, slave, assignment);
    if (!numbers) co_return numbers.error();
    for (const std::uint16_t number : *numbers) {
        Result<PdoDescription> pdo = co_await read_mapping(bus, slave, number);
        if (!pdo && is_absent(pdo.error())) {
            const auto* known = find_pdo(direction.eeprom, number);
            if (known == nullptr) known = find_pdo(direction.known, number);
            if (known == nullptr) co_return pdo.error();
            bus.remember(fmt::format("{}: it has {:04X}h assigned and does not show its mapping; taken from its {}", slave.subject, number,
                                     find_pdo(direction.eeprom, number) != nullptr ? "EEPROM" : "profile"));
            pdo = *known;
        }
        if (!pdo) co_return pdo.error();
        pdos.push_back(std::move(*pdo));
    }
    co_return pdos;
}

/// A slave with CoE that has no assignment object: what it maps is a matter of its firmware.
std::vector<PdoDescription> without_assignment(Bus& bus, const BusSlave& slave, const Direction& direction, std::uint8_t sync_manager) {
    const auto& source = direction.eeprom.empty() ? direction.by_default : direction.eeprom;
    if (!source.empty())
        bus.remember(fmt::format("{}: it has no {:04X}h; its {} are mapped as its {} says", slave.subject, 0x1C10 + sync_manager,
                                 direction.name, direction.eeprom.empty() ? "profile" : "EEPROM"));
    return direction.of(source, sync_manager);
}

/// One sync manager: written where something is wanted, read back, compared.
Script<Result<std::vector<PdoDescription>>> assign_sync_manager(Bus& bus, BusSlave& slave, const Direction& direction,
                                                                std::uint8_t sync_manager) {
    const std::uint16_t assignment = assignment_of(sync_manager);
    const std::vector<PdoDescription> wanted = direction.of(direction.wanted, sync_manager);
    if (!direction.required.empty() && !wanted.empty()) {
        const PdoWish wish{wanted.front(), direction.required};
        Result<std::vector<PdoDescription>> found = co_await search_pdos(bus, slave, sync_manager, wish);
        if (!found) co_return found.error();
        for (auto& pdo : *found) pdo.sync_manager = sync_manager;
        co_return found;
    }
    std::string refused;
    if (!wanted.empty()) {
        const Result<void> written = co_await write_assignment(bus, slave, direction, assignment, wanted);
        if (!written && !is_absent(written.error()) && !is_read_only(written.error())) co_return written.error();
        if (!written) refused = written.error().what;  // it cannot be changed: fine, where it is what was wanted
    }
    Result<std::vector<PdoDescription>> got = co_await read_assigned(bus, slave, direction, assignment);
    if (!got && is_absent(got.error())) got = without_assignment(bus, slave, direction, sync_manager);
    if (!got) co_return got.error();
    if (!wanted.empty()) {
        std::vector<PdoDescription> expected = wanted;
        for (auto& pdo : expected)
            if (pdo.entries.empty()) {
                const auto* own = find_pdo(direction.known, pdo.index);
                const auto* now = find_pdo(*got, pdo.index);
                pdo.entries = own != nullptr ? own->entries : now != nullptr ? now->entries : std::vector<PdoEntry>{};
            }
        Result<void> same = compare_pdos(slave.subject, assignment, expected, *got);
        if (!same) {
            Error error = same.error();
            if (!refused.empty()) error.what += "; the assignment could not be written: " + refused;
            co_return error;
        }
    }
    for (auto& pdo : *got) pdo.sync_manager = sync_manager;
    co_return got;
}

Script<Result<std::vector<PdoDescription>>> assign_direction(Bus& bus, BusSlave& slave, SmUse use) {
    const Direction direction = direction_of(slave, use);
    std::vector<PdoDescription> all;
    for (const std::uint8_t sync_manager : direction.sync_managers) {
        Result<std::vector<PdoDescription>> got = co_await assign_sync_manager(bus, slave, direction, sync_manager);
        if (!got) co_return got.error();
        all.insert(all.end(), got->begin(), got->end());
    }
    co_return all;
}

std::vector<PdoDescription> plain_direction(Bus& bus, const BusSlave& slave, SmUse use) {
    const Direction direction = direction_of(slave, use);
    EffectivePdos effective = without_coe(direction.eeprom, direction.by_default, direction.name);
    if (!effective.remark.empty()) bus.remember(slave.subject + ": " + effective.remark);
    return std::move(effective.pdos);
}

}  // namespace

Script<Result<void>> assign_pdos(Bus& bus, BusSlave& slave) {
    if (!slave.has_coe()) {
        slave.rx = plain_direction(bus, slave, SmUse::outputs);
        slave.tx = plain_direction(bus, slave, SmUse::inputs);
        co_return Result<void>{};
    }
    Result<std::vector<PdoDescription>> rx = co_await assign_direction(bus, slave, SmUse::outputs);
    if (!rx) co_return rx.error();
    Result<std::vector<PdoDescription>> tx = co_await assign_direction(bus, slave, SmUse::inputs);
    if (!tx) co_return tx.error();
    slave.rx = std::move(*rx);
    slave.tx = std::move(*tx);
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat

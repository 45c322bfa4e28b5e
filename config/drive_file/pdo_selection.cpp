#include "config/drive_file/pdo_selection.hpp"

#include <fmt/format.h>

#include "config/drive_file/startup_entry.hpp"
#include "ecat/description/module_pdos.hpp"

namespace taktwerk::config {

namespace {

Error mapping_error(std::string what, std::string remedy) { return {"config.mapping", {}, std::move(what), std::move(remedy)}; }

}  // namespace

Result<ecat::PdoSelection> select_pdos(const ecat::DeviceDescription& device, std::span<const ecat::ModuleSelection> modules, PdoWay way,
                                       const std::vector<ObjectAddress>& wanted) {
    const bool rx = way == PdoWay::rx;
    const auto offered = ecat::pdos_of(device, modules);
    const auto& pdos = rx ? offered.rx : offered.tx;
    const auto& rules = rx ? device.rx_rules : device.tx_rules;
    ecat::PdoSelection out;
    std::vector<ecat::PdoEntry> loose;
    std::size_t bits = 0;
    for (const auto& item : wanted) {
        const ecat::PdoDescription* whole = nullptr;
        for (const auto& pdo : pdos)
            if (pdo.index == item.index) whole = &pdo;
        if (whole) {
            out.assigned.push_back(*whole);
            for (const auto& entry : whole->entries) bits += entry.bits;
            continue;
        }
        const auto* object = find_object(device, item.index, item.sub);
        const auto shown = show_object(item.index, item.sub);
        if (!object)
            return mapping_error(fmt::format("{} has no object {}", device.name, shown), "correct it, or add it to the drive's file");
        if (object->mappable != ecat::Mappable::both && object->mappable != (rx ? ecat::Mappable::rx : ecat::Mappable::tx))
            return mapping_error(fmt::format("{} of {} cannot be mapped into {}", shown, device.name, rx ? "an RxPDO" : "a TxPDO"),
                                 "remove it");
        loose.push_back({item.index, item.sub, item.bits ? item.bits : ecat::bit_size(object->type)});
        bits += loose.back().bits;
    }
    if (!loose.empty() && !out.assigned.empty()) return mapping_error("whole PDOs and single objects are mixed", "give one kind");
    if ((bits + 7) / 8 > rules.max_bytes)
        return mapping_error(fmt::format("{} bytes are mapped, {} takes {}", (bits + 7) / 8, device.name, rules.max_bytes),
                             "map fewer objects");
    std::size_t next = 0;
    for (const auto& pdo : pdos) {
        if (next == loose.size()) break;
        if (pdo.fixed || out.assigned.size() == rules.max_assigned) continue;
        auto filled = pdo;
        filled.entries.clear();
        while (next < loose.size() && filled.entries.size() < rules.max_entries) filled.entries.push_back(loose[next++]);
        out.assigned.push_back(std::move(filled));
    }
    if (next < loose.size() || out.assigned.size() > rules.max_assigned)
        return mapping_error(fmt::format("{} takes {} PDOs of {} objects", device.name, rules.max_assigned, rules.max_entries),
                             "map fewer objects");
    return out;
}

}  // namespace taktwerk::config

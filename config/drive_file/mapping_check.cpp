#include "config/drive_file/mapping_check.hpp"

#include <fmt/format.h>

namespace taktwerk::config {

namespace {

using ecat::DeviceDescription;
using ecat::Mappable;

/// Fills in the bits of mapped objects and reports objects that the dictionary lacks or that may not be mapped.
class PdoResolver {
public:
    PdoResolver(Reader& reader, const DeviceDescription& device) : reader_(reader), device_(device) {}

    void resolve(ecat::PdoEntry& entry, bool rx, std::string_view place) const {
        if (entry.index == 0) return;  // a gap
        const auto* object = find_object(device_, entry.index, entry.sub);
        const auto shown = show_object(entry.index, entry.sub);
        if (!object) {
            report(place, fmt::format("{} is mapped, but `objects` does not list it", shown), "add it to `objects` with its type");
            return;
        }
        if (entry.bits == 0) entry.bits = ecat::bit_size(object->type);
        if (object->mappable != Mappable::both && object->mappable != (rx ? Mappable::rx : Mappable::tx))
            report(place, fmt::format("{} cannot be mapped into {}", shown, rx ? "an RxPDO" : "a TxPDO"),
                   fmt::format("remove it, or correct its `map:` in `objects`"));
    }

    void report(std::string_view place, std::string what, std::string remedy) const {
        reader_.problem(reader_.find(place), "config.mapping", std::move(what), std::move(remedy));
    }

private:
    Reader& reader_;
    const DeviceDescription& device_;
};

void check_rules(const PdoResolver& resolver, const std::vector<PdoChoice>& chosen, const std::vector<ecat::PdoDescription>& available,
                 const ecat::PdoRules& rules, std::string_view place) {
    std::size_t bits = 0;
    if (chosen.size() > rules.max_assigned)
        resolver.report(place, fmt::format("{} PDOs are assigned, the drive takes {}", chosen.size(), rules.max_assigned), "use fewer");
    for (const auto& choice : chosen) {
        const ecat::PdoDescription* pdo = nullptr;
        for (const auto& a : available)
            if (a.index == choice.pdo.index) pdo = &a;
        if (!pdo) {
            resolver.report(place, fmt::format("PDO {:04X}h is not among those `available`", choice.pdo.index), "correct its number");
            continue;
        }
        if (pdo->fixed && !choice.objects.empty())
            resolver.report(place, fmt::format("PDO {:04X}h is fixed", choice.pdo.index), "remove its `objects`");
        const auto& entries = choice.objects.empty() ? pdo->entries : choice.objects;
        if (entries.size() > rules.max_entries)
            resolver.report(
                place, fmt::format("PDO {:04X}h maps {} objects, the drive takes {}", choice.pdo.index, entries.size(), rules.max_entries),
                "map fewer");
        for (const auto& e : entries) bits += e.bits;
    }
    if ((bits + 7) / 8 > rules.max_bytes)
        resolver.report(place, fmt::format("{} bytes are mapped, the drive takes {}", (bits + 7) / 8, rules.max_bytes),
                        "map fewer objects");
}

}  // namespace

void check_mapping(Reader& reader, DriveFile& file) {
    const PdoResolver resolver(reader, file.device);
    for (auto& pdo : file.device.rx_pdos)
        for (auto& entry : pdo.entries) resolver.resolve(entry, true, "pdo.rx");
    for (auto& pdo : file.device.tx_pdos)
        for (auto& entry : pdo.entries) resolver.resolve(entry, false, "pdo.tx");
    for (auto& module : file.device.slots.modules) {
        for (auto& pdo : module.rx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, true, "slots.modules");
        for (auto& pdo : module.tx_pdos)
            for (auto& entry : pdo.entries) resolver.resolve(entry, false, "slots.modules");
    }
    for (auto* direction : {&file.rx, &file.tx})
        for (auto& choice : *direction)
            for (auto* entries : {&choice.objects, &choice.required})
                for (auto& entry : *entries)
                    resolver.resolve(entry, direction == &file.rx, direction == &file.rx ? "mapping.rx" : "mapping.tx");
    check_rules(resolver, file.rx, file.device.rx_pdos, file.device.rx_rules, "mapping.rx");
    check_rules(resolver, file.tx, file.device.tx_pdos, file.device.tx_rules, "mapping.tx");
}

}  // namespace taktwerk::config

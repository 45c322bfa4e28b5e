#include "ecat/sim/pdo_rules.hpp"

#include <algorithm>

#include "ecat/description/factory_mapping.hpp"
#include "ecat/sim/process_data.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

namespace {

bool lists(const std::vector<PdoDescription>& pdos, std::uint16_t index) noexcept {
    return std::any_of(pdos.begin(), pdos.end(), [&](const PdoDescription& pdo) { return pdo.index == index; });
}

std::uint32_t refuse_mapping_entry(const DeviceDescription& description, const ObjectDictionary& dictionary, std::int64_t value,
                                   bool rx) noexcept {
    const auto raw = static_cast<std::uint32_t>(value);
    const auto index = static_cast<std::uint16_t>(raw >> 16);
    const auto bits = raw & 0xFFu;
    if (index == 0) return 0;  // a gap, or an entry cleared
    const auto sub = static_cast<std::uint8_t>(raw >> 8);
    const Entry* target = dictionary.find(index, sub);
    if (target == nullptr) return sdo_abort::not_mappable;
    if (target->bits() != bits && (bits > target->bits() || !mapped_by_maker(description, index, sub, bits, rx)))
        return sdo_abort::not_mappable;
    const Mappable wanted = rx ? Mappable::rx : Mappable::tx;
    return target->mappable() == wanted || target->mappable() == Mappable::both ? 0 : sdo_abort::not_mappable;
}

}  // namespace

std::uint32_t refuse_pdo_write(const DeviceDescription& description, const ObjectDictionary& dictionary, const Entry& entry,
                               std::int64_t value, EsmState state) noexcept {
    if (entry.role() == EntryRole::plain) return 0;
    if (state != EsmState::preop) return sdo_abort::device_state;
    const std::uint16_t index = entry.index();
    const std::size_t sync_manager = index - assignment_object(0);
    const bool rx = lists(description.rx_pdos, index) ||
                    (sync_manager < description.sync_managers.size() && description.sync_managers[sync_manager].use == SmUse::outputs);
    const PdoRules& rules = rx ? description.rx_rules : description.tx_rules;
    const auto& pdos = rx ? description.rx_pdos : description.tx_pdos;
    // A PDO that names its sync manager goes only there; the others wherever the direction is right.
    const auto may_be_assigned = [&](std::uint16_t pdo) {
        return std::any_of(pdos.begin(), pdos.end(), [&](const PdoDescription& known) {
            return known.index == pdo && (!known.sync_manager || *known.sync_manager == sync_manager);
        });
    };

    switch (entry.role()) {
        case EntryRole::plain: break;
        case EntryRole::mapping_entry:
            if (dictionary.value(index, 0) != 0) return sdo_abort::sub0_not_zero;
            return refuse_mapping_entry(description, dictionary, value, rx);
        case EntryRole::assign_entry:
            if (dictionary.value(index, 0) != 0) return sdo_abort::sub0_not_zero;
            return value == 0 || may_be_assigned(static_cast<std::uint16_t>(value)) ? 0 : sdo_abort::value_range;
        case EntryRole::mapping_count: {
            std::uint32_t bits = 0;
            for (std::int64_t n = 1; n <= value; ++n) {
                const auto raw = static_cast<std::uint32_t>(dictionary.value(index, static_cast<std::uint8_t>(n)));
                if (raw == 0) return sdo_abort::not_mappable;  // counts an entry that nobody wrote
                bits += raw & 0xFFu;
            }
            return (bits + 7) / 8 > rules.max_bytes ? sdo_abort::pdo_length : 0;
        }
        case EntryRole::assign_count: {
            std::uint32_t bits = 0;
            for (std::int64_t n = 1; n <= value; ++n) {
                const auto pdo = static_cast<std::uint16_t>(dictionary.value(index, static_cast<std::uint8_t>(n)));
                if (!may_be_assigned(pdo)) return sdo_abort::value_range;
                bits += mapped_bits(dictionary, pdo);
            }
            return (bits + 7) / 8 > rules.max_bytes ? sdo_abort::pdo_length : 0;
        }
    }
    return 0;
}

}  // namespace taktwerk::ecat::sim

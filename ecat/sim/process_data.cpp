#include "ecat/sim/process_data.hpp"

#include <algorithm>

#include "ecat/description/module_pdos.hpp"

namespace taktwerk::ecat::sim {

ProcessData::ProcessData(const DeviceDescription& description, ObjectDictionary& dictionary)
    : description_(description), dictionary_(dictionary), windows_(description.sync_managers.size()) {
    for (std::size_t n = 0; n < windows_.size(); ++n) {
        windows_[n].use = description.sync_managers[n].use;
        const PdoRules& rules = windows_[n].use == SmUse::outputs ? description.rx_rules : description.tx_rules;
        windows_[n].copies.reserve(std::size_t{rules.max_assigned} * rules.max_entries + 32);
    }
}

std::uint16_t ProcessData::resolve() {
    constexpr std::uint16_t invalid_input_mapping = 0x0024, invalid_output_mapping = 0x0025;
    for (unsigned n = 0; n < windows_.size(); ++n)
        if (!resolve(n, windows_[n])) return windows_[n].use == SmUse::outputs ? invalid_output_mapping : invalid_input_mapping;
    if (!every_slot_holds_a_module(SmUse::outputs)) return invalid_output_mapping;
    if (!every_slot_holds_a_module(SmUse::inputs)) return invalid_input_mapping;
    return 0;
}

// TSVM 5.2.5: each axis, a slot, has to have one valid module. What refuses it otherwise is not stated.
bool ProcessData::every_slot_holds_a_module(SmUse use) const {
    const auto& slots = description_.slots;
    if (slots.may_be_empty) return true;
    std::vector<PdoDescription> of_modules;
    for (const auto& module : slots.modules)
        for (const auto& pdo : use == SmUse::outputs ? module.rx_pdos : module.tx_pdos) of_modules.push_back(pdo);
    if (of_modules.empty()) return true;
    std::vector<bool> filled(slots.count, false);
    for (std::size_t n = 0; n < windows_.size(); ++n) {
        if (windows_[n].use != use) continue;
        const auto pdos = dictionary_.value(assignment_object(n), 0);
        for (std::int64_t p = 1; p <= pdos; ++p) {
            const auto pdo = static_cast<std::uint16_t>(dictionary_.value(assignment_object(n), static_cast<std::uint8_t>(p)));
            if (const auto slot = slot_of(slots, of_modules, pdo)) filled[*slot] = true;
        }
    }
    return std::all_of(filled.begin(), filled.end(), [](bool is) { return is; });
}

bool ProcessData::resolve(unsigned sync_manager, Window& window) {
    window.copies.clear();
    window.bytes = 0;
    if (window.use != SmUse::outputs && window.use != SmUse::inputs) return true;
    const auto assignment = assignment_object(sync_manager);
    std::uint32_t bit = 0;
    const auto pdos = dictionary_.value(assignment, 0);
    for (std::int64_t p = 1; p <= pdos; ++p) {
        const auto pdo = static_cast<std::uint16_t>(dictionary_.value(assignment, static_cast<std::uint8_t>(p)));
        if (dictionary_.find(pdo, 0) == nullptr) return false;
        const auto count = dictionary_.value(pdo, 0);
        for (std::int64_t n = 1; n <= count; ++n) {
            const auto raw = static_cast<std::uint32_t>(dictionary_.value(pdo, static_cast<std::uint8_t>(n)));
            const auto bits = static_cast<std::uint8_t>(raw & 0xFFu);
            const auto index = static_cast<std::uint16_t>(raw >> 16);
            if (index != 0) {
                Entry* entry = dictionary_.find(index, static_cast<std::uint8_t>(raw >> 8));
                if (entry == nullptr || entry->bits() < bits) return false;  // fewer: the low ones
                window.copies.push_back({entry, Signal{bit, bits, entry->is_signed()}});
            }
            bit += bits;
        }
    }
    window.bytes = static_cast<std::uint16_t>((bit + 7) / 8);
    return true;
}

std::uint16_t ProcessData::bytes(unsigned sync_manager) const noexcept {
    return sync_manager < windows_.size() ? windows_[sync_manager].bytes : std::uint16_t{0};
}

void ProcessData::load_outputs(unsigned sync_manager, std::span<const std::byte> image) noexcept {
    const Window& window = windows_[sync_manager];
    if (image.size() < window.bytes) return;
    for (const auto& copy : window.copies) copy.entry->set(read_signal(image, copy.signal));
}

void ProcessData::store_inputs(unsigned sync_manager, std::span<std::byte> image) const noexcept {
    const Window& window = windows_[sync_manager];
    if (image.size() < window.bytes) return;
    for (const auto& copy : window.copies) write_signal(image, copy.signal, copy.entry->get());
}

std::optional<unsigned> first_sync_manager(const DeviceDescription& description, SmUse use) noexcept {
    for (std::size_t n = 0; n < description.sync_managers.size(); ++n)
        if (description.sync_managers[n].use == use) return static_cast<unsigned>(n);
    return std::nullopt;
}

bool belongs_to(const DeviceDescription& description, const PdoDescription& pdo, unsigned n) noexcept {
    if (n >= description.sync_managers.size()) return false;
    const auto has = [&](const std::vector<PdoDescription>& pdos) {
        return std::any_of(pdos.begin(), pdos.end(), [&](const PdoDescription& other) { return other.index == pdo.index; });
    };
    const SmUse use = has(description.rx_pdos) ? SmUse::outputs : SmUse::inputs;
    if (description.sync_managers[n].use != use) return false;
    return pdo.sync_manager ? *pdo.sync_manager == n : first_sync_manager(description, use) == n;
}

std::uint32_t mapped_bits(const ObjectDictionary& dictionary, std::uint16_t pdo) noexcept {
    std::uint32_t bits = 0;
    const auto count = dictionary.value(pdo, 0);
    for (std::int64_t n = 1; n <= count; ++n)
        bits += static_cast<std::uint32_t>(dictionary.value(pdo, static_cast<std::uint8_t>(n))) & 0xFFu;
    return bits;
}

}  // namespace taktwerk::ecat::sim

#pragma once
// The PDOs of a modular slave (ETG.5001): its own, and those of the modules in its slots, moved by the slot's increments.
// TSVM-D6 manual 5.2.5: objects +800h, PDOs +40h a slot. Header only: master, simulator and configuration use it alike.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ecat/description/device_description.hpp"

namespace taktwerk::ecat {

/// What a device offers and has assigned by default, modules included.
struct DevicePdos {
    std::vector<PdoDescription> rx, tx;
    std::vector<std::uint16_t> rx_assigned, tx_assigned;
};

[[nodiscard]] inline const ModuleDescription* find_module(const SlotDescription& slots, std::string_view name) noexcept {
    const auto it = std::find_if(slots.modules.begin(), slots.modules.end(), [&](const ModuleDescription& m) { return m.name == name; });
    return it == slots.modules.end() ? nullptr : &*it;
}

/// A PDO of a module as it stands in `slot`. Gaps stay gaps.
[[nodiscard]] inline PdoDescription in_slot(PdoDescription pdo, const SlotDescription& slots, std::uint8_t slot) {
    pdo.index = static_cast<std::uint16_t>(pdo.index + slot * slots.pdo_increment);
    for (auto& entry : pdo.entries)
        if (entry.index != 0) entry.index = static_cast<std::uint16_t>(entry.index + slot * slots.index_increment);
    return pdo;
}

/// In the order of the slots. A module's PDOs are all assigned; modules that the device does not know are left out (check()).
[[nodiscard]] inline DevicePdos pdos_of(const DeviceDescription& device, std::span<const ModuleSelection> modules) {
    DevicePdos out{device.rx_pdos, device.tx_pdos, device.rx_assigned, device.tx_assigned};
    std::vector<ModuleSelection> chosen(modules.begin(), modules.end());
    std::stable_sort(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) { return a.slot < b.slot; });
    for (const auto& selection : chosen) {
        const auto* module = find_module(device.slots, selection.module);
        if (module == nullptr) continue;
        const auto add = [&](const std::vector<PdoDescription>& from, std::vector<PdoDescription>& to,
                             std::vector<std::uint16_t>& assigned) {
            for (const auto& pdo : from) {
                to.push_back(in_slot(pdo, device.slots, selection.slot));
                assigned.push_back(to.back().index);
            }
        };
        add(module->rx_pdos, out.rx, out.rx_assigned);
        add(module->tx_pdos, out.tx, out.tx_assigned);
    }
    return out;
}

/// The device as its firmware knows it: the PDOs of every module in every slot stand beside its own, none of them assigned. Of modules
/// that use the same PDO numbers the first one's default is there.
[[nodiscard]] inline DeviceDescription with_slots_filled(DeviceDescription device) {
    const auto add = [&](const PdoDescription& pdo, std::vector<PdoDescription>& to) {
        if (std::none_of(to.begin(), to.end(), [&](const PdoDescription& other) { return other.index == pdo.index; })) to.push_back(pdo);
    };
    for (std::uint8_t slot = 0; slot < device.slots.count; ++slot)
        for (const auto& module : device.slots.modules) {
            for (const auto& pdo : module.rx_pdos) add(in_slot(pdo, device.slots, slot), device.rx_pdos);
            for (const auto& pdo : module.tx_pdos) add(in_slot(pdo, device.slots, slot), device.tx_pdos);
        }
    return device;
}

/// The slot in which `pdo` is one of `of_module` (numbers as in slot 0); none: it is the device's own.
[[nodiscard]] inline std::optional<std::uint8_t> slot_of(const SlotDescription& slots, const std::vector<PdoDescription>& of_module,
                                                         std::uint16_t pdo) noexcept {
    for (std::uint8_t slot = 0; slot < slots.count; ++slot)
        for (const auto& own : of_module)
            if (own.index + slot * slots.pdo_increment == pdo) return slot;
    return std::nullopt;
}

}  // namespace taktwerk::ecat

#pragma once
// Process data of a slave with CoE: for each process data sync manager n the assigned PDOs (1C10h + n) and their mappings,
// resolved to dictionary entries at PREOP -> SAFEOP, then copied each cycle. resolve() not real-time; load and store real-time safe.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/process_image.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::ecat::sim {

class ProcessData {
public:
    ProcessData(const DeviceDescription& description, ObjectDictionary& dictionary);

    /// AL status code: 0, 0025h (output mapping) or 0024h (input mapping) when an assigned PDO does not resolve, or when a slot of a
    /// modular slave has no PDO of a module assigned.
    [[nodiscard]] std::uint16_t resolve();
    /// Of one sync manager; 0 for those that carry no process data.
    [[nodiscard]] std::uint16_t bytes(unsigned sync_manager) const noexcept;

    /// Newest outputs of a sync manager into the dictionary.
    void load_outputs(unsigned sync_manager, std::span<const std::byte> image) noexcept;
    /// Dictionary into the inputs of a sync manager.
    void store_inputs(unsigned sync_manager, std::span<std::byte> image) const noexcept;

private:
    struct Copy {
        Entry* entry;
        Signal signal;
    };
    /// What one sync manager carries.
    struct Window {
        SmUse use = SmUse::outputs;
        std::vector<Copy> copies;
        std::uint16_t bytes = 0;
    };
    [[nodiscard]] bool resolve(unsigned sync_manager, Window& window);
    [[nodiscard]] bool every_slot_holds_a_module(SmUse use) const;

    const DeviceDescription& description_;
    ObjectDictionary& dictionary_;
    std::vector<Window> windows_;  // by sync manager; mailboxes have an empty one
};

/// The object that assigns PDOs to a sync manager: 1C10h + n.
[[nodiscard]] constexpr std::uint16_t assignment_object(std::size_t sync_manager) noexcept {
    return static_cast<std::uint16_t>(0x1C10 + sync_manager);
}
/// The first sync manager with this use; none: the slave has no such.
[[nodiscard]] std::optional<unsigned> first_sync_manager(const DeviceDescription& description, SmUse use) noexcept;
/// Whether a PDO of the description belongs to sync manager `n`: named there, or n is the first of the PDO's direction.
[[nodiscard]] bool belongs_to(const DeviceDescription& description, const PdoDescription& pdo, unsigned n) noexcept;

/// Bits that the mapping object `pdo` has now.
[[nodiscard]] std::uint32_t mapped_bits(const ObjectDictionary& dictionary, std::uint16_t pdo) noexcept;

}  // namespace taktwerk::ecat::sim

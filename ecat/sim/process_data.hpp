#pragma once
// Process data of a slave with CoE: the assigned PDOs (1C12h, 1C13h) and their mappings, resolved to dictionary entries at
// PREOP -> SAFEOP, then copied each cycle. resolve() not real-time; load and store real-time safe.

#include <cstdint>
#include <span>
#include <vector>

#include "core/process_image.hpp"
#include "ecat/device_description.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::ecat::sim {

class ProcessData {
public:
    ProcessData(const DeviceDescription& description, ObjectDictionary& dictionary);

    /// AL status code: 0, 0025h (output mapping) or 0024h (input mapping) when an assigned PDO does not resolve.
    [[nodiscard]] std::uint16_t resolve();
    [[nodiscard]] std::uint16_t output_bytes() const noexcept { return outputs_.bytes; }
    [[nodiscard]] std::uint16_t input_bytes() const noexcept { return inputs_.bytes; }

    /// Newest outputs into the dictionary.
    void load_outputs(std::span<const std::byte> image) noexcept;
    /// Dictionary into the inputs.
    void store_inputs(std::span<std::byte> image) const noexcept;

private:
    struct Copy {
        Entry* entry;
        Signal signal;
    };
    struct Direction {
        std::vector<Copy> copies;
        std::uint16_t bytes = 0;
    };
    [[nodiscard]] bool resolve(std::uint16_t assignment, Direction& direction);

    ObjectDictionary& dictionary_;
    Direction outputs_, inputs_;
};

/// Bits that the mapping object `pdo` has now.
[[nodiscard]] std::uint32_t mapped_bits(const ObjectDictionary& dictionary, std::uint16_t pdo) noexcept;

}  // namespace taktwerk::ecat::sim

#include "ecat/sim/process_data.hpp"

namespace taktwerk::ecat::sim {

ProcessData::ProcessData(const DeviceDescription& description, ObjectDictionary& dictionary) : dictionary_(dictionary) {
    outputs_.copies.reserve(std::size_t{description.rx_rules.max_assigned} * description.rx_rules.max_entries + 32);
    inputs_.copies.reserve(std::size_t{description.tx_rules.max_assigned} * description.tx_rules.max_entries + 32);
}

std::uint16_t ProcessData::resolve() {
    constexpr std::uint16_t invalid_input_mapping = 0x0024, invalid_output_mapping = 0x0025;
    if (!resolve(0x1C12, outputs_)) return invalid_output_mapping;
    if (!resolve(0x1C13, inputs_)) return invalid_input_mapping;
    return 0;
}

bool ProcessData::resolve(std::uint16_t assignment, Direction& direction) {
    direction.copies.clear();
    direction.bytes = 0;
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
                if (entry == nullptr || entry->bits() != bits) return false;
                direction.copies.push_back({entry, Signal{bit, bits, entry->is_signed()}});
            }
            bit += bits;
        }
    }
    direction.bytes = static_cast<std::uint16_t>((bit + 7) / 8);
    return true;
}

void ProcessData::load_outputs(std::span<const std::byte> image) noexcept {
    if (image.size() < outputs_.bytes) return;
    for (const auto& copy : outputs_.copies) copy.entry->set(read_signal(image, copy.signal));
}

void ProcessData::store_inputs(std::span<std::byte> image) const noexcept {
    if (image.size() < inputs_.bytes) return;
    for (const auto& copy : inputs_.copies) write_signal(image, copy.signal, copy.entry->get());
}

std::uint32_t mapped_bits(const ObjectDictionary& dictionary, std::uint16_t pdo) noexcept {
    std::uint32_t bits = 0;
    const auto count = dictionary.value(pdo, 0);
    for (std::int64_t n = 1; n <= count; ++n)
        bits += static_cast<std::uint32_t>(dictionary.value(pdo, static_cast<std::uint8_t>(n))) & 0xFFu;
    return bits;
}

}  // namespace taktwerk::ecat::sim

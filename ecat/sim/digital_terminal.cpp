#include "ecat/sim/digital_terminal.hpp"

#include <algorithm>
#include <string>

namespace taktwerk::ecat::sim {

namespace {

constexpr Identity terminal_identity{0x00005457, 0x000D1000, 0x00010000, 0};

PdoDescription channels(DeviceDescription& description, std::uint16_t pdo, std::uint16_t object, std::uint8_t count, bool outputs) {
    PdoDescription out{pdo, true, {}};
    for (std::uint8_t n = 1; n <= count; ++n) {
        out.entries.push_back({object, n, 1});
        ObjectEntry entry;
        entry.index = object;
        entry.sub = n;
        entry.name = (outputs ? "output " : "input ") + std::to_string(n);
        entry.type = DataType::BOOL;
        entry.access = outputs ? Access::rw : Access::ro;
        entry.mappable = outputs ? Mappable::rx : Mappable::tx;
        description.objects.push_back(entry);
    }
    return out;
}

bool bit_of(std::span<const std::byte> bytes, unsigned bit) noexcept {
    return bit / 8 < bytes.size() && ((static_cast<unsigned>(bytes[bit / 8]) >> (bit % 8)) & 1u) != 0;
}

}  // namespace

DeviceDescription digital_input_output_terminal(std::uint8_t inputs, std::uint8_t outputs) {
    constexpr std::uint8_t buffered_outputs = 0x44;  // with watchdog trigger
    DeviceDescription description;
    inputs = std::min<std::uint8_t>(inputs, max_terminal_bits);
    outputs = std::min<std::uint8_t>(outputs, max_terminal_bits);
    description.name = "digital_" + std::to_string(inputs) + "_in_" + std::to_string(outputs) + "_out";
    description.identity = terminal_identity;
    description.identity.product += static_cast<std::uint32_t>(inputs) | (static_cast<std::uint32_t>(outputs) << 4);
    description.rx_rules.max_entries = outputs;
    description.tx_rules.max_entries = inputs;
    if (outputs > 0) {
        description.sync_managers.push_back({SmUse::outputs, 0x1000, static_cast<std::uint16_t>((outputs + 7) / 8), buffered_outputs});
        description.rx_pdos.push_back(channels(description, 0x1600, 0x7000, outputs, true));
        description.rx_assigned = {0x1600};
    }
    if (inputs > 0) {
        description.sync_managers.push_back({SmUse::inputs, 0x1100, static_cast<std::uint16_t>((inputs + 7) / 8), 0x00});
        description.tx_pdos.push_back(channels(description, 0x1A00, 0x6000, inputs, false));
        description.tx_assigned = {0x1A00};
    }
    description.fmmus = 2;
    description.sync_manager_count = 2;
    return description;
}

void DigitalTerminal::set_input(unsigned bit, bool on) noexcept {
    if (bit >= max_terminal_bits) return;
    const auto mask = static_cast<std::byte>(1u << (bit % 8));
    inputs_[bit / 8] = on ? inputs_[bit / 8] | mask : inputs_[bit / 8] & ~mask;
}

bool DigitalTerminal::input(unsigned bit) const noexcept { return bit_of(inputs_, bit); }
bool DigitalTerminal::output(unsigned bit) const noexcept { return bit_of(outputs_, bit); }

void DigitalTerminal::raw_outputs(std::span<const std::byte> outputs) {
    std::copy_n(outputs.begin(), std::min(outputs.size(), outputs_.size()), outputs_.begin());
}

void DigitalTerminal::raw_inputs(std::span<std::byte> inputs) {
    std::copy_n(inputs_.begin(), std::min(inputs.size(), inputs_.size()), inputs.begin());
}

}  // namespace taktwerk::ecat::sim

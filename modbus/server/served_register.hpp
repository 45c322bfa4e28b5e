#pragma once
// A register, or a coil, that this machine offers to Modbus clients. Plain data.
// Source: MODBUS Application Protocol Specification V1.1b3.

#include <cstdint>
#include <string>

#include "modbus/tcp/device_config.hpp"

namespace taktwerk::modbus::server {

using tcp::NumberType;
using tcp::Table;
using tcp::WordOrder;

struct ServedRegister {
    std::string name;
    Table table = Table::input;
    std::uint16_t address = 0;  ///< as on the wire: from 0. What manuals call 40001 is address 0 of the holding registers
    NumberType type = NumberType::uint16;
    WordOrder order = WordOrder::high_first;
    std::uint8_t bit = 0;   ///< of a boolean in a register: 0 = lowest
    bool writable = false;  ///< coils and holding registers only
};

/// Addresses from the first to the one behind the last.
[[nodiscard]] constexpr std::uint32_t end_of(const ServedRegister& r) noexcept { return std::uint32_t{r.address} + addresses_of(r.type); }

/// Both claim an address; several bits may share a register.
[[nodiscard]] constexpr bool overlap(const ServedRegister& a, const ServedRegister& b) noexcept {
    if (a.table != b.table || a.address >= end_of(b) || b.address >= end_of(a)) return false;
    const bool bits = a.type == NumberType::boolean && b.type == NumberType::boolean && !is_bits(a.table);
    return !bits || a.bit == b.bit;
}

}  // namespace taktwerk::modbus::server

#pragma once
// Values of CoE objects as text and back: by the type number that SDO information and EEPROM use (ETG.1000.6, data types).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "ecat/description/coe_type_number.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat {

/// Those that SDO information of simulated slaves does not need.
namespace coe_type {
inline constexpr std::uint16_t unknown = 0, integer24 = 0x0010, unsigned24 = 0x0016, bit1 = 0x0030, bit8 = 0x0037;
}  // namespace coe_type

/// "U16", "STRING", "BIT3"; "type 0023h" for numbers of complex types.
[[nodiscard]] std::string type_name(std::uint16_t type);
/// The number of "u16", "UINT", "string", ...; nothing for other words.
[[nodiscard]] std::optional<std::uint16_t> type_number(std::string_view word);
/// Words that type_number() takes, for messages.
[[nodiscard]] std::string known_types();

/// Numbers in decimal and, when unsigned or of unknown type, hexadecimal: "-12", "4660 (1234h)", "'SV33-ECAT'".
/// A value whose size does not fit its type is shown as bytes.
[[nodiscard]] std::string value_text(std::uint16_t type, std::span<const std::byte> value);
/// The bytes of a value written by a user: "12", "-5", "1234h", "0x1234", "1.5", "text",
/// BYTES as "0A1B2C". Errors: sdo.value (range, not a number).
[[nodiscard]] Result<std::vector<std::byte>> parse_value(std::uint16_t type, std::string_view text);

/// `bits` bits from bit `offset` on, least significant first, filled up with zeros to whole bytes.
[[nodiscard]] std::vector<std::byte> bits_of(std::span<const std::byte> bytes, std::size_t offset, std::size_t bits);

}  // namespace taktwerk::ecat

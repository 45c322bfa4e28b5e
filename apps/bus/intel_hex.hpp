#pragma once
// Memory images as text, the way EEPROM generators and chip programmers write them. Source: Intel, Hexadecimal Object File Format
// Specification, revision A (1988): records `:LLAAAATTdata...CC`, types 00 data, 01 end, 02 and 04 bases; 03 and 05 are start addresses.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

/// Its first character that is no blank is a colon, and it has nothing but printable characters and line ends.
[[nodiscard]] bool is_intel_hex(std::span<const std::byte> file) noexcept;

/// The image from address 0 on; what no record holds is FFh, as in an erased memory. Any bytes in.
/// Errors: eeprom.hex, with the line (a record that is none, its checksum, an address at or above `most`, a byte given twice, no end record).
[[nodiscard]] Result<std::vector<std::byte>> parse_intel_hex(std::span<const std::byte> file, std::size_t most, const std::string& path);

}  // namespace taktwerk::apps

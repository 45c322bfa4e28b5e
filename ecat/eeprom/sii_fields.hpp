#pragma once
// The words of an EEPROM image by name, and in what two images differ. Pure; any bytes. Not real-time. Source: ETG.1000.6, ETG.2010.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace taktwerk::ecat {

/// What a word of this image is for: "alias", "product", "sync manager 2 length", "TxPDO 1A00h entry 3", "string 4 'Controlword'",
/// "behind the end marker".
[[nodiscard]] std::string sii_field(std::span<const std::byte> image, std::size_t word);

struct SiiWordChange {
    std::size_t word = 0;
    std::uint16_t from = 0, to = 0;
    friend bool operator==(const SiiWordChange&, const SiiWordChange&) = default;
};

/// From the first to the last. Of images of different length the common part is compared.
[[nodiscard]] std::vector<SiiWordChange> sii_changes(std::span<const std::byte> before, std::span<const std::byte> after);

/// Word 4, and the checksum of words 0 to 6 in word 7. `image` has at least 16 bytes.
void set_sii_alias(std::span<std::byte> image, std::uint16_t alias) noexcept;

}  // namespace taktwerk::ecat

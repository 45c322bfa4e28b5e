#pragma once
// The firmware of simulated slaves, as a file: which device it is for, its revision and version, and a checksum over all of it. The
// format is ours; each maker has his own. Not for the cycle.
//
//   0   "TWFW"                 16  bytes of the body
//   4   vendor                 20  CRC-32 (IEEE 802.3) of bytes 0 to 19, 24 to 31 and the body
//   8   product                24  version, 8 characters, filled up with zeros
//   12  revision               32  the body

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecat/wire/identity.hpp"

namespace taktwerk::ecat::sim {

inline constexpr std::size_t firmware_header_size = 32;

struct FirmwareInfo {
    Identity identity;  ///< without a serial number
    std::string version;
    std::size_t size = 0;  ///< of header and body
    bool sound = false;    ///< all of it is there, and the checksum is right
};

/// The body is made of the identity and the version: two versions differ all over.
[[nodiscard]] std::vector<std::byte> firmware_image(const Identity& identity, std::string_view version, std::size_t body);

/// What a header says, whatever follows; nothing when it is none.
[[nodiscard]] std::optional<FirmwareInfo> read_firmware(std::span<const std::byte> bytes);

}  // namespace taktwerk::ecat::sim

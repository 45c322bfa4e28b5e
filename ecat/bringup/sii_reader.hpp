#pragma once
// Reading a slave's EEPROM through its controller's interface (0500h..050Fh): single words, or the whole image by following the
// chain of categories, so that a 2 KiB EEPROM with 500 bytes in it costs 500 bytes. 8 bytes a command where the controller
// offers them, else 4. Source: ETG.1000.4 (SII), ETG.2010.
//
// Budget: a word may stay busy for sii_busy_limit; a command that the controller refuses (no acknowledge from the EEPROM) is
// repeated sii_retries times. Errors: bus.sii names slave and word; bus.no_frame, bus.no_slave.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

inline constexpr Duration sii_busy_limit = std::chrono::seconds{1};
inline constexpr unsigned sii_retries = 20;

/// Two words from `word` on, low word first.
[[nodiscard]] Script<Result<std::uint32_t>> read_sii(DatagramPort& port, std::uint16_t station, std::uint16_t word, std::string subject);

/// What an EEPROM holds. Only a header that cannot be read is an error; what breaks off behind it is a defect of the image
/// (SiiDefect::unreadable), and what came before stands in it.
[[nodiscard]] Script<Result<Sii>> read_whole_sii(DatagramPort& port, std::uint16_t station, std::string subject);

/// Every byte of the memory, whatever it means: as many as its word 3Eh says, 2 KiB where that says nothing sensible; or `words` words.
[[nodiscard]] Script<Result<std::vector<std::byte>>> read_eeprom(DatagramPort& port, std::uint16_t station, std::string subject,
                                                                 std::optional<std::size_t> words = {});

}  // namespace taktwerk::ecat

#pragma once
// Reading words of a slave's EEPROM through its controller's interface (0500h..050Fh).

#include <cstdint>

#include "core/result.hpp"
#include "ecat/script/datagram_port.hpp"

namespace taktwerk::ecat {

/// Two words from `word` on, low word first. Retries while the interface is busy or refuses, 1 s at most.
/// Error bus.sii names the word.
[[nodiscard]] Script<Result<std::uint32_t>> read_sii(DatagramPort& port, std::uint16_t station, std::uint16_t word,
                                                     const std::string& subject);

}  // namespace taktwerk::ecat

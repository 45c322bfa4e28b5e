#pragma once
// Changing a slave's EEPROM through its controller (0500h..050Fh): word by word, read back as a whole, and put back as it was when
// anything goes wrong. Service side. Source: ETG.1000.4 (SII), ETG.2010.
//
//   what happens                                            reaction
//   its processor holds the EEPROM (0500h, 0501h)           taken by force (0500h = 2, then 0); it stays: bus.sii_taken, nothing written
//   no acknowledge from the memory (0502h bit 13)           the word is written again, eeprom_attempts times at eeprom_retry_period;
//                                                           then bus.eeprom_write, and what was written is put back
//   write not enabled (bit 14)                              the same
//   busy for ever (bit 15)                                  after eeprom_busy_limit bus.eeprom_write, and what was written is put back
//   checksum wrong (bit 11), not loaded (bit 12)            no obstacle: that is what a writing mends
//   a word reads back as another one                        bus.eeprom_verify, and what was written is put back
//   no frame, no answer: cable out, power gone              bus.no_frame, bus.no_slave; nobody can put anything back: restored is false
//   the slave answers, but putting back fails, too          restored is false
//
// Words go from the last to the first, so that those which the controller itself loads at power-on (0 to 7) are touched at the end.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/script/datagram_port.hpp"

namespace taktwerk::ecat {

inline constexpr unsigned eeprom_attempts = 20;
inline constexpr Duration eeprom_retry_period = std::chrono::milliseconds{5};
inline constexpr Duration eeprom_busy_limit = std::chrono::seconds{1};

/// The master holds the EEPROM from here on. Errors: bus.sii_taken, bus.no_frame, bus.no_slave.
[[nodiscard]] Script<Result<void>> take_eeprom(DatagramPort& port, std::uint16_t station, std::string subject);
/// To the slave's processor, which had it before.
[[nodiscard]] Script<Result<void>> give_eeprom_back(DatagramPort& port, std::uint16_t station, std::string subject);

struct EepromWriting {
    std::size_t words = 0;         ///< that were written
    std::optional<Error> failure;  ///< none: `after` is there, read back
    bool restored = false;         ///< after a failure: `before` is there, read back
};

/// `before`: all that the memory holds now; `after`, of the same length: what it shall hold. An error: nothing was written.
[[nodiscard]] Script<Result<EepromWriting>> write_eeprom(DatagramPort& port, std::uint16_t station, std::vector<std::byte> before,
                                                         std::vector<std::byte> after, std::string subject);

}  // namespace taktwerk::ecat

#pragma once
// From an unknown bus to slaves with names: reset, count, station addresses, EEPROM, device ids, topology, match with the
// configuration (slave_match.hpp). Service side only.

#include <string>

#include "ecat/bringup/bus.hpp"
#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::ecat {

/// The station address of the slave at a position. 0 is what a slave has after power-on, so it is never given.
[[nodiscard]] constexpr std::uint16_t station_at(std::uint16_t position) noexcept { return static_cast<std::uint16_t>(0x1001 + position); }

/// How long a slave may take to show its explicit device id (AL status bit 5). Who has none never does.
inline constexpr Duration device_id_timeout = std::chrono::milliseconds{300};

/// Brings every slave to INIT, clears FMMUs, sync managers and clocks, fills bus.found and bus.topology (empty, and a note,
/// where the ports of the slaves contradict each other) and bus.slaves.
/// Errors: bus.no_frame, bus.empty, and those of match().
[[nodiscard]] Script<Result<void>> scan(Bus& bus);

/// Identity, mailbox and features of the slave that has this station address: the few words that tell who it is. The position only says
/// where it stands. Problems stand in `error`. `sii` is left as it is: read_whole_sii() takes its time.
[[nodiscard]] Script<FoundSlave> read_slave(DatagramPort& port, std::uint16_t position, std::uint16_t station, std::string subject);

/// Where a slave says that its explicit device id stands; 0: it does not say so.
[[nodiscard]] std::uint16_t id_register(const Sii& sii) noexcept;

/// Explicit device identification (ETG.1020): from `address` (id_register()), or, where that is 0, by AL control bit 5, when the id comes
/// in 0134h. Nothing where the slave has none.
[[nodiscard]] Script<std::optional<std::uint16_t>> read_device_id(DatagramPort& port, std::uint16_t station, std::uint16_t address);

}  // namespace taktwerk::ecat

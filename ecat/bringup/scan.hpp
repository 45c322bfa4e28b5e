#pragma once
// From an unknown bus to slaves with names: reset, count, station addresses, EEPROM identity, match with the configuration.

#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// The station address of the slave at a position. 0 is what a slave has after power-on, so it is never given.
[[nodiscard]] constexpr std::uint16_t station_at(std::uint16_t position) noexcept { return static_cast<std::uint16_t>(0x1001 + position); }

/// Brings every slave to INIT, clears FMMUs, sync managers and clocks, finds all and fills bus.slaves.
/// Errors: bus.no_frame, bus.empty, bus.missing_slave, bus.unexpected_slave, bus.wrong_identity, bus.sii.
[[nodiscard]] Script<Result<void>> scan(Bus& bus);

/// Reads identity, alias, mailbox and features of the slave that has this station address. Problems stand in `error`.
[[nodiscard]] Script<FoundSlave> read_slave(DatagramPort& port, std::uint16_t position, std::string subject);

/// Gives every configured slave its place. Pure.
[[nodiscard]] Result<void> match(const BusConfig& config, const std::vector<FoundSlave>& found,
                                 std::vector<std::unique_ptr<BusSlave>>& slaves);

/// Is this the device the configuration wants? Names expected and found.
[[nodiscard]] Result<void> check_identity(const std::string& subject, const DeviceDescription& device, const Identity& found);

}  // namespace taktwerk::ecat

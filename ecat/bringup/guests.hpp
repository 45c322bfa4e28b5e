#pragma once
// Who on a cable belongs to groups that come and go, and what the cable is without them: positions in a configuration do not count groups.
// Pure; service side.

#include <cstdint>
#include <optional>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Whether this is the slave that a group is known by. Nobody who could not be read is.
[[nodiscard]] bool is_head(const SlaveConfig& head, const FoundSlave& found) noexcept;

/// For each of those found: which of `config.slaves` it is, where it belongs to a group, as far as can be told. A second one with the same
/// number counts as well, and one whose followers are others: the group ends in front of the first that is another device.
[[nodiscard]] std::vector<std::optional<std::size_t>> guests_among(const BusConfig& config, const std::vector<FoundSlave>& found);

/// As if no group were plugged in.
struct WithoutGuests {
    BusConfig config;                  ///< those that are always there
    std::vector<FoundSlave> found;     ///< numbered anew from 0
    std::vector<std::uint16_t> place;  ///< of `found`: the position that it has on the cable
};
[[nodiscard]] WithoutGuests without_guests(const BusConfig& config, const std::vector<FoundSlave>& found);

}  // namespace taktwerk::ecat

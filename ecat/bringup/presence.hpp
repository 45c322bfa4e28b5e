#pragma once
// Who is on the cable, and where. Positions count the slaves that are there: with a branch unplugged everybody behind it moves
// up, and the auto-increment address of a missing slave reaches another one. So before a slave that lost its station address is
// spoken to by position, the tree that is there now is laid over the tree of the bring-up.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// For each position of `known` the position in `now`, by following the same ports from the first slave; none: it is gone.
/// Slaves behind ports that `known` does not use are nobody's. Pure.
[[nodiscard]] std::vector<std::optional<std::size_t>> places_now(const Topology& known, const Topology& now);

/// How many of the slaves that answer the first interface reaches: all of them as long as the ring is closed.
[[nodiscard]] std::size_t reached_from_first(const RingState& ring, std::size_t slaves) noexcept;

/// The positions of the slaves that answer, in their order. Of a broken ring those behind the break count from its far end
/// (RingState::second_half): between the halves some may be missing.
[[nodiscard]] std::vector<std::uint16_t> positions_now(const RingState& ring, std::uint16_t answering);

/// Counts the slaves, reads their ports and sets BusSlave::position_now. When the bus changes meanwhile, or no frame comes back,
/// nobody has a place, and bus.census_wanted stays set.
[[nodiscard]] Script<void> take_census(Bus& bus);

/// Who the other master is: "its network address is 02:11:22:33:44:55 (...)".
[[nodiscard]] std::string sender_text(const CycleLink& link);

/// Where a ring is broken, by both ends: "between slave 3 'y' (sv33-e) port 1 and slave 4 'z' (sv33-e) port 0".
[[nodiscard]] std::string break_text(const Bus& bus, const RingState& ring);

/// The cable that leads to a slave: "between slave 3 'y' (sv33-e) port 1 and slave 4 'z' (sv33-e)".
[[nodiscard]] std::string connection_text(const Bus& bus, const BusSlave& slave);

}  // namespace taktwerk::ecat

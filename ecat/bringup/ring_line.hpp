#pragma once
// For the time in which a ring is measured it is a line: the last slave's port to the second interface is closed, so that a frame comes back
// the way it went and every port sees it twice. That is what the tree and the propagation delays are read from (a frame that goes round
// passes each port but once). Afterwards the port is left to itself again. Whoever ends meanwhile leaves a line; the next scan opens its
// ports.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Before positions, tree and clocks are read. Does nothing on a bus with one interface. Error: bus.ring_broken names the break: a machine
/// starts with a whole ring.
[[nodiscard]] Script<Result<void>> make_line(Bus& bus, std::uint16_t slaves);
/// What a bring-up says that failed while the ring was a line: a slave that did not answer then may stand behind a cable that broke. Error:
/// bus.ring_broken, or `failure` where all slaves answer.
[[nodiscard]] Script<Error> named_break(Bus& bus, Error failure);
/// Afterwards.
[[nodiscard]] Script<Result<void>> make_ring(Bus& bus);

}  // namespace taktwerk::ecat

#pragma once
// Why a bring-up did not get its answers: somebody who went away after all had been counted, a cable that damages frames, a port without a
// link. Asked of the slaves that answer when it has just failed; who stands behind a fault is not accused. Service side.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// bus.no_slave: the first slave that does not answer, and the cable that leads to it. bus.cable_errors: the cable that damaged most frames
/// since the counters were cleared. bus.no_link, bus.no_frame: nothing comes back any more, or frames get lost and no slave knows where. Any
/// other failure stays as it is. Rings have their own word (ring_line.hpp).
[[nodiscard]] Script<Error> named_loss(Bus& bus, Error failure);

}  // namespace taktwerk::ecat

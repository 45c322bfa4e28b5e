#pragma once
// What a person does when all is mended, and what has to come of it.

#include "tests/whole_machine/hands.hpp"
#include "tests/whole_machine/rig.hpp"

namespace taktwerk::whole {

/// Presses what begins the work of this machine, where there is such a button.
void begin_work(Rig& rig);

/// Nothing moves before; within a minute every slave is in OP, every axis has been reset, has power, moves a little and stands, and no alarm is left.
/// False: a problem of the rig says what is not so.
bool recover(Rig& rig, Hands& hands);

/// Axes stop, power goes off, the bus goes down, within their times.
bool end_in_order(Rig& rig);
bool bus_down(Rig& rig);

}  // namespace taktwerk::whole

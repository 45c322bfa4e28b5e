#pragma once
// Groups that come and go while the bus is in operation. They have their places in the process image and in the frames from the start;
// whoever is plugged in is found by its alias or explicit device id, wherever that is, compared with what is configured, and taken to OP by
// the steps of the bring-up. Nobody else is touched, but for the propagation delays of those behind it.
//
//     away -> joining -> there -> away       SlaveLink::attendance of all slaves of the group
//
// Who is plugged in and is no group is left alone and named (stranger_plugged_in); a group that is there and cannot join says why
// (group_does_not_join) and is tried again, at first after half a second, then ever later. Service side only.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// For as long as the bus is in operation.
[[nodiscard]] Script<void> watch_groups(Bus& bus);

/// A slave of a group does not answer any more: the whole group is away from now on.
void leave(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat

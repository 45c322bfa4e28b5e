#pragma once
// Who is on the cable of a bus that runs, for whoever looks at it meanwhile: what the master knows of its slaves, and what their ports and error
// counters say now. Reads three registers of each slave as far as the cycle has datagrams to spare; writes nothing, misses nobody.

#include "ecat/bringup/bus.hpp"
#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::ecat {

/// What the master knows, without a frame: counters and ports as the bring-up saw them. Service side. Pure.
[[nodiscard]] Survey known_survey(const Bus& bus);

/// `survey`, with ports, counters and the tree as they are now. What a slave does not answer stays as it was, with an `error`.
[[nodiscard]] Script<void> look_at_ports(Bus& bus, Survey& survey);

/// The slave of the configuration that stands at a position; nullptr: none of it, or nobody knows.
[[nodiscard]] const BusSlave* slave_at(const Bus& bus, std::size_t position);

}  // namespace taktwerk::ecat

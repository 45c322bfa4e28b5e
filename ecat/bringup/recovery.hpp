#pragma once
// The way back: one slave that fell, was power-cycled or unplugged goes through the steps of the bring-up again, as many of
// them as its state asks for. The other slaves go on meanwhile.

#include <string>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Valid process data is exchanged this many times before OP is asked for.
inline constexpr std::uint32_t valid_cycles = 5;

/// One slave back to OP from whatever it is in. Needs a bus that was operational once. May be called again at any time.
/// Errors: bus.no_slave (not on the cable: needs a census), bus.wrong_place, bus.wrong_identity, bus.refused_state, ...
[[nodiscard]] Script<Result<void>> recover(Bus& bus, BusSlave& slave);

/// Which sync manager or FMMU of its process data does not read any more as it was written: "FMMU0"; the first of them, or nothing.
[[nodiscard]] Script<Result<std::string>> changed_setting(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat

#pragma once
// The way back: one slave that fell, was power-cycled or unplugged goes through the steps of the bring-up again, as many of
// them as its state asks for. The other slaves go on meanwhile.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Valid process data is exchanged this many times before OP is asked for.
inline constexpr std::uint32_t valid_cycles = 5;

/// One slave back to OP from whatever it is in. Needs a bus that was operational once. May be called again at any time.
[[nodiscard]] Script<Result<void>> recover(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat

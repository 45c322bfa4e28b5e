#pragma once
// One slave too few or too many in the middle of the cable moves all behind it to another position. They are the right ones in the right
// order, so none of them is a wrong device: who was left out, or does not belong there, is named. Pure.

#include <optional>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Nothing where the slaves are not addressed by position alone, where as many are there as configured, where the first or the last
/// ones are concerned (the plain comparison says it well), or where not all others fit their places.
[[nodiscard]] std::optional<Error> shifted_slaves(const BusConfig& config, const std::vector<FoundSlave>& found);

}  // namespace taktwerk::ecat

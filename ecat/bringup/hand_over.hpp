#pragma once
// What the cycle gets of a bus that is configured: the end of the bring-up's knowledge, and all that the cycle needs of it.

#include <memory>

#include "ecat/bringup/bus.hpp"
#include "ecat/cycle/cycle_plan.hpp"

namespace taktwerk::ecat {

/// Its links point into `bus`, which lives as long as the plan.
[[nodiscard]] std::unique_ptr<CyclePlan> cycle_plan(const Bus& bus);

}  // namespace taktwerk::ecat

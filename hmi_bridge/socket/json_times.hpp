#pragma once
// Histograms of the cycle and of the tasks as JSON. Not real-time.

#include <string>

#include "runtime/cycle_histograms.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

/// {"lateness":H,"compute":H,"steps":[{"name":"receive",...H}],"tasks":[{"name":"cell.main",...H}]}; H: "longest_ns", the cycle in which that was
/// ("longest_cycle", 0: never), "count", "bins": [first ns, last ns, count] of each bin that is not empty.
[[nodiscard]] std::string times_json(const runtime::MachineLayout& layout, const runtime::MachineTimes& times);

}  // namespace taktwerk::hmi

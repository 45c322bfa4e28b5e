#pragma once
// The machine as JSON text: what does not change while it runs. Not real-time.

#include <string>

#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

/// Names, units, ranges, jogging speeds.
[[nodiscard]] std::string layout_json(const runtime::MachineLayout& layout);

}  // namespace taktwerk::hmi

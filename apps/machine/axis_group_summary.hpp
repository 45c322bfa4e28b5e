#pragma once
// Groups of axes that move together, in words: for `taktwerk check`.

#include <nlohmann/json.hpp>

#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

void print_axis_groups(const runtime::MachineConfig& config);
[[nodiscard]] nlohmann::ordered_json axis_groups_json(const runtime::MachineConfig& config);

}  // namespace taktwerk::apps

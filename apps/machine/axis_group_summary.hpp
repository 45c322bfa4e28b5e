#pragma once
// Groups of axes that move together, and the stored paths that they go, in words: for `taktwerk check`.

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

/// With their heading; empty: there is none.
[[nodiscard]] std::string axis_groups_text(const runtime::MachineConfig& config);
[[nodiscard]] std::string paths_text(const runtime::MachineConfig& config);
[[nodiscard]] nlohmann::ordered_json axis_groups_json(const runtime::MachineConfig& config);
[[nodiscard]] nlohmann::ordered_json paths_json(const runtime::MachineConfig& config);

}  // namespace taktwerk::apps

#pragma once
// Groups of axes as lines of a terminal: a part of what `taktwerk monitor` shows. Pure.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/machine/monitor_screen.hpp"

namespace taktwerk::apps {

/// `state` as the runtime gives it; empty where it has no groups. Without details a line a group, and why one is in error.
[[nodiscard]] std::vector<std::string> monitor_groups(const nlohmann::ordered_json& state, const ScreenSize& size, bool details);

}  // namespace taktwerk::apps

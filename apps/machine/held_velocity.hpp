#pragma once
// Said behind the answer to a motion command: that the axis goes slower than it was asked to, by what, and how to change that.

#include <string>

#include <nlohmann/json.hpp>

namespace taktwerk::apps {

/// `axis`: its object of the state; `mode`: the machine's mode as the state spells it. Empty while nothing but the command decides.
[[nodiscard]] std::string held_velocity(const nlohmann::ordered_json& axis, const std::string& mode);

}  // namespace taktwerk::apps

#pragma once
// In which keys two YAML files differ, in words: for whoever has to decide whether a new version may run. Not real-time.

#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::apps {

/// "axes.x.limits.velocity: 200 mm/s -> 250 mm/s", "io.inputs.door: new, {slave: io, channel: 3}", "programs.feeder: gone (...)"; in the order of the newer
/// file, what is gone last. Elements of a list that have a `name` are compared by it, others by their place. A text that is no YAML differs as a whole.
[[nodiscard]] std::vector<std::string> yaml_difference(std::string_view before, std::string_view after);

}  // namespace taktwerk::apps

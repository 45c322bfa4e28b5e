#pragma once
// "Did you mean ...": the nearest of some names, by edit distance. For error messages; not real-time.

#include <string>
#include <string_view>
#include <vector>

namespace taktwerk {

/// The candidate nearest to `name`, whatever the case of its letters, or empty when none is near enough to be a slip of the keyboard.
[[nodiscard]] std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace taktwerk

#pragma once
// What the floors themselves say about a configuration: the one place where config/ calls their checks.

#include <vector>

#include "config/machine_file/machine_loader.hpp"
#include "core/result.hpp"

namespace taktwerk::config {

/// Subjects name the field ("axes.x.limits.velocity"); the loader turns them into file positions.
[[nodiscard]] std::vector<Error> check_floors(const LoadedMachine& loaded);

}  // namespace taktwerk::config

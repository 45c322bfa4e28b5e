#pragma once
// Whether a machine of this computer stands without power: only then another version of it is made the active one.

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace taktwerk::apps {

enum class Runs {
    no,            ///< nobody answers as this machine, and nothing runs from its active version
    without_power  ///< it runs, and no axis of it is enabled
};

/// `socket`: where its machine file says that it is asked; empty: by its name. `version_folder`: of the active version; empty: none is.
/// Errors: bundle.machine_runs (axes are enabled, or it does not say whether they are). Not real-time.
[[nodiscard]] Result<Runs> idle_machine(const std::string& machine, const std::string& socket, const std::filesystem::path& version_folder);

}  // namespace taktwerk::apps

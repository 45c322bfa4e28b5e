#pragma once
// The keys of a machine file that say what stands on its builder's own pages.

#include "config/machine_file/machine_tables.hpp"

namespace taktwerk::config {

/// The section `views`.
[[nodiscard]] Field<MachineFile> views_field();

}  // namespace taktwerk::config

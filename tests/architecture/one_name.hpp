#pragma once
// One thing a name: two classes of one namespace with the same name in two files are undefined behaviour as soon as both are linked (one definition
// rule), which no compiler and no linker says; what happens is a crash somewhere else.

#include <vector>

#include "tests/architecture/source_text.hpp"
#include "tests/architecture/walls.hpp"

namespace taktwerk::architecture {

/// Classes and enumerations that stand at the first column in a named namespace; those without a name for their namespace, specialisations, members of
/// classes and declarations do not count. Namespaces end with the line "}  // namespace ...", as everywhere here.
[[nodiscard]] Violations check_names_stand_once(const std::vector<SourceFile>& files);

}  // namespace taktwerk::architecture

#pragma once
// Marks in the sources of the tests: a comment that names clauses, directly above a TEST or inside it, says that this test would fail
// if the clause were broken. `// P1-123`, several with commas, a range as `P1-115..P1-117` or `P1-115..117`.

#include <cstddef>
#include <string>
#include <vector>

#include "tests/architecture/source_text.hpp"

namespace taktwerk::conformance {

/// One clause named in one place.
struct Mark {
    int clause = 0;
    std::string test;  ///< Suite.Name; empty where no TEST is near: such a mark shows nothing
    std::string path;
    std::size_t line = 0;  ///< 1-based
};

/// In the order of the file; the same clause twice for one test is one mark. `document`: what stands before the number, "P1" or "G" (Part 4).
[[nodiscard]] std::vector<Mark> marks_of(const architecture::SourceFile& file, const std::string& document = "P1");

}  // namespace taktwerk::conformance

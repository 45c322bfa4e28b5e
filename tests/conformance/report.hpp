#pragma once
// The verdict over lists and marks, and the page docs/conformance/plcopen-part1.md.

#include <map>
#include <string>
#include <vector>

#include "tests/conformance/clauses.hpp"
#include "tests/conformance/marks.hpp"

namespace taktwerk::conformance {

struct Evidence {
    std::vector<Clause> clauses;
    std::vector<NotDone> not_done;
    std::vector<Decision> decisions;
    std::vector<Mark> marks;
};

/// Unknown clauses, marks without a test, clauses about which nothing is said, and lines that say what is no longer true. Sentences.
[[nodiscard]] std::vector<std::string> problems_of(const Evidence& evidence);

/// not_done.txt without the clauses that are shown by now.
[[nodiscard]] std::string not_done_text(const Evidence& evidence);

/// Markdown.
[[nodiscard]] std::string page_of(const Evidence& evidence);

}  // namespace taktwerk::conformance

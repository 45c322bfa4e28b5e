#pragma once
// The lists beside the marks: the clauses themselves, what is not done and why, and what was decided where the standard leaves a
// choice. Text files of this folder, one entry a line, fields between bars, '#' for comments.

#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::conformance {

struct Clause {
    int number = 0;
    std::string section, page, title;
    bool choice = false;  ///< implementation dependent: the decision is to be documented
};

struct NotDone {
    std::vector<int> clauses;
    std::string reason;
};

struct Decision {
    int clause = 0;
    std::string decision;
    std::string file, words;  ///< the file in which it is written, and words that stand there
};

/// A problem names the line of the text.
template <class Entry>
struct Listed {
    std::vector<Entry> entries;
    std::vector<std::string> problems;
};

[[nodiscard]] Listed<Clause> parse_clauses(std::string_view text);
[[nodiscard]] Listed<NotDone> parse_not_done(std::string_view text);  ///< `12, 30..34 | reason`
[[nodiscard]] Listed<Decision> parse_decisions(std::string_view text);

}  // namespace taktwerk::conformance

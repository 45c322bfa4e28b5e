#include "runtime/retain/retain_note.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace taktwerk::runtime {

std::vector<std::string> lines_of(std::span<const RetainNote> notes) {
    using What = RetainNote::What;
    constexpr std::array<std::pair<What, std::string_view>, 7> words{{{What::kept, "as they were"},
                                                                      {What::converted, "converted"},
                                                                      {What::added, "new"},
                                                                      {What::refused, "not usable"},
                                                                      {What::configured, "overruled by the configuration"},
                                                                      {What::unclaimed, "kept aside"},
                                                                      {What::cold, "given up by this start"}}};
    std::string counts;
    for (const auto& [what, word] : words) {
        const auto count = std::count_if(notes.begin(), notes.end(), [what = what](const RetainNote& note) { return note.what == what; });
        if (count > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, word);
    }
    std::vector<std::string> lines;
    if (!counts.empty()) lines.push_back("kept values: " + counts);
    for (const auto& note : notes)
        if (!note.text.empty()) lines.push_back(note.text);
    return lines;
}

}  // namespace taktwerk::runtime

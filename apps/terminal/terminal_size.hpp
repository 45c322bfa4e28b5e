#pragma once
// How much fits on the terminal, and a picture of text cut to it.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace taktwerk::apps {

struct TerminalSize {
    std::size_t columns = 80, rows = 24;
};

/// Of standard output; nothing where it is none, or does not say.
[[nodiscard]] std::optional<TerminalSize> terminal_size();

/// `text`, lines that end with newlines, with colours as toned() makes them: each line at most as wide as the terminal, and no more lines than leave the last
/// row to the cursor. What was cut ends with "…"; the last line says so where lines are missing.
[[nodiscard]] std::string fitted(std::string_view text, const TerminalSize& size);

}  // namespace taktwerk::apps

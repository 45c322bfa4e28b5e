#pragma once
// Tables and emphasis for the terminal: columns as wide as their widest cell, colour only where there is a terminal.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::apps {

enum class Tone : std::uint8_t { plain, good, warning, bad, faint, strong };

/// Whether standard output is a terminal that takes colours ($NO_COLOR, and TERM=dumb, switch them off).
enum class Colours : std::uint8_t { off, on };
[[nodiscard]] Colours colours_of_output();

[[nodiscard]] std::string toned(std::string_view text, Tone tone, Colours colours);

struct Cell {
    std::string text;
    Tone tone = Tone::plain;
    Cell(std::string words, Tone shade = Tone::plain) : text(std::move(words)), tone(shade) {}  // NOLINT(google-explicit-constructor)
    Cell(const char* words) : text(words) {}                                                    // NOLINT(google-explicit-constructor)
};

class TextTable {
public:
    struct Column {
        std::string title;
        enum class Side : std::uint8_t { left, right } side = Side::left;
        std::size_t limit = 0;  ///< widest a cell may be before it is cut with "…"; 0: any
    };
    explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

    /// Missing cells are empty. Control characters, which names of foreign devices may have, become blanks.
    void add(std::vector<Cell> row);
    [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }
    /// Lines ending with a newline, `indent` spaces before each; no trailing spaces.
    [[nodiscard]] std::string text(Colours colours, std::size_t indent = 0) const;

private:
    std::vector<Column> columns_;
    std::vector<std::vector<Cell>> rows_;
};

/// Breaks a text between words into lines of at most `width` columns; each line but the first starts with `indent` spaces.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 80);

}  // namespace taktwerk::apps

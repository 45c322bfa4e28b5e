#include "apps/terminal/text_table.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "apps/terminal/terminal_text.hpp"
#include "core/one_line.hpp"

namespace taktwerk::apps {

namespace {

const char* escape(Tone tone) noexcept {
    switch (tone) {
        case Tone::good: return "\033[32m";
        case Tone::warning: return "\033[33m";
        case Tone::bad: return "\033[1;31m";
        case Tone::faint: return "\033[2m";
        case Tone::strong: return "\033[1m";
        case Tone::plain: break;
    }
    return "";
}

}  // namespace

Colours colours_of_output() {
    const char* none = std::getenv("NO_COLOR");
    const char* term = std::getenv("TERM");
    const bool off = (none != nullptr && *none != '\0') || (term != nullptr && std::strcmp(term, "dumb") == 0);
    return !off && ::isatty(STDOUT_FILENO) != 0 ? Colours::on : Colours::off;
}

std::string toned(std::string_view text, Tone tone, Colours colours) {
    if (colours == Colours::off || tone == Tone::plain || text.empty()) return std::string{text};
    return std::string{escape(tone)} + std::string{text} + "\033[0m";
}

void TextTable::add(std::vector<Cell> row) {
    for (auto& cell : row) cell.text = on_one_line(cell.text);
    rows_.push_back(std::move(row));
}

std::string TextTable::text(Colours colours, std::size_t indent) const {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        std::size_t width = columns(columns_[c].title);
        for (const auto& row : rows_)
            if (c < row.size()) width = std::max(width, columns(row[c].text));
        if (columns_[c].limit != 0) width = std::min(width, std::max(columns_[c].limit, columns(columns_[c].title)));
        widths.push_back(width);
    }
    const auto line = [&](const auto& cell_at) {
        std::string out(indent, ' ');
        std::string gap;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            const Cell cell = cell_at(c);
            const std::string shown = cut(cell.text, widths[c]);
            const std::string space(widths[c] - columns(shown), ' ');
            const bool right = columns_[c].side == Column::Side::right;
            if (shown.empty()) {
                gap += space + "  ";
                continue;
            }
            out += gap + (right ? space : "") + toned(shown, cell.tone, colours);
            gap = (right ? "" : space) + "  ";
        }
        return out + "\n";
    };
    std::string out = line([&](std::size_t c) { return Cell{columns_[c].title, Tone::faint}; });
    for (const auto& row : rows_) out += line([&](std::size_t c) { return c < row.size() ? row[c] : Cell{""}; });
    return out;
}

std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
    std::string out;
    std::size_t used = indent;
    while (!text.empty()) {
        const auto end = std::min(text.find(' '), text.size());
        const auto word = text.substr(0, end);
        const std::size_t size = columns(word);
        const bool first = used == indent;
        if (!first && used + 1 + size > width) {
            out += "\n" + std::string(indent, ' ');
            used = indent;
        } else if (!first) {
            out += ' ';
            ++used;
        }
        out += word;
        used += size;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

}  // namespace taktwerk::apps

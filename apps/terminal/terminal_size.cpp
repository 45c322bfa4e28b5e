#include "apps/terminal/terminal_size.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "apps/terminal/terminal_text.hpp"

namespace taktwerk::apps {

namespace {

constexpr std::string_view plain_again = "\033[0m";

/// Of the colour at the front; 0: none is there.
std::size_t colour_bytes(std::string_view text) {
    if (!text.starts_with("\033[")) return 0;
    const auto end = text.find('m');
    return end == std::string_view::npos ? 0 : end + 1;
}

std::string without_colours(std::string_view line) {
    std::string out;
    while (!line.empty()) {
        if (const auto bytes = colour_bytes(line); bytes > 0) {
            line.remove_prefix(bytes);
            continue;
        }
        out += line.front();
        line.remove_prefix(1);
    }
    return out;
}

/// Colours take no columns.
std::string cut_line(std::string_view line, std::size_t width) {
    const auto letters = without_colours(line);
    if (columns(letters) <= width) return std::string(line);
    const auto kept = cut(letters, width);  // a part of the letters from their beginning, and "…"
    constexpr std::string_view dots = "…";
    std::size_t left = kept.size() - (kept.ends_with(dots) ? dots.size() : 0);
    std::string out;
    bool coloured = false;
    while (left > 0) {
        if (const auto bytes = colour_bytes(line); bytes > 0) {
            coloured = line.substr(0, bytes) != plain_again;
            out += line.substr(0, bytes);
            line.remove_prefix(bytes);
            continue;
        }
        out += line.front();
        line.remove_prefix(1);
        --left;
    }
    if (coloured) out += plain_again;
    if (kept.ends_with(dots)) out += dots;
    return out;
}

}  // namespace

std::optional<TerminalSize> terminal_size() {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return std::nullopt;
    return TerminalSize{size.ws_col, size.ws_row};
}

std::string fitted(std::string_view text, const TerminalSize& size) {
    std::vector<std::string> lines;
    const auto room = std::max<std::size_t>(size.rows, 2) - 1;
    while (!text.empty()) {
        if (lines.size() == room) {
            lines.back() = cut("… the terminal is too small for the rest", size.columns);
            break;
        }
        const auto end = std::min(text.find('\n'), text.size());
        lines.push_back(cut_line(text.substr(0, end), size.columns));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    std::string out;
    for (const auto& line : lines) out += line + "\n";
    return out;
}

}  // namespace taktwerk::apps

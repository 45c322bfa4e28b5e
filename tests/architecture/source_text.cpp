#include "tests/architecture/source_text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace taktwerk::architecture {
namespace {

constexpr auto npos = std::string_view::npos;

/// Past the end of the literal that opens at `at` with `quote`.
std::size_t end_of_literal(std::string_view text, std::size_t at, char quote) {
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] == '\\') ++i;
        else if (text[i] == quote || text[i] == '\n') return i + 1;
    }
    return text.size();
}

/// Past the end of the raw string whose quote stands at `at`: R"delimiter( ... )delimiter".
std::size_t end_of_raw_string(std::string_view text, std::size_t at) {
    const auto open = text.find('(', at);
    if (open == npos) return text.size();
    const std::string close = ")" + std::string(text.substr(at + 1, open - at - 1)) + "\"";
    const auto found = text.find(close, open);
    return found == npos ? text.size() : found + close.size();
}

/// 1'000'000: a quote between two digits opens no literal.
bool separates_digits(std::string_view text, std::size_t at) {
    return at > 0 && at + 1 < text.size() && std::isxdigit(static_cast<unsigned char>(text[at - 1])) != 0 &&
           std::isxdigit(static_cast<unsigned char>(text[at + 1])) != 0;
}

}  // namespace

std::string code_of(std::string_view text, Literals literals) {
    std::string code(text);
    const auto blank = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < std::min(to, code.size()); ++i)
            if (code[i] != '\n') code[i] = ' ';
    };
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i + 1;
        if (text.substr(i, 2) == "//") {
            end = std::min(text.find('\n', i), text.size());
            blank(i, end);
        } else if (text.substr(i, 2) == "/*") {
            const auto close = text.find("*/", i + 2);
            end = close == npos ? text.size() : close + 2;
            blank(i, end);
        } else if (text[i] == '"' || (text[i] == '\'' && !separates_digits(text, i))) {
            const bool raw = text[i] == '"' && i > 0 && text[i - 1] == 'R';
            end = raw ? end_of_raw_string(text, i) : end_of_literal(text, i, text[i]);
            if (literals == Literals::blank) blank(i + 1, end - 1);
        }
        i = end;
    }
    return code;
}

std::vector<IncludeLine> include_lines(std::string_view text) {
    static const std::regex pattern(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
    std::vector<IncludeLine> includes;
    std::istringstream lines(code_of(text, Literals::keep));
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (std::regex_search(line, match, pattern)) includes.push_back({number, match[2], match[1] == "\""});
    }
    return includes;
}

std::string folder_of(std::string_view path) {
    const auto slash = path.rfind('/');
    return slash == npos ? std::string{} : std::string(path.substr(0, slash));
}

std::string floor_of(std::string_view path) { return std::string(path.substr(0, path.find('/'))); }

bool lies_in(std::string_view path, std::string_view folder) {
    return path == folder || (path.size() > folder.size() && path.substr(0, folder.size()) == folder && path[folder.size()] == '/');
}

std::vector<SourceFile> read_sources(const std::string& root, const std::string& folder) {
    namespace fs = std::filesystem;
    std::vector<SourceFile> files;
    const fs::path top = fs::path(root) / folder;
    if (!fs::is_directory(top)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(top)) {
        const auto extension = entry.path().extension();
        if (!entry.is_regular_file() || (extension != ".hpp" && extension != ".cpp")) continue;
        std::ostringstream text;
        text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
        files.push_back({fs::relative(entry.path(), root).generic_string(), text.str()});
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
    return files;
}

}  // namespace taktwerk::architecture

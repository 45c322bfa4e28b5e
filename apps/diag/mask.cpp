#include "apps/diag/mask.hpp"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

constexpr std::size_t longest_line =
    2000;  // std::regex goes as deep as a line is long; what is longer is masked whole where it holds such a word

const std::string secret_key =
    R"re(((?:(?:[A-Za-z0-9][A-Za-z0-9_-]*)?(?:password|passwd|passphrase|secret|token|credential|private[_-]?key|api[_-]?key)|)re"
    R"re((?:[A-Za-z0-9]+[_-])*(?:psk|community|pwd|pass|authorization))s?(?:[_-]?(?:hash|text|value|access|key|\d+))*))re";

/// The key, what stands between, the value: quoted (also inside a quoted text) where it ends as a value does, else all that follows.
const std::regex& secret() {
    static const std::regex pattern("(^|[^A-Za-z0-9])" + secret_key +
                                        R"re((\\?["']?\s*[:=]\s*|\s+(?=[^\s:=,}\]#])))re"
                                        R"re((\\".*?\\"|(?:"(?:[^"\\]|\\.)*"|'(?:[^']|'')*')(?=\s*(?:[,}\]]|$|\s#|\s--))|\S.*))re",
                                    std::regex::icase | std::regex::optimize);
    return pattern;
}
/// Up to the last @ before a blank or a quotation mark: a password may have one itself.
const std::regex& user_in_address() {
    static const std::regex pattern(R"re(([a-z][a-z0-9+.-]*://[^\s/:@"']*:)([^\s"']+)(@))re", std::regex::icase | std::regex::optimize);
    return pattern;
}
/// A secret key at the beginning of a line: what is deeper than it belongs to its value.
const std::regex& key_of_line() {
    static const std::regex pattern(R"re(^(\s*(?:-\s+)*)["']?)re" + secret_key + R"re(["']?\s*:(?:\s+(\S.*))?\s*$)re",
                                    std::regex::icase | std::regex::optimize);
    return pattern;
}
/// The lines of a text follow; what stands behind it is a comment.
const std::regex& block_mark() {
    static const std::regex pattern(R"re([|>][+-]?\d*[+-]?\s*(?:#.*)?)re");
    return pattern;
}

std::size_t indent_of(std::string_view line) { return std::min(line.find_first_not_of(' '), line.size()); }

/// In `{...}` or `[...]` of the same line, up to `at`.
bool in_flow(const std::string& line, std::size_t at) {
    const auto before = std::string_view(line).substr(0, at);
    const auto count = [&](char c) { return std::count(before.begin(), before.end(), c); };
    return count('{') > count('}') || count('[') > count(']');
}

/// Of a value in `{...}` or `[...]`: up to the comma or bracket that is not its own. A list or a map of secrets is one value.
std::size_t flow_length(std::string_view value) {
    int deep = 0;
    char quote = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const char c = value[i];
        if (quote != 0) {
            if (c == '\\' && quote == '"') ++i;
            else if (c == quote) quote = 0;
        } else if ((c == '"' || c == '\'') && deep > 0) {
            quote = c;
        } else if (c == '{' || c == '[') {
            ++deep;
        } else if (c == '\r' || (deep == 0 && (c == ',' || c == '}' || c == ']'))) {
            return i;
        } else if (c == '}' || c == ']') {
            --deep;
        }
    }
    return value.size();
}

/// How long the value is that begins at `at`; `quoted`: it ends by itself.
std::size_t value_length(const std::string& line, std::size_t at, std::size_t found, bool on_command_line) {
    const auto value = std::string_view(line).substr(at, found);
    const bool quoted = value.size() > 1 && (value.front() == '"' || value.front() == '\'') && value.back() == value.front();
    const bool inside_a_text = value.starts_with("\\\"") && value.ends_with("\\\"");
    if (quoted || inside_a_text) return found;
    const auto ends = on_command_line ? value.find_first_of(" \t\r") : in_flow(line, at) ? flow_length(value) : value.find('\r');
    return std::min(ends, found);
}

std::string mask_line(const std::string& line, std::size_t number, std::vector<std::string>& where) {
    std::string out;
    auto from = line.cbegin();
    std::smatch found;
    while (std::regex_search(from, line.cend(), found, secret())) {
        const auto begin = static_cast<std::size_t>(found[2].first - line.cbegin());
        const bool assigned = found[3].str().find_first_of(":=") != std::string::npos;
        // `password` followed by a word is a secret on a command line (`--password x`) and no secret in a sentence.
        const bool on_command_line = begin >= 2 && line.compare(begin - 2, 2, "--") == 0;
        if (!assigned && !on_command_line) {
            out.append(from, found[2].second);
            from = found[2].second;
            continue;
        }
        const auto at = static_cast<std::size_t>(found[4].first - line.cbegin());
        const auto length = value_length(line, at, static_cast<std::size_t>(found[4].length()), on_command_line);
        out.append(from, found[4].first);
        const auto value = line.substr(at, length);
        if (value.empty() || value == mask) {
            out += value;
        } else {
            const char quote = value.front();
            const bool kept = (quote == '"' || quote == '\'') && value.size() > 1 && value.back() == quote;
            out += value.starts_with("\\\"") && value.ends_with("\\\"") ? "\\\"" + std::string(mask) + "\\\""
                   : kept                                               ? quote + std::string(mask) + quote
                                                                        : std::string(mask);
            where.push_back(fmt::format("line {}: {}", number, found[2].str()));
        }
        from = line.cbegin() + static_cast<std::ptrdiff_t>(at + length);
    }
    out.append(from, line.cend());
    std::string done;
    from = out.cbegin();
    while (std::regex_search(from, out.cend(), found, user_in_address())) {
        done.append(from, found[2].first);
        done += mask;
        where.push_back(fmt::format("line {}: user in an address", number));
        from = found[2].second;
    }
    done.append(from, out.cend());
    return done;
}

}  // namespace

Masked masked(std::string_view text) {
    Masked result;
    constexpr auto none = std::string::npos;
    std::size_t block = none;  // column of the key whose lines follow
    bool list = false;         // and it has no value yet: a list may begin in that column
    bool armoured = false;     // between the lines that begin and end a private key (RFC 7468), whoever it belongs to
    std::size_t number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        const std::string line(text.substr(at, end - at));
        ++number;
        const bool blank = line.find_first_not_of(" \r") == std::string::npos;
        std::smatch begins;
        const auto indent = indent_of(line);
        const bool marks_key = line.find("PRIVATE KEY-----") != std::string::npos;
        if (armoured) {
            armoured = !(marks_key && line.find("-----END") != std::string::npos);
            result.text += std::string(indent, ' ') + std::string(mask);
        } else if (marks_key && line.find("-----BEGIN") != std::string::npos) {
            armoured = line.find("-----END") == std::string::npos;
            result.where.push_back(fmt::format("line {}: a private key", number));
            result.text += std::string(indent, ' ') + std::string(mask);
        } else if (block != none && !blank && (indent > block || (list && indent == block && line[indent] == '-'))) {
            result.text += std::string(indent, ' ') + std::string(mask);
        } else if (line.size() > longest_line) {
            static const std::regex any("password|passwd|passphrase|secret|token|credential|psk|community|private.?key|api.?key|://[^/]*@",
                                        std::regex::icase);
            std::string start = line;
            bool holds = false;  // in pieces that overlap by more than the longest word
            for (std::size_t i = 0; i < line.size() && !holds; i += 1700) holds = std::regex_search(line.substr(i, 2000), any);
            result.text += holds ? std::string(mask) : start;
            if (holds)
                result.where.push_back(fmt::format("line {}: the whole line, which is longer than {} characters", number, longest_line));
        } else {
            if (!blank) block = none;
            const bool named = std::regex_match(line, begins, key_of_line());
            if (named) {
                block = static_cast<std::size_t>(begins[1].length());
                list = !begins[3].matched;
            }
            const auto value = named ? begins[3].str() : std::string();
            if (named && (value.empty() || std::regex_match(value, block_mark()))) {
                result.where.push_back(fmt::format("line {}: {}", number, begins[2].str()));
                result.text += line;
            } else {
                result.text += mask_line(line, number, result.where);
            }
        }
        if (end < text.size()) result.text += '\n';
        at = end + 1;
    }
    return result;
}

}  // namespace taktwerk::apps

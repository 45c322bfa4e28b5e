#include "apps/diag/mask.hpp"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

constexpr std::size_t longest_line =
    2000;  // std::regex goes as deep as a line is long; what is longer is masked whole where it holds such a word

/// The key, what stands between, the value: quoted, or up to what ends one in a flow or a line.
const std::regex& secret() {
    static const std::regex pattern(
        R"re((^|[^A-Za-z0-9])((?:[A-Za-z0-9]+[_-])*(?:password|passwd|passphrase|secret|token|psk|credentials?|private[_-]?key|api[_-]?key|community)(?:[_-](?:hash|text|value))?)("?\s*[:=]\s*|\s+(?=[^\s:=,}\]#])))re"
        R"re(("(?:[^"\\]|\\.)*"|'[^']*'|[^\s,}\]#][^\s,}\]]*))re",
        std::regex::icase | std::regex::optimize);
    return pattern;
}
const std::regex& user_in_address() {
    static const std::regex pattern(R"re(([a-z][a-z0-9+.-]*://[^\s/:@"']*:)([^\s/@"']+)(@))re", std::regex::icase | std::regex::optimize);
    return pattern;
}
const std::regex& block_begins() {
    static const std::regex pattern(
        R"re(^(\s*)(?:-\s+)?"?([A-Za-z0-9_-]*(?:password|passwd|passphrase|secret|token|psk|private[_-]?key|api[_-]?key))"?\s*:\s*[|>][+-]?\d*\s*$)re",
        std::regex::icase | std::regex::optimize);
    return pattern;
}

std::size_t indent_of(std::string_view line) { return std::min(line.find_first_not_of(' '), line.size()); }

/// `password` followed by a word is a secret on a command line (`--password x`) and no secret in a sentence.
bool counts(const std::string& key_and_between, const std::string& line, std::size_t at) {
    if (key_and_between.find_first_of(":=") != std::string::npos) return true;
    return at >= 2 && line.compare(at - 2, 2, "--") == 0;
}

std::string mask_line(const std::string& line, std::size_t number, std::vector<std::string>& where) {
    std::string out;
    auto from = line.cbegin();
    std::smatch found;
    while (std::regex_search(from, line.cend(), found, secret())) {
        const auto begin = static_cast<std::size_t>(found[2].first - line.cbegin());
        out.append(from, found[4].first);
        if (counts(found[3].str(), line, begin) && found[4].str() != mask) {
            const char quote = *found[4].first;
            out += quote == '"' || quote == '\'' ? quote + std::string(mask) + quote : std::string(mask);
            where.push_back(fmt::format("line {}: {}", number, found[2].str()));
        } else {
            out.append(found[4].first, found[4].second);
        }
        from = found[4].second;
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
    std::size_t block = none;  // indent of the key whose lines follow
    std::size_t number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        const std::string line(text.substr(at, end - at));
        ++number;
        const bool blank = line.find_first_not_of(" \r") == std::string::npos;
        std::smatch begins;
        if (block != none && !blank && indent_of(line) > block) {
            result.text += std::string(indent_of(line), ' ') + std::string(mask);
        } else if (line.size() > longest_line) {
            static const std::regex any("password|passwd|passphrase|secret|token|psk|private.?key|api.?key|://[^/]*@", std::regex::icase);
            std::string start = line;
            bool holds = false;  // in pieces that overlap by more than the longest word
            for (std::size_t i = 0; i < line.size() && !holds; i += 1700) holds = std::regex_search(line.substr(i, 2000), any);
            result.text += holds ? std::string(mask) : start;
            if (holds)
                result.where.push_back(fmt::format("line {}: the whole line, which is longer than {} characters", number, longest_line));
        } else {
            if (!blank) block = none;
            if (std::regex_match(line, begins, block_begins())) {
                block = static_cast<std::size_t>(begins[1].length());
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

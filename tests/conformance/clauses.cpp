#include "tests/conformance/clauses.hpp"

#include <charconv>
#include <optional>
#include <sstream>

#include <fmt/format.h>

namespace taktwerk::conformance {
namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
    std::vector<std::string> parts;
    while (true) {
        const auto at = text.find(separator);
        parts.emplace_back(trimmed(text.substr(0, at)));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + separator.size());
    }
}

std::optional<int> number(std::string_view text) {
    int value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// "12, 30..34"
std::optional<std::vector<int>> numbers(const std::string& text) {
    std::vector<int> all;
    for (const auto& part : split(text, ",")) {
        const auto ends = split(part, "..");
        const auto first = number(ends.front()), last = number(ends.back());
        if (ends.size() > 2 || !first || !last || *last < *first) return std::nullopt;
        for (int i = *first; i <= *last; ++i) all.push_back(i);
    }
    return all;
}

/// Gives each line's fields to `take`, which says whether it could use them.
template <class Entry, class Take>
Listed<Entry> parse(std::string_view text, Take take) {
    Listed<Entry> out;
    std::istringstream lines{std::string(text)};
    std::string line;
    for (int at = 1; std::getline(lines, line); ++at) {
        if (trimmed(line).empty() || line.front() == '#') continue;
        Entry entry;
        if (take(split(line, " | "), entry)) out.entries.push_back(entry);
        else out.problems.push_back(fmt::format("line {} cannot be read: {}", at, line));
    }
    return out;
}

}  // namespace

Listed<Clause> parse_clauses(std::string_view text) {
    return parse<Clause>(text, [](const std::vector<std::string>& fields, Clause& clause) {
        if (fields.size() < 4 || fields.size() > 5 || !number(fields[0])) return false;
        clause = {*number(fields[0]), fields[1], fields[2], fields[3], fields.size() == 5};
        return fields.size() == 4 || fields[4] == "choice";
    });
}

Listed<NotDone> parse_not_done(std::string_view text) {
    return parse<NotDone>(text, [](const std::vector<std::string>& fields, NotDone& entry) {
        if (fields.size() != 2 || fields[1].empty()) return false;
        const auto clauses = numbers(fields[0]);
        if (clauses) entry = {*clauses, fields[1]};
        return clauses.has_value();
    });
}

Listed<Decision> parse_decisions(std::string_view text) {
    return parse<Decision>(text, [](const std::vector<std::string>& fields, Decision& entry) {
        if (fields.size() != 4 || !number(fields[0])) return false;
        entry = {*number(fields[0]), fields[1], fields[2], fields[3]};
        return !entry.words.empty();
    });
}

}  // namespace taktwerk::conformance

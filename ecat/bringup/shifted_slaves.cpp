#include "ecat/bringup/shifted_slaves.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::ecat {

namespace {

/// In the order of their positions; empty where some are addressed otherwise or positions are left out.
std::vector<const SlaveConfig*> in_line(const BusConfig& config) {
    std::vector<const SlaveConfig*> line(config.slaves.size());
    for (const auto& slave : config.slaves) {
        if (!slave.position || *slave.position >= line.size()) return {};
        line[*slave.position] = &slave;
    }
    return std::find(line.begin(), line.end(), nullptr) == line.end() ? line : std::vector<const SlaveConfig*>{};
}

bool is(const SlaveConfig& wanted, const FoundSlave& there) {
    return !there.error && !there.sii.has(SiiDefect::empty) && check_identity({}, wanted, there.identity);
}

/// How many fit their places, counted from either end.
struct Fit {
    std::size_t from_front = 0, from_back = 0;
};

Fit fit(const std::vector<const SlaveConfig*>& line, const std::vector<FoundSlave>& found) {
    const std::size_t most = std::min(line.size(), found.size());
    Fit result;
    while (result.from_front < most && is(*line[result.from_front], found[result.from_front])) ++result.from_front;
    while (result.from_back < most && is(*line[line.size() - 1 - result.from_back], found[found.size() - 1 - result.from_back]))
        ++result.from_back;
    return result;
}

std::string found_at(const std::vector<FoundSlave>& found, std::size_t position) {
    return fmt::format("slave {} ({})", position, found_text(found[position]));
}

/// `first`, `last`: places in the line between which the missing ones start, where their neighbours are of their own kind.
Error left_out(const std::vector<const SlaveConfig*>& line, const std::vector<FoundSlave>& found, std::size_t first, std::size_t last) {
    const std::size_t missing = line.size() - found.size();
    const auto named = [&](std::size_t place) { return fmt::format("slave '{}' ({})", line[place]->name, line[place]->device->name); };
    std::string names = named(first);
    for (std::size_t place = first + 1; place < last + missing; ++place) names += ", " + named(place);
    const bool exact = first == last;
    const std::string count = fmt::format("the bus has {} of {} configured slaves", found.size(), line.size());
    Error error{"bus.missing_slave", exact && missing == 1 ? named(first) : std::string{"bus"}, {}, {}};
    if (exact) {
        error.what = fmt::format("{} not on the cable: {}, and those behind are there", missing == 1 ? "is" : names + " are", count);
        const char* it = missing == 1 ? "it" : "them";
        error.remedy = fmt::format("put {} {}, or take {} out of the configuration", it,
                                   first == 0 ? "in front of slave 0" : fmt::format("between slave {} and slave {}", first - 1, first), it);
        if (first > 0) error.remedy += fmt::format("; the cable goes from {} to {}", found_at(found, first - 1), found_at(found, first));
    } else {
        error.what = fmt::format("{} of {} not on the cable: {}, and all others are in their order", missing, names, count);
        error.remedy = "look which of them the cable goes past; they are alike, so who it is the bus cannot tell";
    }
    return error;
}

Error too_many(const std::vector<const SlaveConfig*>& line, const std::vector<FoundSlave>& found, std::size_t first, std::size_t last) {
    const std::size_t extra = found.size() - line.size();
    std::string names = found_at(found, first);
    for (std::size_t place = first + 1; place < last + extra; ++place) names += ", " + found_at(found, place);
    const char* behind = "those behind it are the configured ones, one place further";
    Error error{"bus.unexpected_slave", first == last && extra == 1 ? fmt::format("slave {}", first) : std::string{"bus"}, {}, {}};
    if (first == last && extra == 1)
        error.what = fmt::format("is on the bus but not in the configuration: {}; {}", found_text(found[first]), behind);
    else error.what = fmt::format("{} of {} on the bus but not in the configuration; all others are in their order", extra, names);
    error.remedy = "unplug it, or add it to the configuration at its position: positions count every slave on the cable";
    return error;
}

}  // namespace

std::optional<Error> shifted_slaves(const BusConfig& config, const std::vector<FoundSlave>& found) {
    const auto line = in_line(config);
    if (line.empty() || found.empty() || line.size() == found.size()) return std::nullopt;
    const Fit both = fit(line, found);
    const std::size_t shorter = std::min(line.size(), found.size());
    if (both.from_front >= shorter || both.from_front + both.from_back < shorter) return std::nullopt;
    const std::size_t first = shorter - both.from_back, last = both.from_front;
    return line.size() > found.size() ? left_out(line, found, first, last) : too_many(line, found, first, last);
}

}  // namespace taktwerk::ecat

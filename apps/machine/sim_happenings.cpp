#include "apps/machine/sim_happenings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/reading/quantity.hpp"
#include "config/reading/unit_text.hpp"
#include "core/nearest_name.hpp"
#include "runtime/group_presence.hpp"

namespace taktwerk::apps {

namespace {

using runtime::SimulationEvent;
using Kind = SimulationEvent::Kind;

constexpr double longest_wait_s = 1e6;

constexpr std::array<HappeningWord, 12> all_happenings{{
    {"drive-fault", "AXIS CODE", "the drive raises this alarm (603Fh, or the number of an XP200)", Kind::drive_fault, 0},
    {"main-power-off", "AXIS", "the drive loses its main power", Kind::main_power, 0},
    {"main-power-on", "AXIS", "and gets it back", Kind::main_power, 1},
    {"jam", "AXIS", "the mechanics do not move any more", Kind::jam, 0},
    {"free", "AXIS", "and move again", Kind::jam, 1},
    {"input", "NAME VALUE", "an input takes this value: 0 or 1, one with a unit such as 7.5bar, else the raw number", Kind::input, 0},
    {"input-fault", "NAME", "the terminal reports an error of this input, such as a broken wire", Kind::input_fault, 1},
    {"input-whole", "NAME", "and takes it back", Kind::input_fault, 0},
    {"connect", "GROUP", "a group of hot_connect is coupled, with its supply", Kind::group, 1},
    {"disconnect", "GROUP", "and taken away", Kind::group, 0},
    {"line-cut", "LINE", "a serial line carries nothing any more", Kind::serial_line, 0},
    {"line-plugged", "LINE", "and carries again", Kind::serial_line, 1},
}};

std::vector<std::string> targets(const runtime::MachineConfig& machine, Kind kind) {
    std::vector<std::string> out;
    if (kind == Kind::group) return runtime::group_names(machine.bus);
    if (kind == Kind::serial_line)
        for (const auto& line : machine.serial) out.push_back(line.name);
    else if (kind == Kind::input || kind == Kind::input_fault)
        for (const auto& point : machine.io) {
            const bool fits = kind == Kind::input || !point.status.empty();
            if (point.direction == runtime::IoDirection::input && fits) out.push_back(point.name);
        }
    else
        for (const auto& binding : machine.axes)
            if (!binding.slave.empty() || !binding.drive.empty()) out.push_back(binding.axis.name);
    return out;
}

auto input_named(const runtime::MachineConfig& machine, std::string_view name) {
    return std::ranges::find_if(machine.io, [&](const auto& p) { return p.name == name && p.direction == runtime::IoDirection::input; });
}

/// What a person writes for an input, as its raw word: with a unit where it has one.
Result<std::int64_t> raw_input(const runtime::IoPoint& point, const std::string& text) {
    if (point.unit.empty()) {
        if (const auto number = config::parse_integer(text)) return *number;
        return Error{"fault.arguments", point.name, fmt::format("'{}' is no whole number, and this input has no unit", text),
                     "write 0, 1, or the raw number of its terminal"};
    }
    const auto value = config::value_in(text, point.unit);
    if (!value) return Error{"fault.arguments", fmt::format("{} {}", point.name, text), value.error().what, value.error().remedy};
    if (std::isfinite(*value)) return point.line.raw_of(*value);
    return Error{"fault.arguments", fmt::format("{} {}", point.name, text), "no input has such a value",
                 fmt::format("write a number, as in 7.5{}", point.unit)};
}

Error bad(std::string_view line, const HappeningWord& word) {
    return {"fault.arguments", std::string(line), "is not complete, or has too much",
            fmt::format("write it as {} {}", word.word, word.arguments)};
}

}  // namespace

std::span<const HappeningWord> happening_words() noexcept { return all_happenings; }

Result<SimulationEvent> parse_happening(std::string_view line, const runtime::MachineConfig& machine) {
    std::istringstream in{std::string(line)};
    std::vector<std::string> parts;
    for (std::string part; in >> part;) parts.push_back(part);
    SimulationEvent event;
    if (parts.size() >= 2 && parts[0] == "after") {
        const auto delay = config::parse_quantity(parts[1], config::Dimension::time, "");
        if (delay.problem != config::QuantityProblem::none || !(delay.value >= 0 && delay.value <= longest_wait_s))
            return Error{"fault.arguments", std::string(line), fmt::format("'{}' is no time that will come", parts[1]),
                         "write it as 500ms or 2s; at most 1000000 s"};
        event.at = from_seconds(delay.value);
        parts.erase(parts.begin(), parts.begin() + 2);
    }
    const auto word =
        std::find_if(all_happenings.begin(), all_happenings.end(), [&](const auto& w) { return !parts.empty() && w.word == parts[0]; });
    if (word == all_happenings.end()) return Error{"fault.unknown", std::string(line), "is no happening", "`help` lists them"};
    const bool with_number = word->kind == Kind::drive_fault || word->kind == Kind::input;
    // `7.5 bar` is one value.
    if (word->kind == Kind::input && parts.size() == 4) {
        parts[2] += parts[3];
        parts.pop_back();
    }
    if (parts.size() != (with_number ? 3u : 2u)) return bad(line, *word);
    event.kind = word->kind;
    event.target = parts[1];
    event.value = word->value;
    const auto known = targets(machine, event.kind);
    if (std::find(known.begin(), known.end(), event.target) == known.end()) {
        const auto near = nearest_name(event.target, known);
        return Error{"fault.no_target", event.target, "this machine has no such name",
                     !near.empty()   ? fmt::format("did you mean '{}'?", near)
                     : known.empty() ? "it has none of this kind"
                                     : fmt::format("choose one of {}", fmt::join(known, ", "))};
    }
    if (word->kind == Kind::input) {
        const auto raw = raw_input(*input_named(machine, event.target), parts[2]);
        if (!raw) return raw.error();
        event.value = *raw;
    } else if (with_number) {
        const auto code = config::parse_integer(parts[2]);
        if (!code || *code < 1 || *code > 0xFFFF) return bad(line, *word);
        event.value = *code;
    }
    return event;
}

void Happenings::take(SimulationEvent event, Instant now) {
    const auto at = now + event.at;
    waiting_.push_back({std::move(event), at});
    step(now);
}

void Happenings::step(Instant now) {
    for (const auto& waiting : waiting_)
        if (waiting.at <= now) world_.happen(waiting.event);
    std::erase_if(waiting_, [&](const Waiting& waiting) { return waiting.at <= now; });
}

Instant Happenings::next_event() const noexcept {
    Instant next = Instant::max();
    for (const auto& waiting : waiting_) next = std::min(next, waiting.at);
    return next;
}

}  // namespace taktwerk::apps

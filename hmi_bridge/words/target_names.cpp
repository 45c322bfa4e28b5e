#include "hmi_bridge/words/target_names.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.hpp"

namespace taktwerk::hmi {
namespace {

std::vector<std::string> names(const runtime::MachineLayout& layout, TargetKind kind) {
    std::vector<std::string> out;
    switch (kind) {
        case TargetKind::none: break;
        case TargetKind::axis:
        case TargetKind::axis_or_all:
            for (const auto& axis : layout.axes) out.push_back(axis.name);
            break;
        case TargetKind::program: out = layout.programs; break;
        case TargetKind::parameter:
            for (const auto& parameter : layout.parameters) out.push_back(parameter.program + "." + parameter.name);
            break;
        case TargetKind::output: out = layout.outputs; break;
        case TargetKind::input: out = layout.inputs; break;
        case TargetKind::point: break;
        case TargetKind::variable:
            for (const auto& variable : layout.variables)
                if (variable.writable) out.push_back(variable.program + "." + variable.name);
            break;
        case TargetKind::group:
            for (const auto& group : layout.groups) out.push_back(group.name);
            break;
    }
    return out;
}

/// What came from outside, fit to be shown in one line.
std::string shown(std::string_view name) {
    std::string out;
    for (const char c : name.substr(0, 64)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    return out;
}

Error unknown(TargetKind kind, std::string_view name, const std::vector<std::string>& candidates) {
    Error error{"command.unknown_name", "", fmt::format("there is no {} '{}'", noun(kind), shown(name)), ""};
    if (name.empty()) error.what = fmt::format("the command names no {}", noun(kind));
    if (candidates.empty()) error.remedy = fmt::format("This machine has no {} at all.", noun(kind));
    else if (const auto near = nearest_name(name.substr(0, 64), candidates); !near.empty())
        error.remedy = fmt::format("Did you mean '{}'?", near);
    else
        error.remedy =
            fmt::format("Give one of: {}.",
                        fmt::join(candidates.begin(),
                                  candidates.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(candidates.size(), 12)), ", "));
    return error;
}

}  // namespace

std::string_view noun(TargetKind kind) {
    switch (kind) {
        case TargetKind::none: break;
        case TargetKind::axis:
        case TargetKind::axis_or_all: return "axis";
        case TargetKind::program: return "program";
        case TargetKind::parameter: return "parameter";
        case TargetKind::output: return "output";
        case TargetKind::input: return "input";
        case TargetKind::point: return "point";
        case TargetKind::variable: return "variable";
        case TargetKind::group: return "group";
    }
    return "";
}

/// Among those that people may write; by its name alone where only one program has it.
static Result<std::uint16_t> find_variable(const runtime::MachineLayout& layout, std::string_view name) {
    std::vector<std::size_t> hits;
    std::vector<std::string> known, shown_only;
    for (std::size_t i = 0; i < layout.variables.size(); ++i) {
        const auto& variable = layout.variables[i];
        const auto full = variable.program + "." + variable.name;
        if (!variable.writable) {
            shown_only.push_back(full);
            continue;
        }
        if (full == name) return static_cast<std::uint16_t>(i);
        if (variable.name == name) hits.push_back(i);
        known.push_back(full);
    }
    if (hits.size() == 1) return static_cast<std::uint16_t>(hits.front());
    if (hits.size() > 1)
        return Error{"command.ambiguous_name", "", fmt::format("{} programs have a variable '{}'", hits.size(), name),
                     "Give the program too, as `program.name`."};
    auto error = unknown(TargetKind::variable, name, known);
    if (std::find(shown_only.begin(), shown_only.end(), name) != shown_only.end())
        error.what = fmt::format("variable '{}' is the program's alone: people see it, and do not write it", shown(name));
    return error;
}

Result<std::uint16_t> find_target(const runtime::MachineLayout& layout, TargetKind kind, std::string_view name) {
    if (kind == TargetKind::none) return all_axes;
    if (kind == TargetKind::axis_or_all && name == "all") return all_axes;
    if (kind == TargetKind::variable) return find_variable(layout, name);
    const auto candidates = names(layout, kind);
    const auto found = std::find(candidates.begin(), candidates.end(), name);
    if (found != candidates.end()) return static_cast<std::uint16_t>(found - candidates.begin());

    if (kind == TargetKind::parameter) {
        std::vector<std::size_t> hits;
        std::vector<std::string> bare = candidates;
        for (std::size_t i = 0; i < layout.parameters.size(); ++i) {
            if (layout.parameters[i].name == name) hits.push_back(i);
            bare.push_back(layout.parameters[i].name);
        }
        if (hits.size() == 1) return static_cast<std::uint16_t>(hits.front());
        if (hits.size() > 1)
            return Error{"command.ambiguous_name", "", fmt::format("{} programs have a parameter '{}'", hits.size(), name),
                         fmt::format("Give the program too: '{}' or '{}'.", candidates[hits[0]], candidates[hits[1]])};
        auto error = unknown(kind, name, bare);
        if (!error.remedy.starts_with("Did")) error = unknown(kind, name, candidates);
        return error;
    }
    return unknown(kind, name, candidates);
}

}  // namespace taktwerk::hmi

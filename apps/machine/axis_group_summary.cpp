#include "apps/machine/axis_group_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "axes/group/workspace.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/kinematics/description.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "fb_library/gcode/interpreter.hpp"
#include "fb_library/gcode/program_summary.hpp"
#include "fb_library/gcode/text_source.hpp"
#include "runtime/check/reach_remarks.hpp"

namespace taktwerk::apps {
namespace {

/// "X Y Z C": what the arm commands of its tool.
std::string commanded(const axes::Kinematics& arm) {
    std::string out;
    const auto which = arm.commands();
    for (std::size_t i = 0; i < which.size(); ++i)
        if (which[i]) out += (out.empty() ? "" : " ") + std::string(axes::pose_component_names[i]);
    return out;
}

std::string dynamics_text(const axes::PathDynamics& d, const std::string& u) {
    const auto one = [&u](double value, const char* unit) {
        return value > 0 ? fmt::format("{:g} {}{}", value, u, unit) : std::string("what its axes leave");
    };
    return fmt::format("velocity {}, acceleration {}, deceleration {}, jerk {}", one(d.velocity, "/s"), one(d.acceleration, "/s2"),
                       one(d.deceleration, "/s2"), one(d.jerk, "/s3"));
}

/// In the order of ArmDescription.
constexpr std::array<std::string_view, 8> arm_words{
    "Cartesian axes",           "a beam gantry with two masters", "a CoreXY", "a SCARA", "a palletizer of four axes",
    "a delta with rotary axes", "a delta with linear axes",       "an arm"};
static_assert(arm_words.size() == std::variant_size_v<axes::ArmDescription>);

constexpr double degrees = 180 / std::numbers::pi;
/// Never "-0".
double shown(double value) { return std::abs(value) < 5e-7 ? 0.0 : value; }

std::string pose_text(const axes::SixNumbers& six, const std::string& u) {
    return fmt::format("X {:.6g} Y {:.6g} Z {:.6g} {}, RX {:.6g} RY {:.6g} RZ {:.6g} deg", shown(six[0]), shown(six[1]), shown(six[2]), u,
                       shown(six[3] * degrees), shown(six[4] * degrees), shown(six[5] * degrees));
}

/// What can be compared with the arm: where its tool is with all axes at 0. A wrong convention, a forgotten zero, a swapped sign stand out there.
std::string zero_pose_text(const axes::AxisGroupConfig& group) {
    const auto at = group.kinematics->forward({}, group.equipment.tool_pose());
    if (!at.miss.ok()) return fmt::format("    with its axes at 0 it has no pose: {}\n", axes::name(at.miss.fault));
    return fmt::format("    with its axes at 0 the tool's point stands at {}\n", pose_text(axes::numbers_of(at.pose), group.unit));
}

/// "axis lift has no ends": of straight ones without, which keep the reach from being known.
std::string endless_text(const runtime::MachineConfig& config, const axes::AxisGroupConfig& group) {
    std::string names;
    for (std::size_t i = 0; i < std::min(group.members.size(), group.kinematics->joint_count()); ++i)
        for (const auto& binding : config.axes) {
            const auto& limits = binding.axis.limits;
            const bool ends = std::isfinite(limits.position_min) && std::isfinite(limits.position_max);
            if (binding.axis.name == group.members[i] && !group.kinematics->rotary()[i] && !ends)
                names += (names.empty() ? "" : ", ") + group.members[i];
        }
    if (names.empty()) return {};
    return fmt::format("    where the point comes is not known: no software limits (`limits: {{ position: [...] }}`) at both ends of {}\n",
                       names);
}

/// What a wrong length, unit or limit changes first.
std::string reach_text(const runtime::MachineConfig& config, const axes::AxisGroupConfig& group) {
    const auto reach = runtime::reach_of(config, group);
    if (!reach) return endless_text(config, group);
    if (reach->points.empty()) return {};
    std::string out = fmt::format("    over its axes' travels the point comes to about {} {}", reach->text(), group.unit);
    if (const auto none = reach->looked_at - reach->points.size(); none > reach->looked_at / 100) {
        const double share = 100 * static_cast<double>(none) / static_cast<double>(reach->looked_at);
        out += fmt::format("; {} % of the axes' places are beyond a joint's end, or have no pose",
                           share > 99 ? "more than 99" : fmt::format("{:.0f}", share));
    }
    return out + "\n";
}

/// Tools by their numbers, which are what programs select; frames that the file sets.
std::string carried_text(const axes::AxisGroupConfig& group) {
    std::string out;
    const auto& equipment = group.equipment;
    for (std::size_t i = 1; i < axes::tool_numbers; ++i) {
        const auto* tool = equipment.tools.find(i);
        if (tool == nullptr) continue;
        out += fmt::format("    tool {}: its point stands at {}, seen from the flange", i, pose_text(tool->frame, group.unit));
        if (tool->body.mass > 0) out += fmt::format("; {:g} kg", tool->body.mass);
        out += i == equipment.selected_tool ? "; selected at the start\n" : "\n";
    }
    if (group.kinematics && equipment.selected_tool == 0) out += "    no tool is selected at the start: its point is the flange\n";
    const auto& frames = equipment.frames;
    if (frames.machine != axes::SixNumbers{})
        out += fmt::format("    mcs stands in the world at {}\n", pose_text(frames.machine, group.unit));
    for (std::size_t i = 0; i < frames.product.size(); ++i)
        if (frames.product[i] != axes::SixNumbers{})
            out += fmt::format("    pcs{} stands in the world at {}\n", i == 0 ? std::string{} : fmt::format("_{}", i + 1),
                               pose_text(frames.product[i], group.unit));
    return out;
}

std::string watched_text(const axes::AxisGroupConfig& group) {
    std::string out;
    if (group.workspace) {
        std::string inside, outside;
        for (const auto& room : group.workspace->rooms) {
            auto& names = room.kept_free ? outside : inside;
            names += (names.empty() ? "" : ", ") + room.name;
        }
        out += fmt::format("    its tool's point stays{}{}\n", inside.empty() ? "" : " inside " + inside,
                           outside.empty() ? "" : (inside.empty() ? " out of " : ", and out of ") + outside);
    } else if (group.kinematics) {
        out += "    no workspace: a path may lead its tool's point wherever its axes reach\n";
    }
    if (group.kinematics)
        out += fmt::format("    in set-up mode its tool's point goes at most {:g} {}/s\n", axes::setup_velocity_of(group), group.unit);
    if (group.following.window > 0)
        out += fmt::format("    farther than {:g} {} from its path for {:g} ms it comes to rest\n", group.following.window, group.unit,
                           to_seconds(group.following.time) * 1e3);
    return out;
}

/// A path's text, read through; where it has a fault that stands among the remarks.
struct ReadPath {
    gcode::ProgramSummary summary;
    std::uint32_t lines = 0;
    bool whole = false;
};
ReadPath read_path(const runtime::PathConfig& path) {
    ReadPath out;
    if (path.text == nullptr) return out;
    gcode::TextInMemory text(*path.text);
    gcode::Interpreter program(text, path.options);
    gcode::ProgramItem item;
    auto step = program.next(item);
    for (; step == gcode::Interpreter::Step::item; step = program.next(item)) out.summary.add(item);
    out.lines = program.counts().lines;
    out.whole = step == gcode::Interpreter::Step::end;
    return out;
}

}  // namespace

std::string axis_groups_text(const runtime::MachineConfig& config) {
    std::string out;
    if (!config.axis_groups.empty()) out += "\nAxes that move together\n";
    for (const auto& group : config.axis_groups) {
        out += fmt::format("  {:<16} {}\n", group.name, fmt::join(group.members, ", "));
        if (group.kinematics) {
            out += fmt::format("    {}: {} joints, commands {} of its tool{}\n", arm_words[group.kinematics->kind()],
                               group.kinematics->joint_count(), commanded(*group.kinematics),
                               group.kinematics->closed_form() ? "" : "; its inverse is found step by step");
            out += zero_pose_text(group);
            out += reach_text(config, group);
        } else {
            out += "    no kinematics: commanded in the axes (ACS) alone\n";
        }
        out += carried_text(group);
        out += fmt::format("    where a command does not say it: {}\n", dynamics_text(group.default_dynamics, group.unit));
        out += watched_text(group);
    }
    return out;
}

std::string paths_text(const runtime::MachineConfig& config) {
    std::string out;
    if (!config.paths.empty()) out += "\nPaths in G-code\n";
    for (const auto& path : config.paths) {
        const auto read = read_path(path);
        const auto& summary = read.summary;
        out += fmt::format("  {:<16} {}, {} lines{}\n", path.name, path.file, read.lines, read.whole ? "" : ", up to its fault");
        std::string extents, tools;
        for (std::size_t axis = 0; axis < gcode::axis_count; ++axis) {
            const auto& extent = summary.extents()[axis];
            if (extent.moved)
                extents += fmt::format("{}{} {:.6g} to {:.6g} {}", extents.empty() ? "" : ", ", gcode::axis_letters[axis],
                                       shown(extent.least), shown(extent.most), axis < gcode::linear_axes ? "mm" : "deg");
        }
        if (!extents.empty()) out += fmt::format("    its tool's point, in the machine: {}\n", extents);
        for (const auto tool : summary.tools()) tools += fmt::format("{}{}", tools.empty() ? "" : ", ", tool);
        if (!tools.empty()) out += fmt::format("    tools that it asks for: {}\n", tools);
        out += fmt::format("    whether all of it can be reached, and how long it takes: `taktwerk gcode run MACHINE {}`\n", path.file);
    }
    return out;
}

namespace {

/// Where the tool's point stands with all axes at 0 (angles in rad), and what it comes to over their travels; null: not known, or nowhere.
void add_places(nlohmann::ordered_json& out, const runtime::MachineConfig& config, const axes::AxisGroupConfig& group) {
    out["at_zero"] = nullptr;
    out["reach"] = nullptr;
    if (!group.kinematics) return;
    const auto at = group.kinematics->forward({}, group.equipment.tool_pose());
    const auto reach = runtime::reach_of(config, group);
    if (at.miss.ok()) {
        const axes::SixNumbers pose = axes::numbers_of(at.pose);
        for (std::size_t i = 0; i < pose.size(); ++i) out["at_zero"][axes::pose_component_names[i]] = pose[i];
    }
    if (!reach || reach->points.empty()) return;
    for (std::size_t i = 0; i < reach->least.size(); ++i) out["reach"][axes::pose_component_names[i]] = {reach->least[i], reach->most[i]};
    out["reach"]["without_pose"] = 1 - static_cast<double>(reach->points.size()) / static_cast<double>(reach->looked_at);
}

}  // namespace

nlohmann::ordered_json axis_groups_json(const runtime::MachineConfig& config) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& group : config.axis_groups) {
        out.push_back({{"name", group.name},
                       {"members", group.members},
                       {"unit", group.unit},
                       {"arm", group.kinematics ? std::string(arm_words[group.kinematics->kind()]) : std::string{}},
                       {"commands", group.kinematics ? commanded(*group.kinematics) : std::string{}},
                       {"default",
                        {{"velocity", group.default_dynamics.velocity},
                         {"acceleration", group.default_dynamics.acceleration},
                         {"deceleration", group.default_dynamics.deceleration},
                         {"jerk", group.default_dynamics.jerk}}}});
        add_places(out.back(), config, group);
    }
    return out;
}

nlohmann::ordered_json paths_json(const runtime::MachineConfig& config) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& path : config.paths) {
        const auto read = read_path(path);
        nlohmann::ordered_json one{{"name", path.name}, {"file", path.file}, {"lines", read.lines}, {"whole", read.whole}};
        for (std::size_t axis = 0; axis < gcode::axis_count; ++axis) {
            const auto& extent = read.summary.extents()[axis];
            if (extent.moved) one["extents"][std::string(1, gcode::axis_letters[axis])] = {extent.least, extent.most};
        }
        one["tools"] = read.summary.tools();
        out.push_back(std::move(one));
    }
    return out;
}

}  // namespace taktwerk::apps

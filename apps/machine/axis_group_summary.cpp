#include "apps/machine/axis_group_summary.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "axes/group/workspace.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"

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

/// What can be compared with the arm: where its tool is with all axes at 0. A wrong convention, a forgotten zero, a swapped sign stand out there.
void print_zero_pose(const axes::AxisGroupConfig& group) {
    constexpr double degrees = 180 / std::numbers::pi;
    const auto at = group.kinematics->forward({}, group.equipment.tool_pose());
    if (!at.miss.ok()) return fmt::print("    with its axes at 0 it has no pose: {}\n", axes::name(at.miss.fault));
    const auto six = axes::numbers_of(at.pose);
    const auto shown = [](double value) { return std::abs(value) < 5e-7 ? 0.0 : value; };
    fmt::print("    with its axes at 0 the tool's point stands at X {:.6g} Y {:.6g} Z {:.6g} {}, RX {:.6g} RY {:.6g} RZ {:.6g} deg\n",
               shown(six[0]), shown(six[1]), shown(six[2]), group.unit, shown(six[3] * degrees), shown(six[4] * degrees),
               shown(six[5] * degrees));
}

void print_watched(const axes::AxisGroupConfig& group) {
    if (group.workspace) {
        std::string inside, outside;
        for (const auto& room : group.workspace->rooms) {
            auto& names = room.kept_free ? outside : inside;
            names += (names.empty() ? "" : ", ") + room.name;
        }
        fmt::print("    its tool's point stays{}{}\n", inside.empty() ? "" : " inside " + inside,
                   outside.empty() ? "" : (inside.empty() ? " out of " : ", and out of ") + outside);
    }
    if (group.following.window > 0)
        fmt::print("    farther than {:g} {} from its path for {:g} ms it comes to rest\n", group.following.window, group.unit,
                   to_seconds(group.following.time) * 1e3);
}

}  // namespace

void print_axis_groups(const runtime::MachineConfig& config) {
    if (!config.axis_groups.empty()) fmt::print("\nAxes that move together\n");
    for (const auto& group : config.axis_groups) {
        fmt::print("  {:<16} {}\n", group.name, fmt::join(group.members, ", "));
        if (group.kinematics) {
            fmt::print("    an arm of {} joints that commands {} of its tool{}\n", group.kinematics->joint_count(),
                       commanded(*group.kinematics), group.kinematics->closed_form() ? "" : "; its inverse is found step by step");
            print_zero_pose(group);
        } else {
            fmt::print("    no kinematics: commanded in the axes (ACS) alone\n");
        }
        fmt::print("    where a command does not say it: {}\n", dynamics_text(group.default_dynamics, group.unit));
        print_watched(group);
    }
}

nlohmann::ordered_json axis_groups_json(const runtime::MachineConfig& config) {
    auto out = nlohmann::ordered_json::array();
    for (const auto& group : config.axis_groups)
        out.push_back({{"name", group.name},
                       {"members", group.members},
                       {"commands", group.kinematics ? commanded(*group.kinematics) : std::string{}},
                       {"default",
                        {{"velocity", group.default_dynamics.velocity},
                         {"acceleration", group.default_dynamics.acceleration},
                         {"deceleration", group.default_dynamics.deceleration},
                         {"jerk", group.default_dynamics.jerk}}}});
    return out;
}

}  // namespace taktwerk::apps

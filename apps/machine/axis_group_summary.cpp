#include "apps/machine/axis_group_summary.hpp"

#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

std::string dynamics_text(const axes::PathDynamics& d) {
    const auto one = [](double value, const char* unit) {
        return value > 0 ? fmt::format("{:g} {}", value, unit) : std::string("what its axes leave");
    };
    return fmt::format("velocity {}, acceleration {}, deceleration {}, jerk {}", one(d.velocity, "u/s"), one(d.acceleration, "u/s2"),
                       one(d.deceleration, "u/s2"), one(d.jerk, "u/s3"));
}

}  // namespace

void print_axis_groups(const runtime::MachineConfig& config) {
    if (!config.axis_groups.empty()) fmt::print("\nAxes that move together\n");
    for (const auto& group : config.axis_groups) {
        fmt::print("  {:<16} {}\n", group.name, fmt::join(group.members, ", "));
        if (group.kinematics)
            fmt::print("    an arm of {} joints that commands {} of its tool{}\n", group.kinematics->joint_count(),
                       commanded(*group.kinematics), group.kinematics->closed_form() ? "" : "; its inverse is found step by step");
        else fmt::print("    no kinematics: commanded in the axes (ACS) alone\n");
        fmt::print("    where a command does not say it: {}\n", dynamics_text(group.default_dynamics));
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

#include "axes/group/group_config.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "axes/kinematics/kinematics.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::axes {

std::vector<Error> check(std::span<const AxisGroupConfig> groups, std::span<const std::string> axes) {
    std::vector<Error> errors;
    std::set<std::string> names, taken;
    const std::vector<std::string> known(axes.begin(), axes.end());
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const auto& group = groups[i];
        const std::string subject = "axis_groups." + (group.name.empty() ? std::to_string(i) : group.name);
        const auto problem = [&](std::string code, std::string what, std::string remedy) {
            errors.push_back({"group." + std::move(code), subject, std::move(what), std::move(remedy)});
        };
        if (group.name.empty()) problem("no_name", "the group has no name", "give it one: programs find it by that");
        else if (!names.insert(group.name).second)
            problem("name_twice", "another group is called '" + group.name + "'", "give each group a name of its own");
        if (group.members.size() > most_moved_members)
            problem("too_many_members",
                    "it has " + std::to_string(group.members.size()) + " members, and a path moves " + std::to_string(most_moved_members) +
                        " at most",
                    "divide it");
        if (group.kinematics && group.members.size() != group.kinematics->joint_count())
            problem("kinematics",
                    "its arm has " + std::to_string(group.kinematics->joint_count()) + " joints, and it has " +
                        std::to_string(group.members.size()) + " members",
                    "name one axis for each joint, from the base on");
        for (const auto& member : group.members) {
            if (std::find(known.begin(), known.end(), member) == known.end()) {
                const auto near = nearest_name(member, known);
                problem("unknown_axis", "there is no axis '" + member + "'",
                        near.empty() ? "name an axis of `axes`" : "did you mean '" + near + "'?");
            } else if (!taken.insert(member).second) {
                problem("axis_twice", "axis '" + member + "' is in this or another group already", "give each axis to one group, once");
            }
        }
        const double most = most_setup_velocity * group.millimetre;
        if (!(group.setup_velocity >= 0 && group.setup_velocity <= most * (1 + 1e-12)))
            problem(
                "setup_velocity",
                fmt::format(
                    "setup_velocity is {:g} {}/s, and in set-up mode the tool's point goes 250 mm/s at most (reduced speed, ISO 10218-1)",
                    group.setup_velocity, group.unit),
                fmt::format("give a velocity above 0 and up to {:g} {}/s; without it that holds", most, group.unit));
        for (const double value : {group.default_dynamics.velocity, group.default_dynamics.acceleration,
                                   group.default_dynamics.deceleration, group.default_dynamics.jerk})
            if (!std::isfinite(value) || value < 0) {
                problem("dynamics", "its default dynamics have a number that is negative or none",
                        "give values of 0 or more; 0 is what the axes' limits leave");
                break;
            }
    }
    return errors;
}

}  // namespace taktwerk::axes

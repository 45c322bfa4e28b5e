#include "axes/group/group_config.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "axes/group/workspace.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/pose_math.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::axes {
namespace {

/// Another room, kept free, in which all of this one lies: of rooms that are convex its corners say it. nullptr: none.
const WorkspaceRoom* covered_by(const WorkspaceRoom& room, const Workspace& space) {
    constexpr double endless = 1e12;
    for (const auto& other : space.rooms) {
        if (!other.kept_free) continue;
        const Workspace alone{{other}};
        bool inside = true;
        for (int corner = 0; corner < 8 && inside; ++corner) {
            const auto side = [&](int i) {
                return ((corner >> i) % 2 == 0 ? -1 : 1) * std::min(room.half[static_cast<std::size_t>(i)], endless);
            };
            inside = alone.clearance(composed(room.middle, Pose{.position = {side(0), side(1), side(2)}}).position) <= 0;
        }
        if (inside) return &other;
    }
    return nullptr;
}

}  // namespace

std::vector<Error> check(std::span<const AxisGroupConfig> groups, std::span<const std::string> axes) {
    std::vector<Error> errors;
    std::set<std::string> names;
    std::map<std::string, std::string> taken;  // by whom
    const std::vector<std::string> known(axes.begin(), axes.end());
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const auto& group = groups[i];
        const std::string subject = "axis_groups." + (group.name.empty() ? std::to_string(i) : group.name);
        const auto problem_in = [&](const std::string& place, std::string code, std::string what, std::string remedy) {
            errors.push_back({"group." + std::move(code), subject + place, std::move(what), std::move(remedy)});
        };
        const auto problem = [&](std::string code, std::string what, std::string remedy) {
            problem_in("", std::move(code), std::move(what), std::move(remedy));
        };
        if (group.name.empty()) problem("no_name", "the group has no name", "give it one: programs find it by that");
        else if (!names.insert(group.name).second)
            problem("name_twice", "another group is called '" + group.name + "'", "give each group a name of its own");
        else if (std::find(known.begin(), known.end(), group.name) != known.end())
            problem("name_twice", "an axis is called '" + group.name + "', too",
                    "give the group a name of its own: people command both by their names");
        if (group.members.size() > most_moved_members)
            problem_in(".members", "too_many_members",
                       "it has " + std::to_string(group.members.size()) + " members, and a path moves " +
                           std::to_string(most_moved_members) + " at most",
                       "divide it");
        if (group.kinematics && group.members.size() != group.kinematics->joint_count())
            problem_in(".members", "kinematics",
                       "its arm has " + std::to_string(group.kinematics->joint_count()) + " joints, and it has " +
                           std::to_string(group.members.size()) + fmt::format(" members ({})", fmt::join(group.members, ", ")),
                       "name one axis for each joint, from the base on");
        for (std::size_t k = 0; k < group.members.size(); ++k) {
            const auto& member = group.members[k];
            const std::string place = ".members." + std::to_string(k);
            if (std::find(known.begin(), known.end(), member) == known.end()) {
                const auto near = nearest_name(member, known);
                problem_in(place, "unknown_axis", "there is no axis '" + member + "'",
                           near.empty() ? "name an axis of `axes`" : "did you mean '" + near + "'?");
            } else if (const auto [owner, first] = taken.emplace(member, group.name); !first) {
                problem_in(place, "axis_twice", "axis '" + member + "' is a member of group '" + owner->second + "' already",
                           "give each axis to one group, once");
            }
        }
        if (group.workspace && !group.kinematics)
            problem("workspace", "it has a workspace and no arm whose tool could be in it",
                    "write its kinematics, or leave the workspace out");
        if (group.workspace)
            for (const auto& room : group.workspace->rooms) {
                const std::string place = ".workspace." + room.name;
                if (!std::all_of(room.half.begin(), room.half.end(), [](double half) { return half > 0; }))
                    problem_in(place, "workspace", "room '" + room.name + "' of its workspace has no extent",
                               "give a radius above 0, and of each interval a lower end below the upper one");
                else if (const auto* other = room.kept_free ? nullptr : covered_by(room, *group.workspace))
                    problem_in(place, "workspace",
                               "all of room '" + room.name + "' lies inside '" + other->name +
                                   "', which is kept free: the tool could be nowhere in it",
                               "compare their sides, or leave one of them out");
            }
        if (group.following.window == 0 && group.following.time > Duration{})
            problem_in(".following.window", "following", "its following error has a time and no window, and nobody would look at it",
                       "give the window: how far the tool may be from its path");
        if (!std::isfinite(group.following.window) || group.following.window < 0 || group.following.time < Duration{})
            problem_in(".following.window", "following", "the window of its following error is negative or none",
                       "give a distance above 0, or leave it out");
        const double most = most_setup_velocity * group.millimetre;
        if (!(group.setup_velocity >= 0 && group.setup_velocity <= most * (1 + 1e-12)))
            problem_in(
                ".setup_velocity", "setup_velocity",
                fmt::format(
                    "setup_velocity is {:g} {}/s, and in set-up mode the tool's point goes 250 mm/s at most (reduced speed, ISO 10218-1)",
                    group.setup_velocity, group.unit),
                fmt::format("give a velocity above 0 and up to {:g} {}/s; without it that holds", most, group.unit));
        for (const double value : {group.default_dynamics.velocity, group.default_dynamics.acceleration,
                                   group.default_dynamics.deceleration, group.default_dynamics.jerk})
            if (!std::isfinite(value) || value < 0) {
                problem_in(".default", "dynamics", "its default dynamics have a number that is negative or none",
                           "give values of 0 or more; 0 is what the axes' limits leave");
                break;
            }
    }
    return errors;
}

}  // namespace taktwerk::axes

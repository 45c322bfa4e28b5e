#pragma once
// One group as configured. Plain data, checked by check().

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "axes/group/group_equipment.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class Kinematics;
struct Workspace;

/// How far the tool's point (without an arm: the members, as one point) may be from its set-point, and for how long.
struct PathFollowing {
    double window = 0;  ///< u; 0: nobody looks
    Duration time{};    ///< beyond it for so long in one piece
};

struct AxisGroupConfig {
    std::string name;
    std::vector<std::string> members{};              ///< in the order of their identifiers 1, 2, ...; a program may add others
    std::shared_ptr<const Kinematics> kinematics{};  ///< its joints are the members, in their order; nullptr: ACS only
    GroupEquipment equipment{};                      ///< frames, tools, payloads at the beginning; its `arm` is filled by the group
    std::shared_ptr<const Workspace> workspace{};    ///< where the tool's point may be, in the machine (MCS); nullptr: anywhere
    PathFollowing following{};                       ///< else path_following_error, while the group moves
    double millimetre = 1;                           ///< in the unit of its paths: what stored paths are written in
    PathDynamics default_dynamics{};                 ///< 0 = what the axes' limits leave on a path
    std::string unit = "mm";                         ///< u of lengths and paths, for people
};

/// Every problem; `axes`: the names of the machine's axes. Codes: group.no_name, group.name_twice, group.too_many_members, group.unknown_axis,
/// group.axis_twice, group.dynamics, group.kinematics, group.workspace, group.following.
[[nodiscard]] std::vector<Error> check(std::span<const AxisGroupConfig> groups, std::span<const std::string> axes);

}  // namespace taktwerk::axes

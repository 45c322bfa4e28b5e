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
    double setup_velocity = 0;                       ///< u/s of the tool's point in set-up mode; 0 = most_setup_velocity
    std::string unit = "mm";                         ///< u of lengths and paths, for people
};

/// Reduced speed of ISO 10218-1, 5.6.2, in mm/s: what the tool's point goes in set-up mode at most. Taktwerk is not safety-rated: whatever has to
/// protect a person measures that speed by itself.
inline constexpr double most_setup_velocity = 250;
/// u/s
[[nodiscard]] inline double setup_velocity_of(const AxisGroupConfig& group) noexcept {
    return group.setup_velocity > 0 ? group.setup_velocity : most_setup_velocity * group.millimetre;
}

/// Every problem; `axes`: the names of the machine's axes. Codes: group.no_name, group.name_twice, group.too_many_members, group.unknown_axis,
/// group.axis_twice, group.dynamics, group.kinematics, group.workspace, group.following, group.setup_velocity.
[[nodiscard]] std::vector<Error> check(std::span<const AxisGroupConfig> groups, std::span<const std::string> axes);

}  // namespace taktwerk::axes

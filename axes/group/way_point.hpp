#pragma once
// Where the members are at a place of a path, with three derivatives by its length: what timing needs of a path, and what the cycle gives to the
// axes. Pure, real-time safe. For this room: it includes Eigen.

#include <array>
#include <cstdint>

#include "axes/group/group_equipment.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/path/path.hpp"
#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

/// One number a member, by its rank among them; those behind the last are 0. u of each axis.
using MemberVector = std::array<double, max_path_axes>;

/// A section of a path as the cycle goes it.
struct RunSection {
    PathSection section;
    bool through_arm = false;                         ///< its points are poses; else they are the members themselves
    CarriedTool carried{};                            ///< of whose point they are poses
    Configuration configuration;                      ///< which way of the arm holds along it
    std::uint32_t before = 0;                         ///< of a blend: the command that it comes from
    double way_before = 0;                            ///< length of that one's own element
    double corner = 0;                                ///< s at which its command ends, were it not blended
    double way = 0;                                   ///< length of its command's own element
    double rest = 0;                                  ///< what is left of that behind this section, where it is a blend
    MemberVector to{};                                ///< where its command ends, to the last bit
    CornerPassed corner_passed = CornerPassed::none;  ///< in front of its command
    std::uint32_t line = 0, number = 0;               ///< of a stored path: where in its text
    // Where an axis drives the path: u/s from which it can still be braked for what comes behind its end, in front of its beginning.
    double fastest_at_end = 0, fastest_at_begin = 0;
    double fastest = 0;  ///< u/s that may be had on it
};

struct WayPoint {
    MemberVector q{}, first{}, second{}, third{};
    Miss miss;
};

/// `near`: the members close by, by which turns and free joints are chosen. `orders`: derivatives that are wanted, 1 to 3; further ones may be 0.
[[nodiscard]] WayPoint way_point(const PathSection& section, const RunSection& at, double s, const Kinematics* arm, std::size_t members,
                                 const MemberVector& near, int orders = 3) noexcept;

[[nodiscard]] inline Joints joints_of(const MemberVector& members) noexcept {
    Joints joints{};
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = members[i];
    return joints;
}
[[nodiscard]] inline MemberVector members_of(const Joints& joints) noexcept {
    MemberVector members{};
    for (std::size_t i = 0; i < max_joints; ++i) members[i] = joints[i];
    return members;
}

}  // namespace taktwerk::axes

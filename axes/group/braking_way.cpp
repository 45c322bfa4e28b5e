#include "axes/group/braking_way.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/stop_ramp.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {
namespace {

/// By how much the tool may become faster while the arm's levers change.
constexpr double swing = 2;
constexpr double most_looks = 200;

/// As the axis does it that is let go by its group (Conduct::halt_on_own_account).
Plan ramp_of(const MotionState& from, const Axis& axis, double period) noexcept {
    const auto& limits = axis.config().limits;
    return plan_stop(from, in_each_direction(never_reversing(from, full_limits(limits), period), limits));
}

}  // namespace

bool brakes_inside(const std::array<MotionState, most_members>& from, const GroupMembers& members, double period,
                   const BrakingSpace& space) noexcept {
    std::array<Profile, max_joints> ramps;
    Joints at{};
    double time = 0;
    const std::size_t count = space.arm->joint_count();
    for (std::size_t i = 0; i < count; ++i) {
        at[i] = from[i].position;
        ramps[i] = Profile{{from[i].position, 0, 0}};
        if (!members.has(i) || (from[i].velocity == 0 && from[i].acceleration == 0)) continue;
        const auto plan = ramp_of(from[i], members.axis(i), period);
        if (plan.error != PlanError::none) return false;
        ramps[i] = plan.profile;
        time = std::max(time, plan.profile.duration());
    }
    const auto jacobian = space.arm->jacobian(at, space.tool);
    double fastest = 0;  // u of the tool in a cycle
    for (std::size_t i = 0; i < count; ++i)
        fastest += swing * period * ramps[i].max_speed() * jacobian.col(static_cast<Eigen::Index>(i)).head<3>().norm();
    const double cycles = std::ceil(time / period), stride = std::max(1.0, std::ceil(cycles / most_looks));
    for (double cycle = 0; cycle <= cycles;) {
        for (std::size_t i = 0; i < count; ++i) at[i] = ramps[i].at(cycle * period).position;
        const auto point = space.arm->forward(at, space.tool).pose.position;
        const double room = space.workspace->clearance(point) + wall_digits(point) - space.least;
        if (!(room >= 0)) return false;
        if (cycle == cycles) break;
        const double free = fastest > 0 ? std::floor(room / fastest) : cycles;
        cycle = std::min(cycles, cycle + std::max(stride, free));
    }
    return true;
}

}  // namespace taktwerk::axes

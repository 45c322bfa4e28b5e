#include "axes/group/way_point.hpp"

#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

std::array<double, 3> numbers(const Eigen::Vector3d& v) noexcept { return {v.x(), v.y(), v.z()}; }

void through(WayPoint& w, const PathSection& section, const RunSection& at, const PathPoint& point, const Kinematics& arm,
             const MemberVector& near, int orders) noexcept {
    const Pose& tool = at.carried.tool;
    const PosePoint pose = pose_point(point, section.chart);
    const AxisSolution stand = arm.inverse(pose_of(pose.position, pose.orientation), tool, at.configuration, joints_of(near));
    w.miss = stand.miss;
    if (!stand.ok()) return;
    PathDerivatives along;
    for (std::size_t k = 0; k < 3; ++k) {
        along.position[k] = numbers(pose.linear[k]);
        along.turn[k] = numbers(pose.angular[k]);
    }
    const AxisDerivatives d = arm.derivatives(stand.axes, tool, along, orders);
    w.q = members_of(stand.axes);
    w.first = members_of(d.of[0]);
    w.second = members_of(d.of[1]);
    w.third = members_of(d.of[2]);
    w.miss = d.miss;
}

}  // namespace

WayPoint way_point(const PathSection& section, const RunSection& at, double s, const Kinematics* arm, std::size_t members,
                   const MemberVector& near, int orders) noexcept {
    WayPoint w;
    const PathPoint point = section.at(s);
    if (at.through_arm) {
        through(w, section, at, point, *arm, near, orders);
        return w;
    }
    for (std::size_t i = 0; i < members; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        w.q[i] = point.at[k];
        w.first[i] = point.first[k];
        w.second[i] = point.second[k];
        w.third[i] = point.third[k];
    }
    return w;
}

}  // namespace taktwerk::axes

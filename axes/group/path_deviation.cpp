#include "axes/group/path_deviation.hpp"

#include <cmath>

#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {

double path_deviation(const GroupView& view, const GroupMembers& members, const Kinematics* arm, const Pose& tool) noexcept {
    double squares = 0;
    Joints told{};
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members.has(i)) continue;
        const double error = members.axis(i).view().following_error;
        squares += error * error;
        if (i < max_joints) told[i] = view.actual_position[i] + error;
    }
    if (arm == nullptr || !view.tool_known) return std::sqrt(squares);
    const auto should = arm->forward(told, tool);
    if (!should.miss.ok()) return std::sqrt(squares);
    const auto& p = should.pose.position;
    return std::hypot(p[0] - view.tool_actual[0], p[1] - view.tool_actual[1], p[2] - view.tool_actual[2]);
}

}  // namespace taktwerk::axes

#include "axes/group/motion_target.hpp"

#include <cmath>

namespace taktwerk::axes {

namespace {

constexpr std::size_t cartesian_axes = 3;  // of the identity

}  // namespace

ErrorId refuse_frame(MC_CoordSystem frame, GroupKinematics kinematics, const GroupMembers& members) noexcept {
    if (frame == mcACS) return ErrorId::none;
    if (frame > mcTCS) return ErrorId::invalid_parameter;
    if (kinematics == GroupKinematics::none) return ErrorId::no_kinematics;
    for (std::size_t i = cartesian_axes; i < most_members; ++i)
        if (members.has(i)) return ErrorId::no_kinematics;
    return frame == mcMCS ? ErrorId::none : ErrorId::not_supported;
}

JointVector target_of(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept {
    JointVector target = here;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i)) target[i] = is_relative(command.kind) ? here[i] + command.target[i] : command.target[i];
    return target;
}

ErrorId refuse_target(const GroupCommand& command, const JointVector& target, const GroupMembers& members) noexcept {
    if (command.frame != mcACS)
        for (std::size_t i = cartesian_axes; i < 2 * cartesian_axes; ++i)  // the identity turns nothing
            if (command.target[i] != 0) return ErrorId::invalid_position;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members.has(i)) continue;
        if (!std::isfinite(command.target[i]) || !std::isfinite(target[i])) return ErrorId::invalid_position;
        const auto& config = members.axis(i).config();
        const bool homed = members.axis(i).view().homed;
        if (!is_relative(command.kind) && config.require_homed && !homed) return ErrorId::not_homed;
        if (homed && (target[i] > config.limits.position_max || target[i] < config.limits.position_min))
            return ErrorId::beyond_software_limit;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes

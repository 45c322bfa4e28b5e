#include "axes/group/written_pose.hpp"

#include "axes/pose_angles.hpp"

namespace taktwerk::axes {

Pose pose_of_numbers(const SixNumbers& six) noexcept {
    return pose_of(Eigen::Vector3d(six[0], six[1], six[2]), orientation_from({six[5], six[4], six[3]}, AngleOrder::z_y_x));
}

Pose pose_of_six(const JointVector& six) noexcept { return pose_of_numbers({six[0], six[1], six[2], six[3], six[4], six[5]}); }

Pose pose_of_turns(const std::array<double, 3>& place, const std::array<double, 3>& turns) noexcept {
    return pose_of_numbers({place[0], place[1], place[2], turns[0], turns[1], turns[2]});
}

SixNumbers numbers_of(const Pose& pose) noexcept {
    const auto angles = angles_of(orientation_of(pose), AngleOrder::z_y_x);
    return {pose.position[0], pose.position[1], pose.position[2], angles[2], angles[1], angles[0]};
}

Pose seen_through(const Pose& outer, const Pose& inner) noexcept { return composed(outer, inner); }

Pose seen_from(const Pose& outer, const Pose& both_seen_from) noexcept { return composed(inverted(outer), both_seen_from); }

}  // namespace taktwerk::axes

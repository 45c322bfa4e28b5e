#pragma once
// Poses as people write them: X Y Z in the unit of length, RX RY RZ in rad. Turned about Z by RZ, then about the new Y by RY, then about the new X by
// RX (G-078, docs/motion/group-decisions.md). Without Eigen for who includes this. Pure, real-time safe.

#include <array>

#include "axes/group/group_types.hpp"
#include "axes/pose.hpp"

namespace taktwerk::axes {

[[nodiscard]] Pose pose_of_numbers(const SixNumbers& six) noexcept;
/// Of a command's target.
[[nodiscard]] Pose pose_of_six(const JointVector& six) noexcept;
[[nodiscard]] Pose pose_of_turns(const std::array<double, 3>& place, const std::array<double, 3>& turns) noexcept;

/// RX and RZ in [-pi, pi], RY in [-pi/2, pi/2]. With RY at a right angle the other two turn about one axis: RZ is 0 then.
[[nodiscard]] SixNumbers numbers_of(const Pose& pose) noexcept;

/// `inner`, which is seen from `outer`, seen from where `outer` is; and the way back.
[[nodiscard]] Pose seen_through(const Pose& outer, const Pose& inner) noexcept;
[[nodiscard]] Pose seen_from(const Pose& outer, const Pose& both_seen_from) noexcept;

}  // namespace taktwerk::axes

// Poses: composition, inversion, and three angles in each order, at and beside their singularities too.

#include <gtest/gtest.h>

#include "axes/pose_angles.hpp"
#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/random_stands.hpp"

namespace taktwerk::axes {
namespace {

static_assert(std::is_trivially_copyable_v<Pose>);

// A quarter turn about z and 1 along the new x is 1 along y; back again is nothing.
TEST(PoseArithmetic, ComposesAndInverts) {
    const Pose turned = composed(posed(0, 0, 2, right, 0, 0), posed(1, 0, 0, 0, 0, 0));
    EXPECT_LT((position_of(turned) - Eigen::Vector3d(0, 1, 2)).norm(), 1e-15);
    const PoseDifference nothing = difference(composed(turned, inverted(turned)), {});
    EXPECT_LT(nothing.position + nothing.angle, 1e-15);
}

// By hand: z by 90 degrees, then the new x by 90: x goes to y, y to z, z to x.
TEST(PoseAngles, TurnInTheirOrder) {
    const Eigen::Quaterniond zyx = orientation_from({right, 0, right}, AngleOrder::z_y_x);
    EXPECT_LT((zyx * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
    EXPECT_LT((zyx * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
    // x by 90, then the new z (which points to -y) by 90: x goes to where y went, z.
    const Eigen::Quaterniond xyz = orientation_from({right, 0, right}, AngleOrder::x_y_z);
    EXPECT_LT((xyz * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
    // z, the new y, the new z: the last does not move the tool's direction.
    const Eigen::Quaterniond zyz = orientation_from({right, right, .7}, AngleOrder::z_y_z);
    EXPECT_LT((zyz * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(PoseAngles, ComeBackAsTheSameOrientation) {
    RandomStands random{41};
    for (const AngleOrder order : {AngleOrder::z_y_x, AngleOrder::x_y_z, AngleOrder::z_y_z})
        for (int i = 0; i < 5000; ++i) {
            std::array<double, 3> angles{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
            if (random.one_of(2) == 0) angles[1] = right * (random.one_of(5) - 2) + random.tiny();
            const Eigen::Quaterniond there = orientation_from(angles, order);
            const std::array<double, 3> told = angles_of(there, order);
            ASSERT_LT(difference(pose_of({0, 0, 0}, there), pose_of({0, 0, 0}, orientation_from(told, order))).angle, 1e-11);
            if (order == AngleOrder::z_y_z) {
                ASSERT_GE(told[1], 0);
            } else {
                ASSERT_LE(std::abs(told[1]), right + 1e-12);
            }
        }
    EXPECT_EQ(angles_of(orientation_from({.3, right, .2}, AngleOrder::z_y_x), AngleOrder::z_y_x)[0], 0);
}

}  // namespace
}  // namespace taktwerk::axes

// Poses that can be read off the makers' drawings, or worked out by hand.

#include <gtest/gtest.h>

#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {
namespace {

void expect_pose(const PublishedArm& arm, const Joints& axes, const Pose& expected) {
    SCOPED_TRACE(arm.name);
    const Kinematics kinematics = made(arm);
    const ForwardResult there = kinematics.forward(axes, {});
    ASSERT_TRUE(there.miss.ok());
    const PoseDifference d = difference(there.pose, expected);
    EXPECT_LT(d.position, 1e-12) << ::testing::PrintToString(there.pose.position);
    EXPECT_LT(d.angle, 1e-12) << ::testing::PrintToString(there.pose.orientation);
}

// Forearm level, flange to the front: lengths add up.
TEST(KnownPoses, ArmsOfAbbAtZero) {
    expect_pose(irb_120(), {}, posed(.302 + .072, 0, .290 + .270 + .070, 0, right, 0));
    expect_pose(irb_140(), {}, posed(.070 + .380 + .065, 0, .352 + .360, 0, right, 0));
    expect_pose(irb_2400(), {}, posed(.100 + .755 + .085, 0, .615 + .705 + .135, 0, right, 0));
}

// Axis 1 turns everything about z; axis 5 alone tips the flange down.
TEST(KnownPoses, Irb120TurnsAndTips) {
    expect_pose(irb_120(), degrees({90, 0, 0, 0, 0, 0}), posed(0, .374, .630, right, right, 0));
    expect_pose(irb_120(), degrees({0, 0, 0, 0, 90, 0}), posed(.302, 0, .630 - .072, 0, 2 * right, 0));
    expect_pose(irb_120(), degrees({0, 0, -90, 0, 0, 0}), posed(-.070, 0, .290 + .270 + .302 + .072, 0, 0, 0));
}

// KUKA's zero lies level; its home stands with the forearm level (A2 = -90, A3 = 90). Axis 1 counts clockwise from above.
TEST(KnownPoses, Kr6AtZeroAndHome) {
    expect_pose(kr6_r900(), {}, posed(.025 + .455 + .420 + .080, 0, .400 + .035, 0, right, 0));
    expect_pose(kr6_r900(), degrees({0, -90, 90, 0, 0, 0}), posed(.025 + .420 + .080, 0, .400 + .455 + .035, 0, right, 0));
    expect_pose(kr6_r900(), degrees({90, -90, 90, 0, 0, 0}), posed(0, -(.025 + .420 + .080), .400 + .455 + .035, -right, right, 0));
    // Axis 6 clockwise about the flange's own z, which points to the front.
    expect_pose(kr6_r900(), degrees({0, -90, 90, 0, 0, 90}), composed(posed(.525, 0, .890, 0, right, 0), posed(0, 0, 0, -right, 0, 0)));
}

TEST(KnownPoses, Tx40StandsUpBesideItsAxis) {
    expect_pose(tx40(), {}, posed(0, .035, .320 + .225 + .225 + .065, 0, 0, 0));
    expect_pose(tx40(), degrees({0, 90, 0, 0, 0, 0}), posed(.225 + .225 + .065, .035, .320, 0, right, 0));
}

// Universal Robots' own picture of the zero pose: stretched to -x, flange to -y.
TEST(KnownPoses, Ur5eAtZeroAndUp) {
    expect_pose(ur5e(), {}, posed(-.425 - .3922, -.1333 - .0996, .1625 - .0997, 0, 0, right));
    // Upright: axis 2 at -90, axis 4 at -90.
    expect_pose(ur5e(), degrees({0, -90, 0, -90, 0, 0}),
                composed(posed(0, -.1333 - .0996, .1625 + .425 + .3922 + .0997, 0, 0, right), posed(0, 0, 0, -2 * right, 0, 0)));
}

// Worked out row by row: the upper arm up, the forearm to the front, the flange beside it. J3 does not change when J2 moves alone, and the
// forearm stays level then.
TEST(KnownPoses, Crx10AtZeroAndWithJ2Alone) {
    const Kinematics crx = made(crx_10ia());
    EXPECT_LT((position_of(crx.forward({}, {}).pose) - Eigen::Vector3d(.540 + .160, -.150, .540)).norm(), 1e-12);
    EXPECT_LT((position_of(crx.forward(degrees({0, 90, 0, 0, 0, 0}), {}).pose) - Eigen::Vector3d(.540 + .540 + .160, -.150, 0)).norm(),
              1e-12);
}

TEST(KnownPoses, ScaraBentToTheLeft) {
    expect_pose(epson_g10(), degrees({0, 90, 0, 0, 0, 0}), posed(.250, .400, 0, right, 0, 0));
    expect_pose(epson_g10(), {90 * degree, -90 * degree, -.1, 30 * degree, 0, 0}, posed(.400, .250, -.1, 30 * degree, 0, 0));
}

// Counted to the right, from where the elbow is bent by 90 degrees to the left: at 90 the arm is stretched, at 180 it is bent to the right.
TEST(KnownPoses, AJointThatIsCountedBackwardsFromItsOwnZero) {
    PublishedArm arm = epson_g10();
    arm.description.joints[1].sign = -1;
    arm.description.joints[1].zero = right;
    expect_pose(arm, {}, posed(.250, .400, 0, right, 0, 0));
    expect_pose(arm, degrees({0, 90, 0, 0, 0, 0}), posed(.650, 0, 0, 0, 0, 0));
    expect_pose(arm, degrees({0, 180, 0, 0, 0, 0}), posed(.250, -.400, 0, -right, 0, 0));

    const Kinematics kinematics = made(arm);
    const Joints near = degrees({10, 170, 0, 0, 0, 0});
    const AxisSolution back = kinematics.inverse(posed(.250, -.400, 0, -right, 0, 0), {}, kinematics.configuration(near), near);
    ASSERT_TRUE(back.ok());
    EXPECT_NEAR(back.axes[0], 0, 1e-12);
    EXPECT_NEAR(back.axes[1], 180 * degree, 1e-12);
}

// At 0 as drawn; leaning forward by 90 degrees the upper arm lies level, and the forearm stays level too: its motor keeps its angle to the horizon.
TEST(KnownPoses, PalletizerKeepsItsFlangeLevel) {
    expect_pose(irb_460(), {}, posed(.260 + 1.025 + .225, 0, .745 + .945 - .2515, 0, 0, 0));
    expect_pose(irb_460(), degrees({0, 90, 0, 0, 0, 0}), posed(.260 + .945 + 1.025 + .225, 0, .745 - .2515, 0, 0, 0));
    expect_pose(irb_460(), degrees({90, 0, 90, -30, 0, 0}), posed(0, .260 + .225, .745 + .945 - 1.025 - .2515, 60 * degree, 0, 0));
}

// All arms level: the rods span from 502.5 mm, so they hang by sqrt(0.8^2 - 0.5025^2) = 0.62249 m. Straight down: 148 mm, 354.5 mm lower.
TEST(KnownPoses, FlexpickerHangsBelowItsMiddle) {
    expect_pose(flexpicker(), {}, posed(0, 0, -std::sqrt(.800 * .800 - .5025 * .5025), 0, 0, 0));
    expect_pose(flexpicker(), degrees({90, 90, 90, 45, 0, 0}),
                posed(0, 0, -.3545 - std::sqrt(.800 * .800 - .148 * .148), 45 * degree, 0, 0));
}

// 3-4-5: with the platform below the first tower by 0.269 its own rod hangs straight down.
TEST(KnownPoses, LinearDeltaBelowItsMiddleAndBelowATower) {
    const double middle = std::sqrt(.269 * .269 - .1285 * .1285);
    expect_pose(linear_delta(), {.5, .5, .5, 0, 0, 0}, posed(0, 0, .5 - middle, 0, 0, 0));
    const double across = std::sqrt(.269 * .269 - 3 * .1285 * .1285);  // the other two towers are sqrt(3) radii away
    const Pose below{{.1285 * std::cos(210 * degree), .1285 * std::sin(210 * degree), .1}, {1, 0, 0, 0}};
    const AxisSolution way = made(linear_delta()).inverse(below, {}, {}, {});
    ASSERT_TRUE(way.ok());
    EXPECT_NEAR(way.axes[0], .1 + .269, 1e-12);
    EXPECT_NEAR(way.axes[1], .1 + across, 1e-12);
    EXPECT_NEAR(way.axes[2], .1 + across, 1e-12);
}

// CoreXY: the first motor turns by x + y, the second by x - y (K-09).
TEST(KnownPoses, CoreXyBeltsAddAndSubtract) {
    const AxisSolution way = made(core_xy()).inverse(posed(.3, .1, .2, 0, 0, 0), {}, {}, {});
    ASSERT_TRUE(way.ok());
    EXPECT_NEAR(way.axes[0], .4, 1e-15);
    EXPECT_NEAR(way.axes[1], .2, 1e-15);
    EXPECT_NEAR(way.axes[2], .2, 1e-15);
}

// 3-4-5: the second guide is ahead by 1.8 on a span of 2.4, so the beam is 3.0 long between them and leans towards +X by asin(0.6).
TEST(KnownPoses, SkewedGantryTurnsItsTool) {
    const Kinematics gantry = made(beam_gantry());
    const Joints skewed{1, 2.8, .5, -.2, 0, 0};
    const PoseDifference d = difference(gantry.forward(skewed, {}).pose, posed(1 + .5 * .6, .5 * .8, -.2, -std::asin(.6), 0, 0));
    EXPECT_LT(d.position, 1e-12);
    EXPECT_LT(d.angle, 1e-12);
    EXPECT_NEAR(gantry.skew(skewed), 1.8, 1e-12);
    EXPECT_EQ(gantry.skew({1, 1, .5, 0, 0, 0}), 0);
}

// A tool of 100 mm along the flange's z, and a base that hangs from the ceiling at 2 m.
TEST(KnownPoses, ToolAndBase) {
    PublishedArm arm = irb_120();
    arm.description.base = posed(1, 0, 2, 0, 0, 2 * right);
    const Kinematics hanging = made(arm);
    const Pose there = hanging.forward({}, posed(0, 0, .1, 0, 0, 0)).pose;
    EXPECT_LT((position_of(there) - Eigen::Vector3d(1 + .474, 0, 2 - .630)).norm(), 1e-12);
}

// Behind joint 6 a deviation is a tool of its own: shifted, then turned about x, the new y, the new z.
TEST(KnownPoses, DeviationsShiftAndTurn) {
    PublishedArm arm = irb_120();
    auto& deviations = std::get<SixJoints>(arm.description.arm).deviations;
    deviations[5] = {{.001, .002, .003}, {.2, .3, .4}};
    const Pose turned = composed(posed(.001, .002, .003, 0, 0, .2), composed(posed(0, 0, 0, 0, .3, 0), posed(0, 0, 0, .4, 0, 0)));
    expect_pose(arm, {}, composed(posed(.374, 0, .630, 0, right, 0), turned));
}

}  // namespace
}  // namespace taktwerk::axes

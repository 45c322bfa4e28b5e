// Each singularity has its name and its measure, from hand calculations.

#include <gtest/gtest.h>

#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {
namespace {

void expect_singularity(const PublishedArm& arm, const Joints& axes, SingularityKind kind, double measure, double tolerance = 1e-12) {
    SCOPED_TRACE(arm.name);
    const Singularity s = made(arm).singularity(axes);
    EXPECT_EQ(s.kind, kind);
    EXPECT_NEAR(s.measure, measure, tolerance);
}

TEST(SingularityMeasure, WristElbowAndShoulderOfASixJointArm) {
    expect_singularity(irb_140(), degrees({10, 20, -30, 40, 0, 60}), SingularityKind::wrist, 0);
    expect_singularity(irb_140(), degrees({10, 20, -30, 40, 180, 60}), SingularityKind::wrist, 0);
    expect_singularity(irb_140(), degrees({10, 20, -30, 40, 1, 60}), SingularityKind::wrist, std::sin(1 * degree));
    // Stretched: joint 3 at -90 puts the forearm into the upper arm's line.
    expect_singularity(irb_140(), degrees({10, 20, -90, 40, 50, 60}), SingularityKind::elbow, 0);
    expect_singularity(irb_140(), degrees({10, 20, -89, 40, 50, 60}), SingularityKind::elbow, std::sin(1 * degree));
    // The wrist's centre on axis 1: 70 + 360 sin(q2) + 380 cos(q2 + q3) = 0, here with q2 + q3 = 90: sin(q2) = -70/360.
    const double lean = std::asin(-70. / 360);
    expect_singularity(irb_140(), {.1, lean, 90 * degree - lean, .4, .9, .6}, SingularityKind::shoulder, 0);
    // 10 mm in front of it, of a reach of 740 mm.
    const double less = std::asin(-60. / 360);
    expect_singularity(irb_140(), {.1, less, 90 * degree - less, .4, .9, .6}, SingularityKind::shoulder, .010 / .740);
}

// Forearm and its offset: the elbow is straight where axis 3, wrist and axis 2 are in one line, at -90 + atan(70 / 302) degrees.
TEST(SingularityMeasure, ElbowOfABentForearm) {
    expect_singularity(irb_120(), {.1, .2, -90 * degree + std::atan2(.070, .302), .4, .9, .6}, SingularityKind::elbow, 0);
}

TEST(SingularityMeasure, ThreeParallelAxes) {
    expect_singularity(ur5e(), degrees({10, -60, 70, -50, 0, 60}), SingularityKind::wrist, 0);
    expect_singularity(ur5e(), degrees({10, -60, 0, -50, 70, 60}), SingularityKind::elbow, 0);
    // Upright, axis 4 turned so that the hand's link hangs along axis 1: where axes 5 and 6 meet is beside axis 1, in its line.
    expect_singularity(ur5e(), degrees({10, -60, 120, -150, 70, 60}), SingularityKind::shoulder,
                       std::abs(-.425 * .5 - .3922 * .5 + .0997 * std::sin(-90 * degree)) / (.425 + .3922), 1e-9);
}

TEST(SingularityMeasure, ScaraAndPalletizer) {
    expect_singularity(epson_g10(), degrees({30, 0, 0, 0, 0, 0}), SingularityKind::elbow, 0);
    expect_singularity(epson_g10(), {.5, 150 * degree, -.1, 0, 0, 0}, SingularityKind::elbow, .5);
    // Links in one line: the forearm down as far as the upper arm leans to the back.
    expect_singularity(irb_460(), degrees({0, 60, -30, 0, 0, 0}), SingularityKind::elbow, 0);
    // The flange over axis 1: 260 + 225 + 945 sin(q2) + 1025 cos(q3) = 0 with q3 = 90: sin(q2) = -485/945.
    expect_singularity(irb_460(), {0, std::asin(-485. / 945), 90 * degree, 0, 0, 0}, SingularityKind::shoulder, 0);
}

// Inner: an upper arm in line with its rod. Outer: rods in one plane.
TEST(SingularityMeasure, Deltas) {
    const double out = .200 - .052;
    // All alike, the rod from (148 + 354.5 cos q) inwards to 0: in line with the upper arm where 148 = -(354.5 + 800) cos q.
    const double q = std::acos(-out / (.3545 + .8));
    expect_singularity(flexpicker(), {q, q, q, 0, 0, 0}, SingularityKind::inner, 0, 1e-7);
    // Rods as flat as they get: 502.5 mm out with rods of 800 mm; of a level platform the rods' volume is 3 sqrt(3) / 2 * (r/l)^2 * sqrt(1 - (r/l)^2).
    const double r = .5025 / .800, upright = std::sqrt(1 - r * r);
    const Singularity level = made(flexpicker()).singularity({});
    EXPECT_NEAR(level.measure, std::min(upright, 1.5 * std::sqrt(3.0) * r * r * upright), 1e-12);
    // Linear: the platform out to where the first rod lies almost level.
    const Kinematics linear = made(linear_delta());
    const double away = .1285 - .2689;  // from the first tower 268.9 mm
    const Pose there{{away * std::cos(210 * degree), away * std::sin(210 * degree), 0}, {1, 0, 0, 0}};
    const Singularity flat = linear.singularity(linear.inverse(there, {}, {}, {}).axes);
    EXPECT_EQ(flat.kind, SingularityKind::inner);
    EXPECT_NEAR(flat.measure, std::sqrt(.269 * .269 - .2689 * .2689) / .269, 1e-9);
}

// What has no closed form is judged by its Jacobian: far away in a usual stand, near 0 where the nominal arm is singular.
TEST(SingularityMeasure, NumericArms) {
    const Singularity usual = made(calibrated(irb_120())).singularity(degrees({10, 20, 30, 40, 50, 60}));
    EXPECT_EQ(usual.kind, SingularityKind::numeric);
    EXPECT_GT(usual.measure, .02);
    EXPECT_LT(made(calibrated(irb_120())).singularity(degrees({10, 20, 30, 40, 0, 60})).measure, .01);
}

TEST(SingularityMeasure, StraightArmsHaveNone) {
    for (const PublishedArm& arm : {cartesian(), core_xy(), beam_gantry()}) expect_singularity(arm, {}, SingularityKind::none, 1);
}

}  // namespace
}  // namespace taktwerk::axes

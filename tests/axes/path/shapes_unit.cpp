// Arcs as commands give them, splines, transitions by velocity. G-037, G-038, G-039, G-053, G-054.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "axes/path/arc.hpp"
#include "axes/path/spline.hpp"
#include "axes/path/transition.hpp"
#include "tests/axes/path/points.hpp"

namespace taktwerk::axes {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

TEST(Arc, OverABorderPointPassesItExactly) {
    const auto arc = arc_over_border(at(10, 0), Vector3d(0, 10, 0), at(-10, 0));
    ASSERT_TRUE(arc.ok());

    EXPECT_NEAR(arc->length(), 10 * pi, 1e-12);
    EXPECT_LT((arc->at(5 * pi).at - at(0, 10)).norm(), 1e-13);
    EXPECT_LT((arc->at(arc->length()).at - at(-10, 0)).norm(), 1e-13);

    // Over the far side it is the other three quarters.
    const auto large = arc_over_border(at(10, 0), Vector3d(-10, 0, 0), at(0, 10));
    EXPECT_NEAR(large->length(), 15 * pi, 1e-12);
    EXPECT_LT((large->at(large->length()).at - at(0, 10)).norm(), 1e-13);
}

TEST(Arc, PointsOnALineAreRefused) {
    EXPECT_EQ(arc_over_border(at(0, 0), Vector3d(1, 1, 0), at(2, 2)).error().code, "path.arc_points");
    EXPECT_EQ(arc_over_border(at(0, 0), Vector3d(1, 1, 0), at(0, 0)).error().code, "path.arc_points");
    EXPECT_EQ(arc_over_border(at(0, 0), Vector3d(1, 1, 0), at(1, 1)).error().code, "path.arc_points");
}

TEST(Arc, AboutACentreInBothSenses) {
    const auto left = arc_about_centre(at(10, 0), Vector3d::Zero(), at(0, 10), Vector3d::UnitZ(), ArcSense::counter_clockwise, 0);
    const auto right = arc_about_centre(at(10, 0), Vector3d::Zero(), at(0, 10), Vector3d::UnitZ(), ArcSense::clockwise, 0);

    EXPECT_NEAR(left->length(), 5 * pi, 1e-12);
    EXPECT_NEAR(right->length(), 15 * pi, 1e-12);
    EXPECT_LT((right->at(5 * pi).at - at(0, -10)).norm(), 1e-13);
    EXPECT_LT((right->at(15 * pi).at - at(0, 10)).norm(), 1e-12);
}

TEST(Arc, FullCircleNeedsAPlane) {
    EXPECT_NEAR(arc_about_centre(at(10, 0), Vector3d::Zero(), at(10, 0), Vector3d::UnitZ(), ArcSense::clockwise, 0)->length(), 20 * pi,
                1e-12);
    EXPECT_EQ(arc_about_centre(at(10, 0), Vector3d::Zero(), at(10, 0), Vector3d::Zero(), ArcSense::clockwise, 0).error().code,
              "path.arc_plane");
    EXPECT_EQ(arc_about_centre(at(10, 0), Vector3d::Zero(), at(-10, 0), Vector3d::Zero(), ArcSense::clockwise, 0).error().code,
              "path.arc_plane");
    EXPECT_EQ(arc_about_centre(at(10, 0), Vector3d::Zero(), at(0, 10), Vector3d::UnitX(), ArcSense::clockwise, 0).error().code,
              "path.arc_plane");
}

// Three decimals in a program: the radii differ by less than the tolerance; the arc still begins and ends where it was told, without a step.
TEST(Arc, DifferingRadiiAreReconciledWithinTheTolerance) {
    const auto arc = arc_about_centre(at(10.004, 0), Vector3d::Zero(), at(0, 10), Vector3d::UnitZ(), ArcSense::counter_clockwise, 0.005);
    ASSERT_TRUE(arc.ok());

    EXPECT_LT((arc->at(0).at - at(10.004, 0)).norm(), 1e-13);
    EXPECT_LT((arc->at(arc->length()).at - at(0, 10)).norm(), 1e-12);
    EXPECT_EQ(
        arc_about_centre(at(10.004, 0), Vector3d::Zero(), at(0, 10), Vector3d::UnitZ(), ArcSense::counter_clockwise, 0.003).error().code,
        "path.arc_radii");
}

TEST(Arc, OfRadius) {
    const auto arc = arc_of_radius(at(0, 0), at(10, 0), Vector3d(0, 0, 10), ArcSense::clockwise);
    ASSERT_TRUE(arc.ok());

    EXPECT_NEAR(arc->length(), 10 * pi / 3, 1e-12);  // a sixth of the circle
    EXPECT_GT(arc->at(arc->length() / 2).at[1], 1);  // clockwise from left to right: over the top
    EXPECT_LT((arc->at(arc->length()).at - at(10, 0)).norm(), 1e-12);
    EXPECT_EQ(arc_of_radius(at(0, 0), at(10, 0), Vector3d(0, 0, 4.9), ArcSense::clockwise).error().code, "path.arc_radius");
    EXPECT_EQ(arc_of_radius(at(0, 0), at(10, 0), Vector3d(10, 0, 0), ArcSense::clockwise).error().code, "path.arc_plane");
}

TEST(Spline, PassesItsPointsWithoutAJumpOfCurvature) {
    const std::vector<PathVector> points{at(0, 0), at(10, 5), at(15, -3, 4), at(30, 0), at(31, 8)};
    const auto spline = spline_through(points);
    ASSERT_TRUE(spline.ok());
    ASSERT_EQ(spline->size(), 4u);

    for (std::size_t i = 0; i < 4; ++i) {
        const PathElement& e = (*spline)[i];
        EXPECT_LT((e.at(0).at - points[i]).norm(), 1e-12);
        EXPECT_LT((e.at(e.length()).at - points[i + 1]).norm(), 1e-12);
        if (i == 0) continue;
        EXPECT_TRUE(meet_smoothly((*spline)[i - 1], e)) << i;
    }
    EXPECT_EQ(spline_through(std::vector<PathVector>{at(0, 0)}).error().code, "path.spline_points");
    EXPECT_EQ(spline_through(std::vector<PathVector>{at(0, 0), at(1, 1), at(1, 1)}).error().code, "path.spline_points");
}

// v = 100, a = 1000, j = 20000: v^2/2a + v a/2j = 5 + 2.5; half the factor, half the way.
TEST(Transition, StartVelocityIsTheWayOfBraking) {
    const PathFeed feed{100, 1000, 1000, 20000};

    EXPECT_DOUBLE_EQ(start_velocity_transition(1, feed, feed).parameter, 7.5);
    EXPECT_DOUBLE_EQ(start_velocity_transition(0.5, feed, feed).parameter, 3.75);
    // Too slow to reach 1000 u/s2: 20 u/s at 20000 u/s3 take 20 sqrt(20/20000).
    EXPECT_NEAR(start_velocity_transition(1, {20, 1000, 1000, 20000}, feed).parameter, 20 * std::sqrt(0.001), 1e-12);
}

TEST(Transition, ConstantVelocityCurveCarriesItsCentripetalAcceleration) {
    const PathFeed feed{100, 1000, 1000, 20000};
    const BlendRequest request = constant_velocity_transition(0.8, feed, feed, at(1, 0), at(0, 1));

    const auto curve = blend(PathElement::line(at(-500, 0), at(0, 0)), PathElement::line(at(0, 0), at(0, 500)), request, 250, 250);

    ASSERT_TRUE(curve);
    double curvature = 0;
    for (int i = 0; i <= 1000; ++i) curvature = std::max(curvature, curve->curve.at(curve->curve.length() * i / 1000).second.norm());
    EXPECT_NEAR(80 * 80 * curvature, 1000, 1);
}

// Joints: one straight line of all of them, every joint under way from the same beginning to the same end. G-041.
TEST(DirectMove, AllJointsTogether) {
    PathVector from = PathVector::Zero(), to = PathVector::Zero();
    from.head<6>() << 0, 10, 20, -30, 0, 5;
    to.head<6>() << 90, -20, 20, 30, 45, 5;
    const PathElement joints = PathElement::line(from, to);

    for (double share : {0.25, 0.5, 1.0}) EXPECT_LT((joints.at(share * joints.length()).at - (from + share * (to - from))).norm(), 1e-12);
}

}  // namespace
}  // namespace taktwerk::axes

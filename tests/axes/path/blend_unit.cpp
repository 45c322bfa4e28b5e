// Curves at corners: where they leave and join, how far they pass, how smoothly. G-051, G-052, G-055, G-057, G-060.

#include "axes/path/blend.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/axes/path/points.hpp"

namespace taktwerk::axes {
namespace {

const PathElement along_x = PathElement::line(at(-100, 0), at(0, 0));
const PathElement along_y = PathElement::line(at(0, 0), at(0, 80));

void expect_smooth(const PathPoint& a, const PathPoint& b) {
    EXPECT_LT((a.at - b.at).norm(), 1e-11);
    EXPECT_LT((a.first - b.first).norm(), 1e-12);
    EXPECT_LT((a.second - b.second).norm(), 1e-10);
}

TEST(Blend, CornerDistanceLeavesAndJoinsThere) {
    const auto b = blend(along_x, along_y, {BlendRule::corner_distance, 10}, 50, 40);

    ASSERT_TRUE(b);
    EXPECT_EQ(b->before, 10);
    EXPECT_EQ(b->behind, 10);
    expect_smooth(along_x.at(90), b->curve.at(0));
    expect_smooth(b->curve.at(b->curve.length()), along_y.at(10));
}

TEST(Blend, CornerDeviationIsExact) {
    for (double angle : {0.05, 0.5, 1.5, 2.5, 2.75}) {
        const PathElement second = PathElement::line(at(0, 0), at(100 * std::cos(angle), 100 * std::sin(angle)));

        const auto b = blend(along_x, second, {BlendRule::corner_deviation, 0.2}, 50, 50);

        ASSERT_TRUE(b) << angle;
        double nearest = 1e9;
        for (int i = 0; i <= 2000; ++i) nearest = std::min(nearest, b->curve.at(b->curve.length() * i / 2000).at.norm());
        // A flat corner has no room for it: there the whole half is taken.
        if (b->before < 50) EXPECT_NEAR(nearest, 0.2, 1e-6) << angle;
        else EXPECT_LT(nearest, 0.2);
    }
}

TEST(Blend, ALargerRequestIsCutToTheRoom) {
    const auto b = blend(along_x, along_y, {BlendRule::corner_distance, 70}, 50, 40);

    ASSERT_TRUE(b);
    EXPECT_EQ(b->before, 40);
}

TEST(Blend, StaysInThePlaneOfBothMoves) {
    const auto b = blend(along_x, along_y, {BlendRule::corner_distance, 10}, 50, 40);

    for (int i = 0; i <= 100; ++i) EXPECT_EQ(b->curve.at(b->curve.length() * i / 100).at[2], 0);
}

TEST(Blend, ArcMeetsLineWithItsCurvature) {
    const PathElement arc = PathElement::arc(at(0, 50), at(0, -50), at(50, 0), at(0, 0), 1.5);

    const auto b = blend(PathElement::line(at(-100, 30), at(0, 0)), arc, {BlendRule::corner_deviation, 0.5}, 50, arc.length() / 2);

    ASSERT_TRUE(b);
    EXPECT_LE(b->deviation, 0.5 * (1 + 1e-9));
    expect_smooth(b->curve.at(b->curve.length()), arc.at(b->behind));
}

// Towards an arc that bends away from the corner and towards one that bends on: what a line would need is too long or too short, and is corrected.
TEST(Blend, DeviationHoldsBesideArcsOfBothSenses) {
    for (const double sense : {1.0, -1.0})
        for (const double wanted : {0.1, 0.3, 1.0})
            for (const double slope : {0.3, 1.0, 3.0}) {
                const PathElement arc = PathElement::arc(at(0, sense * 50), at(0, -sense * 50), at(50, 0), at(0, 0), 1.5);

                const auto b = blend(PathElement::line(at(-100, 100 * slope), at(0, 0)), arc, {BlendRule::corner_deviation, wanted}, 50,
                                     arc.length() / 2);

                ASSERT_TRUE(b) << sense << ' ' << wanted << ' ' << slope;
                EXPECT_LE(b->deviation, wanted * (1 + 1e-9)) << sense << ' ' << wanted << ' ' << slope;
            }
}

// 160 degrees are the sharpest corner that is passed on a curve (docs/motion/path.md).
TEST(Blend, ACornerNearAReversalHasNoCurve) {
    const auto turned = [](double degrees) {
        const double angle = degrees * 3.14159265358979 / 180;
        return blend(along_x, PathElement::line(at(0, 0), at(100 * std::cos(angle), 100 * std::sin(angle))),
                     {BlendRule::corner_distance, 10}, 50, 50)
            .has_value();
    };
    EXPECT_TRUE(turned(155));
    EXPECT_FALSE(turned(165));
    EXPECT_FALSE(turned(-170));
}

TEST(Blend, ReversalNoRoomAndNoRuleGiveNothing) {
    const PathElement back = PathElement::line(at(0, 0), at(-100, 0));

    EXPECT_FALSE(blend(along_x, back, {BlendRule::corner_distance, 10}, 50, 50));
    EXPECT_FALSE(blend(along_x, along_y, {BlendRule::corner_distance, 10}, 0, 50));
    EXPECT_FALSE(blend(along_x, along_y, {BlendRule::none, 10}, 50, 50));
    EXPECT_FALSE(blend(along_x, along_y, {BlendRule::corner_deviation, 0}, 50, 50));
}

// A line that touches a circle has its tangent but not its curvature: it is no smooth joint.
TEST(Blend, SmoothMeansCurvatureToo) {
    const PathElement arc = PathElement::arc(at(0, 50), at(0, -50), at(50, 0), at(0, 0), 1.5);

    EXPECT_TRUE(meet_smoothly(along_x, PathElement::line(at(0, 0), at(7, 0))));
    EXPECT_FALSE(meet_smoothly(along_x, arc));
    EXPECT_FALSE(meet_smoothly(along_x, along_y));
}

}  // namespace
}  // namespace taktwerk::axes

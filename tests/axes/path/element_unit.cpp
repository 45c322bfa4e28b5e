// Curves by their length: unit speed, derivatives that are the derivatives, true arcs.

#include "axes/path/path_element.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/axes/path/points.hpp"

namespace taktwerk::axes {
namespace {

PathElement some_quintic() {
    PathPoint from, to;
    from.first = at(1, 0);
    to.at = at(3, 2, 0.5);
    to.first = at(0, 1);
    to.second = at(0.2, 0);
    return PathElement::quintic(Quintic(from, to, 4));
}

std::vector<PathElement> elements() {
    return {PathElement::line(at(1, 2, 3), at(4, 6, 3)), PathElement::arc(at(0, 0), at(2, 0), at(0, 2), at(0, 0, 0.3), 5), some_quintic()};
}

TEST(PathElement, DerivativesAreThoseByLength) {
    for (const PathElement& e : elements()) {
        const double h = 1e-4;
        for (double share : {0.1, 0.33, 0.5, 0.77, 0.9}) {
            const double s = share * e.length();
            const PathPoint p = e.at(s), before = e.at(s - h), behind = e.at(s + h);
            EXPECT_NEAR(p.first.norm(), 1, 1e-12);
            EXPECT_LT((p.first - (behind.at - before.at) / (2 * h)).norm(), 1e-7);
            EXPECT_LT((p.second - (behind.first - before.first) / (2 * h)).norm(), 1e-6);
            EXPECT_LT((p.third - (behind.second - before.second) / (2 * h)).norm(), 1e-5);
        }
    }
}

// A course has the points, first and second derivatives that it was given at its ends, and is the derivative of itself between. One of them goes twice as fast as its length.
TEST(PathElement, ACourseMeetsPathsOfTwoLengths) {
    PathPoint from, to;
    from.first = at(1, 0);
    to.at = at(3, 2, 0.5);
    to.first = at(0, 2);
    to.second = at(0.2, -0.1);
    const PathElement course = PathElement::course(from, to, 3);
    EXPECT_EQ(course.length(), 3);
    for (const auto& [s, wanted] : {std::pair{0.0, from}, std::pair{3.0, to}}) {
        EXPECT_LT((course.at(s).at - wanted.at).norm(), 1e-14);
        EXPECT_LT((course.at(s).first - wanted.first).norm(), 1e-14);
        EXPECT_LT((course.at(s).second - wanted.second).norm(), 1e-14);
    }
    const double h = 1e-4;
    for (const double s : {0.3, 1.2, 2.6}) {
        EXPECT_LT((course.at(s).first - (course.at(s + h).at - course.at(s - h).at) / (2 * h)).norm(), 1e-7);
        EXPECT_LT((course.at(s).second - (course.at(s + h).first - course.at(s - h).first) / (2 * h)).norm(), 1e-6);
        EXPECT_LT((course.at(s).third - (course.at(s + h).second - course.at(s - h).second) / (2 * h)).norm(), 1e-5);
    }
    EXPECT_LT((course.shifted(at(1, 1)).at(1.2).at - course.at(1.2).at - at(1, 1)).norm(), 1e-14);
}

TEST(PathElement, LineOfThreeFourFive) {
    const PathElement line = PathElement::line(at(1, 2, 3), at(4, 6, 3));

    EXPECT_EQ(line.length(), 5);
    EXPECT_LT((line.at(2.5).at - at(2.5, 4, 3)).norm(), 1e-15);
}

// An arc is a circle at every point, never chords. G-040.
TEST(PathElement, ArcKeepsItsRadiusEverywhere) {
    const PathElement arc = PathElement::arc(at(10, -5), at(250, 0), at(0, 250), at(0, 0), 2 * std::numbers::pi);

    EXPECT_NEAR(arc.length(), 500 * std::numbers::pi, 1e-10);
    for (int i = 0; i <= 1000; ++i) EXPECT_NEAR((arc.at(arc.length() * i / 1000).at - at(10, -5)).norm(), 250, 250e-14);
}

// A helix of radius 3 that rises 4 per radian is 5 long per radian.
TEST(PathElement, HelixLength) {
    const PathElement helix = PathElement::arc(at(0, 0), at(3, 0), at(0, 3), at(0, 0, 4), 2);

    EXPECT_NEAR(helix.length(), 10, 1e-14);
    EXPECT_NEAR(helix.at(10).at[2], 8, 1e-14);
}

// The parabola y = x^2 from 0 to 1 has the length sqrt(5)/2 + asinh(2)/4.
TEST(Quintic, LengthOfAParabola) {
    std::array<PathVector, 6> c;
    c.fill(PathVector::Zero());
    c[1] = at(1, 0);
    c[2] = at(0, 1);
    const Quintic parabola(c);

    EXPECT_NEAR(parabola.length(), std::sqrt(5.0) / 2 + std::asinh(2.0) / 4, 1e-12);
    for (int i = 0; i <= 100; ++i)
        EXPECT_NEAR(parabola.length_to(parabola.parameter_at(parabola.length() * i / 100)), parabola.length() * i / 100, 1e-12);
}

// Where it bends most its length runs most unevenly over its parameter: curves of sharp corners, with legs of one length and of two. One step of Newton's
// method is not enough there.
TEST(Quintic, ParameterOfALengthIsExactWhereItBendsMost) {
    for (const double degrees : {155.0, 170.0})
        for (const double leg : {1.0, 0.5}) {
            PathPoint from, to;
            const double angle = degrees * 3.14159265358979 / 180;
            from.at = at(-1, 0);
            from.first = at(1, 0);
            to.first = at(std::cos(angle), std::sin(angle));
            to.at = leg * to.first;
            const Quintic curve(from, to, 1.7);
            ASSERT_TRUE(curve.smooth());

            for (int i = 0; i <= 1000; ++i) {
                const double s = curve.length() * i / 1000;
                EXPECT_NEAR(curve.length_to(curve.parameter_at(s)), s, 1e-12 * curve.length()) << degrees << ' ' << leg << ' ' << i;
            }
        }
}

TEST(Quintic, CuspIsSeen) {
    PathPoint from, to;
    from.first = at(1, 0);
    to.first = at(-1, 0);
    EXPECT_FALSE(Quintic(from, to, 1).smooth());
    EXPECT_TRUE(Quintic(
                    from,
                    [] {
                        PathPoint p;
                        p.at = at(1, 1);
                        p.first = at(0, 1);
                        return p;
                    }(),
                    1.8)
                    .smooth());
}

}  // namespace
}  // namespace taktwerk::axes

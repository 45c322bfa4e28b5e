// Cams: the curve through the points, by hand-calculated values.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "axes/tables/cam_table.hpp"

namespace taktwerk::axes {
namespace {

using enum CamSegment;

PreparedCam made(const std::vector<CamPoint>& points, bool periodic = false) {
    PreparedCam cam(points.size());
    EXPECT_EQ(cam.prepare(points, periodic, true, true), ErrorId::none);
    return cam;
}

void expect_value(const CamValue& value, double position, double first, double second) {
    EXPECT_NEAR(value.position, position, 1e-12);
    EXPECT_NEAR(value.first, first, 1e-12);
    EXPECT_NEAR(value.second, second, 1e-11);
}

CamPoint straight(double master, double slave) { return {.master = master, .slave = slave, .segment = linear}; }
CamPoint spline_point(double master, double slave, double velocity = 0) {
    return {.master = master, .slave = slave, .velocity = velocity, .segment = spline};
}

TEST(CamTable, LinearSegmentsAreStraightAndTheSegmentBelongsToItsFirstPoint) {
    const auto cam = made({straight(100, 3), straight(110, 8), straight(114, 0)});
    EXPECT_EQ(cam.begin(), 100);
    EXPECT_EQ(cam.length(), 14);
    EXPECT_EQ(cam.stroke(), -3);
    expect_value(cam.at(0), 3, 0.5, 0);
    expect_value(cam.at(4), 5, 0.5, 0);
    expect_value(cam.at(10), 8, -2, 0);
    expect_value(cam.at(14), 0, -2, 0);
}

// From rest to rest over a unit: 10 x^3 - 15 x^4 + 6 x^5.
TEST(CamTable, QuinticFromDwellToDwellIsTheKnownPolynomial) {
    const auto cam = made({{.master = 0, .slave = 0}, {.master = 1, .slave = 1}});
    expect_value(cam.at(0), 0, 0, 0);
    expect_value(cam.at(0.25), 0.103515625, 30.0 / 16 - 60.0 / 64 + 30.0 / 256, 60.0 / 4 - 180.0 / 16 + 120.0 / 64);
    expect_value(cam.at(0.5), 0.5, 1.875, 0);
    expect_value(cam.at(1), 1, 0, 0);
}

// The only polynomial of fifth order with these ends is the one they were taken from: x^5 - 2 x^2 between 1 and 3.
TEST(CamTable, QuinticTakesVelocityAndAccelerationOfBothPoints) {
    const auto cam = made(
        {{.master = 1, .slave = -1, .velocity = 1, .acceleration = 16}, {.master = 3, .slave = 225, .velocity = 393, .acceleration = 536}});
    expect_value(cam.at(1), 24, 72, 156);                                  // at 2: 32 - 8, 80 - 8, 160 - 4
    expect_value(cam.at(1.5), 97.65625 - 12.5, 195.3125 - 10, 312.5 - 4);  // at 2.5
}

// A cubic spline with the right slopes at its ends is the cubic itself: x^3 through unequal steps.
TEST(CamTable, SplineWithGivenEndsReproducesACubic) {
    const auto cam = made({spline_point(0, 0, 0), spline_point(1, 1), spline_point(3, 27), spline_point(4, 64, 48)});
    expect_value(cam.at(0.5), 0.125, 0.75, 3);
    expect_value(cam.at(2), 8, 12, 12);
    expect_value(cam.at(3.5), 42.875, 36.75, 21);
}

// (0,0) (1,1) (2,0) with free ends: 4 M = -12 in the middle, so 1.5 x - 0.5 x^3 up to it.
TEST(CamTable, SplineWithFreeEndsIsNatural) {
    const auto cam = made({spline_point(0, 0, cam_free_end), spline_point(1, 1), spline_point(2, 0, cam_free_end)});
    expect_value(cam.at(0), 0, 1.5, 0);
    expect_value(cam.at(0.5), 0.6875, 1.125, -1.5);
    expect_value(cam.at(1), 1, 0, -3);
    expect_value(cam.at(2), 0, -1.5, 0);
    // One step alone between free ends is straight.
    expect_value(made({spline_point(0, 0, cam_free_end), spline_point(4, 2, cam_free_end)}).at(1), 0.5, 0.5, 0);
}

// A wave through (0,0) (1,1) (2,0) (3,-1) (4,0): by symmetry M = 0, -3, 0, 3 and the slope at the wrap is 1.5. With a stroke: the same
// wave on a line of slope 2.
TEST(CamTable, SplineOverAWholePeriodicCamIsClosed) {
    for (const double slope : {0.0, 2.0}) {
        std::vector<CamPoint> points;
        const double wave[] = {0, 1, 0, -1, 0};
        for (int i = 0; i < 5; ++i) points.push_back(spline_point(i, wave[i] + slope * i, 99));  // what is given at the ends does not count
        const auto cam = made(points, true);
        expect_value(cam.at(0), 0, 1.5 + slope, 0);
        expect_value(cam.at(0.5), 0.6875 + slope / 2, 1.125 + slope, -1.5);
        expect_value(cam.at(3), -1 + 3 * slope, slope, 3);
        expect_value(cam.at(4), 4 * slope, 1.5 + slope, 0);
    }
    // Two steps: 4 M0 + 2 M1 = 12, 2 M0 + 4 M1 = -12, so M0 = 6, M1 = -6 and 3 x^2 - 2 x^3.
    const auto two = made({spline_point(0, 0), spline_point(1, 1), spline_point(2, 0)}, true);
    expect_value(two.at(0), 0, 0, 6);
    expect_value(two.at(0.5), 0.5, 1.5, 0);
    expect_value(made({spline_point(0, 0), spline_point(5, 10)}, true).at(2), 4, 2, 0);
}

// Unequal steps: the rule itself, position, velocity and acceleration from both sides of every point and of the wrap.
TEST(CamTable, SplinesAreContinuousAtEveryPoint) {
    const std::vector<CamPoint> points{spline_point(0, 0), spline_point(0.5, 2), spline_point(3, 1), spline_point(3.25, -4),
                                       spline_point(7, 3)};
    const auto cam = made(points, true);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double end = points[i].master;
        const auto left = cam.at(std::nextafter(end, 0.0));
        const auto right = i + 1 < points.size() ? cam.at(end) : cam.at(0);
        EXPECT_NEAR(left.position, points[i].slave, 1e-9) << i;
        EXPECT_NEAR(left.first, right.first, 1e-9) << i;
        EXPECT_NEAR(left.second, right.second, 1e-8) << i;
    }
}

// A run of splines takes over the slope of a straight neighbour, and the given one of a quintic neighbour.
TEST(CamTable, SplineRunsMeetTheirNeighboursSmoothly) {
    const auto cam = made({straight(0, 0),
                           spline_point(2, 6, 99),
                           spline_point(3, 8),
                           {.master = 5, .slave = 8, .velocity = -1.5, .acceleration = 2},
                           {.master = 7, .slave = 0}});
    EXPECT_NEAR(cam.at(2).first, 3, 1e-12);
    EXPECT_NEAR(cam.at(std::nextafter(5, 0)).first, -1.5, 1e-9);
    EXPECT_NEAR(cam.at(5).first, -1.5, 1e-12);
    EXPECT_NEAR(cam.at(5).second, 2, 1e-12);
}

// Strictly monotonic may also mean falling; each segment still leads from its point to the next of the list.
// P1-256
TEST(CamTable, PointsMayFall) {
    const auto rising = made({straight(1, 5), spline_point(2, 6, 0), {.master = 4, .slave = 9}});
    const auto falling = made({{.master = 4, .slave = 9, .segment = spline}, straight(2, 6), {.master = 1, .slave = 5}});
    EXPECT_EQ(falling.begin(), 1);
    EXPECT_EQ(falling.length(), 3);
    EXPECT_EQ(falling.stroke(), 4);
    for (double x = 0; x <= 3; x += 0.125) EXPECT_DOUBLE_EQ(rising.at(x).position, falling.at(x).position) << x;
}

// P1-256
TEST(CamTable, RefusesWhatCannotBeFollowed) {
    constexpr double nan = cam_free_end, infinite = std::numeric_limits<double>::infinity();
    PreparedCam cam(4);
    const auto refused = [&](std::vector<CamPoint> points) {
        return cam.prepare(points, false, true, true) == ErrorId::invalid_table && cam.length() == 0;
    };
    EXPECT_TRUE(refused({}));
    EXPECT_TRUE(refused({straight(0, 0)}));
    EXPECT_TRUE(refused({straight(0, 0), straight(0, 1)}));
    EXPECT_TRUE(refused({straight(0, 0), straight(2, 1), straight(1, 1)}));
    EXPECT_TRUE(refused({straight(0, 0), straight(-1, 1), straight(-1, 1)}));
    EXPECT_TRUE(refused({straight(0, infinite), straight(1, 1)}));
    EXPECT_TRUE(refused({straight(nan, 0), straight(1, 1)}));
    EXPECT_TRUE(refused({{.master = 0, .slave = 0, .velocity = nan}, {.master = 1, .slave = 1}}));           // a quintic has no free end
    EXPECT_TRUE(refused({spline_point(0, 0), spline_point(1, 1, nan), spline_point(2, 1)}));                 // nor has a point inside
    EXPECT_TRUE(refused({{.master = 0, .slave = 0}, {.master = 1e-300, .slave = 1}}));                       // no usable coefficients
    EXPECT_TRUE(refused({straight(0, 0), straight(1, 1), straight(2, 1), straight(3, 1), straight(4, 1)}));  // more than the room
    EXPECT_EQ(cam.prepare(std::vector<CamPoint>{straight(0, 0), straight(1, 1)}, false, true, true), ErrorId::none);
    EXPECT_EQ(cam.at(0.5).position, 0.5);
}

}  // namespace
}  // namespace taktwerk::axes

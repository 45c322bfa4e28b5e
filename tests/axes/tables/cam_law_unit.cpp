// Motion laws: the published characteristic values, their calculus, and the motion tasks they can do.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "axes/tables/cam_table.hpp"

namespace taktwerk::axes {
namespace {

constexpr double law_pi = std::numbers::pi;

struct KnownLaw {
    const char* name;
    CamSegment law;
    double velocity, acceleration, jerk;  // 0: it steps
};

// Cv, Ca and Cj of the laws of VDI 2143, Part 1, as the literature on cams gives them to three digits (modified trapezoid 2.00, 4.89, 61.4; modified
// sine 1.76, 5.53, 69.5; inclined sine, there also cycloidal, 2.00, 6.28, 39.5; 3-4-5 polynomial 1.88, 5.77, 60.0), here by calculus:
//   parabola            acceleration a over half the time makes the velocity a/2 and half the way a/8: a = 4
//   simple sine         (1 - cos(pi z)) / 2: pi/2, pi^2/2
//   inclined sine       z - sin(2 pi z) / 2 pi: 2, 2 pi, 4 pi^2
//   3-4-5               10 z^3 - 15 z^4 + 6 z^5: 15/8 in the middle, 10/sqrt(3) where 1 - 6 z + 6 z^2 = 0, 60 at the ends
//   modified trapezoid  a sin(4 pi z) up to 1/8, a up to 3/8: the velocity a (1/(4 pi) + 1/4 + 1/(4 pi)) = 2, so a = 8 pi/(pi + 2), and 4 pi a
//   modified sine       a sin(4 pi z) up to 1/8, then a cos(4 pi (z - 1/8) / 3): the velocity a (1 + 3) / (4 pi) = a/pi; the way in the middle is
//                       a (1/(32 pi) - 1/(16 pi^2) + 3/(32 pi) + 9/(16 pi^2)) = 1/2, so a = 4 pi^2/(pi + 4), and 4 pi a
const KnownLaw known_laws[] = {
    {"straight", CamSegment::linear, 1, 0, 0},
    {"quadratic_parabola", CamSegment::quadratic_parabola, 2, 4, 0},
    {"simple_sine", CamSegment::simple_sine, 1.5708, 4.9348, 0},
    {"inclined_sine", CamSegment::inclined_sine, 2, 6.2832, 39.478},
    {"polynomial_5", CamSegment::quintic, 1.875, 5.7735, 60},
    {"modified_trapezoid", CamSegment::modified_trapezoid, 2, 4.8881, 61.426},
    {"modified_sine", CamSegment::modified_sine, 1.7596, 5.5279, 69.466},
};

class NormalisedLaw : public testing::TestWithParam<KnownLaw> {};
INSTANTIATE_TEST_SUITE_P(Known, NormalisedLaw, testing::ValuesIn(known_laws), [](const auto& one) { return std::string(one.param.name); });

TEST_P(NormalisedLaw, GoesFromZeroToOneAndItsDerivativesAreDerivatives) {
    const auto law = GetParam().law;
    EXPECT_EQ(normalised_law(law, 0).position, 0);
    EXPECT_EQ(normalised_law(law, 1).position, 1);
    if (law != CamSegment::linear) {
        EXPECT_EQ(normalised_law(law, 0).velocity, 0);
        EXPECT_NEAR(normalised_law(law, 1).velocity, 0, 1e-15);
    }
    constexpr double step = 1e-5;
    for (double z = 0.01; z < 0.99; z += 0.0137) {  // beside the joints at eighths
        const auto before = normalised_law(law, z - step), here = normalised_law(law, z), behind = normalised_law(law, z + step);
        EXPECT_NEAR((behind.position - before.position) / (2 * step), here.velocity, 1e-7) << z;
        EXPECT_NEAR((behind.velocity - before.velocity) / (2 * step), here.acceleration, 1e-5) << z;
        EXPECT_NEAR((behind.acceleration - before.acceleration) / (2 * step), here.jerk, 1e-3) << z;
    }
}

TEST_P(NormalisedLaw, HasThePublishedPeaks) {
    const auto& known = GetParam();
    LawPeaks seen;
    for (int i = 0; i <= 40000; ++i) {
        const auto value = normalised_law(known.law, i / 40000.0);
        seen.velocity = std::max(seen.velocity, std::abs(value.velocity));
        seen.acceleration = std::max(seen.acceleration, std::abs(value.acceleration));
        seen.jerk = std::max(seen.jerk, std::abs(value.jerk));
    }
    const auto told = peaks_of(known.law);
    EXPECT_NEAR(seen.velocity, known.velocity, known.velocity * 2e-5);
    EXPECT_NEAR(told.velocity, known.velocity, known.velocity * 2e-5);
    if (known.acceleration == 0) {
        EXPECT_TRUE(std::isinf(told.acceleration));
    } else {
        EXPECT_NEAR(seen.acceleration, known.acceleration, known.acceleration * 2e-5);
        EXPECT_NEAR(told.acceleration, known.acceleration, known.acceleration * 2e-5);
    }
    if (known.jerk == 0) {
        EXPECT_TRUE(std::isinf(told.jerk));
    } else {
        EXPECT_NEAR(seen.jerk, known.jerk, known.jerk * 2e-5);
        EXPECT_NEAR(told.jerk, known.jerk, known.jerk * 2e-5);
    }
}

// By hand, in closed form: z - sin(2 pi z) / 2 pi, (1 - cos(pi z)) / 2, 2 z^2 and 1 - 2 (1 - z)^2; of the modified sine, with k = pi / (4 + pi):
// k (z - sin(4 pi z) / 4 pi) up to 1/8, k (2/pi + z - 9/(4 pi) sin((pi + 4 pi z) / 3)) up to 7/8.
TEST(CamLaw, AreTheClosedForms) {
    for (double z = 0; z <= 1; z += 0.0625) {
        EXPECT_NEAR(normalised_law(CamSegment::inclined_sine, z).position, z - std::sin(2 * law_pi * z) / (2 * law_pi), 1e-15) << z;
        EXPECT_NEAR(normalised_law(CamSegment::simple_sine, z).position, (1 - std::cos(law_pi * z)) / 2, 1e-15) << z;
        EXPECT_NEAR(normalised_law(CamSegment::quadratic_parabola, z).position, z < 0.5 ? 2 * z * z : 1 - 2 * (1 - z) * (1 - z), 1e-15)
            << z;
        const double k = law_pi / (4 + law_pi);
        const double sine = z < 0.125   ? k * (z - std::sin(4 * law_pi * z) / (4 * law_pi))
                            : z < 0.875 ? k * (2 / law_pi + z - 9 / (4 * law_pi) * std::sin((law_pi + 4 * law_pi * z) / 3))
                                        : k * (4 / law_pi + z - std::sin(4 * law_pi * z) / (4 * law_pi));
        EXPECT_NEAR(normalised_law(CamSegment::modified_sine, z).position, sine, 1e-15) << z;
    }
    // The trapezoid at 1/8: velocity k/(4 pi) with k = 8 pi/(pi + 2), and k from there to 3/8.
    const double k = 8 * law_pi / (law_pi + 2);
    const auto value = normalised_law(CamSegment::modified_trapezoid, 0.125);
    EXPECT_NEAR(value.velocity, k / (4 * law_pi), 1e-14);
    EXPECT_NEAR(value.position, k * (1 / (32 * law_pi) - 1 / (16 * law_pi * law_pi)), 1e-15);
    EXPECT_NEAR(normalised_law(CamSegment::modified_trapezoid, 0.25).acceleration, k, 1e-14);
}

TEST(CamLaw, WhatIsNoLawFromRestToRestIsZero) {
    for (const auto law : {CamSegment::spline, CamSegment::harmonic_combination}) {
        EXPECT_EQ(normalised_law(law, 0.5).position, 0);
        EXPECT_EQ(peaks_of(law).velocity, 0);
    }
}

/// Looks at a curve between two ends: they are met, nothing steps inside, and each derivative is one.
void expect_joins(const CamLawCurve& curve, double width, const LawEnd& from, const LawEnd& to, bool acceleration_steps) {
    ASSERT_TRUE(static_cast<bool>(curve));
    const double size = std::abs(to.slave - from.slave) + width * (std::abs(from.velocity) + std::abs(to.velocity));
    EXPECT_NEAR(curve.at(0).position, from.slave, 1e-14 * size);
    EXPECT_NEAR(curve.at(width).position, to.slave, 1e-14 * size);
    EXPECT_NEAR(curve.at(0).velocity, from.velocity, 1e-13 * size / width);
    EXPECT_NEAR(curve.at(width).velocity, to.velocity, 1e-13 * size / width);
    constexpr int steps = 20000;
    const double step = width / steps;
    double sum = 0, hardest = 0;
    for (int i = 0; i <= steps; ++i) hardest = std::max(hardest, std::abs(curve.at(i * step).acceleration));
    for (int i = 1; i <= steps; ++i) {
        const auto before = curve.at((i - 1) * step), here = curve.at(i * step);
        sum += (before.velocity + here.velocity) / 2 * step;
        EXPECT_NEAR(here.position - from.slave, sum, 1e-6 * size);
        EXPECT_LE(std::abs(here.velocity - before.velocity), hardest * step * 1.001 + 1e-12 * size / width);
        if (!acceleration_steps) {
            EXPECT_LE(std::abs(here.acceleration - before.acceleration), 0.02 * hardest) << i;
        }
    }
}

struct Task {
    double from, to, way;
};
const Task tasks[] = {{0, 0, 1}, {0, 1, 0.5}, {0, 1, 0.6},   {1, 0, 0.5}, {1, 0, -0.7},
                      {1, 1, 1}, {1, 1, 2},   {0.5, 2, 1.2}, {-1, 1, 0},  {3, -2, 5}};

TEST(CamLaw, FromVelocityToVelocityEachMeetsBothEnds) {
    for (const auto law : {CamSegment::quadratic_parabola, CamSegment::inclined_sine, CamSegment::modified_trapezoid,
                           CamSegment::modified_sine, CamSegment::simple_sine})
        for (const auto& task : tasks)
            for (const double width : {1.0, 360.0}) {
                const LawEnd from{.slave = 7, .velocity = task.from / width}, to{.slave = 7 + task.way, .velocity = task.to / width};
                CamLawCurve curve;
                ASSERT_TRUE(curve.set(law, width, from, to));
                const bool steps = law == CamSegment::quadratic_parabola || law == CamSegment::simple_sine;
                expect_joins(curve, width, from, to, steps);
            }
}

// From rest to the velocity 1 at its mean: one change, an even one. By hand for the parabola: s = z^2 / 2, acceleration 1 throughout.
TEST(CamLaw, OneChangeOfVelocityIsEnoughWhereTheWayFits) {
    CamLawCurve curve;
    ASSERT_TRUE(curve.set(CamSegment::quadratic_parabola, 1, {}, {.slave = 0.5, .velocity = 1}));
    for (double z = 0; z <= 1; z += 0.125) {
        EXPECT_NEAR(curve.at(z).position, z * z / 2, 1e-15);
        EXPECT_EQ(curve.at(z).acceleration, 1);
    }
    ASSERT_TRUE(curve.set(CamSegment::inclined_sine, 1, {.velocity = 1}, {.slave = 0.5}));
    for (double z = 0; z <= 1; z += 0.125) EXPECT_NEAR(curve.at(z).velocity, (1 + std::cos(law_pi * z)) / 2, 1e-15);
    ASSERT_TRUE(curve.set(CamSegment::inclined_sine, 1, {.velocity = 2}, {.slave = 2, .velocity = 2}));  // nothing changes
    EXPECT_EQ(curve.at(0.3).velocity, 2);
    EXPECT_EQ(curve.at(0.3).acceleration, 0);
}

// Velocity to velocity with the parabola is the motion with the least peak of acceleration that there is: both parts have the same. By hand, from 0 to 1
// over a way of 1: r^2 - 2 r - 1 = 0, so 1 + sqrt(2).
TEST(CamLaw, TheInflectionMakesThePeakSmall) {
    CamLawCurve curve;
    ASSERT_TRUE(curve.set(CamSegment::quadratic_parabola, 1, {}, {.slave = 1, .velocity = 1}));
    EXPECT_NEAR(curve.at(0).acceleration, 1 + std::sqrt(2.0), 1e-14);
    EXPECT_NEAR(curve.at(1).acceleration, -1 - std::sqrt(2.0), 1e-14);
    EXPECT_NEAR(curve.inflection(), std::sqrt(0.5), 1e-14);
}

TEST(CamLaw, TheHarmonicCombinationTurnsWithTheAccelerationAskedFor) {
    struct Turn {
        LawEnd from, to;
    };
    const Turn turns[] = {
        {{}, {.slave = 1, .acceleration = -5}},                                                       // rest to turning point
        {{}, {.slave = 1, .acceleration = -3}},                                                       //
        {{.slave = 4, .acceleration = -9}, {.slave = 1}},                                             // turning point to rest
        {{.velocity = 0.5}, {.slave = 1, .acceleration = -4}},                                        // velocity to turning point
        {{.slave = 1, .acceleration = 8}, {.slave = 2.5, .velocity = 1}},                             // turning point to velocity
        {{.acceleration = law_pi * law_pi / 2}, {.slave = 1, .acceleration = -law_pi * law_pi / 2}},  // turning point to turning point
        {{.acceleration = law_pi * law_pi}, {.slave = 1, .acceleration = -law_pi * law_pi / 3}},      // 1/a + 1/b = 4/pi^2
    };
    for (const auto& [from, to] : turns)
        for (const double width : {1.0, 90.0}) {
            LawEnd first = from, last = to;
            first.velocity /= width, last.velocity /= width;
            first.acceleration /= width * width, last.acceleration /= width * width;
            CamLawCurve curve;
            ASSERT_TRUE(curve.set(CamSegment::harmonic_combination, width, first, last));
            expect_joins(curve, width, first, last, false);
            EXPECT_NEAR(curve.at(0).acceleration, first.acceleration, 1e-11 / width / width);
            EXPECT_NEAR(curve.at(width).acceleration, last.acceleration, 1e-11 / width / width);
            const double turn = curve.inflection() * width;
            EXPECT_NEAR(curve.at(turn * (1 - 1e-9)).acceleration, 0, 1e-7 / width / width);
        }
}

TEST(CamLaw, TheHarmonicCombinationRefusesWhatItCannotTurn) {
    CamLawCurve curve;
    const auto refused = [&](const LawEnd& from, const LawEnd& to) {
        return !curve.set(CamSegment::harmonic_combination, 1, from, to) && !curve;
    };
    EXPECT_TRUE(refused({}, {.slave = 1}));                                     // turns nowhere
    EXPECT_TRUE(refused({}, {.slave = 1, .velocity = 1, .acceleration = -5}));  // passes on
    EXPECT_TRUE(refused({}, {.slave = 1, .acceleration = 5}));                  // turns towards where it comes from
    EXPECT_TRUE(refused({}, {.slave = 1, .acceleration = -2.4}));               // pi^2/4 = 2.467 is the least: the whole segment turns
    EXPECT_TRUE(refused({.velocity = 9}, {.slave = 1, .acceleration = -5}));    // far too fast
    EXPECT_FALSE(curve.set(CamSegment::linear, 1, {}, {.slave = 1}));
    EXPECT_FALSE(curve.set(CamSegment::inclined_sine, 1e-300, {}, {.slave = 1e100}));
}

// In a table: the segments' values are those of the laws, in either order of the points.
TEST(CamLaw, SegmentsOfATableFollowTheirLaws) {
    const std::vector<CamPoint> points{{.master = 10, .slave = 0, .segment = CamSegment::modified_sine},
                                       {.master = 50, .slave = 8, .segment = CamSegment::linear},
                                       {.master = 90, .slave = 8, .segment = CamSegment::harmonic_combination},
                                       {.master = 100, .slave = 4, .acceleration = 0.2, .segment = CamSegment::harmonic_combination},
                                       {.master = 110, .slave = 8}};
    PreparedCam cam(points.size());
    ASSERT_EQ(cam.prepare(points, true, true, true), ErrorId::none);
    for (double x = 0; x < 40; x += 2.5) {
        const auto law = normalised_law(CamSegment::modified_sine, x / 40);
        EXPECT_NEAR(cam.at(x).position, 8 * law.position, 1e-13);
        EXPECT_NEAR(cam.at(x).first, 8 * law.velocity / 40, 1e-14);
        EXPECT_NEAR(cam.at(x).second, 8 * law.acceleration / 1600, 1e-14);
    }
    EXPECT_EQ(cam.at(60).position, 8);
    EXPECT_NEAR(cam.at(90).position, 4, 1e-13);
    EXPECT_NEAR(cam.at(90).first, 0, 1e-13);
    EXPECT_NEAR(cam.at(std::nextafter(90, 0)).second, 0.2, 1e-12);
    EXPECT_NEAR(cam.at(90).second, 0.2, 1e-12);
    EXPECT_NEAR(cam.at(100).position, 8, 1e-13);

    // Back to front: the segment stands at the point it leads from.
    const std::vector<CamPoint> falling{{.master = 110, .slave = 8, .segment = CamSegment::harmonic_combination},
                                        {.master = 100, .slave = 4, .acceleration = 0.2, .segment = CamSegment::harmonic_combination},
                                        {.master = 90, .slave = 8, .segment = CamSegment::linear},
                                        {.master = 50, .slave = 8, .segment = CamSegment::modified_sine},
                                        {.master = 10, .slave = 0}};
    PreparedCam other(falling.size());
    ASSERT_EQ(other.prepare(falling, true, true, true), ErrorId::none);
    EXPECT_TRUE(other.same_as(cam));

    auto bad = points;
    bad[3].acceleration = 0;
    EXPECT_EQ(cam.prepare(bad, true, true, true), ErrorId::invalid_table);
    EXPECT_EQ(cam.prepare(std::vector<CamPoint>(points.begin(), points.begin() + 3), false, true, true), ErrorId::none);
    EXPECT_EQ(cam.length(), 80);
}

// A place that held a law before holds a polynomial now.
TEST(CamLaw, ATablePreparedAgainForgetsItsLaws) {
    PreparedCam cam(2);
    std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::inclined_sine}, {.master = 4, .slave = 2}};
    ASSERT_EQ(cam.prepare(points, false, true, true), ErrorId::none);
    EXPECT_NEAR(cam.at(1).position, 0.5 - 1 / law_pi, 1e-15);  // 2 (1/4 - sin(pi/2) / 2 pi)
    for (const auto again : {CamSegment::linear, CamSegment::spline}) {
        points[0].segment = again;
        points[0].velocity = points[1].velocity = 0.5;
        ASSERT_EQ(cam.prepare(points, false, true, true), ErrorId::none);
        EXPECT_EQ(cam.at(1).position, 0.5);
    }
}

}  // namespace
}  // namespace taktwerk::axes

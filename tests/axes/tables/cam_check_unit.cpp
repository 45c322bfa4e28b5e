// What is said of a cam before it runs: steps between its segments, laws that do not fit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "axes/tables/cam_check.hpp"

namespace taktwerk::axes {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> told(const std::vector<CamPoint>& points, bool periodic = false) {
    std::vector<std::string> out;
    const auto without_rounding = [](double value) { return std::round(value * 1e12) / 1e12 + 0.0; };
    for (const auto& step : steps_of(points, periodic)) {
        char text[80];
        std::snprintf(text, sizeof text, "%s at %zu: %.4g, %.4g", step.of == CamStep::Of::velocity ? "velocity" : "acceleration",
                      step.point, without_rounding(step.before), without_rounding(step.behind));
        out.emplace_back(text);
    }
    return out;
}

// Rest, up to the slope 1, along with the master, down to rest: smooth with the inclined sine. With the parabola the acceleration begins and ends at once:
// 1 over 10, twice (the way of 5 fits, so one change is enough).
TEST(CamSteps, NoneWhereTheLawsFit) {
    std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::linear},
                                 {.master = 10, .slave = 0, .segment = CamSegment::inclined_sine},
                                 {.master = 20, .slave = 5, .velocity = 1, .segment = CamSegment::linear},
                                 {.master = 40, .slave = 25, .velocity = 1, .segment = CamSegment::modified_trapezoid},
                                 {.master = 50, .slave = 30, .segment = CamSegment::linear},
                                 {.master = 60, .slave = 30}};
    EXPECT_THAT(told(points), IsEmpty());
    EXPECT_THAT(told(points, true), IsEmpty());

    points[1].segment = CamSegment::quadratic_parabola;
    EXPECT_THAT(told(points), ElementsAre("acceleration at 1: 0, 0.1", "acceleration at 2: 0.1, 0"));
    points[2].velocity = 0.5;
    EXPECT_THAT(told(points)[1], "velocity at 2: 0.5, 1");
}

TEST(CamSteps, OfAPeriodicCamTheWrapCountsToo) {
    const std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::linear},
                                       {.master = 10, .slave = 5, .velocity = 0.5, .segment = CamSegment::quintic},
                                       {.master = 20, .slave = 0}};
    EXPECT_THAT(told(points), IsEmpty());
    EXPECT_THAT(told(points, true), ElementsAre("velocity at 0: 0, 0.5"));
}

// At rest a hair of acceleration is left by rounding: no step.
TEST(CamSteps, RoundingIsNone) {
    std::vector<CamPoint> points;
    for (int i = 0; i <= 20; ++i)
        points.push_back({.master = 17.3 * i,
                          .slave = i % 2 * 0.7,
                          .segment = static_cast<CamSegment>(static_cast<int>(CamSegment::inclined_sine) + i % 3)});
    EXPECT_THAT(told(points, true), IsEmpty());
    for (auto& point : points) point.segment = CamSegment::spline;
    EXPECT_THAT(told(points, true), IsEmpty());
}

TEST(CamSteps, AFallingTableIsReadInItsOwnOrder) {
    const std::vector<CamPoint> points{{.master = 20, .slave = 0, .segment = CamSegment::linear},
                                       {.master = 10, .slave = 5, .segment = CamSegment::linear},
                                       {.master = 0, .slave = 0}};
    EXPECT_THAT(told(points), ElementsAre("velocity at 1: -0.5, 0.5"));
}

TEST(CamSteps, OfWhatCannotBeFollowedNothingIsSaid) {
    EXPECT_THAT(told({}), IsEmpty());
    EXPECT_THAT(told({{.master = 0, .slave = 0, .segment = CamSegment::linear}, {.master = 0, .slave = 1}, {.master = 1, .slave = 5}}),
                IsEmpty());
}

TEST(CamMisfits, NameTheLawThatCannotJoinItsPoints) {
    std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::inclined_sine},
                                 {.master = 10, .slave = 5, .segment = CamSegment::harmonic_combination},
                                 {.master = 20, .slave = 0, .acceleration = 0.3, .segment = CamSegment::harmonic_combination},
                                 {.master = 30, .slave = 5}};
    EXPECT_THAT(misfits_of(points), IsEmpty());
    points[2].acceleration = -0.3;
    EXPECT_THAT(misfits_of(points), ElementsAre(1u, 2u));
}

}  // namespace
}  // namespace taktwerk::axes

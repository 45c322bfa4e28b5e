// Curves from tables over time: through every point, smooth where they promise it, and checked over their whole length.

#include "axes/axis/time_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;
using Rows = std::vector<TimePoint>;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr CurveLimits wide{{1e6, 1e9, 1e9, 1e12}, -inf, inf};

TimeCurve with_room(std::size_t rows = 16) {
    TimeCurve curve;
    curve.reserve(rows);
    return curve;
}

// Three thirds of jerk j, -2j, j: by hand a(1) = j, v(1) = j/2, p(3) = j; so 1 u in 3 s is j = 1 u/s3, and the middle has v = 3/4, p = 1/2.
TEST(TimeCurve, OneRowFromRestIsTheMotionOfThreeThirds) {
    auto curve = with_room();
    ASSERT_EQ(curve.make_position({}, Rows{{3s, 1.0}}, {}, 0), ErrorId::none);

    EXPECT_NEAR(curve.at(0.5).acceleration, 0.5, 1e-12);
    EXPECT_NEAR(curve.jerk_at(0.5), 1, 1e-12);
    EXPECT_NEAR(curve.at(1).velocity, 0.5, 1e-12);
    EXPECT_NEAR(curve.at(1.5).velocity, 0.75, 1e-12);
    EXPECT_NEAR(curve.at(1.5).position, 0.5, 1e-12);
    EXPECT_NEAR(curve.jerk_at(1.6), -2, 1e-12);
    EXPECT_EQ(curve.at(3), (MotionState{1, 0, 0}));
    EXPECT_EQ(curve.duration(), 3);
}

// Continuity is what defines the curve: through the points, with one velocity and one acceleration on both sides of everything, from the
// state at the start to rest. (A curve of constant jerks with these properties and these knots is the only one.)
TEST(TimeCurve, PositionsAreHitAndVelocityAndAccelerationAreContinuous) {
    const MotionState from{2, -3, 40};
    const Rows rows{{200ms, 3.0}, {100ms, -1.0}, {400ms, 5.0}, {50ms, 5.5}, {300ms, 5.5}};
    auto curve = with_room();
    ASSERT_EQ(curve.make_position(from, rows, {}, 0), ErrorId::none);

    EXPECT_EQ(curve.at(0), from);
    double t = 0;
    double largest_jerk = 0;
    auto before = curve.at(0);
    constexpr double step = 1e-5;
    std::size_t row = 0;
    double due = to_seconds(rows[0].delta);
    for (int i = 1; i <= 105000; ++i) {
        t = i * step;
        const auto now = curve.at(t);
        largest_jerk = std::max(largest_jerk, std::abs(curve.jerk_at(t)));
        // Taylor from the state before: exact but for what a changed jerk does in one step.
        ASSERT_NEAR(now.acceleration, before.acceleration, 1.0001 * largest_jerk * step) << t;
        ASSERT_NEAR(now.velocity, before.velocity + (before.acceleration + now.acceleration) / 2 * step, largest_jerk * step * step) << t;
        ASSERT_NEAR(now.position, before.position + (before.velocity + now.velocity) / 2 * step, largest_jerk * step * step * step + 1e-12);
        if (row < rows.size() && std::abs(t - due) < step / 2) {
            EXPECT_NEAR(curve.at(due).position, rows[row].value, 1e-9) << row;
            if (++row < rows.size()) due += to_seconds(rows[row].delta);
        }
        before = now;
    }
    EXPECT_EQ(row, rows.size());
    EXPECT_EQ(curve.at(1.05), (MotionState{5.5, 0, 0}));
    EXPECT_EQ(curve.at(2), (MotionState{5.5, 0, 0}));
}

// P1-190: TimeScale, PositionScale and Offset make another table: the curve of the one is the curve of the other.
TEST(TimeCurve, ScalesAndOffsetAreThoseOfTheTable) {
    const MotionState from{11, 0.5, 0};
    auto scaled = with_room(), plain = with_room();
    ASSERT_EQ(scaled.make_position(from, Rows{{100ms, 1.0}, {50ms, -2.0}, {80ms, 0.5}}, {2, 3, 10}, 0), ErrorId::none);
    ASSERT_EQ(plain.make_position(from, Rows{{200ms, 13.0}, {100ms, 4.0}, {160ms, 11.5}}, {}, 0), ErrorId::none);

    EXPECT_NEAR(scaled.duration(), 0.46, 1e-12);
    for (int i = 0; i <= 46; ++i) {
        EXPECT_NEAR(scaled.at(i * 0.01).position, plain.at(i * 0.01).position, 1e-9);
        EXPECT_NEAR(scaled.at(i * 0.01).velocity, plain.at(i * 0.01).velocity, 1e-8);
    }
}

// Velocity 2 -> 4 in 0.5 s, -> -1 in 1 s: areas 1.5 and 1.5 u by hand.
TEST(TimeCurve, VelocitiesAreJoinedByStraightLinesAndTheLastIsKept) {
    auto curve = with_room();
    ASSERT_EQ(curve.make_velocity({7, 2, 99}, Rows{{500ms, 4.0}, {1s, -1.0}}, {}, 0), ErrorId::none);

    EXPECT_EQ(curve.at(0.25), (MotionState{7 + 2 * 0.25 + 2 * 0.0625, 3, 4}));
    EXPECT_NEAR(curve.at(0.5).position, 8.5, 1e-12);
    EXPECT_NEAR(curve.at(1.5).position, 10, 1e-12);
    EXPECT_EQ(curve.at(1.5).velocity, -1);
    EXPECT_NEAR(curve.at(2.5).position, 9, 1e-12);
    EXPECT_EQ(curve.at(2.5).acceleration, 0);
}

// By hand: 0 to 10 in 1 s, 10 to -4 in 2 s, -4 to 2 in 1 s; then 2 is kept. At 1.5 s the velocity is 10 - 7 * 0.5 = 6.5.
TEST(TimeCurve, TheTopVelocityIsThatOfWhatIsStillToCome) {
    auto curve = with_room();
    ASSERT_EQ(curve.make_velocity({}, Rows{{1s, 10.0}, {2s, -4.0}, {1s, 2.0}}, {}, 0), ErrorId::none);
    EXPECT_DOUBLE_EQ(curve.top_velocity(1), 10);
    EXPECT_DOUBLE_EQ(curve.top_velocity(-1), 4);
    (void)curve.at(1.5);
    EXPECT_NEAR(curve.top_velocity(1), 6.5, 1e-12);
    EXPECT_NEAR(curve.top_velocity(-1), 4, 1e-12);
    (void)curve.at(3.5);
    EXPECT_NEAR(curve.top_velocity(1), 2, 1e-12);
    EXPECT_NEAR(curve.top_velocity(-1), 1, 1e-12);
    (void)curve.at(9);
    EXPECT_DOUBLE_EQ(curve.top_velocity(-1), -2);
}

TEST(TimeCurve, AFirstRowWithoutTimeIsTheStart) {
    auto curve = with_room();
    const MotionState from{5, 3, 0};
    EXPECT_EQ(curve.make_position(from, Rows{{0s, 5.01}, {1s, 6.0}}, {}, 0.02), ErrorId::none);
    EXPECT_EQ(curve.at(0), from) << "the axis begins where it is";
    EXPECT_EQ(curve.make_position(from, Rows{{0s, 5.1}, {1s, 6.0}}, {}, 0.02), ErrorId::invalid_position);
    EXPECT_EQ(curve.make_velocity(from, Rows{{0s, 3.0}, {1s, 6.0}}, {}, 0.1), ErrorId::none);
    EXPECT_EQ(curve.make_velocity(from, Rows{{0s, 3.2}, {1s, 6.0}}, {}, 0.1), ErrorId::invalid_velocity);
}

TEST(TimeCurve, RefusesWhatIsNoTable) {
    auto curve = with_room(2);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(curve.make_position({}, Rows{}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_position({}, Rows{{0s, 0.0}}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_position({}, Rows{{1s, nan}}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_position({}, Rows{{1s, 1.0}, {0s, 2.0}}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_position({}, Rows{{1s, 1.0}, {1s, 2.0}, {1s, 3.0}}, {}, 0), ErrorId::invalid_table) << "more rows than room";
    EXPECT_EQ(curve.make_velocity({}, Rows{{1s, 1.0}, {-1s, 2.0}}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_velocity({}, Rows{{1s, nan}}, {}, 0), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_acceleration({}, Rows{{0s, 1.0}}, {}), ErrorId::invalid_table);
    EXPECT_EQ(curve.make_acceleration({}, Rows{{1s, 1.0}}, {0, 1, 0}), ErrorId::invalid_table) << "no time at all";
}

// The numbers of OneRowFromRest: velocity 0.75, acceleration 1, jerk 2, positions 0 to 1. Each limit just there and just missed.
TEST(TimeCurve, EveryLimitIsCheckedBetweenThePointsToo) {
    auto curve = with_room();
    ASSERT_EQ(curve.make_position({}, Rows{{3s, 1.0}}, {}, 0), ErrorId::none);
    EXPECT_EQ(curve.check({{0.75, 1, 1, 2}, 0, 1}), ErrorId::none);
    EXPECT_EQ(curve.check({{0.7499, 1, 1, 2}, 0, 1}), ErrorId::invalid_velocity);
    EXPECT_EQ(curve.check({{0.75, 0.999, 1, 2}, 0, 1}), ErrorId::invalid_dynamics);
    EXPECT_EQ(curve.check({{0.75, 1, 0.999, 2}, 0, 1}), ErrorId::invalid_dynamics);
    EXPECT_EQ(curve.check({{0.75, 1, 1, 1.999}, 0, 1}), ErrorId::invalid_dynamics);
    EXPECT_EQ(curve.check({{0.75, 1, 1, 2}, 0.001, 1}), ErrorId::beyond_software_limit);
    EXPECT_EQ(curve.check({{0.75, 1, 1, 2}, 0, 0.999}), ErrorId::beyond_software_limit);
}

// v = 1 - 2t: turns at t = 0.5 after 0.25 u, between the two points.
TEST(TimeCurve, ATurnBetweenThePointsIsSeen) {
    auto curve = with_room();
    ASSERT_EQ(curve.make_velocity({0, 1, 0}, Rows{{1s, -1.0}}, {}, 0), ErrorId::none);
    EXPECT_EQ(curve.check({{1, 2, 2, inf}, 0, 0.25}), ErrorId::none);
    EXPECT_EQ(curve.check({{1, 2, 2, inf}, 0, 0.2499}), ErrorId::beyond_software_limit);
    EXPECT_EQ(curve.check({{1, 1.9, 2, inf}, 0, 1}), ErrorId::invalid_dynamics) << "after the turn it speeds up";
    EXPECT_EQ(curve.check({{1, 2, 1.9, inf}, 0, 1}), ErrorId::invalid_dynamics) << "before it, it slows down";
    EXPECT_EQ(curve.check(wide), ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::axes

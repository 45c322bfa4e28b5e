// Homing by the drive beyond where it ends (homing_walk_unit.cpp): start and end of the run, halt, time limit, offsets, modes.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

constexpr double fast = 40000, slow = 4000, acceleration = 400000;
constexpr unsigned attained = 1u << 12, error = 1u << 13, warning = 1u << 7, standing = 1u << 10;

/// On the table of axis_bench.hpp, in homing mode, about to start.
Bench ready(std::int64_t method, const DriveProfile& profile = {}, PlantConfig plant = table(), const SimulatedMotor& motor = {}) {
    Bench b{plant, profile, motor};
    b.in.homing = {.method = method, .fast = fast, .slow = slow, .acceleration = acceleration};
    b.enable();
    b.in.mode = 6;
    b.run(3);
    EXPECT_EQ(b.out.mode, 6);
    return b;
}

void expect_rest(Bench& b) {
    const double place = b.axis.plant().position();
    b.run(300);
    EXPECT_NEAR(b.axis.plant().position(), place, 5.0) << "a servo hunts by a few counts; it goes nowhere";
}

// CiA 402-2, SV33-E table 3-70: rising edge starts, falling edge ends. It slows down with 609Ah: from 40000 that takes 100 ms, 2000 counts.
TEST(HomingRun, BreaksOffWithItsOwnRampWhenTheStartBitFalls) {
    auto b = ready(18);
    b.command(0x1F, 300);
    const double from = b.axis.plant().position();
    EXPECT_GT(b.axis.plant().velocity(), 0.9 * fast);
    b.command(0x0F, 200);
    EXPECT_NEAR(b.axis.plant().position() - from, fast * fast / (2 * acceleration), 150);
    expect_rest(b);
    EXPECT_FALSE(b.out.status & (attained | error));
    EXPECT_TRUE(b.out.status & standing);
}

// CiA 402-2: interrupted. The bit that still stands is no new edge.
TEST(HomingRun, HaltBreaksItOffAndNeedsANewEdge) {
    auto b = ready(18);
    b.command(0x1F, 300);
    b.command(0x11F, 300);
    expect_rest(b);
    EXPECT_FALSE(b.out.status & (attained | error));
    b.command(0x1F, 100);
    expect_rest(b);
    b.command(0x0F);
    b.command(0x1F, 100);
    EXPECT_GT(b.axis.plant().velocity(), 0) << "from a new edge on it runs";
}

TEST(HomingRun, ABitThatStoodBeforeTheModeIsNoStart) {
    Bench b;
    b.in.homing = {.method = 18, .fast = fast, .slow = slow, .acceleration = acceleration};
    b.enable();
    b.command(0x1F, 5);
    b.in.mode = 6;
    b.run(100);
    EXPECT_EQ(b.axis.plant().velocity(), 0);
}

TEST(HomingRun, ASpeedOrAccelerationOfZeroIsAHomingError) {
    for (int zero = 0; zero < 3; ++zero) {
        auto b = ready(18);
        (zero == 0 ? b.in.homing.fast : zero == 1 ? b.in.homing.slow : b.in.homing.acceleration) = 0;
        b.command(0x1F, 50);
        EXPECT_TRUE(b.out.status & error) << zero;
        EXPECT_EQ(b.axis.plant().velocity(), 0) << zero;
    }
}

// SV33-E 3.4.3(9) B): 60E6h = 0 gives home the coordinate 607Ch, 1 its former position plus 607Ch. The edge stands at 50000, where the
// drive counts 50000 too (incremental, started at 0).
TEST(HomingRun, TheOffsetIsHomeOrIsAddedAsIn60E6) {
    for (const std::int64_t way : {0, 1}) {
        auto b = ready(18);
        b.in.home_offset = 1234;
        b.in.home_position_method = way;
        b.command(0x1F, 5000);
        ASSERT_TRUE(b.out.status & attained);
        const double edge = 50000 - (b.axis.plant().position() - static_cast<double>(b.out.position));
        EXPECT_NEAR(edge, way == 0 ? 1234 : 50000 + 1234, 2.0);
    }
}

// SV33-E 3.4.3(9) A), 5.5: P13.49 ends the search with A.425, which is a warning: the drive stays enabled.
TEST(HomingRun, TheTimeLimitIsAWarning) {
    DriveProfile p;
    p.alarms = {{.code = 0x0425, .detail = 0x0425, .warning = true, .kind = DriveAlarmKind::homing_timeout}};
    auto b = ready(18, p);
    b.in.homing.time_limit = 0.5;
    b.command(0x1F, 499);
    EXPECT_FALSE(b.out.status & error);
    b.run(5);
    EXPECT_TRUE(b.out.status & error);
    EXPECT_TRUE(b.out.status & warning);
    EXPECT_EQ(b.out.error_code, 0x0425);
    EXPECT_EQ(b.state(), 0x27u) << "Operation enabled";
    b.run(200);
    expect_rest(b);
    b.command(0x0F);
    b.in.homing.time_limit = 0;
    b.command(0x1F, 50);
    EXPECT_FALSE(b.out.status & (error | warning)) << "a new start forgets it";
}

// A machine whose limit switch is broken: the axis runs into its stop and the drive's own following error ends it.
TEST(HomingRun, AHardStopInsteadOfTheSwitchTripsTheFollowingError) {
    auto plant = table();
    plant.start = -40000;
    plant.negative_limit = -60000;
    plant.negative_stop = -50000;
    SimulatedMotor m;
    m.following_error_limit = 5000;
    auto b = ready(17, {}, plant, m);
    b.command(0x1F, 2000);
    EXPECT_EQ(b.out.error_code, 0x8611);
    EXPECT_FALSE(b.out.status & attained);
}

// SV33-E 3.4.3(9): while homing runs no other mode may be entered; when it is over or broken off, it may.
TEST(HomingRun, NoOtherModeIsEnteredWhileItRuns) {
    auto b = ready(18);
    b.command(0x1F, 100);
    b.in.mode = 8;
    b.run(10);
    EXPECT_EQ(b.out.mode, 6);
    b.in.mode = 6;
    b.run(5000);
    ASSERT_TRUE(b.out.status & attained);
    b.in.mode = 8;
    b.in.target_position = b.out.position;
    b.run(3);
    EXPECT_EQ(b.out.mode, 8);
}

}  // namespace
}  // namespace taktwerk::axes::sim

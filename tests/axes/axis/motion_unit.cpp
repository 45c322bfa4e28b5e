// Motion of one axis: commands, their ends, what aborts and what waits. PLCopen Part 1 v2.0, sections 2.4 and 3.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// P1-136, P1-137: ends at the target, to the last bit, with velocity zero; the state shows the motion.
TEST(AxisMotion, AbsoluteMoveEndsExactlyAtTheTarget) {
    Rig rig;
    rig.power_on();

    const auto id = rig.accept(absolute(33.3, 50));
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);  // P1-017: at once
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().set_position, 33.3);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.drive.last.position, 33300);
    EXPECT_LE(rig.largest_velocity, 50.0 * (1 + 1e-12));
    rig.run(20);
    EXPECT_TRUE(rig.view().in_position);
    rig.expect_no_jump();
}

// Trapezoid without jerk: 100 u at 50 u/s with 1000 u/s2 takes 100/50 + 50/1000 = 2.05 s, that is 2050 cycles.
TEST(AxisMotion, TakesTheTimeOfItsTrapezoid) {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    Rig rig(config);
    rig.power_on();
    const auto begin = rig.now;
    rig.accept(absolute(100, 50));

    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(to_seconds(rig.now - begin), 2.05, 0.0011);
    EXPECT_LE(rig.largest_acceleration, 1000.0 * (1 + 1e-12));
}

// P1-144, P1-081: the distance counts from the set position at activation, also when the coordinates are shifted on the way.
TEST(AxisMotion, RelativeMoveCountsFromTheSetPosition) {
    Rig rig;
    rig.power_on();
    rig.accept(absolute(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(relative(-4));
    rig.run(30);
    EXPECT_EQ(rig.axis.set(SetPosition{1000, true}, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_DOUBLE_EQ(rig.view().set_position, 1006);
    EXPECT_EQ(rig.drive.last.position, 6000);
}

// P1-200: the number commanded stays, and means the shifted coordinates: at 500 set to 600, commanded 1000 ends at the number 1000.
TEST(AxisMotion, SetPositionInMotionKeepsTheNumberOfTheTarget) {
    Rig rig;
    rig.power_on();
    rig.accept(absolute(40, 20));
    rig.run(500);
    const double before = rig.view().following_error;
    const double offset = 100;
    EXPECT_EQ(rig.axis.set(SetPosition{offset, true}, Owner::program), ErrorId::none);
    EXPECT_EQ(rig.view().following_error, before);  // P1-198
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    const auto counts = rig.drive.last.position;
    rig.step();
    EXPECT_LE(std::abs(rig.drive.last.position - counts), 21);  // 20 u/s: no jump in the drive's target
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_DOUBLE_EQ(rig.view().set_position, 40);
    EXPECT_EQ(rig.drive.last.position, -60'000);
}

// P1-199: absolute makes the actual position equal to Position; set minus actual stays.
TEST(AxisMotion, SetPositionKeepsSetMinusActual) {
    Rig rig;
    rig.power_on();
    rig.drive.lag = 300;
    rig.accept(at_velocity(10));
    rig.run(300);
    const double lag = rig.view().set_position - rig.view().actual_position;

    EXPECT_EQ(rig.axis.set(SetPosition{-5, false}, Owner::program), ErrorId::none);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, -5);
    EXPECT_NEAR(rig.view().set_position - rig.view().actual_position, lag, 1e-12);
    EXPECT_EQ(rig.axis.set(SetPosition{std::nan(""), false}, Owner::program), ErrorId::invalid_position);
}

// P1-016: of two aborting commands in one cycle the later wins; the earlier is aborted.
TEST(AxisMotion, LaterOfTwoCommandsInOneCycleWins) {
    Rig rig;
    rig.power_on();
    const auto first = rig.accept(absolute(50));
    const auto second = rig.accept(absolute(-5));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_EQ(rig.view().set_position, -5);
}

// P1-086, P1-143 right half: aborting acts on the running motion, without a stop in between.
TEST(AxisMotion, AbortingReplansFromTheMovingState) {
    Rig rig;
    rig.power_on();
    const auto first = rig.accept(absolute(60, 80));
    rig.run(400);
    ASSERT_EQ(rig.view().set_velocity, 80);
    const auto second = rig.accept(absolute(100, 40));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    double slowest = 80;
    ASSERT_TRUE(rig.run_until([&] {
        if (rig.view().set_position < 95) slowest = std::min(slowest, rig.view().set_velocity);
        return rig.view().state == AxisState::Standstill;
    }));

    EXPECT_NEAR(slowest, 40, 1e-9);
    EXPECT_EQ(rig.status(second), CommandStatus::done);
    EXPECT_EQ(rig.view().set_position, 100);
    rig.expect_no_jump();
}

// P1-095: a linear axis that cannot stop before the new target overshoots and comes back.
TEST(AxisMotion, TargetInsideTheBrakingDistanceIsPassedAndReached) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(300);
    const double target = rig.view().set_position + 1;
    rig.accept(absolute(target));
    double farthest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        farthest = std::max(farthest, rig.view().set_position);
        return rig.view().state == AxisState::Standstill;
    }));

    EXPECT_GT(farthest, target + 3);  // braking from 100 u/s with 1000 u/s2 takes at least 5 u
    EXPECT_DOUBLE_EQ(rig.view().set_position, target);
    rig.expect_no_jump();
}

// P1-087, P1-309 (appendix A, example 3): FB1 1000 at 100, FB2 2000 at 50 with a = d = 200 buffered: 11 s and 20.25 s, velocity 0 at 1000, no pause.
// Scaled by 1/10 in time and 1/100 in way: a * 1 (v/10 over t/10).
TEST(AxisMotion, BufferedCommandStartsWithoutAPause) {
    auto config = plain_axis();
    config.limits = {.velocity = 1000, .acceleration = 1000, .deceleration = 1000, .jerk = std::numeric_limits<double>::infinity()};
    Rig rig(config);
    rig.power_on();
    const auto begin = rig.now;
    auto first = absolute(1000, 100);
    first.acceleration = first.deceleration = 100;
    auto second = absolute(2000, 50, mcBuffered);
    second.acceleration = second.deceleration = 200;
    const auto id1 = rig.accept(first);
    const auto id2 = rig.accept(second);
    EXPECT_EQ(rig.status(id2), CommandStatus::queued);

    ASSERT_TRUE(rig.run_until([&] { return rig.status(id1) == CommandStatus::done; }));
    EXPECT_EQ(rig.status(id2), CommandStatus::active);  // P1-314: in the same cycle
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    EXPECT_NEAR(to_seconds(rig.now - begin), 11.0, 0.0011);
    EXPECT_NEAR(rig.view().set_position, 1000, 0.001);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id2) == CommandStatus::done; }, 30000));
    EXPECT_NEAR(to_seconds(rig.now - begin), 31.25, 0.0011);
    EXPECT_EQ(rig.view().set_position, 2000);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// The rest of a cycle in which a command ends belongs to the next one. 1 u at 1000 u/s2 without jerk takes 2 * sqrt(1 / 1000) = 63.2456 ms: eight
// of them 505.96 ms; each rounded up to a cycle would be 512 ms.
TEST(AxisMotion, BufferedCommandsLoseNoPartOfACycle) {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    config.queue_depth = 8;
    Rig rig(config);
    rig.power_on();
    const auto begin = rig.now;
    for (int i = 1; i <= 8; ++i) rig.accept(absolute(i, 100, mcBuffered));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(to_seconds(rig.now - begin), 0.50596, 0.0011);
    EXPECT_EQ(rig.view().set_position, 8);
}

// U-05, U-09: an aborting command clears the buffer; a full buffer refuses.
TEST(AxisMotion, AbortingClearsTheBufferAndAFullOneRefuses) {
    auto config = plain_axis();
    config.queue_depth = 2;
    Rig rig(config);
    rig.power_on();
    rig.accept(absolute(10));
    const auto waiting = rig.accept(absolute(20, 100, mcBuffered));
    rig.accept(absolute(30, 100, mcBuffered));
    EXPECT_EQ(rig.refuse(absolute(40, 100, mcBuffered)), ErrorId::queue_full);
    EXPECT_EQ(rig.view().queued_count, 2);

    rig.accept(absolute(-3));
    EXPECT_EQ(rig.status(waiting), CommandStatus::aborted);
    EXPECT_EQ(rig.view().queued_count, 0);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, -3);
}

// P1-162, P1-164, P1-168: endless; signs multiply; what is buffered behind it starts after InVelocity was shown.
TEST(AxisMotion, VelocityCommandShowsInVelocityBeforeItsFollowerStarts) {
    Rig rig;
    rig.power_on();
    const auto first = rig.accept({.kind = CommandKind::move_velocity, .direction = mcNegativeDirection, .velocity = -60});
    const auto second = rig.accept(at_velocity(30, mcBuffered));
    bool shown = false;
    ASSERT_TRUE(rig.run_until([&] {
        if (rig.status(first) == CommandStatus::in_target) {
            shown = true;
            EXPECT_EQ(rig.view().set_velocity, 60);
            EXPECT_EQ(rig.status(second), CommandStatus::queued);
        }
        return rig.status(second) == CommandStatus::in_target;
    }));

    EXPECT_TRUE(shown);
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    EXPECT_EQ(rig.view().set_velocity, 30);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
}

// P1-034: velocity 0 stays ContinuousMotion; only Halt or Stop leads out.
TEST(AxisMotion, VelocityZeroStaysContinuousUntilHalt) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(20));
    rig.run(200);
    const auto zero = rig.accept(at_velocity(0));
    rig.run(200);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.status(zero), CommandStatus::in_target);

    const auto halted = rig.accept(halt());
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    rig.run(2);
    EXPECT_EQ(rig.status(halted), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// P1-134: a command during the ramp of Halt aborts it and runs at once, without a stop.
TEST(AxisMotion, HaltCanBeAbortedMidRamp) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(80));
    rig.run(300);
    const auto halted = rig.accept(halt());
    rig.run(40);
    ASSERT_GT(rig.view().set_velocity, 1);
    rig.accept(at_velocity(80));
    EXPECT_EQ(rig.status(halted), CommandStatus::aborted);
    bool stood = false;
    ASSERT_TRUE(rig.run_until([&] {
        stood = stood || rig.view().set_velocity < 1;
        return rig.view().active_in_target;
    }));
    EXPECT_FALSE(stood);
}

// P1-037: what is beyond a limit is held down to it, and the view says by what.
TEST(AxisMotion, DynamicsBeyondTheLimitsAreClamped) {
    Rig rig;
    rig.power_on();
    auto fast = absolute(200, 10'000);
    fast.acceleration = fast.deceleration = 1e6;
    fast.jerk = 1e9;
    rig.accept(fast);
    rig.run(300);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-12));
    EXPECT_GT(rig.largest_velocity, 99.9);
    EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-12));
}

// P1-027, P1-047: a wrong parameter is the command's error; the axis goes on undisturbed.
TEST(AxisMotion, WrongParametersLeaveTheAxisAlone) {
    Rig rig;
    rig.power_on();
    const auto running = rig.accept(at_velocity(20));
    rig.run(200);
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    auto bad = absolute(1);

    EXPECT_EQ(rig.refuse(absolute(nan)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(relative(inf)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(absolute(1, 0)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse(absolute(1, -5)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse(at_velocity(nan)), ErrorId::invalid_velocity);
    bad.acceleration = -1;
    EXPECT_EQ(rig.refuse(bad), ErrorId::invalid_dynamics);
    bad.acceleration = 0;
    bad.jerk = inf;
    EXPECT_EQ(rig.refuse(bad), ErrorId::invalid_dynamics);
    EXPECT_EQ(rig.refuse(absolute(1, 10, static_cast<MC_BufferMode>(6))), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::move_velocity, .direction = mcShortestWay, .velocity = 1}),
              ErrorId::invalid_direction);  // P1-165
    EXPECT_EQ(rig.refuse({}), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(home(0)), ErrorId::state_forbids);  // P1-035
    rig.run(10);
    EXPECT_EQ(rig.status(running), CommandStatus::in_target);
    EXPECT_EQ(rig.view().set_velocity, 20);
}

// P1-043: a waiting command that turns out impossible ends with its own error; the next one starts at once.
TEST(AxisMotion, ImpossibleWaitingCommandGivesWayToTheNext) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(20));
    const auto homing = rig.accept({.kind = CommandKind::home, .buffer_mode = mcBuffered, .position = 0});
    const auto last = rig.accept(absolute(7, 100, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(homing) == CommandStatus::error; }));
    EXPECT_EQ(rig.error_of(homing), ErrorId::state_forbids);  // no arrow from ContinuousMotion to Homing
    EXPECT_EQ(rig.status(last), CommandStatus::active);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(last) == CommandStatus::done; }));

    EXPECT_EQ(rig.view().set_position, 7);
}

// An endless axis: 10^6 cycles of 360 degrees in steps of one turn per 100 ms; gear 7:3. The counts are those of the exact ratio, rounded once.
TEST(AxisMotion, EndlessAxisDoesNotDriftInAMillionCycles) {
    auto config = plain_axis();
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360};
    config.limits = {.velocity = 20000, .acceleration = 1e6, .deceleration = 1e6, .jerk = 1e9};
    Rig rig(config);
    rig.power_on();
    long turns = 0;
    rig.program = [&] {
        if (rig.view().state != AxisState::Standstill) return;
        ASSERT_EQ(rig.drive.last.position, (2 * turns * 70000 + 3) / 6) << turns;  // round(turns * 70000 / 3)
        ++turns;
        rig.accept(relative(360, 20000));
    };
    rig.run(1'000'000);

    EXPECT_GT(turns, 10'000);
}

// 3e15 counts from zero (an absolute encoder after years in one direction) the set-points are as fine as near zero: 3e15 counts as such would have
// a resolution of half a count in double degrees.
TEST(AxisMotion, FarAwayIsAsFineAsNear) {
    auto config = plain_axis();
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360};
    const std::int64_t turns = 3LL * 42'857'142'857LL;  // whole feeds and whole counts
    const std::int64_t start = turns / 3 * 70000;
    Rig near(config), far(config, [&](FakeDrive&drive) { drive.position = static_cast<double>(start); });
    for (auto* rig : {&near, &far}) {
        rig->power_on();
        rig->run(10);
    }
    ASSERT_EQ(far.drive.last.position, start);
    for (auto* rig : {&near, &far}) rig->accept(relative(7.3, 20));
    for (int i = 0; i < 600; ++i) {
        near.step();
        far.step();
        ASSERT_EQ(far.drive.last.position - start, near.drive.last.position) << i;
    }
    EXPECT_EQ(near.drive.last.position, 473);  // 7.3 * 70000 / 3 / 360 = 473.15
}

// The same at a constant velocity: 3600 degrees per second for 1000 s. Ramps are symmetric, so the way is v * (t - v / (2 a)) without jerk.
TEST(AxisMotion, EndlessVelocityDoesNotDrift) {
    auto config = plain_axis();
    config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360};
    config.limits = {.velocity = 5000, .acceleration = 36000, .deceleration = 36000, .jerk = std::numeric_limits<double>::infinity()};
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(3600));
    rig.run(1'000'000);

    const double turns = 10.0 * (1000.0 - 0.05);
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position), turns * 70000 / 3, 1.0);
    EXPECT_EQ(rig.view().set_velocity, 3600);
}

}  // namespace
}  // namespace taktwerk::axes::test

// What no set-point passes, whatever made it; why an axis is slow; stops that do not speed up.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig limited() {
    auto config = plain_axis();
    config.limits.position_min = -50;
    config.limits.position_max = 100;
    config.homing.kind = HomingKind::set_here;
    return config;
}
struct HomedRig : Rig {
    explicit HomedRig(const AxisConfig& config = limited()) : Rig(config) {
        power_on();
        accept(home(0));
        run(3);
    }
    double farthest = 0;
    bool watch_to(AxisState state) {
        return run_until([&] {
            farthest = std::max(farthest, view().set_position);
            return view().state == state && view().set_velocity == 0;
        });
    }
};

// A halt and a stop with ramps too long for what is left brake as hard as needed; away from the limit they keep their own.
TEST(LimitGuard, GentleStopsEndBeforeTheLimit) {
    for (const auto kind : {CommandKind::halt, CommandKind::stop}) {
        HomedRig rig;
        rig.accept(absolute(100));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 85; }));
        ASSERT_GT(rig.view().set_velocity, 99);
        AxisCommand gentle{.kind = kind, .deceleration = 100, .jerk = 2000};  // would need 52 u
        const auto id = rig.accept(gentle);
        ASSERT_TRUE(rig.run_until([&] {
            rig.farthest = std::max(rig.farthest, rig.view().set_position);
            return rig.status(id) == CommandStatus::done;
        }));
        EXPECT_LE(rig.farthest, 100);
        EXPECT_TRUE(rig.alarms.empty());
    }
}

// A new target behind the axis: with ramps that fit it is no business of the limits, although the axis passes nearer to it than the target.
TEST(LimitGuard, OvershootInsideTheLimitsIsLeftAlone) {
    HomedRig rig;
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 80; }));
    rig.accept(absolute(0));
    ASSERT_TRUE(rig.watch_to(AxisState::Standstill));
    EXPECT_GT(rig.farthest, 85);
    EXPECT_LT(rig.farthest, 100);
    EXPECT_TRUE(rig.alarms.empty());
}

// MC_MoveContinuousAbsolute that has to take a run-up beyond the limit is cut off on it.
TEST(LimitGuard, OvershootOfAContinuousMoveEndsOnTheLimit) {
    HomedRig rig;
    const auto id = rig.accept({.kind = CommandKind::move_continuous_absolute, .position = 99, .velocity = 100, .end_velocity = -80});
    ASSERT_TRUE(rig.watch_to(AxisState::ErrorStop));
    EXPECT_LE(rig.farthest, 100 * (1 + 1e-15));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 100);
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::software_limit_reached));
}

// Why this velocity: each cause in turn.
TEST(WhyThisVelocity, NamesTheCause) {
    HomedRig rig;
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::none);
    rig.accept(at_velocity(5));
    rig.run(50);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::command);
    rig.accept(at_velocity(500));
    rig.run(50);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit);
    (void)rig.axis.set(Override{0.1, 1, 1}, Owner::program);
    rig.run(50);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
    (void)rig.axis.set(Override{}, Owner::program);
    rig.accept(halt());
    rig.run(2);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::stopping);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.axis.set_mode(OperatingMode::setup);
    const auto id = rig.accept(jog(60), Owner::operator_panel);
    rig.program = [&] { (void)rig.axis.renew_jog(id, 60, Owner::operator_panel); };
    rig.run(100);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::manual_speed);
    EXPECT_NEAR(rig.view().set_velocity, 5, 1e-9);  // 5 % of 100
    bool seen = false;
    ASSERT_TRUE(rig.run_until(
        [&] {
            seen = seen || rig.view().limiter == VelocityLimiter::software_limit;
            return rig.view().set_position == 100;
        },
        40'000));
    EXPECT_TRUE(seen);
}

// A stop with a tenth of the jerk, given while the axis speeds up: the speed grows no further than the motion itself would have let it by taking
// its acceleration away, v + a^2 / (2 j) with the motion's jerk, not with the stop's.
TEST(StopJerk, AStopWhileSpeedingUpDoesNotSpeedUpMore) {
    for (const auto kind : {CommandKind::halt, CommandKind::stop}) {
        Rig rig;
        rig.power_on();
        rig.accept(at_velocity(100));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration >= 999; }));
        const double v = rig.view().set_velocity, a = rig.view().set_acceleration;
        rig.accept({.kind = kind, .jerk = 2000});
        double fastest = v;
        ASSERT_TRUE(rig.run_until([&] {
            fastest = std::max(fastest, rig.view().set_velocity);
            return rig.view().set_velocity == 0;
        }));
        EXPECT_LE(fastest, v + a * a / (2 * 20000) + 1e-9);
        EXPECT_GT(fastest, v + 10);  // with the stop's own jerk it would have been v + 250
        EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-9));
    }
}

// A command with less jerk at the height of the acceleration: the axis' velocity limit holds all the same.
TEST(StopJerk, LessJerkDoesNotCarryTheAxisBeyondItsLimit) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity > 70; }));
    ASSERT_GT(rig.view().set_acceleration, 900);
    auto soft = at_velocity(100);
    soft.jerk = 1000;  // alone it would gain another 500 u/s
    rig.accept(soft);
    rig.run(500);
    EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
    EXPECT_NEAR(rig.view().set_velocity, 100, 1e-9);
}

// The same while it brakes hard: the acceleration carries it through zero, and must not carry it beyond the limit of the other sense.
TEST(StopJerk, LessJerkWhileItBrakesDoesNotCarryTheAxisBeyondItsLimitBackwards) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(90));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity > 89.9; }));
    rig.run(100);
    rig.accept(at_velocity(-20));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity < 20; }));
    ASSERT_LT(rig.view().set_acceleration, -900);
    auto soft = at_velocity(-20);
    soft.jerk = 1000;  // alone it would lose 500 u/s more
    rig.accept(soft);
    rig.run(2000);
    EXPECT_LE(rig.largest_velocity, 100 * (1 + 1e-9));
    EXPECT_NEAR(rig.view().set_velocity, -20, 1e-9);
}

// Two that brake together become one when the jog turns round in front of the limit: what carries the axis back later than at the limit is beyond it
// although the stop ends inside. 1 u: the way that is left when both brake from 100 u/s with 2000 u/s2 together.
TEST(Guards, AJogThatTurnsRoundBesideAnAdditionStaysInside) {
    auto config = plain_axis();
    config.limits.position_min = -10;
    config.limits.position_max = 10;
    config.homing.kind = HomingKind::set_here;
    for (const double sense : {1.0, -1.0})
        for (int first = 60; first < 260; first += 3)
            for (int second = 1; second < 40; second += 9) {
                Rig rig(config);
                rig.power_on();
                rig.accept(home(0));
                rig.run(10);
                rig.accept(jog(sense * 60));
                (void)rig.axis.submit({.kind = CommandKind::move_superimposed, .position = sense * 5, .velocity = 40}, Owner::program);
                rig.run(first);
                (void)rig.axis.submit(jog(sense * -60), Owner::program);
                rig.run(second);
                (void)rig.axis.submit({.kind = CommandKind::move_superimposed, .position = sense * 0.3, .velocity = 30}, Owner::program);
                (void)rig.axis.submit(jog(sense * 30), Owner::program);
                rig.run(15);
                (void)rig.axis.submit(jog(sense * -100), Owner::program);
                for (int i = 0; i < 100; ++i) {
                    rig.step();
                    ASSERT_LE(std::abs(rig.view().set_position), 10 + 1e-9) << first << ", " << second;
                }
                ASSERT_TRUE(rig.oracle.clean()) << first << ", " << second << rig.oracle.report();
            }
}

}  // namespace
}  // namespace taktwerk::axes::test

// MC_MoveAdditive and MC_MoveContinuousAbsolute/Relative. PLCopen Part 1 v2.0, sections 3.7, 3.11, 3.12; numbers are hand calculations.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand additive(double distance, double velocity = 100, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::move_additive, .buffer_mode = mode, .position = distance, .velocity = velocity};
}
AxisCommand passing(double position, double velocity, double end_velocity) {
    return {.kind = CommandKind::move_continuous_absolute, .position = position, .velocity = velocity, .end_velocity = end_velocity};
}
AxisCommand passing_by(double distance, double velocity, double end_velocity, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::move_continuous_relative,
            .buffer_mode = mode,
            .position = distance,
            .velocity = velocity,
            .end_velocity = end_velocity};
}

// P1-147, P1-149: 600 aborted by +400, aborted by +100: 1100, whatever was aborted.
TEST(MoveAdditive, AddsToTheLastCommandedTargetEvenOfAnAbortedOne) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto first = rig.accept(absolute(600, 300));
    rig.run(800);
    const auto second = rig.accept(additive(400, 200));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    rig.run(100);
    const auto third = rig.accept(additive(100, 200));
    EXPECT_EQ(rig.status(second), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(third), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 1100);
}

// P1-016, P1-147: both given in one cycle are taken one after another.
TEST(MoveAdditive, AddsToATargetOfTheSameCycle) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(absolute(60, 300));
    rig.accept(additive(-20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 40);
}

// P1-148: in ContinuousMotion it counts from the set position of that moment; so it does after a motion has ended.
TEST(MoveAdditive, CountsFromTheSetPositionWithoutADiscreteTarget) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(700);
    const double here = rig.view().set_position;
    rig.accept(additive(200));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, here + 200);

    rig.accept(absolute(500));
    rig.run(200);
    rig.accept(halt());
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    const double halted = rig.view().set_position;
    rig.accept(additive(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, halted + 10);
}

// P1-149: buffered behind a move it adds to that move's target.
TEST(MoveAdditive, BufferedAddsToTheTargetBefore) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(absolute(60, 300));
    rig.accept(additive(40, 200, mcBlendingHigh));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 100);
}

// P1-169, P1-170, P1-171, P1-175: 100 u at 50 u/s arriving with 20 u/s, 1000 u/s2: up 1.25 u in 0.05 s, down 1.05 u in 0.03 s, 97.7 u at 50:
// 2.034 s. At the target the velocity is 20 to the last bit and stays.
TEST(MoveContinuous, PassesTheTargetWithItsEndVelocityAndKeepsIt) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto begin = rig.now;
    const auto id = rig.accept(passing(100, 50, 20));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }));
    const double t = to_seconds(rig.now - begin);
    EXPECT_NEAR(t, 2.034, 0.0011);
    EXPECT_EQ(rig.view().set_velocity, 20);
    EXPECT_NEAR(rig.view().set_position, 100 + 20 * (t - 2.034), 1e-9);
    EXPECT_LE(rig.largest_velocity, 50 * (1 + 1e-12));
    rig.run(1000);
    EXPECT_EQ(rig.view().set_velocity, 20);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_NEAR(rig.view().set_position, 100 + 20 * (t + 1 - 2.034), 1e-9);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
}

// P1-173 (figure 26): from 0 to 100 arriving with -100, velocity 500, a = d = 4000 without jerk: it turns at 101.25 and is at 100 after
// 0.3525 s; at 50 half a second later.
TEST(MoveContinuous, NegativeEndVelocityOvershootsAndComesBack) {
    Rig rig(trapezoids(500, 4000));
    rig.power_on();
    const auto begin = rig.now;
    const auto id = rig.accept(passing(100, 500, -100));
    double turning = 0;
    ASSERT_TRUE(rig.run_until([&] {
        turning = std::max(turning, rig.view().set_position);
        return rig.status(id) == CommandStatus::in_target;
    }));
    EXPECT_NEAR(to_seconds(rig.now - begin), 0.3525, 0.0011);
    EXPECT_NEAR(turning, 101.25, 0.003);  // half a cycle next to the turning point: 4000 / 2 * 0.001^2
    EXPECT_EQ(rig.view().set_velocity, -100);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position < 50; }));
    EXPECT_NEAR(to_seconds(rig.now - begin), 0.8525, 0.0011);
}

// P1-174, P1-176: relative, the same way: one reversal beyond the target.
TEST(MoveContinuous, RelativeCountsFromTheStart) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(absolute(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    const auto id = rig.accept(passing_by(40, 80, -30));
    int reversals = 0;
    double before = 0;
    ASSERT_TRUE(rig.run_until([&] {
        const double velocity = rig.view().set_velocity;
        if (before * velocity < 0) ++reversals;
        if (velocity != 0) before = velocity;
        return rig.status(id) == CommandStatus::in_target;
    }));
    EXPECT_EQ(reversals, 1);
    EXPECT_EQ(rig.view().set_velocity, -30);
    EXPECT_NEAR(rig.view().set_position, 50, 0.031);
    EXPECT_LE(rig.view().set_position, 50);
}

// P1-172: the same as a move with a velocity command blended behind it.
TEST(MoveContinuous, EqualsAMoveBlendedIntoAVelocity) {
    Rig one(trapezoids()), two(trapezoids());
    one.power_on();
    two.power_on();
    one.accept(passing(100, 50, 20));
    two.accept(absolute(100, 50));
    two.accept(at_velocity(20, mcBlendingNext));
    for (int i = 0; i < 3000; ++i) {
        one.step();
        two.step();
        ASSERT_NEAR(one.view().set_position, two.view().set_position, 1e-9) << i;
        ASSERT_NEAR(one.view().set_velocity, two.view().set_velocity, 1e-9) << i;
    }
}

// P1-177 (figure 29): 1000 at 50 with 20, then 500 at 20 with 10, then 700 at 20. Buffered: joints at 1000 and 1500, each follower a
// cycle after InEndVelocity was shown: up to two cycles of 20 u/s later. Ways scaled by 1/10.
TEST(MoveContinuous, AChainOfThree) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(passing_by(100, 50, 20));
    const auto second = rig.accept(passing_by(50, 20, 10, mcBuffered));
    const auto third = rig.accept(relative(70, 20, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(second) == CommandStatus::active; }));
    EXPECT_NEAR(rig.view().set_position, 100, 0.061);
    EXPECT_NEAR(rig.view().set_velocity, 20, 1.001);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(third) == CommandStatus::active; }));
    EXPECT_NEAR(rig.view().set_position, 150, 0.1);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.view().set_position, 220, 0.15);
}

// An end velocity above the command's own: the ramp up to it is the last part of the way.
TEST(MoveContinuous, EndVelocityMayBeHigherThanVelocity) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto id = rig.accept(passing(100, 20, 60));
    double at_ninety = 0;
    ASSERT_TRUE(rig.run_until([&] {
        if (rig.view().set_position < 90) at_ninety = rig.view().set_velocity;
        return rig.status(id) == CommandStatus::in_target;
    }));
    EXPECT_NEAR(at_ninety, 20, 1e-9);  // (60^2 - 20^2) / 2000 = 1.6 u are enough for the ramp
    EXPECT_EQ(rig.view().set_velocity, 60);
    EXPECT_NEAR(rig.view().set_position, 100, 0.061);
}

// What it keeps after the target ends at the software limit like any endless motion.
TEST(MoveContinuous, StopsOnTheSoftwareLimit) {
    auto config = trapezoids(100);
    config.limits.position_min = -10;
    config.limits.position_max = 80;
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    rig.accept(home(0));
    rig.run(3);
    const auto id = rig.accept(passing(60, 50, 40));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::ErrorStop && rig.view().set_velocity == 0; }));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 80);
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::software_limit_reached));
    EXPECT_EQ(rig.refuse(passing(81, 50, 0)), ErrorId::in_error_stop);
}

}  // namespace
}  // namespace taktwerk::axes::test

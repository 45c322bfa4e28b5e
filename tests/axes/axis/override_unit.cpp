// MC_SetOverride. PLCopen Part 1 v2.0, section 3.18.

#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

struct OverrideRig : Rig {
    OverrideRig() : Rig(trapezoids()) { power_on(); }
    ErrorId factors(double velocity, double acceleration = 1, double jerk = 1) {
        return axis.set(Override{velocity, acceleration, jerk}, Owner::program);
    }
};

// P1-203, P1-204, P1-205, P1-212: 100 to 50 in 0.05 s, InVelocity there; back to 100 with half the acceleration in 0.1 s.
TEST(AxisOverride, FactorsActAtOnce) {
    OverrideRig rig;
    const auto id = rig.accept(at_velocity(100));
    rig.run(200);
    ASSERT_EQ(rig.view().set_velocity, 100);
    EXPECT_EQ(rig.factors(0.5), ErrorId::none);
    rig.step();
    EXPECT_NEAR(rig.view().set_velocity, 99, 1e-9);
    EXPECT_EQ(rig.status(id), CommandStatus::active);  // P1-070
    rig.run(50);
    EXPECT_EQ(rig.view().set_velocity, 50);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
    EXPECT_EQ(rig.view().override_factors.velocity, 0.5);

    EXPECT_EQ(rig.factors(1, 0.5), ErrorId::none);
    rig.run(1);
    EXPECT_NEAR(rig.view().set_velocity, 50.5, 1e-9);
    rig.run(98);
    EXPECT_LT(rig.view().set_velocity, 100);
    rig.run(2);
    EXPECT_EQ(rig.view().set_velocity, 100);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::command);
}

// P1-207, P1-209: factor 0 stops without leaving the state, the target is not lost; so it is from the very start.
TEST(AxisOverride, ZeroHoldsTheMotionWithoutStandstill) {
    OverrideRig rig;
    const auto id = rig.accept(absolute(100, 50));
    rig.run(500);
    EXPECT_EQ(rig.factors(0), ErrorId::none);
    rig.run(500);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    EXPECT_EQ(rig.view().target_position, 100);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
    EXPECT_EQ(rig.factors(1), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 100);
    EXPECT_EQ(rig.status(id), CommandStatus::done);

    EXPECT_EQ(rig.factors(0), ErrorId::none);
    const auto held = rig.accept(absolute(0, 50));
    rig.run(100);
    EXPECT_EQ(rig.view().set_position, 100);
    EXPECT_EQ(rig.status(held), CommandStatus::active);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    EXPECT_EQ(rig.factors(0.25), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 0);
    EXPECT_LE(rig.largest_velocity, 50 * (1 + 1e-12));
}

// P1-203, P1-209: the factor enters the commanded velocity, so InVelocity is TRUE at the reduced one, which may be 0; on the way there it is not.
TEST(AxisOverride, InVelocityIsTrueAtTheReducedVelocityAlsoAtZero) {
    OverrideRig rig;
    const auto id = rig.accept(at_velocity(100));
    rig.run(200);
    ASSERT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.factors(0), ErrorId::none);
    rig.run(50);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.run(150);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);

    EXPECT_EQ(rig.factors(1), ErrorId::none);
    rig.run(50);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.run(150);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
}

// The operator's factor stands beside the program's: the velocity has both, and neither side sees its own changed by the other.
TEST(AxisOverride, TheOperatorsMultipliesTheProgramsAndStays) {
    OverrideRig rig;
    rig.accept(at_velocity(100));
    rig.run(200);
    ASSERT_EQ(rig.factors(0.5), ErrorId::none);
    ASSERT_EQ(rig.axis.set_operators_override(0.5), ErrorId::none);
    rig.run(200);
    EXPECT_EQ(rig.view().set_velocity, 25);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
    EXPECT_EQ(rig.view().override_factors.velocity, 0.5) << "MC_SetOverride sees what it has set";
    EXPECT_EQ(rig.view().operators_override, 0.5);
    ASSERT_EQ(rig.factors(1), ErrorId::none);
    rig.run(200);
    EXPECT_EQ(rig.view().set_velocity, 50) << "a program cannot take the operator's back";
    for (const double bad : {-0.1, 1.1, std::nan("")}) EXPECT_EQ(rig.axis.set_operators_override(bad), ErrorId::invalid_override) << bad;
    EXPECT_EQ(rig.view().operators_override, 0.5);
    ASSERT_EQ(rig.axis.set_operators_override(1), ErrorId::none);
    rig.run(200);
    EXPECT_EQ(rig.view().set_velocity, 100);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::command);
}

// Whoever owns the axis: it is the operator's. 0 halts in the motion, back goes on to the same target; within the axis' limits all the way.
TEST(AxisOverride, TheOperatorsZeroHaltsAndTheMotionGoesOn) {
    OverrideRig rig;
    const auto id = rig.accept(absolute(100, 50));
    rig.run(500);
    ASSERT_EQ(rig.axis.set_operators_override(0), ErrorId::none);
    rig.run(500);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
    const double halted = rig.view().set_position;
    rig.run(500);
    EXPECT_EQ(rig.view().set_position, halted);
    ASSERT_EQ(rig.axis.set_operators_override(1), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 100);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_LE(rig.largest_velocity, 50 * (1 + 1e-12));
}

// A velocity of 0 is a stop, and an override takes nothing from it: what keeps the axis slow then is the stop, also of a jog that nobody renews.
TEST(AxisOverride, WhatStopsIsNotHeldDownByTheOverride) {
    for (const bool jogged : {false, true}) {
        OverrideRig rig;
        ASSERT_EQ(rig.axis.set_operators_override(0.5), ErrorId::none);
        rig.accept(jogged ? AxisCommand{.kind = CommandKind::jog, .velocity = 50} : at_velocity(50));
        rig.run(100);
        ASSERT_EQ(rig.view().set_velocity, 25);
        ASSERT_EQ(rig.view().limiter, VelocityLimiter::override_factor);
        if (!jogged) rig.accept(at_velocity(0));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity < 25; }));  // the lease of the jog runs out
        for (Patience patience; patience.lasts(rig.view().set_velocity != 0);) {
            ASSERT_EQ(rig.view().limiter, VelocityLimiter::stopping) << jogged;
            rig.step();
        }
    }
}

// P1-206: what is allowed; a refused call changes nothing.
TEST(AxisOverride, RefusesWhatTheStandardForbids) {
    OverrideRig rig;
    ASSERT_EQ(rig.factors(0.5, 0.6, 0.7), ErrorId::none);
    EXPECT_EQ(rig.factors(-0.1), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1.1), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(std::nan("")), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1, 0), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1, 1, 0), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1, -0.1), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1, 1, 1.1), ErrorId::invalid_override);
    EXPECT_EQ(rig.view().override_factors, (Override{0.5, 0.6, 0.7}));
    EXPECT_EQ(rig.axis.set(Override{}, Owner::commissioning), ErrorId::owned_by_other);
}

// P1-210: with less acceleration in the braking ramp the target is passed and reached all the same.
TEST(AxisOverride, LessDecelerationOvershootsAndReturns) {
    OverrideRig rig;
    rig.accept(absolute(100, 100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 96; }));
    EXPECT_EQ(rig.factors(1, 0.2), ErrorId::none);
    double farthest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        farthest = std::max(farthest, rig.view().set_position);
        return rig.view().state == AxisState::Standstill;
    }));
    EXPECT_GT(farthest, 100.5);
    EXPECT_EQ(rig.view().set_position, 100);
}

// Positions of blended moves stay; the velocity at the joint is the reduced one: min(100, 60) * 0.5.
TEST(AxisOverride, BlendsAtTheSamePlaceWithTheReducedVelocity) {
    OverrideRig rig;
    const auto first = rig.accept(absolute(100, 100));
    rig.accept(absolute(200, 60, mcBlendingLow));
    rig.run(300);
    EXPECT_EQ(rig.factors(0.5), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(first) == CommandStatus::done; }));
    EXPECT_NEAR(rig.view().set_position, 100, 0.031);
    EXPECT_GE(rig.view().set_position, 100);
    EXPECT_NEAR(rig.view().set_velocity, 30, 1e-9);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 200);
}

// P1-202: the factors stay; a stop is as hard as ever.
TEST(AxisOverride, StopsAreNotSlowedDown) {
    OverrideRig rig;
    EXPECT_EQ(rig.factors(1, 0.1), ErrorId::none);
    rig.accept(at_velocity(100));
    rig.run(1100);
    ASSERT_EQ(rig.view().set_velocity, 100);
    rig.accept(halt());
    rig.run(101);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.view().override_factors.acceleration, 0.1);
}

// A filter that decays for ever: the axis stands as with 0, and goes on from there.
TEST(AxisOverride, AFactorThatIsAsGoodAsNoneIsNone) {
    OverrideRig rig;
    const auto id = rig.accept(absolute(300, 100));
    rig.run(500);
    for (double factor = 1; factor > 0; factor *= 0.5) {
        ASSERT_EQ(rig.factors(factor), ErrorId::none) << factor;
        rig.run(10);
        ASSERT_EQ(rig.view().state, AxisState::DiscreteMotion) << factor;
    }
    rig.run(500);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.view().override_factors.velocity, 0);
    EXPECT_EQ(rig.factors(0.5, 1e-300), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(0.5, 1, 1e-300), ErrorId::invalid_override);
    EXPECT_EQ(rig.factors(1), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().set_position, 300);
}

// The slowest that is taken, with the smallest factors that are: no number is refused by the planner, and the axis goes on from it.
TEST(AxisOverride, TheLeastOfEverythingStillHasAPlan) {
    for (const double share : {1e-9, 3e-9, 1e-6}) {
        Rig rig;
        rig.power_on();
        auto slow = absolute(300, 100 * share);
        slow.acceleration = slow.deceleration = 1000 * share;
        slow.jerk = 1000 * share;
        rig.accept(at_velocity(60));
        rig.run(500);
        rig.accept(slow);
        for (const double factor : {1.0, share, 0.5}) {
            ASSERT_EQ(rig.axis.set(Override{factor, share, share}, Owner::program), ErrorId::none);
            rig.run(20);
            ASSERT_NE(rig.view().state, AxisState::ErrorStop) << share << " " << factor;
        }
        rig.accept(halt());
        rig.run(500);
        EXPECT_NE(rig.view().state, AxisState::ErrorStop);
    }
}

}  // namespace
}  // namespace taktwerk::axes::test

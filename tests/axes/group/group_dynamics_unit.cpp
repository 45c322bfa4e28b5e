// How fast a group's way is gone: factors of acceleration and jerk, limits of one direction, the velocity of a corner.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct Most {
    double velocity = 0, acceleration = 0, braking = 0, jerk = 0;
};
/// To the end of this command; what the first member does, which the rig sees in each cycle.
Most most_until_done(GroupRig& rig, CommandId id) {
    Most most;
    double before = rig.axis(0).set_acceleration;
    EXPECT_TRUE(rig.until(
        [&] {
            const auto& axis = rig.axis(0);
            most.velocity = std::max(most.velocity, std::abs(axis.set_velocity));
            most.acceleration = std::max(most.acceleration, axis.set_acceleration);
            most.braking = std::max(most.braking, -axis.set_acceleration);
            most.jerk = std::max(most.jerk, std::abs(axis.set_acceleration - before) / to_seconds(GroupRig::cycle));
            before = axis.set_acceleration;
            return rig.status(id) == CommandStatus::done;
        },
        20'000));
    return most;
}

// G-070. 1000 u/s2 and 10,000 u/s3: a quarter of the one, or half of the other, and the rest as it is.
TEST(GroupDynamics, FactorsOfAccelerationAndJerkHoldFromTheFirstCycleOn) {
    GroupRig quarter(1), half(1);
    quarter.enable();
    half.enable();
    ASSERT_EQ(quarter.set(Override{1, 0.25, 1}), ErrorId::none);
    ASSERT_EQ(half.set(Override{1, 1, 0.5}), ErrorId::none);

    const auto slow = most_until_done(quarter, quarter.give(line({100}, 100)).id);
    const auto soft = most_until_done(half, half.give(line({100}, 100)).id);

    EXPECT_LE(slow.acceleration, 250 * (1 + 1e-6));
    EXPECT_LE(slow.braking, 250 * (1 + 1e-6));
    EXPECT_GT(std::min(slow.acceleration, slow.braking), 245);
    EXPECT_LE(soft.jerk, 5000 * (1 + 1e-3));
    EXPECT_GT(soft.jerk, 4800);
    EXPECT_GT(soft.acceleration, 600) << "its acceleration is as it was: 5000 u/s3 come to 707 u/s2 up to 100 u/s";
}

// Half from the program and six tenths from the operator are three tenths, each counted once.
TEST(GroupDynamics, TheOperatorsFactorMultipliesTheProgramsOnce) {
    GroupRig rig(1);
    rig.enable();
    ASSERT_EQ(rig.set(Override{0.5, 1, 1}), ErrorId::none);
    ASSERT_EQ(rig.groups[0].set_operators_override(0.6), ErrorId::none);

    const auto most = most_until_done(rig, rig.give(line({50}, 100)).id);

    EXPECT_LE(most.velocity, 30 * (1 + 1e-6));
    EXPECT_GT(most.velocity, 29.5);
}

// G-071. In a cruise: what is left of the way is braked for with the new factor.
TEST(GroupDynamics, AFactorThatIsLoweredOnTheWayHoldsForTheRestOfIt) {
    GroupRig rig(1);
    rig.enable();
    const auto move = rig.give(line({200}, 100));
    ASSERT_TRUE(rig.until([&] { return rig.point()[0] > 60; }, 5000));
    ASSERT_EQ(rig.set(Override{1, 0.3, 1}), ErrorId::none);

    const auto most = most_until_done(rig, move.id);

    EXPECT_LE(most.braking, 300 * (1 + 1e-6));
    EXPECT_GT(most.braking, 290);
}

// A path turns: what is allowed in one direction only is kept in both.
TEST(GroupDynamics, TheSlowerDirectionHoldsForBoth) {
    for (const bool backwards : {false, true}) {
        auto axis = group_axis("x");
        (backwards ? axis.limits.negative : axis.limits.positive) = {.velocity = 40, .acceleration = 300, .deceleration = 500};
        GroupRig rig({axis});
        rig.enable();
        for (const double to : {60.0, 0.0}) {
            const auto most = most_until_done(rig, rig.give(line({to}, 100)).id);
            EXPECT_LE(most.velocity, 40 * (1 + 1e-6)) << to;
            EXPECT_GT(most.velocity, 39.5) << to;
            EXPECT_LE(std::max(most.acceleration, most.braking), 300 * (1 + 1e-6)) << to;
        }
    }
}

// G-049, G-059. 60 u/s before a corner and 20 behind it, or the other way round: in the middle of the curve it is the one that BufferMode names. A curve of 10 u about 90
// degrees could be passed at 80 u/s.
TEST(GroupDynamics, ACornerIsPassedAtTheVelocityThatItsBufferModeNames) {
    const auto in_the_middle = [](double before, double behind, MC_BufferMode mode) {
        GroupRig rig(2);
        rig.enable();
        (void)rig.give(line({60, 0}, before));
        auto next = line({60, 60}, behind, mode);
        next.transition = mcTMCornerDistance;
        next.transition_parameter = 10;
        const auto second = rig.give(next);
        double velocity = 0;
        EXPECT_TRUE(rig.until(
            [&] {
                const auto p = rig.point();
                if (velocity == 0 && 60 - p[0] <= p[1]) velocity = rig.view().path_velocity;
                return rig.status(second.id) == CommandStatus::done;
            },
            20'000));
        return velocity;
    };
    for (const auto mode : {mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh})
        for (const bool first_is_fast : {true, false}) {
            const double before = first_is_fast ? 60 : 20, behind = first_is_fast ? 20 : 60;
            const double named = mode == mcBlendingLow ? 20 : mode == mcBlendingPrevious ? before : mode == mcBlendingNext ? behind : 60;
            const double velocity = in_the_middle(before, behind, mode);
            EXPECT_LE(velocity, named * (1 + 1e-6)) << mode << ' ' << before;
            EXPECT_GT(velocity, 0.8 * named) << mode << ' ' << before;
        }
}

}  // namespace
}  // namespace taktwerk::axes::test

// How the joint of two motions is passed: curves whose size velocities decide, reversals, joints between paths of axes and of poses. By hand; the rig asserts limits and continuity
// of every member in every cycle.

#include <algorithm>
#include <cmath>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// Of a curve that begins d in front of a right angle, its middle is 7/32 sqrt(2) d from that (docs/motion/path.md).
const double middle_of_right_angle = 7.0 / 32 * std::sqrt(2.0);

GroupCommand rounded(GroupCommand command, MC_TransitionMode transition, double parameter, PathDynamics dynamics) {
    command.transition = transition;
    command.transition_parameter = parameter;
    command.buffer_mode = mcBlendingHigh;
    command.dynamics = dynamics;
    return command;
}

struct CornerRun {
    double nearest = 1e9;  ///< to the corner (60, 0)
    double leaves = 0;     ///< distance of the last set-point on the first line from it
    double slowest = 1e9;  ///< on the curve
    double sharpest = 0;   ///< acceleration on it
    std::vector<JointVector> curve;
};
/// (0, 0) to (60, 0) to (60, 60), both with these dynamics.
CornerRun round_corner(MC_TransitionMode transition, double parameter, PathDynamics dynamics, const Override& factors = {}) {
    std::vector<AxisConfig> axes;
    for (const char* name : {"x", "y"})  // that no member limits what the path asks for
        axes.push_back(group_axis(name, {.velocity = 1000, .acceleration = 1e5, .deceleration = 1e5, .jerk = 1e8}));
    GroupRig rig(axes);
    rig.enable();
    EXPECT_EQ(rig.set(factors), ErrorId::none);
    auto first = line({60, 0}, 0);
    first.dynamics = dynamics;
    (void)rig.give(first);
    const auto second = rig.give(rounded(line({60, 60}, 0), transition, parameter, dynamics));
    CornerRun run;
    EXPECT_TRUE(rig.until(
        [&] {
            const auto p = rig.point();
            const double off = std::hypot(p[0] - 60, p[1]);
            run.nearest = std::min(run.nearest, off);
            if (p[1] == 0) run.leaves = 60 - p[0];
            if (p[1] > 0 && p[0] < 60) {
                run.slowest = std::min(run.slowest, rig.view().path_velocity);
                run.sharpest = std::max(run.sharpest, std::hypot(rig.axis(0).set_acceleration, rig.axis(1).set_acceleration));
                run.curve.push_back(p);
            }
            return rig.status(second.id) == CommandStatus::done;
        },
        200'000));
    return run;
}

// G-053: braking from 50 u/s with 500 u/s2 and 5000 u/s3 takes v^2/2a + v a/2j = 2.5 + 2.5 = 5 u: with factor 1 the curve begins there, with 0.5 at half of that. What
// is commanded counts: an override changes nothing.
TEST(GroupCorner, StartVelocityBeginsWhereBrakingWould) {
    constexpr PathDynamics dynamics{50, 500, 500, 5000};
    for (const double factor : {1.0, 0.5}) {
        const auto run = round_corner(mcTMStartVelocity, factor, dynamics);
        EXPECT_NEAR(run.nearest, middle_of_right_angle * 5 * factor, 2e-3) << factor;
        EXPECT_GE(run.leaves, 5 * factor - 0.06) << "it is on the line until then; " << factor;
        EXPECT_LE(run.leaves, 5 * factor + 0.06);
        for (const Override& factors : {Override{.velocity = 0.2}, Override{.velocity = 0.5, .acceleration = 0.25, .jerk = 0.1}}) {
            const auto slow = round_corner(mcTMStartVelocity, factor, dynamics, factors);
            EXPECT_NEAR(slow.nearest, middle_of_right_angle * 5 * factor, 1e-3) << "at every override " << factors.acceleration;
        }
    }
    // The slower of both decides: 25 u/s do not reach 500 u/s2, 25 sqrt(25/5000) = 1.7678.
    EXPECT_NEAR(round_corner(mcTMStartVelocity, 1, {25, 500, 500, 5000}).nearest, middle_of_right_angle * 25 * std::sqrt(0.005), 1e-3);
}

// Nor does the ramp of an interruption, in which the later move comes: what is commanded counts.
TEST(GroupCorner, ASoftInterruptionChangesNoCurve) {
    for (const auto transition : {mcTMStartVelocity, mcTMConstantVelocity}) {
        constexpr PathDynamics dynamics{50, 500, 500, 5000};
        std::vector<double> nearest;
        for (const bool interrupted : {false, true}) {
            std::vector<AxisConfig> axes;
            for (const char* name : {"x", "y"})
                axes.push_back(group_axis(name, {.velocity = 1000, .acceleration = 1e5, .deceleration = 1e5, .jerk = 1e8}));
            GroupRig rig(axes);
            rig.enable();
            auto first = line({200, 0}, 0);
            first.dynamics = dynamics;
            (void)rig.give(first);
            rig.run(300);
            if (interrupted) {
                const auto stop = rig.give(simply(GroupCommandKind::interrupt, {.deceleration = 100, .jerk = 1000}));
                ASSERT_TRUE(rig.until([&] { return rig.status(stop.id) == CommandStatus::done; }, 5000));
                ASSERT_LT(rig.point()[0], 60);
            }
            const auto second = rig.give(rounded(line({200, 60}, 0), transition, 1, dynamics));
            rig.run(5);
            if (interrupted) (void)rig.give(simply(GroupCommandKind::resume));
            double least = 1e9;
            ASSERT_TRUE(rig.until(
                [&] {
                    least = std::min(least, std::hypot(rig.point()[0] - 200, rig.point()[1]));
                    return rig.status(second.id) == CommandStatus::done;
                },
                200'000));
            nearest.push_back(least);
        }
        EXPECT_NEAR(nearest[0], nearest[1], 2e-3);
    }
}

// G-054: a curve that can be passed at the commanded velocity with the commanded acceleration across it: there is no slower place, and the greatest acceleration is 500. A factor of a
// half halves the velocity that it is made for: v^2 k = a, so a quarter of the size.
TEST(GroupCorner, ConstantVelocityIsKeptOnItsCurve) {
    constexpr PathDynamics dynamics{50, 500, 500, 1e7};
    const auto whole = round_corner(mcTMConstantVelocity, 1, dynamics);
    EXPECT_GT(whole.slowest, 49);
    EXPECT_NEAR(whole.sharpest, 500, 15);
    const auto half = round_corner(mcTMConstantVelocity, 0.5, dynamics);
    EXPECT_NEAR(whole.nearest / half.nearest, 4, 0.05);
    for (const Override& factors : {Override{.velocity = 0.2}, Override{.velocity = 0.5, .acceleration = 0.25, .jerk = 0.1}}) {
        const auto slow = round_corner(mcTMConstantVelocity, 1, dynamics, factors);
        EXPECT_NEAR(slow.nearest, whole.nearest, 2e-3) << "at every override " << factors.acceleration;
    }
}

// G-060: there and back again there is no curve: it stands where it turns, exactly, and both are done.
TEST(GroupCorner, AReversalIsStoodAt) {
    for (const auto transition : {mcTMCornerDistance, mcTMMaxCornerDeviation, mcTMStartVelocity, mcTMConstantVelocity}) {
        GroupRig rig(2);
        rig.enable();
        const auto first = rig.give(line({30, 40}, 50));
        const auto back = rig.give(rounded(line({0, 0}, 50), transition, 1, {.velocity = 50}));
        double furthest = 0, slowest = 1e9;
        ASSERT_TRUE(rig.until(
            [&] {
                const auto p = rig.point();
                EXPECT_NEAR(p[0] * 40, p[1] * 30, 1e-9);
                furthest = std::max(furthest, p[0]);
                if (p[0] > 29.999) slowest = std::min(slowest, rig.view().path_velocity);
                return rig.status(back.id) == CommandStatus::done;
            },
            5000));
        EXPECT_EQ(rig.status(first.id), CommandStatus::done);
        EXPECT_EQ(furthest, 30);
        EXPECT_EQ(slowest, 0);
    }
}

// G-060: a direct move and a line of the tool. Of a portal the axes are the tool's place, so the curve is the one between two lines: 5 from the corner, its middle at 7/32
// sqrt(2) 5. Control goes over in it, and nothing stands. Either way round.
TEST(GroupCorner, AMoveOfTheAxesAndALineOfTheToolAreBlended) {
    for (const bool direct_first : {true, false}) {
        GroupRig rig(3, cartesian_arm());
        rig.enable();
        auto one = line({60, 0, 0}, 50), two = rounded(line({60, 60, 0}, 50), mcTMCornerDistance, 5, {.velocity = 50});
        (direct_first ? one : two).kind = GroupCommandKind::direct_absolute;
        (direct_first ? two : one).frame = mcMCS;
        const auto first = rig.give(one), second = rig.give(two);
        double nearest = 1e9, slowest = 1e9;
        CornerPassed passed = CornerPassed::none;
        JointVector at_done{};
        ASSERT_TRUE(rig.until(
            [&] {
                const auto p = rig.point();
                nearest = std::min(nearest, std::hypot(p[0] - 60, p[1]));
                if (p[0] > 50 && p[1] < 10) slowest = std::min(slowest, rig.view().path_velocity);
                if (p[0] < 55) {
                    EXPECT_EQ(p[1], 0);
                }
                if (p[1] > 5) {
                    EXPECT_NEAR(p[0], 60, 1e-9);
                }
                if (at_done[0] == 0 && rig.status(first.id) == CommandStatus::done) at_done = p;
                if (rig.status(second.id) == CommandStatus::active) passed = rig.view().corner;
                return rig.status(second.id) == CommandStatus::done;
            },
            5000));
        EXPECT_NEAR(nearest, middle_of_right_angle * 5, 5e-3) << direct_first;
        EXPECT_GT(slowest, 5) << "no stop";
        EXPECT_NEAR(std::hypot(at_done[0] - 60, at_done[1]), nearest, 0.1) << "the first is done in the middle of the curve";
        EXPECT_EQ(passed, CornerPassed::as_asked);
        EXPECT_EQ(rig.point()[0], 60);
        EXPECT_EQ(rig.point()[1], 60);
    }
}

// The same with a deviation of 1: no point of it is further from the corner than that in its middle.
TEST(GroupCorner, OfAxesAndToolByItsDeviation) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    auto one = line({60, 0, 0}, 50), two = rounded(line({60, 60, 0}, 50), mcTMMaxCornerDeviation, 1, {.velocity = 50});
    one.kind = GroupCommandKind::direct_absolute;
    two.frame = mcMCS;
    (void)rig.give(one);
    const auto second = rig.give(two);
    double nearest = 1e9;
    ASSERT_TRUE(rig.until(
        [&] {
            nearest = std::min(nearest, std::hypot(rig.point()[0] - 60, rig.point()[1]));
            return rig.status(second.id) == CommandStatus::done;
        },
        5000));
    EXPECT_NEAR(nearest, 1, 5e-3);
}

constexpr double of_a_degree = 3.14159265358979323846 / 180;

/// Of two links of 200 and 150, by hand.
std::array<double, 2> tool_of_scara(const JointVector& q) {
    const double a = q[0] * of_a_degree, b = (q[0] + q[1]) * of_a_degree;
    return {200 * std::cos(a) + 150 * std::cos(b), 200 * std::sin(a) + 150 * std::sin(b)};
}

// G-060 through an arm that bends lines: a SCARA lifts over, direct, and goes down a line of the tool: in front of the curve the joints are on their line, behind it the
// tool is on its own, 20 mm from the corner each; the rig asserts what the joints can do in every cycle.
TEST(GroupCorner, AScaraGoesOverFromItsJointsToALine) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = of_a_degree;
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    GroupRig rig({group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)},
                 arm_of(description));
    rig.enable();
    constexpr JointVector begin{-30, 80, 0, 0}, corner{10, 60, 0, 0};
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = begin});
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    const auto at = tool_of_scara(corner);
    const auto first = rig.give({.kind = GroupCommandKind::direct_absolute, .target = corner});
    GroupCommand down = line_by({-60, 20, 0}, 150);
    down.frame = mcMCS;
    down.buffer_mode = mcBlendingHigh;
    down.transition = mcTMCornerDistance;
    down.transition_parameter = 20;
    const auto second = rig.give(down);
    double slowest = 1e9, furthest_line = 0;
    int on_line = 0, on_joints = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            const auto q = rig.point();
            const auto p = tool_of_scara(q);
            const double off = std::hypot(p[0] - at[0], p[1] - at[1]);
            if (rig.status(first.id) == CommandStatus::active && off > 20.5) {
                ++on_joints;
                EXPECT_NEAR((q[0] - begin[0]) / 40, (begin[1] - q[1]) / 20, 1e-9) << "on the joints' line";
            }
            if (rig.status(first.id) == CommandStatus::done && off > 20.5) {
                ++on_line;
                furthest_line = std::max(furthest_line, std::abs((p[0] - at[0]) * 20 + (p[1] - at[1]) * 60) / std::hypot(60, 20));
            }
            if (off < 20) slowest = std::min(slowest, std::hypot(rig.axis(0).set_velocity, rig.axis(1).set_velocity));
            return rig.status(second.id) == CommandStatus::done || rig.status(second.id) == CommandStatus::error;
        },
        9000));
    EXPECT_EQ(rig.status(second.id), CommandStatus::done) << static_cast<int>(rig.error_of(second.id));
    EXPECT_GT(on_joints, 50);
    EXPECT_GT(on_line, 50);
    EXPECT_LT(furthest_line, 1e-9);
    EXPECT_GT(slowest, 5) << "degrees/s: it does not stand at the corner";
    const auto end = tool_of_scara(rig.point());
    EXPECT_NEAR(end[0], at[0] - 60, 1e-9);
    EXPECT_NEAR(end[1], at[1] + 20, 1e-9);
}

// G-060 with mcTMStartVelocity: each side where it would brake, in its own unit. A line of the tool at 50 mm/s, and then one joint alone that says no velocity: 360 degrees/s, 3600, 72000 are
// what its axis has, so braking from that takes v^2/2a + v a/2j = 18 + 9 = 27 degrees, and the curve half of it at a factor of 0.5. Behind it all other joints stand.
TEST(GroupCorner, WhatAMoveOfTheAxesLeavesOutItsAxesSay) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = of_a_degree;
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    GroupRig rig({group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)},
                 arm_of(description));
    rig.enable();
    constexpr JointVector corner{-60, 60, 0, 0}, end{60, 60, 0, 0};
    const auto go = [&](GroupCommand command) {
        const auto given = rig.give(command);
        EXPECT_TRUE(rig.until([&] { return rig.status(given.id) == CommandStatus::done; }, 9000));
    };
    go({.kind = GroupCommandKind::direct_absolute, .target = corner});
    auto away = line_by({-60, 40, 0}, 100);
    away.frame = mcMCS;
    go(away);
    auto back = line_by({60, -40, 0}, 0);
    back.frame = mcMCS;
    back.dynamics = {50, 500, 500, 5000};
    (void)rig.give(back);
    const auto second =
        rig.give(rounded({.kind = GroupCommandKind::direct_absolute, .target = end}, mcTMStartVelocity, 0.5, PathDynamics{}));
    double joins = 0;
    CornerPassed passed = CornerPassed::none;
    ASSERT_TRUE(rig.until(
        [&] {
            if (rig.status(second.id) == CommandStatus::active) passed = rig.view().corner;
            if (std::abs(rig.point()[1] - 60) > 1e-6) joins = rig.point()[0] + 60;
            return rig.status(second.id) == CommandStatus::done;
        },
        9000));
    EXPECT_EQ(passed, CornerPassed::as_asked);
    EXPECT_NEAR(joins, 13.5, 0.5) << "the last set-point in front of where it joins the joints' line";
}

// G-060: what became of the curve is shown while the command runs: as it was asked for, smaller, or stood at.
TEST(GroupCorner, ADegradationIsVisible) {
    const auto seen = [](const JointVector& second, double distance) {
        GroupRig rig(2);
        rig.enable();
        (void)rig.give(line({30, 0}, 50));
        const auto next = rig.give(rounded(line(second, 50), mcTMCornerDistance, distance, {.velocity = 50}));
        CornerPassed passed = CornerPassed::none;
        EXPECT_TRUE(rig.until(
            [&] {
                if (rig.status(next.id) == CommandStatus::active) passed = rig.view().corner;
                return rig.status(next.id) == CommandStatus::done;
            },
            5000));
        return passed;
    };
    EXPECT_EQ(seen({30, 30}, 5), CornerPassed::as_asked);
    EXPECT_EQ(seen({30, 6}, 5), CornerPassed::smaller) << "half of 6 is there";
    EXPECT_EQ(seen({0, 0}, 5), CornerPassed::stood) << "a reversal";
    EXPECT_EQ(seen({30, 30}, 0), CornerPassed::none);
}

}  // namespace
}  // namespace taktwerk::axes::test

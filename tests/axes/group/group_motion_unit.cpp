// A group moves its axes: straight lines, the queue, halts and stops, override, interruption. On fake drives, 1 ms a cycle.

#include <gtest/gtest.h>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

/// A plan stays below what limits it, and comes within a hundredth of it (docs/motion/path.md).
void expect_just_below(double velocity, double limit) {
    EXPECT_LE(velocity, limit);
    EXPECT_GE(velocity, 0.99 * limit);
}

// G-012, G-013, G-033 of one move. The way is 50 u (30, 40 in the axes) at 50 u/s: 30 and 40 u/s.
TEST(GroupMotion, ALineInTheAxesIsStraightAndAllMembersAreSynchronized) {
    GroupRig rig(3);
    rig.enable();
    rig.run(2);
    EXPECT_EQ(rig.view().state, GroupStandby);

    const auto from = rig.path.size();
    const auto move = rig.give(line({30, 40, 0}, 50));
    ASSERT_EQ(move.error, ErrorId::none);
    EXPECT_EQ(rig.view().state, GroupMoving);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig.axis(i).state, AxisState::SynchronizedMotion) << "the idle one too, " << i;
    rig.run(500);
    expect_just_below(rig.view().set_velocity[0], 30);
    expect_just_below(rig.view().set_velocity[1], 40);
    expect_just_below(rig.view().path_velocity, 50);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 2000));
    EXPECT_EQ(rig.axis(0).set_position, 30);
    EXPECT_EQ(rig.axis(1).set_position, 40);
    EXPECT_EQ(rig.axis(2).set_position, 0);
    EXPECT_EQ(rig.view().state, GroupMoving) << "Standby comes one cycle after the last set-point (G-012)";
    rig.step();
    EXPECT_EQ(rig.view().state, GroupStandby);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig.axis(i).state, AxisState::Standstill) << i;
    EXPECT_LE(rig.deviation({0, 0, 0}, {30, 40, 0}, from), 1e-9 * 50);
}

// O-3 of our oracles: the planner of one axis is the exact optimum; a line of one axis takes within a hundredth as long, and two cycles.
TEST(GroupMotion, ALineOfOneAxisIsAsFastAsTheAxisOwnMove) {
    for (const double target : {37.5, 2.0, 0.05, 99.0}) {
        GroupRig rig(1), alone(1);
        rig.enable();
        rig.run(2);
        alone.run(2);
        const auto move = rig.give(line({target}, 60));
        ASSERT_EQ(move.error, ErrorId::none);
        Submitted own;
        alone.step(
            [&] { own = alone.axes[0].submit({.kind = CommandKind::move_absolute, .position = target, .velocity = 60}, Owner::program); });
        int cycles = 0, exact = 0;
        ASSERT_TRUE(rig.until([&] { return ++cycles, rig.status(move.id) == CommandStatus::done; }, 4000));
        ASSERT_TRUE(alone.until([&] { return ++exact, alone.axis(0).status(own.id) == CommandStatus::done; }, 4000));
        EXPECT_EQ(rig.axis(0).set_position, target);
        EXPECT_LE(cycles, exact * 1.01 + 3) << target;
        EXPECT_GE(cycles, exact) << target;
    }
}

// G-030, G-034: limits of the axes along the way. y may go 20 u/s: a way of 3:4 goes 25 u/s, and y's acceleration of 400 leaves 500 on the path.
TEST(GroupMotion, TheSlowestMemberHoldsTheWayDown) {
    GroupRig rig({group_axis("x"), group_axis("y", {.velocity = 20, .acceleration = 400, .deceleration = 400, .jerk = 8000})});
    rig.enable();
    ASSERT_EQ(rig.give(line({30, 40}, 1000)).error, ErrorId::none);
    double fastest = 0, hardest = 0;
    for (int i = 0; i < 3000; ++i) {
        rig.step();
        fastest = std::max(fastest, rig.view().path_velocity);
        hardest = std::max(hardest, rig.view().path_acceleration);
        if (i == 400) {
            EXPECT_EQ(rig.view().limiter, PathLimiter::axis);
            EXPECT_EQ(rig.view().limiting_place, 1);
        }
    }
    expect_just_below(fastest, 25);
    EXPECT_LE(hardest, 500 * (1 + 1e-9));
    EXPECT_GE(hardest, 450);  // sqrt(25 * 10000) = 500 would be reached just so with y's jerk of 8000 / 0.8
    EXPECT_EQ(rig.axis(1).set_position, 40);
}

// G-047, G-061, G-062: the set-point stands at P1, exactly; the next one starts in the following cycle. G-036: a buffered distance counts from the end before.
TEST(GroupMotion, BufferedMovesMeetAtTheirEnds) {
    GroupRig rig(2);
    rig.enable();
    const auto first = rig.give(line({20, 10}, 80));
    const auto second = rig.give(line_by({-5, 30}, 80, mcBuffered));
    const auto third = rig.give(line({0, 0}, 80, mcBlendingHigh));  // v2.0 lets it act as buffered
    ASSERT_EQ(third.error, ErrorId::none);
    EXPECT_EQ(rig.status(second.id), CommandStatus::queued);
    ASSERT_TRUE(rig.until([&] { return rig.status(first.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 20);
    EXPECT_EQ(rig.point()[1], 10);
    rig.step();
    EXPECT_EQ(rig.status(second.id), CommandStatus::active) << "G-061: one cycle later";
    EXPECT_NE(rig.point()[1], 10);
    ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 3000));
    EXPECT_NEAR(rig.point()[0], 15, 1e-12);
    EXPECT_NEAR(rig.point()[1], 40, 1e-12);
    ASSERT_TRUE(rig.until([&] { return rig.status(third.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 0);
}

// G-045: nothing to do is Done in its turn, and what waits behind it begins in the same cycle.
TEST(GroupMotion, AMoveOfNoLengthIsDoneInItsTurn) {
    GroupRig rig(2);
    rig.enable();
    const auto nothing = rig.give(line({0, 0}, 10));
    EXPECT_EQ(rig.status(nothing.id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, GroupStandby);
}

// G-046: no velocity step; the old way is braked on, then the new one goes from there.
TEST(GroupMotion, AnAbortingMoveBrakesOnTheOldWayFirst) {
    GroupRig rig(2);
    rig.enable();
    const auto begun = rig.path.size();
    const auto first = rig.give(line({100, 0}, 80));
    const auto behind = rig.give(line({0, 0}, 80, mcBuffered));
    rig.run(300);
    const auto second = rig.give(line({0, 50}, 80));
    EXPECT_EQ(rig.status(first.id), CommandStatus::aborted);
    EXPECT_EQ(rig.status(behind.id), CommandStatus::aborted) << "U-05: waiting ones too";
    EXPECT_EQ(rig.status(second.id), CommandStatus::active);
    ASSERT_TRUE(rig.until([&] { return rig.view().set_velocity[1] != 0; }, 1000));
    EXPECT_LE(rig.deviation({0, 0}, {100, 0}, begun), 1e-2) << "but for the first cycle of the new way";
    const JointVector turn{rig.path[rig.path.size() - 2]};
    EXPECT_GT(turn[0], 10);
    const auto from = rig.path.size() - 1;
    ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 3000));
    EXPECT_LE(rig.deviation(turn, {0, 50}, from), 1e-9 * 100);
    EXPECT_EQ(rig.point()[1], 50);
}

// G-063, G-064, G-018: on the way, Stopping until Execute falls; nobody gets in.
TEST(GroupMotion, AStopStaysOnTheWayAndLocksTheGroup) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(400);
    expect_just_below(rig.view().path_velocity, 100);
    const auto stop = rig.give(simply(GroupCommandKind::stop, {.deceleration = 200}));
    EXPECT_EQ(rig.view().state, GroupStopping);
    EXPECT_EQ(rig.status(move.id), CommandStatus::aborted);
    EXPECT_EQ(rig.submit(line({0, 0}, 10)).error, ErrorId::state_forbids);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::halt)).error, ErrorId::state_forbids);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::interrupt)).error, ErrorId::state_forbids);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::stop)).error, ErrorId::state_forbids);
    EXPECT_EQ(rig.set(EnableGroup{}), ErrorId::state_forbids);
    EXPECT_EQ(rig.set(AddMember{{1}, 3}), ErrorId::state_forbids);
    rig.run(100);
    // 100 u/s with 200 u/s2: longer than 0.5 s.
    EXPECT_GT(rig.view().path_velocity, 50);
    ASSERT_TRUE(rig.until([&] { return rig.status(stop.id) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.view().path_velocity, 0);
    EXPECT_EQ(rig.view().state, GroupStopping);
    EXPECT_EQ(rig.axes[0].submit({.kind = CommandKind::move_absolute, .position = 0, .velocity = 1}, Owner::program).error,
              ErrorId::axis_grouped);
    rig.run(50);
    EXPECT_EQ(rig.view().state, GroupStopping);
    rig.groups.release_stop(GroupRig::ref, stop.id, Owner::program);
    rig.step();
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_LE(rig.deviation({0, 0}, {60, 80}, from), 1e-9 * 100);
}

// A stop that is too soft for what is left goes on to the end of the way, never beyond it.
TEST(GroupMotion, AStopNeverPassesTheEndOfTheWay) {
    GroupRig rig(2);
    rig.enable();
    ASSERT_EQ(rig.give(line({30, 40}, 100)).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().remaining_distance < 8; }, 2000));
    const auto stop = rig.give(simply(GroupCommandKind::stop, {.deceleration = 1}));
    double furthest = 0;
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        furthest = std::max(furthest, rig.point()[0]);
    }
    EXPECT_EQ(rig.status(stop.id), CommandStatus::done);
    EXPECT_LE(furthest, 30);
}

// G-018, G-065: GroupMoving until it stands; a command that comes meanwhile takes over.
TEST(GroupMotion, AHaltKeepsGroupMovingUntilItStands) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    ASSERT_EQ(rig.give(line({60, 80}, 100)).error, ErrorId::none);
    rig.run(300);
    const auto halt = rig.give(simply(GroupCommandKind::halt));
    EXPECT_EQ(rig.view().state, GroupMoving);
    ASSERT_TRUE(rig.until([&] { return rig.status(halt.id) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.view().path_velocity, 0);
    rig.step();
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_LE(rig.deviation({0, 0}, {60, 80}, from), 1e-9 * 100);
    const auto nothing = rig.give(simply(GroupCommandKind::halt));
    EXPECT_EQ(rig.status(nothing.id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, GroupStandby);
}

// The deceleration is the halt's, not that of the move that it ends (50 u/s2), softer and harder.
TEST(GroupMotion, AHaltBrakesWithItsOwnDeceleration) {
    for (const double asked : {20.0, 80.0}) {
        GroupRig rig(1);
        rig.enable();
        auto move = line({300}, 50);
        move.dynamics.deceleration = 50;
        move.dynamics.jerk = 10'000;
        ASSERT_EQ(rig.give(move).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.view().path_velocity > 49.9; }, 3000));
        rig.run(200);
        const auto halt = rig.give(simply(GroupCommandKind::halt, {.deceleration = asked, .jerk = 10'000}));
        double hardest = 0;
        const double from = rig.point()[0];
        ASSERT_TRUE(rig.until(
            [&] {
                hardest = std::max(hardest, -rig.view().path_acceleration);
                return rig.status(halt.id) == CommandStatus::done;
            },
            4000));
        EXPECT_LE(hardest, asked * (1 + 1e-6));
        EXPECT_GE(hardest, asked * 0.9);
        // By hand: v2/2a, and what passes until it begins: 60 ms at most.
        EXPECT_LE(rig.point()[0] - from, 1.05 * 50 * 50 / (2 * asked) + 0.06 * 50);
    }
}

// G-041: all axes begin and end together, and the places that they pass depend on start and target only.
TEST(GroupMotion, ADirectMoveIsOneLineOfAllAxes) {
    for (const double factor : {1.0, 0.2}) {
        GroupRig rig(
            {group_axis("x"), group_axis("y", {.velocity = 10, .acceleration = 50, .deceleration = 80, .jerk = 700}), group_axis("z")});
        rig.enable();
        const auto from = rig.path.size();
        ASSERT_EQ(rig.set(Override{factor, 1, 1}), ErrorId::none);
        const auto move = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {20, -5, 1}});
        rig.step();  // the planner's answer
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(rig.axis(i).set_velocity, 0) << i;
        int moving = 0;
        ASSERT_TRUE(rig.until(
            [&] {
                const bool x = rig.axis(0).set_velocity != 0, y = rig.axis(1).set_velocity != 0, z = rig.axis(2).set_velocity != 0;
                EXPECT_TRUE(x == y && y == z);
                moving += x ? 1 : 0;
                return rig.status(move.id) == CommandStatus::done;
            },
            20000));
        EXPECT_GT(moving, 100);
        EXPECT_LE(rig.deviation({0, 0, 0}, {20, -5, 1}, from), 1e-9 * 20);
        EXPECT_EQ(rig.point()[1], -5);
    }
}

// Where a run was, by the length of its way: the same whatever its speed was. G-071
TEST(GroupMotion, OverrideNeverChangesTheWay) {
    for (const double factor : {0.03, 0.37, 1.0}) {
        GroupRig rig(2);
        rig.enable();
        const auto from = rig.path.size();
        ASSERT_EQ(rig.set(Override{factor, 1, 1}), ErrorId::none);
        const auto move = rig.give(line({3, 4}, 10));
        rig.run(100);
        ASSERT_EQ(rig.set(Override{1, 0.5, 1}), ErrorId::none);
        rig.run(50);
        ASSERT_EQ(rig.set(Override{0.5, 1, 0.2}), ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 20000));
        EXPECT_LE(rig.deviation({0, 0}, {3, 4}, from), 1e-9 * 5) << factor;
        EXPECT_EQ(rig.point()[0], 3);
        for (std::size_t n = from + 1; n < rig.path.size(); ++n) EXPECT_GE(rig.path[n][0], rig.path[n - 1][0]) << "it never goes back";
    }
}

// G-070: 0 halts on the way, the state stays; factors beyond their range change nothing.
TEST(GroupMotion, AnOverrideOfZeroHoldsOnTheWay) {
    GroupRig rig(2);
    rig.enable();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    EXPECT_EQ(rig.set(Override{-0.1, 1, 1}), ErrorId::invalid_override);
    EXPECT_EQ(rig.set(Override{1.1, 1, 1}), ErrorId::invalid_override);
    EXPECT_EQ(rig.set(Override{1, 0, 1}), ErrorId::invalid_override);
    EXPECT_EQ(rig.set(Override{1, 1, 0}), ErrorId::invalid_override);
    EXPECT_EQ(rig.set(Override{0, 1, 1}), ErrorId::none);
    rig.run(500);
    EXPECT_EQ(rig.view().path_velocity, 0);
    EXPECT_EQ(rig.view().state, GroupMoving);
    EXPECT_EQ(rig.status(move.id), CommandStatus::active);
    const double held = rig.point()[0];
    EXPECT_LT(held, 60);
    EXPECT_EQ(rig.set(Override{0.5, 1, 1}), ErrorId::none);
    rig.run(300);
    expect_just_below(rig.view().path_velocity, 50);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 60);
    // G-009, G-070: kept over disabling.
    rig.step();
    ASSERT_EQ(rig.give(simply(GroupCommandKind::disable)).error, ErrorId::none);
    rig.enable();
    EXPECT_EQ(rig.view().override_factors, (Override{0.5, 1, 1}));
}

// G-070: a command that comes while the override is 0 waits where it is to begin, and goes when it is more.
TEST(GroupMotion, ACommandUnderAnOverrideOfZeroBeginsWhenItRises) {
    GroupRig rig(2);
    rig.enable();
    ASSERT_EQ(rig.set(Override{0, 1, 1}), ErrorId::none);
    const auto move = rig.give(line({6, 8}, 20));
    ASSERT_EQ(move.error, ErrorId::none);
    rig.run(200);
    EXPECT_EQ(rig.view().state, GroupMoving);
    EXPECT_EQ(rig.status(move.id), CommandStatus::active);
    EXPECT_EQ(rig.point()[0], 0);
    ASSERT_EQ(rig.set(Override{1, 1, 1}), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 2000));
    EXPECT_EQ(rig.point()[1], 8);
}

// G-071: less acceleration than the rest of the way needs waits; on a way there is no coming back.
TEST(GroupMotion, AFactorThatWouldPassTheEndWaits) {
    GroupRig rig(1);
    rig.enable();
    const auto move = rig.give(line({50}, 100));
    ASSERT_TRUE(rig.until([&] { return rig.view().path_acceleration < -500; }, 2000));  // braking at the end
    ASSERT_EQ(rig.set(Override{1, 0.05, 1}), ErrorId::none);
    double furthest = 0;
    for (int i = 0; i < 1000; ++i) {
        rig.step();
        furthest = std::max(furthest, rig.point()[0]);
    }
    EXPECT_EQ(rig.status(move.id), CommandStatus::done);
    EXPECT_EQ(furthest, 50);
}

// G-020: Done not earlier than Duration; the group keeps its axes meanwhile.
TEST(GroupMotion, AWaitHasItsPlaceBetweenMoves) {
    GroupRig rig(2);
    rig.enable();
    const auto first = rig.give(line({1, 1}, 50));
    GroupCommand pause{.kind = GroupCommandKind::wait, .buffer_mode = mcBuffered, .duration = 50500us};
    const auto wait = rig.give(pause);
    const auto last = rig.give(line({0, 0}, 50, mcBuffered));
    ASSERT_TRUE(rig.until([&] { return rig.status(first.id) == CommandStatus::done; }, 2000));
    const auto since = rig.path.size();
    ASSERT_TRUE(rig.until([&] { return rig.status(wait.id) == CommandStatus::done; }, 2000));
    EXPECT_EQ(rig.path.size() - since, 51u) << "50.5 ms are over at the end of the 51st cycle";
    EXPECT_EQ(rig.view().state, GroupMoving);
    EXPECT_EQ(rig.point()[0], 1);
    ASSERT_TRUE(rig.until([&] { return rig.status(last.id) == CommandStatus::done; }, 2000));
}

// G-066, G-067, G-068, G-069.
// In the last ramp a stop is the way that runs anyway: whatever holds there, and whenever, the command comes to its end, exactly.
TEST(GroupMotion, HeldAtAnyCycleOfItsLastRampItEndsWhereItWasToEnd) {
    int held = 0;
    for (int cycle = 500; cycle < 1200; cycle += 7) {
        for (const bool by_override : {true, false}) {
            GroupRig rig(2);
            rig.enable();
            const auto move = rig.give(line({60, 80}, 100));
            rig.run(cycle);
            if (rig.status(move.id) != CommandStatus::active) continue;
            ++held;
            if (by_override) {
                ASSERT_EQ(rig.set(Override{0, 1, 1}), ErrorId::none);
                rig.run(600);
                ASSERT_EQ(rig.set(Override{1, 1, 1}), ErrorId::none);
            } else {
                (void)rig.give(simply(GroupCommandKind::interrupt));
                rig.run(600);
                if (rig.status(move.id) == CommandStatus::queued) (void)rig.give(simply(GroupCommandKind::resume));
            }
            ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000))
                << cycle << (by_override ? " override" : " interrupt");
            EXPECT_EQ(rig.point()[0], 60) << cycle;
            EXPECT_EQ(rig.point()[1], 80) << cycle;
        }
    }
    EXPECT_GT(held, 40);
}

// What a person has interrupted no program goes on with; it ends with the interruption.
TEST(GroupMotion, WhatAPersonHoldsIsNotGoneOnWith) {
    GroupRig rig(2);
    rig.enable();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    EXPECT_EQ(rig.groups[0].hold(), ErrorId::none);
    EXPECT_TRUE(rig.view().held) << "while it brakes, too";
    ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
    const auto place = rig.point();
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::held_by_person);
    rig.run(500);
    EXPECT_EQ(rig.point(), place);
    EXPECT_EQ(rig.groups[0].release_hold(), ErrorId::none);
    EXPECT_FALSE(rig.view().held);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.groups[0].release_hold(), ErrorId::nothing_interrupted);
}

// Nor does one begin anything: near the end of a way it is over where it is held, and its program has the next one ready. That waits for the person; so do those that take
// each other over meanwhile. A stop and a halt do not let it go, and what cannot wait is refused.
TEST(GroupMotion, WhatAPersonHoldsNothingNewMoves) {
    GroupRig rig(2);
    rig.enable();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    EXPECT_EQ(rig.groups[0].hold(), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
    const auto place = rig.point();
    const auto next = rig.give(line({10, 10}, 100)), over = rig.give(line({20, 10}, 100));
    EXPECT_EQ(rig.status(move.id), CommandStatus::aborted);
    EXPECT_EQ(rig.status(next.id), CommandStatus::aborted);
    rig.run(500);
    EXPECT_EQ(rig.point(), place);
    EXPECT_EQ(rig.status(over.id), CommandStatus::queued);
    EXPECT_TRUE(rig.view().held);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::home)).error, ErrorId::held_by_person);

    const auto halt = rig.give(simply(GroupCommandKind::halt));
    EXPECT_EQ(rig.status(halt.id), CommandStatus::done);
    EXPECT_EQ(rig.status(over.id), CommandStatus::aborted);
    const auto stop = rig.give(simply(GroupCommandKind::stop));
    rig.run(10);
    rig.groups[0].release_stop(stop.id);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 100));
    EXPECT_TRUE(rig.view().held);
    const auto last = rig.give(line({5, 5}, 100));
    rig.run(500);
    EXPECT_EQ(rig.point(), place);

    EXPECT_EQ(rig.groups[0].release_hold(), ErrorId::none);
    EXPECT_FALSE(rig.view().interrupted) << "it begins";
    ASSERT_TRUE(rig.until([&] { return rig.status(last.id) == CommandStatus::done; }, 3000));
    EXPECT_NEAR(rig.point()[0], 5, 1e-9);
}

// What its program had interrupted itself, and a person held, is the program's again; a new command of it has ended that, and begins when he lets go.
TEST(GroupMotion, WhatWaitedForAPersonBeginsWhoeverHadInterrupted) {
    for (const bool commands : {true, false}) {
        GroupRig rig(2);
        rig.enable();
        (void)rig.give(line({60, 80}, 100));
        rig.run(300);
        (void)rig.give(simply(GroupCommandKind::interrupt));
        ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
        EXPECT_EQ(rig.groups[0].hold(), ErrorId::none);
        const auto place = rig.point();
        if (commands) (void)rig.give(line({10, 10}, 100));
        else (void)rig.give(line({10, 10}, 100, mcBuffered));
        rig.run(300);
        EXPECT_EQ(rig.point(), place);
        EXPECT_EQ(rig.groups[0].release_hold(), ErrorId::none);
        EXPECT_EQ(rig.view().interrupted, !commands);
        rig.run(3000);
        if (commands) {
            EXPECT_NEAR(rig.point()[0], 10, 1e-9);
        } else {
            EXPECT_EQ(rig.point(), place);
        }
    }
}

// Whoever stops a group ends what it was interrupted in, while it still brakes for that and when it stands: nothing goes on behind a stop.
TEST(GroupMotion, AHaltEndsWhatIsInterrupted) {
    for (const bool stands : {true, false}) {
        GroupRig rig(2);
        rig.enable();
        const auto move = rig.give(line({60, 80}, 100));
        const auto waits = rig.give(line({60, 0}, 100, mcBuffered));
        rig.run(300);
        (void)rig.give(simply(GroupCommandKind::interrupt));
        if (stands) ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
        else rig.run(3);
        rig.groups[0].halt();
        EXPECT_EQ(rig.status(move.id), CommandStatus::aborted) << stands;
        EXPECT_EQ(rig.status(waits.id), CommandStatus::aborted) << stands;
        ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 1000)) << stands;
        EXPECT_FALSE(rig.view().interrupted);
        EXPECT_NEAR(rig.point()[1] * 3, rig.point()[0] * 4, 1e-9) << "on its way";
        EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::nothing_interrupted);
        ASSERT_EQ(rig.submit(line({0, 0}, 100)).error, ErrorId::none);
    }
}

TEST(GroupMotion, AnInterruptedWayGoesOnFromWhereItStopped) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    const auto move = rig.give(line({60, 80}, 100));
    const auto next = rig.give(line({60, 0}, 100, mcBuffered));
    rig.run(300);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::nothing_interrupted);
    const auto interrupt = rig.give(simply(GroupCommandKind::interrupt));
    EXPECT_EQ(rig.view().state, GroupMoving) << "G-018";
    EXPECT_EQ(rig.status(move.id), CommandStatus::queued) << "Busy without Active";
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::interrupt)).error, ErrorId::state_forbids);
    ASSERT_TRUE(rig.until([&] { return rig.status(interrupt.id) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_TRUE(rig.view().interrupted);
    EXPECT_EQ(rig.axis(0).state, AxisState::Standstill);
    EXPECT_EQ(rig.status(next.id), CommandStatus::queued);
    const auto place = rig.point();
    rig.run(100);

    // Away and back by hand.
    ASSERT_EQ(rig.axes[0].submit({.kind = CommandKind::move_relative, .position = -1, .velocity = 20}, Owner::program).error,
              ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Standstill && rig.axis(0).set_position < place[0]; }, 1000));
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::not_at_interruption);
    ASSERT_EQ(rig.axes[0].submit({.kind = CommandKind::move_absolute, .position = place[0], .velocity = 20}, Owner::program).error,
              ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::not_at_interruption);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Standstill; }, 1000));
    const auto back = rig.path.size();

    const auto resume = rig.give(simply(GroupCommandKind::resume));
    ASSERT_EQ(resume.error, ErrorId::none);
    EXPECT_EQ(rig.view().state, GroupMoving);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    EXPECT_LE(rig.deviation({0, 0}, {60, 80}, back), 1e-9 * 100);
    EXPECT_LE(std::abs(rig.point()[1] - 80), 0);
    (void)from;
    ASSERT_TRUE(rig.until([&] { return rig.status(next.id) == CommandStatus::done; }, 3000));
}

// G-069: a new aborting command ends what was interrupted; a buffered one waits behind it.
TEST(GroupMotion, ANewMotionEndsAnInterruption) {
    GroupRig rig(2);
    rig.enable();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    ASSERT_EQ(rig.give(simply(GroupCommandKind::interrupt)).error, ErrorId::none);
    rig.run(500);
    const auto waits = rig.give(line({1, 1}, 100, mcBuffered));
    rig.run(100);
    EXPECT_EQ(rig.status(waits.id), CommandStatus::queued);
    EXPECT_EQ(rig.view().state, GroupStandby);
    const auto other = rig.give(line({0, 0}, 100));
    EXPECT_EQ(rig.status(move.id), CommandStatus::aborted);
    EXPECT_EQ(rig.status(waits.id), CommandStatus::aborted);
    EXPECT_FALSE(rig.view().interrupted);
    ASSERT_TRUE(rig.until([&] { return rig.status(other.id) == CommandStatus::done; }, 3000));
}

// G-006: MCS on the identity is ACS; what the group has no kinematics for is refused.
TEST(GroupMotion, FramesNeedAKinematics) {
    GroupRig plain(3), cartesian(3, cartesian_arm()), wide(4, cartesian_arm());
    for (auto* rig : {&plain, &cartesian, &wide}) rig->enable();
    auto in_machine = line({3, 4, 5}, 10);
    in_machine.frame = mcMCS;
    EXPECT_EQ(plain.submit(in_machine).error, ErrorId::no_kinematics);
    EXPECT_EQ(wide.submit(in_machine).error, ErrorId::no_kinematics) << "a fourth axis has no place in X, Y, Z";
    auto of_flange = in_machine;  // flange or fixture: nobody knows
    of_flange.frame = mcFCS;
    EXPECT_EQ(cartesian.submit(of_flange).error, ErrorId::not_supported);
    auto turned = in_machine;
    turned.target[4] = 0.1;
    EXPECT_EQ(cartesian.submit(turned).error, ErrorId::out_of_reach) << "X, Y, Z turn nothing";
    const auto from = cartesian.path.size();
    const auto move = cartesian.give(in_machine);
    ASSERT_EQ(move.error, ErrorId::none);
    ASSERT_TRUE(cartesian.until([&] { return cartesian.status(move.id) == CommandStatus::done; }, 5000));
    EXPECT_LE(cartesian.deviation({0, 0, 0}, {3, 4, 5}, from), 1e-9);
    EXPECT_EQ(cartesian.point()[2], 5);
}

// G-025, G-026: bounded, never a silent drop.
TEST(GroupMotion, AFullQueueRefusesTheNewOne) {
    GroupRig rig(1);
    rig.enable();
    ASSERT_EQ(rig.give(line({1}, 1)).id, 1u);
    for (std::size_t i = 0; i < GroupView::most_waiting; ++i) EXPECT_EQ(rig.submit(line_by({0.1}, 1, mcBuffered)).error, ErrorId::none);
    EXPECT_EQ(rig.submit(line_by({0.1}, 1, mcBuffered)).error, ErrorId::queue_full);
    EXPECT_EQ(rig.view().queued_count, 16);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 20000));
    EXPECT_NEAR(rig.point()[0], 2.6, 1e-9) << "none was lost";
}

// G-044, G-024: both ends inside is the whole line inside; a target beyond moves nothing, and a buffered relative one ends with its own error.
TEST(GroupMotion, SoftwareLimitsOfTheAxesHoldOfTheWholeWay) {
    auto limited = group_axis("x");
    limited.limits.position_max = 10;
    limited.limits.position_min = -10;
    limited.homing.kind = HomingKind::set_here;
    GroupRig rig({limited, group_axis("y")});
    ASSERT_EQ(rig.axes[0].submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).homed && rig.axis(0).state == AxisState::Standstill; }, 100));
    rig.enable();
    EXPECT_EQ(rig.submit(line({10.001, 0}, 10)).error, ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.view().state, GroupStandby);
    const auto there = rig.give(line({10, 5}, 50));
    const auto beyond = rig.give(line_by({1, 0}, 50, mcBuffered));
    const auto back = rig.give(line({0, 0}, 50, mcBuffered));
    ASSERT_TRUE(rig.until([&] { return rig.status(back.id) == CommandStatus::done; }, 5000));
    EXPECT_EQ(rig.status(there.id), CommandStatus::done);
    EXPECT_EQ(rig.status(beyond.id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(beyond.id), ErrorId::beyond_software_limit);
}

TEST(GroupMotion, NumbersThatAreNoneAreRefused) {
    GroupRig rig(2);
    rig.enable();
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(rig.submit(line({none, 0}, 10)).error, ErrorId::invalid_position);
    EXPECT_EQ(rig.submit(line({1, 0}, none)).error, ErrorId::invalid_velocity);
    auto jerky = line({1, 0}, 1);
    jerky.dynamics.jerk = std::numeric_limits<double>::infinity();
    EXPECT_EQ(rig.submit(jerky).error, ErrorId::invalid_dynamics);
    auto curved = line({1, 0}, 1);
    curved.transition = mcTMCornerDistance;
    curved.transition_parameter = -1;
    EXPECT_EQ(rig.submit(curved).error, ErrorId::invalid_parameter);
    curved.transition_parameter = none;
    EXPECT_EQ(rig.submit(curved).error, ErrorId::invalid_parameter);
    curved.transition = mcTMStartVelocity;
    curved.transition_parameter = 1.5;
    EXPECT_EQ(rig.submit(curved).error, ErrorId::invalid_parameter) << "a factor";
    GroupCommand back_in_time{.kind = GroupCommandKind::wait, .duration = -1ms};
    EXPECT_EQ(rig.submit(back_in_time).error, ErrorId::invalid_parameter);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_EQ(rig.view().last_id, 0u);
}

// G-030: 0 and less are the group's default dynamics, and without them what the axes' limits leave: 100 u/s along one axis.
TEST(GroupMotion, DynamicsThatAreNotSaidAreTheGroups) {
    GroupRig rig(1);
    rig.enable();
    ASSERT_EQ(rig.give(line({100}, -1)).error, ErrorId::none);
    double fastest = 0;
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        fastest = std::max(fastest, rig.view().path_velocity);
    }
    expect_just_below(fastest, 100);
    ASSERT_EQ(rig.set(WriteDynamics{WriteDynamics::Which::default_dynamics,
                                    {.velocity = 30, .acceleration = -1, .deceleration = -1, .jerk = -1}}),
              ErrorId::none);
    ASSERT_EQ(rig.give(line({0}, 0)).error, ErrorId::none);
    rig.run(500);
    expect_just_below(rig.view().path_velocity, 30);
}

}  // namespace
}  // namespace taktwerk::axes::test

// A group on a belt or a table. In each cycle of each test the rig asserts of every member: position, velocity and acceleration continuous and inside
// the limits, told = shown. Places by hand.

#include <gtest/gtest.h>

#include "core/guard/allocation_guard.hpp"
#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

// G-081: nothing moves until a command is in the frame. G-082: the object was at origin * (10, 2, 0) when the command was given, whatever the belt's position was
// then; it is seen to move. The belt goes along the origin's X, which is the machine's Y.
TEST(GroupTracking, MovesNothingByItselfAndSaysWhereTheObjectIs) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(700);
    ASSERT_EQ(rig.track({100, 50, 5, 0, 0, std::numbers::pi / 2}, {10, 2, 0, 0, 0, 0}).error, ErrorId::none);
    for (int i = 0; i < 500; ++i) {
        rig.step();
        ASSERT_EQ(rig.view().state, GroupStandby);
        ASSERT_EQ(rig.point()[0], 0);
        // 10 + way along the machine's Y, 2 against its X.
        const auto& six = rig.groups.equipment(GroupRig::ref)->frames.product[0];
        ASSERT_NEAR(six[0], 100 - 2, 1e-9);
        ASSERT_NEAR(six[1], 50 + 10 + rig.belt_at() - rig.reference, 1e-9);
        ASSERT_NEAR(six[2], 5, 1e-9);
    }
    EXPECT_GT(rig.belt_at() - rig.reference, 9.9);
}

// G-083: in without a jump (the rig), then exactly: 1e-9; G-019: at the target it stays GroupMoving and on the object; out again without a jump.
TEST(GroupTracking, JoinsTheBeltWorksOnItAndLeavesIt) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({0, 0, 0, 0, 0, 0}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_EQ(down.error, ErrorId::none);
    ASSERT_TRUE(rig.done(down.id)) << static_cast<int>(rig.error_of(down.id));
    EXPECT_TRUE(rig.view().track.in_sync);
    EXPECT_EQ(rig.view().track.axis, rig.belt());
    for (int i = 0; i < 300; ++i) {
        rig.step();
        ASSERT_EQ(rig.view().state, GroupMoving);
        ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), 0, 0, 4));
        ASSERT_NEAR(rig.view().set_velocity[0], 20, 1e-9);
    }
    // A line on the object: its own X and Y stay on the line in each cycle.
    const auto over = rig.give(on_product(line({6, 3, 4}, 20)));
    while (rig.status(over.id) != CommandStatus::done) {
        rig.step();
        ASSERT_EQ(rig.status(over.id) == CommandStatus::error, false) << static_cast<int>(rig.error_of(over.id));
        const auto at = rig.on_object();
        ASSERT_NEAR(at[1], at[0] / 2, 1e-9);
        ASSERT_NEAR(at[2], 4, 1e-9);
    }
    expect_place(rig.on_object(), 6, 3, 4);
    const auto away =
        rig.give({.kind = GroupCommandKind::linear_absolute, .frame = mcMCS, .target = {1, 2, 3}, .dynamics = {.velocity = 50}});
    ASSERT_TRUE(rig.done(away.id));
    EXPECT_NEAR(rig.point()[0], 1, 1e-9);
    EXPECT_NEAR(rig.point()[2], 3, 1e-9);
    rig.run(2);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_FALSE(rig.view().track.axis.valid());
}

// G-088: it stops, goes back, and on at another speed. While its velocity is constant the tool is on the object to 1e-9; while it changes a set-point that is planned
// before the belt's own differs by jerk * T^3 / 6 (2500 / 6e9 = 4.2e-7) at most.
TEST(GroupTracking, ABeltThatStopsAndReversesIsFollowed) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id));
    for (const double velocity : {35.0, 0.0, -25.0, -5.0, 15.0}) {
        if (velocity == 0) rig.step([&] { (void)rig.axes[rig.last].submit({.kind = CommandKind::halt}, Owner::program); });
        else rig.drive_belt(velocity);
        for (int i = 0; i < 700; ++i) {
            rig.step();
            ASSERT_TRUE(rig.view().track.in_sync) << velocity << " in " << i;
            ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), 0, 0, 4, i > 600 ? 1e-9 : 4.3e-7));
        }
        EXPECT_NEAR(rig.axis(rig.last).set_velocity, velocity, 1e-9);
    }
}

// G-072: an override of 0 holds the path, not the belt. G-087: halt and interruption stop on the object, a stop in space.
TEST(GroupTracking, OverrideHaltAndInterruptionHoldOnTheObjectAStopInSpace) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id));
    const auto stands_on_object = [&] {
        const auto was = rig.on_object();
        for (int i = 0; i < 100; ++i) {
            rig.step();
            ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), was[0], was[1], was[2]));
            ASSERT_NEAR(rig.view().set_velocity[0], 20, 1e-9);
        }
        ASSERT_EQ(rig.view().state, GroupMoving);
    };
    const auto along = rig.give(on_product(line({0, 40, 4}, 10)));
    rig.run(800);
    ASSERT_EQ(rig.set(Override{.velocity = 0}), ErrorId::none);
    rig.run(400);
    stands_on_object();
    EXPECT_EQ(rig.status(along.id), CommandStatus::active);
    ASSERT_EQ(rig.set(Override{}), ErrorId::none);
    rig.run(300);
    const auto held = rig.give(simply(GroupCommandKind::interrupt));
    ASSERT_TRUE(rig.done(held.id));
    stands_on_object();
    EXPECT_TRUE(rig.view().interrupted);
    ASSERT_EQ(rig.give(simply(GroupCommandKind::resume)).error, ErrorId::none);
    rig.run(300);
    EXPECT_GT(rig.view().set_velocity[1], 5);
    const auto halt = rig.give(simply(GroupCommandKind::halt));
    ASSERT_TRUE(rig.done(halt.id));
    EXPECT_EQ(rig.status(along.id), CommandStatus::aborted);
    stands_on_object();
    const auto on = rig.give(on_product(line({0, 40, 4}, 10)));
    rig.run(600);
    const auto stop = rig.give(simply(GroupCommandKind::stop));
    ASSERT_TRUE(rig.done(stop.id));
    EXPECT_EQ(rig.status(on.id), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, GroupStopping);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig.view().set_velocity[i], 0);
    rig.groups.release_stop(GroupRig::ref, stop.id, Owner::program);
    rig.run(3);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_GT(rig.axis(rig.last).set_velocity, 19);
}

// G-085: another object in the frame would bend what is under way; behind it, it is another object.
TEST(GroupTracking, AFrameInUseTakesNoOtherObject) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto first = rig.give(on_product(line({0, 0, 4}, 30)));
    rig.run(100);
    const double seen = rig.reference;
    EXPECT_EQ(rig.track({}, {0, 9, 0, 0, 0, 0}).error, ErrorId::frame_in_use);
    GroupCommand fixed{.kind = GroupCommandKind::set_frame, .frame = mcPCS, .target = {1, 2, 3}};
    EXPECT_EQ(rig.give(fixed).error, ErrorId::frame_in_use);
    EXPECT_EQ(rig.give(on_product({.kind = GroupCommandKind::direct_absolute, .target = {1, 2, 3}})).error, ErrorId::not_supported);
    rig.reference = seen;
    rig.seen_object = {10, 5, 0, 0, 0, 0};
    ASSERT_TRUE(rig.done(first.id));
    expect_place(rig.on_object(), 0, 0, 4);
    // Another product's frame is free, and a command in it leaves the first.
    ASSERT_EQ(rig.track({}, {0, 9, 0, 0, 0, 0}, mcPCS_2).error, ErrorId::none);
    const auto second = rig.give(on_product(line({1, 1, 1}, 30), mcPCS_2));
    ASSERT_TRUE(rig.done(second.id)) << static_cast<int>(rig.error_of(second.id));
    expect_place(rig.on_object(), 1, 1, 1);
    EXPECT_EQ(rig.track({}, {0, 0, 0, 0, 0, 0}, mcPCS_1).error, ErrorId::none);
}

// G-086: half of a member is 50 u/s. A belt of 60 is too fast: the group is in error, and comes to rest inside all limits.
TEST(GroupTracking, ABeltThatIsTooFastIsAnErrorAndARamp) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id));
    rig.drive_belt(60);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 1000));
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_too_fast));
    EXPECT_LE(rig.axis(rig.last).set_velocity, 50.5);
    ASSERT_TRUE(rig.until([&] { return rig.view().set_velocity[0] == 0; }, 1000));
    rig.run(3);
    EXPECT_EQ(rig.groups.reset(GroupRig::ref, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 100));
    const auto late = rig.give(on_product(line({0, 0, 4}, 30)));
    EXPECT_FALSE(rig.done(late.id));
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_too_fast));
}

// G-021, G-086: at the end of X the object leaves the reach: the group is in error before the limit, and no member goes beyond it.
TEST(GroupTracking, WhatLeavesTheReachIsAnErrorBeforeTheLimit) {
    auto members = GroupRig::named(3);
    for (auto& one : members) {
        one.limits.position_min = -10;
        one.limits.position_max = 60;
        one.require_homed = true;
        one.homing.kind = HomingKind::set_here;
    }
    TrackRig rig(members, cartesian_arm());
    const auto home = rig.give(simply(GroupCommandKind::home));
    ASSERT_TRUE(rig.done(home.id)) << static_cast<int>(rig.error_of(home.id));
    rig.drive_belt(20);
    rig.run(300);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id)) << static_cast<int>(rig.error_of(down.id));
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 4000));
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_limit));
    ASSERT_TRUE(rig.until([&] { return rig.view().set_velocity[0] == 0; }, 1000));
    EXPECT_LE(rig.point()[0], 60);
    EXPECT_GT(rig.point()[0], 59.5);
}

// G-088: an error of the belt's axis is one of the group, which comes to rest.
TEST(GroupTracking, AnErrorOfTheBeltIsOneOfTheGroup) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id));
    rig.drives[rig.last]->fault_code = 0x5441;
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 50));
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_lost));
    ASSERT_TRUE(rig.until([&] { return rig.view().set_velocity[0] == 0; }, 1000));
    EXPECT_EQ(rig.give(on_product(line({0, 0, 4}, 30))).error, ErrorId::in_error_stop);
}

Arm turning_arm() {
    KinematicsDescription description{.arm = CartesianAxes{.turn_about = 2}};
    description.joints[3].unit = std::numbers::pi / 180;
    return arm_of(description);
}
Arm selective_arm() {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = std::numbers::pi / 180;
    return arm_of(description);
}
std::vector<AxisConfig> selective_axes() {
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    return {group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)};
}

// G-081, G-083: a table turns about its origin's Z, 360 u a turn. At 30 u/s and 40 u from its centre the tool goes 20.9 u/s, and turns with it.
TEST(GroupTracking, ATableIsFollowedRoundItsCentre) {
    auto table = belt_axis();
    table.modulo = 360;
    TrackRig rig(4, turning_arm(), table);
    rig.drive_belt(30);
    rig.run(500);
    ASSERT_EQ(rig.track({20, 10, 0, 0, 0, 0}, {40, 0, 0, 0, 0, 0}, mcPCS, FrameTrack::Kind::table).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4, 0, 0, 0}, 30)));
    ASSERT_EQ(down.error, ErrorId::none);
    ASSERT_TRUE(rig.done(down.id)) << static_cast<int>(rig.error_of(down.id)) << " " << rig.view().error;
    for (int i = 0; i < 400; ++i) {
        rig.step();
        ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), 0, 0, 4));
        ASSERT_NEAR(std::hypot(rig.view().set_velocity[0], rig.view().set_velocity[1]), 40 * 30 * std::numbers::pi / 180, 1e-9);
        ASSERT_NEAR(rig.view().set_velocity[3], 30, 1e-9);
    }
    // An arm that cannot turn its tool cannot follow what turns.
    TrackRig stiff(3, cartesian_arm(), table);
    EXPECT_EQ(stiff.track({}, {40, 0, 0, 0, 0, 0}, mcPCS, FrameTrack::Kind::table).error, ErrorId::not_supported);
}

// An arm bends what is straight: on a belt, along a line and an arc on the object, each set-point is where it belongs to 1e-9.
TEST(GroupTracking, AScaraDrawsOnAMovingObject) {
    TrackRig rig(selective_axes(), selective_arm());
    const auto ready = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 20}});
    ASSERT_TRUE(rig.done(ready.id));
    rig.drive_belt(30);
    rig.run(700);
    const auto start = rig.view().tool_set;
    // The belt runs along the machine's Y.
    ASSERT_EQ(rig.track({start[0], start[1], 0, 0, 0, std::numbers::pi / 2}, {0, -20, 0, 0, 0, 0}).error, ErrorId::none);
    const double turned = start[5] - std::numbers::pi / 2;
    const auto to = [&](double x, double y) { return on_product(line({x, y, 0, 0, 0, turned}, 60, mcBuffered)); };
    const auto there = rig.give(to(0, 0));
    ASSERT_EQ(there.error, ErrorId::none);
    ASSERT_TRUE(rig.done(there.id)) << static_cast<int>(rig.error_of(there.id)) << " " << rig.view().error;
    auto arc = to(20, 0);
    arc.kind = GroupCommandKind::circular_absolute;
    arc.circle = {.mode = mcBORDER, .aux = {10, 10, 0}};
    const auto round = rig.give(arc);
    const auto along = rig.give(to(-10, 0));
    for (int i = 0; rig.status(along.id) != CommandStatus::done; ++i) {
        ASSERT_LT(i, 5000);
        rig.step();
        ASSERT_NE(rig.view().state, GroupErrorStop) << rig.view().error;
        const auto at = rig.on_object();
        if (rig.status(round.id) == CommandStatus::active) ASSERT_NEAR(std::hypot(at[0] - 10, at[1]), 10, 1e-8);
        else ASSERT_NEAR(at[1], 0, 1e-8);
    }
    expect_place(rig.on_object(), -10, 0, 0, 1e-8);
}

// What is commanded in the scan in which the frame is tracked is meant on the object, not where the frame stood before: that is the middle of the SCARA's foot, which nothing reaches.
TEST(GroupTracking, ACommandOfTheSameScanIsMeantOnTheObject) {
    TrackRig rig(selective_axes(), selective_arm());
    const auto ready = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 20}});
    ASSERT_TRUE(rig.done(ready.id));
    const auto start = rig.view().tool_set;
    GroupCommand track{.kind = GroupCommandKind::track_frame, .frame = mcPCS, .execution = mcImmediately};
    track.track = {.kind = FrameTrack::Kind::belt, .master = rig.belt()};
    track.track.origin = {start[0], start[1], 0, 0, 0, 0};
    Submitted tracked, there;
    rig.step([&] {
        tracked = rig.submit(track);
        there = rig.submit(on_product(line({5, 0, 0, 0, 0, start[5]}, 60)));
    });
    ASSERT_EQ(tracked.error, ErrorId::none);
    ASSERT_EQ(there.error, ErrorId::none);
    ASSERT_TRUE(rig.done(there.id)) << static_cast<int>(rig.error_of(there.id));
    EXPECT_NEAR(rig.view().tool_set[0], start[0] + 5, 1e-9);
    EXPECT_NEAR(rig.view().tool_set[1], start[1], 1e-9);
}

// All members leave at once in the middle of it (an emergency stop, a lost bus): nobody is left to be brought to rest. What the group did with the belt is forgotten, and the next command
// begins from rest where the members are; the rig sees a jump.
TEST(GroupTracking, WhenAllMembersLeaveAtOnceTheBeltIsForgotten) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({0, 0, 0, 0, 0, 0}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(down.id));
    rig.run(50);
    for (std::size_t i = 0; i < 3; ++i) rig.axes[i].demand_emergency_stop(EmergencyStop::stop);
    rig.run(1000);
    EXPECT_EQ(rig.view().state, GroupErrorStop);
    EXPECT_FALSE(rig.view().track.axis.valid());
    for (std::size_t i = 0; i < 3; ++i) rig.axes[i].demand_emergency_stop(EmergencyStop::none);
    EXPECT_EQ(rig.groups.reset(GroupRig::ref, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 5000));
    const auto at = rig.point();
    const auto away = rig.give(
        {.kind = GroupCommandKind::linear_absolute, .frame = mcMCS, .target = {at[0] + 1, at[1], at[2]}, .dynamics = {.velocity = 50}});
    ASSERT_TRUE(rig.done(away.id)) << static_cast<int>(rig.error_of(away.id));
    EXPECT_NEAR(rig.point()[0], at[0] + 1, 1e-9);
}

// G-084: an encoder measures the belt: what it says is as old as its latch, and set-points act a cycle later; both are made up for. The belt really is
// 30 u/s * 1 ms = 0.03 u further for each cycle of them.
TEST(GroupTracking, WhatAnEncoderSaysIsTakenOnToWhereSetPointsAct) {
    auto belt = belt_axis();
    belt.encoder = true;
    belt.limits = {.velocity = 100};
    TrackRig rig(GroupRig::named(3), cartesian_arm(), belt);
    rig.drives[rig.last]->coasting = 30;  // counts a cycle
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_EQ(down.error, ErrorId::none);
    ASSERT_TRUE(rig.done(down.id)) << static_cast<int>(rig.error_of(down.id)) << " " << rig.view().error;
    for (int i = 0; i < 300; ++i) {
        rig.step();
        // Latched a cycle ago, and acting in a cycle: two of them.
        ASSERT_NEAR(rig.point()[0], 10 + rig.axis(rig.last).actual_position - rig.reference + 2 * 0.03, 2e-3);
        ASSERT_NEAR(rig.view().set_velocity[0], 30, 1);
    }
}

// The cycle's part of it allocates nothing.
TEST(GroupTracking, AllocatesNothingInTheCycle) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto down = rig.give(on_product(line({0, 0, 4}, 30)));
    rig.run(50);
    ASSERT_EQ(rig.status(down.id), CommandStatus::active);
    for (int i = 0; i < 300; ++i) {
        rig.now += GroupRig::cycle;
        NoAllocationScope none;
        rig.groups.plan(rig.now, GroupRig::cycle);
        ASSERT_EQ(none.used().total(), 0u);
    }
}

}  // namespace
}  // namespace taktwerk::axes::test

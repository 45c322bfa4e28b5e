// Rules of frames that move which a plain pick never meets. Oracle of members as in group_tracking_unit.cpp; places by hand.

#include <gtest/gtest.h>

#include "tests/axes/group/jog_arms.hpp"
#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct RunningBelt : TrackRig {
    explicit RunningBelt(double velocity = 20) : TrackRig(3, cartesian_arm()) {
        drive_belt(velocity);
        run(700);
    }
};

// G-083, "Done: the path is at its end and the tool is on the object": a command whose path has no length too. The group stands at X = 0; the object is there now.
TEST(GroupTrackingRules, ACommandWithoutAWayJoinsTheObjectToo) {
    RunningBelt rig;
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    const auto stay = rig.give(on_product(line_by({}, 30)));
    ASSERT_EQ(stay.error, ErrorId::none);
    ASSERT_TRUE(rig.done(stay.id)) << static_cast<int>(rig.error_of(stay.id));
    EXPECT_TRUE(rig.view().track.in_sync);
    const auto was = rig.on_object();
    for (int i = 0; i < 200; ++i) {
        rig.step();
        ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), was[0], was[1], was[2]));
        ASSERT_NEAR(rig.view().set_velocity[0], 20, 1e-9);
    }
}

// A command that cannot be gone is an Error, and the group stands as before: nothing of it waits for anything.
TEST(GroupTrackingRules, ARefusedPathLeavesTheGroupInStandby) {
    RunningBelt rig;
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    auto arc = on_product(line({10, 0, 0}, 30));
    arc.kind = GroupCommandKind::circular_absolute;
    arc.circle = {.mode = mcBORDER, .aux = {5, 0, 0}};
    arc.target = {10, 0, 0};
    // Begin, border and end on one line are no arc; where it begins only the planner knows.
    rig.step();
    const auto at = rig.on_object();
    arc.circle.aux = {at[0] + 5, at[1], at[2]};
    arc.target = {at[0] + 10, at[1], at[2]};
    arc.kind = GroupCommandKind::circular_relative;
    arc.circle.aux = {5, 0, 0};
    arc.target = {10, 0, 0};
    const auto bent = rig.give(arc);
    ASSERT_EQ(bent.error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(bent.id) == CommandStatus::error; }, 500));
    EXPECT_EQ(rig.error_of(bent.id), ErrorId::invalid_arc);
    rig.run(10);
    EXPECT_EQ(rig.view().state, GroupState::GroupStandby);
    EXPECT_FALSE(rig.view().track.axis.valid());
}

// G-081: an axis that was a belt and is a member now would carry itself.
TEST(GroupTrackingRules, ABeltThatHasBecomeAMemberIsNone) {
    KinematicsDescription lift{.arm = CartesianAxes{.linear = {true, true, true}}};
    TrackRig rig(3, arm_of(lift));
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    const auto off = rig.give(simply(GroupCommandKind::disable));
    (void)off;
    rig.run(3);
    ASSERT_EQ(rig.set(RemoveMember{3}), ErrorId::none);
    ASSERT_EQ(rig.set(AddMember{rig.belt(), 3}), ErrorId::none);
    ASSERT_EQ(rig.set(EnableGroup{}), ErrorId::none);
    EXPECT_EQ(rig.give(on_product(line({1, 2, 3}, 20))).error, ErrorId::invalid_axis);
}

// "Its path is planned on the object where that is now": also the next command's on the same object, which has gone 60 u since the group joined it.
TEST(GroupTrackingRules, ALaterCommandIsPlannedWhereTheObjectIsThen) {
    auto members = GroupRig::named(3);
    for (auto& one : members) {
        one.limits.position_min = -100;
        one.limits.position_max = 30;
        one.require_homed = true;
        one.homing.kind = HomingKind::set_here;
    }
    TrackRig rig(members, cartesian_arm());
    const auto home = rig.give(simply(GroupCommandKind::home));
    ASSERT_TRUE(rig.done(home.id));
    rig.drive_belt(-20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {25, 0, 0, 0, 0, 0}).error, ErrorId::none);
    const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(there.id)) << static_cast<int>(rig.error_of(there.id));
    rig.run(1500);
    ASSERT_LT(rig.point()[0], -10);
    // 15 u along the object: now it ends below X = 5; seen from where the group joined it would be at 40.
    const auto along = rig.give(on_product(line({15, 0, 4}, 30)));
    ASSERT_EQ(along.error, ErrorId::none);
    ASSERT_TRUE(rig.done(along.id)) << static_cast<int>(rig.error_of(along.id));
    expect_place(rig.on_object(), 15, 0, 4);
}

// G-074, G-085: the machine's own frame is part of where an object is.
TEST(GroupTrackingRules, TheMachinesFrameIsInUseWhileTheGroupGoesWithAnObject) {
    RunningBelt rig;
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(there.id));
    GroupCommand shift{.kind = GroupCommandKind::set_frame, .frame = mcMCS, .target = {0, 7, 0}};
    EXPECT_EQ(rig.give(shift).error, ErrorId::frame_in_use);
    // In its turn: what comes behind it goes where the object is seen from the machine then.
    shift.execution = mcQueued;
    ASSERT_EQ(rig.give(shift).error, ErrorId::none);
    const auto again = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_EQ(again.error, ErrorId::none);
    ASSERT_TRUE(rig.done(again.id)) << static_cast<int>(rig.error_of(again.id));
    rig.step();
    const double way = rig.belt_at() - rig.reference;
    EXPECT_NEAR(rig.point()[0], 10 + way, 1e-9);
    EXPECT_NEAR(rig.point()[1], 5 - 7, 1e-9);
}

// G-083: a command elsewhere lets the object go; one on the same object, given before the frame's way has come to rest, joins it again.
TEST(GroupTrackingRules, WhatIsBeingLetGoIsJoinedAgain) {
    for (const int after : {1, 2, 20, 60, 150, 400}) {
        SCOPED_TRACE(after);
        RunningBelt rig;
        ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
        const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
        ASSERT_TRUE(rig.done(there.id));
        ASSERT_EQ(rig.give(line({200, 50, 0}, 30)).error, ErrorId::none);
        rig.run(after);
        const auto back_again = rig.give(on_product(line({3, 0, 4}, 30)));
        ASSERT_EQ(back_again.error, ErrorId::none);
        ASSERT_TRUE(rig.done(back_again.id)) << static_cast<int>(rig.status(back_again.id));
        expect_place(rig.on_object(), 3, 0, 4);
    }
}

// G-081: a table that turns about what the arm cannot turn its tool about is none for it: a SCARA turns about Z alone.
TEST(GroupTrackingRules, ATableThatIsTiltedIsNoneForAnArmThatTurnsAboutZ) {
    const auto arms = every_kind_of_arm();
    for (const auto& arm : arms) {
        const auto turns = arm_of(arm.description)->commands();
        if (!turns[5]) continue;
        SCOPED_TRACE(arm.name);
        auto table = belt_axis();
        table.modulo = 360;
        TrackRig rig(axes_of(arm), arm_of(arm.description), table);
        const bool any = turns[3] && turns[4];
        const auto answer = rig.track({0, 0, 0, 0, 0.2, 0}, {}, mcPCS, FrameTrack::Kind::table);
        EXPECT_EQ(answer.error, any ? ErrorId::none : ErrorId::not_supported);
        EXPECT_EQ(rig.track({0, 0, 0, 0, 0, 0.2}, {}, mcPCS_2, FrameTrack::Kind::table).error, ErrorId::none);
        EXPECT_EQ(rig.track({0, 0, 0, std::numbers::pi, 0, 0}, {}, mcPCS_3, FrameTrack::Kind::table).error, ErrorId::none) << "it hangs";
    }
}

// G-082: MC_SetPosition of a belt gives its places other numbers; the object does not move.
TEST(GroupTrackingRules, ANewNumberForTheBeltMovesNothing) {
    RunningBelt rig;
    ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(there.id));
    for (const double shift : {0.05, 1000.0, -3.0}) {
        rig.step(
            [&] { ASSERT_EQ(rig.axes[rig.last].set(SetPosition{.position = shift, .relative = true}, Owner::program), ErrorId::none); });
        rig.reference += shift;
        for (int i = 0; i < 50; ++i) {
            rig.step();
            ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), 0, 0, 4));
        }
    }
    EXPECT_EQ(rig.view().state, GroupState::GroupMoving);
}

// The object was seen a million of units ago: it is followed as at the beginning. Sums there cost 1.2e-10 u.
TEST(GroupTrackingRules, AMillionUnitsOnItIsAsExact) {
    TrackRig rig(3, cartesian_arm(), belt_axis({.velocity = 2e5, .acceleration = 1e6, .deceleration = 1e6, .jerk = 1e8}));
    ASSERT_EQ(rig.track({-1e6, 0, 0, 0, 0, 0}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
    rig.step([&] { ASSERT_EQ(rig.axes[rig.last].submit(absolute(1e6, 1e5), Owner::program).error, ErrorId::none); });
    ASSERT_TRUE(rig.until([&] { return rig.belt_at() == 1e6; }, 20000));
    rig.step([&] {
        const AxisCommand on{.kind = CommandKind::move_velocity, .velocity = 20, .acceleration = 250, .deceleration = 250, .jerk = 2500};
        ASSERT_EQ(rig.axes[rig.last].submit(on, Owner::program).error, ErrorId::none);
    });
    rig.run(500);
    const auto there = rig.give(on_product(line({0, 0, 4}, 30)));
    ASSERT_TRUE(rig.done(there.id)) << static_cast<int>(rig.error_of(there.id));
    for (int i = 0; i < 300; ++i) {
        rig.step();
        ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), 0, 0, 4));
        ASSERT_NEAR(rig.view().set_velocity[0], 20, 1e-9);
    }
    EXPECT_GT(rig.belt_at() - rig.reference, 1e6);
}

// The end of a program, whatever is under way: halted and let go, and nothing is left that would go on.
TEST(GroupTrackingRules, WhoIsGoneLeavesNothingThatGoesOn) {
    for (const bool tracked : {false, true})
        for (const auto kind : {GroupCommandKind::halt, GroupCommandKind::interrupt, GroupCommandKind::disable}) {
            SCOPED_TRACE(std::to_string(tracked) + " " + std::to_string(static_cast<int>(kind)));
            RunningBelt rig;
            ASSERT_EQ(rig.track({}, {10, 5, 0, 0, 0, 0}).error, ErrorId::none);
            auto first = line({40, 20, 4}, 20);
            if (tracked) first = on_product(first);
            ASSERT_EQ(rig.give(first).error, ErrorId::none);
            rig.run(400);
            ASSERT_EQ(rig.give(simply(kind)).error, ErrorId::none);
            auto behind = line({1, 2, 3}, 20, mcBuffered);
            const auto waiting = rig.give(behind);
            rig.step([&] { rig.groups[0].let_go(); });
            ASSERT_TRUE(rig.until([&] { return !rig.groups[0].leads(); }, 2000));
            rig.run(500);
            EXPECT_EQ(rig.view().queued_count, 0);
            EXPECT_FALSE(rig.view().interrupted);
            EXPECT_EQ(rig.view().active, 0u);
            EXPECT_EQ(rig.view().state, kind == GroupCommandKind::disable ? GroupState::GroupDisabled : GroupState::GroupStandby);
            if (waiting.error == ErrorId::none) {
                EXPECT_EQ(rig.status(waiting.id), CommandStatus::aborted);
            }
        }
}

}  // namespace
}  // namespace taktwerk::axes::test

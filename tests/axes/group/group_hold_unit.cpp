// What ends a person's hold of a group, what does not, and what of its program takes effect meanwhile. Random walks: group_hold_property.cpp,
// group_hold_belt_property.cpp.

#include <gtest/gtest.h>

#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {
namespace held {  // files beside this one have functions by the names of commands

using enum GroupCommandKind;

/// On its way to {60, 80}, 300 cycles in.
struct HeldRig : GroupRig {
    HeldRig() : GroupRig(2) {
        enable();
        move = give(line({60, 80}, 50)).id;
        run(300);
    }
    bool rests() {
        return until([this] { return view().interrupted; }, 1000);
    }
    AxisGroup& group() { return groups[0]; }
    CommandId move = 0;
};

// A member's power goes with the program that has switched it on, while the group still brakes for a person: another program would move it when power is back.
TEST(GroupHold, AMemberThatIsShutDownDoesNotLetGo) {
    HeldRig rig;
    ASSERT_EQ(rig.group().hold(), ErrorId::none);
    rig.run(3);
    rig.step([&] { rig.group().shut_down({1}); });
    ASSERT_TRUE(rig.rests());
    EXPECT_TRUE(rig.view().held);
    EXPECT_EQ(rig.status(rig.move), CommandStatus::aborted);
    ASSERT_TRUE(rig.until([&] { return rig.view().powered; }, 1000));
    const auto place = rig.point();
    const auto next = rig.give(line({10, 10}, 50));
    EXPECT_EQ(rig.status(next.id), CommandStatus::queued);
    rig.run(500);
    EXPECT_EQ(rig.point(), place);
    EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
    EXPECT_TRUE(rig.until([&] { return rig.status(next.id) == CommandStatus::done; }, 3000));
}

// MC_GroupHalt while it brakes for a person ends what he has interrupted, and is Done where it rests. Its program has made no mistake.
TEST(GroupHold, AHaltWhileItBrakesIsDoneAtRest) {
    HeldRig rig;
    ASSERT_EQ(rig.group().hold(), ErrorId::none);
    rig.run(3);
    const auto halt_now = rig.give(simply(halt));
    ASSERT_EQ(halt_now.error, ErrorId::none);
    EXPECT_EQ(rig.status(rig.move), CommandStatus::aborted);
    ASSERT_GT(rig.view().path_velocity, 0);
    EXPECT_EQ(rig.status(halt_now.id), CommandStatus::active);
    ASSERT_TRUE(rig.rests());
    EXPECT_EQ(rig.status(halt_now.id), CommandStatus::done);
    EXPECT_TRUE(rig.view().held);
    EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
    EXPECT_FALSE(rig.view().interrupted);
}

// G-066: its program interrupts while a person holds it. Done where it rests; who continues gives it back, and the program's MC_GroupContinue goes on.
TEST(GroupHold, AnInterruptionOfItsProgramTakesEffectBesideIt) {
    for (const int later : {3, 600}) {
        HeldRig rig;
        ASSERT_EQ(rig.group().hold(), ErrorId::none);
        rig.run(later);
        const auto own = rig.give(simply(interrupt));
        ASSERT_EQ(own.error, ErrorId::none) << later;
        EXPECT_EQ(rig.status(own.id), later < 100 ? CommandStatus::active : CommandStatus::done);
        EXPECT_EQ(rig.submit(simply(interrupt)).error, ErrorId::state_forbids) << "a second one";
        EXPECT_EQ(rig.submit(simply(resume)).error, later < 100 ? ErrorId::nothing_interrupted : ErrorId::held_by_person);
        ASSERT_TRUE(rig.rests());
        EXPECT_EQ(rig.status(own.id), CommandStatus::done);
        const auto place = rig.point();
        EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
        rig.run(500);
        EXPECT_EQ(rig.point(), place);
        EXPECT_TRUE(rig.view().interrupted);
        EXPECT_EQ(rig.submit(simply(resume)).error, ErrorId::none);
        EXPECT_TRUE(rig.until([&] { return rig.status(rig.move) == CommandStatus::done; }, 3000));
    }
}

// A program that comes to rest softly by itself: who interrupts it then does not wait for that. 50 u/s by 1000 u/s2 and 10000 u/s3 are gone in
// 50/1000 + 1000/10000 = 0.15 s, by 10 u/s2 in 5 s.
TEST(GroupHold, WhoInterruptsBehindASoftInterruptionIsNotKeptWaiting) {
    HeldRig rig;
    (void)rig.give(simply(interrupt, {0, 10, 10, 1000}));
    rig.run(100);
    ASSERT_GT(rig.view().path_velocity, 40);
    ASSERT_EQ(rig.group().hold(), ErrorId::none);
    EXPECT_TRUE(rig.until([&] { return rig.view().interrupted; }, 250));
    EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
    EXPECT_TRUE(rig.view().interrupted) << "it is its program's";
}

// What stands on a belt, interrupted while a halt of its program was under way: a person's stop ends that too, and nothing is left to continue.
TEST(GroupHold, AStopOnABeltEndsWhatIsInterruptedThere) {
    TrackRig rig(3, cartesian_arm());
    rig.drive_belt(10);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    ASSERT_EQ(rig.give(on_product(line({rig.belt_at() - rig.reference, 90, 0}, 30))).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().track.in_sync && rig.view().path_velocity > 20; }, 3000));
    (void)rig.give(simply(halt, {0, 50, 50, 500}));
    ASSERT_EQ(rig.groups[0].hold(), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 3000));
    ASSERT_EQ(rig.view().active_kind, halt);
    rig.groups[0].halt();
    rig.run(10);
    EXPECT_FALSE(rig.view().held);
    EXPECT_FALSE(rig.view().interrupted);
    EXPECT_EQ(rig.submit(simply(resume)).error, ErrorId::nothing_interrupted);
}

// What its program commands while a person holds the tool on its part waits there, too: no error that nobody has made. The tool stays on the part until he lets go.
TEST(GroupHold, WhatIsCommandedOnABeltWaitsThere) {
    for (const auto& [later, frame] : {std::pair{3, mcPCS}, {1500, mcPCS}, {1500, mcMCS}}) {
        TrackRig rig(3, cartesian_arm());
        rig.drive_belt(10);
        rig.run(500);
        ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
        ASSERT_EQ(rig.give(on_product(line({rig.belt_at() - rig.reference, 90, 0}, 30))).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.view().track.in_sync && rig.view().path_velocity > 20; }, 3000));
        ASSERT_EQ(rig.groups[0].hold(), ErrorId::none);
        rig.run(later);
        const auto next = rig.give(on_product(line({30, 40, 5}, 30), frame));
        ASSERT_EQ(next.error, ErrorId::none) << later;
        ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 3000));
        const auto stood = rig.on_object();
        for (int i = 0; i < 500; ++i) {
            rig.step();
            ASSERT_NO_FATAL_FAILURE(expect_place(rig.on_object(), stood[0], stood[1], stood[2]));
            ASSERT_EQ(rig.status(next.id), CommandStatus::queued);
        }
        ASSERT_EQ(rig.groups[0].release_hold(), ErrorId::none);
        ASSERT_TRUE(rig.done(next.id)) << static_cast<int>(rig.error_of(next.id));
        if (frame == mcPCS) expect_place(rig.on_object(), 30, 40, 5);
        else EXPECT_NEAR(rig.point()[0], 30, 1e-9);
    }
}

// MC_SyncAxisToGroup would move a member of a group that a person holds.
TEST(GroupHold, NoPathMovesAMemberOfWhatIsHeld) {
    GroupRig rig(GroupRig::named(3),
                 {{.name = "g", .members = {"a0", "a1"}, .kinematics = {}}, {.name = "h", .members = {"a2"}, .kinematics = {}}});
    rig.enable();
    ASSERT_EQ(rig.groups.set({1}, EnableGroup{}, Owner::program), ErrorId::none);
    ASSERT_EQ(rig.groups[1].hold(), ErrorId::none);
    EXPECT_EQ(rig.set(FollowPath{.slave = {2}}), ErrorId::held_by_person);
    ASSERT_EQ(rig.groups[1].release_hold(), ErrorId::none);
    EXPECT_EQ(rig.set(FollowPath{.slave = {2}}), ErrorId::none);
}

}  // namespace held
}  // namespace
}  // namespace taktwerk::axes::test

// Blocks of Part 4 on a group: their outputs, scan by scan.

#include <gtest/gtest.h>

#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::test::group_axis;

struct EnabledPlc : GroupPlc {
    explicit EnabledPlc(std::size_t count, axes::test::Arm kinematics = {}) : GroupPlc(count, kinematics) {
        MC_GroupEnable enable;
        carry_out(enable);
    }
};

// A group is put together, enabled, moved and taken apart by its blocks alone.
TEST(GroupBlocks, AGroupFromItsFirstMemberToItsLast) {
    GroupPlc plc({group_axis("x"), group_axis("y")}, {{.name = "g"}});
    MC_GroupEnable enable;
    enable.AxesGroup = plc.group;
    enable.Execute = true;
    plc.program = [&](const MotionContext& ctx) { enable(ctx); };
    plc.scan();
    EXPECT_TRUE(enable.Error);
    EXPECT_EQ(enable.ErrorID, ErrorId::no_members);
    plc.program = {};

    MC_AddAxisToGroup add_x, add_y;
    add_x.Axis = {0};
    add_x.IdentInGroup = 1;
    add_y.Axis = {1};
    add_y.IdentInGroup = 2;
    plc.carry_out(add_x);
    plc.carry_out(add_y);
    EXPECT_EQ(add_y.ErrorID, ErrorId::none);
    EXPECT_EQ(plc.rig.view().member_count, 2);

    MC_GroupEnable again;
    plc.carry_out(again);
    EXPECT_EQ(plc.rig.view().state, axes::GroupState::GroupStandby);

    MC_MoveLinearAbsolute move;
    move.Position.A.Axes = {3, 4};
    move.Velocity = 50;
    plc.carry_out(move, 1000);
    EXPECT_EQ(move.ErrorID, ErrorId::none);
    EXPECT_EQ(plc.rig.axis(0).set_position, 3);
    EXPECT_EQ(plc.rig.axis(1).set_position, 4);

    MC_GroupDisable disable;
    plc.carry_out(disable);
    EXPECT_EQ(plc.rig.view().state, axes::GroupState::GroupDisabled);
    MC_RemoveAxisFromGroup remove;
    remove.IdentInGroup = 2;
    plc.carry_out(remove);
    EXPECT_EQ(plc.rig.view().member_count, 1);
    MC_UngroupAllAxes ungroup;
    plc.carry_out(ungroup);
    EXPECT_EQ(plc.rig.view().member_count, 0);
}

// G-026, G-031 and the lifecycle: Busy, Active, Done; CommandAccepted and CommandID while it is under way.
TEST(GroupBlocks, AMoveShowsItsLife) {
    EnabledPlc plc(2);
    MC_MoveLinearAbsolute first, second;
    for (auto* move : {&first, &second}) {
        move->AxesGroup = plc.group;
        move->Velocity = 50;
    }
    first.Position.A.Axes = {5, 0};
    second.Position.A.Axes = {5, 5};
    second.BufferMode = mcBuffered;
    plc.program = [&](const MotionContext& ctx) {
        second(ctx);  // G-032: whatever the order of the calls
        first(ctx);
    };
    plc.scan();
    EXPECT_FALSE(first.Busy);
    EXPECT_FALSE(first.CommandAccepted);
    EXPECT_EQ(first.CommandID.id, 0u);
    first.Execute = true;
    plc.scan();
    second.Execute = true;
    plc.scan();
    EXPECT_TRUE(first.Busy && first.Active && first.CommandAccepted);
    EXPECT_EQ(first.CommandID.id, 1u);
    EXPECT_TRUE(second.Busy && second.CommandAccepted);
    EXPECT_FALSE(second.Active);
    EXPECT_EQ(second.CommandID.id, 2u);

    ASSERT_TRUE(plc.until([&] { return first.Done; }, 1000));
    EXPECT_FALSE(first.Busy || first.Active || first.CommandAccepted || first.CommandAborted || first.Error);
    EXPECT_EQ(first.CommandID.id, 0u);
    ASSERT_TRUE(plc.until([&] { return second.Done; }, 1000));

    // A new edge while Busy: the earlier command goes on, and is not shown.
    first.Execute = second.Execute = false;
    plc.scan();
    first.Position.A.Axes = {0, 5};
    first.Execute = true;
    plc.run(20);
    first.Execute = false;
    plc.scan();
    first.BufferMode = mcBuffered;
    first.Position.A.Axes = {0, 0};
    first.Execute = true;
    plc.scan();
    EXPECT_TRUE(first.Busy && first.CommandAccepted);
    EXPECT_FALSE(first.Active);
    ASSERT_TRUE(plc.until([&] { return first.Done; }, 2000));
    EXPECT_EQ(plc.rig.axis(0).set_position, 0);
    EXPECT_EQ(plc.rig.axis(1).set_position, 0);

    // Another command takes over.
    MC_MoveLinearRelative other;
    other.AxesGroup = plc.group;
    other.Velocity = 50;
    other.Distance.A.Axes = {1, 1};
    first.Execute = false;
    plc.scan();
    first.BufferMode = mcAborting;
    first.Position.A.Axes = {50, 0};
    first.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        first(ctx);
        other(ctx);
    };
    plc.run(30);
    other.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_FALSE(first.Busy || first.Done || first.Error);
    ASSERT_TRUE(plc.until([&] { return other.Done; }, 2000));
}

// G-010: exactly one.
TEST(GroupBlocks, StatusIsExactlyOneOfSix) {
    GroupPlc plc(2);
    MC_GroupReadStatus status;
    MC_GroupReadMotionState motion;
    MC_GroupEnable enable;
    MC_MoveLinearRelative move;
    MC_GroupStop stop;
    status.AxesGroup = motion.AxesGroup = enable.AxesGroup = move.AxesGroup = stop.AxesGroup = plc.group;
    status.Enable = motion.Enable = true;
    move.Distance.A.Axes = {50, 0};
    move.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) {
        enable(ctx);
        move(ctx);
        stop(ctx);
        status(ctx);
        motion(ctx);
        EXPECT_TRUE(status.Valid && status.Busy);
        EXPECT_EQ(status.GroupMoving + status.GroupHoming + status.GroupErrorStop + status.GroupStandby + status.GroupStopping +
                      status.GroupDisabled,
                  1);
    };
    plc.scan();
    EXPECT_TRUE(status.GroupDisabled);
    EXPECT_TRUE(motion.Standstill);
    enable.Execute = true;
    plc.scan();
    EXPECT_TRUE(status.GroupStandby);
    move.Execute = true;
    plc.run(3);
    EXPECT_TRUE(status.GroupMoving);
    EXPECT_TRUE(motion.Accelerating);
    EXPECT_FALSE(motion.Standstill);
    EXPECT_EQ(motion.ActiveCommandID.id, 1u);
    plc.run(200);
    EXPECT_TRUE(motion.ConstantVelocity);
    stop.Execute = true;
    plc.scan();
    EXPECT_TRUE(status.GroupStopping);
    ASSERT_TRUE(plc.until([&] { return motion.Decelerating; }, 90))
        << "the planner's answer comes behind its lead of 8 ms and a piece of 40";
    ASSERT_TRUE(plc.until([&] { return stop.Done; }, 300));
    EXPECT_TRUE(status.GroupStopping);
    stop.Execute = false;
    plc.run(2);
    EXPECT_TRUE(status.GroupStandby);
    EXPECT_FALSE(stop.Done);
    plc.rig.drives[1]->fault_code = 0x2310;
    ASSERT_TRUE(plc.until([&] { return status.GroupErrorStop; }, 20));
    status.Enable = false;
    plc.program = [&](const MotionContext& ctx) { status(ctx); };
    plc.scan();
    EXPECT_FALSE(status.Valid || status.GroupErrorStop);
}

// G-017, G-016
TEST(GroupBlocks, AnErrorIsReadUntilItIsReset) {
    EnabledPlc plc(2);
    MC_GroupReadError error;
    MC_GroupReset reset;
    MC_MoveLinearAbsolute wrong;
    error.AxesGroup = reset.AxesGroup = wrong.AxesGroup = plc.group;
    error.Enable = true;
    wrong.CoordSystem = mcMCS;
    wrong.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        wrong(ctx);
        reset(ctx);
        error(ctx);
    };
    plc.scan();
    EXPECT_TRUE(wrong.Error);
    EXPECT_EQ(wrong.ErrorID, ErrorId::no_kinematics);
    EXPECT_EQ(error.GroupErrorID, 0) << "what a block is refused for is no error of the group";
    plc.rig.drives[0]->fault_code = 0x2310;
    ASSERT_TRUE(plc.until([&] { return error.GroupErrorID != 0; }, 20));
    EXPECT_EQ(error.GroupErrorID, plc.rig.axis(0).error);
    plc.rig.drives[0]->fault_code = 0;
    reset.Execute = true;
    ASSERT_TRUE(plc.until([&] { return reset.Done; }, 5000));
    plc.scan();
    EXPECT_EQ(error.GroupErrorID, 0);
    EXPECT_EQ(plc.rig.view().state, axes::GroupState::GroupStandby);
}

// A room of 10 about x = 50: entered at 45, by an arm that is none but its axes.
TEST(GroupBlocks, ARefusalIsReadWithItsPlace) {
    std::vector<axes::AxisConfig> configs{group_axis("x"), group_axis("y"), group_axis("z")};
    axes::WorkspaceRoom far{.name = "far", .shape = axes::WorkspaceRoom::Shape::box, .kept_free = true, .half = {1, 1, 1}}, post = far;
    far.middle.position = {500, 0, 0};
    post.middle.position = {50, 0, 0};
    post.half = {5, 50, 50};
    GroupPlc plc(configs, axes::test::GroupRig::all_of(configs, axes::test::cartesian_arm(), {far, post}));
    MC_GroupEnable enable;
    plc.carry_out(enable);
    Group_ReadRefusal read;
    MC_MoveLinearAbsolute through, there;
    read.AxesGroup = through.AxesGroup = there.AxesGroup = plc.group;
    read.Enable = true;
    through.CoordSystem = there.CoordSystem = mcMCS;
    through.Position.C.Tcp = {.X = 100};
    there.Position.C.Tcp = {.X = 10};
    through.Velocity = there.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) {
        through(ctx);
        there(ctx);
        read(ctx);
    };
    plc.scan();
    EXPECT_TRUE(read.Valid);
    EXPECT_EQ(read.RefusedID, ErrorId::none);
    EXPECT_EQ(read.Number, 0u);
    through.Execute = true;
    ASSERT_TRUE(plc.until([&] { return through.Error; }, 100));
    plc.scan();
    EXPECT_EQ(through.ErrorID, ErrorId::outside_workspace);
    EXPECT_EQ(read.RefusedID, ErrorId::outside_workspace);
    EXPECT_EQ(read.Number, 1u);
    EXPECT_EQ(read.Room, 2) << "counted from 1";
    EXPECT_EQ(read.IdentInGroup, 0);
    EXPECT_TRUE(read.OnPath && read.InSpace);
    EXPECT_NEAR(read.Progress, 0.45, 1e-6);
    EXPECT_NEAR(read.X, 45, 1e-6);
    there.Execute = true;
    plc.run(3);
    EXPECT_EQ(read.RefusedID, ErrorId::none) << "another motion has begun";
    EXPECT_EQ(read.Room, 0);
    EXPECT_EQ(read.Number, 1u);
}

// G-008
// Who leaves the group while the block has Enable is let go by it, and does not stay under power with nobody to take it away.
TEST(GroupBlocks, PowerLetsGoWhoLeavesTheGroup) {
    GroupPlc plc({group_axis("x"), group_axis("y")}, {{.name = "g"}});
    MC_AddAxisToGroup add_x, add_y;
    add_x.Axis = {0};
    add_x.IdentInGroup = 1;
    add_y.Axis = {1};
    add_y.IdentInGroup = 2;
    plc.carry_out(add_x);
    plc.carry_out(add_y);
    plc.rig.powered = {false, false};
    MC_GroupPower power;
    power.AxesGroup = plc.group;
    power.Enable = true;
    MC_RemoveAxisFromGroup remove;
    remove.AxesGroup = plc.group;
    remove.IdentInGroup = 2;
    plc.program = [&](const MotionContext& ctx) {
        power(ctx);
        remove(ctx);
    };
    ASSERT_TRUE(plc.until([&] { return power.Status; }, 50));
    ASSERT_EQ(plc.rig.axis(1).state, axes::AxisState::Standstill) << "the control: it has power";
    remove.Execute = true;
    ASSERT_TRUE(plc.until([&] { return remove.Done; }, 50));
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(1).state == axes::AxisState::Disabled; }, 50));
    EXPECT_EQ(plc.rig.axis(0).state, axes::AxisState::Standstill) << "who stays keeps it";
    power.Enable = false;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).state == axes::AxisState::Disabled; }, 50));
}

TEST(GroupBlocks, PowerIsALevelOverAllMembers) {
    EnabledPlc plc(2);
    plc.rig.powered = {false, false};
    MC_GroupPower power;
    MC_Power single;
    power.AxesGroup = plc.group;
    single.Axis = {1};
    power.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        power(ctx);
        if (single.Enable) single(ctx);
    };
    plc.run(3);
    EXPECT_TRUE(power.Status && power.Valid);
    single.Enable = true;
    plc.scan();
    EXPECT_EQ(single.ErrorID, ErrorId::power_conflict);
    EXPECT_TRUE(power.Status);
    single.Enable = false;
    power.Enable = false;
    ASSERT_TRUE(plc.until([&] { return !power.Status; }, 50));
    EXPECT_EQ(plc.rig.axis(0).state, axes::AxisState::Disabled);
    EXPECT_EQ(plc.rig.view().state, axes::GroupState::GroupStandby) << "it changes no state";
}

// G-027, G-066, G-067 by their blocks.
TEST(GroupBlocks, AnInterruptedMoveKeepsBusyAndLosesActive) {
    EnabledPlc plc(2);
    MC_MoveLinearAbsolute move;
    MC_GroupInterrupt interrupt;
    MC_GroupContinue go_on;
    MC_GroupReadCommandInfo info;
    move.AxesGroup = interrupt.AxesGroup = go_on.AxesGroup = info.AxesGroup = plc.group;
    move.Position.A.Axes = {60, 80};
    move.Velocity = 100;
    info.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        interrupt(ctx);
        go_on(ctx);
        info.CommandID = move.CommandID;
        info(ctx);
    };
    go_on.Execute = true;
    plc.scan();
    EXPECT_EQ(go_on.ErrorID, ErrorId::nothing_interrupted);
    EXPECT_EQ(info.ErrorID, ErrorId::unknown_command);
    go_on.Execute = false;
    move.Execute = true;
    plc.run(400);
    EXPECT_TRUE(info.Valid);
    EXPECT_EQ(info.CommandState, mcActive);
    EXPECT_NEAR(info.RemainingDistance, 100 * (1 - info.Progress), 1e-9);
    EXPECT_NEAR(to_seconds(info.ElapsedDuration), 0.399, 0.0011);
    interrupt.Execute = true;
    plc.run(2);
    EXPECT_TRUE(move.Busy && !move.Active && !move.CommandAborted);
    ASSERT_TRUE(plc.until([&] { return interrupt.Done; }, 500));
    EXPECT_TRUE(move.Busy && !move.Active);
    EXPECT_EQ(info.CommandState, mcAccepted);
    go_on.Execute = true;
    plc.scan();
    EXPECT_TRUE(go_on.Done);
    plc.scan();
    EXPECT_TRUE(move.Active);
    const auto number = move.CommandID;
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 3000));
    EXPECT_EQ(plc.rig.axis(1).set_position, 80);
    MC_GroupReadCommandInfo late;
    late.AxesGroup = plc.group;
    late.Enable = true;
    late.CommandID = number;
    plc.program = [&](const MotionContext& ctx) { late(ctx); };
    plc.scan();
    EXPECT_NE(number.id, 0u);
    EXPECT_EQ(late.ErrorID, ErrorId::unknown_command) << "it is over";
}

// What MC_GroupStop has interrupted before it stood shows as an error: the block has no CommandAborted.
TEST(GroupBlocks, AnInterruptionThatAStopEndsIsAnError) {
    EnabledPlc plc(1);
    MC_MoveLinearRelative move;
    MC_GroupInterrupt interrupt;
    MC_GroupStop stop;
    move.AxesGroup = interrupt.AxesGroup = stop.AxesGroup = plc.group;
    move.Distance.A.Axes = {50};
    move.Velocity = 100;
    move.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        stop(ctx);
        interrupt(ctx);
    };
    plc.run(200);
    interrupt.Execute = true;
    plc.run(3);
    stop.Execute = true;
    plc.run(2);
    EXPECT_EQ(interrupt.ErrorID, ErrorId::aborted_by_command);
    EXPECT_TRUE(move.CommandAborted);
    ASSERT_TRUE(plc.until([&] { return stop.Done; }, 300));
}

// G-070
TEST(GroupBlocks, OverrideWritesWhileEnabledAndStays) {
    EnabledPlc plc(1);
    MC_GroupSetOverride factors;
    factors.AxesGroup = plc.group;
    factors.Enable = true;
    factors.VelFactor = 0.25;
    plc.program = [&](const MotionContext& ctx) { factors(ctx); };
    plc.scan();
    EXPECT_TRUE(factors.Enabled);
    EXPECT_EQ(plc.rig.view().override_factors.velocity, 0.25);
    factors.VelFactor = -1;
    plc.scan();
    EXPECT_EQ(factors.ErrorID, ErrorId::invalid_override);
    EXPECT_EQ(plc.rig.view().override_factors.velocity, 0.25);
    factors.Enable = false;
    plc.scan();
    EXPECT_FALSE(factors.Enabled || factors.Error);
    EXPECT_EQ(plc.rig.view().override_factors.velocity, 0.25);
}

TEST(GroupBlocks, ValuesAreReadInTheFramesThatThereAre) {
    EnabledPlc plc(3, axes::test::cartesian_arm());
    MC_MoveLinearAbsolute move;
    move.Position.C.Tcp = {.X = 3, .Y = 4, .Z = 12};
    move.CoordSystem = mcMCS;
    move.Velocity = 13;
    move.AxesGroup = plc.group;
    MC_GroupReadPosition place, target, flange;
    MC_GroupReadVelocity velocity;
    MC_GroupReadActualPosition actual;
    MC_GroupReadAcceleration measured;
    place.AxesGroup = target.AxesGroup = flange.AxesGroup = velocity.AxesGroup = actual.AxesGroup = measured.AxesGroup = plc.group;
    place.Enable = target.Enable = flange.Enable = velocity.Enable = actual.Enable = measured.Enable = true;
    place.CoordSystem = velocity.CoordSystem = mcMCS;
    target.Source = mcCommandedValue;
    flange.CoordSystem = mcFCS;
    measured.Source = mcActualValue;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        place(ctx);
        target(ctx);
        flange(ctx);
        velocity(ctx);
        actual(ctx);
        measured(ctx);
    };
    move.Execute = true;
    plc.run(500);
    EXPECT_NEAR(velocity.Velocity[0], 3, 0.03);
    EXPECT_NEAR(velocity.Velocity[2], 12, 0.12);
    EXPECT_NEAR(velocity.PathVelocity, 13, 0.13);
    EXPECT_NEAR(place.Position.C.Tcp.Z, 4 * place.Position.C.Tcp.X, 1e-9);
    EXPECT_EQ(target.Position.A.Axes[2], 12);
    EXPECT_EQ(flange.ErrorID, ErrorId::not_supported);
    EXPECT_EQ(measured.ErrorID, ErrorId::not_supported) << "nobody measures it";
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 2000));
    plc.run(5);
    EXPECT_NEAR(actual.Position[1], 4, 0.001);
    plc.rig.drives[1]->silent = true;
    ASSERT_TRUE(plc.until([&] { return actual.ErrorID == ErrorId::drive_not_ready; }, 50));
    EXPECT_EQ(actual.Position[1], 0) << "not Valid: no value";
}

TEST(GroupBlocks, MembersAreFoundByIdentifierAndByAxis) {
    EnabledPlc plc(2);
    MC_GroupReadConfiguration by_number;
    MC_ReadAxisGroupInfo by_axis;
    MC_GroupReadSWLimits limits;
    by_number.AxesGroup = limits.AxesGroup = plc.group;
    by_number.Enable = by_axis.Enable = limits.Enable = true;
    by_number.IdentInGroup = 2;
    by_axis.Axis = {1};
    plc.program = [&](const MotionContext& ctx) {
        by_number(ctx);
        by_axis(ctx);
        limits(ctx);
    };
    plc.scan();
    EXPECT_EQ(by_number.Axis, AxisRef{1});
    EXPECT_EQ(by_number.AxisID.number, 2);
    EXPECT_EQ(by_axis.AxesGroup, plc.group);
    EXPECT_EQ(by_axis.AxesGroupID.number, 1);
    EXPECT_EQ(by_axis.IdentInGroup, 2);
    EXPECT_EQ(limits.LimitValues.Axes[0].SWLimitPos, std::numeric_limits<double>::infinity());
    by_number.IdentInGroup = 3;
    plc.scan();
    EXPECT_EQ(by_number.ErrorID, ErrorId::invalid_member);
    EXPECT_FALSE(by_number.Axis.valid());
}

// G-020, G-030
TEST(GroupBlocks, WaitsAndDefaultsAreCommandsLikeOthers) {
    EnabledPlc plc(1);
    MC_GroupWriteDefaultDynamics write;
    write.Velocity = 20;
    plc.carry_out(write);
    MC_GroupReadDefaultDynamics read;
    MC_GroupWaitTime wait;
    MC_MoveDirectAbsolute move;
    MC_GroupHalt halt;
    read.AxesGroup = wait.AxesGroup = move.AxesGroup = halt.AxesGroup = plc.group;
    read.Enable = true;
    wait.Duration = std::chrono::milliseconds{20};
    move.Position.A.Axes = {10};
    move.BufferMode = mcBuffered;
    wait.Execute = move.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        wait(ctx);
        move(ctx);
        halt(ctx);
        read(ctx);
    };
    plc.scan();
    EXPECT_EQ(read.Velocity, 20);
    EXPECT_TRUE(wait.Active);
    EXPECT_NE(wait.CommandID.id, 0u);
    ASSERT_TRUE(plc.until([&] { return wait.Done; }, 40));
    plc.run(200);
    EXPECT_NEAR(plc.rig.axis(0).set_velocity, 20, 0.2);
    halt.Execute = true;
    plc.run(2);
    EXPECT_TRUE(move.CommandAborted);
    ASSERT_TRUE(plc.until([&] { return halt.Done; }, 200));
}

// A handle that was never given, and a task that sees no groups.
TEST(GroupBlocks, WithoutAGroupEveryBlockSaysSo) {
    EnabledPlc plc(1);
    MC_MoveLinearAbsolute move;
    MC_GroupReadStatus status;
    MC_GroupPower power;
    MC_GroupSetOverride factors;
    MC_GroupReset reset;
    MC_ReadAxisGroupInfo info;
    move.Execute = reset.Execute = status.Enable = power.Enable = factors.Enable = info.Enable = true;
    info.Axis = {0};
    const auto call = [&](const MotionContext& ctx) {
        move(ctx);
        status(ctx);
        power(ctx);
        factors(ctx);
        reset(ctx);
        info(ctx);
    };
    plc.program = call;
    plc.scan();
    for (const auto error : {move.ErrorID, status.ErrorID, power.ErrorID, factors.ErrorID, reset.ErrorID})
        EXPECT_EQ(error, ErrorId::invalid_group);
    EXPECT_EQ(info.ErrorID, ErrorId::none);
    plc.context.groups = nullptr;
    plc.scan();
    EXPECT_EQ(info.ErrorID, ErrorId::invalid_group);
}

}  // namespace
}  // namespace taktwerk::fb

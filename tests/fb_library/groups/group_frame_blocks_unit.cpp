// Blocks of frames, tools and the arm on a group, scan by scan. Expected numbers by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/axes/group/by_hand.hpp"
#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::test::cartesian_arm;
constexpr double quarter = std::numbers::pi / 2;

struct FramesPlc : GroupPlc {
    explicit FramesPlc(std::size_t count, axes::test::Arm arm) : GroupPlc(count, arm) {
        MC_GroupEnable enable;
        done(enable);
    }
    /// Carries it out; what it came to.
    template <class Block>
    ErrorId outcome(Block& block, int most = 20) {
        ErrorId error = ErrorId::none;
        bool over = false;
        block.AxesGroup = group;
        block.Execute = true;
        program = [&](const MotionContext& ctx) {
            block(ctx);
            over = block.Done || block.Error;
            error = block.ErrorID;
        };
        EXPECT_TRUE(until([&] { return over; }, most));
        const ErrorId came_to = error;
        block.Execute = false;
        scan();
        program = {};
        return came_to;
    }
    template <class Block>
    void done(Block& block, int most = 20) {
        EXPECT_EQ(outcome(block, most), ErrorId::none);
    }
    /// Calls a reading block once.
    template <class Block>
    void ask(Block& block) {
        block.AxesGroup = group;
        block.Enable = true;
        program = [&](const MotionContext& ctx) { block(ctx); };
        scan();
        program = {};
    }
};

// G-073, G-074: both blocks set the same, and each reads what the other has set, as it was written.
TEST(GroupFrameBlocks, BothTransformsAreOne) {
    FramesPlc plc(3, cartesian_arm());
    MC_SetCartesianTransform cartesian;
    cartesian.TransX = 1, cartesian.TransY = 2, cartesian.TransZ = 3;
    cartesian.RotAngle1 = 0.1, cartesian.RotAngle2 = 0.2, cartesian.RotAngle3 = 4;
    cartesian.CoordSystem = mcPCS_5;
    EXPECT_EQ(plc.outcome(cartesian), ErrorId::none);
    MC_ReadCoordinateTransform read;
    read.CoordSystem = mcPCS_5;
    plc.ask(read);
    ASSERT_TRUE(read.Valid);
    EXPECT_EQ(read.CoordTransform.Y, 2);
    EXPECT_EQ(read.CoordTransform.RX, 0.1);
    EXPECT_EQ(read.CoordTransform.RZ, 4) << "as it was written, beyond half a turn too";

    MC_SetCoordinateTransform coordinate;
    coordinate.CoordSystem = mcMCS;
    coordinate.CoordTransform = {.X = 7, .RZ = quarter};
    plc.done(coordinate);
    MC_ReadCartesianTransform machine, first, world, tool;
    machine.CoordSystem = mcMCS;
    plc.ask(machine);
    EXPECT_EQ(machine.TransX, 7);
    EXPECT_EQ(machine.RotAngle3, quarter);
    plc.ask(first);
    EXPECT_TRUE(first.Valid) << "mcPCS unless said otherwise";
    EXPECT_EQ(first.TransX, 0);
    world.CoordSystem = mcWCS;
    plc.ask(world);
    EXPECT_TRUE(world.Valid);
    tool.CoordSystem = mcTCS;
    plc.ask(tool);
    EXPECT_EQ(tool.ErrorID, ErrorId::not_supported);
    coordinate.CoordSystem = mcWCS;
    EXPECT_EQ(plc.outcome(coordinate), ErrorId::not_supported);
}

// G-026, G-028: a frame that waits for its turn is accepted, has a number, and is Done when the motion in front of it is over.
TEST(GroupFrameBlocks, AQueuedFrameIsBusyUntilItsTurn) {
    FramesPlc plc(3, cartesian_arm());
    MC_MoveLinearAbsolute move;
    move.AxesGroup = plc.group;
    move.Position.C.Tcp.X = 10;
    move.Velocity = 50;
    move.CoordSystem = mcMCS;
    move.Execute = true;
    MC_SetCoordinateTransform frame;
    frame.AxesGroup = plc.group;
    frame.CoordTransform.X = 5;
    frame.ExecutionMode = mcQueued;
    frame.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        frame(ctx);
    };
    plc.scan();
    plc.scan();
    EXPECT_TRUE(frame.Busy);
    EXPECT_TRUE(frame.CommandAccepted);
    EXPECT_NE(static_cast<std::uint32_t>(frame.CommandID), 0u);
    EXPECT_FALSE(frame.Done);
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 2000));
    ASSERT_TRUE(plc.until([&] { return frame.Done; }, 3));
    EXPECT_FALSE(frame.Error);
    EXPECT_EQ(plc.rig.groups.equipment(plc.group)->frames.product[0][0], 5);

    move.Execute = frame.Execute = false;
    plc.scan();
    move.Position.C.Tcp.X = 0;
    frame.CoordTransform.X = 9;
    move.Execute = frame.Execute = true;
    plc.scan();
    MC_GroupHalt halt;
    halt.AxesGroup = plc.group;
    halt.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        halt(ctx);
        move(ctx);
        frame(ctx);
    };
    plc.scan();
    plc.scan();
    EXPECT_TRUE(frame.CommandAborted);
    EXPECT_EQ(plc.rig.groups.equipment(plc.group)->frames.product[0][0], 5);
    ASSERT_TRUE(plc.until([&] { return halt.Done; }, 2000));
}

// Velocity and position in a frame that is turned by a quarter: the machine's X is against the product's Y.
TEST(GroupFrameBlocks, PositionsAndVelocitiesAreReadInEveryFrame) {
    FramesPlc plc(3, cartesian_arm());
    MC_SetCoordinateTransform frame;
    frame.CoordSystem = mcPCS_2;
    frame.CoordTransform = {.X = 10, .Y = 20, .Z = 1, .RZ = quarter};
    plc.done(frame);
    MC_MoveLinearAbsolute move;
    move.AxesGroup = plc.group;
    move.Position.C.Tcp.X = 30;
    move.Velocity = 20;
    move.CoordSystem = mcMCS;
    move.Execute = true;
    MC_GroupReadPosition position;
    MC_GroupReadVelocity velocity;
    MC_GroupReadActualPosition actual;
    position.AxesGroup = velocity.AxesGroup = actual.AxesGroup = plc.group;
    position.CoordSystem = velocity.CoordSystem = actual.CoordSystem = mcPCS_2;
    position.Enable = velocity.Enable = actual.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        position(ctx);
        velocity(ctx);
        actual(ctx);
    };
    ASSERT_TRUE(plc.until([&] { return velocity.PathVelocity > 19.98; }, 2000));
    ASSERT_TRUE(position.Valid && velocity.Valid && actual.Valid);
    EXPECT_NEAR(velocity.Velocity[0], 0, 1e-9);
    EXPECT_NEAR(velocity.Velocity[1], -20, 0.02);
    const double x = plc.rig.view().set_position[0];  // one cycle on
    EXPECT_NEAR(position.Position.C.Tcp.X, -20, 1e-9) << "y = 0 is 20 below the product's origin";
    EXPECT_NEAR(position.Position.C.Tcp.Y, 10 - x, 0.05);
    EXPECT_NEAR(position.Position.C.Tcp.Z, -1, 1e-9);
    EXPECT_NEAR(position.Position.C.Tcp.RZ, -quarter, 1e-12);
    EXPECT_TRUE(position.Position.C.Cfg.ConfigValid);
    EXPECT_NEAR(actual.Position[0], -20, 1e-3);
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 3000));
    plc.scan();
    EXPECT_NEAR(position.Position.C.Tcp.Y, -20, 1e-9);
    velocity.CoordSystem = mcFCS;
    position.CoordSystem = mcTCS;
    plc.scan();
    EXPECT_EQ(velocity.ErrorID, ErrorId::not_supported);
    EXPECT_EQ(position.ErrorID, ErrorId::not_supported);
}

// G-079, G-080: numbers come back as they were written; 0 is there and is not written; the running command keeps its tool as the active one.
TEST(GroupToolBlocks, ToolsAreWrittenReadAndSelected) {
    FramesPlc plc(3, cartesian_arm());
    MC_GroupWriteToolData write;
    write.ToolNumber = 4;
    write.ToolData.ToolFrame = {.X = 1, .Y = 2, .Z = 30};
    write.ToolData.RigidBodyDynamic = {.CenterOfGravity = {.Z = 15, .RX = 0.5}, .Mass = 1.5, .IX = 0.1, .IY = 0.2, .IZ = 0.3};
    EXPECT_EQ(plc.outcome(write), ErrorId::none);
    MC_GroupReadToolData read;
    read.ToolNumber = 4;
    plc.ask(read);
    ASSERT_TRUE(read.Valid);
    EXPECT_EQ(read.ToolData.ToolFrame.Z, 30);
    EXPECT_EQ(read.ToolData.RigidBodyDynamic.CenterOfGravity.RX, 0.5);
    EXPECT_EQ(read.ToolData.RigidBodyDynamic.Mass, 1.5);
    EXPECT_EQ(read.ToolData.RigidBodyDynamic.IZ, 0.3);
    for (const std::int16_t number : {std::int16_t{-1}, std::int16_t{5}, std::int16_t{260}}) {
        MC_GroupReadToolData none;
        none.ToolNumber = number;
        plc.ask(none);
        EXPECT_EQ(none.ErrorID, ErrorId::invalid_tool) << number;
        MC_GroupSelectTool select;
        select.ToolNumber = number;
        EXPECT_EQ(plc.outcome(select), ErrorId::invalid_tool) << number;
    }
    MC_GroupReadToolData flange;
    plc.ask(flange);
    EXPECT_TRUE(flange.Valid);
    EXPECT_EQ(flange.ToolData.ToolFrame.Z, 0);
    write.ToolNumber = 0;
    EXPECT_EQ(plc.outcome(write), ErrorId::invalid_tool);

    MC_MoveLinearAbsolute move;
    move.AxesGroup = plc.group;
    move.Position.C.Tcp.X = 10;
    move.Velocity = 20;
    move.CoordSystem = mcMCS;
    move.Execute = true;
    MC_GroupSelectTool select;
    select.AxesGroup = plc.group;
    select.ToolNumber = 4;
    MC_GroupReadTool active, selected;
    active.AxesGroup = selected.AxesGroup = plc.group;
    active.Enable = selected.Enable = true;
    selected.ToolSource = MC_ToolSource::mcSelected;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        select(ctx);
        active(ctx);
        selected(ctx);
    };
    plc.run(50);
    ASSERT_TRUE(move.Active);
    select.Execute = true;
    plc.run(2);
    EXPECT_TRUE(select.Done);
    EXPECT_EQ(active.ToolNumber, 0);
    EXPECT_EQ(selected.ToolNumber, 4);
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 3000));
    plc.run(2);
    EXPECT_EQ(active.ToolNumber, 4) << "nothing runs: what is selected counts";
    EXPECT_NEAR(plc.rig.view().tool_set[0], 11, 1e-9) << "the flange is at 10";
    EXPECT_NEAR(plc.rig.view().tool_set[2], 30, 1e-9);
}

// G-079, G-080: payloads and the bodies of links are kept, and move nothing.
TEST(GroupToolBlocks, PayloadsAndBodiesAreKeptAndMoveNothing) {
    FramesPlc plc(3, cartesian_arm());
    const auto before = plc.rig.view().tool_set;
    MC_GroupWritePayloadData write;
    write.PayloadNumber = 2;
    write.PayloadData = {.CenterOfGravity = {.X = 5}, .Mass = 4, .IX = 1, .IY = 2, .IZ = 3};
    plc.done(write);
    MC_GroupReadPayloadData read;
    read.PayloadNumber = 2;
    plc.ask(read);
    ASSERT_TRUE(read.Valid);
    EXPECT_EQ(read.PayloadData.CenterOfGravity.X, 5);
    EXPECT_EQ(read.PayloadData.Mass, 4);
    EXPECT_EQ(read.PayloadData.IY, 2);
    MC_GroupSelectPayload select;
    select.PayloadNumber = 2;
    EXPECT_EQ(plc.outcome(select), ErrorId::none);
    MC_GroupReadPayload active;
    plc.ask(active);
    EXPECT_EQ(active.PayloadNumber, 2);
    select.PayloadNumber = 9;
    EXPECT_EQ(plc.outcome(select), ErrorId::invalid_tool);
    write.PayloadData.Mass = -1;
    EXPECT_EQ(plc.outcome(write), ErrorId::invalid_parameter);

    MC_GroupWriteRigidBodyDynamic bodies;
    bodies.RigidBodyCount = 2;
    bodies.RigidBodyDynamic[1] = {.Mass = 12, .IX = 0.5};
    bodies.RigidBodyDynamic[2] = {.Mass = 99};
    plc.done(bodies);
    MC_GroupReadRigidBodyDynamic known;
    plc.ask(known);
    EXPECT_EQ(known.RigidBodyCount, 2);
    EXPECT_EQ(known.RigidBodyDynamic[1].Mass, 12);
    EXPECT_EQ(known.RigidBodyDynamic[2].Mass, 0) << "behind the count";
    bodies.RigidBodyCount = 9;
    EXPECT_EQ(plc.outcome(bodies), ErrorId::invalid_parameter);
    EXPECT_EQ(plc.rig.view().tool_set, before);
}

/// KUKA, KR 6 R900 sixx, specification: 400, 25, 455, 35, 420, 80 mm; at 0 the arm lies level to the front; axes 1, 4 and 6 count clockwise.
axes::test::Arm kr6() {
    axes::KinematicsDescription d{
        .arm = axes::SixJoints{.geometry = axes::WristArmLengths{.a1 = .025, .a2 = -.035, .c1 = .400, .c2 = .455, .c3 = .420, .c4 = .080}}};
    d.base = axes::pose_of_numbers({0.5, 0, 0.1, 0, 0, quarter});
    const double signs[] = {-1, 1, 1, -1, 1, -1};
    for (std::size_t i = 0; i < 6; ++i) d.joints[i].sign = signs[i];
    d.joints[1].zero = quarter;
    return axes::test::arm_of(d);
}

// MC_ReadKinTransform, MC_ReadJointInfo: as configured.
TEST(GroupArmBlocks, TheArmIsReadAsItIsConfigured) {
    FramesPlc plc(6, kr6());
    MC_ReadKinTransform kin;
    plc.ask(kin);
    ASSERT_TRUE(kin.Valid);
    EXPECT_EQ(kin.KinTransform.Kind, 7);
    EXPECT_EQ(kin.KinTransform.Joints, 6);
    EXPECT_TRUE(kin.KinTransform.ClosedForm);
    EXPECT_NEAR(kin.KinTransform.Base.X, 0.5, 1e-15);
    EXPECT_NEAR(kin.KinTransform.Base.RZ, quarter, 1e-15);
    MC_ReadJointInfo info;
    plc.ask(info);
    ASSERT_TRUE(info.Valid);
    EXPECT_EQ(info.JointInfo.Joints, 6);
    EXPECT_TRUE(info.JointInfo.Joint[0].Clockwise);
    EXPECT_FALSE(info.JointInfo.Joint[1].Clockwise);
    EXPECT_TRUE(info.JointInfo.Joint[3].Rotary);
    EXPECT_EQ(info.JointInfo.Joint[1].ZeroPosition, quarter);

    FramesPlc plain(2, {}), cartesian(3, cartesian_arm());
    MC_ReadKinTransform none;
    plain.ask(none);
    EXPECT_EQ(none.ErrorID, ErrorId::no_kinematics);
    MC_ReadDHParameters no_table;
    cartesian.ask(no_table);
    EXPECT_EQ(no_table.ErrorID, ErrorId::not_supported) << "no serial arm";
}

// MC_ReadDHParameters: the product of the six matrices of Denavit and Hartenberg, written out here, is where the arm's flange is.
TEST(GroupArmBlocks, TheTableOfTheLengthsIsTheArm) {
    using axes::test::hand_frame;
    FramesPlc plc(6, kr6());
    MC_ReadDHParameters table;
    MC_ReadJointInfo info;
    plc.ask(table);
    plc.ask(info);
    ASSERT_TRUE(table.Valid);
    EXPECT_FALSE(table.DHParameters.Modified);
    EXPECT_EQ(table.DHParameters.Joint[0].D, .400);
    for (const auto& q : {axes::JointVector{0.3, -0.4, 0.7, 1.1, -0.9, 0.2}, axes::JointVector{-2, 0.5, -1, 0.4, 1.3, -2.2}}) {
        auto at = hand_frame({0.5, 0, 0.1, 0, 0, quarter});  // the base
        for (std::size_t i = 0; i < 6; ++i) {
            const auto& row = table.DHParameters.Joint[i];
            const auto& joint = info.JointInfo.Joint[i];
            const double own = (joint.Clockwise ? -1 : 1) * q[i] + joint.ZeroPosition;
            // Classic: Rz(theta + q) Tz(d) Tx(a) Rx(alpha).
            at = at * hand_frame({0, 0, 0, 0, 0, row.Theta + own}) * hand_frame({row.A, 0, row.D, row.Alpha, 0, 0});
        }
        MC_GroupTransformPosition transform;
        transform.InputPosition.A.Axes = q;
        plc.ask(transform);
        ASSERT_TRUE(transform.Valid);
        const auto& t = transform.OutputPosition.C.Tcp;
        EXPECT_LE(axes::test::apart(at, hand_frame({t.X, t.Y, t.Z, t.RX, t.RY, t.RZ})), 1e-12);
    }
}

// G-076: in any state, moving nothing; with Cfg and turns the axes come back, across a turn; singular where the wrist is straight.
TEST(GroupArmBlocks, TransformsInAnyStateAndBack) {
    GroupPlc plc(6, kr6());
    ASSERT_EQ(plc.rig.view().state, axes::GroupState::GroupDisabled);
    const auto before = plc.rig.point();
    const axes::JointVector q{0.3, -0.8, 0.9, 4.1, 0.9, -3.9};
    MC_GroupTransformPosition there, again, straight;
    there.AxesGroup = again.AxesGroup = straight.AxesGroup = plc.group;
    there.InputPosition.A.Axes = q;
    there.OutputCoordSystem = mcWCS;
    there.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        there(ctx);
        again(ctx);
        straight(ctx);
    };
    plc.scan();
    ASSERT_TRUE(there.Valid);
    EXPECT_FALSE(there.SingularPosition);
    EXPECT_TRUE(there.OutputPosition.C.Cfg.ConfigValid);
    EXPECT_EQ(there.OutputPosition.C.TurnInfo.ATurns[3], 1) << "4.1 rad is beyond half a turn";
    EXPECT_EQ(there.OutputPosition.C.TurnInfo.ATurns[5], -1);
    again.InputPosition = there.OutputPosition;
    again.InputCoordSystem = mcWCS;
    again.OutputCoordSystem = mcACS;
    again.Enable = true;
    straight.InputPosition.A.Axes = {0.3, -0.8, 0.9, 0.5, 0, 0};
    straight.Enable = true;
    plc.scan();
    ASSERT_TRUE(again.Valid);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(again.OutputPosition.A.Axes[i], q[i], 1e-9) << i;
    EXPECT_TRUE(straight.Valid);
    EXPECT_TRUE(straight.SingularPosition);
    again.InputPosition.C.Tcp.X = 30;  // metres
    straight.InputPosition.A.Axes[2] = std::nan("");
    straight.OutputCoordSystem = mcMCS;
    plc.scan();
    EXPECT_EQ(again.ErrorID, ErrorId::out_of_reach);
    EXPECT_EQ(straight.ErrorID, ErrorId::invalid_position);
    again.OutputCoordSystem = mcFCS;
    plc.scan();
    EXPECT_EQ(again.ErrorID, ErrorId::not_supported);
    EXPECT_EQ(plc.rig.point(), before);
}

// G-042: a direct move goes to the way of the arm that it names, a path refuses another one than it stands in.
TEST(GroupArmBlocks, ADirectMoveTakesTheConfigurationItIsTold) {
    axes::KinematicsDescription d{.arm = axes::ScaraLengths{.first = 20, .second = 15, .height = 0}};
    FramesPlc plc(4, axes::test::arm_of(d));
    MC_MoveDirectAbsolute bend;
    bend.Position.A.Axes = {0.2, 1.2, 0, 0};
    bend.Velocity = 5;
    plc.done(bend, 5000);
    plc.run(3);
    MC_GroupReadPosition read;
    read.CoordSystem = mcMCS;
    plc.ask(read);
    ASSERT_TRUE(read.Valid);
    const bool elbow = read.Position.C.Cfg.Elbow;
    MC_MoveLinearAbsolute line;
    line.Position = read.Position;
    line.Position.C.Tcp.Y += 1;
    line.Position.C.Cfg.Elbow = !elbow;
    line.CoordSystem = mcMCS;
    line.Velocity = 5;
    EXPECT_EQ(plc.outcome(line, 5000), ErrorId::out_of_reach);
    MC_MoveDirectAbsolute over;
    over.Position = read.Position;
    over.Position.C.Cfg.Elbow = !elbow;
    over.CoordSystem = mcMCS;
    over.Velocity = 5;
    ASSERT_EQ(plc.outcome(over, 8000), ErrorId::none);
    // Two links: the other elbow is the mirror about the line to the point: q2 -> -q2.
    EXPECT_NEAR(plc.rig.point()[1], -1.2, 1e-9);
    const double reach = std::atan2(20 * std::sin(0.2) + 15 * std::sin(1.4), 20 * std::cos(0.2) + 15 * std::cos(1.4));
    EXPECT_NEAR(plc.rig.point()[0], 2 * reach - 0.2, 1e-9);
}

// G-077: without motion, absolute and relative, in the axes and in a frame; in motion refused, and nothing has changed.
// G-077: in the scan in which it is set, whoever is called behind it reads the new place, in every frame.
TEST(GroupArmBlocks, ASetPositionIsReadInTheSameScan) {
    FramesPlc plc(3, cartesian_arm());
    MC_GroupSetPosition set;
    set.AxesGroup = plc.group;
    set.Position.A.Axes = {100, 200, 300};
    MC_GroupReadPosition axes, machine;
    axes.AxesGroup = machine.AxesGroup = plc.group;
    axes.Enable = machine.Enable = true;
    machine.CoordSystem = mcMCS;
    set.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        set(ctx);
        axes(ctx);
        machine(ctx);
    };
    plc.scan();
    ASSERT_FALSE(set.Error);
    EXPECT_NEAR(axes.Position.A.Axes[1], 200, 1e-3);
    EXPECT_NEAR(machine.Position.C.Tcp.X, 100, 1e-3);
    EXPECT_NEAR(machine.Position.C.Tcp.Y, 200, 1e-3);
    EXPECT_NEAR(machine.Position.C.Tcp.Z, 300, 1e-3);
    EXPECT_NEAR(plc.rig.view().tool_set[1], 200, 1e-3);
    plc.program = {};
}

TEST(GroupArmBlocks, ThePositionOfTheGroupIsSetWithoutMotion) {
    FramesPlc plc(3, cartesian_arm());
    MC_GroupSetPosition set;
    set.Position.A.Axes = {100, 200, 300};
    EXPECT_EQ(plc.outcome(set), ErrorId::none);
    plc.run(3);
    EXPECT_NEAR(plc.rig.axis(1).actual_position, 200, 1e-3);
    EXPECT_NEAR(plc.rig.axis(1).set_position, 200, 1e-3);
    EXPECT_EQ(plc.rig.axis(0).state, axes::AxisState::Standstill);
    set.Relative = true;
    set.Position.A.Axes = {1, -2, 0};
    plc.done(set);
    plc.run(3);
    EXPECT_NEAR(plc.rig.axis(0).actual_position, 101, 1e-3);
    EXPECT_NEAR(plc.rig.axis(1).actual_position, 198, 1e-3);

    MC_SetCoordinateTransform frame;
    frame.CoordTransform = {.X = 10, .Y = 20, .RZ = quarter};
    plc.done(frame);
    MC_GroupSetPosition in_product;
    in_product.CoordSystem = mcPCS;
    in_product.Position.C.Tcp = {.X = 5, .Y = 0, .Z = 7, .RZ = -quarter};
    EXPECT_EQ(plc.outcome(in_product), ErrorId::none);
    plc.run(3);
    // 5 along the product's X, which is the machine's Y, from (10, 20).
    EXPECT_NEAR(plc.rig.axis(0).actual_position, 10, 1e-3);
    EXPECT_NEAR(plc.rig.axis(1).actual_position, 25, 1e-3);
    EXPECT_NEAR(plc.rig.axis(2).actual_position, 7, 1e-3);

    MC_MoveLinearAbsolute move;
    move.AxesGroup = plc.group;
    move.Position.A.Axes = {20, 25, 7};
    move.Velocity = 10;
    move.Execute = true;
    set.Relative = false;
    set.AxesGroup = plc.group;
    set.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        if (move.Active) set(ctx);
    };
    ASSERT_TRUE(plc.until([&] { return set.Error; }, 50));
    EXPECT_EQ(set.ErrorID, ErrorId::state_forbids);
    ASSERT_TRUE(plc.until([&] { return move.Done; }, 3000));
    EXPECT_NEAR(plc.rig.axis(0).set_position, 20, 1e-3);
    plc.program = {};
    plc.run(3);
    // One member that cannot: none has changed.
    plc.rig.powered[2] = false;
    plc.rig.drives[2]->offline = true;
    plc.run(5);
    MC_GroupSetPosition refused;
    EXPECT_NE(plc.outcome(refused), ErrorId::none);
    EXPECT_NEAR(plc.rig.axis(0).actual_position, 20, 1e-3);
}

}  // namespace
}  // namespace taktwerk::fb

// The blocks of moving frames on a group and a belt, scan by scan. Places by hand.

#include <gtest/gtest.h>

#include "tests/axes/group/track_rig.hpp"
#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::test::cartesian_arm;
using axes::test::GroupRig;

struct BeltPlc : GroupPlc {
    BeltPlc()
        : GroupPlc(axes::test::TrackRig::with(GroupRig::named(3), axes::test::belt_axis()),
                   GroupRig::all_of(GroupRig::named(3), cartesian_arm())) {
        MC_GroupEnable enable;
        EXPECT_EQ(carry_out(enable), ErrorId::none);
        rig.step([&] { (void)rig.axes[3].submit({.kind = axes::CommandKind::move_velocity, .velocity = 20}, axes::Owner::program); });
        run(500);
    }
    static constexpr AxisRef belt{3};
    [[nodiscard]] double belt_at() const { return rig.axis(3).set_position; }
};

// G-081, G-082: a light barrier's latch says where the belt was when the part stood in it: 12 u ago the part was at X = 30; now, it is at 42. The picker meets it.
TEST(GroupTrackingBlocks, APartIsPickedFromWhereABarrierSawIt) {
    BeltPlc plc;
    const double latched = plc.belt_at() - 12;
    MC_TrackConveyorBelt track;
    track.ConveyorBelt = BeltPlc::belt;
    track.ConveyorBeltOrigin = {.X = 5, .Y = 8};
    MC_MoveLinearAbsolute pick;
    pick.AxesGroup = track.AxesGroup = GroupPlc::group;
    pick.CoordSystem = mcPCS;
    pick.Position.C.Tcp.Z = -3;
    pick.Velocity = 50;
    bool seen = false;
    plc.program = [&](const MotionContext& ctx) {
        track.InitialObjectPosition.X = 30 + (ctx.axes[3].set_position - latched);
        track.Execute = true;
        track(ctx);
        seen = seen || track.Done;
        pick.Execute = seen;
        pick(ctx);
    };
    plc.scan();
    plc.scan();
    EXPECT_TRUE(track.Done);
    EXPECT_FALSE(track.Error);
    ASSERT_TRUE(plc.until([&] { return pick.Done || pick.Error; }, 3000));
    ASSERT_FALSE(pick.Error) << static_cast<int>(pick.ErrorID);
    for (int i = 0; i < 50; ++i) {
        plc.scan();
        ASSERT_NEAR(plc.rig.point()[0], 5 + 30 + plc.belt_at() - latched, 1e-9);
        ASSERT_NEAR(plc.rig.point()[1], 8, 1e-9);
        ASSERT_NEAR(plc.rig.point()[2], -3, 1e-9);
    }
    // What the frame is said to be is where the tool is.
    MC_ReadCoordinateTransform where;
    where.AxesGroup = GroupPlc::group;
    where.CoordSystem = mcPCS;
    where.Enable = true;
    plc.program = [&](const MotionContext& ctx) { where(ctx); };
    const double then = plc.belt_at();
    plc.scan();
    ASSERT_TRUE(where.Valid);
    EXPECT_NEAR(where.CoordTransform.X, 5 + 30 + then - latched, 1e-9);
}

// MC_GroupReadMotionState: Tracking, InSync, and Standstill, which is meant "relative to the active coordinate system".
TEST(GroupTrackingBlocks, TheMotionStateSaysThatItGoesWithABelt) {
    BeltPlc plc;
    MC_TrackConveyorBelt track;
    track.ConveyorBelt = BeltPlc::belt;
    ASSERT_EQ(plc.carry_out(track), ErrorId::none);
    MC_GroupReadMotionState how;
    MC_MoveLinearAbsolute pick, away;
    how.AxesGroup = pick.AxesGroup = away.AxesGroup = GroupPlc::group;
    how.Enable = true;
    pick.CoordSystem = mcPCS;
    pick.Position.C.Tcp.Z = -3;
    away.Position.A.Axes = {0, 0, 0};
    pick.Velocity = away.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) {
        pick(ctx);
        away(ctx);
        how(ctx);
    };
    plc.scan();
    EXPECT_TRUE(how.Valid);
    EXPECT_FALSE(how.Tracking);
    EXPECT_TRUE(how.Standstill);
    pick.Execute = true;
    ASSERT_TRUE(plc.until([&] { return how.Tracking && !how.Standstill; }, 100));
    EXPECT_FALSE(how.InSync) << "it still comes up to the belt";
    ASSERT_TRUE(plc.until([&] { return pick.Done; }, 3000));
    plc.run(2);
    EXPECT_TRUE(how.Tracking);
    EXPECT_TRUE(how.InSync);
    EXPECT_TRUE(how.Standstill) << "on the belt";
    EXPECT_NEAR(plc.rig.view().set_velocity[0], 20, 1e-9);
    away.Execute = true;
    plc.run(3);
    EXPECT_TRUE(how.Tracking);
    EXPECT_FALSE(how.InSync);
    EXPECT_FALSE(how.Standstill);
    ASSERT_TRUE(plc.until([&] { return away.Done; }, 3000));
    plc.run(2);
    EXPECT_FALSE(how.Tracking);
    EXPECT_TRUE(how.Standstill);
    how.Enable = false;
    plc.scan();
    EXPECT_FALSE(how.Standstill);
}

// G-085: behind the commands that use the frame another object may wait for its turn; at once it may not.
TEST(GroupTrackingBlocks, AnotherObjectWaitsOrIsRefused) {
    BeltPlc plc;
    MC_TrackConveyorBelt first, second;
    first.ConveyorBelt = second.ConveyorBelt = BeltPlc::belt;
    first.InitialObjectPosition.X = 10;
    ASSERT_EQ(plc.carry_out(first), ErrorId::none);
    MC_MoveLinearAbsolute pick;
    pick.AxesGroup = GroupPlc::group;
    pick.CoordSystem = mcPCS;
    pick.Velocity = 50;
    pick.Execute = true;
    plc.program = [&](const MotionContext& ctx) { pick(ctx); };
    plc.run(20);
    ASSERT_TRUE(pick.Busy);
    EXPECT_EQ(plc.carry_out(second), ErrorId::frame_in_use);
    second.InitialObjectPosition.X = 25;
    second.BufferMode = mcBuffered;
    EXPECT_EQ(plc.carry_out(second, 3000), ErrorId::none);
    EXPECT_TRUE(pick.Done);
    second.BufferMode = mcBlendingLow;
    EXPECT_EQ(plc.carry_out(second), ErrorId::buffer_mode_not_supported);
    second.BufferMode = mcAborting;
    second.CoordSystem = mcMCS;
    EXPECT_EQ(plc.carry_out(second), ErrorId::invalid_parameter);
    second.CoordSystem = mcPCS_3;
    second.ConveyorBelt = AxisRef{1};
    EXPECT_EQ(plc.carry_out(second), ErrorId::invalid_axis) << "a member moves with the group";
    MC_TrackRotaryTable table;
    table.RotaryTable = BeltPlc::belt;
    EXPECT_EQ(plc.carry_out(table), ErrorId::not_supported) << "this arm cannot turn its tool";
}

}  // namespace
}  // namespace taktwerk::fb

// MC_GroupJog, MC_GroupJogVector and their dynamics, scan by scan.

#include <gtest/gtest.h>

#include "tests/axes/group/jog_rig.hpp"
#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::GroupState;

struct JogPlc : GroupPlc {
    explicit JogPlc(std::size_t count, axes::test::Arm arm = {}, bool with_dynamics = true) : GroupPlc(count, arm) {
        MC_GroupEnable enable;
        carry_out(enable);
        if (with_dynamics) write(20);
        jog.AxesGroup = vector.AxesGroup = group;
        jog.Enable = true;
        program = [this](const MotionContext& ctx) { jog(ctx); };
    }
    void write(double velocity) {
        MC_GroupWriteJoggingDynamics dynamics;
        dynamics.Velocity = velocity;
        dynamics.Acceleration = dynamics.Deceleration = 200;
        dynamics.Jerk = 2000;
        dynamics.AxisVelocity.fill(velocity);
        dynamics.AxisAcceleration.fill(200);
        dynamics.AxisDeceleration.fill(200);
        dynamics.AxisJerk.fill(2000);
        carry_out(dynamics);
        EXPECT_EQ(dynamics.ErrorID, ErrorId::none);
    }
    MC_GroupJog jog;
    MC_GroupJogVector vector;
};

// G-089: Enabled without motion, GroupStandby; a key moves and lets go; both keys of a slot are none.
TEST(GroupJogging, KeysMoveAndBothKeysStand) {
    JogPlc plc(2);
    plc.run(5);
    EXPECT_TRUE(plc.jog.Enabled);
    EXPECT_FALSE(plc.jog.Active);
    EXPECT_EQ(plc.rig.view().state, GroupState::GroupStandby);
    plc.jog.JogPositive[1] = plc.jog.JogNegative[1] = true;
    plc.run(100);
    EXPECT_EQ(plc.rig.view().state, GroupState::GroupStandby);
    EXPECT_EQ(plc.rig.point()[1], 0);
    plc.jog.JogNegative[1] = false;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(1).set_velocity > 19.9; }, 600));
    EXPECT_TRUE(plc.jog.Active);
    EXPECT_TRUE(plc.jog.Enabled);
    plc.jog.JogNegative[1] = true;
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1000)) << "the other key as well: it stands";
    EXPECT_FALSE(plc.jog.Active);
    plc.jog.JogPositive[1] = false;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(1).set_velocity < -19.9; }, 600));
    plc.jog.Enable = false;
    plc.scan();
    EXPECT_FALSE(plc.jog.Enabled || plc.jog.Active || plc.jog.Error || plc.jog.CommandAborted);
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1000)) << "let go";
}

// G-089: without jogging dynamics an error, which goes with the key; with them it works.
TEST(GroupJogging, NeedsItsDynamics) {
    JogPlc plc(2, {}, false);
    plc.jog.JogPositive[0] = true;
    plc.run(3);
    EXPECT_TRUE(plc.jog.Error);
    EXPECT_EQ(plc.jog.ErrorID, ErrorId::invalid_velocity);
    EXPECT_FALSE(plc.jog.Enabled);
    plc.jog.JogPositive[0] = false;
    plc.run(2);
    EXPECT_FALSE(plc.jog.Error);
    EXPECT_TRUE(plc.jog.Enabled);
    plc.write(15);
    plc.jog.JogPositive[0] = true;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity > 14.9; }, 600));
    MC_GroupReadJoggingDynamics read;
    read.AxesGroup = plc.group;
    read.Enable = true;
    plc.program = [&](const MotionContext& ctx) { read(ctx); };
    plc.scan();
    EXPECT_TRUE(read.Valid);
    EXPECT_EQ(read.Velocity, 15);
    EXPECT_EQ(read.Deceleration, 200);
    EXPECT_EQ(read.AxisVelocity[1], 15);
    EXPECT_EQ(read.AxisJerk[0], 2000);
    // The block is not called any more: the lease ends it.
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1000));
}

// G-090: a distance ends it with the key still down; the next press goes the next one. Another command that takes over: CommandAborted.
TEST(GroupJogging, InchesAndIsTakenOver) {
    JogPlc plc(2);
    plc.jog.MaxLinearDistance = 1.5;
    for (int press = 1; press <= 3; ++press) {
        plc.jog.JogPositive[0] = true;
        ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupMoving; }, 100));
        ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1500));
        EXPECT_NEAR(plc.rig.point()[0], 1.5 * press, 1e-12);
        plc.run(50);
        EXPECT_EQ(plc.rig.view().state, GroupState::GroupStandby);
        EXPECT_TRUE(plc.jog.Enabled);
        plc.jog.JogPositive[0] = false;
        plc.run(2);
    }
    plc.jog.MaxLinearDistance = 0;
    plc.jog.JogPositive[0] = true;
    plc.run(200);
    MC_MoveLinearAbsolute move;
    move.Velocity = 30;
    plc.carry_out(move, 5000);
    EXPECT_EQ(move.ErrorID, ErrorId::none);
    EXPECT_EQ(plc.rig.point(), axes::JointVector{});
    EXPECT_TRUE(plc.jog.CommandAborted);
    EXPECT_FALSE(plc.jog.Enabled || plc.jog.Active || plc.jog.Error);
    plc.jog.Enable = false;
    plc.scan();
    EXPECT_FALSE(plc.jog.CommandAborted);
    plc.jog.Enable = true;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity > 19; }, 600)) << "enabled again, with the key down: pressed";
}

// Another frame while a key is down: it stands first. Shares that are none are an error, and it stands.
TEST(GroupJogging, InputsThatChangeWhileAKeyIsDown) {
    JogPlc plc(3, axes::test::cartesian_arm());
    plc.jog.JogPositive[0] = true;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity > 19; }, 600));
    plc.jog.CoordSystem = mcMCS;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity == 0; }, 1000));
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity > 19; }, 1000));
    plc.jog.VelOverride = 0.5;
    plc.run(300);
    EXPECT_NEAR(plc.rig.axis(0).set_velocity, 10, 0.02);
    plc.jog.AccOverride = 0;
    plc.scan();
    EXPECT_TRUE(plc.jog.Error);
    EXPECT_EQ(plc.jog.ErrorID, ErrorId::invalid_override);
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1000));
    plc.jog.AccOverride = 1;
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity > 9; }, 1000));
    EXPECT_FALSE(plc.jog.Error);
}

// G-091: the vector's length is a share of the velocity, changed while it moves; a small change of direction does not stop it, a greater one does;
// not in ACS.
TEST(GroupJogging, AVectorScalesAndTurns) {
    JogPlc plc(3, axes::test::cartesian_arm());
    plc.program = [&](const MotionContext& ctx) { plc.vector(ctx); };
    plc.vector.Enable = true;
    plc.vector.Direction = {0.3, 0.4, 0};
    plc.run(400);
    EXPECT_TRUE(plc.vector.Active);
    EXPECT_NEAR(plc.rig.view().path_velocity, 10, 0.02) << "half of 20";
    plc.vector.Direction = {6, 8, 0};
    plc.run(400);
    EXPECT_NEAR(plc.rig.view().path_velocity, 20, 0.04) << "longer than 1 is 1";
    plc.vector.Direction = {0.6 * 0.7, 0.8 * 0.7 + 0.02, 0};
    double slowest = 100;
    for (int i = 0; i < 400; ++i) {
        plc.scan();
        slowest = std::min(slowest, plc.rig.view().path_velocity);
    }
    EXPECT_GT(slowest, 13.9) << "it does not stop for some hundredths of a rad, nor is it slower than 14 on its way there";
    EXPECT_NEAR(plc.rig.point()[0] * 4, plc.rig.point()[1] * 3, 1e-8) << "on its line still";
    plc.vector.Direction = {0, 0, -1};
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(0).set_velocity == 0; }, 1000));
    const double x = plc.rig.point()[0];
    ASSERT_TRUE(plc.until([&] { return plc.rig.axis(2).set_velocity < -19; }, 1000));
    EXPECT_EQ(plc.rig.point()[0], x);
    plc.vector.Direction = {};
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupStandby; }, 1000));
    plc.vector.CoordSystem = mcACS;
    plc.vector.Direction = {1};
    plc.run(3);
    EXPECT_TRUE(plc.vector.Error);
    EXPECT_EQ(plc.vector.ErrorID, ErrorId::invalid_parameter);
    plc.vector.CoordSystem = mcMCS;
    plc.vector.Direction = {std::nan("")};
    plc.run(3);
    EXPECT_EQ(plc.vector.ErrorID, ErrorId::invalid_parameter);
    EXPECT_EQ(plc.rig.view().state, GroupState::GroupStandby);
}

// In GroupDisabled and GroupErrorStop: Error; a group that there is not; a restart presses nothing.
TEST(GroupJogging, WhereItCannotBe) {
    JogPlc plc(2);
    MC_GroupDisable disable;
    plc.carry_out(disable);
    plc.jog.JogPositive[0] = true;
    plc.run(3);
    EXPECT_EQ(plc.jog.ErrorID, ErrorId::group_disabled);
    MC_GroupEnable enable;
    plc.carry_out(enable);
    ASSERT_TRUE(plc.until([&] { return plc.jog.Active; }, 600)) << "the error goes, the key is down";
    plc.rig.drives[1]->fault_code = 0x2310;
    ASSERT_TRUE(plc.until([&] { return plc.rig.view().state == GroupState::GroupErrorStop; }, 20));
    plc.run(2);
    EXPECT_TRUE(plc.jog.Error);
    EXPECT_EQ(plc.jog.ErrorID, ErrorId::in_error_stop);
    EXPECT_FALSE(plc.jog.Active);
    plc.jog.AxesGroup = {7};
    plc.jog.Enable = false;
    plc.scan();
    plc.jog.Enable = true;
    plc.scan();
    EXPECT_EQ(plc.jog.ErrorID, ErrorId::invalid_group);
}

}  // namespace
}  // namespace taktwerk::fb

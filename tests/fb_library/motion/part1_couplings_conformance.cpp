// Section 4 of PLCopen Part 1 v2.0, replayed by the blocks on two real axes (fake drives, virtual time, infinite jerk). Expected values
// are the figures' and hand calculation.
#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/coupled_plc.hpp"
#include "tests/patience.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

/// The master runs at 100 u/s.
struct Coupling : testing::Test {
    Coupling() {
        lead.Axis = CoupledPlc::master;
        lead.Velocity = 100;
        lead.Execute = true;
    }
    double master() const { return plc.position(CoupledPlc::master); }
    double slave() const { return plc.position(CoupledPlc::slave); }
    double slave_velocity() const { return plc.velocity(CoupledPlc::slave); }
    AxisState slave_state() const { return plc.view(CoupledPlc::slave).state; }

    CoupledPlc plc;
    MC_MoveVelocity lead;
};

struct GearFigure : Coupling {
    GearFigure() {
        for (MC_GearIn* gear : {&first, &second}) {
            gear->Master = CoupledPlc::master, gear->Slave = CoupledPlc::slave;
            gear->Acceleration = gear->Deceleration = 100;
        }
        second.RatioNumerator = 2;
        out.Slave = CoupledPlc::slave;
        plc.program = [this](const MotionContext& ctx) {
            lead(ctx);
            first(ctx);
            second(ctx);
            out(ctx);
        };
        plc.run_until([this] { return lead.InVelocity; }, 5s);
    }
    MC_GearIn first, second;
    MC_GearOut out;
};

// Figure 43: First 1:1, Second 2:1, a = d = 100: 1 s each.
TEST_F(GearFigure, Figure43AnotherRatioWithoutGearOut) {  // P1-279, P1-276
    first.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_FALSE(first.InGear);
    EXPECT_EQ(slave_state(), AxisState::SynchronizedMotion);
    expect_time(plc.run_until([&] { return first.InGear; }, 5s), 1s);
    EXPECT_NEAR(slave_velocity(), 100, 1e-6);
    first.Execute = false;
    plc.run_for(10ms);
    EXPECT_TRUE(first.InGear);

    second.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_FALSE(first.InGear) << "aborted";
    EXPECT_FALSE(second.InGear);
    expect_time(plc.run_until([&] { return second.InGear; }, 5s), 1s);
    EXPECT_NEAR(slave_velocity(), 200, 1e-6);
    second.Execute = false;
    plc.run_for(10ms);
    EXPECT_TRUE(second.InGear);
    EXPECT_TRUE(second.Busy);
    EXPECT_EQ(plc.view(CoupledPlc::master).state, AxisState::ContinuousMotion) << "the master's own state";
    EXPECT_NEAR(plc.velocity(CoupledPlc::master), 100, 1e-9);
}

TEST_F(GearFigure, GearOutKeepsTheVelocityAndLeavesNoBlockActive) {  // P1-271, P1-272, P1-273
    first.Execute = true;
    plc.run_until([&] { return first.InGear; }, 5s);
    out.Execute = true;
    plc.run_until([&] { return out.Done; }, 1s);
    EXPECT_TRUE(out.Done);
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_EQ(slave_state(), AxisState::ContinuousMotion);
    for (int i = 0; i < 1000; ++i) {
        plc.scan();
        ASSERT_NEAR(slave_velocity(), 100, 1e-6);
        ASSERT_FALSE(first.Active || second.Active || out.Busy);
    }
    second.Execute = true;
    plc.run_until([&] { return second.InGear; }, 5s);
    EXPECT_TRUE(second.InGear) << "the next command is taken";
}

TEST_F(GearFigure, GearOutWithoutAGearIsAnError) {  // P1-031
    out.Execute = true;
    plc.scan();
    EXPECT_TRUE(out.Error);
    EXPECT_FALSE(out.Done);
}

// Figure 44: the slave stands at 0; from master 100 on it has 100 u of master, one second, to be at 50 with 100 u/s: an even ramp.
TEST_F(Coupling, Figure44GearInPosOfASlaveAtRest) {  // P1-285, P1-280, P1-281
    MC_GearInPos gear;
    gear.Master = CoupledPlc::master, gear.Slave = CoupledPlc::slave;
    gear.MasterSyncPosition = 200, gear.SlaveSyncPosition = 50, gear.MasterStartDistance = 100;
    gear.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        lead(ctx);
        gear(ctx);
    };
    for (Patience patience; patience.lasts(master() < 99);) {
        plc.scan();
        ASSERT_FALSE(gear.StartSync || gear.InSync || gear.Error);
        ASSERT_EQ(slave(), 0);
    }
    plc.run_until([&] { return gear.StartSync; }, 1s);
    EXPECT_NEAR(master(), 100, 0.5);
    plc.run_until([&] { return gear.InSync; }, 5s);
    EXPECT_FALSE(gear.StartSync);
    EXPECT_NEAR(master(), 200, 0.5);
    for (int i = 0; i < 1000; ++i) {
        ASSERT_NEAR(slave(), 50 + (master() - 200), 1e-6);
        ASSERT_TRUE(gear.InSync);
        plc.scan();
    }
}

/// Rest to rest from 0 to 25 at 50 and back to 0 at 100, fifth order.
struct CamFigure : Coupling {
    CamFigure() {
        const std::array points{axes::CamPoint{0, 0}, axes::CamPoint{50, 25}, axes::CamPoint{100, 0}};
        select.Slave = follow.Slave = CoupledPlc::slave;
        follow.Master = CoupledPlc::master;
        select.CamTable = plc.tables.add_cam(points);
        select.Periodic = select.MasterAbsolute = select.SlaveAbsolute = true;
        plc.program = [this](const MotionContext& ctx) {
            lead(ctx);
            select(ctx);
            follow.CamTableID = select.CamTableID;
            follow(ctx);
            ends += follow.EndOfProfile;
        };
        lead.Execute = false;
    }
    static double cam(double at) {
        const double x = at < 50 ? at / 50 : (100 - at) / 50;
        return 25 * x * x * x * (10 - 15 * x + 6 * x * x);
    }
    MC_CamTableSelect select;
    MC_CamIn follow;
    int ends = 0;
};

TEST_F(CamFigure, CamInNeedsTheIdOfADoneSelection) {  // P1-259
    follow.Execute = true;
    plc.scan();
    EXPECT_TRUE(follow.Error);
    EXPECT_EQ(follow.ErrorID, ErrorId::invalid_table);
    follow.Execute = false;
    select.Execute = true;
    plc.run_until([&] { return select.Done; }, 1s);
    follow.Execute = true;
    plc.run_until([&] { return follow.InSync; }, 1s);
    EXPECT_FALSE(follow.Error);
    EXPECT_TRUE(follow.InSync);
}

TEST_F(CamFigure, TheSlaveIsWhereTheProfileSaysInEveryCycleAndPeriod) {  // P1-270, P1-253, P1-268
    select.Execute = true;
    plc.run_until([&] { return select.Done; }, 1s);
    follow.Execute = true;
    plc.run_until([&] { return follow.InSync; }, 1s);
    lead.Execute = true;
    for (Patience patience; patience.lasts(master() < 350);) {
        plc.scan();
        ASSERT_NEAR(slave(), cam(std::fmod(master(), 100)), 1e-6) << master();
        ASSERT_EQ(slave_state(), AxisState::SynchronizedMotion);
    }
    EXPECT_EQ(ends, 3) << "one call at each end";
    lead.Execute = false;
    plc.scan();
    lead.Velocity = -100;  // inversely
    lead.Execute = true;
    plc.run_until([&] { return master() < 120; }, 10s);
    EXPECT_NEAR(slave(), cam(std::fmod(master(), 100)), 1e-6);
    EXPECT_EQ(ends, 5) << "at 300 and at 200, backwards";
}

/// On a gear 1:1.
struct PhasingFigure : GearFigure {
    PhasingFigure() {
        absolute.Master = relative.Master = CoupledPlc::master;
        absolute.Slave = relative.Slave = CoupledPlc::slave;
        absolute.Velocity = relative.Velocity = 50;
        absolute.Acceleration = absolute.Deceleration = relative.Acceleration = relative.Deceleration = 100;
        plc.program = [this](const MotionContext& ctx) {
            lead(ctx);
            first(ctx);
            absolute(ctx);
            relative(ctx);
        };
        first.Execute = true;
        plc.run_until([this] { return first.InGear; }, 5s);
        apart = slave() - master();
    }
    template <class Block>
    void shift(Block& block, double by) {
        block.Execute = false;
        plc.scan();
        block.PhaseShift = by;
        block.Execute = true;
        plc.run_until([&] { return block.Done || block.Error; }, 10s);
        EXPECT_TRUE(block.Done);
        plc.run_for(10ms);
    }
    MC_PhasingAbsolute absolute;
    MC_PhasingRelative relative;
    double apart = 0;
};

TEST_F(PhasingFigure, AbsoluteTwiceIsOnce) {  // P1-292, P1-290, P1-291
    shift(absolute, 10);
    EXPECT_NEAR(slave() - master() - apart, 10, 1e-6);
    EXPECT_NEAR(absolute.AbsolutePhaseShift, 10, 1e-6);
    shift(absolute, 10);
    EXPECT_NEAR(slave() - master() - apart, 10, 1e-6);
    plc.run_for(1s);
    EXPECT_NEAR(slave() - master() - apart, 10, 1e-6) << "stays";
    EXPECT_NEAR(plc.velocity(CoupledPlc::master), 100, 1e-9);
}

TEST_F(PhasingFigure, RelativeTwiceIsTwiceAndTheGearStaysActive) {  // P1-293, P1-297
    shift(relative, 10);
    EXPECT_NEAR(relative.CoveredPhaseShift, 10, 1e-6);
    relative.Execute = false;
    plc.scan();
    relative.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(relative.Active);
    EXPECT_TRUE(first.Active) << "both";
    EXPECT_EQ(slave_state(), AxisState::SynchronizedMotion);
    plc.run_until([&] { return relative.Done; }, 10s);
    plc.run_for(10ms);
    EXPECT_NEAR(slave() - master() - apart, 20, 1e-6);
}

}  // namespace
}  // namespace taktwerk::fb

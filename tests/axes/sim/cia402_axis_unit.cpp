// The simulated axis against the manuals' state machines and homing tables, driven by its objects alone.

#include <gtest/gtest.h>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

// SV33-E manual 3.4.1: 6 -> 7 -> 15 through Ready (21h), Switched On (23h), Operation Enabled (27h).
TEST(SimulatedAxis, EnablesBy6Then7Then15) {
    Bench b;
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
    b.command(6);
    EXPECT_EQ(b.state(), 0x21u);
    b.command(7);
    EXPECT_EQ(b.state(), 0x23u);
    b.command(15);
    EXPECT_EQ(b.state(), 0x27u);
}

TEST(SimulatedAxis, DoesNotSkipStates) {
    Bench b;
    b.command(15);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(SimulatedAxis, FollowsTargetsWithASmallHonestFollowingError) {
    Bench b;
    b.enable();
    std::int64_t worst = 0;
    for (int i = 0; i < 500; ++i) {  // 50 counts each ms: 5 turns/s
        b.in.target_position += 50;
        b.cycle();
        worst = std::max(worst, std::abs(b.out.following_error));
    }
    EXPECT_GT(worst, 0);
    EXPECT_LT(worst, 2000);
    b.run(200);
    EXPECT_NEAR(static_cast<double>(b.out.position), 25000.0, 3.0);
    EXPECT_TRUE(b.out.status & (1u << 10));
}

TEST(SimulatedAxis, AFaultFallsThroughReactionAndIsResetByTheEdgeOfBit7) {
    Bench b;
    b.enable();
    b.axis.raise(0x3130);
    b.run(100);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
    EXPECT_EQ(b.out.error_code, 0x3130);

    b.command(0x0006);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u) << "no way out without a reset";
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
    EXPECT_EQ(b.out.error_code, 0);
    b.command(0x0086);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u) << "while bit 7 stands nothing else is taken";
    b.command(0x0006);
    EXPECT_EQ(b.state(), 0x21u);
}

// SV33-E manual 5.1: "for faults first remove servo enable, then reset".
TEST(SimulatedAxis, ResetWithEnableStillSetIsIgnoredWhereTheDriveWantsItDropped) {
    DriveProfile p;
    p.quirks = {Quirk::fault_reset_needs_disable};
    Bench b{table(), p};
    b.enable();
    b.axis.raise(0x3130);
    b.run(100);
    b.command(0x008F);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
    b.command(0x0000);
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(SimulatedAxis, AFaultThatNeedsAPowerCycleStays) {
    Bench b;
    b.axis.raise(0x2312, false);  // SV33-E E.210 hardware over-current: not resettable
    b.command(0x0000);
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
    b.axis.power_on(b.now);
    b.command(0x0000);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(SimulatedAxis, AJammedLoadTripsTheFollowingErrorAlarm) {
    SimulatedMotor m;
    m.following_error_limit = 2000;
    Bench b{table(), {}, m};
    b.enable();
    b.axis.jam(true);
    for (int i = 0; i < 100; ++i) {
        b.in.target_position += 50;
        b.cycle();
    }
    EXPECT_EQ(b.out.error_code, 0x8611);  // SV33-E E.423, SE-808X position error too large
}

// SV33-E manual 5.4, E.424: a target that leaps several times trips; one leap does not.
TEST(SimulatedAxis, LeapingTargetsTripAfterThreeStrikes) {
    SimulatedMotor m;
    m.maximum_velocity = 500000;  // counts/s: 500 counts a cycle, leaps beyond 1500 count
    Bench b{table(), {}, m};
    b.enable();
    b.in.target_position += 1600;
    b.cycle();
    b.run(20);
    EXPECT_EQ(b.out.error_code, 0);
    for (int i = 0; i < 3; ++i) {
        b.in.target_position += 1600;
        b.cycle();
    }
    EXPECT_EQ(b.out.error_code, 0x0424);
}

TEST(SimulatedAxis, LosingTheBusWhileEnabledIsAnAlarm) {
    DriveProfile p;
    p.alarms = {{.code = 0x0D26, .kind = DriveAlarmKind::communication}};  // SV33-E E.D26
    Bench b{table(), p};
    b.enable();
    b.axis.communication_lost();
    b.run(50);
    EXPECT_EQ(b.out.error_code, 0x0D26);
}

TEST(SimulatedAxis, LosingMainPowerIsUndervoltageAndCannotBeResetBeforeItReturns) {
    Bench b;
    b.enable();
    b.axis.main_power(false);
    b.run(100);
    EXPECT_EQ(b.out.error_code, 0x3220);
    EXPECT_FALSE(b.out.status & (1u << 4));
    b.command(0x0000);
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
    b.axis.main_power(true);
    b.command(0x0000);
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

// SV33-E manual 3.1.4 / CiA 402: overtravel as a warning holds the position and leaves only the way back.
TEST(SimulatedAxis, OvertravelAsWarningHoldsAndAllowsRetreat) {
    DriveProfile p;
    p.quirks = {Quirk::limit_stop_is_warning};
    auto plant = table();
    plant.start = 49000;
    Bench b{plant, p};
    b.enable();
    for (int i = 0; i < 200; ++i) {
        b.in.target_position += 20;
        b.cycle();
    }
    EXPECT_EQ(b.out.error_code, 0x5443);
    EXPECT_TRUE(b.out.status & (1u << 7));
    EXPECT_EQ(b.state(), 0x27u);
    b.in.target_position = b.out.position;
    for (int i = 0; i < 200; ++i) {
        b.in.target_position -= 20;
        b.cycle();
    }
    EXPECT_EQ(b.out.error_code, 0);
    EXPECT_FALSE(b.out.digital_inputs & 2u);
}

TEST(SimulatedAxis, AModeSwitchNeverMovesTheMotor) {
    Bench b;
    b.enable();
    b.in.target_position = 100;
    b.run(50);
    const double before = b.axis.plant().position();
    b.in.mode = 6;
    b.in.target_position = 30000;  // garbage in the target while homing is selected
    b.run(20);
    EXPECT_NEAR(b.axis.plant().position(), before, 2.0);
}

}  // namespace
}  // namespace taktwerk::axes::sim

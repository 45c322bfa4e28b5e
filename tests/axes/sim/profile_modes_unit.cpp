// PP, PV and PT of the simulated drive, its ways of stopping and its rules for changing modes.

#include <gtest/gtest.h>

#include <cmath>

#include "axes/sim/cia402_device.hpp"
#include "tests/axes/sim/axis_bench.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::sim {
namespace {

constexpr unsigned reached = 0x0400, limited = 0x0800, bit_12 = 0x1000;

/// 20000 counts/s, 100000 counts/s2 up and down.
Bench profile_bench(int mode, const DriveProfile& profile = {}) {
    Bench b{long_table(), profile};
    b.in.mode = mode;
    b.in.profile_velocity = 20000;
    b.in.profile_acceleration = b.in.profile_deceleration = 100000;
    b.in.quick_stop_deceleration = 200000;
    b.enable();
    return b;
}

void set_point(Bench& b, std::int64_t target, unsigned word = 0x1F) {
    b.in.target_position = target;
    b.in.control = static_cast<std::uint16_t>(word & ~0x10u);
    b.cycle();
    b.in.control = static_cast<std::uint16_t>(word);
    b.cycle();
}

// CiA 402-2, SV33-E 3.4.3(5): bit 4 rises, bit 12 answers, bit 4 falls, bit 12 falls; bit 10 falls and comes with arrival. 10000 counts take
// 0.2 s up, 0.2 s down and 6000 counts at 20000: 0.7 s.
TEST(ProfilePositionMode, TheHandshakeOfASingleSetPoint) {
    auto b = profile_bench(1);
    EXPECT_EQ(b.out.mode, 1);
    set_point(b, 10000);
    EXPECT_NE(b.out.status & bit_12, 0u);
    b.run(2);
    EXPECT_EQ(b.out.status & reached, 0u);
    b.in.control = 0x0F;
    b.cycle();
    EXPECT_EQ(b.out.status & bit_12, 0u);
    b.run(340);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 20000, 200);
    b.run(340);
    EXPECT_EQ(b.out.status & reached, 0u);
    b.run(60);
    EXPECT_NE(b.out.status & reached, 0u);
    EXPECT_NEAR(static_cast<double>(b.out.position), 10000, 3);
}

TEST(ProfilePositionMode, ARelativeSetPointCountsFromTheLastTarget) {
    auto b = profile_bench(1);
    set_point(b, 3000);
    b.command(0x0F, 800);
    set_point(b, -1000, 0x5F);
    b.command(0x0F, 800);
    EXPECT_NEAR(static_cast<double>(b.out.position), 2000, 3);
}

// SV33-E 3.4.3(5) case 2: one more set-point waits; bit 12 stays until the first is finished; the motor stands between the two.
TEST(ProfilePositionMode, ABufferOfOneAcknowledgesWhenItHasRoomAgain) {
    auto b = profile_bench(1);
    set_point(b, 5000);
    b.command(0x0F, 5);
    set_point(b, 10000);
    b.command(0x0F, 5);
    EXPECT_NE(b.out.status & bit_12, 0u) << "full";
    set_point(b, 99999);  // lost: no room
    b.in.control = 0x0F;
    std::int64_t slowest = 20000;
    for (int i = 0; i < 500; ++i) {
        b.cycle();
        if (i > 300) slowest = std::min(slowest, b.out.velocity);
    }
    EXPECT_EQ(b.out.status & bit_12, 0u);
    EXPECT_LT(slowest, 500);
    b.run(600);
    EXPECT_NEAR(static_cast<double>(b.out.position), 10000, 3);
}

// SV-DA200 3.2.7: eight levels.
TEST(ProfilePositionMode, ABufferOfEightTakesNineSetPoints) {
    DriveProfile p;
    p.profile_buffer = 8;
    auto b = profile_bench(1, p);
    for (int i = 1; i <= 9; ++i) {
        set_point(b, 1000 * i);
        b.command(0x0F, 1);
        EXPECT_EQ((b.out.status & bit_12) != 0, i == 9) << i;
    }
    b.run(4000);
    EXPECT_NEAR(static_cast<double>(b.out.position), 9000, 3);
    EXPECT_NE(b.out.status & reached, 0u);
}

// CiA 402-2: bit 5 abandons the running set-point.
TEST(ProfilePositionMode, ChangeImmediatelyTakesOver) {
    auto b = profile_bench(1);
    set_point(b, 100000);
    b.command(0x0F, 400);
    ASSERT_GT(b.out.velocity, 19000);
    set_point(b, 2000, 0x3F);
    b.command(0x0F, 1500);
    EXPECT_NEAR(static_cast<double>(b.out.position), 2000, 3);
}

// SE-808X 3.2.4: bit 5 keeps the speed at X1 and goes on to X2.
TEST(ProfilePositionMode, WithBlendingBitFiveTheSpeedIsKeptAtTheFirstTarget) {
    DriveProfile p;
    p.quirks = {Quirk::pp_bit_5_blends};
    auto b = profile_bench(1, p);
    set_point(b, 8000);
    b.command(0x0F, 5);
    set_point(b, 16000, 0x3F);
    b.in.control = 0x0F;
    for (Patience patience; patience.lasts(b.out.position < 3000);) b.cycle();
    double slowest = 20000;
    for (Patience patience; patience.lasts(b.out.position < 12000);) {
        b.cycle();
        slowest = std::min(slowest, static_cast<double>(b.out.velocity));
    }
    EXPECT_GT(slowest, 19500);
    b.run(1000);
    EXPECT_NEAR(static_cast<double>(b.out.position), 16000, 3);
}

// SV-DA200 3.2.3: 6083h is both ramps. 20000 counts/s by 50000 counts/s2 takes 0.4 s and 4000 counts; 6084h would be four times as hard.
TEST(ProfilePositionMode, WithASharedRampSixtyEightyFourIsNotUsed) {
    DriveProfile p;
    p.quirks = {Quirk::pp_shared_ramp};
    auto b = profile_bench(1, p);
    b.in.profile_acceleration = 50000;
    b.in.profile_deceleration = 200000;
    set_point(b, 20000);
    b.in.control = 0x0F;
    for (Patience patience; patience.lasts(b.out.position < 18000);) b.cycle();
    // 2000 counts before the end: v^2 = 2 * 50000 * 2000.
    EXPECT_NEAR(static_cast<double>(b.out.velocity), std::sqrt(2 * 50000.0 * 2000), 300);
}

// SE-808X 9.1 item 3: zeros in the cyclic 6081h and 6083h really hold.
TEST(ProfilePositionMode, ZerosInSpeedOrRampMoveNothing) {
    auto b = profile_bench(1);
    b.in.profile_velocity = 0;
    set_point(b, 10000);
    b.command(0x0F, 500);
    EXPECT_NEAR(static_cast<double>(b.out.position), 0, 1);
    EXPECT_EQ(b.out.status & reached, 0u);
}

// Halt with 6084h; CiA 402-2: taken back, the motion goes on. SV-DA200 3.2.7: it must be triggered again.
TEST(ProfilePositionMode, AfterAHaltTheMotionGoesOnOrIsForgotten) {
    for (const bool forgets : {false, true}) {
        DriveProfile p;
        if (forgets) p.quirks = {Quirk::pp_stop_forgets};
        auto b = profile_bench(1, p);
        set_point(b, 20000);
        b.command(0x0F, 400);
        ASSERT_GT(b.out.velocity, 19000);
        const double from = static_cast<double>(b.out.position);
        b.command(0x10F, 400);
        // v^2 / 2a = 2000 counts, and a cycle's way.
        EXPECT_NEAR(static_cast<double>(b.out.position) - from, 2000, 100);
        EXPECT_EQ(b.state(), 0x27u);
        EXPECT_NE(b.out.status & reached, 0u) << "with halt bit 10 means standstill";
        b.command(0x0F, 1500);
        if (forgets) EXPECT_NEAR(static_cast<double>(b.out.position) - from, 2000, 100);
        else EXPECT_NEAR(static_cast<double>(b.out.position), 20000, 3);
    }
}

// 607Fh bounds the speed (SV33-E 3.4.3(5)); bit 11 says so.
TEST(ProfilePositionMode, TheMaximumSpeedBoundsIt) {
    auto b = profile_bench(1);
    b.in.maximum_velocity = 5000;
    set_point(b, 20000);
    b.command(0x0F, 500);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 5000, 100);
    EXPECT_NE(b.out.status & limited, 0u);
}

// 60FFh by 6083h and 6084h: 20000 by 100000 takes 200 ms; through zero both ramps count, one after the other.
TEST(ProfileVelocityMode, RampsUpDownAndThroughZero) {
    auto b = profile_bench(3);
    b.in.profile_deceleration = 200000;
    EXPECT_NE(b.out.status & bit_12, 0u) << "speed zero";
    b.in.target_velocity = 20000;
    b.run(101);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 10000, 300);
    EXPECT_EQ(b.out.status & (reached | bit_12), 0u);
    b.run(250);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 20000, 20);
    EXPECT_NE(b.out.status & reached, 0u);
    b.in.target_velocity = -10000;
    b.run(101);  // 100 ms to zero by 6084h
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 0, 300);
    b.run(100);  // 100 ms to -10000 by 6083h
    EXPECT_NEAR(static_cast<double>(b.out.velocity), -10000, 300);
}

// SV33-E 8.5.5: "if 60FF is accepted but nothing moves, check whether the ramps are 0".
TEST(ProfileVelocityMode, ARampOfZeroMovesNothing) {
    auto b = profile_bench(3);
    b.in.profile_acceleration = 0;
    b.in.target_velocity = 20000;
    b.run(300);
    EXPECT_EQ(b.out.velocity, 0);
}

TEST(ProfileVelocityMode, WithoutTheSpeedZeroBitItStaysOff) {
    DriveProfile p;
    p.quirks = {Quirk::pv_bits_12_13_reserved};
    auto b = profile_bench(3, p);
    EXPECT_EQ(b.out.status & bit_12, 0u);
}

// 6087h: 1000 per s of 0.1 % reaches 20 % after 200 ms. 2^32 - 1 means at once (SV33-E 7.3), 0 no torque (8.5.6).
TEST(ProfileTorqueMode, TheSlopeLeadsToTheTorque) {
    auto b = profile_bench(4);
    b.in.maximum_velocity = 1000000;
    b.in.torque_slope = 1000;
    b.in.target_torque = 200;
    b.run(101);
    EXPECT_NEAR(static_cast<double>(b.out.torque), 100, 2);
    EXPECT_EQ(b.out.status & reached, 0u);
    b.run(110);
    EXPECT_NEAR(static_cast<double>(b.out.torque), 200, 1);
    EXPECT_NE(b.out.status & reached, 0u);
    b.in.torque_slope = 0xFFFFFFFF;
    b.in.target_torque = 50;
    b.run(2);
    EXPECT_NEAR(static_cast<double>(b.out.torque), 50, 1);
    b.in.torque_slope = 0;
    b.in.target_torque = 200;
    b.run(100);
    EXPECT_NEAR(static_cast<double>(b.out.torque), 50, 1);
}

// SV-DA200 3.6: 6083h and 6084h act in CSV too.
TEST(CyclicVelocityMode, SomeDrivesRampOnTopOfTheMaster) {
    for (const bool ramps : {false, true}) {
        DriveProfile p;
        if (ramps) p.quirks = {Quirk::csv_ramps};
        auto b = profile_bench(9, p);
        b.in.target_velocity = 10000;
        b.run(51);
        if (ramps) EXPECT_NEAR(static_cast<double>(b.out.velocity), 5000, 300);
        else EXPECT_NEAR(static_cast<double>(b.out.velocity), 10000, 300);
    }
}

// --- ways of stopping -----------------------------------------------------------------------------------------------------------

StopOption option(StopCause cause, std::vector<StopWay> ways) { return {cause, {0x605A, 0}, std::move(ways)}; }

// CiA 402-2 605Ah: the value chooses ramp and whether the drive stays in Quick Stop Active.
TEST(StopOptions, TheValueChoosesTheRampAndWhatComesAfter) {
    DriveProfile p;
    p.stops.options = {option(
        StopCause::quick_stop,
        {{1, {}, StopBy::ramp, StopThen::free}, {2, {}, StopBy::quick_ramp, StopThen::free}, {6, {}, StopBy::quick_ramp, StopThen::lock}})};
    struct Case {
        int value;
        double way;  // v^2 / 2a
        unsigned state;
    };
    for (const auto& c : {Case{1, 2000, 0x40}, Case{2, 1000, 0x40}, Case{6, 1000, 0x07}}) {
        auto b = profile_bench(3, p);
        b.in.stop_values[0] = c.value;
        b.in.target_velocity = 20000;
        b.run(400);
        const double from = static_cast<double>(b.out.position);
        b.command(0x02, 300);
        EXPECT_NEAR(static_cast<double>(b.out.position) - from, c.way, 100) << c.value;
        EXPECT_EQ(b.out.status & 0x4Fu, c.state) << c.value;
        if (c.state != 0x07) continue;
        b.in.target_velocity = 0;
        b.command(0x0F);
        EXPECT_EQ(b.state(), 0x27u) << "transition 16";
    }
}

// SV33-E 3.1.8: the same value means another way in another mode; rows with a mode go before those for all.
TEST(StopOptions, AValueMayMeanSomethingElseInAnotherMode) {
    DriveProfile p;
    p.stops.options = {option(StopCause::halt, {{1, {DriveMode::cyclic_position}, StopBy::emergency_torque, StopThen::lock},
                                                {1, {}, StopBy::ramp, StopThen::lock}})};
    double way[2];
    for (const int mode : {3, 8}) {
        auto b = profile_bench(mode, p);
        b.in.stop_values[0] = 1;
        b.in.profile_deceleration = 20000;
        for (int i = 0; i < 400; ++i) {
            b.in.target_velocity = 20000;
            b.in.target_position += 20;
            b.cycle();
        }
        const double from = static_cast<double>(b.out.position);
        b.command(0x10F, 1500);
        way[mode == 8] = static_cast<double>(b.out.position) - from;
        EXPECT_EQ(b.state(), 0x27u);
        EXPECT_NEAR(b.axis.plant().velocity(), 0, 1);
    }
    EXPECT_NEAR(way[0], 10000, 200);  // v^2 / 2a
    EXPECT_LT(way[1], 500);
}

// SV33-E P04.12: shorted phases brake without power; coasting runs much farther.
TEST(StopOptions, ShortedPhasesBrakeAMotorWithoutPower) {
    double way[2];
    for (const bool shorted : {false, true}) {
        DriveProfile p;
        p.stops.options = {option(StopCause::off, {{0, {}, shorted ? StopBy::dynamic_brake : StopBy::coast, StopThen::free}})};
        auto plant = long_table();
        plant.viscous_friction = 0.001;
        plant.coulomb_friction = 0;
        Bench b{plant, p};
        b.in.mode = 9;
        b.enable();
        b.in.target_velocity = 20000;
        b.run(400);
        const double from = static_cast<double>(b.out.position);
        b.command(0x00, 2000);
        EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
        way[shorted] = static_cast<double>(b.out.position) - from;
    }
    EXPECT_LT(way[1] * 3, way[0]);
}

// --- changes of the mode --------------------------------------------------------------------------------------------------------

// TSVM 5.4.1: at standstill only; "may not switch, or may raise an abnormality".
TEST(ModeChange, InMotionItIsObeyedIgnoredOrAnAlarm) {
    for (const auto violation : {ModeViolation::obeyed, ModeViolation::ignored, ModeViolation::alarm}) {
        DriveProfile p;
        p.mode_rules.violation = violation;
        p.mode_rules.change_at_standstill = true;
        p.alarms = {{.code = 0x6320, .kind = DriveAlarmKind::mode_change}};
        auto b = profile_bench(9, p);
        b.in.target_velocity = 10000;
        b.run(100);
        b.in.mode = 10;
        b.cycle();
        EXPECT_EQ(b.out.mode, violation == ModeViolation::obeyed ? 10 : 9);
        EXPECT_EQ(b.out.error_code, violation == ModeViolation::alarm ? 0x6320 : 0);
    }
}

// SV33-E 3.4.3 (7): out of PV a ramp stop, then the other mode. 20000 counts/s by 100000 counts/s2 take 0.2 s and 2000 counts. (5): out of PP at once.
TEST(ModeChange, OutOfAVelocityAlongTheRampFirst) {
    DriveProfile p;
    p.quirks = {Quirk::ramp_before_mode_change};
    auto b = profile_bench(3, p);
    b.in.target_velocity = 20000;
    b.run(400);
    const double from = static_cast<double>(b.out.position);
    b.in.mode = 8;
    for (int i = 0; i < 190; ++i) {
        b.in.target_position = b.out.position;
        b.cycle();
        ASSERT_EQ(b.out.mode, 3) << i;
    }
    b.in.target_position = b.out.position;
    b.run(40);
    EXPECT_EQ(b.out.mode, 8);
    EXPECT_NEAR(static_cast<double>(b.out.position) - from, 2000, 100);
    auto position = profile_bench(1, p);
    set_point(position, 100000);
    position.command(0x0F, 400);
    position.in.mode = 8;
    position.in.target_position = position.out.position;
    position.cycle();
    EXPECT_EQ(position.out.mode, 8);
}

// Taken back in the middle of the ramp it goes on in its mode.
TEST(ModeChange, TakenBackInTheRampTheVelocityGoesOn) {
    DriveProfile p;
    p.quirks = {Quirk::ramp_before_mode_change};
    auto b = profile_bench(3, p);
    b.in.target_velocity = 20000;
    b.run(400);
    b.in.mode = 8;
    b.run(100);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 10000, 500);
    b.in.mode = 3;
    b.run(150);
    EXPECT_NEAR(static_cast<double>(b.out.velocity), 20000, 200);
}

// TSVM 5.4.1: at least 20 ms apart; for 2 ms 6061h means nothing.
TEST(ModeChange, TooSoonAndIndeterminate) {
    DriveProfile p;
    p.mode_rules.violation = ModeViolation::ignored;
    p.mode_rules.change_interval = 20ms;
    p.mode_rules.indeterminate = 2ms;
    Bench b{long_table(), p};
    b.run(30);
    b.in.mode = 9;
    b.cycle();
    EXPECT_NE(b.out.mode, 9);
    EXPECT_NE(b.out.mode, 8);
    b.run(2);
    EXPECT_EQ(b.out.mode, 9);
    b.in.mode = 10;
    b.run(10);
    EXPECT_EQ(b.out.mode, 9) << "too soon";
    b.run(15);
    EXPECT_EQ(b.out.mode, 10);
}

// TSVM 5.4.1 rule 6 and 7.2 alarm 43: enabled without a mode; rule 7: 0 keeps the mode there was.
TEST(ModeChange, EnabledWithoutAMode) {
    DriveProfile p;
    p.alarms = {{.code = 43, .kind = DriveAlarmKind::mode_not_set}};
    Bench b{long_table(), p};
    b.axis.power_on(b.now);
    b.in.mode = 0;
    b.enable();
    EXPECT_EQ(b.out.error_code, 43);
    b.command(0x00);
    b.command(0x80);
    b.in.mode = 8;
    b.run(2);
    b.in.mode = 0;
    b.enable();
    EXPECT_EQ(b.state(), 0x27u);
    EXPECT_EQ(b.out.mode, 8);
}

}  // namespace
}  // namespace taktwerk::axes::sim

// How the simulated XP200 moves, stops and fails. Facts from the manual's chapters 4 to 6; times by hand.

#include "tests/axes/sim/xp200/drive_rig.hpp"

namespace taktwerk::axes::sim::xp200 {
namespace {

/// Enabled at standstill in speed mode, brake time over.
struct Running : DriveRig {
    explicit Running(const Options& options = {}, const PlantConfig& plant = {}) : DriveRig(options, plant) {}
    void go() {
        start();
        enable();
        run(700ms);
    }
};

// 4.3.3: SP3 SP2 SP1 = 001 selects internal speed 2 (Pr138), 010 internal speed 3 (Pr139).
TEST(Xp200Servo, ForcedInputsSelectInternalSpeeds) {
    Running rig;
    rig.go();
    rig.write(138, 600);
    rig.write(139, -300);
    rig.write(122, 1);
    rig.run(1s);
    EXPECT_NEAR(rig.servo().speed(), 600, 2);
    EXPECT_NEAR(rig.status(0), 600, 2);
    EXPECT_NEAR(rig.status(0x1B), 6000, 20);  // 0.1 r/min
    EXPECT_EQ(rig.status(0x0E), 600);
    rig.write(122, 10);
    rig.run(1s);
    EXPECT_NEAR(rig.servo().speed(), -300, 2);
    rig.write(122, 0);
    rig.run(1s);
    EXPECT_NEAR(rig.servo().speed(), 0, 1);
}

// 4.3.4: Pr060 is the time from 0 to 1000 r/min. 500 ms: after 250 ms it is at 500 r/min.
TEST(Xp200Servo, RampsAreTimesForAThousandTurns) {
    Running rig;
    rig.set(60, 500);
    rig.set(61, 2000);
    rig.go();
    rig.write(138, 1000);
    rig.write(122, 1);  // heard somewhat before its answer is here
    const double begun = rig.servo().speed_command();
    rig.run(250ms);
    EXPECT_NEAR(rig.servo().speed_command() - begun, 500, 2);
    rig.run(1s);
    rig.write(122, 0);
    const double braking = rig.servo().speed_command();
    rig.run(500ms);
    EXPECT_NEAR(braking - rig.servo().speed_command(), 250, 2);
}

// 5.4.1 Pr075: no faster in either direction.
TEST(Xp200Servo, HighestSpeedHolds) {
    Running rig;
    rig.set(75, 400);
    rig.go();
    rig.write(138, 3000);
    rig.write(122, 1);
    rig.run(1s);
    EXPECT_NEAR(rig.servo().speed(), 400, 2);
}

// 4.2.3: 2500 lines are 10000 counts a turn. 60 r/min for 10 s: ten turns.
TEST(Xp200Servo, PositionCountsEncoderPulses) {
    Running rig;
    rig.set(60, 0);
    rig.set(61, 0);
    rig.go();
    rig.write(138, 60);
    rig.write(122, 1);
    const auto before = rig.servo().status(5) | (rig.servo().status(6) << 16);
    rig.run(10s);
    const auto after = rig.servo().status(5) | (rig.servo().status(6) << 16);
    EXPECT_NEAR(after - before, 100'000, 100);
    const auto in_turn = rig.servo().status(0x14);
    EXPECT_LT(in_turn, 10'000);
    EXPECT_EQ(in_turn, after % 10'000);
}

// 5.4.2: a digit only forces on. With SON wired and on, neither 42h nor the digit disables.
TEST(Xp200Servo, AnythingThatEnablesEnables) {
    Running rig;
    rig.start();
    rig.servo().inputs().contact(0, true);  // DI1, SON (5.1.2)
    rig.run(10ms);
    EXPECT_TRUE(rig.servo().energised());
    rig.enable(false);
    EXPECT_TRUE(rig.servo().energised());
    rig.servo().inputs().contact(0, false);
    rig.run(600ms);  // input filter, then Pr166 for the brake
    EXPECT_FALSE(rig.servo().energised());
    rig.write(120, 10);  // SON by force
    rig.run(10ms);
    EXPECT_TRUE(rig.servo().energised());
}

// 4.8: released Pr169 after enabling; at standstill it falls at once and the current stays for Pr166.
TEST(Xp200Servo, BrakeFollowsItsTimes) {
    Running rig;
    rig.start();
    rig.enable();
    rig.run(450ms);
    EXPECT_FALSE(rig.servo().output(3)) << "DO4, BRK: Pr169 = 500 ms";
    rig.run(100ms);
    EXPECT_TRUE(rig.servo().output(3));
    rig.enable(false);
    EXPECT_FALSE(rig.servo().output(3));
    EXPECT_TRUE(rig.servo().energised());
    rig.run(450ms);
    EXPECT_TRUE(rig.servo().energised()) << "Pr166 = 500 ms";
    rig.run(100ms);
    EXPECT_FALSE(rig.servo().energised());
}

// 5.4.2 Pr136: disabled in motion the motor coasts (0), or ramps by Pr063 first (1).
TEST(Xp200Servo, DisabledInMotionItCoastsOrRamps) {
    PlantConfig easy;
    easy.coulomb_friction = 0.005;
    easy.viscous_friction = 1e-4;
    for (const int mode : {0, 1}) {
        Running rig{{}, easy};
        rig.set(136, mode);
        rig.set(63, 200);  // ms for 1000 r/min
        rig.go();
        rig.write(138, 1000);
        rig.write(122, 1);
        rig.run(1s);
        rig.enable(false);
        EXPECT_EQ(rig.servo().energised(), mode == 1);
        rig.run(250ms);
        if (mode == 0) {
            EXPECT_GT(rig.servo().speed(), 300);
        } else {
            EXPECT_LT(std::abs(rig.servo().speed()), 5);
        }
    }
}

// 4.6: the drive takes the torque away towards a limit switch, raises nothing, and lets the axis back.
TEST(Xp200Servo, ALimitOnlyTakesTheTorqueAway) {
    Running rig;
    rig.set(97, 30);
    rig.start();
    rig.servo().inputs().contact(2, true);  // DI3 CCWL: on = allowed
    rig.servo().inputs().contact(3, true);  // DI4 CWL
    rig.run(10ms);
    rig.enable();
    rig.run(700ms);
    rig.write(138, 500);
    rig.write(139, -500);
    rig.write(122, 1);
    rig.run(500ms);
    rig.servo().inputs().contact(2, false);
    rig.run(50ms);
    EXPECT_GT(rig.servo().speed(), 50) << "it coasts through";
    EXPECT_EQ(rig.servo().alarm(), 0);
    rig.write(122, 10);
    rig.run(1s);
    EXPECT_NEAR(rig.servo().speed(), -500, 3);
}

// 4.3.5: below Pr160 ZCLAMP holds the position (Pr162 = 0), against a push too.
TEST(Xp200Servo, ZeroClampHoldsThePlace) {
    Running rig;
    rig.go();
    rig.write(121, 100);
    rig.run(100ms);
    const double at = rig.servo().plant().position();
    rig.run(5s);
    EXPECT_NEAR(rig.servo().plant().position(), at, 2);
    rig.write(138, 500);
    rig.write(122, 1);
    rig.run(500ms);
    EXPECT_NEAR(rig.servo().speed(), 500, 3) << "the command is not below Pr160";
}

// 5.4.2 Pr164 and 9.1 of the hazards: EMG stops, and released it goes on with the speed that is still selected.
TEST(Xp200Servo, EmergencyStopRampsOrCoastsAndGoesOnAfterwards) {
    for (const int mode : {0, 1}) {
        Running rig;
        rig.set(164, mode);
        rig.set(63, 200);
        rig.set(105, -15);  // DI6: EMG while open
        rig.start();
        rig.servo().inputs().contact(5, true);
        rig.run(20ms);
        rig.enable();
        rig.run(700ms);
        rig.write(138, 500);
        rig.write(122, 1);
        rig.run(1s);
        rig.servo().inputs().contact(5, false);
        rig.run(150ms);
        EXPECT_EQ(rig.servo().energised(), mode == 1);
        EXPECT_EQ(rig.servo().alarm(), 0) << "5.5 names no alarm for it";
        if (mode == 1) {
            EXPECT_LT(std::abs(rig.servo().speed()), 10);
        }
        rig.servo().inputs().contact(5, true);
        rig.run(1s);
        EXPECT_NEAR(rig.servo().speed(), 500, 5);
    }
}

// 4.4.3: TRQ1 selects internal torque 2; Pr078 holds the speed, a little above (Pr079): 300 % would make 100 r/min, 50 % a sixth of that, less
// what friction takes.
TEST(Xp200Servo, TorqueModeKeepsItsSpeedLimit) {
    Running rig;
    rig.set(4, 2);
    rig.set(26, 1);
    rig.set(78, 300);
    rig.go();
    rig.write(146, 50);
    EXPECT_EQ(rig.servo().mode(), Servo::Mode::torque);
    rig.write(122, 1000);
    rig.run(2s);
    EXPECT_EQ(rig.status(0x0F), 50);
    EXPECT_GT(rig.servo().speed(), 300);
    EXPECT_LE(rig.servo().speed(), 316.7);
}

// 5.4.1 Pr079: the smaller, the steeper.
TEST(Xp200Servo, ASmallerSpeedLimitErrorHoldsTheLimitHarder) {
    const auto speed_with = [](int slope) {
        Running rig;
        for (const auto& [number, value] : {std::pair{4, 2}, {26, 1}, {78, 300}, {79, slope}}) rig.set(number, value);
        rig.go();
        rig.write(146, 50);
        rig.write(122, 1000);
        rig.run(2s);
        return rig.servo().speed();
    };
    EXPECT_LT(speed_with(20), 303.4);   // a sixth of 20
    EXPECT_GT(speed_with(500), 320.0);  // a sixth of 500 is 83
}

// 5.4.1 Pr004: 5 is speed or torque by CMODE; a new Pr004 counts after a restart (3.6.4).
TEST(Xp200Servo, ModeByInputAndByRestart) {
    Running rig;
    rig.set(4, 5);
    rig.go();
    EXPECT_EQ(rig.servo().mode(), Servo::Mode::speed);
    rig.write(123, 10);
    rig.run(10ms);
    EXPECT_EQ(rig.servo().mode(), Servo::Mode::torque);
    rig.write(123, 0);
    rig.write(4, 2);
    rig.run(10ms);
    EXPECT_EQ(rig.read(4), 2);
    EXPECT_EQ(rig.servo().mode(), Servo::Mode::speed);
}

// --- alarms (6.1): code, how it comes, whether 43h clears it --------------------------------------------------------------------

TEST(Xp200Alarms, PositionDeviation) {
    Running rig;
    rig.set(4, 0);
    rig.set(75, 100);  // too slow for the pulses
    rig.go();
    rig.servo().pulses(39'000);  // Pr080 = 400: 4 turns, 40000 counts
    rig.run(10ms);
    EXPECT_EQ(rig.servo().alarm(), 0);
    rig.servo().pulses(5'000);
    rig.run(10ms);
    EXPECT_EQ(rig.status(0x1A), 4);
    EXPECT_FALSE(rig.servo().output(1)) << "DO2, ALM: on = no alarm";
    EXPECT_EQ(rig.ask(modbus::clear_alarm(1)).outcome, modbus::Outcome::answered);
    EXPECT_EQ(rig.status(0x1A), 0);
}

TEST(Xp200Alarms, StallAndUserOverload) {
    Running rig;
    rig.set(72, 1000);
    rig.go();
    rig.servo().jam(true);
    rig.write(138, 500);
    rig.write(122, 1);
    rig.run(950ms);
    EXPECT_EQ(rig.servo().alarm(), 0);
    rig.run(200ms);
    EXPECT_EQ(rig.servo().alarm(), 29) << "300 % is beyond Pr070 = 140 for Pr072 = 1 s";

    Running slow;
    slow.set(72, 30'000);
    slow.go();
    slow.servo().jam(true);
    slow.write(138, 500);
    slow.write(122, 1);
    slow.run(2500ms);
    EXPECT_EQ(slow.servo().alarm(), 6);
}

TEST(Xp200Alarms, Overload) {
    PlantConfig heavy;
    heavy.load_torque = 1.3 * heavy.rated_torque;
    Running rig{{.brake = true}, heavy};
    rig.go();
    rig.run(60s);
    EXPECT_EQ(rig.servo().alarm(), 13) << "30 % above rated for a minute";
}

TEST(Xp200Alarms, BothLimitsOpen) {
    Running rig;
    rig.set(97, 30);
    rig.start();
    rig.enable();
    rig.run(20ms);
    EXPECT_EQ(rig.servo().alarm(), 7);
}

TEST(Xp200Alarms, Overspeed) {
    PlantConfig sinking;  // a load that pulls the motor along while it coasts
    sinking.load_torque = -2;
    Running rig{{}, sinking};
    rig.set(75, 500);
    rig.start();
    rig.run(3s);
    EXPECT_EQ(rig.servo().alarm(), 1);
}

TEST(Xp200Alarms, EncoderShowsTheSamePlace) {
    Running rig;
    rig.go();
    rig.write(138, 500);
    rig.write(122, 1);
    rig.run(500ms);
    rig.servo().break_encoder();
    EXPECT_EQ(rig.servo().alarm(), 9);
    const auto frozen = rig.servo().status(5);
    rig.run(100ms);
    EXPECT_EQ(rig.servo().status(5), frozen);
    EXPECT_FALSE(rig.servo().energised());
}

// 6.1, column "clearing": eleven of twenty-two.
TEST(Xp200Alarms, WhatClearsAndWhatDoesNot) {
    const std::vector<int> clearable{1, 4, 5, 6, 7, 9, 10, 12, 13, 14, 29}, lasting{2, 3, 11, 20, 21, 23, 24, 30, 31, 32, 33};
    for (const auto& [codes, left] : {std::pair{clearable, false}, std::pair{lasting, true}})
        for (const int code : codes) {
            Running rig;
            rig.start();
            rig.servo().raise(static_cast<std::uint16_t>(code));
            rig.run(10ms);
            EXPECT_EQ(rig.status(0x1A), code);
            EXPECT_EQ(rig.ask(modbus::clear_alarm(1)).outcome, modbus::Outcome::answered);
            EXPECT_EQ(rig.status(0x1A), left ? code : 0) << code;
            rig.servo().power_off();
            rig.start();
            EXPECT_EQ(rig.status(0x1A), 0) << code;
        }
}

// 5.5: ACLR clears by its rising edge. The enabling word 42h is forgotten by an alarm (assumed): nothing starts by itself then.
TEST(Xp200Alarms, ClearedByTheEdgeOfAnInput) {
    Running rig;
    rig.go();
    rig.servo().raise(12);
    rig.run(10ms);
    rig.write(120, 100);
    rig.run(20ms);
    EXPECT_EQ(rig.servo().alarm(), 0);
    EXPECT_FALSE(rig.servo().energised());
    rig.servo().raise(12);
    rig.run(20ms);
    EXPECT_EQ(rig.servo().alarm(), 12) << "no new edge";
}

// 9 and the hazards: no watchdog. The line is cut, the motor goes on.
TEST(Xp200Servo, ASilentLineStopsNothing) {
    Running rig;
    rig.go();
    rig.write(138, 500);
    rig.write(122, 1);
    rig.run(1s);
    rig.line.cut(true);
    rig.run(60s);
    EXPECT_NEAR(rig.servo().speed(), 500, 3);
    EXPECT_EQ(rig.servo().alarm(), 0);
}

// 4.1: mains and control are one; the counter begins anew (1.3: incremental).
TEST(Xp200Servo, MainsLostIsPositionLost) {
    Running rig;
    rig.go();
    rig.write(138, 500);
    rig.write(122, 1);
    rig.run(1s);
    EXPECT_NE(rig.status(5), 0);
    rig.servo().power_off();
    rig.run(3s);
    rig.start();
    EXPECT_EQ(rig.status(5), 0);
    EXPECT_FALSE(rig.servo().energised());
    EXPECT_EQ(rig.read(122), 0);
}

}  // namespace
}  // namespace taktwerk::axes::sim::xp200

// How drives differ where CiA 402 leaves room, and the failures that can be provoked.

#include <cmath>

#include <gmock/gmock.h>

#include "axes/sim/cia402_device.hpp"
#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

/// Runs up to 50000 counts/s (5 turns/s) in CSP.
void run_up(Bench& b) {
    b.enable();
    b.run(400);
    for (int i = 0; i < 200; ++i) {
        b.in.target_position += std::min(50, i);
        b.cycle();
    }
    ASSERT_NEAR(b.axis.plant().velocity(), 50000, 1000);
}

// SV33-E 3.1.2 and P05.13: from enabling to the first command 250 ms, else the command is lost.
TEST(Brake, WhatIsCommandedBeforeItOpensIsLost) {
    DriveProfile p;
    p.brake.release = 250ms;
    p.brake.hold = 150ms;
    Bench b{long_table(), p};
    b.enable();
    ASSERT_EQ(b.state(), 0x27u);
    const double before = b.axis.plant().position();
    b.in.target_position += 400;
    b.run(240);
    EXPECT_EQ(b.axis.plant().position(), before);
    EXPECT_TRUE(b.axis.brake_closed());
    EXPECT_GT(b.axis.early_commands(), 0u);
}

TEST(Brake, AMasterThatWaitsLosesNothing) {
    DriveProfile p;
    p.brake.release = 250ms;
    p.brake.hold = 150ms;
    Bench b{long_table(), p};
    b.enable();
    b.run(260);
    EXPECT_FALSE(b.axis.brake_closed());
    for (int i = 0; i < 100; ++i) {
        b.in.target_position += 10;
        b.cycle();
    }
    b.run(200);
    EXPECT_EQ(b.axis.early_commands(), 0u);
    EXPECT_NEAR(static_cast<double>(b.out.position), 1000, 3);
}

TEST(Brake, AHomingStartBeforeItOpensIsLostToo) {
    DriveProfile p;
    p.brake.release = 250ms;
    p.brake.hold = 150ms;
    Bench b{table(), p};
    b.in.homing = {.method = 18, .fast = 40000, .slow = 4000, .acceleration = 400000};
    b.enable();
    b.in.mode = 6;
    b.run(3);
    b.command(0x1F, 100);
    EXPECT_EQ(b.axis.plant().velocity(), 0);
    EXPECT_GT(b.axis.early_commands(), 0u);
}

// SV33-E 3.1.2(3) and P05.14: at standstill the motor holds 150 ms after servo-off, until the brake does. The load never drops.
TEST(Brake, AVerticalAxisDoesNotSagWhenPowerGoes) {
    auto plant = long_table();
    plant.load_torque = 0.5;
    DriveProfile p;
    p.brake.release = 250ms;
    p.brake.hold = 150ms;
    Bench b{plant, p};
    b.enable();
    b.run(500);
    const double before = b.axis.plant().position();
    b.command(0x0006, 100);
    EXPECT_FALSE(b.axis.brake_closed()) << "the motor still holds";
    b.run(900);
    EXPECT_TRUE(b.axis.brake_closed());
    EXPECT_NEAR(b.axis.plant().position(), before, 20);
}

TEST(Brake, WithoutOneAVerticalAxisDrops) {
    auto plant = long_table();
    plant.load_torque = 0.5;
    Bench b{plant};
    b.enable();
    b.run(500);
    const double before = b.axis.plant().position();
    b.command(0x0006, 500);
    EXPECT_LT(b.axis.plant().position(), before - 1000);
}

// SV33-E P04.12 = 2: zero-speed stop; 3.4.1 transition 8 without it: the motor coasts.
TEST(Stop, PowerTakenAwayInMotionRampsOrCoasts) {
    double way[2] = {};
    for (const auto stop : {DriveStop::ramp, DriveStop::coast}) {
        DriveProfile p;
        p.stops.off = stop;
        Bench b{long_table(), p};
        run_up(b);
        const double from = b.axis.plant().position();
        b.command(0x0006, 2000);
        EXPECT_EQ(b.state(), 0x21u);
        way[stop == DriveStop::coast] = b.axis.plant().position() - from;
    }
    EXPECT_LT(way[0] * 3, way[1]);
}

// SE-808X 4.3: 605Eh = 0, current off, motor free.
TEST(Stop, AFaultReactionRampsOrCoasts) {
    double way[2] = {};
    for (const auto stop : {DriveStop::ramp, DriveStop::coast}) {
        DriveProfile p;
        p.stops.fault = stop;
        Bench b{long_table(), p};
        run_up(b);
        const double from = b.axis.plant().position();
        b.axis.fail(Failure::overload);
        b.run(2000);
        way[stop == DriveStop::coast] = b.axis.plant().position() - from;
    }
    EXPECT_LT(way[0] * 3, way[1]);
}

// SE-808X 3.2.1.1: Quick Stop Active ends by Disable Voltage or Enable Operation only; SV33-E 605Ah = 2: by itself.
TEST(Stop, QuickStopLeavesByItselfOrStays) {
    for (const bool leaves : {true, false}) {
        DriveProfile p;
        p.stops.quick_stop_leaves = leaves;
        Bench b{long_table(), p};
        run_up(b);
        b.command(0x0002, 1000);
        EXPECT_NEAR(b.axis.plant().velocity(), 0, 1);
        if (leaves) EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
        else EXPECT_EQ(b.state(), 0x07u);
    }
}

// SE-808X 3.2.2.2: Fault reads x0xx1111, bit 9 is not supported, bits 12 and 13 are reserved in CSP.
TEST(StatusWord, OfTheSe808x) {
    DriveProfile p;
    p.quirks = {Quirk::fault_low_nibble_f, Quirk::no_remote_bit, Quirk::csp_bits_12_13_reserved};
    p.stops.fault = DriveStop::coast;
    Bench b{long_table(), p};
    b.enable();
    b.run(10);
    EXPECT_EQ(b.out.status & 0x3200u, 0u);
    b.axis.fail(Failure::undervoltage);
    b.run(10);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x0Fu);
    b.command(0x0000);
    b.command(0x0080);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(Failures, EachShowsTheDrivesOwnCodeAndItsOwnResetRule) {
    struct Case {
        Failure failure;
        std::uint16_t code;
        bool resettable;
    };
    // SV33-E 5.2: E.416, E.423, E.414, E.419, E.911 (needs a power cycle), E.D26.
    for (const auto& c :
         {Case{Failure::overspeed, 0x8400, true}, Case{Failure::following_error, 0x8611, true}, Case{Failure::undervoltage, 0x3220, true},
          Case{Failure::overload, 0x3230, true}, Case{Failure::encoder, 0x7305, false}, Case{Failure::communication, 0x0D26, true}}) {
        DriveProfile p;
        p.alarms = {{.code = 0x0D26, .kind = DriveAlarmKind::communication}};
        Bench b{long_table(), p};
        b.enable();
        b.axis.fail(c.failure);
        b.run(100);
        EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
        EXPECT_EQ(b.out.error_code, c.code);
        b.command(0x0000);
        b.command(0x0080);
        EXPECT_EQ((b.out.status & 0x4Fu) == 0x40u, c.resettable) << std::hex << c.code;
        b.axis.power_on(b.now);
        b.command(0x0000);
        EXPECT_EQ(b.out.status & 0x4Fu, 0x40u) << "a power cycle clears them all";
    }
}

TEST(Failures, AFailedEncoderShowsNoMotion) {
    Bench b{long_table()};
    run_up(b);
    b.axis.fail(Failure::encoder);
    b.cycle();
    const auto shown = b.out.position;
    const double really = b.axis.plant().position();
    b.run(50);
    EXPECT_EQ(b.out.position, shown);
    EXPECT_NE(b.axis.plant().position(), really);
}

// SV33-E E.416: speed above the maximum; here the load runs away downhill.
TEST(Failures, ARealOverspeedIsFound) {
    auto plant = long_table();
    plant.rated_torque = 0.1;
    plant.load_torque = -2;  // more than the motor can hold
    SimulatedMotor m;
    m.overspeed = 500000;
    Bench b{plant, {}, m};
    b.enable();
    b.run(3000);
    EXPECT_EQ(b.out.error_code, 0x8400);
}

TEST(DriveAlarmCodes, AreThoseOfTheProfilesAlarmsWithTheirResetRules) {
    DriveProfile profile;
    const auto row = [&](std::uint16_t code, std::uint32_t detail, DriveAlarmKind kind, bool resettable) {
        DriveAlarmText text;
        text.code = code;
        text.detail = detail;
        text.kind = kind;
        text.resettable = resettable;
        profile.alarms.push_back(text);
    };
    row(0x3221, 0, DriveAlarmKind::undervoltage, true);
    row(0x7305, 0x0911, DriveAlarmKind::encoder, false);
    row(0x7305, 0x0917, DriveAlarmKind::encoder, true);
    const DriveAlarmCodes codes{profile};
    EXPECT_EQ(codes[DriveAlarmKind::undervoltage].code, 0x3221);
    EXPECT_EQ(codes[DriveAlarmKind::encoder].detail, 0x0911u) << "the first row of a kind";
    EXPECT_FALSE(codes[DriveAlarmKind::encoder].resettable);
    EXPECT_EQ(codes[DriveAlarmKind::following_error].code, 0x8611) << "what the profile does not mark keeps the usual code";
}

}  // namespace
}  // namespace taktwerk::axes::sim

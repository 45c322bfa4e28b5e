// An open-loop stepper on the SE-808X (2000h:11 = 2, from the factory): no encoder [2.4], so 6064h is the command, and lost steps show
// nowhere. The motor has 50 rotor teeth, so it slips by 10000 / 50 = 200 pulses; its pull-out torque is 3 x 1.27 = 3.81 N m.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test::se_808x_open_loop {
namespace {

constexpr double period = 200, pull_out = 3.81;
constexpr std::int64_t save = 0x65766173;

axes::sim::PlantConfig table(double load_torque = 0) {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.rated_torque = 1.27;
    plant.maximum_torque = 3.0;
    plant.coulomb_friction = 0;
    plant.load_torque = load_torque;
    return plant;
}

/// How far the rotor lags behind the field under a constant torque: the sine of the electrical angle.
double lag(double torque, double most) { return std::asin(torque / most) / (2 * std::numbers::pi) * period; }

struct Stepper : DriveDesk {
    explicit Stepper(const axes::sim::PlantConfig& plant = table()) : DriveDesk("se-808x", plant) {}

    void set_and_restart(std::uint8_t sub, std::int64_t value) {
        ASSERT_EQ(sdo(0x2000, sub, value), 0u);
        ASSERT_EQ(sdo(0x1010, 1, save), 0u);
        power_cycle();
    }
    void enable(std::int64_t mode = 8) {
        if (state != EsmState::op) go_operational();
        pdo(0x6060, mode);
        run(2ms);
        pdo(0x607A, read(0x6064));
        control({6, 7, 15});
        ASSERT_EQ(power_state(), 0x27u);
    }
    /// CSP, so many pulses each millisecond.
    void travel(int cycles, std::int64_t step) {
        for (int i = 0; i < cycles; ++i) {
            target += step;
            pdo(0x607A, target);
            run(1ms);
        }
    }
    /// Where the rotor is, as the drive counts.
    [[nodiscard]] double rotor() { return axis().plant().position(); }
    [[nodiscard]] double lost() { return static_cast<double>(read(0x6064)) - rotor(); }
    void expect_no_complaint() {
        EXPECT_EQ(power_state(), 0x27u);
        EXPECT_EQ(read(0x603F), 0);
        EXPECT_EQ(status() & 0x0080, 0) << "bit 7, warning";
    }

    std::int64_t target = 0;
};

TEST(Se808xOpenLoop, FollowsWithoutALossWhileTheLoadIsBelowPullOut) {
    Stepper s;
    s.enable();
    s.travel(400, 50);
    s.run(200ms);
    EXPECT_EQ(s.read(0x6064), 20000);
    EXPECT_NEAR(s.lost(), 0, 0.5);
}

// A jam in the middle of the way: the field goes on, the rotor does not.
TEST(Se808xOpenLoop, ABlockedMotorLosesStepsAndTheDriveDoesNotNotice) {
    Stepper s;
    s.enable();
    s.travel(50, 50);
    s.axis().jam(true);
    s.travel(50, 50);
    EXPECT_EQ(s.read(0x606C), 50000) << "the speed of the command";
    EXPECT_EQ(s.read(0x6077), 0);
    s.axis().jam(false);
    s.travel(50, 50);
    s.run(300ms);
    EXPECT_EQ(s.read(0x6064), 7500);
    EXPECT_GE(s.lost(), 2400) << "2500 pulses of command while it stood";
    EXPECT_NEAR(std::remainder(s.lost(), period), 0, 0.5) << "whole periods of the field";
    s.expect_no_complaint();
}

// Set-points that fail to come for some milliseconds at 4 turns a second (a computer that stalls, frames that are lost): the field stands, the rotor swings
// about it, and the field that goes on all at once may find it on the wrong foot. Where it does depends on the swing; without a pause nothing is lost.
TEST(Se808xOpenLoop, AFieldThatStandsForSomeMillisecondsInAMoveMayLoseSteps) {
    auto machine = table();
    machine.coulomb_friction = 0.05;
    int losses = 0;
    for (auto pause = 0ms; pause <= 10ms; pause += 1ms) {
        Stepper s{machine};
        s.enable();
        s.travel(200, 40);
        s.run(pause);
        s.travel(200, 40);
        s.run(300ms);
        EXPECT_EQ(s.read(0x6064), 16000) << "the command";
        EXPECT_NEAR(std::remainder(s.lost(), period), 0, 5) << "whole periods of the field, but for the friction";
        const bool loses = std::abs(s.lost()) > period / 2;
        EXPECT_FALSE(loses && pause == 0ms);
        losses += loses;
        s.expect_no_complaint();
    }
    EXPECT_GT(losses, 0);
}

// A field that gets faster than the rotor can: 3.81 N m on 2e-3 kg m2 is 3.03e6 pulses/s2.
TEST(Se808xOpenLoop, RampsThatAskForMoreThanPullOutLoseSteps) {
    auto heavy = table();
    heavy.inertia = 2e-3;
    for (const auto& [ramp, loses] : {std::pair{1'000'000, false}, std::pair{12'000'000, true}}) {
        Stepper s{heavy};
        s.enable(1);
        s.pdo(0x6081, 200'000);
        s.pdo(0x6083, ramp);
        s.pdo(0x6084, ramp);
        s.pdo(0x607A, 100'000);
        s.control(0x1F);
        s.run(2s);
        EXPECT_EQ(s.read(0x6064), 100'000);
        EXPECT_NE(s.status() & 0x0400, 0) << "bit 10: reached, says the drive";
        EXPECT_EQ(s.lost() > 100, loses) << ramp;
        EXPECT_NEAR(std::remainder(s.lost(), period), 0, 0.5) << ramp;
        s.expect_no_complaint();
    }
}

/// A weight that stands on the floor at 0 until the motor lifts it.
axes::sim::PlantConfig hoist(double weight) {
    auto plant = table(weight);
    plant.negative_stop = 0;
    return plant;
}

// 1.5 N m: asin(1.5 / 3.81) with full current, asin(1.5 / 1.905) with the 50 % that 2000h:1B leaves at standstill [4.4].
TEST(Se808xOpenLoop, AHangingLoadPullsTheRotorBehindTheField) {
    Stepper s{hoist(1.5)};
    s.enable();
    s.travel(100, 20);
    s.run(300ms);
    EXPECT_NEAR(s.lost(), lag(1.5, pull_out), 0.5);
    s.run(700ms);
    EXPECT_NEAR(s.lost(), lag(1.5, 0.5 * pull_out), 0.5);
    s.expect_no_complaint();
}

// 2.5 N m lies between 1.905 and 3.81: held in motion, dropped at standstill, unless 2000h:1B says 100 %.
TEST(Se808xOpenLoop, StandbyCurrentDropsALoadThatTheFullCurrentHolds) {
    Stepper s{hoist(2.5)};
    s.enable();
    s.travel(400, 20);
    s.run(300ms);
    EXPECT_NEAR(s.lost(), lag(2.5, pull_out), 0.5);
    s.run(2s);
    EXPECT_EQ(s.rotor(), 0) << "on the floor";
    EXPECT_EQ(s.read(0x6064), 8000);
    s.expect_no_complaint();

    Stepper full{hoist(2.5)};
    full.set_and_restart(0x1B, 100);
    full.enable();
    full.travel(400, 20);
    full.run(2s);
    EXPECT_NEAR(full.lost(), lag(2.5, pull_out), 0.5);
}

// 605Eh = 0, 3.2.1.1 (14): the motor is free. It runs out, and 6064h knows nothing of that way; 12.6 rad/s against 0.05 N m on 2e-4 kg m2
// is 0.3 rad, some 500 pulses.
TEST(Se808xOpenLoop, AfterAFaultInMotionTheCountIsWrongForGood) {
    auto plant = table();
    plant.coulomb_friction = 0.05;
    plant.viscous_friction = 0;
    Stepper s{plant};
    s.enable();
    s.travel(200, 20);
    s.device.raise(0, 0x3221);
    s.run(500ms);
    EXPECT_EQ(s.read(0x606C), 0);
    const auto counted = s.read(0x6064);
    EXPECT_NEAR(static_cast<double>(counted), 4000, 40);
    EXPECT_NEAR(-s.lost(), 503, 40) << "12.566^2 / (2 * 250) rad";
    s.control({0, 0x80, 0});
    s.enable();
    s.run(100ms);
    EXPECT_EQ(s.read(0x6064), counted);
    EXPECT_NEAR(std::remainder(s.lost(), period), 0, 0.5) << "at the nearest tooth";
    EXPECT_LT(s.lost(), -period);
}

// Somebody turns the shaft of a motor without power: nothing counts that.
TEST(Se808xOpenLoop, AFreeShaftIsNotCounted) {
    Stepper s{table(0.2)};
    s.go_operational();
    s.run(200ms);
    EXPECT_LT(s.rotor(), -1000);
    EXPECT_EQ(s.read(0x6064), 0);
}

// 4.4: with 2000h:11 = 4 (closed loop) there is an encoder, and more than 2000h:0F = 50 behind is 8611h. The value counts after a restart [6];
// its unit is not stated and taken as pulses.
TEST(Se808xClosedLoop, ABlockedMotorIsAPositionError) {
    Stepper s;
    ASSERT_EQ(s.sdo(0x2000, 0x11, 4), 0u);
    s.enable();
    s.axis().jam(true);
    s.travel(20, 50);
    EXPECT_EQ(s.read(0x603F), 0) << "not before the restart";
    s.axis().jam(false);
    s.control(0);
    s.enter(EsmState::preop);

    s.set_and_restart(0x11, 4);
    s.target = 0;
    s.enable();
    s.travel(100, 20);
    EXPECT_EQ(s.read(0x603F), 0);
    const auto before = s.read(0x6064);
    s.axis().jam(true);
    s.travel(10, 20);
    EXPECT_EQ(s.read(0x603F), 0x8611);
    EXPECT_EQ(s.read(0x2001, 1), 12);
    EXPECT_NEAR(static_cast<double>(s.read(0x6064)), static_cast<double>(before), 20) << "the encoder tells the truth";
    EXPECT_FALSE(s.axis().powered());
}

}  // namespace
}  // namespace taktwerk::test::se_808x_open_loop

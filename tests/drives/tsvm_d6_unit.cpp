// Brake and encoder of the TSVM-D6 by its manual: PA47 to PA50 [6.1], battery and PA80 [7.2, 7.2.1]. The PA of the brake have no bus address:
// the maker's tool sets them, and so does `adapt` here.

#include <gtest/gtest.h>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test::tsvm_d6 {
namespace {

using axes::sim::SimulatedMotor;

/// 10000 counts a turn, 2e-4 kg m2, rated torque 1.27 N m, so the brake slows with 2.54 N m.
axes::sim::PlantConfig motor() {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.inertia = 2e-4;
    plant.viscous_friction = 0;
    plant.coulomb_friction = 0;
    plant.rated_torque = 1.27;
    return plant;
}

/// A weight of 0.5 N m, and a brake that needs 40 ms to close.
axes::sim::PlantConfig vertical_axis() {
    auto plant = motor();
    plant.load_torque = 0.5;
    plant.brake_closing = 40ms;
    return plant;
}

struct Tsvm : DriveDesk {
    explicit Tsvm(const axes::sim::PlantConfig& plant, const MotorFacts& adapt = {}) : DriveDesk("tsvm-d6", plant, 1ms, adapt) {
        go_operational();
        run(30ms);
    }
    void enable() {
        pdo(0x6060, 8);
        run(25ms);
        pdo(0x607A, read(0x6064));
        control({6, 7, 15});
        ASSERT_EQ(power_state(), 0x27u);
        run(200ms);
    }
    [[nodiscard]] double place() { return axis().plant().position(); }
};

/// How far a vertical axis comes down when its power is taken at standstill.
double sag(Duration pa47) {
    Tsvm drive{vertical_axis(), [&](SimulatedMotor&, axes::DriveProfile& p) { p.brake.hold = pa47; }};
    drive.enable();
    const double from = drive.place();
    drive.control(6);
    drive.run(500ms);
    EXPECT_TRUE(drive.axis().brake_closed());
    EXPECT_EQ(drive.axis().plant().velocity(), 0);
    return from - drive.place();
}

/// Falls free for `t` seconds with 2500 rad/s2, then the brake takes (2.54 - 0.5) / 2e-4 = 10200 rad/s2 of it; in counts.
constexpr double fall(double t) {
    const double speed = 2500 * t;
    return (0.5 * 2500 * t * t + speed * speed / (2 * 10200)) / 6.283185307 * 10000;
}

// 6.1, PA47 "wait before enable drops at standstill", 0 from the factory: the brake is told to close as the torque goes.
TEST(TsvmBrake, AVerticalAxisSagsByFactorySettings) {
    EXPECT_EQ(drive_of_file("tsvm-d6").profile->brake.hold, 0ms);
    EXPECT_NEAR(sag(0ms), fall(0.040), 60);  // 3963 counts; an inner step of 125 us more or less is 20 of them
}

TEST(TsvmBrake, Pa47ShortensTheFallAndEndsItOnceItCoversTheBrake) {
    EXPECT_NEAR(sag(20ms), fall(0.020), 30);
    EXPECT_NEAR(sag(40ms), 0, 3);
    EXPECT_NEAR(sag(100ms), 0, 3);
}

// 6.1, PA50 = 20 ms: the brake opens so long after enabling; the motor has its torque by then.
TEST(TsvmBrake, OpensPa50AfterEnablingWithoutASag) {
    Tsvm drive{vertical_axis()};
    drive.pdo(0x6060, 8);
    drive.run(25ms);
    drive.control({6, 7});
    EXPECT_TRUE(drive.axis().brake_closed());
    const double from = drive.place();
    drive.pdo(0x6040, 15);
    drive.run(20ms);
    EXPECT_TRUE(drive.axis().brake_closed());
    drive.run(2ms);
    EXPECT_FALSE(drive.axis().brake_closed());
    drive.run(300ms);
    EXPECT_NEAR(drive.place(), from, 30);
}

/// How far a motor without friction runs on when its power is taken at `rpm`.
double way_to_rest(double rpm) {
    Tsvm drive{motor()};
    drive.enable();
    const double step = rpm / 60.0 * 10000 / 1000;  // counts each ms
    const auto start = static_cast<double>(drive.read(0x6064));
    for (int i = 1; i <= 400; ++i) {
        drive.pdo(0x607A, std::llround(start + i * step));
        drive.run(1ms);
    }
    const double from = drive.place();
    drive.control(0);
    drive.run(1s);
    EXPECT_TRUE(drive.axis().brake_closed());
    return drive.place() - from;
}

// 6.1: above PA49 = 100 rpm the brake waits for PA48 = 50 ms at the most, below it does not. 2.54 / 2e-4 = 12700 rad/s2.
TEST(TsvmBrake, InMotionItClosesBelowPa49OrAfterPa48) {
    const auto braked = [](double rpm) {
        const double speed = rpm / 60.0 * 6.283185307;
        return speed * speed / (2 * 12700) / 6.283185307 * 10000;
    };
    EXPECT_NEAR(way_to_rest(300), 50'000 * 0.050 + braked(300), 100);  // the word comes a cycle, 50 counts, after the last target
    EXPECT_NEAR(way_to_rest(90), braked(90), 30);
}

// Not stated: enabled again before it stands, the motor has its torque at once, and the brake that was open stays so.
TEST(TsvmBrake, StaysOpenWhenAMotorThatTurnsIsEnabledAgain) {
    Tsvm drive{motor()};
    drive.enable();
    const auto start = drive.read(0x6064);
    for (int i = 1; i <= 200; ++i) {
        drive.pdo(0x607A, start + 50 * i);  // 300 rpm
        drive.run(1ms);
    }
    drive.control({6, 7});
    ASSERT_FALSE(drive.axis().brake_closed());
    drive.pdo(0x6040, 15);
    for (int i = 0; i < 30; ++i) {
        drive.run(1ms);
        EXPECT_FALSE(drive.axis().brake_closed() && !drive.axis().stands()) << i;
    }
}

// --- Encoder -----------------------------------------------------------------------------------------------------------------------------

/// Two turns below zero, with the encoder's index a tenth of a turn off.
axes::sim::PlantConfig two_turns_down() {
    auto plant = motor();
    plant.start = -20000;
    plant.index_pulse = 1000;
    return plant;
}

/// 2.4: only absolute encoders work.
void absolute(SimulatedMotor& motor, axes::DriveProfile&) { motor.absolute_encoder = true; }

struct TsvmBattery : ::testing::Test {
    Tsvm drive{two_turns_down(), absolute};

    void restart() {
        drive.power_cycle();
        drive.go_operational();
        drive.run(30ms);
    }
    [[nodiscard]] std::int64_t code() { return drive.read(0x603F); }
};

// 7.2, alarm 27: "battery below 3.1 V, low". The drive goes on, and warns by bit 7 [5.3.2].
TEST_F(TsvmBattery, Below3V1ItIsAnAlarmUntilTheBatteryIsNew) {
    drive.axis().battery_voltage(3.2);
    drive.enable();
    EXPECT_EQ(code(), 0);
    const auto at = drive.read(0x6064);
    drive.axis().battery_voltage(3.0);
    drive.run(2ms);
    EXPECT_EQ(code(), 27);
    EXPECT_EQ(drive.power_state() & 0x4Fu, 0x08u) << "7.2 lists it among the alarms, not among warnings";
    drive.axis().battery_voltage(3.6);  // "replace it with the drive powered" [7.2.1]
    drive.run(2ms);
    drive.control({0, 0x80, 0});
    EXPECT_EQ(code(), 0) << "no star: a reset clears it";
    restart();
    EXPECT_NEAR(static_cast<double>(drive.read(0x6064) - at), 0, 2) << "nothing is lost";
}

// 7.2, alarm 19 (with a star): "below 2.5 V, the multi-turn position is lost". While the drive has power it feeds the encoder.
TEST_F(TsvmBattery, Below2V5TheTurnsAreGoneAtTheNextPowerOn) {
    const auto before = drive.read(0x6064);
    drive.axis().battery_voltage(2.4);
    drive.run(2ms);
    EXPECT_EQ(code(), 27);
    EXPECT_EQ(drive.read(0x6064), before);
    restart();
    EXPECT_EQ(code(), 19);
    EXPECT_EQ(drive.power_state() & 0x4Fu, 0x08u);
    const auto moved = drive.read(0x6064) - before;
    EXPECT_NE(moved, 0);
    EXPECT_EQ(moved % 10000, 0) << "whole turns: the place within the turn stays";
    drive.control({0, 0x80, 0});
    EXPECT_EQ(code(), 19) << "a starred alarm";
}

// 7.2.1, alarm 19: "reset the absolute encoder (PA80 = 1, do not save, power on again); after the alarm is cleared set the origin again".
TEST_F(TsvmBattery, Alarm19EndsWithPa80AndAPowerCycle) {
    drive.axis().battery_voltage(2.4);
    restart();
    ASSERT_EQ(code(), 19);
    drive.axis().battery_voltage(3.6);
    restart();
    EXPECT_EQ(code(), 19) << "a new battery alone does not clear it";
    ASSERT_EQ(drive.sdo(0x2050, 0, 1), 0u);
    drive.run(5ms);
    drive.control({0, 0x80, 0});
    EXPECT_EQ(code(), 19) << "not before the power cycle";
    restart();
    EXPECT_EQ(code(), 0);
    EXPECT_EQ(drive.power_state(), 0x40u);
    EXPECT_EQ(drive.read(0x2050), 0) << "it is not saved";
    restart();
    EXPECT_EQ(code(), 0);
}

// PA80 with a battery that is still empty.
TEST_F(TsvmBattery, Alarm19ComesBackWithoutANewBattery) {
    drive.axis().battery_voltage(2.4);
    restart();
    ASSERT_EQ(drive.sdo(0x2050, 0, 1), 0u);
    drive.run(5ms);
    restart();
    EXPECT_EQ(code(), 19);
}

// PA80 with a good one clears the turns all the same: "absolute encoder reset" [6.1].
TEST_F(TsvmBattery, Pa80ClearsTheTurnsOfItsAxisOnly) {
    const auto first = drive.read(0x6064), second = drive.read(0x6864);
    ASSERT_EQ(drive.sdo(0x2850, 0, 1), 0u);  // axis 2 [5.4.3]
    drive.run(5ms);
    EXPECT_EQ(drive.read(0x6864), second) << "not before the power cycle";
    restart();
    EXPECT_EQ(drive.read(0x6064), first);
    EXPECT_NE(drive.read(0x6864), second);
    EXPECT_EQ((drive.read(0x6864) - second) % 10000, 0);
}

}  // namespace
}  // namespace taktwerk::test::tsvm_d6

// The absolute encoder of a simulated drive over power cycles. Turns, battery and overflow: SV33-E 3.1.4 and 5.4 (E.917, E.919, A.921).

#include <gtest/gtest.h>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

/// 10000 counts a turn, 16 bit of turns: half of them are 327'680'000 counts.
DriveProfile counts_turns() {
    DriveProfile p;
    p.encoder.turn_bits = 16;
    p.alarms = {{.code = 0x7305, .detail = 0x0917, .kind = DriveAlarmKind::reference_lost},
                {.code = 0x7305, .detail = 0x0919, .kind = DriveAlarmKind::turn_overflow},
                {.code = 0x7305, .detail = 0x0921, .warning = true, .kind = DriveAlarmKind::battery_low}};
    return p;
}
constexpr SimulatedMotor absolute{.absolute_encoder = true};

PlantConfig at(double start) {
    auto plant = table();
    plant.start = start;
    plant.index_pulse = 1000;
    return plant;
}

void restart(Bench& b) {
    b.axis.power_off();
    b.axis.power_on(b.now);
    b.axis.operational(true);
    b.in.control = 0;
    b.in.mode = 8;
    b.cycle();
}

/// Method 35 with an offset of 700: where the axis stands is 700.
void home_here(Bench& b) {
    b.enable();
    b.in.homing = {.method = 35};
    b.in.home_offset = 700;
    b.in.mode = 6;
    b.run(3);
    b.command(0x1F, 5);
    ASSERT_TRUE(b.out.status & (1u << 12));
    b.command(0);
}

TEST(AbsoluteEncoder, ItsReadingWrapsAfterAllItsTurns) {
    AbsoluteEncoder encoder(10000, 1000, 16);
    EXPECT_DOUBLE_EQ(encoder.reading(1000), 0);
    EXPECT_DOUBLE_EQ(encoder.reading(1000 + 327'679'999.0), 327'679'999);
    EXPECT_DOUBLE_EQ(encoder.reading(1000 + 327'680'000.0), -327'680'000);
    encoder.forget_turns(1000 + 123'456);
    EXPECT_DOUBLE_EQ(encoder.reading(1000 + 123'456), 3'456) << "the place within the turn stays";
}

TEST(EncoderPower, HomingOutlivesAPowerCycleOfAnAbsoluteEncoder) {
    Bench b{at(-20000), counts_turns(), absolute};
    home_here(b);
    restart(b);
    EXPECT_NEAR(static_cast<double>(b.out.position), 700, 1);
    EXPECT_EQ(b.out.error_code, 0);
}

TEST(EncoderPower, AnIncrementalOneCountsFromWhereItWakes) {
    Bench b{at(-20000)};
    home_here(b);
    restart(b);
    EXPECT_EQ(b.out.position, 0);
}

// -20000 is three turns below the pulse at 1000 and 9000 on: the turns go, the 9000 stay.
TEST(EncoderPower, AnEmptyBatteryLosesTheTurnsAndIsAFault) {
    Bench b{at(-20000), counts_turns(), absolute};
    home_here(b);
    b.axis.battery(Battery::empty);
    b.run(5);
    EXPECT_EQ(b.out.error_code, 0) << "as long as the drive has power the turns are there";
    restart(b);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u);
    EXPECT_EQ(b.out.error_code, 0x7305);
    EXPECT_EQ(b.out.error_detail, 0x0917u);
    EXPECT_NEAR(static_cast<double>(b.out.position), 700 + 30000, 1);
    b.command(0x80, 3);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u) << "P20.05 first";
    b.command(0);
    b.axis.reset_encoder();
    b.command(0x80, 3);
    b.command(0);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(EncoderPower, ALowBatteryOnlyWarns) {
    Bench b{at(0), counts_turns(), absolute};
    b.axis.battery(Battery::low);
    b.enable();
    EXPECT_EQ(b.state(), 0x27u);
    EXPECT_TRUE(b.out.status & (1u << 7));
    EXPECT_EQ(b.out.error_detail, 0x0921u);
    b.axis.battery(Battery::good);
    b.run(2);
    EXPECT_FALSE(b.out.status & (1u << 7));
    EXPECT_EQ(b.out.error_code, 0);
}

TEST(EncoderPower, TooManyTurnsAreAFaultUntilTheyAreCleared) {
    auto plant = at(1000 + 327'679'900.0);
    plant.positive_limit = 1e9;
    Bench b{plant, counts_turns(), absolute};
    b.enable();
    for (int i = 0; i < 40; ++i) {
        b.in.target_position += 10;
        b.cycle();
    }
    b.run(200);
    EXPECT_EQ(b.out.error_detail, 0x0919u);
    b.command(0);
    b.axis.reset_encoder();
    b.command(0x80, 3);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x08u) << "the turns are still too many";
    b.command(0);
    b.axis.clear_turns();
    b.command(0x80, 3);
    b.command(0);
    EXPECT_EQ(b.out.status & 0x4Fu, 0x40u);
}

TEST(EncoderPower, TurnsAreNotClearedWhileTheMotorHasPower) {
    Bench b{at(-20000), counts_turns(), absolute};
    b.enable();
    const auto before = b.out.position;
    b.axis.clear_turns();
    b.run(3);
    EXPECT_NEAR(static_cast<double>(b.out.position - before), 0, 3);
    b.command(0, 300);
    b.axis.clear_turns();
    b.run(3);
    EXPECT_NEAR(static_cast<double>(b.out.position - before), 30000, 3);
}

}  // namespace
}  // namespace taktwerk::axes::sim

// Conversion between counts and u: exact, also after any number of turns.

#include "axes/axis/units.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

// A 17 bit encoder on a 5 mm screw: 131072 / 5 = 26214.4 counts per mm.
TEST(AxisUnits, ConvertsBothWays) {
    const AxisUnits units({.counts_per_revolution = 131072, .motor_revolutions = 1, .load_revolutions = 1, .feed = 5});

    EXPECT_EQ(units.counts(5), 131072);
    EXPECT_EQ(units.counts(1), 26214);      // 26214.4
    EXPECT_EQ(units.counts(-1.5), -39322);  // -39321.6
    EXPECT_DOUBLE_EQ(units.local(131072), 5);
    EXPECT_DOUBLE_EQ(units.counts_per_unit(), 26214.4);
}

TEST(AxisUnits, InversionTurnsTheSign) {
    const AxisUnits units({.counts_per_revolution = 1000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10, .inverted = true});

    EXPECT_EQ(units.counts(20), -2000);
    EXPECT_DOUBLE_EQ(units.local(-500), 5);
    EXPECT_DOUBLE_EQ(units.counts_per_unit(), -100);
}

// Gear 7:3, so one turn of the load is 10000 * 7 / 3 counts: no whole number. After N turns the counts are N * 70000 / 3, rounded once.
TEST(AxisUnits, AMillionTurnsOverAnOddGearLoseNothing) {
    AxisUnits units({.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360});
    double local = 0;
    for (int turn = 1; turn <= 1'000'000; ++turn) {
        local = units.reanchor(local + 360.0);
        ASSERT_EQ(local, 0.0);
        if (turn % 99'999 != 0) continue;
        ASSERT_EQ(units.counts(local), (turn * 70000LL + 1) / 3) << turn;  // rest 0, 1 or 2 thirds: nearest
    }
    EXPECT_EQ(units.counts(local), 23'333'333'333LL);
    EXPECT_EQ(units.counts(180), 23'333'345'000LL);  // half a turn more: 11666.67 counts on .33
    EXPECT_DOUBLE_EQ(units.to_program(0), 360e6);
}

// Backwards too: the anchor is then negative.
TEST(AxisUnits, NegativeTurnsAreAsExact) {
    AxisUnits units({.counts_per_revolution = 10000, .motor_revolutions = 7, .load_revolutions = 3, .feed = 360});
    double local = 0;
    for (int turn = 0; turn < 1000; ++turn) local = units.reanchor(local - 360.0);

    EXPECT_EQ(units.counts(local), -23'333'333LL);
    EXPECT_NEAR(units.local(-23'333'333LL), 0.0, 360.0 / 23333 / 2);
}

TEST(AxisUnits, ReferenceGivesAPlaceItsCoordinateAndMovesNothing) {
    AxisUnits units({.counts_per_revolution = 1000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 1});
    const double local = units.local(123'456);

    units.set_program(123'456, 77.5);

    EXPECT_DOUBLE_EQ(units.to_program(local), 77.5);
    EXPECT_EQ(units.counts(units.to_local(77.5)), 123'456);
    EXPECT_EQ(units.local(123'456), local);
}

}  // namespace
}  // namespace taktwerk::axes

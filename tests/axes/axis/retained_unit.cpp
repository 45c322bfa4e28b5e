// Coordinates of an axis with an absolute encoder over a time without power: one axis ends, another one begins with what it left.

#include "axes/axis/retained_position.hpp"

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig absolute_axis() {
    auto config = plain_axis();
    config.memory = {.absolute = true, .range = 1'000'000, .moved_while_off = 2};
    config.homing.kind = HomingKind::set_here;
    return config;
}

/// An axis that was homed at count 5000 as 100 u and then moved to 130 u.
RetainedPosition left_behind() {
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 5000; });
    rig.power_on();
    rig.accept(home(100));
    EXPECT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(absolute(130));
    EXPECT_TRUE(rig.run_to(AxisState::Standstill));
    rig.run(20);
    return rig.axis.retained();
}

TEST(Retained, SaysWhereTheCoordinatesAreAndWhetherItStands) {
    const auto kept = left_behind();
    EXPECT_TRUE(kept.homed);
    EXPECT_TRUE(kept.at_rest);
    EXPECT_EQ(kept.counts, 35'000);
    EXPECT_DOUBLE_EQ(kept.shift, 95);  // 100 u at 5 u of counts

    Rig moving(absolute_axis());
    moving.power_on();
    moving.accept(home(0));
    moving.accept(absolute(50, 100, mcBuffered));
    moving.run(100);
    EXPECT_FALSE(moving.axis.retained().at_rest);
    Rig incremental;
    incremental.power_on();
    EXPECT_FALSE(incremental.axis.retained().homed);
}

TEST(Retained, AfterPowerTheAxisIsHomedWithoutMotion) {
    const auto kept = left_behind();
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 35'000; });
    rig.axis.restore(kept, absolute_axis().gearing);
    EXPECT_EQ(rig.axis.retained(), kept);  // nothing better is known before the first position
    rig.step();
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 130);
    rig.power_on();
    rig.accept(absolute(131));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 36'000);
    EXPECT_TRUE(rig.alarms.empty());
}

// The raw position began anew while the axis was off: 0.5 u further it reads 999'500 counts less.
TEST(Retained, OverflowOfTheEncoderIsNoticed) {
    auto kept = left_behind();
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 35'500 - 1'000'000; });
    rig.axis.restore(kept, absolute_axis().gearing);
    rig.step();
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 130.5);
    EXPECT_EQ(rig.axis.retained().counts, 35'500 - 1'000'000);
    EXPECT_DOUBLE_EQ(rig.axis.retained().shift, 95 + 1000);
}

TEST(Retained, MovedWithoutPowerItMustBeHomedAgain) {
    const auto kept = left_behind();
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 35'000 - 2'001; });
    rig.axis.restore(kept, absolute_axis().gearing);
    rig.step();
    EXPECT_FALSE(rig.view().homed);
    ASSERT_TRUE(rig.raised(AxisAlarm::moved_while_off));
    EXPECT_NEAR(rig.alarms[0].a, 2.001, 1e-12);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);  // a warning
    EXPECT_FALSE(rig.axis.retained().homed);
    rig.axis.acknowledge_alarms();
    EXPECT_TRUE(rig.axis.active_alarms().empty());
    rig.power_on();
    rig.accept(home(0));
    rig.step();
    EXPECT_TRUE(rig.view().homed);
}

// Power went while it moved: how far it went on cannot be told, the encoder knows.
TEST(Retained, WhatWasMovingMayBeElsewhere) {
    auto kept = left_behind();
    kept.at_rest = false;
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 60'000; });
    rig.axis.restore(kept, absolute_axis().gearing);
    rig.step();
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 155);
}

TEST(Retained, AnotherGearingMakesItWorthless) {
    const auto kept = left_behind();
    Rig rig(absolute_axis(), [](FakeDrive& drive) { drive.position = 35'000; });
    auto other = absolute_axis().gearing;
    other.feed = 5;
    rig.axis.restore(kept, other);
    rig.step();
    EXPECT_FALSE(rig.view().homed);
    EXPECT_TRUE(rig.raised(AxisAlarm::retained_gearing_differs));
}

TEST(Retained, AnIncrementalEncoderHasNothingToRestore) {
    const auto kept = left_behind();
    Rig rig;
    rig.axis.restore(kept, plain_axis().gearing);
    rig.step();
    EXPECT_FALSE(rig.view().homed);
}

TEST(Retained, InvertedAxisToo) {
    auto config = absolute_axis();
    config.gearing.inverted = true;
    Rig before(config, [](FakeDrive& drive) { drive.position = -4000; });
    before.power_on();
    before.accept(home(10));
    before.run(3);
    Rig after(config, [](FakeDrive& drive) { drive.position = -5500 + 1'000'000; });
    after.axis.restore(before.axis.retained(), config.gearing);
    after.step();
    EXPECT_TRUE(after.view().homed);
    EXPECT_DOUBLE_EQ(after.view().actual_position, 11.5);
}

// The drive is gone and comes back while the runtime goes on: an absolute encoder still knows, an incremental one does not.
TEST(Retained, LossOfTheBusCostsTheReferenceOfIncrementalEncodersOnly) {
    for (const bool absolute_encoder : {true, false}) {
        auto config = absolute_axis();
        config.memory.absolute = absolute_encoder;
        Rig rig(config);
        rig.power_on();
        rig.accept(home(7));
        rig.run(3);
        ASSERT_TRUE(rig.view().homed);
        rig.drive.offline = true;
        rig.run(10);
        rig.drive.offline = false;
        ++rig.drive.epoch;
        rig.run(10);
        EXPECT_EQ(rig.view().homed, absolute_encoder);
    }
}

TEST(UnwrappedNear, IsTheNearestWithThatReading) {
    EXPECT_EQ(unwrapped_near(35'000, 35'000, 1000), 35'000);
    EXPECT_EQ(unwrapped_near(35'400, 100, 1000), 35'100);
    EXPECT_EQ(unwrapped_near(35'900, 100, 1000), 36'100);
    EXPECT_EQ(unwrapped_near(-100, 900, 1000), -100);
    EXPECT_EQ(unwrapped_near(-100, 50, 1000), 50);
    EXPECT_EQ(unwrapped_near(0, 499, 1000), 499);
    EXPECT_EQ(unwrapped_near(0, 501, 1000), -499);  // half the range and more: taken for the other way
}

}  // namespace
}  // namespace taktwerk::axes::test

// What a turn of the motor is for the drive is compared with the axis before it is enabled. Objects as the manuals have them: SV33-E 3.1.5
// (encoder counts = counts * 6091h:01 / 6091h:02, P01.05), SE-808X 6 (2000h:02), TSVM 6.1 (10000 * PA84 + PA81), SV-DA200 2.1 note 4.

#include <gmock/gmock.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr ParameterAddress encoder{0x2001, 6}, numerator{0x6091, 1}, denominator{0x6091, 2}, steps{0x2000, 2};

/// A drive in CSP that would be Operation enabled at once if it were told so.
class DriveScaleBeforeEnabling : public ::testing::Test {
protected:
    void build() {
        rig.profile.scale.remedy = "correct the gear";
        rig.profile.scale.section = "3.1.5";
        for (const auto& object : {encoder, numerator, denominator, steps, ParameterAddress{0x2051, 0}, ParameterAddress{0x2054, 0}})
            rig.others.emplace_back(object.index, object.sub);
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        rig.status(0x1233);  // Switched on, voltage, remote
        rig.mode(8);
        rig.command.power = PowerRequest::on;
    }
    void as_sv33(std::int64_t lines, std::int64_t above, std::int64_t below) {
        rig.profile.scale.encoder = encoder;
        rig.profile.scale.numerator = numerator;
        rig.profile.scale.denominator = denominator;
        rig.holds = {{{0x2001, 6}, lines}, {{0x6091, 1}, above}, {{0x6091, 2}, below}};
        build();
        rig.run(200);
    }
    void parameter(ParameterAddress address, ParameterEffect effect) {
        DriveParameter row;
        row.address = address;
        row.name = "steps per revolution";
        row.effect = effect;
        rig.profile.parameters.push_back(row);
    }
    DriveRig rig;
};

// 1048576 counts of the encoder through 8 : 1 are 131072.
TEST_F(DriveScaleBeforeEnabling, AGearThatFitsIsEnabled) {
    rig.wants.counts_per_revolution = 131072;
    as_sv33(1048576, 8, 1);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_THAT(rig.drive->setup_problems(), IsEmpty());
}

// Without the gear a turn is eight times as many: the axis would go an eighth of what it shows.
TEST_F(DriveScaleBeforeEnabling, AnotherGearIsRefusedWithBothNumbersAndTheRemedy) {
    rig.wants.counts_per_revolution = 131072;
    as_sv33(1048576, 1, 1);
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_TRUE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(),
                ElementsAre(AllOf(HasSubstr("'z_drive'"), HasSubstr("1048576 counts for the drive"), HasSubstr("131072 for the axis"),
                                  HasSubstr("0.125 times"), HasSubstr("correct the gear"), HasSubstr("3.1.5"))));
}

// 10 counts too many of 131072 over a long way are no rounding: compared exactly.
TEST_F(DriveScaleBeforeEnabling, ANearlyFittingGearIsRefused) {
    rig.wants.counts_per_revolution = 131073;
    as_sv33(1048576, 8, 1);
    EXPECT_FALSE(rig.told_to_enable());
}

TEST_F(DriveScaleBeforeEnabling, WhatNobodyKnowsHoldsNobodyBack) {
    rig.wants.counts_per_revolution = 10000;
    rig.profile.scale.counts = {0x2051, 0};
    rig.profile.scale.counts_high = {0x2054, 0};
    rig.profile.scale.counts_high_unit = 10000;
    build();
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable()) << "PA81 = PA84 = 0: a turn is what the encoder has, which no object tells (TSVM 6.1)";
}

TEST_F(DriveScaleBeforeEnabling, ANumberInTwoPartsIsAddedUp) {
    rig.wants.counts_per_revolution = 131072;
    rig.profile.scale.counts = {0x2051, 0};
    rig.profile.scale.counts_high = {0x2054, 0};
    rig.profile.scale.counts_high_unit = 10000;
    rig.holds = {{{0x2051, 0}, 1072}, {{0x2054, 0}, 13}};
    build();
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable());
}

// The case of an audit: the list writes 50000, the read-back agrees with the axis, and the drive still works with what it had at power-on.
TEST_F(DriveScaleBeforeEnabling, AStartUpListThatWritesWhatCountsAfterSavingIsRefusedThoughItReadsBack) {
    rig.wants.counts_per_revolution = 50000;
    rig.profile.scale.counts = steps;
    parameter(steps, ParameterEffect::after_saving);
    ecat::StartupSdo sdo;
    sdo.index = 0x2000, sdo.sub = 2, sdo.type = ecat::DataType::U32, sdo.value = 50000;
    rig.startup.push_back(sdo);
    build();
    rig.run(200);
    ASSERT_EQ(rig.got(0x2000, 2), 50000) << "it reads back";
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_THAT(rig.drive->setup_problems(),
                ElementsAre(AllOf(HasSubstr("2000h:02 (steps per revolution) was written"), HasSubstr("nobody knows"))));
}

TEST_F(DriveScaleBeforeEnabling, WhatWasWrittenWhileTheMachineRunsIsRefusedUntilTheDriveHasBeenAway) {
    rig.wants.counts_per_revolution = 10000;
    rig.profile.scale.counts = steps;
    parameter(steps, ParameterEffect::after_saving);
    rig.holds = {{{0x2000, 2}, 10000}};
    build();
    rig.command.power = PowerRequest::off;
    rig.run(200);
    ASSERT_FALSE(rig.feedback().setup_refused);
    ASSERT_NE(rig.drive->write_parameter(steps, {std::byte{0x10}, std::byte{0x27}, std::byte{0}, std::byte{0}}), 0u);
    rig.command.power = PowerRequest::on;
    rig.run(200);
    EXPECT_FALSE(rig.told_to_enable()) << "10000 again, but nobody knows what it was between";
}

TEST_F(DriveScaleBeforeEnabling, WhatTheMachineHasStoredIsComparedToo) {
    rig.wants.stored = {{steps, 10000, "store it"}};
    rig.holds = {{{0x2000, 2}, 400}};
    build();
    rig.run(200);
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_THAT(rig.drive->setup_problems(),
                ElementsAre(AllOf(HasSubstr("shall be 10000"), HasSubstr("reads 400"), HasSubstr("store it"))));
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test

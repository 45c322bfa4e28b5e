// Power, modes, faults of a CiA 402 drive: which control word follows on which status word.

#include <gmock/gmock.h>

#include <limits>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Distinct control words in the order in which the drive saw them.
std::vector<std::uint16_t> words_of(DriveRig& rig, int cycles) {
    std::vector<std::uint16_t> words;
    rig.puppet->on_exchange = [&] {
        if (words.empty() || words.back() != rig.control()) words.push_back(rig.control());
    };
    rig.run(cycles);
    rig.puppet->on_exchange = nullptr;
    return words;
}

// SV33-E 3.4.1 table of states: 6 in 0250h, 7 in 0231h, 15 in 0233h; the drive here needs ten cycles for each step.
TEST(Cia402Power, EachStepWaitsForTheStateBeforeIt) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.mode(8);
    rig.command.power = PowerRequest::on;
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0006);
    rig.status(0x0231);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0007);
    rig.status(0x0233);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x000F);
    EXPECT_EQ(rig.feedback().power, PowerState::switched_on);
}

// TSVM 5.3.1 and alarm 43: the mode is confirmed before Enable Operation.
TEST(Cia402Power, DoesNotEnableBeforeTheModeIsConfirmed) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.command.power = PowerRequest::on;
    rig.status(0x0233);
    rig.mode(0);
    rig.run(50);
    EXPECT_EQ(rig.control(), 0x0007);
    EXPECT_EQ(rig.got(0x6060), 8);
    rig.mode(8);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x000F);
}

// SV33-E 3.4.1 transitions 8 and 9 cut the power at once, 5 and 6 do not: 7, then 6, then 0.
TEST(Cia402Power, GoesDownStepByStep) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.command.power = PowerRequest::off;
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0007);
    rig.status(0x0233);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0006);
    rig.status(0x0231);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0000);
}

TEST(Cia402Power, QuickStopIsHeldWhileItRunsAndEndsInDisabled) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.command.power = PowerRequest::quick_stop;
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0002);
    rig.status(0x0217);  // TSVM 5.3.1: Quick stop active
    rig.run(10);
    EXPECT_EQ(rig.feedback().power, PowerState::quick_stop);
    EXPECT_EQ(rig.control(), 0x0002);
    rig.status(0x0270);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0000);
}

// TSVM 5.3.1 prints 02B6h for the fault reaction; no row of its state table fits. An enabled motor must not be let go.
TEST(Cia402Power, AnUnknownPatternBecomesAQuickStop) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.command.power = PowerRequest::on;
    rig.run(10);
    ASSERT_EQ(rig.control(), 0x000F);
    rig.status(0x02B6);
    rig.run(10);
    EXPECT_EQ(rig.feedback().power, PowerState::unknown);
    EXPECT_EQ(rig.control(), 0x0002);
}

// SV33-E 3.4.1: rising edge of bit 7, and back to 0 afterwards; enable dropped before (5.1).
TEST(Cia402Power, FaultResetIsAPulseAfterEnableWasDropped) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.command.power = PowerRequest::on;
    rig.run(10);
    rig.status(0x0218);
    rig.put(0x603F, 0x8611);
    rig.run(10);
    EXPECT_EQ(rig.control(), 0x0000) << "no reset unasked";

    rig.command.reset_fault = true;
    EXPECT_THAT(words_of(rig, 60), ElementsAre(0x0000, 0x0080, 0x0000)) << "one pulse, not a level";
    rig.status(0x0250);
    rig.put(0x603F, 0);
    rig.run(10);
    EXPECT_EQ(rig.control() & 0x0080, 0);
}

// The pulse ends as soon as the fault is gone, also in its middle: while bit 7 stands nothing else is taken.
TEST(Cia402Power, TheResetBitFallsWithTheFault) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.mode(8);
    rig.status(0x0218);
    rig.command.power = PowerRequest::on;
    rig.command.reset_fault = true;
    rig.run(5);
    for (int i = 0; i < 20 && rig.control() != 0x0080; ++i) rig.run(1);
    ASSERT_EQ(rig.control(), 0x0080);
    rig.status(0x0250);
    rig.run(3);
    EXPECT_EQ(rig.control(), 0x0006);
}

// TSVM 7: alarms with a star do not clear by software; SV33-E 5.2: E.210 neither.
TEST(Cia402Power, AnAlarmThatOnlyAPowerCycleClearsIsNotReset) {
    DriveRig rig;
    DriveAlarmText row;
    row.code = 0x2312;
    row.resettable = false;
    rig.profile.alarms = {row};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.status(0x0218);
    rig.put(0x603F, 0x2312);
    rig.command.reset_fault = true;
    EXPECT_THAT(words_of(rig, 60), ElementsAre(0x0000));
    EXPECT_FALSE(rig.drive->alarm().resettable);
}

// SE-808X 3.2.2.2: Fault reads x0xx1111.
TEST(Cia402Power, FaultWithLowNibbleFIsAFaultWhereTheQuirkSaysSo) {
    DriveRig rig;
    rig.profile.quirks = {Quirk::fault_low_nibble_f};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.status(0x001F);
    rig.run(5);
    EXPECT_EQ(rig.feedback().power, PowerState::fault);
    EXPECT_TRUE(rig.feedback().fault);
}

// TSVM 5.3.2: bit 7 stands with faults, too. Then it is no warning besides.
TEST(Cia402Power, AFaultIsNoWarningBesides) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.status(0x0288);
    rig.run(5);
    EXPECT_TRUE(rig.feedback().fault);
    EXPECT_FALSE(rig.feedback().warning);
}

// SV33-E 5.3: A.220 and A.221 are warnings; the drive stays in Operation enabled.
TEST(Cia402Power, AWarningIsAnAlarmButNoFault) {
    DriveRig rig;
    DriveAlarmText row;
    row.code = 0x5443;
    row.warning = true;
    row.kind = DriveAlarmKind::positive_limit;
    rig.profile.alarms = {row};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.status(0x12B7);
    rig.put(0x603F, 0x5443);
    rig.command.power = PowerRequest::on;
    rig.run(10);
    EXPECT_FALSE(rig.feedback().fault);
    EXPECT_TRUE(rig.feedback().warning);
    EXPECT_EQ(rig.control(), 0x000F);
    EXPECT_EQ(rig.drive->alarm().entry, 0);
    EXPECT_TRUE(rig.drive->alarm().warning);
    EXPECT_EQ(rig.drive->alarm().kind, DriveAlarmKind::positive_limit);
    rig.enabled();
    rig.put(0x603F, 0);
    rig.run(5);
    EXPECT_EQ(rig.drive->alarm().code, 0);
}

// TSVM 5.4.1: at least 20 ms between two mode changes, 2 ms in which 6061h means nothing.
TEST(Cia402Mode, ChangesKeepTheirDistanceAndAreNotBelievedTooEarly) {
    DriveRig rig;
    rig.profile.mode_rules.change_interval = 20ms;
    rig.profile.mode_rules.indeterminate = 2ms;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.run(30);
    rig.command.mode = DriveMode::homing;
    std::vector<Instant> changes;
    std::int64_t last = rig.got(0x6060);
    bool believed_junk = false;
    rig.puppet->on_exchange = [&] {
        const auto sent = rig.got(0x6060);
        if (sent != last) changes.push_back(rig.now);
        last = sent;
        // Junk for 2 ms, then the truth.
        const bool junk = !changes.empty() && rig.now - changes.back() < 2ms;
        rig.mode(junk ? 10 : sent);
        rig.put(0x6064, junk ? 123456 : 500);
    };
    rig.on_cycle = [&] { believed_junk |= rig.feedback().mode == DriveMode::cyclic_torque || rig.feedback().position == 123456; };
    rig.run(3);
    rig.command.mode = DriveMode::cyclic_position;
    rig.run(60);
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_GE(changes[1] - changes[0], 20ms);
    EXPECT_FALSE(believed_junk);
    EXPECT_EQ(rig.feedback().mode, DriveMode::cyclic_position);
    EXPECT_EQ(rig.feedback().position, 500);
}

// SV33-E 3.4.3(2), TSVM 5.3.1: 607Ah equals 6064h until the drive follows, and again in every change of mode.
TEST(Cia402Mode, TheTargetIsTheActualPositionUntilTheDriveFollowsInThisMode) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.mode(8);
    rig.command.power = PowerRequest::on;
    rig.command.position = 999'999;
    rig.put(0x6064, -4321);
    for (const auto status : {0x0250, 0x0231, 0x0233}) {
        rig.status(static_cast<std::uint16_t>(status));
        rig.run(6);
        EXPECT_EQ(rig.got(0x607A), -4321);
    }
    rig.enabled();
    rig.run(6);
    EXPECT_EQ(rig.got(0x607A), 999'999);

    rig.mode(6);
    rig.run(6);
    EXPECT_EQ(rig.got(0x607A), -4321);
}

// From one cyclic mode into another a turning motor must feel nothing: both targets are the command's until 6061h has changed.
TEST(Cia402Mode, BetweenCyclicModesTheTargetsOfBothAreTheCommands) {
    DriveRig rig;
    rig.profile.modes = {DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_torque, DriveMode::homing};
    rig.rx.push_back({0x60FF, 0});
    rig.rx.push_back({0x6071, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.command.power = PowerRequest::on;
    rig.enabled();
    rig.put(0x6064, -4321);
    rig.command.position = 777;
    rig.command.velocity = 1500;
    rig.command.torque = 0.25;
    rig.run(6);
    EXPECT_EQ(rig.got(0x6071), 0) << "nobody asked for torque";

    rig.command.mode = DriveMode::cyclic_torque;
    rig.run(6);
    EXPECT_EQ(rig.got(0x6060), 10);
    EXPECT_EQ(rig.got(0x607A), 777) << "as long as the drive is in CSP";
    EXPECT_EQ(rig.got(0x6071), 250);
    rig.mode(10);
    rig.run(6);
    EXPECT_EQ(rig.got(0x6071), 250);

    rig.command.mode = DriveMode::cyclic_velocity;
    rig.run(6);
    EXPECT_EQ(rig.got(0x60FF), 1500);
    EXPECT_EQ(rig.got(0x6071), 250) << "as long as the drive is in CST";
    rig.mode(9);
    rig.run(6);
    EXPECT_EQ(rig.got(0x6071), 0);
}

// The velocity limit of a torque command goes with it: 607Fh bounds other modes, too.
TEST(Cia402Mode, TheVelocityLimitIsGivenBackAfterTorque) {
    DriveRig rig;
    rig.rx.push_back({0x607F, 0});
    ecat::StartupSdo fastest;
    fastest.index = 0x607F;
    fastest.value = 90'000;
    rig.startup = {fastest};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.run(3);
    EXPECT_EQ(rig.got(0x607F), 90'000);
    rig.command.velocity_limit = 20'000;
    rig.run(3);
    EXPECT_EQ(rig.got(0x607F), 20'000);
    rig.command.velocity_limit = std::numeric_limits<double>::infinity();
    rig.run(3);
    EXPECT_EQ(rig.got(0x607F), 90'000);
}

// SV33-E 3.4.3(2) bit 12; SE-808X 3.2.6 reserves it.
TEST(Cia402Mode, ADriveThatDoesNotFollowSaysSo) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.enabled();
    rig.run(6);
    EXPECT_TRUE(rig.feedback().follows_target);
    rig.status(0x0237);
    rig.run(6);
    EXPECT_FALSE(rig.feedback().follows_target);
}

TEST(Cia402Mode, BitTwelveIsNotAskedWhereItIsReserved) {
    DriveRig rig;
    rig.profile.quirks = {Quirk::csp_bits_12_13_reserved};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.mode(8);
    rig.status(0x0037);
    rig.run(6);
    EXPECT_TRUE(rig.feedback().follows_target);
}

class HomingBits : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        rig.mode(6);
        rig.command.power = PowerRequest::on;
        rig.command.mode = DriveMode::homing;
    }
    DriveRig rig;
};

// SV33-E 3.4.3(9): bit 4 starts and is held; bits 12 and 10 together are success.
TEST_F(HomingBits, AttainedNeedsTargetReachedToo) {
    rig.status(0x0237);
    rig.run(6);
    EXPECT_EQ(rig.control(), 0x000F);
    rig.command.start_homing = true;
    rig.run(6);
    EXPECT_EQ(rig.control(), 0x001F);
    rig.status(0x1237);
    rig.run(100);
    EXPECT_FALSE(rig.feedback().homing_attained);
    const auto epoch = rig.feedback().position_epoch;
    rig.status(0x1637);
    rig.run(6);
    EXPECT_TRUE(rig.feedback().homing_attained);
    EXPECT_EQ(rig.feedback().position_epoch, epoch + 1) << "6064h may have jumped";
}

TEST_F(HomingBits, AnEarlierHomingIsNotTakenForThisOne) {
    rig.status(0x1637);
    rig.run(6);
    rig.command.start_homing = true;
    bool attained = false;
    rig.on_cycle = [&] { attained |= rig.feedback().homing_attained; };
    rig.run(20);
    rig.status(0x0237);  // the drive takes the start late
    rig.run(500);
    EXPECT_FALSE(attained);
    rig.status(0x1637);
    rig.run(6);
    EXPECT_TRUE(attained);
}

// Method 35 is over at once: the bit never falls.
TEST_F(HomingBits, AnAttainedBitThatNeverFallsIsBelievedAfterAWhile) {
    rig.status(0x1637);
    rig.run(6);
    rig.command.start_homing = true;
    rig.run(100);
    EXPECT_TRUE(rig.feedback().homing_attained);
}

TEST_F(HomingBits, ErrorOutranksAttained) {
    rig.status(0x0237);
    rig.command.start_homing = true;
    rig.run(6);
    rig.status(0x3637);
    rig.run(6);
    EXPECT_TRUE(rig.feedback().homing_error);
    EXPECT_FALSE(rig.feedback().homing_attained);
}

TEST_F(HomingBits, DroppingTheLevelDropsBitFour) {
    rig.status(0x0237);
    rig.command.start_homing = true;
    rig.run(6);
    rig.command.start_homing = false;
    rig.run(3);
    EXPECT_EQ(rig.control(), 0x000F);
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test

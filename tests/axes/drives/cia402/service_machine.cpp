// What is read and written beside the cycle: details of alarms, parameters.

#include <gmock/gmock.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

DriveAlarmText row(std::uint16_t code, std::uint32_t detail, const char* panel, bool resettable) {
    DriveAlarmText text;
    text.code = code;
    text.detail = detail;
    text.panel = panel;
    text.resettable = resettable;
    return text;
}

/// SV33-E 5.2: 7305h is shared by E.911 (power cycle) and E.917 (resettable) and others; P21.08 = 2021h:09 tells them apart.
class SharedCode : public ::testing::Test {
protected:
    void SetUp() override {
        rig.profile.alarm_detail_index = 0x2021;
        rig.profile.alarm_detail_sub = 9;
        rig.profile.alarms = {row(0x7305, 0x0911, "E.911", false), row(0x7305, 0x0917, "E.917", true), row(0x8611, 0, "E.423", true)};
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
    }
    void fault(std::uint16_t code, std::uint16_t detail) {
        rig.put(0x2021, detail, 9);
        rig.put(0x603F, code);
        rig.status(0x0218);
    }
    DriveRig rig;
};

TEST_F(SharedCode, IsToldApartByTheFurtherObject) {
    fault(0x7305, 0x0917);
    rig.run(5);
    EXPECT_EQ(rig.drive->alarm().code, 0x7305);
    EXPECT_TRUE(rig.drive->alarm().resettable) << "until it is known, a reset is worth the attempt";
    rig.run(200);
    EXPECT_TRUE(rig.drive->alarm().detail_known);
    EXPECT_EQ(rig.drive->alarm().detail, 0x0917u);
    EXPECT_EQ(rig.drive->alarm().entry, 1);
    EXPECT_TRUE(rig.drive->alarm().resettable);
}

TEST_F(SharedCode, ReadingItLosesNoCycle) {
    const auto before = rig.master->statistics();
    bool stale = false;
    rig.on_cycle = [&] { stale |= !rig.feedback().fresh; };
    fault(0x7305, 0x0911);
    rig.run(200);
    EXPECT_TRUE(rig.drive->alarm().detail_known);
    EXPECT_FALSE(rig.drive->alarm().resettable);
    EXPECT_FALSE(stale);
    EXPECT_EQ(rig.master->statistics().frames_lost, before.frames_lost);
}

// The same code again at once, for another reason: the old answer is not this one's.
TEST_F(SharedCode, AReturningCodeIsReadAnew) {
    fault(0x7305, 0x0911);
    rig.run(200);
    ASSERT_EQ(rig.drive->alarm().detail, 0x0911u);
    rig.status(0x0250);
    rig.put(0x603F, 0);
    rig.run(6);
    EXPECT_EQ(rig.drive->alarm().code, 0);
    fault(0x7305, 0x0917);
    bool wrong = false;
    rig.on_cycle = [&] { wrong |= rig.drive->alarm().detail_known && rig.drive->alarm().detail == 0x0911; };
    rig.run(200);
    EXPECT_FALSE(wrong);
    EXPECT_EQ(rig.drive->alarm().detail, 0x0917u);
}

TEST_F(SharedCode, AnUnknownCodeHasNoEntryAndMayBeReset) {
    fault(0x1234, 0);
    rig.run(50);
    EXPECT_EQ(rig.drive->alarm().code, 0x1234);
    EXPECT_EQ(rig.drive->alarm().entry, -1);
    EXPECT_TRUE(rig.drive->alarm().resettable);
}

TEST(Cia402Parameter, IsWrittenAndReadByIndexAndSubIndex) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    const auto write = rig.drive->write_parameter({0x2005, 0x0B}, {std::byte{0x03}, std::byte{0x00}});
    ASSERT_NE(write, 0u);
    const auto written = rig.answer_to(write);
    ASSERT_TRUE(written && written->ok());
    EXPECT_EQ(rig.got(0x2005, 0x0B), 3);

    const auto read = rig.answer_to(rig.drive->read_parameter({0x2005, 0x0B}));
    ASSERT_TRUE(read && read->ok());
    EXPECT_EQ(read->value(), (ServiceAnswer{std::byte{0x03}, std::byte{0x00}}));
}

// SV33-E 6.2.8, TSVM 5.2.5: no SDO to an object that is in the PDO.
TEST(Cia402Parameter, WhatIsMappedIsNotWrittenBesideTheCycle) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_EQ(rig.drive->write_parameter({0x607A, 0}, {std::byte{}, std::byte{}, std::byte{}, std::byte{}}), 0u);
}

TEST(Cia402Parameter, WhatTheDriveRefusesComesBackAsItsError) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    const auto answer = rig.answer_to(rig.drive->read_parameter({0x605B, 0}));  // SV33-E: not in the dictionary
    ASSERT_TRUE(answer.has_value());
    EXPECT_FALSE(answer->ok());
}

TEST(Cia402Service, WhatIsNotServedIsRefusedAtOnce) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_FALSE(rig.drive->capabilities().has(DriveService::clear_multi_turn));
    EXPECT_EQ(rig.drive->start_service(DriveService::clear_multi_turn), 0u);
}

/// SV33-E 3.4.4(1): 60B8h bits 0 enable, 1 continuous, 2 index, 4 rising, 5 falling; 60B9h bit 0 enabled, 1 rising, 2 falling latched.
class Probe : public ::testing::Test {
protected:
    void SetUp() override {
        rig.profile.probes = 1;
        rig.rx.push_back({0x60B8, 0});
        rig.tx.insert(rig.tx.end(), {{0x60B9, 0}, {0x60BA, 0}, {0x60BB, 0}});
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        ASSERT_EQ(rig.drive->capabilities().probes, 1);
        rig.puppet->on_exchange = [this] {
            const auto word = static_cast<unsigned>(rig.got(0x60B8));
            if (words.empty() || words.back() != word) words.push_back(word);
            if (!(word & 1u)) rig.put(0x60B9, 0);
            else rig.put(0x60B9, rig.got(0x60B9) | 1);
        };
    }
    void latch(std::int64_t position) {
        rig.put(0x60BA, position);
        rig.put(0x60B9, rig.got(0x60B9) | 2);
    }
    DriveRig rig;
    std::vector<unsigned> words;
};

TEST_F(Probe, ItsSettingComesBeforeItsEnableBit) {
    rig.command.probes[0] = {.armed = true, .continuous = true, .edge = ProbeEdge::falling};
    rig.run(10);
    EXPECT_THAT(words, ::testing::ElementsAre(0u, 0x22u, 0x23u));
    EXPECT_TRUE(rig.feedback().probes[0].armed);
    EXPECT_FALSE(rig.feedback().probes[0].latched);
}

TEST_F(Probe, ALatchIsGivenInUnwrappedCounts) {
    rig.put(0x6064, 2'147'483'600);
    rig.run(6);
    rig.put(0x6064, -2'147'483'596);
    rig.command.probes[0].armed = true;
    rig.run(10);
    latch(2'147'483'640);  // 60 counts before the actual position, on the other side of the wrap
    rig.run(6);
    EXPECT_TRUE(rig.feedback().probes[0].latched);
    EXPECT_EQ(rig.feedback().probes[0].count, 1);
    EXPECT_EQ(rig.feedback().position - rig.feedback().probes[0].position, 60);
}

// No toggle bits, no counters (SV33-E): the next latch shows by its position.
TEST_F(Probe, ContinuousLatchesAreCounted) {
    rig.command.probes[0] = {.armed = true, .continuous = true};
    rig.run(10);
    latch(100);
    rig.run(6);
    latch(250);
    rig.run(6);
    EXPECT_EQ(rig.feedback().probes[0].count, 2);
    EXPECT_EQ(rig.feedback().probes[0].position, 250);
}

// SV-DA200 3.8.3: bit 6 changes with each latch, so that a second one at the same count shows too.
TEST(ProbeToggle, TellsLatchesAtTheSameCountApart) {
    ProbeLatch latch;
    latch.use_toggle_bits();
    const ProbeCommand wanted{.armed = true, .continuous = true};
    ProbeFeedback seen;
    for (int i = 0; i < 4; ++i) (void)latch.function(wanted);
    EXPECT_FALSE(latch.take(0b0000'0001, 0, seen));
    EXPECT_TRUE(latch.take(0b0100'0011, 500, seen));
    EXPECT_FALSE(latch.take(0b0100'0011, 500, seen));
    EXPECT_TRUE(latch.take(0b0000'0011, 500, seen));
    EXPECT_EQ(seen.count, 2);
    EXPECT_TRUE(latch.take(0b0000'0011, 600, seen)) << "two latches between two looks: the bit is back, the position is not";
}

// Disarmed for one cycle only, and a drive that takes its time: the latch of the arming before is still shown.
TEST_F(Probe, RearmingForgetsTheOldLatch) {
    rig.command.probes[0].armed = true;
    rig.run(10);
    latch(100);
    rig.run(6);
    ASSERT_TRUE(rig.feedback().probes[0].latched);
    int cleared_after = 8;
    rig.puppet->on_exchange = [&] {
        const bool wanted = (rig.got(0x60B8) & 1) != 0;
        if (!wanted && --cleared_after <= 0) rig.put(0x60B9, 0);
        if (wanted && cleared_after <= 0) rig.put(0x60B9, rig.got(0x60B9) | 1);
    };
    rig.command.probes[0].armed = false;
    rig.run(1);
    rig.command.probes[0].armed = true;
    bool stale = false;
    rig.on_cycle = [&] { stale |= rig.feedback().probes[0].latched; };
    rig.run(30);
    EXPECT_FALSE(stale);
    EXPECT_TRUE(rig.feedback().probes[0].armed);
    latch(300);
    rig.run(6);
    EXPECT_EQ(rig.feedback().probes[0].count, 1);
    EXPECT_EQ(rig.feedback().probes[0].position, 300);
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test

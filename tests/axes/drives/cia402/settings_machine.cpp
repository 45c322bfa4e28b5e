// Settings of the drive's own with which it must not be enabled: read by SDO each time it comes into OP, and the enabling waits for them.
// The rows are shaped as those of the SV-DA200 (2.1, 3.3.2): P0.37, P4.07, P4.08.

#include <gmock/gmock.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RequiredSetting row(ParameterAddress object, std::vector<std::int64_t> values) {
    RequiredSetting out;
    out.object = object;
    out.values = std::move(values);
    out.text = "targets are increments";
    out.remedy = "set P0.37 = 1";
    out.section = "3.3.2";
    return out;
}

/// A drive in CSP that would be Operation enabled at once if it were told so.
class DriveSettings : public ::testing::Test {
protected:
    void build() {
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        rig.status(0x1233);  // Switched on, voltage, remote
        rig.mode(8);
        rig.command.power = PowerRequest::on;
    }
    DriveRig rig;
};

TEST_F(DriveSettings, AWrongOneIsSaidAndTheDriveIsNotEnabled) {
    rig.profile.required_settings = {row({0x2005, 0x0B}, {1})};  // reads 0
    build();
    rig.run(200);
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_TRUE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(),
                ElementsAre(AllOf(HasSubstr("'z_drive'"), HasSubstr("targets are increments"), HasSubstr("2005h:0B reads 0"),
                                  HasSubstr("set P0.37 = 1"), HasSubstr("3.3.2"))));
}

TEST_F(DriveSettings, OnceItIsRightTheDriveIsEnabled) {
    rig.profile.required_settings = {row({0x2005, 0x0B}, {1})};
    build();
    rig.run(200);
    ASSERT_FALSE(rig.told_to_enable());
    const auto ticket = rig.drive->write_parameter({0x2005, 0x0B}, {std::byte{1}, std::byte{0}});
    ASSERT_NE(ticket, 0u);
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_FALSE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(), IsEmpty());
}

TEST_F(DriveSettings, WhatFitsLetsItBeEnabled) {
    rig.profile.required_settings = {row({0x2005, 0x0B}, {0, 2}), row({0x2021, 9}, {0})};
    build();
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable());
}

// Every SDO takes several cycles: while they go on nobody knows, and nothing is enabled.
TEST_F(DriveSettings, EnablingWaitsForTheReading) {
    for (int i = 0; i < 10; ++i) {
        rig.others.push_back({0x2020, static_cast<std::uint8_t>(i + 1)});
        rig.profile.required_settings.push_back(row({0x2020, static_cast<std::uint8_t>(i + 1)}, {0}));
    }
    build();
    int waited = 0;
    rig.on_cycle = [&] { waited += rig.told_to_enable() ? 0 : 1; };
    rig.run(3);
    EXPECT_EQ(waited, 3) << "ten objects were not read in eight cycles";
    EXPECT_FALSE(rig.feedback().setup_refused) << "not known is not refused";
    rig.run(300);
    EXPECT_TRUE(rig.told_to_enable());
}

// Somebody changed it while the drive was away: until it was read again, what was read before says nothing.
TEST_F(DriveSettings, WhatWasReadBeforeARestartDoesNotCount) {
    rig.profile.required_settings = {row({0x2005, 0x0B}, {0})};
    build();
    rig.run(200);
    ASSERT_TRUE(rig.told_to_enable());
    rig.network.set_power(0, false);
    rig.run(50);
    rig.network.set_power(0, true);
    bool away = false;
    int back = 0, enabled = 0;
    rig.on_cycle = [&] {
        away = away || !rig.feedback().online;
        if (!away) return;
        rig.status(0x1233);
        rig.mode(8);
        // The first frame that reaches it in OP, too, although nobody has heard yet that it is there.
        if (rig.network.slave(0).state() == ecat::sim::EsmState::op && rig.told_to_enable()) ++enabled;
        if (!rig.feedback().online) return;
        if (back++ == 0) rig.put(0x2005, 1, 0x0B);  // before anybody has asked
    };
    rig.run(5000);
    ASSERT_GT(back, 100);
    EXPECT_EQ(enabled, 0);
    EXPECT_TRUE(rig.feedback().setup_refused);
}

TEST_F(DriveSettings, WhatCannotBeReadIsNotTakenForRight) {
    rig.profile.required_settings = {row({0x2006, 1}, {0})};  // the drive has no such object
    build();
    rig.run(200);
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_THAT(rig.drive->setup_problems(), ElementsAre(HasSubstr("2006h:01 could not be read: it refuses")));
}

struct StuckMailbox : DriveSettings {
    /// Stuck while its ten objects are read.
    void get_stuck() {
        for (int i = 0; i < 10; ++i) {
            rig.others.push_back({0x2020, static_cast<std::uint8_t>(i + 1)});
            rig.profile.required_settings.push_back(row({0x2020, static_cast<std::uint8_t>(i + 1)}, {0}));
        }
        build();
        rig.run(3);
        rig.network.slave(0).stick_mailbox(true);
        rig.run(200);
        ASSERT_FALSE(rig.told_to_enable()) << "all was read before it got stuck: this shows nothing";
    }
};

// A question that a stuck mailbox has swallowed never gets an answer, however well the drive is by then.
TEST_F(StuckMailbox, WhatItSwallowedIsAskedOnceMore) {
    get_stuck();
    rig.network.slave(0).stick_mailbox(false);
    bool refused = false;
    rig.on_cycle = [&] { refused = refused || rig.feedback().setup_refused; };
    rig.run(20'000);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_FALSE(refused);
}

TEST_F(StuckMailbox, ForGoodItSaysNothingAboutTheObjects) {
    get_stuck();
    rig.run(20'000);
    EXPECT_FALSE(rig.told_to_enable());
    EXPECT_TRUE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(),
                Contains(AllOf(HasSubstr("2020h:0A could not be read: its mailbox did not answer"), HasSubstr("a reset reads it again"))));
    rig.network.slave(0).stick_mailbox(false);
    rig.command.reset_fault = true;
    rig.run(20'000);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_FALSE(rig.feedback().setup_refused);
}

// Set at the drive's own panel: nothing on the bus tells of it. Who resets the axis says that it was mended.
TEST_F(DriveSettings, AResetReadsThemAgain) {
    rig.profile.required_settings = {row({0x2005, 0x0B}, {1})};
    build();
    rig.run(200);
    ASSERT_TRUE(rig.feedback().setup_refused);
    rig.command.reset_fault = true;
    rig.run(200);
    EXPECT_TRUE(rig.feedback().setup_refused) << "nothing was mended";
    EXPECT_FALSE(rig.told_to_enable());
    rig.command.reset_fault = false;
    rig.network.slave(0).dictionary().find(0x2005, 0x0B)->set(1);
    rig.run(200);
    EXPECT_TRUE(rig.feedback().setup_refused);
    rig.command.reset_fault = true;
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_FALSE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(), IsEmpty());
}

// P4.07: place n of the list is the cycle (SV-DA200 2.1 note 2). The rig exchanges every millisecond.
TEST_F(DriveSettings, ACycleThatIsNotThatOfTheBusIsRefused) {
    RequiredSetting cycle = row({0x2005, 0x0B}, {});
    cycle.cycles = {1ms, 500us};
    rig.profile.required_settings = {cycle};
    build();
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable()) << "reads 0: 1 ms";
    rig.put(0x2005, 1, 0x0B);
    ASSERT_NE(rig.drive->write_parameter({0x2005, 0x0B}, {std::byte{1}, std::byte{0}}), 0u);
    rig.run(200);
    EXPECT_TRUE(rig.feedback().setup_refused);
    EXPECT_THAT(rig.drive->setup_problems(), ElementsAre(AllOf(HasSubstr("reads 1: 500 us"), HasSubstr("every 1000 us"))));
}

// P4.08 is 2 on a bus with SYNC0 and 0 on one without (SV-DA200 2.1): the rig's slave runs on SYNC0.
TEST_F(DriveSettings, ARowForABusWithoutClocksDoesNotCountOnOneWithThem) {
    auto with = row({0x2005, 0x0B}, {0}), without = row({0x2005, 0x0B}, {7});
    with.when = SettingApplies::with_clocks;
    without.when = SettingApplies::without_clocks;
    rig.profile.required_settings = {with, without};
    build();
    rig.run(200);
    EXPECT_TRUE(rig.told_to_enable());
    EXPECT_THAT(rig.drive->setup_problems(), IsEmpty());
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test

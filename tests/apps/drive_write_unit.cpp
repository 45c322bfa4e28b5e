// What goes into a drive's EEPROM and what does not, counted at a drive that stores as SV33-E and SE-808X do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "apps/drive/drive.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// P05.10 (2005h:0B): while it is not 0 every write is stored (SV33-E 7.2). P05.13 and P05.14: two settings.
const axes::ParameterAddress store_switch{0x2005, 0x0B}, brake_release{0x2005, 0x0E}, brake_hold{0x2005, 0x0F};
const axes::ParameterAddress encoder_use{0x2004, 0x03};  ///< P04.02 counts after a restart (SV33-E 7.2)

axes::DriveProfile profile_storing(axes::ParameterStorage storage) {
    axes::DriveProfile profile;
    profile.name = "stored";
    profile.storage.way = storage;
    if (storage == axes::ParameterStorage::each_write) profile.storage.switched_by = store_switch;
    const auto add = [&](axes::ParameterAddress address, const char* name, std::int64_t factory) {
        axes::DriveParameter parameter;
        parameter.address = address;
        parameter.parameter = parameter.name = name;
        parameter.value = factory;
        profile.parameters.push_back(parameter);
    };
    add(store_switch, "P05.10", 1);
    add(brake_release, "P05.13", 250);
    add(brake_hold, "P05.14", 150);
    add(encoder_use, "P04.02", 0);
    profile.parameters.back().effect = axes::ParameterEffect::after_restart;
    return profile;
}

/// RAM, EEPROM, and a hand on the cable: access number `fails_at` and all behind it end with an error, as after Ctrl-C.
class FakeDrive final : public DriveAccess {
public:
    explicit FakeDrive(axes::ParameterStorage storage) : DriveAccess(std::make_shared<const axes::DriveProfile>(profile_storing(storage))) {
        for (const auto& parameter : profile().parameters) ram[parameter.address.sub] = eeprom[parameter.address.sub] = parameter.value;
    }
    [[nodiscard]] std::string subject() const override { return "slave 0 'x'"; }
    [[nodiscard]] std::string word() const override { return "x"; }
    [[nodiscard]] std::string where() const override { return "desk"; }
    [[nodiscard]] Result<std::vector<std::byte>> read_bytes(const axes::DriveParameter& parameter) override {
        if (auto end = count(); !end) return end.error();
        const auto raw = static_cast<std::uint16_t>(ram[parameter.address.sub]);
        return std::vector<std::byte>{static_cast<std::byte>(raw & 0xFF), static_cast<std::byte>(raw >> 8)};
    }
    [[nodiscard]] Result<void> write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value, Storing) override {
        if (auto end = count(); !end) return end;
        const auto raw = std::to_integer<std::int64_t>(value[0]) | std::to_integer<std::int64_t>(value[1]) << 8;
        ram[parameter.address.sub] = raw;
        const bool stores = profile().storage.way == axes::ParameterStorage::each_write && ram[store_switch.sub] != 0;
        if (stores) eeprom[parameter.address.sub] = raw, ++eeprom_writes;
        return {};
    }
    [[nodiscard]] Result<void> store_all() override {
        eeprom = ram;
        ++eeprom_writes;
        return {};
    }
    [[nodiscard]] Result<DriveComplaint> complaint() override { return DriveComplaint{}; }
    [[nodiscard]] Result<bool> reset_fault(Duration) override { return true; }
    void wait(Duration) override {}
    void finish_undisturbed() override { undisturbed = true; }

    [[nodiscard]] config::ParameterSet::Value value(const axes::ParameterAddress& address, std::int64_t raw) const {
        for (const auto& parameter : profile().parameters)
            if (parameter.address == address) return {&parameter, raw};
        return {};
    }

    std::map<std::uint8_t, std::int64_t> ram, eeprom;  // by sub-index
    int eeprom_writes = 0, accesses = 0, fails_at = 1'000'000;
    bool undisturbed = false, dead = false;

private:
    Result<void> count() {
        if (++accesses >= fails_at && (dead || !undisturbed)) return Error{"bus.interrupted", "", "ended before it was done", ""};
        return {};
    }
};

using axes::ParameterStorage;

TEST(DriveWrite, WithoutStoringTheSwitchGoesOffFirstAndNothingReachesTheEeprom) {
    FakeDrive drive{ParameterStorage::each_write};
    const auto written = write_values(drive, {drive.value(brake_release, 300)}, Storing::volatile_only);
    EXPECT_FALSE(written.error);
    EXPECT_EQ(drive.ram[brake_release.sub], 300);
    EXPECT_EQ(drive.eeprom_writes, 0);
    EXPECT_THAT(written.notes, Contains(HasSubstr("--store keeps them")));
    const auto again = write_values(drive, {drive.value(brake_release, 310)}, Storing::volatile_only);  // the switch is off already
    EXPECT_THAT(again.notes, ElementsAre(HasSubstr("--store keeps them")));
}

TEST(DriveWrite, StoringSwitchesOnStoresAndSwitchesOffAgain) {
    FakeDrive drive{ParameterStorage::each_write};
    drive.ram[store_switch.sub] = 0;
    const auto written = write_values(drive, {drive.value(brake_release, 300)}, Storing::asked);
    EXPECT_FALSE(written.error);
    EXPECT_EQ(drive.eeprom[brake_release.sub], 300);
    EXPECT_EQ(drive.ram[store_switch.sub], 0);
    EXPECT_THAT(written.notes, Contains(HasSubstr("1 value stored")));
}

// SV33-E 7.2: P05.10 = 1 stores the 2000h only, 2 the 6000h only; 3, as delivered, both. The fake drive as delivered has 1, so 2 is "a part".
TEST(DriveWrite, ASwitchThatStoresAPartOnlyIsSetForTheWriting) {
    FakeDrive drive{ParameterStorage::each_write};
    drive.ram[store_switch.sub] = 2;
    const auto written = write_values(drive, {drive.value(brake_release, 300)}, Storing::asked);
    EXPECT_FALSE(written.error);
    EXPECT_THAT(written.notes, Contains(HasSubstr("P05.10 was 2: 1 while these values are stored, then 2 again")));
    EXPECT_EQ(drive.ram[store_switch.sub], 2);
}

TEST(DriveWrite, AValueThatIsInForceButWasNeverStoredIsStored) {
    FakeDrive each{ParameterStorage::each_write};
    each.ram[store_switch.sub] = 0;
    each.ram[brake_release.sub] = 300;  // written without storing, before
    const auto written = write_values(each, {each.value(brake_release, 300)}, Storing::asked);
    EXPECT_THAT(written.changes, IsEmpty());
    EXPECT_EQ(each.eeprom[brake_release.sub], 300);

    FakeDrive at_once{ParameterStorage::on_request};
    at_once.ram[brake_release.sub] = 300;
    EXPECT_FALSE(write_values(at_once, {at_once.value(brake_release, 300)}, Storing::asked).error);
    EXPECT_EQ(at_once.eeprom[brake_release.sub], 300);
    EXPECT_EQ(at_once.eeprom_writes, 1);
}

// Lost before it counts: it would read as if it were in force, and never be.
TEST(DriveWrite, WhatCountsAfterARestartIsNotWrittenUnlessItIsStored) {
    for (const auto storage : {ParameterStorage::each_write, ParameterStorage::on_request}) {
        FakeDrive drive{storage};
        const auto refused = write_values(drive, {drive.value(brake_release, 300), drive.value(encoder_use, 1)}, Storing::volatile_only);
        ASSERT_TRUE(refused.error);
        EXPECT_EQ(refused.error->code, "drive.needs_store");
        EXPECT_THAT(refused.error->what, HasSubstr("P04.02"));
        EXPECT_THAT(refused.error->remedy, HasSubstr("--store"));
        EXPECT_EQ(drive.ram[brake_release.sub], 250) << "nothing is half done";
        EXPECT_EQ(drive.ram[encoder_use.sub], 0);

        const auto stored = write_values(drive, {drive.value(encoder_use, 1)}, Storing::asked);
        EXPECT_FALSE(stored.error);
        EXPECT_EQ(drive.eeprom[encoder_use.sub], 1);
        EXPECT_THAT(stored.notes, Contains(HasSubstr("P04.02 counts after the drive's next restart")));
    }
    FakeDrive never{ParameterStorage::never};
    const auto refused = write_values(never, {never.value(encoder_use, 1)}, Storing::volatile_only);
    ASSERT_TRUE(refused.error);
    EXPECT_THAT(refused.error->remedy, HasSubstr("maker's tool"));
    EXPECT_FALSE(write_values(never, {never.value(encoder_use, 0)}, Storing::volatile_only).error) << "it is so already";
}

TEST(DriveWrite, WithoutStoringWhatIsInForceIsNotTouched) {
    FakeDrive drive{ParameterStorage::each_write};
    EXPECT_FALSE(write_values(drive, {drive.value(brake_release, 250)}, Storing::volatile_only).error);
    EXPECT_EQ(drive.ram[store_switch.sub], 1) << "not even the switch";
}

// Accesses: two reads of the values, the switch read, the switch written, then write and read back of each value. Whichever of the
// last five is the first to fail, the switch is off at the end. (A read back that fails is no error of its own: the write was answered.)
TEST(DriveWrite, TheSwitchIsOffAgainHoweverTheWritingEnds) {
    for (int fails_at = 4; fails_at <= 8; ++fails_at) {
        FakeDrive drive{ParameterStorage::each_write};
        drive.ram[store_switch.sub] = 0;
        drive.fails_at = fails_at;
        const auto written = write_values(drive, {drive.value(brake_release, 300), drive.value(brake_hold, 200)}, Storing::asked);
        if (fails_at == 6 || fails_at == 8) {
            EXPECT_EQ(drive.eeprom[brake_release.sub], 300) << fails_at;
        } else {
            ASSERT_TRUE(written.error) << fails_at;
            EXPECT_EQ(written.error->code, "bus.interrupted") << fails_at;
        }
        EXPECT_EQ(drive.ram[store_switch.sub], 0) << fails_at;
        EXPECT_TRUE(drive.undisturbed) << fails_at << ": Ctrl-C must not hold it up";
    }
}

TEST(DriveWrite, ASwitchThatCannotBePutBackIsSaidWithTheCommandThatDoesIt) {
    FakeDrive drive{ParameterStorage::each_write};
    drive.ram[store_switch.sub] = 0;
    drive.fails_at = 5;  // the second value's read is 2, the switch 3 and 4
    drive.dead = true;
    const auto written = write_values(drive, {drive.value(brake_release, 300), drive.value(brake_hold, 200)}, Storing::asked);
    ASSERT_TRUE(written.error);
    EXPECT_THAT(written.notes, Contains(HasSubstr("taktwerk drive set x P05.10=0")));
}

// A set from a drive as delivered holds P05.10 = 1: it stays so, and whether this write is stored is still what its user asked.
TEST(DriveWrite, WhoWritesTheSwitchItselfDecidesHowItStays) {
    for (const auto& [storing, kept] : {std::pair{Storing::asked, 300}, {Storing::volatile_only, 250}}) {
        FakeDrive drive{ParameterStorage::each_write};
        drive.ram[store_switch.sub] = 0;
        const auto written = write_values(drive, {drive.value(store_switch, 1), drive.value(brake_release, 300)}, storing);
        EXPECT_FALSE(written.error);
        EXPECT_EQ(drive.ram[brake_release.sub], 300);
        EXPECT_EQ(drive.eeprom[brake_release.sub], kept);
        EXPECT_EQ(drive.ram[store_switch.sub], 1);
        EXPECT_THAT(written.notes, Not(Contains(HasSubstr("then 0 again"))));
    }
}

// A set that `save` took from a running machine holds P05.10 = 0, in the midst of the others: those behind it are stored all the same.
TEST(DriveWrite, ASetThatSwitchesStoringOffIsStoredAsAWhole) {
    for (const std::int64_t before : {0, 1}) {
        FakeDrive drive{ParameterStorage::each_write};
        drive.ram[store_switch.sub] = before;
        const auto written = write_values(
            drive, {drive.value(brake_hold, 200), drive.value(store_switch, 0), drive.value(brake_release, 300)}, Storing::asked);
        EXPECT_FALSE(written.error);
        EXPECT_EQ(drive.eeprom[brake_hold.sub], 200) << before;
        EXPECT_EQ(drive.eeprom[brake_release.sub], 300) << before;
        EXPECT_EQ(drive.ram[store_switch.sub], 0) << before;
        EXPECT_THAT(written.notes, Contains(HasSubstr("3 values stored in the EEPROM"))) << before;
    }
}

// Half a set is none: a cable that fails while it is read is an error, not a parameter that the drive does not have.
TEST(KeptSettings, AreAllOrAnError) {
    FakeDrive drive{ParameterStorage::each_write};
    ASSERT_TRUE(kept_settings(drive, Kept::all));
    drive.accesses = 0, drive.fails_at = 3;
    const auto kept = kept_settings(drive, Kept::all);
    ASSERT_FALSE(kept);
    EXPECT_EQ(kept.error().code, "bus.interrupted");
    drive.accesses = 0;
    EXPECT_FALSE(difference_from_factory(drive));
}

}  // namespace
}  // namespace taktwerk::apps

// `taktwerk esi` as a user meets it, on a file of a vendor that does not exist.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string works = (source / "tests/apps/esi/works.xml").string();

Outcome esi(std::vector<std::string> words) {
    words.insert(words.begin(), "esi");
    return in_process(std::move(words));
}

TEST(EsiCommand, ListShowsTypeIdentityAndNamesOfWhatIsNotReplaced) {
    const auto list = esi({"list", works});
    EXPECT_EQ(list.code, exit_ok) << list.err;
    EXPECT_THAT(list.out, AllOf(HasSubstr("Works (vendor 0000270Fh), 6 devices"),
                                HasSubstr("DI2    00000D14h  00020000h  2 digital inputs · 2 路数字输入"), HasSubstr("SERVO"),
                                HasSubstr("1 revision older or hidden")));
    EXPECT_THAT(list.out, Not(HasSubstr("first edition")));
    EXPECT_THAT(esi({"list", works, "--all"}).out, HasSubstr("first edition"));
}

TEST(EsiCommand, ListAsJsonHoldsAllOfThem) {
    const auto json = esi({"list", works, "--json"}).json();
    EXPECT_EQ(json["vendor"], 9999);
    ASSERT_EQ(json["devices"].size(), 6u);
    EXPECT_EQ(json["devices"][0]["hidden"], true);
    EXPECT_EQ(json["devices"][1]["revision"], 0x20000);
    EXPECT_EQ(json["devices"][1]["group"], "Terminals");
}

TEST(EsiCommand, ShowHasEveryPartOfTheDevice) {
    const auto show = esi({"show", works, "--device", "ai1"});
    EXPECT_EQ(show.code, exit_ok) << show.err;
    EXPECT_THAT(show.out, AllOf(HasSubstr("vendor 0000270Fh product 00000A12h revision 00030000h"), HasSubstr("ports: E-bus, E-bus"),
                                HasSubstr("E-bus: takes 130 mA"), HasSubstr("Dictionary (5 values)"), HasSubstr("profile 5001"),
                                HasSubstr("mailbox out"), HasSubstr("not enabled")));
    EXPECT_THAT(show.out, AllOf(HasSubstr("TxPDO 1A00h Standard: in SM3, fixed, not with 1A01h"), HasSubstr("6000h:11"), HasSubstr("gap"),
                                HasSubstr("TxPDO 1A01h Compact: not assigned"), HasSubstr("complete access"), HasSubstr("also FoE"),
                                HasSubstr("an answer may take 2000 ms")));
    EXPECT_THAT(show.out, AllOf(HasSubstr("50 Hz filter"), HasSubstr("0300h"), HasSubstr("bus cycle, shift 10 us"),
                                HasSubstr("Settings: Filter"), HasSubstr("Device/Su (1, first in line 53)")));
}

TEST(EsiCommand, ShowHasSlotsAndModules) {
    const auto show = esi({"show", works, "--device", "BOX"});
    EXPECT_THAT(show.out, AllOf(HasSubstr("at most 4 slots; of each the PDOs are 1h further, the objects 10h"),
                                HasSubstr("Terminal (0 to 4): 11h, 12h"), HasSubstr("Module DI4 (11h) 4 inputs"),
                                HasSubstr("Module AO1 (12h) 1 analog output")));
}

TEST(EsiCommand, ShowAsJsonHoldsTheSame) {
    const auto json = esi({"show", works, "--device", "AI1", "--json"}).json();
    EXPECT_EQ(json["product"], 0xA12);
    EXPECT_EQ(json["sync_managers"].size(), 4u);
    EXPECT_EQ(json["tx"][0]["excludes"][0], 0x1A01);
    EXPECT_EQ(json["op_modes"][1]["sync0_shift_ns"], 10000);
    EXPECT_EQ(json["mailbox"]["init_commands"][0]["data"], "0100");
    EXPECT_EQ(json["objects"].size(), 5u);
    EXPECT_EQ(json["unread"][0]["path"], "Device/Su");
}

TEST(EsiCommand, AnotherRevisionIsTakenWhenAsked) {
    EXPECT_THAT(esi({"show", works, "--device", "DI2"}).out, HasSubstr("revision 00020000h"));
    EXPECT_THAT(esi({"show", works, "--device", "DI2", "--revision", "0x10000"}).out, HasSubstr("hidden: newer ones take its place"));
    const auto none = esi({"show", works, "--device", "DI2", "--revision", "new"});
    EXPECT_EQ(none.code, exit_usage);
    EXPECT_THAT(none.err, HasSubstr("'new' is no revision"));
}

TEST(EsiCommand, WhatIsWrongInADeviceIsShownWithItsPlace) {
    const auto torn = esi({"show", works, "--device", "TORN"});
    EXPECT_EQ(torn.code, exit_bad_file);
    EXPECT_THAT(torn.out, AllOf(HasSubstr("Wrong in the file: it cannot be used like this"),
                                HasSubstr("works.xml:104:12 (Device 'TORN'/TxPdo/Entry)")));
}

TEST(EsiCommand, WhatIsNotThereIsRefused) {
    const auto several = esi({"show", works});
    EXPECT_EQ(several.code, exit_usage);
    EXPECT_THAT(several.err, HasSubstr("it holds 5 types of device"));
    const auto no_file = esi({"list", "/nowhere/a.xml"});
    EXPECT_EQ(no_file.code, exit_bad_file);
    EXPECT_THAT(no_file.err, HasSubstr("/nowhere/a.xml: the file cannot be read"));
    EXPECT_THAT(no_file.out, IsEmpty());
    EXPECT_EQ(esi({"list", demo}).code, exit_bad_file) << "a machine file is no ESI file";
}

}  // namespace
}  // namespace taktwerk::apps

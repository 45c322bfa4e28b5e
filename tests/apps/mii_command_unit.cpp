// `taktwerk bus mii` as a user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Outcome mii(std::vector<std::string> words) {
    words.insert(words.begin(), {"bus", "mii"});
    words.insert(words.end(), {"--machine", demo, "--simulate"});
    return in_process(std::move(words));
}

TEST(MiiCommand, ShowsTheLinksOfASlavesPorts) {
    const auto all = mii({"io"});
    ASSERT_EQ(all.code, exit_ok) << all.err;
    EXPECT_THAT(all.out, AllOf(HasSubstr("slave 3 'io'"), HasSubstr("100 Mbit"), HasSubstr("full"), HasSubstr("both ends agreed"),
                               HasSubstr("none"), HasSubstr("2000h 5C90h National Semiconductor (TI)")));
    const auto one = mii({"0", "1", "--json"});
    ASSERT_EQ(one.code, exit_ok) << one.err;
    const auto json = one.json();
    ASSERT_EQ(json["ports"].size(), 1u);
    EXPECT_EQ(json["ports"][0]["port"], 1);
    EXPECT_EQ(json["ports"][0]["megabits"], 100);
    EXPECT_EQ(json["ports"][0]["full_duplex"], true);
    EXPECT_EQ(mii({"0", "2"}).code, exit_usage) << "no such port";
    EXPECT_EQ(mii({"0", "4"}).code, exit_usage);
    EXPECT_EQ(mii({"9"}).code, exit_usage);
}

TEST(MiiCommand, SaysWhatIsWrongWithALink) {
    ecat::PhyReport report;
    report.port = 1;
    report.phy = ecat::PhyRegisters{0x1000, 0x0024, 0x0022, 0x1560, 0x01E1, 0x0021, 0};
    const auto text = mii_text("slave 2 'y'", {report}, Colours::off);
    EXPECT_THAT(text, AllOf(HasSubstr("10 Mbit"), HasSubstr("half"), HasSubstr("this end only"), HasSubstr("Micrel")));
    EXPECT_THAT(text, HasSubstr("port 1: 10 Mbit half duplex, and EtherCAT needs 100 Mbit full duplex"));
    EXPECT_THAT(mii_text("slave 2", {}, Colours::off), HasSubstr("none of its ports has a PHY"));
}

}  // namespace
}  // namespace taktwerk::apps

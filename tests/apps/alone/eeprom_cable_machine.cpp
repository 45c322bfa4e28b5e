// `taktwerk bus eeprom` in real time on a cable, with slaves that keep what is written: those of `taktwerk sim`. Needs root; skipped otherwise.

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/foreign_master.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class EepromOnACable : public ::testing::Test {
protected:
    ~EepromOnACable() override { fs::remove_all(folder); }
    std::string bus(std::vector<std::string> words, int expected) {
        words.insert(words.begin(), {taktwerk, "bus"});
        words.insert(words.end(), {"--nic", "twk0"});
        std::string said;
        EXPECT_EQ(run(cable.at_master(std::move(words)), &said), expected) << said;
        return said;
    }
    const Cable cable;
    const std::string folder = (fs::temp_directory_path() / ("taktwerk-eeprom-cable-" + std::to_string(::getpid()))).string();
};

TEST_F(EepromOnACable, AnAliasIsWrittenCountsAfterThePowerCycleAndTheBackupTakesItBack) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    Child slaves(cable.at_slaves({taktwerk, "sim", demo, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'demo'", 20s)) << slaves.text();

    const Json kept = Json::parse(bus({"eeprom", "backup", "-d", folder, "--json"}, exit_ok));
    ASSERT_EQ(kept["backups"].size(), 4u);
    const std::string backup = kept["backups"][1]["file"];

    EXPECT_THAT(bus({"eeprom", "alias", "1", "77", "-d", folder}, exit_ok), AllOf(HasSubstr("2 words written"), HasSubstr(backup)));
    EXPECT_EQ(Json::parse(bus({"scan", "--json"}, exit_ok))["slaves"][1]["alias"], 0) << "not yet";
    slaves.say("power-cycle y_drive 200ms");
    const auto shown = [&] {  // without power it is not on the bus at all
        const Json slaves = Json::parse(bus({"scan", "--json"}, exit_ok))["slaves"];
        return slaves.size() > 1 ? slaves[1].value("alias", 0) : 0;
    };
    int alias = shown();
    for (int i = 0; i < 50 && alias != 77; ++i) alias = shown();
    EXPECT_EQ(alias, 77);
    EXPECT_THAT(bus({"eeprom", "alias", "0", "77", "-d", folder}, exit_refused), HasSubstr("has alias 77 already"));

    EXPECT_THAT(bus({"eeprom", "write", "1", backup, "-d", folder}, exit_usage), HasSubstr("--yes")) << "nobody was there to answer";
    EXPECT_THAT(bus({"eeprom", "write", "1", backup, "-d", folder, "--yes"}, exit_ok), HasSubstr("2 words written"));
    EXPECT_EQ(Json::parse(bus({"eeprom", "read", "1", "--json"}, exit_ok))["alias"], 0);
    EXPECT_EQ(std::distance(fs::directory_iterator{folder}, fs::directory_iterator{}), 5) << "four, and the one with the alias";

    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

TEST_F(EepromOnACable, BesideAnotherMasterNothingIsWrittenWithForceNeither) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    Child slaves(cable.at_slaves({taktwerk, "sim", demo, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'demo'", 20s)) << slaves.text();
    const ForeignMaster other(cable.master_end(), "twk0");
    for (int i = 0; i < 1000 && other.answered() < 50; ++i) std::this_thread::sleep_for(10ms);
    ASSERT_GE(other.answered(), 50) << "the other master does not reach its slave";

    EXPECT_THAT(bus({"eeprom", "alias", "1", "77", "-d", folder, "--force"}, exit_bus),
                AllOf(HasSubstr("another master is sending on this cable"), HasSubstr("with --force neither")));
    EXPECT_FALSE(fs::exists(folder));
    EXPECT_EQ(other.disturbed(), 0);
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

}  // namespace
}  // namespace taktwerk::apps

// Files and firmware in real time on a cable, with slaves that keep what is written: those of `taktwerk sim`. Needs root; skipped otherwise.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/foreign_master.hpp"
#include "tests/apps/gauge_files.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

class FilesOnACable : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
        if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        slaves.emplace(cable.at_slaves({taktwerk, "sim", files.machine, "--nic", "twk1"}));
        ASSERT_TRUE(slaves->says("slaves of 'gauges'", 20s)) << slaves->text();
    }
    void TearDown() override {
        if (!slaves) return;
        slaves->signal(SIGTERM);
        EXPECT_EQ(slaves->wait(10s), exit_ok) << slaves->text();
    }
    std::vector<std::string> words(std::vector<std::string> rest) const {
        rest.insert(rest.begin(), {taktwerk, "bus"});
        rest.insert(rest.end(), {"--nic", "twk0"});
        return cable.at_master(std::move(rest));
    }
    std::string bus(std::vector<std::string> rest, int expected) const {
        std::string said;
        EXPECT_EQ(run(words(std::move(rest)), &said), expected) << said;
        return said;
    }
    const GaugeFiles files;
    const Cable cable;
    std::optional<Child> slaves;
};

TEST_F(FilesOnACable, FirmwareIsWrittenOnceSomebodySaysYesAndStays) {
    const auto image = files.firmware("firmware.bin", "2.1", 0x00020001);
    EXPECT_THAT(bus({"firmware", "1", image}, exit_usage), HasSubstr("--yes")) << "nobody was there to answer";
    EXPECT_THAT(bus({"firmware", "1", image, "--yes"}, exit_ok), AllOf(HasSubstr("software '1.0' -> '2.1'"), HasSubstr("in PREOP")));
    slaves->say("power-cycle gauge 200ms");
    for (int i = 0; i < 100 && bus({"scan"}, exit_ok).find("00020001h") == std::string::npos; ++i) std::this_thread::sleep_for(50ms);
    EXPECT_THAT(bus({"scan"}, exit_ok), HasSubstr("revision 00020001h"));

    const auto note = files.keep("note.txt", "kept in the slave\n");
    bus({"file", "write", "1", "note.txt", note}, exit_ok);
    EXPECT_THAT(bus({"file", "read", "1", "note.txt"}, exit_ok), HasSubstr("kept in the slave\n"));
}

TEST_F(FilesOnACable, ACommandThatIsKilledLeavesTheSlaveInBootAndTheNextOneWritesItFromThere) {
    const auto image = files.firmware("firmware.bin", "2.1", 0x00020001, 0x4711, 200'000);
    Child writing(words({"firmware", "1", image, "--yes"}));
    ASSERT_TRUE(writing.says("30 %", 20s)) << writing.text();
    writing.signal(SIGINT);
    writing.signal(SIGKILL);
    EXPECT_EQ(writing.wait(5s), 128 + SIGKILL);
    EXPECT_THAT(bus({"state"}, exit_ok), HasSubstr("BOOT"));
    EXPECT_THAT(bus({"firmware", "1", image, "--yes"}, exit_ok), HasSubstr("revision 00010000h -> 00020001h"));
}

TEST_F(FilesOnACable, BesideAnotherMasterNothingBeginsWithForceNeither) {
    const ForeignMaster other(cable.master_end(), "twk0");
    for (int i = 0; i < 1000 && other.answered() < 50; ++i) std::this_thread::sleep_for(10ms);
    ASSERT_GE(other.answered(), 50) << "the other master does not reach its slave";
    EXPECT_THAT(bus({"firmware", "1", files.firmware("firmware.bin", "2.1", 2), "--yes", "--force"}, exit_bus),
                AllOf(HasSubstr("another master is sending on this cable"), HasSubstr("with --force neither")));
    EXPECT_EQ(other.disturbed(), 0);
}

}  // namespace
}  // namespace taktwerk::apps

// `taktwerk drive` while the machine runs: it asks the machine instead of its bus. The smallest machine, in real time with relaxed supervision.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class DriveOfARunningMachine : public ::testing::Test {
protected:
    DriveOfARunningMachine() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        std::ifstream in(source / "config/machines/minimal.yaml");
        std::ofstream(folder / "machines/minimal.yaml") << in.rdbuf() << "hmi: { socket: '" << (folder / "socket").string()
                                                        << "', lcm: { enabled: false } }\nsimulation: { supervision: relaxed }\n";
    }
    ~DriveOfARunningMachine() override { std::filesystem::remove_all(folder); }

    std::string asked(std::vector<std::string> words, int expected = exit_ok) const {
        words.insert(words.begin(), taktwerk);
        words.insert(words.end(), {"-s", folder / "socket"});
        Child child(std::move(words));
        EXPECT_EQ(child.wait(30s), expected) << child.text();
        return child.text();
    }
    std::filesystem::path folder;
};

// minimal.yaml: axis x on the SV33-E 'x_drive'. Values of SV33-E 7.2.
TEST_F(DriveOfARunningMachine, IsReadWrittenAndStoredWhileItRuns) {
    Child machine({taktwerk, "run", folder / "machines/minimal.yaml"});
    ASSERT_TRUE(machine.says("running, manual mode", 30s)) << machine.text();

    EXPECT_THAT(asked({"drive", "identify"}), AllOf(HasSubstr("axis x ('x_drive')"), HasSubstr("sv33-e")));
    EXPECT_THAT(asked({"drive", "get", "x", "P05.13"}), HasSubstr("= 250 ms"));
    EXPECT_THAT(asked({"drive", "get", "x_drive", "P05.13", "--json"}), HasSubstr(R"("shown":"250 ms")"));
    EXPECT_THAT(asked({"drive", "params", "0", "--filter", "P05.1"}), AllOf(HasSubstr("P05.13"), HasSubstr("0 .. 500 ms")));
    EXPECT_THAT(asked({"drive", "get", "y", "P05.13"}, exit_usage), HasSubstr("x_drive (axis x)"));
    EXPECT_THAT(asked({"drive", "alarms", "x"}), HasSubstr("no alarm"));
    EXPECT_THAT(asked({"drive", "reset", "x"}), HasSubstr("nothing to reset"));

    EXPECT_THAT(asked({"drive", "set", "x", "P05.13=300"}), AllOf(HasSubstr("250 ms"), HasSubstr("300 ms"), HasSubstr("--store")));
    EXPECT_TRUE(machine.says("writes P05.13 (", 10s)) << machine.text();
    EXPECT_THAT(machine.text(), Not(HasSubstr("into the EEPROM"))) << "nothing was stored";

    EXPECT_THAT(asked({"drive", "set", "x", "P05.13=300", "--store"}), HasSubstr("1 value stored in the EEPROM"));
    EXPECT_TRUE(machine.says("300 ms, into the EEPROM", 10s)) << machine.text();
    EXPECT_THAT(asked({"drive", "get", "x", "P05.10"}), HasSubstr("= 0")) << "the switch is off again";

    EXPECT_THAT(asked({"drive", "clear-turns", "x"}, exit_usage), AllOf(HasSubstr("must be homed"), HasSubstr("--yes")));
    EXPECT_THAT(asked({"drive", "clear-turns", "x", "--yes"}), HasSubstr("the turns are cleared"));
    EXPECT_TRUE(machine.says("clears the encoder's turns of axis x", 10s)) << machine.text();

    // The machine's rules: a program that could start any time must not find another drive than it left.
    asked({"mode", "automatic"});
    EXPECT_THAT(asked({"drive", "set", "x", "P05.13=250"}, exit_refused), HasSubstr("manual"));
    EXPECT_THAT(asked({"drive", "get", "x", "P05.13"}), HasSubstr("= 300 ms"));

    asked({"shutdown"});
    EXPECT_EQ(machine.wait(20s), exit_ok) << machine.text();
    EXPECT_THAT(asked({"drive", "get", "x", "P05.13"}, exit_no_runtime), HasSubstr("taktwerk run"));
}

}  // namespace
}  // namespace taktwerk::apps

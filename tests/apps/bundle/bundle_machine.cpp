// A machine from its bundle, with the built command: it starts, keeps what it knows, comes back from a version that does not start, and is not changed under
// power.

#include <unistd.h>

#include <chrono>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using runtime::TemporaryFolder;
using runtime::text_of_file;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto patience = 60s;

struct BundleMachine : ::testing::Test {
    TemporaryFolder folder;
    [[nodiscard]] std::string path(const std::string& name) const { return (folder.path() / name).string(); }

    /// One axis, and a program that counts scans; `interface` is where the bus is.
    void write_machine(const std::string& interface, int program) const {
        folder.write("cell.yaml",
                     "version: 1\nname: cell\ncycle: 1 ms\nstart_mode: automatic\nbus:\n  interface: " + interface +
                         "\n  slaves:\n    - { name: x_drive, profile: sv33-e }\naxes:\n  x:\n    slave: x_drive\n    unit: mm\n"
                         "    gearing: { counts_per_revolution: 131072, feed: 10 mm }\n"
                         "    limits: { velocity: 300 mm/s, acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }\n"
                         "    following_error: { window: 5 mm }\n    homing: { kind: set_here }\n"
                         "programs:\n  count: { library: counting.so, autostart: true }\n"
                         "simulation: { supervision: relaxed }\nhmi: { socket: '" +
                         path("cell.sock") + "', lcm: { enabled: false } }\n");
        fs::copy_file(std::string(TAKTWERK_BINARY_DIR) + "/tests/counting_program_" + std::to_string(program) + ".so", path("counting.so"),
                      fs::copy_options::overwrite_existing);
    }
    /// Exit code and output.
    static std::pair<int, std::string> command(std::vector<std::string> words) {
        words.insert(words.begin(), taktwerk);
        Child child(std::move(words));
        const int code = child.wait(patience);
        return {code, child.text()};
    }
    std::pair<int, std::string> bundle(std::vector<std::string> words, bool keys = false) const {
        words.insert(words.begin(), "bundle");
        words.insert(words.end(), {"--root", path("root")});
        if (keys) words.insert(words.end(), {"--trusted-keys", path("no-keys")});
        return command(std::move(words));
    }
    void bring(const std::string& version) const {
        const auto made = command({"bundle", "make", path("cell.yaml"), "--version", version, "-o", path("cell.twb")});
        ASSERT_EQ(made.first, exit_ok) << made.second;
        const auto installed = bundle({"install", path("cell.twb")}, true);
        ASSERT_EQ(installed.first, exit_ok) << installed.second;
        const auto activated = bundle({"activate", "cell", version}, true);
        ASSERT_EQ(activated.first, exit_ok) << activated.second;
    }
    std::vector<std::string> run_words(std::vector<std::string> more) const {
        std::vector<std::string> words{"run", "--bundle", "cell", "--root", path("root")};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::pair<int, std::string> run(std::vector<std::string> more) const { return command(run_words(std::move(more))); }
    /// What is kept of a number that a program counts; -1: nothing.
    std::int64_t kept(const std::string& name) const {
        const auto shown = command({"retain", "show", path("kept"), "--json"});
        const auto json = nlohmann::json::parse(shown.second, nullptr, false);
        if (json.is_discarded()) return -1;
        for (const auto& value : json["values"])
            if (value["name"] == name) return std::stoll(value["value"].get<std::string>());
        return -1;
    }
};

TEST_F(BundleMachine, WhatItKeepsTravelsByNameFromVersionToVersionAndBack) {
    const std::vector<std::string> two_seconds{"--virtual-time", "--duration", "2s", "--retain", path("kept")};
    write_machine("simulated", 1);
    bring("1.0");
    auto ran = run(two_seconds);
    ASSERT_EQ(ran.first, exit_ok) << ran.second;
    EXPECT_THAT(ran.second, HasSubstr("cell 1.0, made at "));
    const auto first = kept("count.pieces");
    ASSERT_GT(first, 100);

    write_machine("simulated", 2);
    bring("2.0");
    ran = run(two_seconds);
    ASSERT_EQ(ran.first, exit_ok) << ran.second;
    const auto second = kept("count.pieces");
    EXPECT_GE(second, 2 * first - 1) << "as many again: it went on where it had been";
    const auto scrap = kept("count.scrap");
    EXPECT_EQ(scrap, second - first) << "the new one began with its first value";

    ASSERT_EQ(bundle({"rollback", "cell"}).first, exit_ok);
    ran = run(two_seconds);
    ASSERT_EQ(ran.first, exit_ok) << ran.second;
    EXPECT_THAT(ran.second, HasSubstr("cell 1.0, made at "));
    EXPECT_GT(kept("count.pieces"), second);
    EXPECT_EQ(kept("count.scrap"), scrap) << "kept aside for the version that has it";
}

// A path that is wrong on the command line, a time that is too short: the version can do nothing for it.
TEST_F(BundleMachine, AStartThatFailsByItsOwnOptionsDoesNotCount) {
    write_machine("simulated", 1);
    bring("1.0");
    ASSERT_EQ(run({"--virtual-time", "--duration", "2s"}).first, exit_ok);
    write_machine("simulated", 2);
    bring("2.0");
    for (const char* option : {"--trace", "--record", "--pcap"}) {
        EXPECT_EQ(run({"--duration", "4s", option, path("no folder/file")}).first, exit_bad_file) << option;
        EXPECT_EQ(run({"--virtual-time", "--duration", "2s", option, path("no folder/file")}).first, exit_bad_file) << option;
    }
    EXPECT_EQ(run({"--duration", "50ms", "--quiet"}).first, exit_bus);
    EXPECT_THAT(bundle({"list"}).second, HasSubstr("active, not started yet"));
}

TEST_F(BundleMachine, AVersionThatDoesNotStartIsLeftAfterThreeStarts) {
    write_machine("simulated", 1);
    bring("1.0");
    ASSERT_EQ(run({"--virtual-time", "--duration", "2s"}).first, exit_ok);
    write_machine("nosuchport0", 1);
    bring("2.0");
    for (int i = 0; i < 3; ++i) {
        const auto failed = run({"--quiet"});
        ASSERT_EQ(failed.first, exit_bus) << failed.second;
    }
    EXPECT_THAT(bundle({"list"}).second, HasSubstr("active, 3 starts failed"));
    const auto back = run({"--duration", "4s"});
    EXPECT_EQ(back.first, exit_ok) << back.second;
    EXPECT_THAT(back.second,
                AllOf(HasSubstr("warning: cell: version 2.0 is left and 1.0 is active again: 3 starts in a row did not reach operation"),
                      HasSubstr("BUNDLE"), HasSubstr("cell 1.0, made at "), HasSubstr("The machine runs from the version before")));
    EXPECT_THAT(text_of_file(path("root/bundles/cell/audit.log")), HasSubstr("\"did\":\"fall back\",\"from\":\"2.0\",\"to\":\"1.0\""));
    EXPECT_THAT(run({"--virtual-time", "--duration", "2s"}).second, Not(HasSubstr("BUNDLE"))) << "said once";
}

TEST_F(BundleMachine, IsNotChangedUnderPower) {
    write_machine("simulated", 1);
    bring("1.0");
    auto words = run_words({"--quiet"});
    words.insert(words.begin(), taktwerk);
    Child machine(words);
    const auto operate = [&](std::vector<std::string> order) {
        order.insert(order.end(), {"-s", path("cell.sock")});
        return command(std::move(order));
    };
    for (int i = 0; i < 300 && operate({"monitor", "--once"}).first != exit_ok; ++i) ::usleep(20'000);
    ASSERT_EQ(operate({"mode", "manual"}).first, exit_ok);
    const auto enabled = operate({"enable", "x", "--wait"});
    ASSERT_EQ(enabled.first, exit_ok) << enabled.second;

    write_machine("simulated", 2);
    ASSERT_EQ(command({"bundle", "make", path("cell.yaml"), "--version", "2.0", "-o", path("cell.twb")}).first, exit_ok);
    ASSERT_EQ(bundle({"install", path("cell.twb")}, true).first, exit_ok) << "installing changes nothing";
    const auto refused = bundle({"activate", "cell", "2.0"}, true);
    EXPECT_EQ(refused.first, exit_refused) << refused.second;
    EXPECT_THAT(refused.second, HasSubstr("it runs, and these axes are enabled: x"));
    EXPECT_EQ(bundle({"rollback", "cell"}).first, exit_refused);
    EXPECT_THAT(bundle({"list"}).second, HasSubstr("active, has worked"));

    ASSERT_EQ(operate({"disable", "x", "--wait"}).first, exit_ok);
    const auto taken = bundle({"activate", "cell", "2.0"}, true);
    EXPECT_EQ(taken.first, exit_ok) << taken.second;
    EXPECT_THAT(taken.second, HasSubstr("The machine runs and goes on with what it has"));
    EXPECT_THAT(bundle({"remove", "cell", "1.0"}).second, HasSubstr("the version to go back to"));
    EXPECT_EQ(operate({"shutdown"}).first, exit_ok);
    EXPECT_EQ(machine.wait(patience), exit_ok) << machine.text();
}

TEST_F(BundleMachine, AStartThatAPersonEndsIsNoFailedStart) {
    write_machine("simulated", 1);
    bring("1.0");
    write_machine("simulated", 2);
    bring("2.0");
    auto words = run_words({});
    words.insert(words.begin(), taktwerk);
    for (int i = 0; i < 4; ++i) {
        Child machine(words);
        ASSERT_TRUE(machine.says("INIT -> PREOP", patience)) << machine.text();
        machine.signal(SIGINT);
        ASSERT_EQ(machine.wait(patience), exit_ok) << machine.text();
        ASSERT_THAT(machine.text(), Not(HasSubstr("operational\n"))) << "it was ended before";
    }
    EXPECT_THAT(bundle({"list"}).second, HasSubstr("active, not started yet"));
}

}  // namespace
}  // namespace taktwerk::apps

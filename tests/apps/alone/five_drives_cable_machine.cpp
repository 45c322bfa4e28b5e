// One of each of the five drives in another process, behind a real network interface and a terminal: `taktwerk sim` plays the slaves on one
// end of a veth pair and the XP200 on a pseudo-terminal, `taktwerk run` drives them from the other. Real time, relaxed: what counts is
// what happens, not when. Needs root; skipped otherwise.

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class FiveDrivesOnACable : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
        if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        write_machine();
    }
    void TearDown() override {
        if (!folder.empty()) std::filesystem::remove_all(folder);
    }

    /// config/machines/five-drives.yaml with this cable, this terminal, 8 ms, and no event by the clock. P4.07 of the SV-DA200 is the
    /// cycle: 5 is 8 ms (2.1 note 2); P4.09 is how long it bears no process data, 10 ms from the factory: no frame could be late. The joints
    /// may lag by several cycles of 180 deg/s.
    void write_machine() {
        std::ifstream in(source / "config/machines/five-drives.yaml");
        std::stringstream all;
        all << in.rdbuf();
        auto text = all.str();
        const auto replace = [&](const std::string& from, const std::string& to) {
            const auto at = text.find(from);
            ASSERT_NE(at, std::string::npos) << from;
            text.replace(at, from.size(), to);
        };
        replace("interface: simulated", "interface: twk0");
        replace("cycle: 1 ms", "cycle: 8 ms");
        replace("/dev/ttyUSB0", line());
        replace("profile: sv-da200\n", "profile: sv-da200\n      stored: [{ object: 2407h, value: 5 }, { object: 2409h, value: 500 }]\n");
        replace("window: 2 deg", "window: 20 deg");
        replace("lcm: { enabled: true,", "socket: '" + socket() + "', lcm: { enabled: false,");
        text.erase(text.find("  events:"));
        std::ofstream(file()) << text;
    }
    [[nodiscard]] std::string file() const { return folder / "machines/five.yaml"; }
    [[nodiscard]] std::string line() const { return folder / "rs485"; }
    [[nodiscard]] std::string socket() const { return folder / "socket"; }

    /// null when the machine gave no answer.
    [[nodiscard]] Json state() const {
        std::string said;
        run({taktwerk, "monitor", "--once", "--json", "-s", socket()}, &said);
        auto out = Json::parse(said, nullptr, false);
        return out.is_object() && out.contains("variables") ? out : Json{};  // an error: this computer stalls, it is asked again
    }
    static double variable(const Json& state, const std::string& name) {
        if (!state.is_null())
            for (const auto& v : state.at("variables"))
                if (v.at("name") == name) return v.at("value").get<double>();
        return 0;
    }
    /// Looks until it holds or `patience` is over. The machine's state at the end is `seen`.
    bool until(const std::function<bool(const Json&)>& condition, std::chrono::seconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        do {
            seen = state();
            go_on_after_an_emergency_stop();
            if (!seen.is_null() && condition(seen)) return true;
        } while (std::chrono::steady_clock::now() < end);
        return false;
    }

    /// Of both programs: an axis that moves alone, the arm, the belt.
    static double failures(const Json& state) {
        return variable(state, "failures") + variable(state, "arm_failures") + variable(state, "belt_failures");
    }
    static double recoveries(const Json& state) {
        return variable(state, "recoveries") + variable(state, "arm_recoveries") + variable(state, "belt_recoveries");
    }

    /// A stall of this computer may silence the terminal for so long that its emergency stop counts as pressed: then a person lets the program go on.
    void go_on_after_an_emergency_stop() const {
        if (seen.is_null()) return;
        for (const auto& alarm : seen.at("alarms"))
            if (alarm.at("name") == "program_waits") {
                run({taktwerk, "reset", "-s", socket()});
                run({taktwerk, "start", "-s", socket()});
            }
    }

    /// While it runs: the machine answers, keeps its program's axes to itself, and nobody speaks to its bus beside it.
    void ask_for_parameters() {
        const auto drive = [&](std::vector<std::string> words, int expected) {
            words.insert(words.begin(), {taktwerk, "drive"});
            std::string said;
            EXPECT_EQ(run(cable.at_master(std::move(words)), &said), expected) << said;
            return said;
        };
        EXPECT_THAT(drive({"get", "da200", "P4.07", "-s", socket()}, exit_ok), HasSubstr("= 5"));
        EXPECT_THAT(drive({"get", "xp200_drive", "Pr097", "-s", socket()}, exit_ok), HasSubstr("= 33"));  // of the machine file
        EXPECT_THAT(drive({"set", "sv33", "P05.13=300", "-s", socket()}, exit_refused), HasSubstr("a program has control"));
        EXPECT_THAT(drive({"get", "sv33_drive", "P05.13", "--machine", file()}, exit_bus),
                    AllOf(HasSubstr("machine 'five-drives'"), HasSubstr("runs on this interface"), HasSubstr("-s " + socket())));
        EXPECT_THAT(drive({"get", "0", "P05.13", "--nic", "twk0", "--profile", "sv33-e"}, exit_bus),
                    HasSubstr("another Taktwerk is the master on it"));
    }

    const Cable cable;
    std::filesystem::path folder;
    Json seen;
};

TEST_F(FiveDrivesOnACable, AllHomeAndMoveFailComeBackAndEndWell) {
    Child slaves(cable.at_slaves({taktwerk, "sim", file(), "--nic", "twk1", "--serial", "rs485=" + line()}));
    ASSERT_TRUE(slaves.says("slaves of 'five-drives'", 30s)) << slaves.text();
    Child master(cable.at_master({taktwerk, "run", file()}));
    ASSERT_TRUE(master.says("running, automatic mode", 60s)) << master.text() << slaves.text();

    // All that move alone have homed and been at both ends of their way, the XP200 over its line, too; the arm has laid down a part from the belt.
    const auto all_work = [&](const Json& s) { return variable(s, "least_strokes") >= 1 && variable(s, "placed") >= 1; };
    ASSERT_TRUE(until(all_work, 60s)) << seen << master.text();
    for (const auto& axis : seen.at("axes")) EXPECT_EQ(axis.at("homed").get<bool>(), axis.at("name") != "belt") << axis.at("name");

    ask_for_parameters();

    // One of each kind fails, and the line is cut: each is seen to fail and comes back, whatever a stall of this computer adds.
    const double failed = failures(seen);
    for (const char* happening : {"drive-fault sv33 0x3130", "drive-fault da200 0x2320", "drive-fault j3 12", "drive-fault stepper 0x3221",
                                  "drive-fault xp200 13"})  // as in the machine file: E.217, Er01-0, 112, under-voltage, E13
        slaves.say(happening);
    ASSERT_TRUE(until([&](const Json& s) { return failures(s) >= failed + 5; }, 60s)) << seen << master.text() << slaves.text();
    const auto all_are_back = [&](const Json& s) { return recoveries(s) == failures(s); };
    ASSERT_TRUE(until(all_are_back, 60s)) << seen << master.text();  // an axis that still stands in its error would not fail anew
    slaves.say("line-cut rs485");
    slaves.say("after 2s line-plugged rs485");
    ASSERT_TRUE(until([&](const Json& s) { return failures(s) >= failed + 6; }, 60s)) << seen << master.text();
    ASSERT_TRUE(until(all_are_back, 60s)) << seen << master.text();
    const double strokes = variable(seen, "least_strokes"), placed = variable(seen, "placed");
    EXPECT_TRUE(until([&](const Json& s) { return variable(s, "least_strokes") > strokes && variable(s, "placed") > placed; }, 60s))
        << seen << master.text();

    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(30s), exit_ok) << master.text();
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

TEST_F(FiveDrivesOnACable, WhatWasRecordedInRealTimeIsReplayedInVirtualTime) {
    Child slaves(cable.at_slaves({taktwerk, "sim", file(), "--nic", "twk1", "--serial", "rs485=" + line()}));
    ASSERT_TRUE(slaves.says("slaves of 'five-drives'", 30s)) << slaves.text();
    const std::string recording = folder / "run.twrec";
    Child master(cable.at_master({taktwerk, "run", file(), "--record", recording}));
    ASSERT_TRUE(master.says("running, automatic mode", 60s)) << master.text() << slaves.text();
    ASSERT_TRUE(until([&](const Json& s) { return variable(s, "least_strokes") >= 1; }, 60s)) << seen << master.text();
    slaves.say("drive-fault sv33 0x3130");
    const double failed = variable(seen, "failures");
    ASSERT_TRUE(until([&](const Json& s) { return variable(s, "failures") > failed; }, 60s)) << seen << master.text();
    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(30s), exit_ok) << master.text();

    // Nobody is at the other end of the cable any more, and nobody is asked.
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
    std::string said;
    EXPECT_EQ(run({taktwerk, "replay", recording, "--quiet"}, &said), exit_ok) << said;
    EXPECT_THAT(said, HasSubstr("identical: "));
}

}  // namespace
}  // namespace taktwerk::apps

// `taktwerk bus` in real time on a cable: slaves of `taktwerk sim` at the other end of a veth pair. Needs root; skipped otherwise.

#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/foreign_master.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(BusCommandOnACable, SeesReadsAndExplainsTheSlavesOfSim) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    const auto bus = [&](std::vector<std::string> words, int expected) {
        words.insert(words.begin(), {taktwerk, "bus"});
        words.insert(words.end(), {"--nic", "twk0"});
        std::string said;
        EXPECT_EQ(run(cable.at_master(std::move(words)), &said), expected) << said;
        return said;
    };

    // Nobody at the other end yet.
    EXPECT_THAT(bus({"scan"}, exit_bus), HasSubstr("no frame came back"));

    Child slaves(cable.at_slaves({taktwerk, "sim", demo, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'demo'", 20s)) << slaves.text();

    const Json scan = Json::parse(bus({"scan", "--json"}, exit_ok));
    ASSERT_EQ(scan["slaves"].size(), 4u);
    EXPECT_EQ(scan["slaves"][0]["vendor"], 0x7FB) << "SV33-E manual; no machine file was given";
    EXPECT_THAT(bus({"sdo", "read", "0", "1018h:01"}, exit_ok), HasSubstr("000007FBh"));
    const Json state = Json::parse(bus({"state", "--json"}, exit_ok));
    EXPECT_EQ(state["slaves"][0]["state"], "PREOP") << "where reading an object has taken it";
    EXPECT_EQ(state["slaves"][1]["state"], "INIT");
    EXPECT_THAT(bus({"counters"}, exit_ok), HasSubstr("No port has counted an error"));
    EXPECT_THAT(bus({"why"}, exit_usage), HasSubstr("--yes")) << "outputs are driven in OP: nobody was there to answer";

    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

// Beside a master that works with these slaves: it is named, and nothing of what it has set is touched.
TEST(BusCommandOnACable, BesideAnotherMasterNamesItAndDisturbsNothing) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    Child slaves(cable.at_slaves({taktwerk, "sim", demo, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'demo'", 20s)) << slaves.text();
    const ForeignMaster other(cable.master_end(), "twk0");
    for (int i = 0; i < 1000 && other.answered() < 50; ++i) std::this_thread::sleep_for(10ms);
    ASSERT_GE(other.answered(), 50) << "the other master does not reach its slave";

    for (const char* doing : {"why", "scan"}) {
        std::string said;
        std::vector<std::string> words{taktwerk, "bus", doing, "--nic", "twk0"};
        if (std::string(doing) == "why") words.push_back("--yes");
        (void)run(cable.at_master(std::move(words)), &said);
        EXPECT_THAT(said, HasSubstr("another master is sending on this cable")) << doing;
        EXPECT_THAT(said, HasSubstr("02:46:4f:52:00:42")) << doing;
        EXPECT_THAT(said, ::testing::Not(HasSubstr("nobody is heard"))) << doing;
        EXPECT_THAT(said, ::testing::Not(HasSubstr("power-cycle"))) << doing;
        EXPECT_EQ(other.disturbed(), 0) << doing << ": its slave lost its address, or stopped answering";
    }
    // --force writes beside it, but brings nothing up.
    for (const std::vector<std::string>& doing : {std::vector<std::string>{"why"}, {"state", "op"}}) {
        std::vector<std::string> words{taktwerk, "bus"};
        words.insert(words.end(), doing.begin(), doing.end());
        words.insert(words.end(), {"--nic", "twk0", "--yes", "--force"});
        std::string said;
        EXPECT_EQ(run(cable.at_master(std::move(words)), &said), exit_bus) << said;
        EXPECT_THAT(said, HasSubstr("two masters never bring up one bus")) << doing.back();
        EXPECT_THAT(said, ::testing::Not(HasSubstr("all the same"))) << doing.back();
        EXPECT_EQ(other.disturbed(), 0) << doing.back();
    }
    std::string said;
    const auto folder = std::filesystem::temp_directory_path() / ("taktwerk-beside-" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    std::filesystem::copy_file(source / "config/machines/demo-cell.svg", folder / "demo-cell.svg");
    const auto file = (folder / "beside.yaml").string();
    std::ifstream in(demo);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    text = std::regex_replace(text, std::regex("interface: simulated"), "interface: twk0");
    text =
        std::regex_replace(text, std::regex("library: pick_and_place.so"), "library: " TAKTWERK_BINARY_DIR "/programs/pick_and_place.so");
    std::ofstream(file) << text << "\n";
    EXPECT_EQ(run(cable.at_master({taktwerk, "run", file}), &said), exit_bus) << said;
    EXPECT_THAT(said, HasSubstr("another EtherCAT master is sending on this cable"));
    EXPECT_THAT(said, HasSubstr("02:46:4f:52:00:42"));
    std::filesystem::remove_all(folder);

    EXPECT_EQ(other.disturbed(), 0) << "its slave lost its address, or stopped answering";
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

// Long buses on a real cable: two processes, each frame through a veth pair.
TEST(BusCommandOnACable, ManySlavesReachOp) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    for (const int count : {30, 33, 64, 100, 200, 300}) {
        const Cable cable;
        if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        const auto file =
            (std::filesystem::temp_directory_path() / fmt::format("taktwerk-long-bus-{}-{}.yaml", ::getpid(), count)).string();
        std::string slaves_of_file;
        for (int i = 0; i < count; ++i)
            slaves_of_file += fmt::format("    - {{ name: t{}, terminal: {{ inputs: 32, outputs: 32 }} }}\n", i);
        std::ofstream(file) << "version: 1\nname: long\ncycle: " << (count > 200 ? 10 : 4) << " ms\nbus:\n  interface: twk0\n  slaves:\n"
                            << slaves_of_file << "simulation: { supervision: relaxed }\nhmi: { socket: '" << file << ".socket' }\n";
        Child slaves(cable.at_slaves({taktwerk, "sim", file, "--nic", "twk1"}));
        ASSERT_TRUE(slaves.says("slaves of 'long'", 20s)) << slaves.text();
        std::string said;
        Child master(cable.at_master({taktwerk, "run", file}));
        EXPECT_TRUE(master.says("running, manual mode", 120s)) << count << " slaves: " << master.text();
        master.signal(SIGTERM);
        (void)master.wait(30s);
        slaves.signal(SIGTERM);
        (void)slaves.wait(10s);
        std::filesystem::remove(file);
    }
}

}  // namespace
}  // namespace taktwerk::apps

// `taktwerk bus` in real time on a cable: slaves of `taktwerk sim` at the other end of a veth pair. Needs root; skipped otherwise.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/exit_code.hpp"
#include "tests/apps/cable.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string command = std::string(TAKTWERK_BINARY_DIR) + "/taktwerk";
const std::string demo = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/demo.yaml";

TEST(BusCommandOnACable, SeesReadsAndExplainsTheSlavesOfSim) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    const auto bus = [&](std::vector<std::string> words, int expected) {
        words.insert(words.begin(), {command, "bus"});
        words.insert(words.end(), {"--nic", "twk0"});
        std::string said;
        EXPECT_EQ(run(cable.at_master(std::move(words)), &said), expected) << said;
        return said;
    };

    // Nobody at the other end yet.
    EXPECT_THAT(bus({"scan"}, exit_bus), HasSubstr("no frame came back"));

    Child slaves(cable.at_slaves({command, "sim", demo, "--nic", "twk1"}));
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

}  // namespace
}  // namespace taktwerk::apps

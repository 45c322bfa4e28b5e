// The bus as people see it over the socket, of a machine on real frames in virtual time: who stands where, whose cable is bad, who is gone. Looking
// at it disturbs nobody.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using runtime::testing::TestMachine;
using testing::HasSubstr;

struct BusTree : testing::Test {
    BusTree() {
        requests.on_open(1, {100, 1000, 1000});
        requests.on_open(2, {101, 1000, 1000});
    }
    void SetUp() override {
        ASSERT_TRUE(m.up());
        m.run(300ms);
    }
    void step() {
        m.run(1ms);
        requests.observe(m.machine->latest());
        requests.step(m.clock.now());
    }
    json ask(ConnectionId who = 1, Duration patience = 2s) {
        requests.on_line(who, R"({"id":1,"cmd":"bus"})", m.clock.now());
        for (Duration waited{}; waited < patience; waited += 1ms) {
            while (auto line = requests.next_line()) {
                if (line->connection != who) continue;
                const auto answer = json::parse(line->text);
                EXPECT_EQ(answer["ok"], true) << line->text;
                return answer["bus"];
            }
            step();
        }
        ADD_FAILURE() << "no answer";
        return json::object();
    }
    TestMachine m{runtime::testing::machine_config(2)};  // x_drive, y_drive, io in one line
    RuntimeLink link{*m.machine};
    Gateway gateway{link};
    JsonRequests requests{gateway, link, [] { return std::int64_t{0}; }};
};

TEST_F(BusTree, ALineIsATreeWithPortsAndTheMasterInFront) {
    const auto bus = ask();
    EXPECT_EQ(bus["phase"], "operational");
    EXPECT_EQ(bus["tree_known"], true);
    const auto& slaves = bus["slaves"];
    ASSERT_EQ(slaves.size(), 3u);
    const char* names[] = {"x_drive", "y_drive", "io"};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(slaves[i]["name"], names[i]);
        EXPECT_EQ(slaves[i]["position"], i);
        EXPECT_EQ(slaves[i]["index"], i);
        EXPECT_EQ(slaves[i]["configured"], true);
        EXPECT_EQ(slaves[i]["state"], "OP");
        EXPECT_EQ(slaves[i]["al_status_code"], 0);
        EXPECT_EQ(slaves[i]["fresh"], true);
        EXPECT_EQ(slaves[i]["age"], 0);
        EXPECT_EQ(slaves[i]["unread"], "");
        EXPECT_EQ(slaves[i]["depth"], i);
        ASSERT_EQ(slaves[i]["ports"].size(), 4u);
        for (const auto& port : slaves[i]["ports"]) EXPECT_EQ(port["rx_errors"].get<int>() + port["lost_links"].get<int>(), 0);
    }
    EXPECT_TRUE(slaves[0]["parent"].is_null());
    EXPECT_EQ(slaves[0]["ports"][0]["at_other_end"], "the master");
    EXPECT_EQ(slaves[1]["parent"], 0);
    EXPECT_EQ(slaves[1]["parent_port"], 1);
    EXPECT_EQ(slaves[1]["entry_port"], 0);
    EXPECT_EQ(slaves[0]["ports"][1]["child"], 1);
    EXPECT_EQ(slaves[0]["ports"][1]["link"], true);
    EXPECT_EQ(slaves[0]["ports"][1]["open"], true);
    EXPECT_EQ(slaves[2]["ports"][1]["open"], false) << "the end of the line";
    EXPECT_EQ(slaves[0]["reference_clock"], true) << "the first with a clock";
    EXPECT_EQ(slaves[1]["reference_clock"], false);
    EXPECT_EQ(slaves[0]["dc"], true);
    EXPECT_EQ(bus["statistics"]["frames_lost"], 0);
    EXPECT_EQ(bus["trouble"], json::array());
    EXPECT_EQ(bus["findings"], json::array());
}

TEST_F(BusTree, CountersNameTheBadCable) {
    for (int i = 0; i < 4; ++i) {
        m.world.network().disturb(m.world.network().slave(1), 1);
        m.run(300ms);
    }
    const auto bus = ask();
    const auto& port = bus["slaves"][1]["ports"][0];
    EXPECT_GE(port["rx_errors"].get<int>() + port["invalid_frames"].get<int>(), 4) << port;
    ASSERT_GE(bus["findings"].size(), 1u);
    EXPECT_EQ(bus["findings"][0]["position"], 1);
    EXPECT_EQ(bus["findings"][0]["port"], 0);
    EXPECT_THAT(bus["findings"][0]["text"].get<std::string>(), HasSubstr("the cable between slave 1 'y_drive' and slave 0 'x_drive'"));
}

TEST_F(BusTree, WhoIsGoneStandsLastWithTheAlarmOfIt) {
    m.world.set_slave_power("io", false);
    m.run(3s);
    const auto bus = ask();
    ASSERT_EQ(bus["slaves"].size(), 3u);
    EXPECT_EQ(bus["slaves"][2]["name"], "io");
    EXPECT_TRUE(bus["slaves"][2]["position"].is_null());
    EXPECT_EQ(bus["slaves"][2]["fresh"], false);
    ASSERT_GE(bus["trouble"].size(), 1u);
    EXPECT_FALSE(bus["trouble"][0]["english"].get<std::string>().empty());
    EXPECT_FALSE(bus["trouble"][0]["chinese"].get<std::string>().empty());
    EXPECT_FALSE(bus["trouble"][0]["remedy"].get<std::string>().empty());
    m.world.set_slave_power("io", true);
    ASSERT_TRUE(m.until([&] { return m.state().slaves[2].fresh; }, 10s));
    m.run(2s);
    const auto again = ask();
    EXPECT_EQ(again["slaves"][2]["position"], 2);
    EXPECT_EQ(again["slaves"][2]["state"], "OP");
}

// However many look, the bus is asked once a second, and no frame is lost or late by it.
TEST_F(BusTree, ManyWhoLookDisturbNobody) {
    const auto before = m.state().bus;
    for (int second = 0; second < 5; ++second)
        for (int i = 0; i < 20; ++i) (void)ask(1 + i % 2);
    const auto after = m.state().bus;
    EXPECT_EQ(after.frames_lost, before.frames_lost);
    EXPECT_EQ(after.working_counter_errors, before.working_counter_errors);
    for (const auto& slave : m.state().slaves) EXPECT_EQ(slave.al_state, ecat::AlState::op);
}

// A client that goes before its answer, and a bus that stops meanwhile, leave nothing behind.
TEST_F(BusTree, NobodyWaitsForABusThatStops) {
    requests.on_line(1, R"({"id":1,"cmd":"bus"})", m.clock.now());
    requests.on_line(2, R"({"id":2,"cmd":"bus"})", m.clock.now());
    requests.on_close(1);
    m.machine->stop_bus();
    for (int i = 0; i < 200; ++i) step();
    const auto line = requests.next_line();
    ASSERT_TRUE(line);
    EXPECT_EQ(line->connection, 2u);
    EXPECT_FALSE(requests.next_line()) << "one answer, and none to who is gone";
}

}  // namespace
}  // namespace taktwerk::hmi

// Histograms, lists of drives' parameters and the log over the socket, from a machine played by hand.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/json_requests.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

class Questions : public testing::Test {
protected:
    Questions() {
        machine.its_times = {&cycle, &tasks, &lateness};
        gateway.observe(true);
        requests.observe(&machine.snapshot);
        requests.on_open(1, {100, 1000, 1000});
    }
    json ask(std::string_view line) {
        requests.on_line(1, line, now);
        requests.step(now);
        const auto answer = requests.next_line();
        EXPECT_TRUE(answer.has_value()) << line;
        EXPECT_FALSE(requests.next_line().has_value()) << "one answer a line";
        return answer ? json::parse(answer->text) : json::object();
    }
    runtime::CycleHistograms cycle;
    std::vector<SharedHistogram> tasks = std::vector<SharedHistogram>(1), lateness = std::vector<SharedHistogram>(1);
    test::FakeMachine machine;
    Gateway gateway{machine};
    JsonRequests requests{gateway, machine, [] { return std::int64_t{0}; }};
    Instant now{10s};
};

TEST_F(Questions, HistogramsTellHowOftenAndWhenItTookLongest) {
    cycle.compute.record(20ns, 1);
    cycle.compute.record(100us, 2);
    cycle.compute.record(20ns, 3);
    tasks[0].record(5us, 7);
    lateness[0].record(30us, 6);

    const auto answer = ask(R"({"id":4,"cmd":"histograms"})");

    EXPECT_EQ(answer["id"], 4);
    const auto& h = answer["histograms"];
    EXPECT_EQ(h["compute"]["count"], 3);
    EXPECT_EQ(h["compute"]["longest_ns"], 100'000);
    EXPECT_EQ(h["compute"]["longest_cycle"], 2);
    ASSERT_EQ(h["compute"]["bins"].size(), 2u);
    EXPECT_EQ(h["compute"]["bins"][0], (json::array({20, 20, 2}))) << "exact below 32 ns";
    EXPECT_LE(h["compute"]["bins"][1][0], 100'000);
    EXPECT_GE(h["compute"]["bins"][1][1], 100'000);
    EXPECT_EQ(h["lateness"]["count"], 0);
    EXPECT_EQ(h["lateness"]["longest_cycle"], 0);
    EXPECT_EQ(h["steps"].size(), runtime::step_count - 1);
    EXPECT_EQ(h["steps"][0]["name"], "receive");
    EXPECT_EQ(h["tasks"][0]["name"], "cell.main");
    EXPECT_EQ(h["tasks"][0]["longest_cycle"], 7);
    EXPECT_EQ(h["task_lateness"][0]["name"], "cell.main");
    EXPECT_EQ(h["task_lateness"][0]["longest_ns"], 30'000);
}

TEST_F(Questions, ParametersOfADriveTellWhatIsStatedAssumedAndUnknown) {
    axes::DriveProfile profile;
    profile.name = "sv33-e";
    profile.vendor = "Sinsegye";
    const auto parameter = [](axes::ParameterAddress address, const char* id, const char* name, std::int64_t value) {
        axes::DriveParameter out;
        out.address = address;
        out.parameter = id;
        out.name = name;
        out.value = value;
        return out;
    };
    auto gain = parameter({0x2005, 0x0B}, "P05.10", "store", 25);
    gain.chinese = "存储";
    gain.factory = axes::FactoryValue::stated;
    gain.minimum = 0;
    gain.maximum = 1000;
    gain.unit = "%";
    gain.scale = 0.5;
    gain.change = axes::ParameterChange::disabled;
    gain.effect = axes::ParameterEffect::after_restart;
    gain.section = "7.3";
    auto guessed = parameter({0x2006, 1}, "P06.00", "guessed", 3);
    guessed.factory = axes::FactoryValue::assumed;
    auto open = parameter({0x6041, 0}, "", "status", 0);
    open.change = axes::ParameterChange::never;
    profile.parameters = {gain, guessed, open};
    machine.drives = {{nullptr, &profile}};

    const auto answer = ask(R"({"id":1,"cmd":"drive_parameters","axis":"x"})");

    const auto& list = answer["drive_parameters"]["parameters"];
    EXPECT_EQ(answer["drive_parameters"]["profile"], "sv33-e");
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ(list[0]["id"], "P05.10");
    EXPECT_EQ(list[0]["object"], "2005h:0B");
    EXPECT_EQ(list[0]["english"], "store");
    EXPECT_EQ(list[0]["chinese"], "存储");
    EXPECT_EQ(list[0]["factory"], 12.5) << "in its unit";
    EXPECT_EQ(list[0]["factory_is"], "stated");
    EXPECT_EQ(list[0]["minimum"], 0);
    EXPECT_EQ(list[0]["maximum"], 500);
    EXPECT_EQ(list[0]["unit"], "%");
    EXPECT_EQ(list[0]["writable"], true);
    EXPECT_EQ(list[0]["change"], "disabled");
    EXPECT_EQ(list[0]["effective"], "after_restart");
    EXPECT_EQ(list[0]["manual"], "7.3");
    EXPECT_EQ(list[1]["factory_is"], "assumed");
    EXPECT_EQ(list[1]["factory"], 3);
    EXPECT_EQ(list[2]["factory_is"], "unknown");
    EXPECT_TRUE(list[2]["factory"].is_null());
    EXPECT_TRUE(list[2]["minimum"].is_null());
    EXPECT_EQ(list[2]["writable"], false);

    EXPECT_EQ(ask(R"({"id":2,"cmd":"drive_parameters","axis":"turret"})")["error"]["code"], "drive.none");
    EXPECT_EQ(ask(R"({"id":3,"cmd":"drive_parameters","axis":"q"})")["error"]["code"], "command.unknown_name");
    EXPECT_EQ(ask(R"({"id":4,"cmd":"drive_parameters"})")["error"]["code"], "request.missing_key");
}

TEST_F(Questions, TheLogGoesOnWhereAClientLeftOff) {
    const auto tail = std::make_shared<LogTail>();
    requests.set_log(tail);
    EXPECT_EQ(ask(R"({"cmd":"log"})")["log"], (json{{"last", 0}, {"lines", json::array()}}));
    tail->add("first\nsecond\n");
    tail->add("third");
    auto log = ask(R"({"cmd":"log"})")["log"];
    ASSERT_EQ(log["lines"].size(), 3u);
    EXPECT_EQ(log["lines"][2], (json{{"number", 3}, {"text", "third"}}));
    log = ask(R"({"cmd":"log","after":2})")["log"];
    ASSERT_EQ(log["lines"].size(), 1u);
    EXPECT_EQ(log["lines"][0]["number"], 3);
    EXPECT_EQ(ask(R"({"cmd":"log","after":3})")["log"]["lines"].size(), 0u);
    EXPECT_EQ(ask(R"({"cmd":"log","limit":2})")["log"]["lines"][0]["number"], 2) << "the newest ones";
    EXPECT_EQ(ask(R"({"cmd":"log","after":-1})")["error"]["code"], "request.wrong_type");

    for (int i = 0; i < 3000; ++i) tail->add(std::string(3000, 'x'));
    log = ask(R"({"cmd":"log","after":0})")["log"];
    EXPECT_EQ(log["lines"].size(), MachineQuestions::most_log_lines);
    EXPECT_EQ(log["last"], 3003);
    EXPECT_EQ(log["lines"].back()["number"], 3003);
    EXPECT_EQ(log["lines"].back()["text"].get<std::string>().size(), LogTail::longest);
    EXPECT_EQ(tail->after(0, 100'000).size(), LogTail::most_lines) << "bounded";
}

TEST_F(Questions, AMachineWithoutABusSaysSo) {
    EXPECT_EQ(ask(R"({"id":1,"cmd":"bus"})")["error"]["code"], "state.not_yet");
    EXPECT_EQ(ask(R"({"id":2,"cmd":"bus","deep":1})")["error"]["code"], "request.unknown_key");
}

}  // namespace
}  // namespace taktwerk::hmi

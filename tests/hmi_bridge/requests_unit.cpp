// The socket's language: what is asked, what comes back, and what broken lines get.
#include "hmi_bridge/socket/json_number.hpp"
#include "hmi_bridge/socket/json_requests.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using runtime::Answer;
using runtime::OperatorAction;
using test::FakeMachine;
using testing::HasSubstr;

constexpr std::int64_t sent_at = 1'800'000'000'000'000;  // us since 1970

class RequestsTest : public testing::Test {
protected:
    RequestsTest() {
        gateway.observe(true);
        requests.observe(&machine.snapshot);
        requests.on_open(1, {100, 1000, 1000});
    }
    /// The line's one answer; the machine accepts what reaches it.
    json ask(std::string_view line) {
        const auto before = machine.submitted.size();
        requests.on_line(1, line, now);
        if (machine.submitted.size() > before) machine.answer(Answer::accepted);
        gateway.step(now);
        while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
        const auto answer = requests.next_line();
        EXPECT_TRUE(answer.has_value()) << line;
        EXPECT_FALSE(requests.next_line().has_value()) << "one answer a line";
        if (!answer) return json::object();
        EXPECT_EQ(answer->text.find('\n'), std::string::npos);
        auto parsed = json::parse(answer->text, nullptr, false);
        EXPECT_TRUE(parsed.is_object()) << answer->text;
        return parsed;
    }
    std::string code_for(std::string_view line) {
        const auto answer = ask(line);
        EXPECT_EQ(answer["ok"], false) << line;
        EXPECT_FALSE(answer["error"]["what"].get<std::string>().empty());
        EXPECT_FALSE(answer["error"]["remedy"].get<std::string>().empty());
        return answer["error"]["code"];
    }

    FakeMachine machine;
    Gateway gateway{machine};
    JsonRequests requests{gateway, machine, [] { return sent_at; }};
    Instant now{10s};
};

TEST_F(RequestsTest, ACommandIsCarriedOutAndAnsweredWithItsId) {
    const auto answer = ask(R"({"id":7,"cmd":"jog","axis":"x","velocity":-20,"press":true})");

    EXPECT_EQ(answer, (json{{"id", 7}, {"ok", true}}));
    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].action, OperatorAction::jog);
    EXPECT_EQ(machine.submitted[0].value, -20);
    EXPECT_TRUE(machine.submitted[0].flag);
}

TEST_F(RequestsTest, AForceNamesAnInputOrAnOutputAndWithoutAValueReleasesIt) {
    EXPECT_EQ(ask(R"({"id":1,"cmd":"force","input":"start_button","value":1})")["ok"], true);
    EXPECT_EQ(ask(R"({"id":2,"cmd":"force","output":"lamp_run","value":0})")["ok"], true);
    EXPECT_EQ(ask(R"({"id":3,"cmd":"force","output":"lamp_run"})")["ok"], true);
    ASSERT_EQ(machine.submitted.size(), 3u);
    EXPECT_EQ(machine.submitted[0].action, OperatorAction::force);
    EXPECT_FALSE(machine.submitted[0].flag) << "an input";
    EXPECT_EQ(machine.submitted[0].value, 1);
    EXPECT_EQ(machine.submitted[1].action, OperatorAction::force);
    EXPECT_TRUE(machine.submitted[1].flag) << "an output";
    EXPECT_EQ(machine.submitted[2].action, OperatorAction::unforce);
    EXPECT_TRUE(machine.submitted[2].flag);

    EXPECT_EQ(code_for(R"({"id":4,"cmd":"force","input":"start_button","output":"lamp_run","value":1})"), "request.unknown_key");
    EXPECT_EQ(code_for(R"({"id":5,"cmd":"force","value":1})"), "request.missing_key");
    EXPECT_EQ(code_for(R"({"id":6,"cmd":"force","input":"lamp_run","value":1})"), "command.unknown_name");
    EXPECT_EQ(code_for(R"({"id":7,"cmd":"force","input":"start_button","value":0.5})"), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":8,"cmd":"unforce","input":"start_button","value":0})"), "request.unknown_key");
    machine.its_layout.kept_inputs = {"", "the emergency stop reads it"};
    const auto kept = ask(R"({"id":9,"cmd":"force","input":"estop_ok","value":1})");
    EXPECT_EQ(kept["error"]["code"], "command.not_possible_now");
    EXPECT_THAT(kept["error"]["what"].get<std::string>(), HasSubstr("the emergency stop reads it"));
    EXPECT_EQ(machine.submitted.size(), 3u);
}

TEST_F(RequestsTest, AForceIsShownWithWhoForcedIt) {
    ask(R"({"id":1,"cmd":"force","output":"lamp_run","value":1})");
    machine.snapshot.forces[0] = {runtime::IoDirection::output, 0, machine.submitted[0].client, 1};
    machine.snapshot.force_count = 1;
    const auto forced = ask(R"({"cmd":"state"})")["state"]["forced"];
    ASSERT_EQ(forced.size(), 1u);
    EXPECT_EQ(forced[0]["point"], "lamp_run");
    EXPECT_EQ(forced[0]["direction"], "output");
    EXPECT_EQ(forced[0]["value"], 1);
    EXPECT_THAT(forced[0]["by"].get<std::string>(), HasSubstr("process 100"));
}

TEST_F(RequestsTest, AnOverrideIsAPartOfTheVelocity) {
    EXPECT_EQ(ask(R"({"id":1,"cmd":"override","axis":"x","value":0.25})")["ok"], true);
    EXPECT_EQ(machine.submitted.back().axis, 0);
    EXPECT_EQ(machine.submitted.back().value, 0.25);
    EXPECT_EQ(ask(R"({"id":2,"cmd":"override","axis":"all","value":0})")["ok"], true);
    EXPECT_EQ(machine.submitted.back().axis, 0xFFFF);
    for (const char* bad : {"1.5", "-0.1"})
        EXPECT_EQ(code_for(std::string(R"({"id":)") + (bad[0] == '1' ? "3" : "4") + R"(,"cmd":"override","axis":"x","value":)" + bad + "}"),
                  "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":5,"cmd":"override","value":1})"), "request.missing_key");
}

// Levels, as a stop of an axis: no age, no sequence and no queue holds them up.
TEST_F(RequestsTest, AGroupIsHaltedWhateverIsAroundIt) {
    machine.inbox_size = 0;
    EXPECT_EQ(ask(R"({"id":7,"cmd":"group_halt","group":"table","utime":0})")["ok"], true);
    EXPECT_EQ(ask(R"({"id":7,"cmd":"group_halt","group":"table"})")["ok"], true);
    EXPECT_EQ(machine.stops, (std::vector<std::uint16_t>{1, 0, 1, 0}));
    EXPECT_EQ(code_for(R"({"id":8,"cmd":"group_halt","group":"tabel"})"), "command.unknown_name");
    EXPECT_EQ(code_for(R"({"id":9,"cmd":"group_halt"})"), "request.missing_key");
}

TEST_F(RequestsTest, AnOverrideOfAGroupIsAPartOfTheVelocity) {
    EXPECT_EQ(ask(R"({"id":1,"cmd":"group_override","group":"table","value":0.25})")["ok"], true);
    EXPECT_EQ(machine.submitted.back().index, 0);
    EXPECT_EQ(machine.submitted.back().value, 0.25);
    for (const char* bad : {R"({"id":2,"cmd":"group_override","group":"table","value":1.5})",
                            R"({"id":3,"cmd":"group_override","group":"table","value":-0.1})"})
        EXPECT_EQ(code_for(bad), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":4,"cmd":"group_override","group":"x","value":1})"), "command.unknown_name") << "an axis is no group";
    EXPECT_EQ(code_for(R"({"id":5,"cmd":"group_continue","group":"table","utime":0})"), "command.stale");
}

TEST_F(RequestsTest, HelloSaysWhatRunsAndForHowLong) {
    requests.set_about({"0.1.0", {{"fmt", "9.1.0", "MIT"}}});
    requests.step(now);
    now += 90s;
    const auto hello = ask(R"({"cmd":"hello"})")["hello"];
    EXPECT_EQ(hello["version"], "0.1.0");
    EXPECT_EQ(hello["uptime_s"], 90);
    EXPECT_EQ(hello["libraries"], (json::array({{{"name", "fmt"}, {"version", "9.1.0"}, {"licence", "MIT"}}})));
}

TEST_F(RequestsTest, EveryCommandOfTheTableHasALine) {
    const std::vector<std::string> lines{R"("cmd":"take_control","axis":"x")",
                                         R"("cmd":"release_control","axis":"all")",
                                         R"("cmd":"mode","mode":"automatic")",
                                         R"("cmd":"enable","axis":"x")",
                                         R"("cmd":"disable","axis":"all")",
                                         R"("cmd":"home","axis":"x")",
                                         R"("cmd":"jog","axis":"x","velocity":1,"press":true)",
                                         R"("cmd":"move","axis":"x","position":1,"velocity":2)",
                                         R"("cmd":"stop")",
                                         R"("cmd":"reset","axis":"y")",
                                         R"("cmd":"program_start","program":"cell")",
                                         R"("cmd":"program_stop","program":"cell")",
                                         R"("cmd":"program_reset","program":"cell")",
                                         R"("cmd":"set_parameter","parameter":"speed","value":100)",
                                         R"("cmd":"set_output","output":"lamp_run","value":true)",
                                         R"("cmd":"acknowledge")",
                                         R"("cmd":"shutdown")",
                                         R"("cmd":"force","input":"start_button","value":1)",
                                         R"("cmd":"unforce","output":"lamp_run")",
                                         R"("cmd":"release_forces")",
                                         R"("cmd":"override","axis":"all","value":0.5)",
                                         R"("cmd":"reset_peaks","axis":"x")",
                                         R"("cmd":"reset_statistics")",
                                         R"("cmd":"measure","axis":"x","press":true,"kind":"step")",
                                         R"("cmd":"set_value","variable":"cell.start","value":1,"press":true)",
                                         R"("cmd":"group_halt","group":"table")",
                                         R"("cmd":"group_interrupt","group":"table")",
                                         R"("cmd":"group_continue","group":"table")",
                                         R"("cmd":"group_override","group":"table","value":0.5)",
                                         R"("cmd":"group_reset","group":"table")",
                                         R"("cmd":"group_enable","group":"table")",
                                         R"("cmd":"group_disable","group":"table")",
                                         R"("cmd":"group_jog","group":"table","direction":"x+","velocity":0.5,"press":true)"};
    ASSERT_EQ(lines.size(), command_words.size());
    auto& limits = machine.its_config.limits;  // of an axis that can be measured
    limits.velocity = 200, limits.acceleration = limits.deceleration = 5000, limits.jerk = 100000;
    machine.snapshot.axes[0].manual_slow = 20, machine.snapshot.axes[0].manual_fast = 50;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto answer = ask("{\"id\":" + std::to_string(i + 1) + "," + lines[i] + "}");
        EXPECT_EQ(answer["ok"], true) << lines[i] << answer;
        if (command_words[i].kind == CommandKind::shutdown) EXPECT_TRUE(machine.shutdown_requested);
        else if (command_words[i].kind == CommandKind::stop) EXPECT_EQ(machine.stops.size(), 1u);
        else if (command_words[i].kind == CommandKind::group_halt)
            EXPECT_EQ(machine.stops, (std::vector<std::uint16_t>{0xFFFF, 1, 0})) << "a level for each of its axes, the first one last";
        else EXPECT_EQ(machine.submitted.back().action, command_words[i].action) << lines[i];
    }
}

TEST_F(RequestsTest, BrokenLinesGetOneClearErrorEach) {
    EXPECT_EQ(code_for("{"), "request.not_json");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"sta)"), "request.not_json");
    EXPECT_EQ(code_for("\x00\xff\xfe\x80 binary"), "request.not_json");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"jog","axis":"x","velocity":1e999,"press":true})"), "request.not_json") << "no such number";
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"jog","axis":"x","velocity":NaN,"press":true})"), "request.not_json");
    EXPECT_EQ(code_for("[1,2]"), "request.not_an_object");
    EXPECT_EQ(code_for("17"), "request.not_an_object");
    EXPECT_EQ(code_for(R"({"id":1})"), "request.missing_key");
    EXPECT_EQ(code_for(R"({"id":"one","cmd":"state"})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"id":18446744073709551615,"cmd":"home","axis":"x"})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":5})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"cmd":"home","axis":"x"})"), "request.missing_key") << "a command needs a sequence";
    EXPECT_EQ(code_for(R"({"id":0,"cmd":"home","axis":"x"})"), "request.missing_key");
    EXPECT_EQ(code_for(R"({"id":-3,"cmd":"home","axis":"x"})"), "request.missing_key");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home"})"), "request.missing_key");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home","axis":["x"]})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"jog","axis":"x","velocity":"20"})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"jog","axis":"x","velocity":20,"press":1})"), "request.wrong_type");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"mode","mode":"turbo"})"), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home","axis":"x","valid_ms":-5})"), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":2,"cmd":"home","axis":"x","valid_ms":9223372036854775807})"), "command.bad_value");
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(RequestsTest, ZeroIsANumberAndNotNothing) {
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home","axis":"x","valid_ms":0})"), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":2,"cmd":"home","axis":"x","utime":0})"), "command.stale") << "1970";
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(RequestsTest, AKeyThatStandsTwiceIsRefused) {
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home","axis":"x","axis":"y"})"), "request.duplicate_key");
    EXPECT_EQ(code_for(R"({"id":2,"cmd":"state","cmd":"home","axis":"x"})"), "request.duplicate_key");
    EXPECT_EQ(code_for(R"({"id":3,"id":4,"cmd":"home","axis":"x"})"), "request.duplicate_key");
    std::string many = R"({"id":5,"cmd":"home","axis":"x")";
    for (int i = 0; i < 100; ++i) many += ",\"k" + std::to_string(i) + "\":1";
    EXPECT_EQ(code_for(many + "}"), "request.unknown_key");
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(RequestsTest, AResetWithAnEmptyNameResetsNothing) {
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"reset","axis":""})"), "command.unknown_name");
    EXPECT_TRUE(machine.submitted.empty());
    EXPECT_EQ(ask(R"({"id":2,"cmd":"reset"})")["ok"], true);
    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].axis, 0xFFFF);
}

TEST_F(RequestsTest, AParameterThatCountsTakesWholeNumbersOnly) {
    machine.its_layout.parameters[0].whole = true;
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"set_parameter","parameter":"speed","value":20.5})"), "command.bad_value");
    EXPECT_TRUE(machine.submitted.empty());
    EXPECT_EQ(ask(R"({"id":2,"cmd":"set_parameter","parameter":"speed","value":20})")["ok"], true);
}

TEST_F(RequestsTest, DeepNestingIsRefusedWithoutRecursion) {
    EXPECT_EQ(code_for(R"({"id":1,"cmd":)" + std::string(60'000, '[')), "request.too_deep");
    EXPECT_EQ(code_for(std::string(60'000, '{')), "request.not_json");
    EXPECT_EQ(code_for(R"({"id":1,"cmd":)" + std::string(20'000, '[') + std::string(20'000, ']') + "}"), "request.too_deep");
}

TEST_F(RequestsTest, UnknownCommandsAndKeysComeWithASuggestion) {
    const auto command = ask(R"({"id":1,"cmd":"hoem","axis":"x"})");
    EXPECT_EQ(command["error"]["code"], "request.unknown_command");
    EXPECT_THAT(command["error"]["remedy"].get<std::string>(), HasSubstr("home"));

    const auto key = ask(R"({"id":2,"cmd":"jog","axis":"x","velocity":20,"pres":true})");
    EXPECT_EQ(key["error"]["code"], "request.unknown_key");
    EXPECT_THAT(key["error"]["remedy"].get<std::string>(), HasSubstr("press"));
    EXPECT_TRUE(machine.submitted.empty());

    const auto axis = ask(R"({"id":3,"cmd":"home","axis":"turet"})");
    EXPECT_THAT(axis["error"]["remedy"].get<std::string>(), HasSubstr("turret"));
}

TEST_F(RequestsTest, ARequestThatSaysWhenItWasSentIsJudgedByItsAge) {
    const auto sent = [](std::int64_t us_ago) { return std::to_string(sent_at - us_ago); };
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"home","axis":"x","valid_ms":200,"utime":)" + sent(201'000) + "}"), "command.stale");
    EXPECT_EQ(code_for(R"({"id":2,"cmd":"home","axis":"x","utime":)" + sent(-2'000'000) + "}"), "command.stale");
    EXPECT_EQ(code_for(R"({"id":3,"cmd":"home","axis":"x","utime":-9223372036854775808})"), "command.stale");
    EXPECT_EQ(code_for(R"({"id":4,"cmd":"home","axis":"x","utime":9223372036854775807})"), "command.stale");
    EXPECT_TRUE(machine.submitted.empty());
    EXPECT_EQ(ask(R"({"id":5,"cmd":"home","axis":"x","valid_ms":200,"utime":)" + sent(100'000) + "}")["ok"], true);
    EXPECT_EQ(machine.submitted[0].expires, now + 100ms);
}

// What the gateway does not see is judged all the same: by the client's clock, and by how long it has waited here.
TEST_F(RequestsTest, AHandOnASimulatedMachineThatComesTooLateIsRefused) {
    std::vector<std::string> done;
    requests.set_simulate([&](const std::string& line) -> Result<void> {
        done.push_back(line);
        return {};
    });
    const auto sent = [](std::int64_t us_ago) { return std::to_string(sent_at - us_ago); };
    EXPECT_EQ(code_for(R"({"id":1,"cmd":"simulate","line":"input start 1","utime":)" + sent(1'000'001) + "}"), "command.stale");
    EXPECT_EQ(code_for(R"({"id":2,"cmd":"simulate","line":"input start 1","valid_ms":200,"utime":)" + sent(200'001) + "}"),
              "command.stale");
    EXPECT_EQ(code_for(R"({"id":3,"cmd":"simulate","line":"input start 1","utime":)" + sent(-1'000'001) + "}"), "command.stale");
    EXPECT_EQ(code_for(R"({"id":4,"cmd":"simulate","line":"input start 1","valid_ms":0})"), "command.bad_value");
    EXPECT_EQ(code_for(R"({"id":5,"cmd":"simulate","line":"input start 1","valid_ms":10001})"), "command.bad_value");
    // Of a client without a clock: it lay in the socket while the runtime stood still.
    requests.on_request(1, R"({"id":6,"cmd":"simulate","line":"input start 1"})", now, {.at = now - 1001ms});
    EXPECT_THAT(requests.next_line()->text, HasSubstr("command.stale"));
    EXPECT_TRUE(done.empty());
    requests.on_request(1, R"({"id":7,"cmd":"simulate","line":"input start 1"})", now, {.at = now - 1000ms});
    EXPECT_EQ(requests.next_line()->text, R"({"id":7,"ok":true})");
    EXPECT_EQ(ask(R"({"id":8,"cmd":"simulate","line":"input start 1","valid_ms":200,"utime":)" + sent(200'000) + "}")["ok"], true);
    EXPECT_EQ(done.size(), 2u);
}

TEST_F(RequestsTest, StateCarriesNamesUnitsAndAlarmTexts) {
    machine.snapshot.axes[0].state = axes::AxisState::DiscreteMotion;
    machine.snapshot.axes[0].actual_position = 12.5;
    machine.snapshot.axes[0].active_kind = axes::CommandKind::gear_in_pos;
    machine.snapshot.axes[1].lock = 7;
    std::array<std::byte, 64> pick{};  // a block: what of it submits lies somewhere inside
    machine.its_layout.blocks = {{"cell.pick", pick.data(), pick.size()}};
    machine.snapshot.axes[0].holder = &pick[40];
    machine.snapshot.axes[1].holder = pick.data() + pick.size();
    machine.snapshot.alarms.resize(4);
    machine.snapshot.alarms[0].standing = true;
    machine.snapshot.alarms[0].reaction = Reaction::stop_axis;
    machine.snapshot.alarm_count = 1;

    const auto state = ask(R"({"id":1,"cmd":"state"})")["state"];

    EXPECT_EQ(state["machine"], "demo");
    EXPECT_EQ(state["phase"], "running");
    EXPECT_EQ(state["bus"]["phase"], "operational");
    ASSERT_EQ(state["axes"].size(), 3u);
    EXPECT_EQ(state["axes"][0]["name"], "x");
    EXPECT_EQ(state["axes"][0]["unit"], "mm");
    EXPECT_EQ(state["axes"][0]["state"], "DiscreteMotion");
    EXPECT_EQ(state["axes"][0]["actual_position"], 12.5);
    EXPECT_EQ(state["axes"][0]["command"], "MC_GearInPos");
    EXPECT_EQ(state["axes"][0]["block"], "cell.pick");
    EXPECT_EQ(state["axes"][1]["block"], "") << "the first byte behind it";
    EXPECT_EQ(state["axes"][0]["held_by_stop"], false);
    EXPECT_EQ(state["axes"][1]["held_by_stop"], true);
    EXPECT_EQ(state["axes"][1]["command"], "");
    EXPECT_EQ(state["inputs"]["estop_ok"], 1);
    EXPECT_EQ(state["outputs"]["lamp_run"], 1);
    EXPECT_EQ(state["programs"][0]["state"], "running");
    EXPECT_EQ(state["parameters"][2]["program"], "feeder");
    ASSERT_EQ(state["alarms"].size(), 1u) << "only the valid ones";
    EXPECT_EQ(state["alarms"][0]["chinese"], "跟随误差过大");
    EXPECT_EQ(state["alarms"][0]["reaction"], "stop_axis");
}

TEST_F(RequestsTest, LayoutCarriesRangesAndJoggingSpeeds) {
    const auto layout = ask(R"({"cmd":"layout"})")["layout"];
    EXPECT_EQ(layout["axes"][2]["name"], "turret");
    EXPECT_EQ(layout["axes"][2]["disabled"], true);
    EXPECT_EQ(layout["axes"][0]["jog_fast"], 50);
    EXPECT_EQ(layout["parameters"][0]["maximum"], 500);
    EXPECT_EQ(layout["cycle_ns"], 1'000'000);
}

TEST_F(RequestsTest, BeforeTheFirstCycleStateSaysHowTheStartGetsOn) {
    requests.observe(nullptr);
    requests.set_progress("slave 2 'y' PREOP");
    const auto answer = ask(R"({"id":1,"cmd":"state"})");
    EXPECT_EQ(answer["error"]["code"], "state.not_yet");
    EXPECT_THAT(answer["error"]["what"].get<std::string>(), HasSubstr("slave 2 'y' PREOP"));
    EXPECT_EQ(ask(R"({"cmd":"hello"})")["hello"]["cycling"], false);
}

TEST_F(RequestsTest, ValuesThatAreNoNumbersDoNotBreakTheAnswer) {
    machine.snapshot.axes[0].actual_position = std::numeric_limits<double>::quiet_NaN();
    machine.snapshot.variables[0] = std::numeric_limits<double>::infinity();
    machine.its_layout.machine = "bro\xffken";
    const auto state = ask(R"({"id":1,"cmd":"state"})")["state"];
    EXPECT_EQ(state["axes"][0]["actual_position"], "NaN");
    EXPECT_EQ(state["variables"][0]["value"], "Infinity");
    EXPECT_EQ(state["parameters"][0]["value"], 200) << "a number stays one";
    // And back.
    EXPECT_TRUE(std::isnan(number_of(state["axes"][0]["actual_position"])));
    EXPECT_EQ(number_of(state["variables"][0]["value"]), std::numeric_limits<double>::infinity());
    EXPECT_EQ(number_of(nlohmann::json("-Infinity")), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(number_of(nlohmann::json(2.5)), 2.5);
    EXPECT_TRUE(std::isnan(number_of(nlohmann::json(nullptr))));
}

// Who stood in whose way is there for every client, not only in the log.
TEST_F(RequestsTest, StateCarriesRefusedAndAbortedCommands) {
    auto& event = machine.snapshot.events[0];
    event.number = 41;
    event.axis = 1;
    event.given = {axes::CommandKind::move_absolute, axes::Owner::program, 0, nullptr};
    event.by = {axes::CommandKind::stop, axes::Owner::program, 1, nullptr};
    event.held = true;
    event.error = axes::ErrorId::state_forbids;
    event.times = 3;
    machine.snapshot.event_count = 1;

    const auto state = ask(R"({"id":1,"cmd":"state"})")["state"];

    ASSERT_EQ(state["events"].size(), 1u) << "only the valid ones";
    const auto& told = state["events"][0];
    EXPECT_EQ(told["number"], 41);
    EXPECT_EQ(told["event"], "refused");
    EXPECT_EQ(told["axis"], "y");
    EXPECT_EQ(told["given"]["command"], "MC_MoveAbsolute");
    EXPECT_EQ(told["given"]["program"], "cell");
    EXPECT_EQ(told["by"]["program"], "feeder");
    EXPECT_EQ(told["held_by_stop"], true);
    EXPECT_EQ(told["error"], "state_forbids");
    EXPECT_EQ(told["times"], 3);
    EXPECT_THAT(told["english"].get<std::string>(), HasSubstr("MC_Stop of program feeder holds the axis"));
    EXPECT_FALSE(told["remedy"].get<std::string>().empty());
}

TEST_F(RequestsTest, AnAnswerSaysWhenTheAxisGoesSlowerThanAskedFor) {
    requests.on_line(1, R"({"id":1,"cmd":"move","axis":"x","position":10,"velocity":100})", now);
    ASSERT_EQ(machine.submitted.size(), 1u);
    machine.answer(runtime::Answer::accepted);
    machine.answers.back().limited_to = 20;
    machine.answers.back().limited_in = runtime::Mode::setup;
    gateway.step(now);
    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply);
    requests.deliver(*reply);
    EXPECT_EQ(requests.next_line()->text, R"({"id":1,"ok":true,"note":"limited to 20 mm/s by setup mode"})");
}

TEST_F(RequestsTest, AnAnswerSaysWhenAContinueLeavesItToTheProgram) {
    requests.on_line(1, R"({"id":1,"cmd":"group_continue","group":"table"})", now);
    ASSERT_EQ(machine.submitted.size(), 1u);
    machine.answer(runtime::Answer::accepted);
    machine.answers.back().waits_for_program = true;
    gateway.step(now);
    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply);
    requests.deliver(*reply);
    EXPECT_EQ(requests.next_line()->text,
              R"({"id":1,"ok":true,"note":"its program has interrupted it, too, and goes on with it by itself"})");
}

TEST_F(RequestsTest, HandsReachASimulatedMachineOnly) {
    const auto real = ask(R"({"id":1,"cmd":"simulate","line":"input start 1"})");
    EXPECT_EQ(real["ok"], false);
    EXPECT_EQ(real["error"]["code"], "simulate.real_machine");

    std::vector<std::string> done;
    requests.set_simulate([&](const std::string& line) -> Result<void> {
        if (line == "nonsense") return Error{"fault.unknown", line, "there is no such word", "look"};
        done.push_back(line);
        return {};
    });
    EXPECT_EQ(ask(R"({"id":2,"cmd":"simulate","line":"input start 1"})")["ok"], true);
    EXPECT_EQ(done, std::vector<std::string>{"input start 1"});
    EXPECT_EQ(ask(R"({"id":3,"cmd":"simulate","line":"nonsense"})")["error"]["code"], "fault.unknown");
    EXPECT_EQ(ask(R"({"id":4,"cmd":"simulate"})")["error"]["code"], "request.missing_key");
}

TEST_F(RequestsTest, AnswersGoToTheConnectionThatAsked) {
    requests.on_open(2, {200, 1000, 1000});
    requests.on_line(2, R"({"id":1,"cmd":"home","axis":"y"})", now);
    machine.answer(Answer::accepted);
    requests.on_line(1, R"({"id":1,"cmd":"home","axis":"x"})", now);
    machine.answer(Answer::wrong_mode);
    gateway.step(now);
    while (const auto reply = gateway.next_reply()) requests.deliver(*reply);

    const auto first = requests.next_line();
    const auto second = requests.next_line();
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->connection, 2u);
    EXPECT_EQ(second->connection, 1u);
    EXPECT_THAT(second->text, HasSubstr("command.wrong_mode"));
}

TEST_F(RequestsTest, AClosedConnectionStopsItsJogAndHearsNothing) {
    ask(R"({"id":1,"cmd":"jog","axis":"x","velocity":20,"press":true})");
    requests.on_line(1, R"({"id":2,"cmd":"home","axis":"y"})", now);
    machine.answer(Answer::accepted);

    requests.on_close(1);

    EXPECT_EQ(machine.releases, std::vector<std::uint16_t>{0});
    gateway.step(now);
    while (const auto reply = gateway.next_reply()) requests.deliver(*reply);
    EXPECT_FALSE(requests.next_line());
}

}  // namespace
}  // namespace taktwerk::hmi

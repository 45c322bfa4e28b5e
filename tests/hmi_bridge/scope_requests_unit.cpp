// The scope's requests: what signals there are, windows of them, and what broken requests get.
#include "hmi_bridge/socket/scope_requests.hpp"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/base64.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "tests/hmi_bridge/base64_text.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using runtime::RecordedSignal;
using runtime::SignalCell;
using runtime::SignalGroup;
using runtime::SignalKind;
using runtime::SignalRing;
using Coding = SignalCell::Coding;

std::string base64(std::string_view text) {
    std::string out;
    append_base64(out, std::as_bytes(std::span{text}));
    return out;
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

class ScopeRequestsTest : public testing::Test {
protected:
    ScopeRequestsTest() {
        machine.rows = &ring;
        for (std::uint64_t cycle = 1; cycle <= 3000; ++cycle) write(cycle, static_cast<double>(cycle) / 8);
    }
    void write(std::uint64_t cycle, double position) {
        auto row = ring.begin(cycle);
        row.put(Duration{cycle * 1'000'000});
        row.put(position);
        row.put(std::uint64_t{5});
        ring.commit();
    }
    json ask(const json& request, int* steps = nullptr) {
        JsonFields fields(request);
        (void)fields.text("cmd", true);
        if (const auto begun = scope.handle(1, "7", request["cmd"].get<std::string>(), fields, now); !begun)
            return json{{"code", begun.error().code}, {"remedy", begun.error().remedy}};
        for (int i = 0; i < 10000; ++i) {
            if (const auto answer = scope.next_answer()) {
                if (steps) *steps = i;
                if (answer->error) return json{{"code", answer->error->code}, {"remedy", answer->error->remedy}};
                return json::parse(answer->text);
            }
            scope.step(&machine.snapshot, now);
        }
        ADD_FAILURE() << "no answer";
        return {};
    }

    SignalRing ring{
        {{"time_s", "s", SignalKind::real, SignalGroup::machine, "", "machine time", "机器时间", {0, 0, 64, Coding::integer, 1e9}},
         {"x.set_position", "mm", SignalKind::real, SignalGroup::axis, "x", "set position", "设定位置", {1, 0, 64, Coding::real, 1}},
         {"x.state",
          "",
          SignalKind::state,
          SignalGroup::axis,
          "x",
          "state",
          "轴状态",
          {2, 0, 8, Coding::natural, 1},
          true,
          {{0, "Disabled"}, {5, "Moves"}}}},
        3,
        2000,
        1ms};
    test::FakeMachine machine;
    ScopeRequests scope{machine};
    Instant now{10s};
};

TEST_F(ScopeRequestsTest, SignalsAreNamedWithAllThatAPageNeeds) {
    const auto answer = ask({{"cmd", "scope_signals"}});
    EXPECT_EQ(answer["id"], 7);
    EXPECT_EQ(answer["ok"], true);
    const auto& s = answer["scope"];
    EXPECT_EQ(s["cycle_ns"], 1'000'000);
    EXPECT_EQ(s["first"], 1001);
    EXPECT_EQ(s["last"], 3000);
    EXPECT_EQ(s["depth"], 2000);
    EXPECT_EQ(s["signals"][1], (json{{"name", "x.set_position"},
                                     {"unit", "mm"},
                                     {"kind", "real"},
                                     {"group", "axis"},
                                     {"of", "x"},
                                     {"en", "set position"},
                                     {"zh", "设定位置"}}));
    EXPECT_EQ(s["signals"][2]["states"], (json{{"0", "Disabled"}, {"5", "Moves"}}));
}

TEST_F(ScopeRequestsTest, AReadIsToTheLastBit) {
    write(3001, 0.1);
    write(3002, std::numeric_limits<double>::quiet_NaN());
    write(3003, -std::numeric_limits<double>::infinity());

    const auto answer = ask({{"cmd", "scope_read"}, {"signals", {"x.state", "x.set_position"}}, {"from", 3000}, {"to", 3004}});

    EXPECT_EQ(answer["from"], 3000);
    EXPECT_EQ(answer["to"], 3004);
    EXPECT_EQ(answer["per"], 1);
    EXPECT_EQ(answer["missing"], 0);
    EXPECT_EQ(answer["time_ns"], 3'000'000'000);
    EXPECT_EQ(answer["last"], 3003);
    EXPECT_EQ(numbers_of(answer["data"][0]), (std::vector<double>{5, 5, 5, 5}));
    const auto positions = numbers_of(answer["data"][1]);
    ASSERT_EQ(positions.size(), 4u);
    EXPECT_EQ(positions[0], 375.0);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(positions[1]), std::bit_cast<std::uint64_t>(0.1));
    EXPECT_TRUE(std::isnan(positions[2]));
    EXPECT_EQ(positions[3], -std::numeric_limits<double>::infinity());
}

TEST_F(ScopeRequestsTest, FewerPointsAreTheExtremesOfAsManyCycles) {
    write(3001, 9999);
    const auto answer = ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"from", 2002}, {"to", 3002}, {"points", 10}});
    EXPECT_EQ(answer["per"], 100);
    const auto pairs = numbers_of(answer["data"][0]);
    ASSERT_EQ(pairs.size(), 20u);
    EXPECT_EQ(pairs[0], 2002.0 / 8);
    EXPECT_EQ(pairs[1], 2101.0 / 8);
    EXPECT_EQ(pairs[18], 2902.0 / 8);
    EXPECT_EQ(pairs[19], 9999) << "one sample of a hundred";
}

TEST_F(ScopeRequestsTest, WithoutFromItIsTheNewestAndAPageReadsOnWhereItWas) {
    const auto newest = ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"points", 50}});
    EXPECT_EQ(newest["from"], 2951);
    EXPECT_EQ(newest["to"], 3001);

    const auto nothing_yet = ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"from", newest["to"]}});
    EXPECT_EQ(nothing_yet["to"], 3001);
    EXPECT_EQ(nothing_yet["missing"], 0);
    write(3001, 1);
    write(3002, 2);
    const auto next = ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"from", newest["to"]}});
    EXPECT_EQ(numbers_of(next["data"][0]), (std::vector<double>{1, 2}));
    EXPECT_EQ(next["to"], 3003);

    for (std::uint64_t c = 3003; c <= 6000; ++c) write(c, 0);
    const auto slow = ask({{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"from", next["to"]}});
    EXPECT_EQ(slow["from"], 4001) << "6000 - 2000 + 1";
    EXPECT_EQ(slow["missing"], 4001 - 3003);
}

// 64 signals over 2000 cycles are 128,000 values, and as many again that are text: in steps, for everybody else waits meanwhile.
TEST_F(ScopeRequestsTest, ALongReadingIsDoneInStepsAndNoAnswerIsTooLong) {
    json names = json::array();
    for (int i = 0; i < 64; ++i) names.push_back("x.set_position");
    int steps = 0;
    const auto answer = ask({{"cmd", "scope_read"}, {"signals", names}, {"from", 1001}}, &steps);
    EXPECT_GE(steps, 4);
    EXPECT_EQ(answer["per"], 1);
    EXPECT_EQ(answer["data"].size(), 64u);

    SignalRing large{ring.signals(), 3, 20'000, 1ms};
    for (std::uint64_t cycle = 1; cycle <= 20'000; ++cycle) {
        auto row = large.begin(cycle);
        for (int w = 0; w < 3; ++w) row.put(static_cast<double>(cycle));
        large.commit();
    }
    test::FakeMachine large_machine;
    large_machine.rows = &large;
    ScopeRequests other{large_machine};
    const json request{{"cmd", "scope_read"}, {"signals", names}, {"from", 1}};
    JsonFields fields(request);
    (void)fields.text("cmd", true);
    ASSERT_TRUE(other.handle(1, "1", "scope_read", fields, now).ok());
    std::optional<ScopeRequests::Answer> got;
    for (int i = 0; i < 1000 && !(got = other.next_answer()); ++i) other.step(nullptr, now);
    ASSERT_TRUE(got.has_value());
    const auto thinned = json::parse(got->text);
    std::size_t total = 0;
    for (const auto& one : thinned["data"]) total += numbers_of(one).size();
    EXPECT_GT(thinned["per"], 1);
    EXPECT_LE(total, ScopeRequests::most_numbers);
    EXPECT_EQ(numbers_of(thinned["data"][63]).back(), 20'000);
}

TEST_F(ScopeRequestsTest, WhoAsksTooMuchIsToldAndAClosedConnectionIsForgotten) {
    const json request{{"cmd", "scope_read"}, {"signals", {"x.set_position"}}, {"from", 1}};
    const auto begin = [&](ConnectionId connection) {
        JsonFields fields(request);
        (void)fields.text("cmd", true);
        return scope.handle(connection, "1", "scope_read", fields, now);
    };
    for (std::size_t i = 0; i < ScopeRequests::most_reads; ++i) EXPECT_TRUE(begin(1).ok());
    EXPECT_EQ(begin(1).error().code, "scope.busy");
    EXPECT_TRUE(begin(2).ok()) << "another client's are another's";
    scope.forget(1);
    for (int i = 0; i < 100; ++i) scope.step(nullptr, now);
    const auto only = scope.next_answer();
    ASSERT_TRUE(only.has_value());
    EXPECT_EQ(only->connection, 2u);
    EXPECT_FALSE(scope.next_answer().has_value());
}

TEST_F(ScopeRequestsTest, BrokenRequestsGetOneClearErrorEach) {
    const auto code = [&](const json& request) { return ask(request)["code"].get<std::string>(); };
    EXPECT_EQ(code({{"cmd", "scope_read"}}), "request.missing_key");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", "x.state"}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", json::array()}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", {1}}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", std::vector<std::string>(65, "x.state")}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"from", -1}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"from", 1.5}}), "request.wrong_type");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"from", 5}, {"to", 4}}), "scope.window");
    EXPECT_EQ(code({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"form", 5}}), "request.unknown_key");
    EXPECT_EQ(code({{"cmd", "scope_signals"}, {"axis", "x"}}), "request.unknown_key");
    const auto unknown = ask({{"cmd", "scope_read"}, {"signals", {"x.set_positon"}}});
    EXPECT_EQ(unknown["code"], "scope.unknown_signal");
    EXPECT_THAT(unknown["remedy"].get<std::string>(), testing::HasSubstr("x.set_position"));
    // As large as numbers get: nothing overflows, nothing takes for ever.
    const auto far = ask({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"from", 0}, {"to", INT64_MAX}, {"points", INT64_MAX}});
    EXPECT_EQ(far["from"], 1001);
    EXPECT_EQ(far["to"], 3001);
    EXPECT_EQ(far["missing"], INT64_MAX - 2000);
    EXPECT_EQ(ask({{"cmd", "scope_read"}, {"signals", {"x.state"}}, {"points", 0}})["ok"], true);
}

// A warning that stands for longer than the memory is deep: it came before the trigger was armed, and does not come again.
TEST_F(ScopeRequestsTest, AnAlarmFromBeforeNeverTriggersHoweverLongItStands) {
    machine.snapshot.alarms = {{{0x5001, AlarmSource::axis, 0}, Instant{2900ms}, 1, true, false, Reaction::warn},
                               {{0x5001, AlarmSource::axis, 1}, Instant{7500ms}, 1, true, false, Reaction::warn}};
    machine.snapshot.alarm_count = 1;
    machine.snapshot.cycle = 3000;
    const json when{{"kind", "alarm"}, {"alarm", "following_error"}};
    ASSERT_EQ(ask({{"cmd", "scope_arm"}, {"when", when}, {"pre", 5}, {"post", 5}, {"mode", "normal"}})["ok"], true);
    for (std::uint64_t cycle = 3001; cycle <= 8000; ++cycle) {
        write(cycle, 0);
        machine.snapshot.cycle = cycle;
        if (cycle % 100 == 0) scope.step(&machine.snapshot, now);
    }
    EXPECT_EQ(ask({{"cmd", "scope_state"}})["scope"]["events"], json::array());

    machine.snapshot.alarm_count = 2;  // one that did come
    scope.step(&machine.snapshot, now);
    const auto events = ask({{"cmd", "scope_state"}})["scope"]["events"];
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0]["cycle"], 7500);
}

TEST(ScopeRequests, AMachineWithoutAMemorySaysSo) {
    const test::FakeMachine machine;
    ScopeRequests scope{machine};
    const json request{{"cmd", "scope_signals"}};
    JsonFields fields(request);
    EXPECT_EQ(scope.handle(1, "1", "scope_signals", fields, Instant{1s}).error().code, "scope.none");
}

}  // namespace
}  // namespace taktwerk::hmi

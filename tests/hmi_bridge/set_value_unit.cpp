// What people write to programs' variables at the gateway: by whose name, in which range, how old; and what ends with who pressed.

#include <gmock/gmock.h>

#include <limits>

#include "hmi_bridge/gateway/gateway.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::Answer;
using runtime::OperatorAction;
using test::FakeMachine;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SetValue : public testing::Test {
protected:
    SetValue() { gateway.observe(true); }
    CommandRequest request(std::string target, double value, bool press = false) {
        CommandRequest r;
        r.client = client;
        r.sequence = ++sequence;
        r.kind = CommandKind::set_value;
        r.target = std::move(target);
        r.value = value;
        r.press = press;
        return r;
    }
    CommandReply outcome(const CommandRequest& r, Answer verdict = Answer::accepted, axes::ErrorId error = axes::ErrorId::none) {
        const auto before = machine.submitted.size();
        gateway.handle(r, now);
        if (machine.submitted.size() > before) machine.answer(verdict, error);
        gateway.step(now += 5ms);
        auto reply = gateway.next_reply();
        EXPECT_TRUE(reply.has_value());
        return reply.value_or(CommandReply{});
    }

    std::vector<std::string> log;
    FakeMachine machine;
    Gateway gateway{machine, [this](std::string_view line) { log.emplace_back(line); }};
    ClientId client = gateway.open(Source::socket, "panel", Rights::commissioning);
    std::uint64_t sequence = 0;
    Instant now{10s};
};

TEST_F(SetValue, GoesToItsVariableByFullNameOrByItsOwnWhereOnlyOneProgramHasIt) {
    EXPECT_TRUE(outcome(request("cell.count", 7)).accepted());
    EXPECT_TRUE(outcome(request("tempo", 12.5)).accepted());
    ASSERT_EQ(machine.submitted.size(), 2u);
    EXPECT_EQ(machine.submitted[0].action, OperatorAction::set_value);
    EXPECT_EQ(machine.submitted[0].index, 2) << "its place in the layout";
    EXPECT_EQ(machine.submitted[0].value, 7);
    EXPECT_FALSE(machine.submitted[0].flag);
    EXPECT_EQ(machine.submitted[1].index, 3);
    EXPECT_THAT(log, ElementsAre("panel: set_value variable cell.count = 7", "panel: set_value variable feeder.tempo = 12.5 mm/s"));
}

TEST_F(SetValue, WhatIsTheProgramsAloneIsRefusedAndSaysSo) {
    const auto reply = outcome(request("cell.step", 1));
    EXPECT_EQ(reply.answer, Answer::unknown_name);
    EXPECT_THAT(reply.error.what, HasSubstr("'cell.step' is the program's alone"));
    EXPECT_THAT(reply.error.remedy, HasSubstr("cell.start"));
    EXPECT_THAT(outcome(request("cell.cuont", 1)).error.remedy, HasSubstr("Did you mean 'cell.count'?"));
    EXPECT_THAT(machine.submitted, IsEmpty());
}

TEST_F(SetValue, OutsideItsRangeOrOfAnotherTypeIsRefusedWithTheRange) {
    const auto nan = std::numeric_limits<double>::quiet_NaN();
    const auto beyond = outcome(request("cell.count", 51));
    EXPECT_EQ(beyond.answer, Answer::bad_value);
    EXPECT_EQ(beyond.error.subject, "variable cell.count");
    EXPECT_THAT(beyond.error.remedy, HasSubstr("1 to 50"));
    EXPECT_THAT(outcome(request("feeder.tempo", 100.5)).error.remedy, HasSubstr("10 to 100 mm/s"));
    EXPECT_THAT(outcome(request("cell.count", 2.5)).error.remedy, HasSubstr("2 or 3"));
    EXPECT_THAT(outcome(request("feeder.light", 2)).error.remedy, HasSubstr("0 or 1"));
    for (const double value : {nan, -1e300, 0.0}) EXPECT_EQ(outcome(request("cell.count", value)).answer, Answer::bad_value) << value;
    EXPECT_THAT(outcome(request("feeder.light", 1, true)).error.what, HasSubstr("only a button is pressed"));
    EXPECT_THAT(machine.submitted, IsEmpty());
}

TEST_F(SetValue, AnOldPressIsRefusedAndAnOldReleaseIsNot) {
    auto press = request("cell.start", 1, true);
    press.age = 600ms;  // the second that other commands are valid for is too long for a hand
    EXPECT_EQ(outcome(press).answer, Answer::stale);
    auto release = request("cell.start", 0);
    release.age = 20s;
    EXPECT_TRUE(outcome(release).accepted());
    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].value, 0);
    EXPECT_EQ(machine.submitted[0].expires, Instant{}) << "never too late in the cycle either";
}

TEST_F(SetValue, APressIsToldOnceAndItsRenewalsAreNot) {
    EXPECT_TRUE(outcome(request("cell.start", 1, true)).accepted());
    EXPECT_TRUE(machine.submitted.back().flag);
    EXPECT_TRUE(outcome(request("cell.start", 1)).accepted());
    EXPECT_FALSE(machine.submitted.back().flag);
    EXPECT_TRUE(outcome(request("cell.start", 0)).accepted());
    EXPECT_THAT(log, ElementsAre("panel: set_value variable cell.start = 1", "panel: set_value variable cell.start = 0"));
}

TEST_F(SetValue, WhoPressedAndIsGoneLetsGo) {
    EXPECT_TRUE(outcome(request("cell.start", 1, true)).accepted());
    gateway.close(client);
    ASSERT_EQ(machine.submitted.size(), 2u);
    EXPECT_EQ(machine.submitted[1].action, OperatorAction::release_values);
    EXPECT_EQ(machine.submitted[1].client, client);
}

TEST_F(SetValue, WhatTheMachineRefusesComesWithItsWords) {
    EXPECT_THAT(outcome(request("cell.start", 1, true), Answer::no_control).error.what, HasSubstr("somebody else holds this button"));
    EXPECT_THAT(outcome(request("cell.start", 1, true), Answer::not_possible_now).error.remedy, HasSubstr("Start the program"));
    EXPECT_THAT(outcome(request("cell.start", 1), Answer::stale).error.remedy, HasSubstr("Press again"));
    EXPECT_THAT(outcome(request("feeder.light", 1), Answer::not_possible_now, axes::ErrorId::interlocked).error.what,
                HasSubstr("emergency stop is pressed"));
}

}  // namespace
}  // namespace taktwerk::hmi

// Who did what, and what ends with whom.

#include <gmock/gmock.h>

#include "hmi_bridge/gateway/gateway.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::Answer;
using runtime::OperatorAction;
using test::FakeMachine;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Deeds : public testing::Test {
protected:
    Deeds() { gateway.observe(true); }
    CommandRequest request(ClientId who, CommandKind kind, std::string target = "", double value = 0, double value2 = 0) {
        CommandRequest r;
        r.client = who;
        r.sequence = ++sequence;
        r.kind = kind;
        r.target = std::move(target);
        r.value = value;
        r.value2 = value2;
        if (kind == CommandKind::jog) r.valid_for = 250ms;
        return r;
    }
    Answer does(const CommandRequest& r, Answer verdict = Answer::accepted) {
        const auto before = machine.submitted.size();
        gateway.handle(r, now);
        if (machine.submitted.size() > before) machine.answer(verdict);
        gateway.step(now += 5ms);
        const auto reply = gateway.next_reply();
        EXPECT_TRUE(reply);
        return reply ? reply->answer : Answer::duplicate;
    }
    Answer does(ClientId who, CommandKind kind, std::string target = "", double value = 0, double value2 = 0) {
        return does(request(who, kind, std::move(target), value, value2));
    }

    std::vector<std::string> log;
    FakeMachine machine;
    Gateway gateway{machine, [this](std::string_view line) { log.emplace_back(line); }};
    ClientId a = gateway.open(Source::socket, "process 7 (panel) of user 1000", Rights::commissioning);
    ClientId b = gateway.open(Source::socket, "process 8 (script) of user 1001", Rights::commissioning);
    std::uint64_t sequence = 0;
    Instant now{10s};
};

TEST_F(Deeds, EachKindIsToldWithWhoAndWhatAndItsNumbers) {
    const std::string who = "process 7 (panel) of user 1000: ";
    const auto told = [&](CommandKind kind, const char* target, double value, double value2, const std::string& what) {
        log.clear();
        EXPECT_EQ(does(a, kind, target, value, value2), Answer::accepted) << what;
        EXPECT_THAT(log, ElementsAre(who + what));
        now += 1s;
    };
    told(CommandKind::take_control, "x", 0, 0, "take_control axis x");
    told(CommandKind::release_control, "all", 0, 0, "release_control all axes");
    told(CommandKind::enable, "x", 0, 0, "enable axis x");
    told(CommandKind::disable, "x", 0, 0, "disable axis x");
    told(CommandKind::home, "y", 0, 0, "home axis y");
    told(CommandKind::move, "x", 20.5, 10, "move axis x to 20.5 mm at 10 mm/s");
    told(CommandKind::stop, "", 0, 0, "stop all axes");
    told(CommandKind::reset, "x", 0, 0, "reset axis x");
    told(CommandKind::mode, "", 0, 0, "mode manual");
    told(CommandKind::program_start, "cell", 0, 0, "program_start program cell");
    told(CommandKind::program_stop, "cell", 0, 0, "program_stop program cell");
    told(CommandKind::program_reset, "cell", 0, 0, "program_reset program cell");
    told(CommandKind::set_parameter, "speed", 250, 0, "set_parameter parameter cell.speed = 250 mm/s");
    told(CommandKind::set_output, "lamp_run", 1, 0, "set_output output lamp_run = 1");
    told(CommandKind::force, "start_button", 1, 0, "force input start_button = 1");
    told(CommandKind::unforce, "start_button", 0, 0, "unforce input start_button");
    told(CommandKind::release_forces, "", 0, 0, "release_forces");
    told(CommandKind::override_velocity, "x", 0.5, 0, "override axis x 50 %");
    told(CommandKind::group_halt, "table", 0, 0, "group_halt group table");
    told(CommandKind::group_interrupt, "table", 0, 0, "group_interrupt group table");
    told(CommandKind::group_override, "table", 0.5, 0, "group_override group table 50 %");
    told(CommandKind::group_enable, "table", 0, 0, "group_enable group table");
    told(CommandKind::reset_peaks, "all", 0, 0, "reset_peaks all axes");
    told(CommandKind::reset_statistics, "", 0, 0, "reset_statistics");
    told(CommandKind::acknowledge, "", 0, 0, "acknowledge");
    told(CommandKind::shutdown, "", 0, 0, "shutdown");
    auto commissioning = request(a, CommandKind::take_control, "x");
    commissioning.commissioning = true;
    log.clear();
    does(commissioning);
    EXPECT_THAT(log, ElementsAre(who + "take_control axis x, as commissioning"));
}

TEST_F(Deeds, WhatTheMachineRefusedWasNoDeed) {
    EXPECT_EQ(does(request(a, CommandKind::enable, "x"), Answer::no_control), Answer::no_control);
    EXPECT_THAT(log, IsEmpty());
}

TEST_F(Deeds, AJogIsToldWhenItBeginsAndWhenItEnds) {
    auto press = request(a, CommandKind::jog, "x", 20);
    press.press = true;
    does(press);
    for (int i = 0; i < 10; ++i) does(a, CommandKind::jog, "x", 20);
    does(a, CommandKind::jog, "x", 0);
    does(a, CommandKind::jog, "x", 0);
    EXPECT_THAT(log, ElementsAre(HasSubstr("jog axis x at 20 mm/s"), HasSubstr("jog axis x: let go")));

    log.clear();
    press = request(a, CommandKind::jog, "x", 20);
    press.press = true;
    does(press);
    gateway.close(a);
    EXPECT_THAT(log, ElementsAre(HasSubstr("jog axis x at 20 mm/s"), HasSubstr("is gone while it jogs axis x: the axis stops")));
}

// `echo ... | socat` is gone before the cycle has answered.
TEST_F(Deeds, ADeedIsToldAlsoWhenItsClientIsGoneBeforeTheAnswer) {
    gateway.handle(request(a, CommandKind::enable, "x"), now);
    gateway.close(a);
    EXPECT_THAT(log, ElementsAre("process 7 (panel) of user 1000: enable axis x; it was gone before the answer"));
}

TEST_F(Deeds, OneClientCannotFillTheLogNorCrowdOutAnother) {
    machine.inbox_size = 10000;
    for (int i = 0; i < 1000; ++i) does(a, CommandKind::acknowledge);
    EXPECT_LE(log.size(), 20u + 2u * 5u + 1u) << "burst, and two a second for five seconds";
    log.clear();
    does(b, CommandKind::enable, "y");
    EXPECT_THAT(log, ElementsAre("process 8 (script) of user 1001: enable axis y"));
    log.clear();
    now += 10s;
    does(a, CommandKind::acknowledge);
    EXPECT_THAT(log, ElementsAre(HasSubstr("things it did before are not listed")));
}

TEST_F(Deeds, OutputsOfAClientThatIsGoneAreTakenBackAlsoWhenTheInboxWasFull) {
    does(a, CommandKind::set_output, "lamp_run", 1);
    const auto before = machine.submitted.size();
    machine.inbox_size = before;
    gateway.close(a);
    gateway.step(now);
    EXPECT_EQ(machine.submitted.size(), before);
    machine.inbox_size = 1000;
    gateway.step(now);
    gateway.step(now);
    ASSERT_EQ(machine.submitted.size(), before + 1) << "once";
    EXPECT_EQ(machine.submitted.back().action, OperatorAction::release_outputs);
    EXPECT_EQ(machine.submitted.back().client, a);
    gateway.close(b);
    gateway.step(now);
    EXPECT_EQ(machine.submitted.size(), before + 1) << "it had set none";
}

TEST_F(Deeds, WhatAClientHasForcedEndsWithIt) {
    does(a, CommandKind::force, "start_button", 1);
    does(a, CommandKind::unforce, "start_button");
    const auto before = machine.submitted.size();
    gateway.close(b);
    gateway.step(now);
    EXPECT_EQ(machine.submitted.size(), before) << "it had forced none";
    gateway.close(a);
    gateway.step(now);
    ASSERT_EQ(machine.submitted.size(), before + 1) << "once";
    EXPECT_EQ(machine.submitted.back().action, OperatorAction::release_forces);
    EXPECT_TRUE(machine.submitted.back().flag) << "its own alone";
    EXPECT_EQ(machine.submitted.back().client, a);
    EXPECT_THAT(log, Contains(HasSubstr("is gone: points that it was the last to force are their own again")));
    EXPECT_EQ(gateway.name_of(a), "");
}

// Over LCM nobody knows who asks, and nobody misses a sender that has died.
TEST_F(Deeds, OverLcmNobodyEndsTheRunOrSetsAnOutputButAnybodyStops) {
    const auto lcm = gateway.open(Source::lcm, "LCM client 9", Rights::operating);
    EXPECT_EQ(does(lcm, CommandKind::shutdown), Answer::no_control);
    EXPECT_FALSE(machine.shutdown_requested);
    EXPECT_EQ(does(lcm, CommandKind::set_output, "lamp_run", 1), Answer::no_control);
    EXPECT_EQ(does(lcm, CommandKind::force, "start_button", 1), Answer::no_control);
    EXPECT_THAT(machine.submitted, IsEmpty());
    EXPECT_EQ(does(lcm, CommandKind::stop), Answer::accepted);
    EXPECT_EQ(does(a, CommandKind::shutdown), Answer::accepted);
    EXPECT_TRUE(machine.shutdown_requested);
}

TEST_F(Deeds, AHandIsOnAnAxisUntilItLetsGoOrIsGone) {
    EXPECT_EQ(gateway.hands().on(0), nullptr);
    does(a, CommandKind::enable, "x");
    ASSERT_NE(gateway.hands().on(0), nullptr);
    EXPECT_EQ(gateway.hands().on(0)->client, a);
    EXPECT_EQ(gateway.hands().on(1), nullptr);
    does(b, CommandKind::move, "x", 5, 5);
    EXPECT_EQ(gateway.hands().on(0)->client, b) << "who moved it last";
    does(a, CommandKind::disable, "x");
    EXPECT_NE(gateway.hands().on(0), nullptr) << "that was not his";
    does(request(b, CommandKind::enable, "all"));
    EXPECT_EQ(gateway.hands().on(1)->client, b);
    gateway.close(b);
    EXPECT_EQ(gateway.hands().on(0), nullptr);
    EXPECT_EQ(gateway.hands().on(1), nullptr);
}

}  // namespace
}  // namespace taktwerk::hmi

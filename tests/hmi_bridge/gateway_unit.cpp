// The rules of the one gate for commands. Issue: client, sequence, validity, acknowledgement; control authority; jog lease.
#include "hmi_bridge/gateway/gateway.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>

#include "axes/axis/alarms.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"
#include "tests/patience.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::Answer;
using runtime::OperatorAction;
using test::FakeMachine;
using testing::HasSubstr;

class GatewayTest : public testing::Test {
protected:
    GatewayTest() { gateway.observe(true); }

    CommandRequest request(CommandKind kind, std::string target = "") {
        CommandRequest r;
        r.client = client;
        r.sequence = ++sequence;
        r.kind = kind;
        r.target = std::move(target);
        return r;
    }
    CommandRequest jog(double velocity, bool press, ClientId who) {
        auto r = request(CommandKind::jog, "x");
        r.client = who;
        r.value = velocity;
        r.press = press;
        r.valid_for = 250ms;
        return r;
    }
    /// Hands the request in; the machine accepts what reaches it.
    CommandReply outcome(const CommandRequest& r, Answer verdict = Answer::accepted, axes::ErrorId error = axes::ErrorId::none,
                         axes::Owner owner = axes::Owner::none) {
        const auto before = machine.submitted.size();
        gateway.handle(r, now);
        if (machine.submitted.size() > before) machine.answer(verdict, error, owner, holder);
        gateway.step(now);
        auto reply = gateway.next_reply();
        EXPECT_TRUE(reply.has_value());
        EXPECT_FALSE(gateway.next_reply().has_value()) << "exactly one reply";
        return reply.value_or(CommandReply{});
    }

    FakeMachine machine;
    Gateway gateway{machine};
    const void* holder = nullptr;  ///< what the axis says moves it
    ClientId client = gateway.open(Source::socket, "panel A", Rights::commissioning);
    std::uint64_t sequence = 0;
    Instant now{10s};
};

TEST_F(GatewayTest, ACommandBecomesAnOperatorCommandWithItsNamesResolvedAndAnExpiry) {
    auto r = request(CommandKind::move, "y");
    r.value = 12.5;
    r.value2 = 30;
    r.valid_for = 400ms;
    r.age = 100ms;

    const auto reply = outcome(r);

    EXPECT_TRUE(reply.accepted());
    EXPECT_EQ(reply.sequence, 1u);
    ASSERT_EQ(machine.submitted.size(), 1u);
    const auto& command = machine.submitted[0];
    EXPECT_EQ(command.action, OperatorAction::move_absolute);
    EXPECT_EQ(command.axis, 1);
    EXPECT_EQ(command.value, 12.5);
    EXPECT_EQ(command.value2, 30);
    EXPECT_EQ(command.owner, axes::Owner::operator_panel);
    EXPECT_EQ(command.expires, now + 300ms) << "validity counts from when the client gave it";
}

TEST_F(GatewayTest, ARepeatedSequenceIsAnsweredAgainAndNotExecutedAgain) {
    const auto r = request(CommandKind::home, "x");
    outcome(r, Answer::refused_by_axis, axes::ErrorId::not_powered);

    gateway.handle(r, now + 5ms);

    const auto again = gateway.next_reply();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->answer, Answer::refused_by_axis);
    EXPECT_EQ(machine.submitted.size(), 1u);
}

TEST_F(GatewayTest, ARepeatWhileTheAnswerIsOnItsWayWaitsForThatAnswer) {
    const auto r = request(CommandKind::home, "x");
    gateway.handle(r, now);
    gateway.handle(r, now);
    EXPECT_FALSE(gateway.next_reply());

    machine.answer(Answer::accepted);
    gateway.step(now);

    EXPECT_TRUE(gateway.next_reply());
    EXPECT_FALSE(gateway.next_reply());
    EXPECT_EQ(machine.submitted.size(), 1u);
}

TEST_F(GatewayTest, ASequenceUsedForAnotherCommandIsRefused) {
    outcome(request(CommandKind::home, "x"));
    auto other = request(CommandKind::home, "y");
    other.sequence = 1;

    EXPECT_EQ(outcome(other).answer, Answer::duplicate);
    EXPECT_EQ(machine.submitted.size(), 1u);
}

TEST_F(GatewayTest, ASequenceThatIsForgottenOrRunsBackwardsIsNotExecuted) {
    auto first = request(CommandKind::acknowledge);
    first.sequence = 5;
    outcome(first);
    auto backwards = request(CommandKind::acknowledge);
    backwards.sequence = 4;
    EXPECT_EQ(outcome(backwards).answer, Answer::duplicate);

    sequence = 5;
    for (std::size_t i = 0; i < Gateway::remembered; ++i) outcome(request(CommandKind::acknowledge));
    const auto executed = machine.submitted.size();
    EXPECT_EQ(outcome(first).answer, Answer::duplicate);
    EXPECT_EQ(machine.submitted.size(), executed);
}

TEST_F(GatewayTest, SequencesOfDifferentClientsDoNotMeet) {
    outcome(request(CommandKind::home, "x"));
    auto r = request(CommandKind::home, "y");
    r.client = gateway.open(Source::lcm, "panel B", Rights::operating);
    r.sequence = 1;

    EXPECT_TRUE(outcome(r).accepted());
    EXPECT_EQ(machine.submitted.size(), 2u);
}

TEST_F(GatewayTest, AFullInboxRefusesAndTheSameSequenceMayTryAgain) {
    const auto r = request(CommandKind::home, "x");
    machine.inbox_size = 0;
    EXPECT_EQ(outcome(r).answer, Answer::queue_full);

    machine.inbox_size = 10;
    EXPECT_TRUE(outcome(r).accepted());
}

TEST_F(GatewayTest, ACommandOlderThanItsValidityIsStale) {
    auto r = request(CommandKind::home, "x");
    r.valid_for = 200ms;
    r.age = 201ms;

    const auto reply = outcome(r);

    EXPECT_EQ(reply.answer, Answer::stale);
    EXPECT_EQ(reply.error.code, "command.stale");
    EXPECT_EQ(reply.error.subject, "axis x");
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, ACommandFromTheFutureIsRefusedBecauseItsAgeCannotBeJudged) {
    auto r = request(CommandKind::home, "x");
    r.age = -1001ms;
    EXPECT_EQ(outcome(r).answer, Answer::stale);
    auto small = request(CommandKind::home, "x");
    small.age = -900ms;
    EXPECT_TRUE(outcome(small).accepted());
    EXPECT_EQ(machine.submitted.back().expires, now + 1s) << "no credit for a clock that is ahead";
}

TEST_F(GatewayTest, ValiditiesOutsideTheirRangeAreRefused) {
    for (const auto validity : {Duration{-1ms}, Duration{0}, Duration{10001ms}}) {
        auto r = request(CommandKind::home, "x");
        r.valid_for = validity;
        EXPECT_EQ(outcome(r).answer, Answer::bad_value) << validity.count();
    }
    auto r = jog(20, true, client);
    r.valid_for = 501ms;
    EXPECT_EQ(outcome(r).answer, Answer::bad_value) << "a jog lives shorter";
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, UnknownNamesAreRefusedWithASuggestion) {
    const auto reply = outcome(request(CommandKind::home, "turet"));

    EXPECT_EQ(reply.answer, Answer::unknown_name);
    EXPECT_THAT(reply.error.what, HasSubstr("turet"));
    EXPECT_THAT(reply.error.remedy, HasSubstr("'turret'"));
    EXPECT_EQ(outcome(request(CommandKind::program_start, "cel")).answer, Answer::unknown_name);
    EXPECT_EQ(outcome(request(CommandKind::home, "")).answer, Answer::unknown_name);
    EXPECT_EQ(outcome(request(CommandKind::home, "all")).answer, Answer::unknown_name) << "axes are homed one by one";
    EXPECT_EQ(outcome(request(static_cast<CommandKind>(99))).answer, Answer::unknown_name);
    EXPECT_EQ(outcome(request(static_cast<CommandKind>(-1))).answer, Answer::unknown_name);
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, StopAndResetWithoutANameMeanAll) {
    outcome(request(CommandKind::stop));
    outcome(request(CommandKind::reset));
    outcome(request(CommandKind::enable, "all"));

    EXPECT_THAT(machine.stops, testing::ElementsAre(0xFFFF));
    ASSERT_EQ(machine.submitted.size(), 2u);
    for (const auto& command : machine.submitted) EXPECT_EQ(command.axis, 0xFFFF);
    EXPECT_TRUE(machine.submitted[1].flag);
    EXPECT_EQ(outcome(request(CommandKind::enable, "")).answer, Answer::unknown_name) << "power for all must be said";
}

TEST_F(GatewayTest, AParameterIsFoundByItsNameAloneOnlyWhenThatIsUnique) {
    auto speed = request(CommandKind::set_parameter, "speed");
    speed.value = 300;
    EXPECT_TRUE(outcome(speed).accepted());
    EXPECT_EQ(machine.submitted[0].index, 0);

    auto pause = request(CommandKind::set_parameter, "pause");
    pause.value = 1;
    const auto reply = outcome(pause);
    EXPECT_EQ(reply.answer, Answer::unknown_name);
    EXPECT_THAT(reply.error.remedy, HasSubstr("'feeder.pause'"));

    pause = request(CommandKind::set_parameter, "feeder.pause");
    pause.value = 8;
    EXPECT_TRUE(outcome(pause).accepted());
    EXPECT_EQ(machine.submitted[1].index, 2);
}

TEST_F(GatewayTest, ValuesOutsideTheirRangeAreRefusedWithTheRange) {
    const auto nan = std::numeric_limits<double>::quiet_NaN();
    const auto infinity = std::numeric_limits<double>::infinity();
    auto speed = request(CommandKind::set_parameter, "speed");
    speed.value = 500.1;
    const auto reply = outcome(speed);
    EXPECT_EQ(reply.answer, Answer::bad_value);
    EXPECT_EQ(reply.error.subject, "parameter cell.speed");
    EXPECT_THAT(reply.error.remedy, HasSubstr("10 to 500 mm/s"));

    for (const double value : {nan, infinity, -infinity, 9.9}) {
        speed = request(CommandKind::set_parameter, "speed");
        speed.value = value;
        EXPECT_EQ(outcome(speed).answer, Answer::bad_value) << value;
    }
    for (const double velocity : {nan, infinity, 50.1, -50.1, 0.0})
        EXPECT_EQ(outcome(jog(velocity, true, client)).answer, Answer::bad_value) << velocity;
    for (const double velocity : {nan, infinity, 0.0, -1.0}) {
        auto move = request(CommandKind::move, "x");
        move.value2 = velocity;
        EXPECT_EQ(outcome(move).answer, Answer::bad_value) << velocity;
    }
    auto lamp = request(CommandKind::set_output, "lamp_run");
    lamp.value = 0.5;
    EXPECT_EQ(outcome(lamp).answer, Answer::bad_value);
    auto mode = request(CommandKind::mode);
    mode.mode = static_cast<runtime::Mode>(7);
    EXPECT_EQ(outcome(mode).answer, Answer::bad_value);
    EXPECT_TRUE(machine.submitted.empty());
}

// An output with a unit takes any number of it; how far it goes the machine knows, and what is beyond is not called a broken number.
TEST_F(GatewayTest, AnOutputWithAUnitTakesAnyNumberThatItsChannelGives) {
    machine.its_layout.outputs = {"lamp_run", "valve"};
    machine.its_layout.output_units = {"", "%"};
    auto valve = request(CommandKind::set_output, "valve");
    valve.value = 12.5;
    EXPECT_TRUE(outcome(valve).accepted());
    ASSERT_EQ(machine.submitted.size(), 1u);
    EXPECT_EQ(machine.submitted[0].value, 12.5);
    auto beyond = request(CommandKind::set_output, "valve");
    beyond.value = 1e308;
    const auto refused = outcome(beyond, Answer::bad_value);
    EXPECT_EQ(refused.error.what, "the value is beyond what its channel gives");
    EXPECT_THAT(refused.error.remedy, HasSubstr("`scale`"));
    auto lamp = request(CommandKind::set_output, "lamp_run");
    lamp.value = 0.5;
    EXPECT_EQ(outcome(lamp).answer, Answer::bad_value);
}

TEST_F(GatewayTest, RefusalsOfTheMachineComeBackInWords) {
    const auto owned = outcome(request(CommandKind::home, "x"), Answer::no_control, axes::ErrorId::owned_by_other, axes::Owner::program);
    EXPECT_EQ(owned.error.code, "command.no_control");
    EXPECT_THAT(owned.error.what, HasSubstr("a program has control"));
    EXPECT_THAT(owned.error.remedy, HasSubstr("manual mode"));

    const std::byte pick{};
    machine.its_layout.blocks = {{"cell.pick", &pick, 1}};
    holder = &pick;
    const auto moved = outcome(request(CommandKind::home, "x"), Answer::no_control, axes::ErrorId::owned_by_other, axes::Owner::program);
    EXPECT_THAT(moved.error.what, HasSubstr("'cell.pick' moves or holds the axis")) << "who blocks";
    holder = nullptr;

    const auto refused = outcome(request(CommandKind::home, "x"), Answer::refused_by_axis, axes::ErrorId::not_powered);
    EXPECT_EQ(refused.error.subject, "axis x");
    EXPECT_THAT(refused.error.what, HasSubstr("The axis is disabled"));
    EXPECT_THAT(refused.error.what, HasSubstr("power stage is off")) << "the cause is missing";
    EXPECT_EQ(refused.error.remedy, "Enable it: `taktwerk enable x`.") << "a person at the machine has no MC_Power";
    EXPECT_EQ(refused.error.what.find("MC_"), std::string::npos) << refused.error.what;

    for (const auto answer : {Answer::unknown_name, Answer::bad_value, Answer::stale, Answer::wrong_mode, Answer::not_possible_now,
                              Answer::queue_full, Answer::duplicate}) {
        const auto reply = outcome(request(CommandKind::home, "x"), answer);
        EXPECT_FALSE(reply.error.what.empty());
        EXPECT_FALSE(reply.error.remedy.empty());
    }
}

TEST_F(GatewayTest, CommissioningIsForClientsWithThatRight) {
    auto r = request(CommandKind::take_control, "x");
    r.commissioning = true;
    EXPECT_TRUE(outcome(r).accepted());
    EXPECT_EQ(machine.submitted[0].owner, axes::Owner::commissioning);

    r = request(CommandKind::take_control, "x");
    r.commissioning = true;
    r.client = gateway.open(Source::lcm, "panel B", Rights::operating);
    EXPECT_EQ(outcome(r).answer, Answer::no_control);
    EXPECT_EQ(machine.submitted.size(), 1u);
}

TEST_F(GatewayTest, WithoutAnAnswerOfTheCycleTheClientIsTold) {
    gateway.handle(request(CommandKind::home, "x"), now);
    gateway.step(now + Gateway::answer_patience);
    EXPECT_FALSE(gateway.next_reply());

    gateway.step(now + Gateway::answer_patience + 1ms);

    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->error.code, "command.no_answer");
}

TEST_F(GatewayTest, BeforeTheFirstCycleOnlyStopAndShutdownAreTaken) {
    gateway.observe(false);
    EXPECT_TRUE(outcome(request(CommandKind::stop)).accepted());
    EXPECT_EQ(outcome(request(CommandKind::home, "x")).answer, Answer::not_possible_now);
    EXPECT_TRUE(outcome(request(CommandKind::shutdown)).accepted());
    EXPECT_TRUE(machine.shutdown_requested);
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, ShutdownGetsThroughAFullInbox) {
    machine.inbox_size = 0;
    EXPECT_TRUE(outcome(request(CommandKind::shutdown)).accepted());
    EXPECT_TRUE(machine.shutdown_requested);
}

TEST_F(GatewayTest, AJogIsPressedAndRenewedByTheSameClient) {
    EXPECT_TRUE(outcome(jog(20, true, client)).accepted());
    EXPECT_TRUE(machine.submitted.back().flag);
    now += 50ms;
    EXPECT_TRUE(outcome(jog(20, false, client)).accepted());
    EXPECT_FALSE(machine.submitted.back().flag);
    now += 50ms;
    EXPECT_TRUE(outcome(jog(0, false, client)).accepted());
    now += 50ms;
    EXPECT_THAT(machine.releases, testing::ElementsAre(0));
    EXPECT_EQ(outcome(jog(20, false, client)).answer, Answer::stale) << "after letting go a renewal moves nothing";
    EXPECT_EQ(machine.submitted.size(), 2u);
}

TEST_F(GatewayTest, AMeasurementIsHeldAsAJogIsAndBindsItsAxis) {
    auto measure = [&](bool press, ClientId who) {
        auto r = request(CommandKind::measure, "x");
        r.client = who;
        r.press = press;
        r.measure.kind = axes::MeasureKind::step;
        r.measure.distance = 12;
        r.valid_for = 250ms;
        return r;
    };
    EXPECT_EQ(outcome(measure(false, client)).answer, Answer::stale) << "a renewal begins nothing";
    EXPECT_TRUE(outcome(measure(true, client)).accepted());
    EXPECT_TRUE(machine.submitted.back().flag);
    EXPECT_EQ(machine.submitted.back().measure.distance, 12);
    now += 50ms;
    EXPECT_TRUE(outcome(measure(false, client)).accepted());
    EXPECT_FALSE(machine.submitted.back().flag);
    const auto other = gateway.open(Source::socket, "panel B", Rights::commissioning);
    EXPECT_EQ(outcome(measure(true, other)).answer, Answer::no_control);
    EXPECT_EQ(outcome(jog(20, true, other)).answer, Answer::no_control);
    auto late = measure(true, client);
    late.valid_for = 600ms;
    EXPECT_EQ(outcome(late).answer, Answer::bad_value) << "it lives as short as a jog";
    const auto wire = gateway.open(Source::lcm, "somebody", Rights::operating);
    EXPECT_EQ(outcome(measure(true, wire)).answer, Answer::no_control) << "over LCM nobody lets go";
    gateway.close(client);
    EXPECT_THAT(machine.releases, testing::ElementsAre(0));
}

TEST_F(GatewayTest, ARenewalWithoutAPressMovesNothing) {
    EXPECT_EQ(outcome(jog(20, false, client)).answer, Answer::stale);
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, AJogThatWasSilentTooLongNeedsANewPress) {
    outcome(jog(20, true, client));
    now += Gateway::jog_session + 1ms;
    EXPECT_EQ(outcome(jog(20, false, client)).answer, Answer::stale);
    EXPECT_TRUE(outcome(jog(20, true, client)).accepted());
}

TEST_F(GatewayTest, AJogWhoseLeaseRanOutInTheCycleNeedsANewPress) {
    outcome(jog(20, true, client));
    const auto late = outcome(jog(20, false, client), Answer::stale);
    EXPECT_THAT(late.error.what, HasSubstr("lease ran out"));
    const auto count = machine.submitted.size();

    EXPECT_EQ(outcome(jog(20, false, client)).answer, Answer::stale);

    EXPECT_EQ(machine.submitted.size(), count) << "the gateway does not even ask";
}

TEST_F(GatewayTest, OnlyOneClientJogsAnAxisAtATime) {
    outcome(jog(20, true, client));
    const auto other = gateway.open(Source::lcm, "panel B", Rights::operating);

    const auto refused = outcome(jog(-20, true, other));
    EXPECT_EQ(refused.answer, Answer::no_control);
    EXPECT_THAT(refused.error.what, HasSubstr("panel A"));

    outcome(jog(0, false, client));
    EXPECT_TRUE(outcome(jog(-20, true, other)).accepted());
}

TEST_F(GatewayTest, AClientThatClosesWhileJoggingStopsItsAxis) {
    outcome(jog(20, true, client));

    gateway.close(client);

    EXPECT_THAT(machine.releases, testing::ElementsAre(0));
    gateway.close(client);
    EXPECT_EQ(machine.releases.size(), 1u) << "once";
}

// --- what nothing may hold up ---------------------------------------------------------------------------------------------------------

TEST_F(GatewayTest, NoAgeNoValidityNoQueueAndNoSequenceRefusesAStopOrAShutdown) {
    for (std::size_t i = 0; i < Gateway::remembered; ++i) gateway.handle(request(CommandKind::acknowledge), now);
    machine.inbox_size = 0;
    for (const auto kind : {CommandKind::stop, CommandKind::shutdown}) {
        auto r = request(kind, kind == CommandKind::stop ? "y" : "");
        for (const Duration age : {Duration{1500ms}, Duration{-24h}}) {
            r.age = age;
            r.valid_for = Duration{};
            r.sequence = age > Duration{} ? 1 : 0;  // used before, and none at all
            gateway.handle(r, now);
            gateway.step(now);
            const auto reply = gateway.next_reply();
            ASSERT_TRUE(reply);
            EXPECT_TRUE(reply->accepted()) << reply->error.text();
        }
    }
    EXPECT_THAT(machine.stops, testing::ElementsAre(1, 1));
    EXPECT_TRUE(machine.shutdown_requested);
    EXPECT_EQ(outcome(request(CommandKind::stop, "turet")).answer, Answer::unknown_name);
}

TEST_F(GatewayTest, AStopIsAnsweredOnceTheCycleHasTakenIt) {
    machine.takes_levels = false;
    gateway.handle(request(CommandKind::stop), now);
    gateway.step(now);
    EXPECT_FALSE(gateway.next_reply());
    machine.stuck_words = "task 'main' of program 'cell' does not return";
    gateway.step(now + Gateway::answer_patience + 1ms);
    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->error.code, "command.no_answer");
    EXPECT_THAT(reply->error.what, HasSubstr("'main'"));
    machine.takes_levels = true;
    EXPECT_TRUE(outcome(request(CommandKind::stop)).accepted());
}

TEST_F(GatewayTest, WhileAClientHoldsAJogNobodyElseMovesOrHomesThatAxis) {
    outcome(jog(20, true, client));
    const auto other = gateway.open(Source::socket, "panel B", Rights::commissioning);
    auto home = request(CommandKind::home, "x");
    auto move = request(CommandKind::move, "x");
    auto elsewhere = request(CommandKind::move, "y");
    for (auto* r : {&home, &move, &elsewhere}) r->client = other;
    move.value2 = elsewhere.value2 = 140;
    for (auto* r : {&home, &move}) {
        const auto refused = outcome(*r);
        EXPECT_EQ(refused.answer, Answer::no_control);
        EXPECT_THAT(refused.error.what, HasSubstr("panel A"));
    }
    EXPECT_TRUE(outcome(elsewhere).accepted());
    outcome(jog(0, false, client));
    move.sequence = ++sequence;
    EXPECT_TRUE(outcome(move).accepted());
}

TEST_F(GatewayTest, AJogIsLetGoAlthoughEverythingIsFullAndItsWordsAreOld) {
    outcome(jog(20, true, client));
    for (std::size_t i = 0; i < Gateway::remembered; ++i) gateway.handle(request(CommandKind::acknowledge), now);
    machine.inbox_size = 0;
    auto r = jog(0, false, client);
    r.age = 24h;
    gateway.handle(r, now);
    EXPECT_THAT(machine.releases, testing::ElementsAre(0));
}

TEST_F(GatewayTest, ALetGoOfWhoHoldsNothingStopsNobody) {
    outcome(jog(20, true, client));
    const auto other = gateway.open(Source::socket, "panel B", Rights::commissioning);
    EXPECT_TRUE(outcome(jog(0, false, other)).accepted());
    EXPECT_TRUE(machine.releases.empty());
}

TEST_F(GatewayTest, ACommandThatHasWaitedHereIsAsOldAsThat) {
    auto r = request(CommandKind::move, "x");
    r.value2 = 10;
    r.arrival.at = now - 20s;
    EXPECT_EQ(outcome(r).answer, Answer::stale) << "it says not when it was sent";
    r.sequence = ++sequence;
    r.arrival.at = now - 300ms;
    EXPECT_TRUE(outcome(r).accepted());
    EXPECT_EQ(machine.submitted.back().expires, now + 700ms);
}

TEST_F(GatewayTest, WhileTheCycleStandsNothingIsTakenThatWouldStartLater) {
    machine.stuck_words = "task 'main' of program 'cell' does not return";
    const auto refused = outcome(request(CommandKind::home, "x"));
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_THAT(refused.error.what, HasSubstr("'main'"));
    EXPECT_TRUE(machine.submitted.empty());
}

TEST_F(GatewayTest, AnswersToAClosedClientAreDropped) {
    const ClientId other = gateway.open(Source::socket, "panel B", Rights::commissioning);
    auto from_other = request(CommandKind::home, "y");
    from_other.client = other;
    gateway.handle(request(CommandKind::home, "x"), now);
    machine.answer(Answer::accepted);
    gateway.handle(from_other, now);
    machine.answer(Answer::accepted);
    gateway.close(client);
    gateway.step(now);
    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply) << "who is still there gets his";
    EXPECT_EQ(reply->client, other);
    EXPECT_FALSE(gateway.next_reply());
}

TEST_F(GatewayTest, ClientsAreBounded) {
    ClientId last = client;
    for (Patience patience; patience.lasts(gateway.client_count() < Gateway::max_clients);)
        last = gateway.open(Source::lcm, "flood", Rights::operating);
    EXPECT_EQ(gateway.open(Source::lcm, "flood", Rights::operating), 0u);
    gateway.close(last);
    EXPECT_NE(gateway.open(Source::lcm, "flood", Rights::operating), 0u);
}

TEST_F(GatewayTest, TooManyCommandsInFlightAreRefusedWithoutForgettingOne) {
    for (std::size_t i = 0; i < Gateway::remembered; ++i) gateway.handle(request(CommandKind::acknowledge), now);
    gateway.handle(request(CommandKind::acknowledge), now);

    const auto reply = gateway.next_reply();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->answer, Answer::queue_full);
    EXPECT_EQ(machine.submitted.size(), Gateway::remembered);
}

// --- a hand on a group ----------------------------------------------------------------------------------------------------------

class GroupJogTest : public GatewayTest {
protected:
    CommandRequest group_jog(const std::string& direction, double velocity, bool press, std::optional<ClientId> who = {}) {
        auto r = request(CommandKind::group_jog, "table");
        r.client = who.value_or(client);
        r.value = velocity;
        r.press = press;
        r.valid_for = 250ms;
        r.group_jog.direction = direction;
        return r;
    }
};

// Which way becomes slots: X is slot 0 of the machine's directions, the second axis slot 1 of its own; a distance goes with it.
TEST_F(GroupJogTest, WordsBecomeSlots) {
    auto r = group_jog("y- x+", 0.25, true);
    r.group_jog.distance = 5;
    ASSERT_TRUE(outcome(r).accepted());
    const auto& command = machine.submitted.back();
    EXPECT_EQ(command.action, runtime::OperatorAction::group_jog);
    EXPECT_EQ(command.index, 0);
    EXPECT_TRUE(command.flag);
    EXPECT_EQ(command.value, 0.25);
    EXPECT_EQ(command.value2, 5);
    EXPECT_EQ(command.group_jog.frame, axes::mcMCS);
    EXPECT_EQ(command.group_jog.plus, 1u << 0);
    EXPECT_EQ(command.group_jog.minus, 1u << 1);
    r = group_jog("y+", 1, true);
    r.group_jog.frame = "acs";
    ASSERT_TRUE(outcome(r).accepted());
    EXPECT_EQ(machine.submitted.back().group_jog, (runtime::GroupJogOrder{axes::mcACS, 1u << 1, 0}));
}

// One hand has the whole group: nobody else jogs it, or moves or homes an axis of it; and who jogs one of its axes keeps the group from others.
TEST_F(GroupJogTest, WhoJogsAGroupJogsAllOfItsAxes) {
    const auto other = gateway.open(Source::socket, "panel B", Rights::operating);
    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    auto move = request(CommandKind::move, "y");
    move.client = other;
    move.value2 = 10;
    auto home = request(CommandKind::home, "x");
    home.client = other;
    for (const auto& r : {move, home, jog(20, true, other), group_jog("x+", 1, true, other), group_jog("x+", 1, false, other)}) {
        const auto refused = outcome(r);
        EXPECT_EQ(refused.answer, Answer::no_control);
        EXPECT_THAT(refused.error.what, HasSubstr("panel A"));
    }
    ASSERT_TRUE(outcome(group_jog("x+", 1, false)).accepted()) << "its own renewal";
    EXPECT_TRUE(outcome(group_jog("", 0, false, other)).accepted()) << "letting go of nothing is no error";
    EXPECT_THAT(machine.releases, testing::IsEmpty());

    EXPECT_TRUE(outcome(group_jog("", 0, false)).accepted());
    EXPECT_THAT(machine.releases, testing::ElementsAre(0, 1));
    EXPECT_EQ(outcome(group_jog("x+", 1, false)).answer, Answer::stale) << "after letting go a renewal moves nothing";
    ASSERT_TRUE(outcome(jog(20, true, other)).accepted());
    const auto refused = outcome(group_jog("y+", 1, true));
    EXPECT_EQ(refused.answer, Answer::no_control);
    EXPECT_THAT(refused.error.what, HasSubstr("panel B is jogging or measuring axis x"));
}

TEST_F(GroupJogTest, AClientThatClosesLetsGoOfTheWholeGroup) {
    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    gateway.close(client);
    EXPECT_THAT(machine.releases, testing::ElementsAre(0, 1));
}

// Its renewal in the cycle has failed: the hold is over here, too, and another client may press.
TEST_F(GroupJogTest, ARefusedRenewalEndsTheHold) {
    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    const auto limit = outcome(group_jog("x+", 1, false), Answer::refused_by_axis, axes::ErrorId::beyond_software_limit);
    EXPECT_THAT(limit.error.what, HasSubstr("as far as its axes may"));
    EXPECT_EQ(outcome(group_jog("x+", 1, false)).answer, Answer::stale);
    const auto other = gateway.open(Source::socket, "panel B", Rights::operating);
    EXPECT_TRUE(outcome(group_jog("x-", 1, true, other)).accepted());
}

// What has ended it may be an alarm of an axis: that is named with cause and remedy, and is no number.
TEST_F(GroupJogTest, AnAlarmThatEndedItIsNamed) {
    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    const auto fault = static_cast<axes::ErrorId>(axes::id(axes::AxisAlarm::drive_fault));
    const auto ended = outcome(group_jog("x+", 1, false), Answer::refused_by_axis, fault);
    EXPECT_THAT(ended.error.what, HasSubstr("alarm 'drive_fault' has ended it: See the drive's alarm list"));
    EXPECT_THAT(ended.error.remedy, HasSubstr("Remove the cause named by the drive's alarm text, then reset"));
    ASSERT_TRUE(outcome(jog(20, true, client)).accepted());
    EXPECT_THAT(outcome(jog(20, false, client), Answer::refused_by_axis, fault).error.what, HasSubstr("its alarm 'drive_fault'"));
}

// Nobody is known over LCM, and nobody is missed: no jog of a group from there. It lives as short as a jog of an axis.
TEST_F(GroupJogTest, NotOverLcmAndNotForLong) {
    const auto lcm = gateway.open(Source::lcm, "LCM", Rights::operating);
    const auto refused = outcome(group_jog("x+", 1, true, lcm));
    EXPECT_EQ(refused.answer, Answer::no_control);
    EXPECT_THAT(refused.error.remedy, HasSubstr("local socket"));
    auto late = group_jog("x+", 1, true);
    late.valid_for = 1s;
    EXPECT_EQ(outcome(late).answer, Answer::bad_value);
    auto old = group_jog("x+", 1, true);
    old.age = 300ms;
    EXPECT_EQ(outcome(old).answer, Answer::stale);
    auto release = group_jog("", 0, false);
    release.age = 10s;
    EXPECT_TRUE(outcome(release).accepted()) << "letting go is never too late";
    EXPECT_EQ(outcome(group_jog("x+", 0, true)).answer, Answer::bad_value) << "a press at 0";
}

// A second key under the same hand that is refused ends nothing: the first one is renewed and let go as before, by whichever name it was pressed.
TEST_F(GroupJogTest, ARefusedSecondKeyLeavesTheFirstHeld) {
    ASSERT_TRUE(outcome(jog(20, true, client)).accepted());
    EXPECT_FALSE(outcome(group_jog("y+", 1, true), Answer::refused_by_axis, axes::ErrorId::not_at_standstill).accepted());
    EXPECT_TRUE(outcome(jog(20, false, client)).accepted()) << "its renewal";
    const auto other = gateway.open(Source::socket, "panel B", Rights::operating);
    EXPECT_EQ(outcome(jog(20, true, other)).answer, Answer::no_control) << "and nobody else has it";
    EXPECT_TRUE(outcome(jog(0, false, client)).accepted());
    EXPECT_THAT(machine.releases, testing::ElementsAre(0));

    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    EXPECT_FALSE(outcome(jog(20, true, client), Answer::refused_by_axis, axes::ErrorId::axis_grouped).accepted());
    EXPECT_TRUE(outcome(group_jog("x+", 1, false)).accepted());
    EXPECT_TRUE(outcome(group_jog("", 0, false)).accepted());
    EXPECT_THAT(machine.releases, testing::ElementsAre(0, 0, 1));
}

// A key that nobody let go of, and that is long over, is in nobody's way: the next one is held as any.
TEST_F(GroupJogTest, AForgottenKeyIsInNobodysWay) {
    for (const auto later : {Gateway::jog_session + 100ms, Gateway::jog_session - 50ms}) {
        ASSERT_TRUE(outcome(jog(20, true, client)).accepted());
        now += later;
        ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
        now += 100ms;
        EXPECT_TRUE(outcome(group_jog("x+", 1, false)).accepted());
        EXPECT_TRUE(outcome(group_jog("", 0, false)).accepted());
    }
}

// A renewal with a value that is none changes nothing in the cycle: the hold stands, and letting go is heard. Nor is it told as a number out of its range.
TEST_F(GroupJogTest, ARenewalWithAnotherDistanceCanStillBeLetGo) {
    ASSERT_TRUE(outcome(group_jog("x+", 1, true)).accepted());
    const auto other = outcome(group_jog("x+", 1, false), Answer::bad_value);
    EXPECT_THAT(other.error.what, HasSubstr("another frame or distance"));
    EXPECT_TRUE(outcome(group_jog("", 0, false)).accepted());
    EXPECT_THAT(machine.releases, testing::ElementsAre(0, 1));
}

// A group without an arm has its axes alone, and one whose axes a program gives nobody can hold as a whole.
TEST_F(GroupJogTest, WhatAGroupCannotDoIsSaid) {
    machine.its_layout.groups[0].arm = false;
    const auto no_arm = outcome(group_jog("x+", 1, true));
    EXPECT_EQ(no_arm.answer, Answer::bad_value);
    EXPECT_THAT(no_arm.error.remedy, HasSubstr("acs"));
    machine.its_layout.groups[0].arm = true;
    EXPECT_THAT(outcome(group_jog("rz+", 1, true)).error.what, HasSubstr("does not turn its tool"));
    EXPECT_THAT(outcome(group_jog("xx+", 1, true)).error.remedy, HasSubstr("\"x+\""));
    // An axis' name where directions of the tool are asked for, and the other way round: which frame it wants is said.
    machine.its_layout.axes[1].name = "lift";
    EXPECT_THAT(outcome(group_jog("lift+", 1, true)).error.remedy, HasSubstr("\"lift\" is an axis of it: those are jogged in frame acs"));
    auto in_axes = group_jog("z+", 1, true);
    in_axes.group_jog.frame = "acs";
    EXPECT_THAT(outcome(in_axes).error.remedy, HasSubstr("\"z\" is a direction of its tool"));
    machine.its_layout.groups[0].members.clear();
    const auto empty = outcome(group_jog("x+", 1, true));
    EXPECT_EQ(empty.answer, Answer::not_possible_now);
    EXPECT_THAT(empty.error.what, HasSubstr("no axes"));
}

}  // namespace
}  // namespace taktwerk::hmi

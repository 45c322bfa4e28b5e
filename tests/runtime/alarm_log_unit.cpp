// The alarm list: how an alarm goes away by its rule (core/alarm.hpp, ResetRule), and what happens when the list is full.

#include "runtime/machine/alarm_log.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "runtime/alarms.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;

constexpr AlarmFact fact(AlarmId id, std::uint16_t index = 0) { return {id, AlarmSource::axis, index, 1, 2}; }

struct Log : ::testing::Test {
    AlarmLog log;
    Instant now{};

    /// One cycle in which exactly these hold.
    void cycle(std::vector<AlarmFact> holding, ResetRule rule = ResetRule::self_clearing, Reaction reaction = Reaction::warn) {
        now += 1ms;
        log.begin_cycle();
        for (const auto& f : holding) log.raise(f, reaction, rule, now);
        log.end_cycle(now);
    }
};

TEST_F(Log, ASelfClearingAlarmGoesWithItsCause) {
    cycle({fact(1)});
    ASSERT_EQ(log.alarms().size(), 1u);
    EXPECT_TRUE(log.alarms()[0].standing);
    cycle({});
    EXPECT_TRUE(log.alarms().empty());
}

// Who looks now and then would not know that it was there.
TEST_F(Log, OneThatGoesAtOnceIsKeptAmongThosePassed) {
    cycle({fact(1)});
    EXPECT_EQ(log.passed().noted(), 0u) << "it still holds";
    cycle({});
    ASSERT_EQ(log.passed().noted(), 1u);
    const auto& passed = log.passed().at(0);
    EXPECT_EQ(passed.fact.id, 1);
    EXPECT_EQ(passed.reaction, Reaction::warn);
    EXPECT_EQ(passed.gone - passed.since, 1ms);

    cycle({fact(2)});
    now += PassedAlarms::moment;
    cycle({fact(2)});
    cycle({});
    EXPECT_EQ(log.passed().noted(), 1u) << "everybody has seen it";

    for (std::uint16_t i = 0; i < PassedAlarms::capacity + 2; ++i) {
        cycle({fact(3, i)});
        cycle({});
    }
    EXPECT_EQ(log.passed().noted(), 1 + PassedAlarms::capacity + 2);
    EXPECT_EQ(log.passed().oldest(), 3u);
    EXPECT_EQ(log.passed().at(log.passed().oldest()).fact.index, 2);
}

// Three snapshots in turn follow the list, each after two others: at any time each is what the list was then.
TEST(Passed, CopiesFollowWhatCameMeanwhile) {
    PassedAlarms all;
    std::array<PassedAlarms, 3> copies;
    std::uint16_t number = 0;
    for (std::size_t round = 0; round < 600; ++round) {
        const auto come = round % 50 == 49 ? PassedAlarms::capacity * 3 / 2 : round % 4;
        for (std::size_t i = 0; i < come; ++i, ++number) all.note({fact(1, number), Reaction::warn, Instant{}, Instant{}});
        auto& copy = copies[round % copies.size()];
        copy.follow(all);
        ASSERT_EQ(copy.noted(), number);
        ASSERT_EQ(copy.oldest(), all.oldest());
        for (auto at = copy.oldest(); at < copy.noted(); ++at) ASSERT_EQ(copy.at(at).fact.index, static_cast<std::uint16_t>(at)) << round;
    }
}

// Slaves are named some milliseconds later, axes stop in the next cycle: what a person reads first is what it came from.
TEST_F(Log, CausesStandBeforeWhatFollowsFromThem) {
    const AlarmFact axis{0x3002, AlarmSource::axis, 0, 0, 0}, stopped{0x3010, AlarmSource::axis, 1, 0, 0};
    const AlarmFact slave{0x1012, AlarmSource::slave, 2, 0, 0}, bus{0x1030, AlarmSource::bus, 0, 0, 0};
    cycle({stopped});
    cycle({stopped, axis});
    cycle({stopped, axis, slave});
    cycle({stopped, axis, slave, bus});
    std::vector<AlarmId> ids;
    for (const auto& alarm : log.alarms()) ids.push_back(alarm.fact.id);
    EXPECT_EQ(ids, (std::vector<AlarmId>{0x1030, 0x1012, 0x3002, 0x3010}));
    cycle({stopped, axis, slave});
    EXPECT_EQ(log.alarms().size(), 3u) << "the rules moved with their alarms";
    EXPECT_EQ(log.alarms()[0].fact.id, 0x1012);

    now += 1s;  // another event: it comes behind
    cycle({stopped, axis, slave, bus});
    EXPECT_EQ(log.alarms().back().fact.id, 0x1030);
}

TEST_F(Log, AnAcknowledgedOneStaysWhileItHoldsAndWantsAnotherAcknowledgementWhenItIsOver) {
    cycle({fact(1)}, ResetRule::acknowledge);
    log.acknowledge();
    cycle({fact(1)}, ResetRule::acknowledge);
    ASSERT_EQ(log.alarms().size(), 1u);
    EXPECT_TRUE(log.alarms()[0].acknowledged) << "somebody has seen it";

    cycle({});
    ASSERT_EQ(log.alarms().size(), 1u) << "the acknowledgement was given while it held";
    EXPECT_FALSE(log.alarms()[0].standing);
    EXPECT_FALSE(log.alarms()[0].acknowledged);

    log.acknowledge();
    cycle({});
    EXPECT_TRUE(log.alarms().empty());
}

// A slave fell silent, and then it is known that another device stands there: one trouble, one alarm.
TEST_F(Log, WhatIsKnownBetterTakesThePlaceOfWhatWasSaidBefore) {
    const auto of_slave = [](AlarmId id, std::uint16_t slave, double reason = 0) {
        return AlarmFact{id, AlarmSource::slave, slave, reason, 0};
    };
    cycle({of_slave(1, 5), of_slave(1, 6), of_slave(1, 7, 4)}, ResetRule::acknowledge);
    cycle({of_slave(2, 5), of_slave(1, 6)}, ResetRule::acknowledge);
    log.withdraw(1, of_slave(2, 5));
    ASSERT_EQ(log.alarms().size(), 3u) << "its own, although nobody has acknowledged it";
    log.withdraw(1, of_slave(2, 6));
    EXPECT_EQ(log.alarms().size(), 3u) << "what holds stays";
    cycle({}, ResetRule::acknowledge);
    log.begin_cycle();
    log.withdraw(1, {3, AlarmSource::bus, 0, 0, 0});
    log.end_cycle(now);
    ASSERT_EQ(log.alarms().size(), 2u) << "the bus speaks for all";
    EXPECT_EQ(log.alarms()[0].fact.index, 7) << "that one has a reason of its own";
    EXPECT_EQ(log.alarms()[1].fact.id, 2);
}

TEST_F(Log, AResetAlarmNeedsAResetAfterTheCauseIsGone) {
    cycle({fact(1)}, ResetRule::reset);
    log.reset();
    cycle({fact(1)}, ResetRule::reset);
    cycle({});
    ASSERT_EQ(log.alarms().size(), 1u) << "the reset came while it held: it is none";
    log.acknowledge();
    cycle({});
    ASSERT_EQ(log.alarms().size(), 1u) << "an acknowledgement is no reset";
    log.reset();
    cycle({});
    EXPECT_TRUE(log.alarms().empty());
}

TEST_F(Log, AResetAlsoAcknowledges) {
    cycle({fact(1)}, ResetRule::acknowledge);
    cycle({});
    cycle({});
    ASSERT_EQ(log.alarms().size(), 1u) << "it waits for somebody";
    log.reset();
    cycle({});
    EXPECT_TRUE(log.alarms().empty());
}

TEST_F(Log, ARestartAlarmStaysAndReactsUntilTheEnd) {
    cycle({fact(1)}, ResetRule::restart, Reaction::stop_machine);
    cycle({});
    log.reset();
    cycle({});
    ASSERT_EQ(log.alarms().size(), 1u);
    EXPECT_EQ(log.strongest(), Reaction::stop_machine);
}

TEST_F(Log, AnAlarmThatComesAgainIsCountedAndKeepsItsPlace) {
    cycle({fact(1), fact(2)}, ResetRule::reset);
    cycle({fact(2)}, ResetRule::reset);
    cycle({fact(1), fact(2)}, ResetRule::reset);
    ASSERT_EQ(log.alarms().size(), 2u);
    EXPECT_EQ(log.alarms()[0].fact.id, 1);
    EXPECT_EQ(log.alarms()[0].count, 2u);
    EXPECT_EQ(log.alarms()[1].count, 1u);
}

TEST_F(Log, TheSameConditionOfTwoAxesIsTwoAlarmsInOrderOfAppearance) {
    cycle({fact(1, 3)});
    cycle({fact(1, 0), fact(1, 3)});
    ASSERT_EQ(log.alarms().size(), 2u);
    EXPECT_EQ(log.alarms()[0].fact.index, 3);
    EXPECT_EQ(log.alarms()[1].fact.index, 0);
}

TEST_F(Log, WhatWaitsForAPersonReactsOn) {
    cycle({fact(1)}, ResetRule::acknowledge, Reaction::power_off);
    cycle({});
    EXPECT_EQ(log.strongest(), Reaction::power_off);
}

std::vector<AlarmFact> many(std::size_t count) {
    std::vector<AlarmFact> facts;
    for (std::size_t i = 0; i < count; ++i) facts.push_back(fact(1, static_cast<std::uint16_t>(i)));
    return facts;
}

// 64 places, one of them kept for the announcement.
TEST_F(Log, AFullListSaysSoAndHowManyFoundNoPlace) {
    cycle(many(66));
    ASSERT_EQ(log.alarms().size(), AlarmLog::capacity);
    const auto& last = log.alarms().back();
    EXPECT_EQ(last.fact.id, id(MachineAlarm::alarm_log_full));
    EXPECT_EQ(last.fact.a, 3.0);
    EXPECT_EQ(log.dropped(), 3u);

    cycle(many(10));
    EXPECT_EQ(log.alarms().size(), 10u) << "there is room again, the announcement goes";
    EXPECT_EQ(log.dropped(), 0u);
}

TEST_F(Log, AFullListOfWarningsDoesNotHideAReaction) {
    cycle(many(63));
    now += 1ms;
    log.begin_cycle();
    for (const auto& f : many(63)) log.raise(f, Reaction::warn, ResetRule::self_clearing, now);
    log.raise(fact(9), Reaction::stop_machine, ResetRule::reset, now);
    log.end_cycle(now);

    EXPECT_EQ(log.strongest(), Reaction::stop_machine);
    EXPECT_EQ(log.alarms()[0].fact.index, 0) << "the newest of the weakest gave its place";
    EXPECT_EQ(log.dropped(), 1u);
}

}  // namespace
}  // namespace taktwerk::runtime

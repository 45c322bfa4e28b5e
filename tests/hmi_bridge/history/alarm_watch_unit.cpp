// What a look at the list of alarms makes of it: each alarm once, with the times of what happened to it.
#include "hmi_bridge/history/alarm_watch.hpp"

#include <gmock/gmock.h>

#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::ActiveAlarm;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t at_zero = 1'800'000'000'000'000;  // us since 1970 at machine time 0

class AlarmWatchTest : public ::testing::Test {
protected:
    std::vector<AlarmWatch::Change> look(Duration at) {
        snapshot.at = Instant{at};
        return watch.look(snapshot, Instant{at}, at_zero + at / 1us);
    }
    void list(std::vector<ActiveAlarm> alarms) {
        snapshot.alarms = std::move(alarms);
        snapshot.alarm_count = snapshot.alarms.size();
    }
    static ActiveAlarm alarm(Duration since, bool standing = true, bool acknowledged = false, std::uint32_t count = 1) {
        return {{0x3001, AlarmSource::axis, 0, 5.5, 5}, Instant{since}, count, standing, acknowledged, Reaction::stop_axis};
    }
    static std::int64_t us(Duration at) { return at_zero + at / 1us; }

    runtime::Snapshot snapshot;
    AlarmWatch watch{[](const AlarmFact& fact) {
        runtime::AlarmText words;
        words.source = "axis x";
        words.name = "following_error";
        words.english = "lags by " + std::to_string(fact.a);
        return words;
    }};
};

TEST_F(AlarmWatchTest, AnAlarmIsTheSameRowFromItsBeginningToItsEnd) {
    EXPECT_THAT(look(1s), IsEmpty());

    list({alarm(2s)});
    const auto begun = look(2100ms);
    ASSERT_THAT(begun, SizeIs(1));
    EXPECT_EQ(begun[0].row.utime, us(2s)) << "when the cycle saw it, not the look";
    EXPECT_EQ(begun[0].row.state, AlarmState::stands);
    EXPECT_EQ(begun[0].row.cleared_utime, 0);
    EXPECT_EQ(begun[0].row.reaction, Reaction::stop_axis);
    EXPECT_EQ(begun[0].row.name, "following_error");
    EXPECT_THAT(look(5s), IsEmpty()) << "nothing has changed";

    list({alarm(2s, false)});
    const auto over = look(6s);
    ASSERT_THAT(over, SizeIs(1));
    EXPECT_EQ(over[0].key, begun[0].key);
    EXPECT_EQ(over[0].row.state, AlarmState::waits);
    EXPECT_EQ(over[0].row.cleared_utime, us(6s));

    list({});
    const auto gone = look(9s);
    ASSERT_THAT(gone, SizeIs(1));
    EXPECT_EQ(gone[0].key, begun[0].key);
    EXPECT_EQ(gone[0].row.state, AlarmState::gone);
    EXPECT_EQ(gone[0].row.cleared_utime, us(6s));
    EXPECT_EQ(gone[0].row.acknowledged_utime, us(9s)) << "it waited for a person: one has come";
    EXPECT_THAT(look(10s), IsEmpty());
}

TEST_F(AlarmWatchTest, OneThatGoesByItselfWasAcknowledgedByNobody) {
    list({alarm(2s)});
    look(2s);
    list({});
    const auto gone = look(4s);
    ASSERT_THAT(gone, SizeIs(1));
    EXPECT_EQ(gone[0].row.cleared_utime, us(4s));
    EXPECT_EQ(gone[0].row.acknowledged_utime, 0);
}

TEST_F(AlarmWatchTest, AnotherTimeIsCountedAndHoldsAgain) {
    list({alarm(2s, false)});
    look(3s);
    list({alarm(2s, true, false, 2)});
    const auto again = look(4s);
    ASSERT_THAT(again, SizeIs(1));
    EXPECT_EQ(again[0].row.count, 2u);
    EXPECT_EQ(again[0].row.state, AlarmState::stands);
    EXPECT_EQ(again[0].row.cleared_utime, 0) << "it holds";
}

TEST_F(AlarmWatchTest, AnAcknowledgementIsAChange) {
    list({alarm(2s)});
    look(2s);
    list({alarm(2s, true, true)});
    const auto seen = look(3s);
    ASSERT_THAT(seen, SizeIs(1));
    EXPECT_EQ(seen[0].row.acknowledged_utime, us(3s));
    EXPECT_EQ(seen[0].row.state, AlarmState::stands);
}

TEST_F(AlarmWatchTest, ItsWordsFollowItsNumbersForAWhileAndThenOnlyWithAnotherChange) {
    list({alarm(2s)});
    look(2s);
    snapshot.alarms[0].fact.a = 7;
    const auto detail = look(3s);
    ASSERT_THAT(detail, SizeIs(1));
    EXPECT_EQ(detail[0].row.english, "lags by 7.000000");
    snapshot.alarms[0].fact.a = 8;
    EXPECT_THAT(look(5s), IsEmpty()) << "a number that runs must not be written for ever";
    snapshot.alarms[0].standing = false;
    const auto over = look(6s);
    ASSERT_THAT(over, SizeIs(1));
    EXPECT_EQ(over[0].row.english, "lags by 8.000000");
}

TEST_F(AlarmWatchTest, WhatPassedBetweenTwoLooksIsThere) {
    look(1s);
    snapshot.passed_alarms.note({{0x3001, AlarmSource::axis, 0, 1, 2}, Reaction::stop_axis, Instant{1200ms}, Instant{1300ms}});
    const auto passed = look(2s);
    ASSERT_THAT(passed, SizeIs(1));
    EXPECT_EQ(passed[0].row.utime, us(1200ms));
    EXPECT_EQ(passed[0].row.cleared_utime, us(1300ms));
    EXPECT_EQ(passed[0].row.state, AlarmState::gone);
    EXPECT_THAT(look(3s), IsEmpty());
    EXPECT_EQ(watch.missed(), 0u);
}

TEST_F(AlarmWatchTest, OneThatWasListedAndPassesIsOneRow) {
    list({alarm(2s)});
    const auto begun = look(2s);
    list({});
    snapshot.passed_alarms.note({{0x3001, AlarmSource::axis, 0, 5.5, 5}, Reaction::stop_axis, Instant{2s}, Instant{2300ms}});
    const auto gone = look(2500ms);
    ASSERT_THAT(gone, SizeIs(1));
    EXPECT_EQ(gone[0].key, begun[0].key);
    EXPECT_EQ(gone[0].row.cleared_utime, us(2300ms)) << "the cycle's time, not the look's";
}

// The machine remembers so many between two looks: of more, a row says how many are missing.
TEST_F(AlarmWatchTest, MoreThanAreRememberedAreCountedInARowOfTheirOwn) {
    const auto storm = [&](std::size_t alarms) {
        for (std::size_t i = 0; i < alarms; ++i)
            snapshot.passed_alarms.note(
                {{0x3001, AlarmSource::axis, static_cast<std::uint16_t>(i), 0, 0}, Reaction::stop_axis, snapshot.at, snapshot.at + 1ms});
    };
    const auto unseen = [](const std::vector<AlarmWatch::Change>& changes) {
        std::vector<AlarmWatch::Change> found;
        for (const auto& change : changes)
            if (change.row.alarm == runtime::id(runtime::MachineAlarm::alarm_log_full)) found.push_back(change);
        return found;
    };
    storm(runtime::PassedAlarms::capacity);
    EXPECT_THAT(unseen(look(1s)), IsEmpty()) << "each of them is there";

    storm(runtime::PassedAlarms::capacity + 3);
    auto changes = look(2s);
    EXPECT_EQ(changes.size(), runtime::PassedAlarms::capacity + 1);
    EXPECT_EQ(watch.missed(), 3u);
    ASSERT_THAT(unseen(changes), SizeIs(1));
    const auto first = unseen(changes)[0];
    EXPECT_EQ(first.row.utime, us(2s));
    EXPECT_EQ(first.row.state, AlarmState::gone);
    EXPECT_EQ(first.row.english, "lags by 3.000000") << "the words of that alarm take their number";

    storm(runtime::PassedAlarms::capacity + 40);
    changes = look(5s);
    ASSERT_THAT(unseen(changes), SizeIs(1)) << "soon: the same row";
    EXPECT_EQ(unseen(changes)[0].key, first.key);
    EXPECT_EQ(unseen(changes)[0].row.english, "lags by 43.000000");

    storm(runtime::PassedAlarms::capacity + 1);
    changes = look(5s + AlarmWatch::flutters + 1ms);
    ASSERT_THAT(unseen(changes), SizeIs(1));
    EXPECT_NE(unseen(changes)[0].key, first.key) << "another trouble";
    EXPECT_EQ(unseen(changes)[0].row.english, "lags by 1.000000");
    EXPECT_THAT(look(20s), IsEmpty());
}

// A computer without real time wakes late again and again: ten thousand notes must not push out the alarm that stopped the machine.
TEST_F(AlarmWatchTest, ANoteThatFluttersIsOneRowThatCounts) {
    const auto note = [&](Duration since, Duration gone) {
        snapshot.passed_alarms.note({{0x6007, AlarmSource::machine, 0, 300, 250}, Reaction::none, Instant{since}, Instant{gone}});
    };
    note(1s, 1001ms);
    note(1100ms, 1101ms);
    auto changes = look(1200ms);
    ASSERT_THAT(changes, SizeIs(1));
    const auto key = changes[0].key;
    EXPECT_EQ(changes[0].row.count, 2u);
    EXPECT_EQ(changes[0].row.utime, us(1s));
    EXPECT_EQ(changes[0].row.cleared_utime, us(1101ms));
    EXPECT_EQ(changes[0].row.state, AlarmState::gone);

    list({{{0x6007, AlarmSource::machine, 0, 300, 250}, Instant{9s}, 1, true, false, Reaction::none}});
    changes = look(9s);
    ASSERT_THAT(changes, SizeIs(1));
    EXPECT_EQ(changes[0].key, key);
    EXPECT_EQ(changes[0].row.count, 3u);
    EXPECT_EQ(changes[0].row.state, AlarmState::stands);
    list({});
    EXPECT_EQ(look(10s).at(0).row.state, AlarmState::gone);

    note(21s, 21001ms);
    changes = look(22s);
    ASSERT_THAT(changes, SizeIs(1));
    EXPECT_NE(changes[0].key, key) << "after a rest it is another one";
    EXPECT_EQ(changes[0].row.count, 1u);
}

TEST_F(AlarmWatchTest, ARecordingIsAskedForWhileTheAlarmIsYoung) {
    std::string recording;
    int asked = 0;
    watch.set_recordings([&](const AlarmFact&, Instant) {
        ++asked;
        return recording;
    });
    list({alarm(2s)});
    EXPECT_EQ(look(2s).at(0).row.recording, "");
    list({});
    look(2100ms);
    recording = "demo-following_error";
    const auto named = look(2200ms);
    ASSERT_THAT(named, SizeIs(1)) << "gone already";
    EXPECT_EQ(named[0].row.recording, "demo-following_error");
    EXPECT_THAT(look(2300ms), IsEmpty());
    EXPECT_EQ(asked, 3);
    recording.clear();
    list({alarm(10s)});
    look(10s);
    look(13s);
    EXPECT_EQ(asked, 4) << "not for ever";
}

TEST_F(AlarmWatchTest, ARecordingFindsItsAlarmAlsoWhenThatIsGone) {
    list({alarm(2s)});
    const auto begun = look(2s);
    watch.name_recording(alarm(2s).fact, Instant{2s}, "first");
    const auto named = look(3s);
    ASSERT_THAT(named, SizeIs(1));
    EXPECT_EQ(named[0].row.recording, "first");
    list({});
    look(4s);
    watch.name_recording(alarm(2s).fact, Instant{2s}, "second");
    const auto late = look(5s);
    ASSERT_THAT(late, SizeIs(1));
    EXPECT_EQ(late[0].key, begun[0].key);
    EXPECT_EQ(late[0].row.recording, "second");
    EXPECT_EQ(late[0].row.state, AlarmState::gone);
    watch.name_recording({0x1234, AlarmSource::bus, 0, 0, 0}, Instant{1s}, "nobody's");
    EXPECT_THAT(look(6s), IsEmpty());
}

}  // namespace
}  // namespace taktwerk::hmi

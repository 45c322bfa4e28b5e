// Configuration checks and the tables of words.

#include <algorithm>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

TEST(AxisConfigCheck, AGoodOneHasNoProblems) { EXPECT_TRUE(check(plain_axis()).empty()); }

// All at once, each naming its field and saying what to do.
TEST(AxisConfigCheck, FindsEveryProblemAtOnceAndNamesTheField) {
    auto config = plain_axis();
    config.gearing.feed = 0;
    config.gearing.load_revolutions = 0;
    config.limits.velocity = -1;
    config.limits.jerk = std::nan("");
    config.limits.position_min = 10;
    config.limits.position_max = 5;
    config.following.window = 0;
    config.queue_depth = 9;
    config.homing = {.kind = HomingKind::home_switch, .search_velocity = 1, .latch_velocity = 2};
    const auto problems = check(config);

    std::vector<std::string> subjects;
    for (const auto& problem : problems) {
        subjects.push_back(problem.subject);
        EXPECT_FALSE(problem.what.empty());
        EXPECT_FALSE(problem.remedy.empty());
    }
    for (const char* field : {"gearing.feed", "gearing.load_revolutions", "limits.velocity", "limits.jerk", "limits.position_min",
                              "following.window", "queue_depth", "homing.latch_velocity"})
        EXPECT_NE(std::find(subjects.begin(), subjects.end(), std::string("axes.x.") + field), subjects.end()) << field;
    EXPECT_EQ(problems.size(), 8u);
}

TEST(AxisAlarms, AreFoundByIdAndDecideTheReaction) {
    const auto* lost = find_alarm(axis_alarms, id(AxisAlarm::axis_feedback_lost));
    ASSERT_NE(lost, nullptr);
    EXPECT_EQ(lost->name, "axis_feedback_lost");
    EXPECT_EQ(reaction(AxisAlarm::jog_lease_expired), Reaction::warn);
    EXPECT_EQ(reaction(AxisAlarm::drive_mode_mismatch), Reaction::power_off);
}

// Each text uses Chinese characters and the same numbers as the English one.
TEST(AxisAlarms, ChineseTextsCarryTheSameNumbers) {
    for (const auto& alarm : axis_alarms) {
        for (const auto* number : {"{a", "{b"})
            EXPECT_EQ(alarm.english.find(number) != std::string_view::npos, alarm.chinese.find(number) != std::string_view::npos)
                << alarm.name;
        EXPECT_TRUE(std::any_of(alarm.chinese.begin(), alarm.chinese.end(), [](char c) { return static_cast<unsigned char>(c) >= 0xE4; }))
            << alarm.name;
    }
}

TEST(ErrorTexts, EveryErrorIdHasOne) {
    ASSERT_NE(find_error(ErrorId::power_conflict), nullptr);
    EXPECT_EQ(find_error(ErrorId::power_conflict)->name, "power_conflict");
    EXPECT_EQ(find_error(static_cast<ErrorId>(0x3001)), nullptr);
}

// The board holds each alarm once and hands it out once.
TEST(AlarmBoard, AnnouncesOnceWhileItHolds) {
    AlarmBoard board(7);
    EXPECT_TRUE(board.raise(AxisAlarm::drive_fault, 1, 2));
    EXPECT_FALSE(board.raise(AxisAlarm::drive_fault, 3, 4));
    AlarmFact fact;
    ASSERT_TRUE(board.fetch(fact));
    EXPECT_EQ(fact.index, 7);
    EXPECT_EQ(fact.source, AlarmSource::axis);
    EXPECT_EQ(fact.a, 1);
    EXPECT_FALSE(board.fetch(fact));
    board.clear(AxisAlarm::drive_fault);
    EXPECT_TRUE(board.active().empty());
    EXPECT_TRUE(board.raise(AxisAlarm::drive_fault, 5, 6));
}

}  // namespace
}  // namespace taktwerk::axes::test

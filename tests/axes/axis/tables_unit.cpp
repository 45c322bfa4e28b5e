// Configuration checks and the tables of words.

#include <algorithm>
#include <array>
#include <set>

#include "axes/axis/alarm_board.hpp"
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

/// Whether it holds a character of the CJK block (its first byte in UTF-8).
bool has_chinese(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0xE4 && byte <= 0xE9;
    });
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// Each text uses Chinese characters and the same numbers as the English one.
TEST(AxisAlarms, ChineseTextsCarryTheSameNumbers) {
    for (const auto& alarm : axis_alarms) {
        for (const auto* number : {"{a", "{b"})
            EXPECT_EQ(alarm.english.find(number) != std::string_view::npos, alarm.chinese.find(number) != std::string_view::npos)
                << alarm.name;
        EXPECT_TRUE(has_chinese(alarm.chinese)) << alarm.name;
    }
}

TEST(ErrorTexts, AreFoundByTheirNumber) {
    for (std::size_t i = 0; i < error_id_count; ++i) {
        const auto* error = find_error(static_cast<ErrorId>(i));
        ASSERT_NE(error, nullptr) << i;
        EXPECT_EQ(static_cast<std::size_t>(error->id), i);
    }
    EXPECT_EQ(find_error(static_cast<ErrorId>(error_id_count)), nullptr);
    EXPECT_EQ(find_error(static_cast<ErrorId>(0x3001)), nullptr) << "an axis error stands in the alarms";
}

// Programs and screens know errors by these: neither a number nor a name may change, new ones come at the end.
TEST(ErrorTexts, NumbersAndNamesStayWhatTheyAre) {
    // clang-format off
    constexpr std::array<std::string_view, 52> names{
        "none", "invalid_axis", "not_powered", "in_error_stop", "state_forbids", "invalid_velocity", "invalid_dynamics",
        "invalid_position", "beyond_software_limit", "queue_full", "owned_by_other", "not_supported", "not_homed",
        "buffer_mode_not_supported", "invalid_direction", "mode_forbids", "drive_not_ready", "reset_failed", "homing_failed",
        "interlocked", "aborted_by_axis_error", "power_conflict", "invalid_parameter", "invalid_device", "object_refused",
        "object_no_answer", "object_too_long", "object_requests_full", "unknown_parameter", "read_only_parameter", "invalid_output",
        "invalid_override", "invalid_master", "coupling_loop", "invalid_ratio", "not_coupled", "sync_impossible", "master_lost",
        "invalid_table", "no_table_room", "no_such_probe", "probe_busy", "probe_idle", "homing_limit_time", "homing_limit_distance",
        "homing_limit_torque", "drive_mode_refused", "not_at_standstill", "update_not_possible", "aborted_by_command",
        "setpoint_missing", "drive_setpoint_refused"};
    // clang-format on
    ASSERT_GE(error_texts.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(error_texts[i].name, names[i]) << i;
}

// Text, cause and remedy in both languages, each a sentence of its own and each in its language.
TEST(ErrorTexts, SayWhatWhyAndWhatToDoInBothLanguages) {
    std::set<std::string_view> names, english, chinese;
    for (const auto& error : error_texts) {
        EXPECT_TRUE(names.insert(error.name).second) << error.name << " stands twice";
        EXPECT_TRUE(english.insert(error.english.text).second) << error.name << " says the same as another";
        EXPECT_TRUE(chinese.insert(error.chinese.text).second) << error.name << " says the same as another in Chinese";
        for (const auto words : {error.english, error.chinese}) {
            EXPECT_NE(words.text, words.cause) << error.name;
            EXPECT_NE(words.cause, words.remedy) << error.name;
        }
        for (const auto text : {error.english.text, error.english.cause, error.english.remedy}) {
            EXPECT_FALSE(text.empty()) << error.name;
            EXPECT_TRUE(is_ascii(text)) << error.name << ": " << text;
            EXPECT_FALSE(text.ends_with('.')) << error.name << ": " << text;
        }
        for (const auto text : {error.chinese.text, error.chinese.cause, error.chinese.remedy}) {
            EXPECT_TRUE(has_chinese(text)) << error.name << ": " << text;
            EXPECT_FALSE(text.ends_with("\u3002")) << error.name << ": " << text;
        }
    }
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

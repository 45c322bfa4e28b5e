#include "core/alarm_table.hpp"

#include <gtest/gtest.h>

namespace taktwerk {
namespace {

constexpr AlarmInfo good(AlarmId id, std::string_view name) {
    return {id, name, "It happened {a}.", "发生了 {a}。", "Something.", "Do something.", ResetRule::reset, Reaction::stop_axis, ""};
}

constexpr std::array sound{good(0x3001, "following_error"), good(0x3002, "limit_switch_2")};
static_assert(alarm_table_is_sound(sound));
static_assert(alarm_table_is_sound(sound, 0x3000, 0x3FFF));

AlarmTableFlaw flaw_of(AlarmInfo second, AlarmId first = 1, AlarmId last = 0xFFFF) {
    const std::array table{sound[0], second};
    return alarm_table_problem(table, first, last).flaw;
}

TEST(AlarmTable, IdsAndNamesAreUnique) {
    EXPECT_EQ(flaw_of(good(0x3002, "other")), AlarmTableFlaw::none);
    EXPECT_EQ(flaw_of(good(0x3001, "other")), AlarmTableFlaw::duplicate_id);
    EXPECT_EQ(flaw_of(good(0x3002, "following_error")), AlarmTableFlaw::duplicate_name);
}

TEST(AlarmTable, NamesAreSnakeCase) {
    for (const auto* bad : {"", "Following", "following error", "_a", "a_", "a__b", "2a", "a-b"})
        EXPECT_EQ(flaw_of(good(0x3002, bad)), AlarmTableFlaw::name_not_snake_case) << bad;
    for (const auto* fine : {"a", "a1", "a_b_2"}) EXPECT_EQ(flaw_of(good(0x3002, fine)), AlarmTableFlaw::none) << fine;
}

TEST(AlarmTable, EveryTextIsThereInBothLanguages) {
    for (auto text : {&AlarmInfo::english, &AlarmInfo::chinese, &AlarmInfo::cause, &AlarmInfo::remedy}) {
        AlarmInfo info = good(0x3002, "other");
        info.*text = "";
        EXPECT_EQ(flaw_of(info), AlarmTableFlaw::text_missing);
    }
}

TEST(AlarmTable, IdsStayInTheFloorsRange) {
    EXPECT_EQ(flaw_of(good(0x4000, "other"), 0x3000, 0x3FFF), AlarmTableFlaw::id_out_of_range);
    EXPECT_EQ(flaw_of(good(0, "other")), AlarmTableFlaw::id_out_of_range);
}

TEST(AlarmTable, TheProblemNamesTheEntry) {
    const std::array table{sound[0], sound[1], good(0x3001, "third")};
    EXPECT_EQ(alarm_table_problem(table).entry, 2u);
}

}  // namespace
}  // namespace taktwerk

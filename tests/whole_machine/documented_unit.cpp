// What the campaign says in words is looked up in the tables of alarms, and what it judges can be judged wrong.

#include "tests/whole_machine/documented.hpp"

#include <gtest/gtest.h>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "modbus/tcp/alarms.hpp"
#include "runtime/alarms.hpp"
#include "tests/whole_machine/causes.hpp"

namespace taktwerk::whole {
namespace {

bool is_an_alarm(std::string_view name) {
    for (const auto table : {std::span<const AlarmInfo>(runtime::machine_alarms), std::span<const AlarmInfo>(axes::axis_alarms),
                             std::span<const AlarmInfo>(ecat::bus_alarms), std::span<const AlarmInfo>(modbus::tcp::device_alarms)})
        for (const auto& info : table)
            if (info.name == name) return true;
    return name == "program_alarm_";  // of programs, each with its number
}

TEST(WholeDocumented, EachAlarmThatIsNamedThereIsOne) {
    EXPECT_FALSE(is_an_alarm("frames_lots"));
    int named = 0;
    for (std::size_t t = 0; t < trouble_names.size(); ++t) {
        const auto trouble = static_cast<Trouble>(t);
        for (const auto& text : {documented(trouble).does, documented(trouble).back}) {
            EXPECT_EQ(std::count(text.begin(), text.end(), '`') % 2, 0) << text;
            for (const auto& one : alarms_named(text)) {
                EXPECT_TRUE(is_an_alarm(one)) << one << " of " << name(trouble);
                ++named;
            }
        }
    }
    EXPECT_GT(named, 25);
}

TEST(WholeDocumented, EachAlarmThatMayComeOfSomethingIsOne) {
    for (std::size_t t = 0; t < trouble_names.size(); ++t)
        for (const auto& one : consequences(static_cast<Trouble>(t)))
            EXPECT_TRUE(is_an_alarm(one.alarm)) << one.alarm << " of " << trouble_names[t];
    for (std::size_t d = 0; d < deed_names.size(); ++d)
        for (const auto& one : consequences(static_cast<Deed>(d)))
            EXPECT_TRUE(is_an_alarm(one.alarm)) << one.alarm << " of " << deed_names[d];
}

TEST(WholeDocumented, WhatIsNamedIsWhatStandsInBackQuotes) {
    EXPECT_EQ(alarms_named("stops: `a_b`, or `c`"), (std::vector<std::string>{"a_b", "c"}));
    EXPECT_TRUE(alarms_named("goes on").empty());
}

/// Alone, upon a machine of 1 ms that works.
WholeRun run_of(Trouble trouble, Reaction reaction, std::set<std::string, std::less<>> alarms = {}) {
    WholeRun run;
    run.troubles = {trouble};
    run.cycle = std::chrono::milliseconds{1};
    run.length = std::chrono::milliseconds{20};
    run.delay = std::chrono::milliseconds{2};
    run.reaction = reaction;
    run.alarms = std::move(alarms);
    return run;
}

TEST(WholeDocumented, ALongAbsenceThatStopsNothingIsNotAsDocumented) {
    for (const auto trouble : {Trouble::slave_off, Trouble::cable_pulled, Trouble::answers_late}) {
        EXPECT_NE(judged(run_of(trouble, Reaction::none)), "") << name(trouble);
        EXPECT_NE(judged(run_of(trouble, Reaction::warn)), "") << name(trouble);
        EXPECT_EQ(judged(run_of(trouble, Reaction::stop_machine, {"frames_lost", "slave_lost"})), "") << name(trouble);
    }
    auto brief = run_of(Trouble::slave_off, Reaction::none);
    brief.length = std::chrono::milliseconds{5};
    EXPECT_EQ(judged(brief), "") << "too short to be missed";
}

TEST(WholeDocumented, AShortStallStopsThoseAloneThatSuperviseEachFrame) {
    auto run = run_of(Trouble::stall_5ms, Reaction::stop_axis, {"drive_fault"});
    EXPECT_NE(judged(run), "");
    run.frames_supervised = true;
    EXPECT_EQ(judged(run), "");
    run.reaction = Reaction::none;
    EXPECT_NE(judged(run), "");
}

TEST(WholeDocumented, AStopForAnotherReasonIsNotAsDocumented) {
    EXPECT_NE(judged(run_of(Trouble::link_down, Reaction::stop_machine, {"program_fault"})), "");
    EXPECT_EQ(judged(run_of(Trouble::link_down, Reaction::stop_machine, {"link_down"})), "");
    EXPECT_NE(judged(run_of(Trouble::late_by_half, Reaction::stop_axis, {"late_wakeups"})), "") << "more than documented";
}

}  // namespace
}  // namespace taktwerk::whole

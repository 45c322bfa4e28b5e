// A drive on a serial line that nobody hears: the machine file that contradicts itself is refused, and what only the real line shows is an alarm
// that says where to look. XP200 manual 9.2: Pr181 is the station, -1 closes the port; Pr182 the baud rate; Pr183 the format.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "axes/drives/xp200/registers.hpp"
#include "runtime/alarms.hpp"
#include "runtime/check/machine_check.hpp"
#include "tests/runtime/serial/line_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::ErrorId;
using ::testing::AllOf;
using ::testing::HasSubstr;
namespace pr = axes::xp200::pr;

/// As it stands at its panel, whatever the machine file says. Counts after power off and on (9.3).
void set_at_the_panel(TestMachine& m, std::uint16_t number, std::int64_t value) {
    auto& servo = m.world.serial().drive("u")->servo();
    servo.power_off();
    servo.parameters().commission(number, value);
    servo.power_on(m.clock.now());
}

/// All that is said about the drive that nobody hears; empty: no such alarm.
std::string told_of_silence(TestMachine& m) {
    const auto& state = m.state();
    for (std::size_t i = 0; i < state.alarm_count; ++i) {
        if (state.alarms[i].fact.id != id(MachineAlarm::drive_silent)) continue;
        const auto text = m.machine->describe(state.alarms[i].fact);
        return text.source + ": " + text.english + "; " + text.cause + "; " + text.remedy;
    }
    return {};
}

// --- what the machine file can know ------------------------------------------------------------------------------------------------

struct Contradiction {
    std::uint16_t number;
    std::int64_t wrong, right;
    const char* key;
    const char* said;
};
class AgainstTheLine : public ::testing::TestWithParam<Contradiction> {};

// with_line(): station 1, 38400 baud (Pr182 = 3), 8E1 (Pr183 = 1).
TEST_P(AgainstTheLine, IsRefusedWithBothPlaces) {
    const auto& row = GetParam();
    auto config = with_line(machine_config(1));
    auto& parameters = config.serial[0].drives[0].drive.parameters;
    parameters.push_back({row.number, row.wrong});
    const auto errors = check(config);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].code, "serial.parameter_against_line");
    EXPECT_THAT(errors[0].subject, HasSubstr(fmt::format("Pr{:03}", row.number)));
    EXPECT_THAT(errors[0].what, AllOf(HasSubstr(row.key), HasSubstr(row.said)));

    parameters.back().value = row.right;
    EXPECT_TRUE(check(config).empty()) << "the same said twice is no contradiction";
}
INSTANTIATE_TEST_SUITE_P(Each, AgainstTheLine,
                         ::testing::Values(Contradiction{pr::station, 2, 1, "`station`", "1"},
                                           Contradiction{pr::station, -1, 1, "`station`", "closes the port"},
                                           Contradiction{pr::baud, 2, 3, "`baud`", "38400"},
                                           Contradiction{pr::format, 0, 1, "`format`", "8E1"}));

// --- what only the line shows ------------------------------------------------------------------------------------------------------

struct Wrong {
    std::uint16_t number;
    std::int64_t value;
};
class NobodyAnswers : public ::testing::TestWithParam<Wrong> {};

TEST_P(NobodyAnswers, IsAnAlarmThatSaysWhereToLook) {
    TestMachine m{with_line(machine_config(1))};
    set_at_the_panel(m, GetParam().number, GetParam().value);
    ASSERT_TRUE(m.up()) << m.alarms();
    m.run(4s);
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::drive_silent))) << "a drive needs 1.5 s to start, and its settings are read";
    ASSERT_TRUE(m.until([&] { return m.has_alarm(id(MachineAlarm::drive_silent)); }, 2s)) << m.alarms();
    EXPECT_THAT(told_of_silence(m),
                AllOf(HasSubstr("axis u"), HasSubstr("station 1"), HasSubstr("'rs485'"), HasSubstr("38400 baud"), HasSubstr("8E1"),
                      HasSubstr("Pr181"), HasSubstr("Pr182"), HasSubstr("Pr183"), HasSubstr("supply"), HasSubstr("cable")));
    EXPECT_FALSE(m.axis(u).online);
    EXPECT_TRUE(m.axis(0).online) << "the bus has nothing to do with it";

    // Put right, it goes by itself.
    set_at_the_panel(m, GetParam().number, GetParam().number == pr::station ? 1 : GetParam().number == pr::baud ? 3 : 1);
    ASSERT_TRUE(m.until([&] { return m.axis(u).online; }, 5s)) << m.alarms();
    m.run(10ms);
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::drive_silent)));
}
INSTANTIATE_TEST_SUITE_P(Each, NobodyAnswers,
                         ::testing::Values(Wrong{pr::station, 2}, Wrong{pr::station, -1}, Wrong{pr::baud, 2}, Wrong{pr::format, 0}));

TEST(AbsentDrive, WhatWasOnlineAndFallsSilentWithoutPowerIsSaidToo) {
    TestMachine m{with_line(machine_config(1))};
    ASSERT_TRUE(m.up() && m.until([&] { return m.axis(u).online; }, 5s)) << m.alarms();
    m.run(10s);
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::drive_silent))) << "it answers";
    m.world.serial().line("rs485")->cut(true);
    m.run(4s);
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::drive_silent)));
    ASSERT_TRUE(m.until([&] { return m.has_alarm(id(MachineAlarm::drive_silent)); }, 2s)) << m.alarms();
}

// It is heard a tenth of a second at a time, which is less than its settings take: neither silent nor ready.
TEST(AbsentDrive, WhatAnswersAndNeverGetsReadyIsSaidInOtherWords) {
    TestMachine m{with_line(machine_config(1))};
    ASSERT_TRUE(m.up()) << m.alarms();
    bool said = false;
    for (int i = 0; i < 50 && !said; ++i) {
        m.world.serial().line("rs485")->cut(false);
        m.run(200ms);
        m.world.serial().line("rs485")->cut(true);
        m.run(500ms);
        ASSERT_FALSE(m.axis(u).online) << "the case under test";
        ASSERT_FALSE(m.has_alarm(id(MachineAlarm::drive_silent)));
        said = m.has_alarm(id(MachineAlarm::drive_not_ready_on_line));
        EXPECT_TRUE(i >= 42 || !said) << "within 29 s";
    }
    EXPECT_TRUE(said) << m.alarms();
}

// --- enabling it -------------------------------------------------------------------------------------------------------------------

TEST(AbsentDrive, IsNotEnabled) {
    TestMachine m{with_line(machine_config(1))};
    set_at_the_panel(m, pr::station, 2);
    ASSERT_TRUE(m.up()) << m.alarms();
    const auto refused = m.command(OperatorAction::power, u, true);
    EXPECT_EQ(refused.answer, Answer::refused_by_axis);
    EXPECT_EQ(refused.error, ErrorId::drive_not_ready);

    // No wish stays behind that would switch the motor on when the drive comes.
    set_at_the_panel(m, pr::station, 1);
    ASSERT_TRUE(m.until([&] { return m.axis(u).online; }, 5s)) << m.alarms();
    m.run(3s);
    EXPECT_EQ(m.axis(u).drive_state, axes::PowerState::disabled);
    EXPECT_FALSE(m.world.serial().drive("u")->servo().energised());
    m.enable(u);
    EXPECT_TRUE(m.world.serial().drive("u")->servo().energised()) << "positive control";
}

// An axis that can be switched off is, also when nobody can be asked: the wish goes.
TEST(AbsentDrive, IsDisabledAllTheSame) {
    TestMachine m{with_line(machine_config(1))};
    set_at_the_panel(m, pr::station, 2);
    ASSERT_TRUE(m.up()) << m.alarms();
    EXPECT_EQ(m.command(OperatorAction::power, u, false).answer, Answer::accepted);
}

// Every axis is asked, those that are there get their power, and the answer is the refusal.
TEST(AbsentDrive, DoesNotHoldUpTheOthers) {
    TestMachine m{with_line(machine_config(1))};
    set_at_the_panel(m, pr::station, 2);
    ASSERT_TRUE(m.up()) << m.alarms();
    EXPECT_EQ(m.command(OperatorAction::power, 0xFFFF, true).error, ErrorId::drive_not_ready);
    EXPECT_TRUE(m.until([&] { return m.axis(0).drive_state == axes::PowerState::enabled; }, 3s)) << m.alarms();
}

}  // namespace
}  // namespace taktwerk::runtime::testing

// Numbers of alarms as a person reads them.

#include <gmock/gmock.h>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::HasSubstr;

TEST(AlarmWords, TimesStandInTheUnitThatTheirSizeAsksFor) {
    TestMachine m{machine_config(1)};
    const auto said = [&](AlarmId alarm, double nanoseconds) {
        return m.machine->describe({alarm, AlarmSource::slave, 0, nanoseconds, 0}).english;
    };
    EXPECT_THAT(said(ecat::id(ecat::BusAlarm::dc_out_of_sync), 4'884'786), HasSubstr("differ by 4.88 ms"));
    EXPECT_THAT(said(ecat::id(ecat::BusAlarm::dc_out_of_sync), 3'214), HasSubstr("differ by 3.21 us"));
    EXPECT_THAT(said(ecat::id(ecat::BusAlarm::dc_out_of_sync), 812), HasSubstr("differ by 812 ns"));
    EXPECT_THAT(said(ecat::id(ecat::BusAlarm::dc_out_of_sync), 2.5e9), HasSubstr("differ by 2.5 s"));
    EXPECT_THAT(said(ecat::id(ecat::BusAlarm::dc_not_locked), -31'000), HasSubstr("(-31 us off)"));
}

// The tables cannot know the unit of an axis, people do.
TEST(AlarmWords, AnAxisSpeaksInItsOwnUnitInEveryField) {
    auto config = machine_config(2);
    config.axes[1].axis.unit = "deg";
    TestMachine m{config};
    const auto said = [&](axes::AxisAlarm alarm, std::uint16_t axis) {
        return m.machine->describe({axes::id(alarm), AlarmSource::axis, axis, 6.5, 5});
    };
    EXPECT_EQ(said(axes::AxisAlarm::following_error, 0).english, "Following error 6.5 mm is beyond the window of 5 mm");
    EXPECT_EQ(said(axes::AxisAlarm::following_error, 1).english, "Following error 6.5 deg is beyond the window of 5 deg");
    EXPECT_THAT(said(axes::AxisAlarm::motor_turns, 1).english, HasSubstr("at 6.5 deg/s"));
    EXPECT_THAT(said(axes::AxisAlarm::motor_turns, 1).chinese, HasSubstr("6.5 deg/s"));
    EXPECT_THAT(said(axes::AxisAlarm::motor_turns, 1).cause, HasSubstr("(5 deg/s)"));
    for (const auto& row : axes::axis_alarms) {
        const auto words = m.machine->describe({row.id, AlarmSource::axis, 0, 6.5, 5});
        for (const auto& text : {words.english, words.chinese, words.cause, words.remedy})
            EXPECT_THAT(text,
                        ::testing::AllOf(::testing::Not(HasSubstr("{")), ::testing::Not(::testing::ContainsRegex("[0-9] u([ /;)]|$)"))))
                << row.name;
    }
}

}  // namespace
}  // namespace taktwerk::runtime::testing

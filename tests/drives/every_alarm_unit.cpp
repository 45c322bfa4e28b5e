// Every alarm that the file of a drive lists, on its simulated drive, provoked while the motor runs: what the drive shows and does, and what
// clears it. Which of them the model finds by computing: alarm_causes_unit.cpp. What a machine makes of them: alarms/every_alarm_machine.cpp.

#include "axes/port/find_alarm.hpp"
#include "tests/drives/moving_desk.hpp"

namespace taktwerk::test::the_every_alarm {
namespace {

using axes::DriveAlarmKind;
using axes::DriveAlarmText;

enum class Reaction { stops, coasts };

/// A drive, how many alarms its manual lists, and how it comes to rest at a fault. Where the manual is silent the way is the documented choice.
struct Drive {
    const char* name;
    std::size_t alarms;
    Reaction reaction;
    friend void PrintTo(const Drive& drive, std::ostream* out) { *out << drive.name; }
};
constexpr Drive drives[] = {
    {"sv33-e", 84, Reaction::stops},    // tables 5-2 and 5-3; 3.1.8 table 3-16, P04.11 = 2: zero speed
    {"sv-da200", 75, Reaction::stops},  // 5.2, 5.3; 3.1: "stops in the configured way, motor excited"
    {"tsvm-d6", 45, Reaction::coasts},  // 7.1, 7.2; not stated
    {"se-808x", 9, Reaction::coasts},   // 5.1; 4.3: 605Eh = 0
};

class EveryAlarm : public ::testing::TestWithParam<Drive> {
protected:
    static void provoke(MovingDesk& desk, const DriveAlarmText& row) {
        for (unsigned axis = 0; axis < (row.whole_drive ? desk.drive.profile->axes : 1u); ++axis)
            ASSERT_TRUE(desk.axis(axis).provoke(row.panel)) << row.panel;
    }
    static void release(MovingDesk& desk, const DriveAlarmText& row) {
        for (unsigned axis = 0; axis < desk.drive.profile->axes; ++axis) desk.axis(axis).release(row.panel);
        desk.run(2);
    }
    static void expect_shown(MovingDesk& desk, const DriveAlarmText& row) {
        EXPECT_EQ(desk.code(), row.code);
        EXPECT_EQ(desk.detail(), row.detail);
    }
    static void expect_warning(MovingDesk& desk, const DriveAlarmText& row);
    static void expect_fault(MovingDesk& desk, const DriveAlarmText& row, Reaction reaction);
};

// SV33-E 5.3: "all warnings clear themselves when their condition has gone".
void EveryAlarm::expect_warning(MovingDesk& desk, const DriveAlarmText& row) {
    const double speed = desk.speed();
    provoke(desk, row);
    desk.follow(MovingDesk::step, 50);
    expect_shown(desk, row);
    EXPECT_TRUE(desk.enabled()) << "it goes on";
    EXPECT_TRUE(desk.status_bit(7));
    EXPECT_NEAR(desk.speed(), speed, 0.05 * speed);
    release(desk, row);
    EXPECT_EQ(desk.code(), 0);
    EXPECT_FALSE(desk.status_bit(7));
}

void EveryAlarm::expect_fault(MovingDesk& desk, const DriveAlarmText& row, Reaction reaction) {
    const double speed = desk.speed();
    provoke(desk, row);
    desk.follow(MovingDesk::step, 10);
    // Friction alone takes 400 rad/s2 of 31 rad/s, the motor's torque 19000: after 10 ms they are far apart.
    const bool coasts = reaction == Reaction::coasts || row.kind == DriveAlarmKind::safe_torque_off;
    if (coasts) {
        EXPECT_GT(desk.speed(), 0.8 * speed);
    } else {
        EXPECT_LT(std::abs(desk.speed()), 0.05 * speed);
    }
    desk.run(500);
    expect_shown(desk, row);
    EXPECT_TRUE(desk.status_bit(3));
    EXPECT_FALSE(desk.enabled());
    EXPECT_LT(std::abs(desk.speed()), 0.01 * speed);
    for (unsigned axis = 1; axis < desk.drive.profile->axes; ++axis)
        EXPECT_EQ(desk.code(axis), row.whole_drive ? row.code : 0) << "axis " << axis + 1;

    desk.reset();
    EXPECT_TRUE(desk.status_bit(3)) << "its cause is still there";
    release(desk, row);
    if (row.clears_itself) {
        EXPECT_FALSE(desk.status_bit(3));
        return;
    }
    EXPECT_TRUE(desk.status_bit(3)) << "only a reset clears it";
    desk.reset();
    EXPECT_EQ(desk.status_bit(3), !row.resettable);
    EXPECT_EQ(desk.code(), row.resettable ? 0 : row.code);
    if (row.resettable) return;
    desk.power_cycle();
    desk.run(100);
    EXPECT_FALSE(desk.status_bit(3)) << "switched off and on";
    EXPECT_EQ(desk.code(), 0);
}

TEST_P(EveryAlarm, ShowsItsNumbersStopsTheMotorOrWarnsAndClearsAsListed) {
    const auto& alarms = drive_of_file(GetParam().name).profile->alarms;
    EXPECT_EQ(alarms.size(), GetParam().alarms);
    for (const auto& row : alarms) {
        SCOPED_TRACE(row.panel + " " + row.english);
        MovingDesk desk{GetParam().name};
        desk.go();
        if (HasFatalFailure()) return;
        if (row.warning) expect_warning(desk, row);
        else expect_fault(desk, row, GetParam().reaction);
    }
}

// What the port tells the axis of it: the row that its numbers mean, with what follows from it.
TEST(EveryAlarmRow, IsToldApartByCodeDetailAndSort) {
    for (const std::string name : {"sv33-e", "sv-da200", "tsvm-d6", "se-808x", "xp200"}) {
        const auto drive = config::drive(name);
        const auto& profile = *drive.profile;
        for (const auto& row : profile.alarms) {
            SCOPED_TRACE(name + " " + row.panel);
            axes::ShownAlarm shown{row.code, std::nullopt, row.warning ? axes::ShownAlarm::As::warning : axes::ShownAlarm::As::fault};
            const auto soon = axes::find_alarm(profile, shown);
            EXPECT_GE(soon.candidates, 1u);
            EXPECT_TRUE(soon.resettable || !row.resettable) << "a reset that may help is tried";
            if (profile.alarm_detail_index) shown.detail = row.detail;
            const auto found = axes::find_alarm(profile, shown);
            ASSERT_EQ(found.row, &row);
            EXPECT_EQ(found.kind, row.kind);
            EXPECT_EQ(found.resettable, row.resettable);
            EXPECT_EQ(found.whole_drive, row.whole_drive);
        }
    }
}

TEST(EveryAlarmOfNoList, IsNotProvoked) {
    MovingDesk desk{"sv33-e"};
    EXPECT_FALSE(desk.axis().provoke("E.999"));
}

// TSVM 7.1: common alarms "have no axis number"; each axis leaves Fault by a reset of its own (5.3.1, transition 15).
TEST(EveryAlarmOfAllAxes, IsResetAxisByAxis) {
    MovingDesk desk{"tsvm-d6"};
    desk.run(50);
    for (const auto& row : desk.drive.profile->alarms) {
        if (!row.whole_drive || !row.resettable) continue;
        SCOPED_TRACE(row.panel);
        for (unsigned axis = 0; axis < 6; ++axis) desk.axis(axis).provoke(row.panel);
        desk.run(5);
        for (unsigned axis = 0; axis < 6; ++axis) desk.axis(axis).release(row.panel);
        for (unsigned axis = 0; axis < 6; ++axis) {
            EXPECT_EQ(desk.code(axis), row.code);
            desk.reset(static_cast<std::uint16_t>(0x6040 + axis * 0x800));
            EXPECT_EQ(desk.code(axis), 0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Drives, EveryAlarm, ::testing::ValuesIn(drives), [](const auto& drive) {
    std::string name = drive.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace taktwerk::test::the_every_alarm

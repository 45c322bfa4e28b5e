// The alarms that a simulated drive finds out by itself: each cause is made to happen, nobody names the alarm.

#include <gmock/gmock.h>

#include <map>

#include "tests/drives/alarm_causes.hpp"
#include "tests/drives/moving_desk.hpp"

namespace taktwerk::test::alarm_causes {
namespace {

using axes::sim::Battery;
using axes::sim::PlantConfig;
using axes::sim::SimulatedMotor;
using ::testing::UnorderedElementsAreArray;

// --- what the motor brings into it -------------------------------------------------------------------------------------------------

constexpr double turn = 10'000;  // counts

PlantConfig plant_for(Cause cause) {
    auto plant = long_table();
    switch (cause) {
        case Cause::overloaded: plant.coulomb_friction = 1.5 * plant.rated_torque; break;
        case Cause::torque_above_user: plant.coulomb_friction = 1.7 * plant.rated_torque; break;  // TSVM PA30 = 160 %
        case Cause::positive_limit:
        case Cause::homing_into_limit: plant.positive_limit = turn; break;
        case Cause::negative_limit: plant.negative_limit = -turn; break;
        case Cause::encoder_turns_full: plant.start = 32'768 * turn - 500; break;  // SV33-E 3.1.4: 16 bits of signed turns
        default: break;
    }
    return plant;
}

void motor_for(Cause cause, SimulatedMotor& motor) {
    switch (cause) {
        case Cause::faster_than_allowed: motor.overspeed = 4 * turn; break;
        case Cause::enabled_while_turning: motor.start_speed = 3 * turn; break;
        case Cause::overloaded: motor.overload_seconds = 0.2; break;
        case Cause::jammed: motor.following_error_limit = 0.1 * turn; break;  // where no object says it
        case Cause::setpoint_leaps: motor.maximum_velocity = 100 * turn; break;
        case Cause::encoder_turns_full:
        case Cause::battery_low:
        case Cause::battery_empty: motor.absolute_encoder = true; break;
        default: break;
    }
}

// --- what happens -----------------------------------------------------------------------------------------------------------------

void write(MovingDesk& desk, std::uint16_t index, std::uint8_t sub, std::int64_t value) {
    EXPECT_EQ(desk.sdo(index, sub, value), 0u) << std::hex << index << ':' << int{sub};
}

/// SE-808X 4.4: 2000h:11 = 4 closes the loop, which alone notices a lag; 2000h:0F is its limit. Both count after a restart.
void close_the_loop(MovingDesk& desk) {
    write(desk, 0x2000, 0x11, 4);
    write(desk, 0x2000, 0x0F, 1000);
    write(desk, 0x1010, 1, 0x65766173);
    desk.power_cycle();
    desk.go_operational();
}

void lag(MovingDesk& desk) {
    if (desk.drive.profile->name == "se-808x") close_the_loop(desk);
    const auto limit = desk.drive.profile->behaviour.following_limit;  // SV-DA200 P4.33
    if (limit.index) write(desk, limit.index, limit.sub, 1000);
    else if (desk.has(0x6065)) write(desk, 0x6065, 0, 1000);
    desk.go();
    desk.axis().jam(true);
    desk.follow_until_alarm(MovingDesk::step, 1s);
}

/// At the torque limit, no check of the position in the way (6065h = FFFFFFFFh is none, CiA 402-2).
void press(MovingDesk& desk) {
    write(desk, 0x6065, 0, 0xFFFFFFFF);
    desk.go();
    desk.axis().jam(true);
    desk.follow_until_alarm(MovingDesk::step, 2s);
}

/// SV33-E P04.12 = 0: it runs out when the enable is taken, and is enabled again at five turns a second.
void enable_while_turning(MovingDesk& desk) {
    write(desk, 0x2004, 0x0D, 0);
    desk.go();
    for (const int word : {0, 6, 7, 15}) desk.control(static_cast<std::uint16_t>(word), 1);
    desk.run(2);
}

void leap(MovingDesk& desk) {
    desk.go();
    for (int i = 0; i < 5; ++i) desk.follow(2000, 1);
}

void home_by(MovingDesk& desk, std::int64_t method) {
    write(desk, 0x6098, 0, method);
    write(desk, 0x6099, 1, 20'000);
    write(desk, 0x6099, 2, 2'000);
    write(desk, 0x609A, 0, 200'000);
    desk.pdo(0x6060, 6);
    desk.run(50);
    desk.enable();
    desk.control(0x1F);
    desk.run(3s);
}

void miss_outputs(MovingDesk& desk) {
    if (const auto patience = desk.drive.profile->behaviour.lost_data_time; patience.index) {  // SV-DA200 P4.09, ms, from a restart on
        write(desk, patience.index, patience.sub, 20);
        desk.power_cycle();
        desk.go_operational();
    }
    desk.go();
    desk.arrives.outputs = false;
    auto* missed = desk.dictionary.find(0x1C32, 0x0B);  // counted by the slave controller, which the desk does not have
    for (int i = 0; i < 100; ++i) {
        if (missed) missed->set(missed->get() + 1);
        desk.cycle();
    }
}

void run_into_limit(MovingDesk& desk, std::int64_t step) {
    desk.go(step);
    desk.follow_until_alarm(step, 2s);
    desk.follow(step, 20);
}

void cross_limits(MovingDesk& desk) {
    write(desk, 0x607D, 1, -1000);
    write(desk, 0x607D, 2, -1000);
}

/// SV33-E 8.1: DI function 1 is servo enable, here of the second input that the bus plays (P23.00, P23.08, P20.50).
void enable_by_input(MovingDesk& desk) {
    write(desk, 0x2023, 0x09, 1);
    write(desk, 0x2023, 0x01, 1);
    write(desk, 0x2020, 0x33, 2);
    desk.pdo(0x6060, MovingDesk::csp);
    desk.run(50);
    desk.enable();
}

/// SV33-E 7.2: P08.00 = 1 is fault and warning; without power at the motor it warns.
void miss_a_phase_at_rest(MovingDesk& desk) {
    write(desk, 0x2008, 0x01, 1);
    desk.device.mains_complete(false);
}

void put_home_outside(MovingDesk& desk) {
    write(desk, 0x607D, 1, -1000);
    write(desk, 0x607D, 2, 1000);
    write(desk, 0x607C, 0, 1001);
}

void restart_with(MovingDesk& desk, Battery battery) {
    desk.stand();
    desk.axis().battery(battery);
    desk.run(5);
    if (battery != Battery::empty) return;
    EXPECT_EQ(desk.code(), 0) << "as long as the drive is supplied the turns are there";
    desk.power_cycle();
    desk.run(50);
}

void enable_without_mode(MovingDesk& desk) {
    desk.run(50);
    for (const int word : {6, 7, 15}) desk.control(static_cast<std::uint16_t>(word));
}

void happen(Cause cause, MovingDesk& desk) {
    switch (cause) {
        case Cause::main_power_gone: desk.go(), desk.device.main_power(false); break;
        case Cause::phase_missing: desk.go(), desk.device.mains_complete(false), desk.run(100); break;
        case Cause::phase_missing_at_rest: miss_a_phase_at_rest(desk); break;
        case Cause::supply_too_high: desk.go(), desk.device.supply_voltage(91); break;  // SE-808X 4.4, 2000h:15 = 90 V
        case Cause::enabled_by_input_too: enable_by_input(desk); break;
        case Cause::faster_than_allowed: desk.go(), desk.follow_until_alarm(MovingDesk::step, 1s); break;
        case Cause::enabled_while_turning: enable_while_turning(desk); break;
        case Cause::overloaded:
        case Cause::torque_above_user: desk.go(), desk.follow_until_alarm(MovingDesk::step, 5s); break;
        case Cause::stalled: press(desk); break;
        case Cause::jammed: lag(desk); break;
        case Cause::setpoint_leaps: leap(desk); break;
        case Cause::encoder_fails: desk.go(), desk.axis().fail(axes::sim::Failure::encoder); break;
        case Cause::encoder_turns_full: desk.go(), desk.follow_until_alarm(MovingDesk::step, 1s); break;
        case Cause::battery_low: restart_with(desk, Battery::low); break;
        case Cause::battery_empty: restart_with(desk, Battery::empty); break;
        case Cause::bus_leaves_op: desk.go(), desk.enter(EsmState::safeop); break;
        case Cause::outputs_missing: miss_outputs(desk); break;
        case Cause::outputs_watchdog: desk.go(), desk.device.outputs_lost(desk.now); break;
        case Cause::sync_missing: desk.go(), desk.arrives.sync0 = false, desk.run(100); break;
        case Cause::link_changes: desk.go(), desk.device.link_changed(desk.now); break;
        case Cause::positive_limit: run_into_limit(desk, MovingDesk::step); break;
        case Cause::negative_limit: run_into_limit(desk, -MovingDesk::step); break;
        case Cause::emergency_stop_ordered: desk.go(), write(desk, 0x2020, 3, 1); break;  // P20.02
        case Cause::limits_crossed: cross_limits(desk); break;
        case Cause::home_outside_limits: put_home_outside(desk); break;
        case Cause::homing_too_long: write(desk, 0x2013, 0x32, 100), home_by(desk, 19); break;  // P13.49 = 1 s; there is no home switch
        case Cause::homing_into_limit: home_by(desk, 19); break;                                // sets out forwards, no home switch
        case Cause::homing_method_unknown: home_by(desk, 15); break;                            // reserved in CiA 402
        case Cause::mode_not_set: enable_without_mode(desk); break;
        case Cause::restart_awaited: write(desk, 0x2004, 0x02, 1); break;  // P04.01
        case Cause::stored_too_often:
            for (int i = 0; i < 150; ++i) write(desk, 0x6081, 0, i);
            break;
        case Cause::both_limits_open:
        case Cause::off_while_saving: FAIL() << "an XP200 only";
    }
    desk.run(20);
}

// --- the rules ---------------------------------------------------------------------------------------------------------------------

std::vector<Found> of_the_bus() {
    std::vector<Found> out;
    for (const auto& found : found_by_computing())
        if (found.drive != "xp200") out.push_back(found);
    return out;
}

class FoundAlarm : public ::testing::TestWithParam<Found> {};

TEST_P(FoundAlarm, ByComputing) {
    const auto& [name, panel, cause, section] = GetParam();
    const auto* row = config::alarm(*drive_of_file(std::string(name)).profile, panel);
    ASSERT_NE(row, nullptr);
    MovingDesk desk{std::string(name), plant_for(cause),
                    [cause = cause](SimulatedMotor& motor, axes::DriveProfile&) { motor_for(cause, motor); }};
    desk.run(50);
    ASSERT_EQ(desk.code(), 0);

    happen(cause, desk);

    EXPECT_EQ(desk.code(), row->code);
    EXPECT_EQ(desk.detail(), row->detail);
    EXPECT_EQ(desk.status_bit(3), !row->warning) << std::hex << desk.status();
    for (unsigned axis = 1; axis < desk.drive.profile->axes; ++axis) EXPECT_EQ(desk.code(axis), row->whole_drive ? row->code : 0);
}

// Both lists together are the drive's file, each alarm once: a new one is found by computing, or says why not.
TEST(AlarmCauses, EveryAlarmOfEveryDriveIsFoundOrSaysWhyNot) {
    for (const std::string name : {"sv33-e", "sv-da200", "tsvm-d6", "se-808x", "xp200"}) {
        std::vector<std::string> of_the_file, listed;
        for (const auto& row : drive_of_file(name).profile->alarms) of_the_file.push_back(row.panel);
        for (const auto& found : found_by_computing())
            if (found.drive == name) listed.emplace_back(found.panel);
        for (const auto& told : told_only())
            if (told.drive == name) listed.insert(listed.end(), told.panels.begin(), told.panels.end());
        EXPECT_THAT(listed, UnorderedElementsAreArray(of_the_file)) << name;
    }
}

// Counted by hand: what a model once found it finds tomorrow, and what it cannot does not grow.
TEST(AlarmCauses, TheListOfThoseThatAreOnlyToldDoesNotGrow) {
    std::map<std::string_view, std::size_t> found, told;
    for (const auto& row : found_by_computing()) ++found[row.drive];
    for (const auto& reason : told_only()) told[reason.drive] += reason.panels.size();
    const auto counts = [](const auto& map) { return std::vector<std::pair<std::string_view, std::size_t>>(map.begin(), map.end()); };
    EXPECT_THAT(counts(found),
                ::testing::ElementsAre(::testing::Pair("se-808x", 6), ::testing::Pair("sv-da200", 14), ::testing::Pair("sv33-e", 25),
                                       ::testing::Pair("tsvm-d6", 12), ::testing::Pair("xp200", 8)));
    EXPECT_THAT(counts(told), ::testing::ElementsAre(::testing::Pair("se-808x", 9 - 6), ::testing::Pair("sv-da200", 75 - 14),
                                                     ::testing::Pair("sv33-e", 84 - 25), ::testing::Pair("tsvm-d6", 45 - 12),
                                                     ::testing::Pair("xp200", 22 - 8)));
}

INSTANTIATE_TEST_SUITE_P(Drives, FoundAlarm, ::testing::ValuesIn(of_the_bus()), [](const auto& found) {
    auto name = std::string(found.param.drive) + "_" + std::string(found.param.panel);
    for (auto& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
});

}  // namespace
}  // namespace taktwerk::test::alarm_causes

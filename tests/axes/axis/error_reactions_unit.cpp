// What the machine file may choose about an axis' alarms, and what the axis does then.

#include <algorithm>

#include "axes/axis/error_reaction.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig reacting(AxisAlarm alarm, ErrorReaction reaction) {
    auto config = plain_axis();
    config.following.window = 1;
    config.limits.jerk = infinity;
    config.reactions.choose(alarm, reaction);
    return config;
}

/// At 50 u/s, then its motor is blocked: 1 u behind after 20 ms, and the alarm 10 ms later.
struct Blocked : Rig {
    explicit Blocked(ErrorReaction reaction) : Rig(reacting(AxisAlarm::following_error, reaction)) {
        power_on();
        command = accept(at_velocity(50));
        run(100);
        drive.blocked = true;
        EXPECT_TRUE(run_until([&] { return raised(AxisAlarm::following_error); }, 100));
    }
    CommandId command = 0;
};

TEST(ErrorReaction, WithoutAChoiceTheTablesHolds) {
    Blocked rig(ErrorReaction::by_table);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    rig.run(300);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.drive.power, PowerState::enabled);
    rig.drive.blocked = false;
    rig.run(100);
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
}

// The milder one: shown while it lasts, and nothing stops.
TEST(ErrorReaction, AWarningIsShownWhileItLasts) {
    Blocked rig(ErrorReaction::warn);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.run(50);
    EXPECT_EQ(rig.status(rig.command), CommandStatus::in_target);
    EXPECT_EQ(rig.axis.active_alarms().size(), 1u);
    rig.drive.blocked = false;
    ASSERT_TRUE(rig.run_until([&] { return rig.axis.active_alarms().empty(); }, 2000));
    EXPECT_EQ(rig.view().set_velocity, 50);
    EXPECT_EQ(rig.view().error, 0);
}

TEST(ErrorReaction, RampThenOffTakesThePowerWhenTheAxisStands) {
    Blocked rig(ErrorReaction::ramp_then_off);
    bool off_while_moving = false;
    ASSERT_TRUE(rig.run_until([&] {
        off_while_moving = off_while_moving || (rig.drive.last.power == PowerRequest::off && rig.view().set_velocity != 0);
        return rig.drive.power == PowerState::disabled;
    }));
    EXPECT_FALSE(off_while_moving);
    rig.run(200);
    EXPECT_EQ(rig.drive.power, PowerState::disabled) << "until a reset, although Enable is TRUE";
    rig.drive.blocked = false;
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
}

TEST(ErrorReaction, PowerOffTakesItAtOnce) {
    Blocked rig(ErrorReaction::power_off);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    rig.run(1);
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
    rig.run(100);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);
    EXPECT_EQ(rig.alarms.size(), 1u) << "the power that goes is no alarm of its own";
    rig.drive.blocked = false;
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    rig.expect_no_jump();
}

/// A drive warning at 50 u/s. The drive brakes from 50,000 counts/s with 5,000,000 counts/s2: 10 cycles, in which it goes 45, 40, ... 5, 0 counts. The
/// first is over when it shows the state.
struct Warned : Rig {
    explicit Warned(ErrorReaction reaction, bool stays = false) : Rig(reacting(AxisAlarm::drive_warning, reaction)) {
        drive.quick_stop_stays = stays;
        power_on();
        accept(at_velocity(50));
        run(100);
        drive.warning = true;
        EXPECT_TRUE(run_to(AxisState::ErrorStop, 5));
        drive.warning = false;
    }
};

TEST(ErrorReaction, QuickStopIsTheDrivesThenPowerGoes) {
    for (const bool stays : {false, true}) {
        Warned rig(ErrorReaction::quick_stop, stays);
        EXPECT_EQ(rig.view().error, id(AxisAlarm::drive_warning));
        ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::quick_stop; }, 5));
        const double from = rig.drive.position;
        int braking = 0;
        double before = from - 1;
        while (rig.drive.position != before && braking < 100) {
            before = rig.drive.position;
            rig.step();
            ++braking;
            if (rig.drive.position != before) {
                ASSERT_EQ(rig.drive.last.power, PowerRequest::quick_stop) << "its power must not go while it brakes";
            }
        }
        EXPECT_NEAR(braking, 10, 2);
        EXPECT_NEAR(rig.drive.position - from, 180, 1);
        rig.run(20);
        EXPECT_EQ(rig.drive.power, PowerState::disabled);
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        EXPECT_EQ(rig.alarms.size(), 1u);
        rig.run(100);
        EXPECT_EQ(rig.drive.power, PowerState::disabled) << "until a reset, although Enable is TRUE";
        rig.axis.reset(Owner::program);
        ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
        rig.accept(absolute(0));
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    }
}

// A reset in the middle of it waits: the drive would be let go.
TEST(ErrorReaction, AResetWaitsForTheQuickStop) {
    Warned rig(ErrorReaction::quick_stop);
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::quick_stop; }, 5));
    rig.axis.reset(Owner::program);
    int braking = 0;
    while (rig.view().state == AxisState::ErrorStop && braking < 100) {
        const double before = rig.drive.position;
        rig.step();
        if (rig.drive.position == before) continue;
        ++braking;
        ASSERT_EQ(rig.drive.last.power, PowerRequest::quick_stop);
    }
    EXPECT_GE(braking, 7);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
}

// It stands: the quick stop is over as soon as it has begun.
TEST(ErrorReaction, QuickStopOfAnAxisThatStands) {
    Rig rig(reacting(AxisAlarm::drive_warning, ErrorReaction::quick_stop), [](FakeDrive& drive) { drive.quick_stop_stays = true; });
    rig.power_on();
    rig.drive.warning = true;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 5));
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::disabled; }, 20));
}

// While the axis already ramps down for one alarm, a harder one of another counts.
TEST(ErrorReaction, AnotherAlarmMayBeHarder) {
    auto config = reacting(AxisAlarm::drive_warning, ErrorReaction::ramp_stop);
    config.reactions.choose(AxisAlarm::axis_feedback_lost, ErrorReaction::power_off);
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(200);
    rig.drive.warning = true;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 5));
    rig.run(5);
    ASSERT_EQ(rig.drive.last.power, PowerRequest::on);
    rig.drive.silent = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.raised(AxisAlarm::axis_feedback_lost); }, 10));
    rig.run(1);
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
    EXPECT_GT(rig.view().set_velocity, 0);
}

// What is harder than the table's stop of a jog whose client has gone.
TEST(ErrorReaction, AJogThatNobodyRenewsMayEndInErrorStop) {
    Rig rig(reacting(AxisAlarm::jog_lease_expired, ErrorReaction::ramp_stop));
    rig.power_on();
    rig.accept(jog(20));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 400));
    rig.run(100);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view().set_velocity, 0);
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_TRUE(rig.axis.active_alarms().empty());
}

TEST(ErrorReaction, WhatTheMachineDoesAboutIt) {
    ErrorReactions reactions;
    EXPECT_EQ(reactions.of_machine(AxisAlarm::following_error), Reaction::stop_axis);
    EXPECT_EQ(reactions.of_machine(AxisAlarm::drive_mode_mismatch), Reaction::power_off);
    reactions.choose(AxisAlarm::following_error, ErrorReaction::warn);
    EXPECT_EQ(reactions.of_machine(AxisAlarm::following_error), Reaction::warn);
    reactions.choose(AxisAlarm::following_error, ErrorReaction::stop_machine);
    EXPECT_EQ(reactions.of_machine(AxisAlarm::following_error), Reaction::stop_machine);
    reactions.choose(AxisAlarm::following_error, ErrorReaction::power_off);
    EXPECT_EQ(reactions.of_machine(AxisAlarm::following_error), Reaction::stop_axis) << "its own power, nobody else's";
    reactions.choose(AxisAlarm::drive_mode_mismatch, ErrorReaction::quick_stop);
    EXPECT_EQ(reactions.of_machine(AxisAlarm::drive_mode_mismatch), Reaction::power_off) << "never less than the table's";
}

// For each alarm and each reaction: harder than the table's is always taken; milder never for what the table of the documentation forbids.
TEST(ErrorReaction, BoundsHoldForEachAlarmAndAreSaid) {
    const std::array never_milder{AxisAlarm::drive_fault,           AxisAlarm::drive_power_lost,      AxisAlarm::axis_feedback_lost,
                                  AxisAlarm::negative_limit_switch, AxisAlarm::positive_limit_switch, AxisAlarm::software_limit_reached,
                                  AxisAlarm::drive_too_fast,        AxisAlarm::drive_unknown_state,   AxisAlarm::master_lost};
    for (const auto& info : axis_alarms) {
        const auto alarm = static_cast<AxisAlarm>(info.id);
        for (const auto& word : reaction_words) {
            auto config = plain_axis();
            config.reactions.choose(alarm, word.reaction);
            const auto problems = check(config);
            const bool harder = word.reaction >= reaction_by_table(alarm);
            if (bound_of(alarm) == nullptr) {
                EXPECT_EQ(problems.size(), 1u) << info.name;
                continue;
            }
            if (harder) {
                EXPECT_TRUE(problems.empty()) << info.name << ' ' << word.name;
            }
            if (!harder && std::find(never_milder.begin(), never_milder.end(), alarm) != never_milder.end()) {
                ASSERT_EQ(problems.size(), 1u) << info.name << ' ' << word.name;
                EXPECT_EQ(problems[0].subject, "axes.x.reactions." + std::string(info.name));
                EXPECT_NE(problems[0].remedy.find("`ramp_then_off`"), std::string::npos);
            }
        }
    }
    for (const auto alarm : {AxisAlarm::emergency_stop, AxisAlarm::stopped_by_machine}) EXPECT_EQ(bound_of(alarm), nullptr);
}

}  // namespace
}  // namespace taktwerk::axes::test

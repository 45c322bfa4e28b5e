// MC_SyncAxisToGroup: what an axis does that follows the length of a path, whatever becomes of it meanwhile. The slave's own oracle (motion_oracle.hpp) holds
// in each cycle.

#include <gtest/gtest.h>

#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// The last axis is a pump; the group's paths are soft enough for it.
struct PumpRig : TrackRig {
    explicit PumpRig(AxisConfig pump = group_axis("pump", {.velocity = 100, .acceleration = 500, .deceleration = 500, .jerk = 10000}))
        : TrackRig(3, cartesian_arm(), std::move(pump)) {}
    ErrorId couple(std::int32_t numerator = 1, std::int32_t denominator = 1) {
        ErrorId error = ErrorId::none;
        step([&] { error = set(FollowPath{.slave = belt(), .numerator = numerator, .denominator = denominator}); });
        return error;
    }
    static GroupCommand soft(const JointVector& to, double velocity, MC_BufferMode mode = mcAborting) {
        auto move = line(to, velocity, mode);
        move.dynamics = {velocity, 200, 200, 2000};
        return move;
    }
    [[nodiscard]] const PathSlave& slave() const { return view().slaves[0]; }
};

// G-092: its coordinates get other numbers while it follows: nothing moves for that, as with any coupled axis (MC_SetPosition, Part 1), and it stays in sync.
TEST(GroupSlaves, ANewNumberForTheSlaveMovesNothing) {
    PumpRig rig;
    ASSERT_EQ(rig.couple(2), ErrorId::none);
    const auto move = rig.give(PumpRig::soft({90, 0, 0}, 20));
    ASSERT_EQ(move.error, ErrorId::none);
    rig.run(800);
    ASSERT_TRUE(rig.slave().in_sync);
    double shifted = 0;
    const double apart = rig.belt_at() - 2 * rig.view().path_gone;
    for (const double by : {5.0, -1e6, 0.01}) {
        rig.step([&] { ASSERT_EQ(rig.axes[rig.last].set(SetPosition{.position = by, .relative = true}, Owner::program), ErrorId::none); });
        shifted += by;
        for (int i = 0; i < 100; ++i) {
            rig.step();
            ASSERT_TRUE(rig.slave().in_sync);
            ASSERT_NEAR(rig.axis(rig.last).set_velocity, 2 * rig.view().path_velocity, 1e-9);
            ASSERT_NEAR(rig.belt_at() - shifted - 2 * rig.view().path_gone, apart, 1e-8);
        }
    }
}

// G-092: interrupted, continued, aborted, slowed down: the slave has gone what the path has, to the last digit.
TEST(GroupSlaves, ItGoesWhatThePathGoesWhateverBecomesOfThat) {
    PumpRig rig;
    ASSERT_EQ(rig.couple(-3, 4), ErrorId::none);
    rig.run(3);
    ASSERT_TRUE(rig.slave().in_sync);
    const double began = rig.belt_at(), gone = rig.view().path_gone;
    const auto look = [&] {
        ASSERT_TRUE(rig.slave().in_sync);
        ASSERT_NEAR(rig.belt_at() - began, -0.75 * (rig.view().path_gone - gone), 1e-9);
    };
    double length = 0;
    JointVector at = rig.point();
    const auto run = [&](int cycles) {
        for (int i = 0; i < cycles; ++i) {
            rig.step();
            double square = 0;
            for (std::size_t k = 0; k < 3; ++k) square += (rig.point()[k] - at[k]) * (rig.point()[k] - at[k]);
            length += std::sqrt(square);
            at = rig.point();
            ASSERT_NO_FATAL_FAILURE(look());
        }
    };
    const auto say = [&](const GroupCommand& command) {
        const auto answer = rig.submit(command);
        ASSERT_EQ(answer.error, ErrorId::none);
    };
    say(PumpRig::soft({80, 0, 0}, 30));
    run(500);
    say(simply(GroupCommandKind::interrupt, {0, 200, 200, 2000}));
    run(500);
    say(simply(GroupCommandKind::resume));
    run(300);
    ASSERT_EQ(rig.set(Override{.velocity = 0.2}), ErrorId::none);
    run(300);
    ASSERT_EQ(rig.set(Override{}), ErrorId::none);
    say(PumpRig::soft({0, 40, 10}, 25));
    run(700);
    say(simply(GroupCommandKind::halt, {0, 200, 200, 2000}));
    run(500);
    say(PumpRig::soft({0, 40, 10}, 25));
    say(PumpRig::soft({10, 10, 0}, 25, mcBuffered));
    run(6000);
    EXPECT_EQ(rig.view().state, GroupState::GroupStandby);
    // All lines are straight, so the sum of the steps is the way.
    EXPECT_NEAR(rig.view().path_gone - gone, length, 1e-6);
}

// What is superimposed on the slave (Part 1: beside any motion) comes on top of what it follows.
TEST(GroupSlaves, WhatIsSuperimposedComesOnTop) {
    PumpRig rig;
    ASSERT_EQ(rig.couple(), ErrorId::none);
    const auto move = rig.give(PumpRig::soft({90, 0, 0}, 20));
    ASSERT_EQ(move.error, ErrorId::none);
    rig.run(800);
    ASSERT_TRUE(rig.slave().in_sync);
    const double apart = rig.belt_at() - rig.view().path_gone;
    Submitted answer;
    rig.step([&] { answer = rig.axes[rig.last].submit(on_top(3, 10), Owner::program); });
    ASSERT_EQ(answer.error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(rig.last).status(answer.id) == CommandStatus::done; }, 2000));
    EXPECT_TRUE(rig.slave().in_sync);
    EXPECT_NEAR(rig.belt_at() - rig.view().path_gone, apart + 3, 1e-9);
}

// G-092: the group does not wait for its slave: where that can do less it is not in sync, keeps its limits (its oracle), and makes the distance up.
TEST(GroupSlaves, AWeakSlaveFallsBehindAndMakesItUp) {
    PumpRig rig(group_axis("pump", {.velocity = 25, .acceleration = 100, .deceleration = 100, .jerk = 1000}));
    ASSERT_EQ(rig.couple(), ErrorId::none);
    rig.run(3);
    ASSERT_TRUE(rig.slave().in_sync);
    const double apart = rig.belt_at() - rig.view().path_gone;
    const auto move = rig.give(line({60, 0, 0}, 40));
    bool lost = false;
    ASSERT_TRUE(rig.until(
        [&] {
            lost = lost || !rig.slave().in_sync;
            return rig.status(move.id) == CommandStatus::done;
        },
        5000));
    EXPECT_TRUE(lost);
    ASSERT_TRUE(rig.until([&] { return rig.slave().in_sync; }, 5000));
    rig.run(5);
    EXPECT_NEAR(rig.belt_at() - rig.view().path_gone, apart, 1e-9);
}

// Behind its software limit it would be: the command of the slave ends, and it stands in front of the limit.
TEST(GroupSlaves, TheSlaveStopsInFrontOfItsSoftwareLimit) {
    auto pump = group_axis("pump", {.velocity = 100, .acceleration = 500, .deceleration = 500, .jerk = 10000});
    pump.limits.position_min = -100;
    pump.limits.position_max = 30;
    pump.homing.kind = HomingKind::set_here;
    PumpRig rig(pump);
    rig.step([&] { ASSERT_EQ(rig.axes[rig.last].submit({.kind = CommandKind::home}, Owner::program).error, ErrorId::none); });
    rig.run(20);
    ASSERT_TRUE(rig.axis(rig.last).homed);
    ASSERT_EQ(rig.couple(), ErrorId::none);
    rig.run(2);
    const auto id = rig.slave().id;
    const auto move = rig.give(PumpRig::soft({60, 0, 0}, 20));
    ASSERT_TRUE(rig.until([&] { return rig.axis(rig.last).status(id) == CommandStatus::error; }, 4000));
    ErrorId why = ErrorId::none;
    (void)rig.axis(rig.last).status(id, &why);
    EXPECT_EQ(why, ErrorId::beyond_software_limit);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 5000));
    EXPECT_LE(rig.belt_at(), 30);
    EXPECT_GT(rig.belt_at(), 29);
    EXPECT_EQ(rig.slave().id, 0u);
}

// A slave in error, or without power, is one no more; the group goes its path.
TEST(GroupSlaves, AFaultOfTheSlaveIsNoneOfTheGroup) {
    PumpRig rig;
    ASSERT_EQ(rig.couple(), ErrorId::none);
    const auto move = rig.give(PumpRig::soft({60, 0, 0}, 20));
    rig.run(900);
    rig.drives[rig.last]->fault_code = 0x5441;
    ASSERT_TRUE(rig.until([&] { return rig.slave().id == 0; }, 50));
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 5000));
    EXPECT_EQ(rig.couple(), ErrorId::in_error_stop);
}

// Each of four slaves has its place; a fifth has none. One that gets a new ratio keeps its own.
TEST(GroupSlaves, FourHavePlacesAndAFifthHasNone) {
    auto configs = GroupRig::named(3);
    for (int i = 0; i < 5; ++i) configs.push_back(group_axis("p" + std::to_string(i)));
    GroupRig rig(configs, GroupRig::all_of(GroupRig::named(3), cartesian_arm()));
    rig.enable();
    for (std::uint16_t i = 3; i < 7; ++i) EXPECT_EQ(rig.set(FollowPath{.slave = {i}}), ErrorId::none);
    EXPECT_EQ(rig.set(FollowPath{.slave = {7}}), ErrorId::not_supported);
    EXPECT_EQ(rig.set(FollowPath{.slave = {4}, .numerator = 2}), ErrorId::none);
    rig.run(3);
    const auto move = rig.give(PumpRig::soft({30, 0, 0}, 20));
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 5000));
    rig.run(2);
    for (std::size_t i = 3; i < 7; ++i) EXPECT_NEAR(rig.axis(i).set_position, i == 4 ? 60 : 30, 1e-9);
}

}  // namespace
}  // namespace taktwerk::axes::test

// A group that is jogged by hand. The rig asserts limits, continuity and "told = shown" of every member in every cycle.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

// G-089: ACS. The member goes at its jogging velocity and stops on its own ramp: from 20 u/s with 200 u/s2 and 2000 u/s3 the least way is
// v^2/2a + v a/2j = 1 + 1 = 2.
TEST(GroupJog, AMemberGoesWhileItIsHeld) {
    JogRig rig(2);
    rig.press({1, 0});
    EXPECT_EQ(rig.answer.error, ErrorId::none);
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(0).set_velocity > 19.9; }, 600));
    EXPECT_EQ(rig.view().state, GroupMoving);
    rig.hold_for(300);
    EXPECT_NEAR(rig.axis(0).set_velocity, 20, 0.02) << "at its jogging velocity";
    EXPECT_EQ(rig.axis(1).set_position, 0);
    const double at = rig.point()[0];
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1000));
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
    EXPECT_GE(rig.point()[0] - at, 2.0);
    EXPECT_LE(rig.point()[0] - at, 2.0 + 20 * 0.25) << "the planner's lead and the piece under way";
}

// G-089: a product that is turned by a right angle has its X along the machine's Y, and its -Y along the machine's X.
TEST(GroupJog, GoesInTheDirectionsOfAProduct) {
    JogRig rig(3, cartesian_arm());
    const auto frame = rig.give({.kind = GroupCommandKind::set_frame, .frame = mcPCS_2, .target = {10, 20, 3, 0, 0, std::numbers::pi / 2}});
    ASSERT_EQ(frame.error, ErrorId::none);
    const auto begin = rig.point();
    rig.frame = mcPCS_2;
    rig.press({1, 0, 0});
    ASSERT_EQ(rig.answer.error, ErrorId::none);
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(1).set_velocity > 19.9; }, 600)) << "positive along Y";
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1000));
    EXPECT_GT(rig.point()[1] - begin[1], 2);
    EXPECT_NEAR(rig.point()[0], begin[0], 1e-9);
    EXPECT_NEAR(rig.point()[2], begin[2], 1e-9);
}

// G-089: both inputs of a slot are the direction 0 of it; nothing moves, and the group is in GroupStandby. A direction of nothing is no jog.
TEST(GroupJog, WhatIsNoJogIsRefused) {
    JogRig rig(2, plane_arm());
    const auto refused = [&](GroupCommand command) { return rig.submit(command).error; };
    const GroupCommand jog{.kind = GroupCommandKind::jog, .target = {1, 0}};
    EXPECT_EQ(refused({.kind = GroupCommandKind::jog}), ErrorId::invalid_parameter) << "no direction";
    auto one = jog;
    one.target[5] = 1;
    EXPECT_EQ(refused(one), ErrorId::invalid_parameter) << "a slot without a member";
    one = jog;
    one.target[0] = 1.5;
    EXPECT_EQ(refused(one), ErrorId::invalid_parameter);
    one.target[0] = std::nan("");
    EXPECT_EQ(refused(one), ErrorId::invalid_parameter);
    one = jog;
    one.jog.linear = -1;
    EXPECT_EQ(refused(one), ErrorId::invalid_parameter);
    one = jog;
    one.jog.velocity = 1.1;
    EXPECT_EQ(refused(one), ErrorId::invalid_override);
    one.jog.velocity = 1;
    one.jog.acceleration = 0;
    EXPECT_EQ(refused(one), ErrorId::invalid_override);
    one = jog;
    one.buffer_mode = mcBuffered;
    EXPECT_EQ(refused(one), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(rig.view().state, GroupStandby);
    one = jog;
    one.frame = mcFCS;
    EXPECT_EQ(refused(one), ErrorId::not_supported);
    GroupRig bare(2);
    bare.enable();
    EXPECT_EQ(bare.submit(jog).error, ErrorId::invalid_velocity) << "no jogging dynamics";
    one = jog;
    one.frame = mcMCS;
    EXPECT_EQ(bare.submit(one).error, ErrorId::no_kinematics);
    JoggingDynamics bad = slow_jogging();
    bad.velocity[3] = std::nan("");
    EXPECT_EQ(rig.set(WriteJoggingDynamics{bad}), ErrorId::invalid_velocity);
    bad = slow_jogging();
    bad.path.jerk = INFINITY;
    EXPECT_EQ(rig.set(WriteJoggingDynamics{bad}), ErrorId::invalid_dynamics);
    EXPECT_EQ(rig.view().jogging_dynamics, slow_jogging()) << "nothing was written";
    EXPECT_EQ(rig.submit(jog).error, ErrorId::none);
}

// G-089: each member at its own jogging velocity, all of them on one straight line; a change of the keys stands first.
TEST(GroupJog, MembersGoOnOneLineAndChangeItAtRest) {
    auto dynamics = slow_jogging();
    dynamics.velocity[1] = 5;
    JogRig rig(2, {}, dynamics);
    const auto from = rig.path.size();
    rig.press({1, -1});
    rig.hold_for(500);
    EXPECT_NEAR(rig.axis(0).set_velocity, 20, 0.02);
    EXPECT_NEAR(rig.axis(1).set_velocity, -5, 0.005);
    const auto before = rig.path.size();
    EXPECT_LE(rig.deviation({0, 0}, {4, -1}, from), 1e-9);
    rig.press({1, 0});
    std::size_t turned = 0;
    ASSERT_TRUE(rig.until_held(
        [&] {
            if (rig.axis(0).set_velocity == 0 && turned == 0) turned = rig.path.size();
            return turned != 0 && rig.axis(0).set_velocity > 19.9;
        },
        1500));
    const auto corner = rig.path[turned - 1];
    for (std::size_t n = before; n < turned; ++n) EXPECT_NEAR(rig.path[n][0], -4 * rig.path[n][1], 1e-8) << "brakes on the first line";
    for (std::size_t n = turned; n < rig.path.size(); ++n) EXPECT_NEAR(rig.path[n][1], corner[1], 1e-12) << "goes on along the other";
    EXPECT_EQ(rig.view().last_id, rig.answer.id) << "one command";
}

// Nothing is jogged faster than somebody has said (docs/motion/group-decisions.md): a member without a jogging velocity is not jogged, also where the
// keys come to it while another one is held; and what was held before lets go.
TEST(GroupJog, AMemberWithoutAJoggingVelocityIsNeverJogged) {
    auto dynamics = slow_jogging();
    dynamics.velocity = {20};
    JogRig rig(2, {}, dynamics);
    EXPECT_EQ(rig.submit({.kind = GroupCommandKind::jog, .target = {0, 1}}).error, ErrorId::invalid_velocity);
    rig.press({1, 0});
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(0).set_velocity > 19.9; }, 600));
    for (const JointVector& other : {JointVector{0, 1}, JointVector{1, 1}}) {
        EXPECT_EQ(rig.set(HoldJog{.id = rig.answer.id, .direction = other}), ErrorId::invalid_velocity);
    }
    EXPECT_EQ(rig.set(HoldJog{.id = rig.answer.id, .direction = {0, 0, 1}}), ErrorId::invalid_parameter) << "a slot without a member";
    rig.run(150);  // the lease of 200 ms has not run out
    EXPECT_LT(rig.axis(0).set_velocity, 15) << "let go";
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 500));
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
    rig.run(2000);
    EXPECT_EQ(rig.point()[1], 0);
}

// Turns of the tool are as fast as its slowest turning member is jogged; so each of them has to have a velocity. Ways of the tool have their own.
TEST(GroupJog, AToolTurnsOnlyAsFastAsSomebodyHasSaid) {
    const auto arms = every_kind_of_arm();
    const auto& arm = *std::find_if(arms.begin(), arms.end(), [](const JogArm& a) { return a.name == "cartesian"; });
    auto dynamics = slow_jogging();
    dynamics.velocity[3] = 0;  // the turning one
    JogRig rig(axes_of(arm), arm_of(arm.description), dynamics);
    rig.frame = mcMCS;
    rig.press({0, 0, 0, 0, 0, 1});
    EXPECT_EQ(rig.answer.error, ErrorId::invalid_velocity);
    rig.press({1});
    ASSERT_EQ(rig.answer.error, ErrorId::none);
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(0).set_velocity > 19.9; }, 600));
    EXPECT_EQ(rig.set(HoldJog{.id = rig.answer.id, .direction = {0, 0, 0, 0, 0, 1}}), ErrorId::invalid_velocity);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 500));
    EXPECT_EQ(rig.point()[3], 0);
}

std::vector<AxisConfig> homed_axes(std::size_t count, double high) {
    auto axes = GroupRig::named(count);
    for (auto& axis : axes) {
        axis.limits.position_min = -high;
        axis.limits.position_max = high;
        axis.homing.kind = HomingKind::set_here;
    }
    return axes;
}
void home_all(GroupRig& rig) {
    for (auto& axis : rig.axes) {
        ASSERT_EQ(axis.submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
    }
    ASSERT_TRUE(rig.until(
        [&] {
            bool all = true;
            for (std::size_t i = 0; i < rig.axes.size(); ++i) all = all && rig.axis(i).homed && rig.axis(i).state == AxisState::Standstill;
            return all;
        },
        100));
}

// G-091: it stops at a limit, exactly, without an error; a member at its limit does not keep the other one; and it comes back.
TEST(GroupJog, ALimitEndsItWithoutAnError) {
    auto dynamics = slow_jogging();
    dynamics.velocity[1] = 10;
    JogRig rig(homed_axes(2, 10), {}, dynamics);
    home_all(rig);
    rig.press({1, 1});
    ASSERT_TRUE(rig.until_held([&] { return rig.point()[0] == 10; }, 1500));
    EXPECT_LT(rig.point()[1], 5.1);
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1500));
    EXPECT_EQ(rig.point()[1], 10) << "the other one went on to its own";
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
    EXPECT_EQ(rig.view().error, 0);
    rig.hold_for(50);
    EXPECT_EQ(rig.view().state, GroupStandby) << "still held: nothing comes of it";
    rig.press({});
    rig.press({1, 0});
    ASSERT_TRUE(rig.until_held([&] { return rig.status(rig.answer.id) == CommandStatus::done; }, 100)) << "no way there: done";
    rig.press({});
    rig.press({-1, 0});
    ASSERT_TRUE(rig.until_held([&] { return rig.point()[0] < 5; }, 1500));
}

// G-090: a distance is gone exactly, from where the key was pressed, in both directions; the next press goes the next one.
TEST(GroupJog, ADistanceIsGoneExactly) {
    JogRig rig(3, cartesian_arm());
    rig.pins.linear = 2.5;
    for (const auto& [frame, direction, to] : {std::tuple{mcACS, JointVector{1, 0, 0}, JointVector{2.5, 0, 0}},
                                               std::tuple{mcACS, JointVector{0, -1, 0}, JointVector{2.5, -2.5, 0}},
                                               std::tuple{mcMCS, JointVector{0, 0, 1}, JointVector{2.5, -2.5, 2.5}},
                                               std::tuple{mcMCS, JointVector{-1, 0, 0}, JointVector{0, -2.5, 2.5}}}) {
        rig.frame = frame;
        rig.press(direction);
        ASSERT_EQ(rig.answer.error, ErrorId::none);
        ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 1500));
        EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rig.point()[k], to[k], 1e-12) << k;
        rig.press({});
    }
}

// A distance that is none at all is an error: else it would count as gone, and nobody would see that nothing moved. A distance that is gone is none.
TEST(GroupJog, ADistanceThatIsNoneIsAnError) {
    JogRig rig(3, cartesian_arm());
    for (const auto frame : {mcACS, mcMCS}) {
        rig.frame = frame;
        rig.pins.linear = 1e-12;
        rig.press({1, 0, 0});
        ASSERT_EQ(rig.answer.error, ErrorId::none);
        ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 100));
        EXPECT_EQ(rig.error_of(rig.answer.id), ErrorId::invalid_position) << frame;
        EXPECT_EQ(rig.view().state, GroupStandby);
        rig.press({});
        rig.pins.linear = 1e-3;
        rig.press({1, 0, 0});
        ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 100));
        EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done) << frame;
        EXPECT_EQ(rig.view().jog_end, JogEnd::distance);
        rig.press({});
    }
    EXPECT_NEAR(rig.point()[0], 2e-3, 1e-12);
}

// G-090: a jog takes the place of what runs, which brakes on its own path first; nothing is buffered behind a jog; any aborting command takes over.
TEST(GroupJog, AJogTakesOverAndIsTakenOver) {
    JogRig rig(2);
    const auto from = rig.path.size();
    const auto move = rig.give(line({60, 30}, 40));
    ASSERT_TRUE(rig.until([&] { return rig.view().path_velocity > 30; }, 1000));
    rig.press({0, 1});
    EXPECT_EQ(rig.status(move.id), CommandStatus::aborted);
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(0).set_velocity == 0; }, 1000));
    const auto stood = rig.path.size();
    for (std::size_t n = from; n < stood; ++n) EXPECT_NEAR(rig.path[n][0], 2 * rig.path[n][1], 1e-8);
    ASSERT_TRUE(rig.until_held([&] { return rig.axis(1).set_velocity > 19; }, 1000));
    EXPECT_EQ(rig.submit(line({0, 0}, 10, mcBuffered)).error, ErrorId::state_forbids);
    EXPECT_EQ(rig.submit({.kind = GroupCommandKind::wait, .buffer_mode = mcBuffered, .duration = 1ms}).error, ErrorId::state_forbids);
    const auto back = rig.submit(line({0, 0}, 10));
    EXPECT_EQ(back.error, ErrorId::none);
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::aborted);
    ASSERT_TRUE(rig.until([&] { return rig.status(back.id) == CommandStatus::done; }, 8000));
    EXPECT_EQ(rig.point(), JointVector{});
    // Stop, interrupt and disable end it too.
    rig.press({});
    rig.press({1, 0});
    rig.hold_for(200);
    const auto interrupt = rig.submit(simply(GroupCommandKind::interrupt));
    ASSERT_EQ(interrupt.error, ErrorId::none);
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::aborted);
    ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::resume)).error, ErrorId::none) << "there is nothing to go on with";
    rig.run(20);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_EQ(rig.axis(0).set_velocity, 0);
}

// Who jogs has to say so: after the members' lease (200 ms) the group stops, and the command was aborted.
TEST(GroupJog, NobodyRenewsIt) {
    JogRig rig(2);
    rig.press({1, 0});
    rig.hold_for(400);
    EXPECT_EQ(rig.view().state, GroupMoving);
    rig.run(190);
    EXPECT_NEAR(rig.axis(0).set_velocity, 20, 0.02) << "a gap that is shorter";
    rig.hold_for(1);
    rig.run(199);
    EXPECT_NEAR(rig.axis(0).set_velocity, 20, 0.02);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 500));
    EXPECT_EQ(rig.status(rig.held.id), CommandStatus::aborted);
    EXPECT_EQ(rig.set(rig.held), ErrorId::unknown_command) << "it does not come back";
}

// G-070, G-091: the group's override and the hand's share act on it at once; 0 holds.
TEST(GroupJog, SharesOfTheVelocityActAtOnce) {
    JogRig rig(2);
    rig.press({1, 0});
    rig.hold_for(400);
    rig.held.velocity = 0.5;
    rig.hold_for(300);
    EXPECT_NEAR(rig.axis(0).set_velocity, 10, 0.02);
    EXPECT_EQ(rig.view().limiter, PathLimiter::command) << "half was asked for: no override holds it down";
    ASSERT_EQ(rig.set(Override{0.5, 1, 1}), ErrorId::none);
    rig.hold_for(300);
    EXPECT_NEAR(rig.axis(0).set_velocity, 5, 0.02);
    EXPECT_EQ(rig.view().limiter, PathLimiter::override_factor);
    rig.held.velocity = 0;
    rig.hold_for(400);
    EXPECT_EQ(rig.axis(0).set_velocity, 0);
    EXPECT_EQ(rig.view().state, GroupMoving);
    rig.held.velocity = 1;
    rig.hold_for(400);
    EXPECT_NEAR(rig.axis(0).set_velocity, 10, 0.02);
}

/// A SCARA of 200 and 150, its tool at (200, 150): the elbow at a right angle.
JogArm bent_scara() { return arm_in_degrees("scara", ScaraLengths{.first = 200, .second = 150}, {true, true, false, true}, {0, 90, 0, 0}); }
struct ScaraRig : JogRig {
    ScaraRig() : JogRig(loose(axes_of(bent_scara())), arm_of(bent_scara().description), jogging_of_arms()) {
        const auto there = give({.kind = GroupCommandKind::direct_absolute, .target = bent_scara().start});
        EXPECT_TRUE(until([&] { return status(there.id) == CommandStatus::done; }, 5000));
        run(3);
    }
    static std::vector<AxisConfig> loose(std::vector<AxisConfig> axes) {
        for (auto& axis : axes) axis.limits.position_min = -(axis.limits.position_max = 1e6);
        return axes;
    }
    [[nodiscard]] double elbow() const { return std::sin(point()[1] * std::numbers::pi / 180); }
};

// G-033, G-091: in MCS the tool goes straight while it starts, cruises and brakes. Its velocity is the jogging one, or what a member's leaves. By hand:
// the tool is where two links put it.
TEST(GroupJog, TheToolGoesStraight) {
    ScaraRig rig;
    rig.frame = mcMCS;
    const auto from = rig.path.size();
    rig.press({-1, 0.5});
    double fastest = 0;
    for (int i = 0; i < 700; ++i) {
        rig.hold_for(1);
        fastest = std::max(fastest, rig.view().path_velocity);
    }
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1500));
    for (std::size_t n = from; n < rig.path.size(); ++n) {
        const double a = rig.path[n][0] * std::numbers::pi / 180, b = a + rig.path[n][1] * std::numbers::pi / 180;
        const double x = 200 * std::cos(a) + 150 * std::cos(b) - 200, y = 200 * std::sin(a) + 150 * std::sin(b) - 150;
        ASSERT_LE(std::abs(0.5 * x + y) / std::hypot(1, 0.5), 1e-9 * 250);
        ASSERT_NEAR(rig.path[n][0] + rig.path[n][1] + rig.path[n][3], 90, 1e-9) << "the tool does not turn";
    }
    EXPECT_LT(rig.point()[1] - 90, 60);
    EXPECT_GT(fastest, 60) << "a member at 40 degrees a second leaves so much here";
    EXPECT_LE(fastest, 100 * (1 + 1e-6));
}

// G-091: it ends in front of the singularity, where the sine of the elbow is 0.02, without an error; it can be jogged back. In the singularity itself
// the pose cannot be jogged, and that is said; a jog of the axes leads out.
TEST(GroupJog, ASingularityEndsItAndTheAxesLeadOut) {
    ScaraRig rig;
    rig.frame = mcMCS;
    rig.press({1});
    ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 8000));
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
    EXPECT_NEAR(rig.elbow(), 0.02, 1e-6);
    EXPECT_GE(rig.elbow(), 0.02);
    rig.hold_for(100);
    EXPECT_EQ(rig.view().state, GroupStandby);
    rig.press({});
    rig.press({1});
    ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 100));
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done) << "again: no way, and no error";
    rig.press({});
    rig.press({-1});
    ASSERT_TRUE(rig.until_held([&] { return rig.elbow() > 0.3; }, 3000)) << "back";
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1500));

    rig.frame = mcACS;
    rig.pins.angular = rig.point()[1];
    rig.press({0, -1});
    ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 3000));
    EXPECT_NEAR(rig.point()[1], 0, 1e-12) << "straight";
    rig.pins = {};
    rig.frame = mcMCS;
    rig.press({});
    rig.press({-1});
    ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 100));
    EXPECT_EQ(rig.error_of(rig.answer.id), ErrorId::singular_path);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_EQ(rig.view().error, 0);
    rig.frame = mcACS;
    rig.press({});
    rig.press({0, 1});
    ASSERT_TRUE(rig.until_held([&] { return rig.elbow() > 0.1; }, 1000));
    rig.press({});
    ASSERT_TRUE(rig.until_held([&] { return rig.view().state == GroupStandby; }, 1500));
    rig.frame = mcMCS;
    rig.press({-1});
    const double x = rig.view().tool_set[0];
    ASSERT_TRUE(rig.until_held([&] { return rig.view().tool_set[0] < x - 20; }, 1500));
}

// What a jog met is in the view: which member's limit, which room, or a turn that the arm does not have (not its reach).
TEST(GroupJog, WhatItMetIsSaid) {
    JogRig limited(homed_axes(2, 10), {});
    home_all(limited);
    limited.press({0, 1});
    ASSERT_TRUE(limited.until_held([&] { return limited.active() == false; }, 1500));
    limited.press({});
    limited.press({0, 1});
    ASSERT_TRUE(limited.until_held([&] { return !limited.active(); }, 100));
    EXPECT_EQ(limited.view().jog_end, JogEnd::member_limit);
    EXPECT_EQ(limited.view().jog_hindrance.place, 1);

    WorkspaceRoom far{.name = "far", .shape = WorkspaceRoom::Shape::box, .kept_free = true, .half = {1, 1, 1}}, cell = far;
    far.middle.position = {500, 0, 0};
    cell.kept_free = false;
    cell.half = {3, 100, 100};
    JogRig walled(GroupRig::named(2), plane_arm(), {far, cell});
    walled.frame = mcMCS;
    for (int presses = 0; presses < 2; ++presses) {
        walled.press({1, 0});
        ASSERT_TRUE(walled.until_held([&] { return !walled.active(); }, 2000));
        walled.press({});
    }
    EXPECT_EQ(walled.view().jog_end, JogEnd::workspace);
    EXPECT_EQ(walled.view().jog_hindrance.room, 1);

    ScaraRig scara;
    scara.frame = mcMCS;
    scara.press({0, 0, 0, 1});
    ASSERT_TRUE(scara.until_held([&] { return !scara.active(); }, 100));
    EXPECT_EQ(scara.view().jog_end, JogEnd::orientation);
}

// G-089, G-090: a turn of the tool about its own point, by its distance: the point stays.
TEST(GroupJog, TheToolTurnsAboutItsPoint) {
    ScaraRig rig;
    rig.frame = mcMCS;
    rig.pins.angular = 0.5;
    const auto at = rig.view().tool_set;
    rig.press({0, 0, 0, 0, 0, 1});
    ASSERT_TRUE(rig.until_held(
        [&] {
            EXPECT_NEAR(rig.view().tool_set[0], at[0], 1e-9 * 250);
            EXPECT_NEAR(rig.view().tool_set[1], at[1], 1e-9 * 250);
            // As fast as the slowest turning member is jogged: 40 degrees a second.
            EXPECT_LE(std::abs(rig.view().tool_velocity[5]), 40 * std::numbers::pi / 180 * (1 + 1e-6));
            return !rig.active();
        },
        3000));
    EXPECT_NEAR(rig.view().tool_set[5] - at[5], 0.5, 1e-12);
}

// The rods of a delta meet at every place that its axes are jogged to.
TEST(GroupJog, ADeltasRodsMeet) {
    const auto arms = every_kind_of_arm();
    const auto& delta = *std::find_if(arms.begin(), arms.end(), [](const JogArm& arm) { return arm.name == "linear_delta"; });
    const auto kinematics = arm_of(delta.description);
    JogRig rig(ScaraRig::loose(axes_of(delta)), kinematics, jogging_of_arms());
    rig.press({1, 0, 0});  // one carriage away from the others, until its rod is too short
    ASSERT_TRUE(rig.until_held([&] { return !rig.active(); }, 30000));
    EXPECT_EQ(rig.status(rig.answer.id), CommandStatus::done);
    EXPECT_GT(rig.point()[0], 100);
    const auto miss_at = [&](double more) {
        Joints q{};
        q[0] = rig.point()[0] + more;
        return kinematics->forward(q, {}).miss;
    };
    EXPECT_TRUE(miss_at(0).ok());
    EXPECT_FALSE(miss_at(1e-3).ok()) << "as far as there is a place for the tool";
    rig.press({});
    rig.press({-1, 0, 0});
    ASSERT_TRUE(rig.until_held([&] { return rig.point()[0] < 100; }, 30000));
}

}  // namespace
}  // namespace taktwerk::axes::test

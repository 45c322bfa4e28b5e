// Frames and tools of a group: what a command takes with it, and when a change counts. Expected places by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/guard/allocation_guard.hpp"
#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;
constexpr double right_angle = std::numbers::pi / 2;
constexpr double rad_per_degree = std::numbers::pi / 180;

GroupCommand in(MC_CoordSystem frame, GroupCommand command) {
    command.frame = frame;
    return command;
}
GroupCommand set_frame(MC_CoordSystem frame, const JointVector& six, MC_ExecutionMode mode = mcImmediately) {
    return {.kind = GroupCommandKind::set_frame, .frame = frame, .target = six, .execution = mode};
}
GroupCommand write_tool(std::uint8_t number, const SixNumbers& frame, MC_ExecutionMode mode = mcImmediately) {
    GroupCommand command{.kind = GroupCommandKind::write_tool, .execution = mode, .number = number};
    command.tool.frame = frame;
    return command;
}
void expect_at(const GroupRig& rig, double x, double y, double z) {
    EXPECT_NEAR(rig.point()[0], x, 1e-9);
    EXPECT_NEAR(rig.point()[1], y, 1e-9);
    EXPECT_NEAR(rig.point()[2], z, 1e-9);
}
bool done(GroupRig& rig, CommandId id) {
    return rig.until([&] { return rig.status(id) != CommandStatus::active && rig.status(id) != CommandStatus::queued; }, 9000) &&
           rig.status(id) == CommandStatus::done;
}

// G-073, G-074: the product's X is the machine's Y. Of (5, 0, 0) in it: (10, 20) + 5 along Y. The tool does not turn: in the product it stands at -90
// degrees.
TEST(GroupFrames, APositionInAProductFrame) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give(set_frame(mcPCS_2, {10, 20, 3, 0, 0, right_angle})).error, ErrorId::none);
    const auto move = rig.give(in(mcPCS_2, line({5, 0, 0, 0, 0, -right_angle}, 50)));
    ASSERT_EQ(move.error, ErrorId::none);
    ASSERT_TRUE(done(rig, move.id)) << static_cast<int>(rig.error_of(move.id));
    expect_at(rig, 10, 25, 3);
    // By (1, 2, 0) of the product: its X is the machine's Y, its Y is against the machine's X.
    const auto by = rig.give(in(mcPCS_2, line_by({1, 2, 0}, 50)));
    ASSERT_TRUE(done(rig, by.id));
    expect_at(rig, 8, 26, 3);
    // The other products stay at the world's origin.
    const auto first = rig.give(in(mcPCS, line({7, 1, 0}, 50)));
    ASSERT_TRUE(done(rig, first.id));
    expect_at(rig, 7, 1, 0);
}

// G-073: WCS -> MCS and WCS -> PCS. The machine stands at (100, 0, 0) of the world and is turned by 90 degrees: the world's (100, 7, 0) is 7 along the
// machine's X.
TEST(GroupFrames, TheMachineStandsInTheWorld) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give(set_frame(mcMCS, {100, 0, 0, 0, 0, right_angle})).error, ErrorId::none);
    const auto world = rig.give(in(mcWCS, line({100, 7, 1, 0, 0, right_angle}, 50)));
    ASSERT_TRUE(done(rig, world.id));
    expect_at(rig, 7, 0, 1);
    // A product at (90, 10, 0) of the world, not turned: 10 against the world's X is the machine's Y, 10 along the world's Y the machine's X.
    ASSERT_EQ(rig.give(set_frame(mcPCS, {90, 10, 0})).error, ErrorId::none);
    const auto product = rig.give(in(mcPCS, line({0, 0, 0, 0, 0, right_angle}, 50)));
    ASSERT_TRUE(done(rig, product.id));
    expect_at(rig, 10, 10, 0);
    const auto machine = rig.give(in(mcMCS, line({1, 2, 3}, 50)));
    ASSERT_TRUE(done(rig, machine.id));
    expect_at(rig, 1, 2, 3);
}

// G-029: neither the running nor a waiting command is bent by a frame that changes; what is accepted later goes by the new one.
TEST(GroupFrames, AChangeBendsNothingThatWasAccepted) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give(set_frame(mcPCS, {10, 0, 0})).error, ErrorId::none);
    const auto from = rig.path.size();
    const auto running = rig.give(in(mcPCS, line({20, 0, 0}, 50)));
    const auto waiting = rig.give(in(mcPCS, line({20, 10, 0}, 50, mcBuffered)));
    rig.run(100);
    ASSERT_EQ(rig.status(running.id), CommandStatus::active);
    ASSERT_EQ(rig.give(set_frame(mcPCS, {0, 5, 7})).error, ErrorId::none);
    const auto later = rig.give(in(mcPCS, line({20, 10, 0}, 50, mcBuffered)));
    ASSERT_TRUE(done(rig, running.id));
    EXPECT_NEAR(rig.deviation({0, 0, 0}, {30, 0, 0}, from), 0, 1e-9);
    ASSERT_TRUE(done(rig, waiting.id));
    expect_at(rig, 30, 10, 0);
    ASSERT_TRUE(done(rig, later.id));
    expect_at(rig, 20, 15, 7);
}

// G-028: queued, a frame changes between the motions it stands between, without a stop of a blended path; a command behind it has it, one in front not.
TEST(GroupFrames, AQueuedFrameHasItsPlaceBetweenMotions) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    const auto first = rig.give(in(mcPCS, line({30, 0, 0}, 50)));
    const auto setting = rig.give(set_frame(mcPCS, {0, 0, 5}, mcQueued));
    ASSERT_EQ(setting.error, ErrorId::none);
    auto second = in(mcPCS, line({30, 30, -5}, 50, mcBlendingHigh));
    second.transition = mcTMCornerDistance;
    second.transition_parameter = 4;
    const auto next = rig.give(second);
    EXPECT_EQ(rig.status(setting.id), CommandStatus::queued);
    EXPECT_EQ(rig.groups.equipment(GroupRig::ref)->frames.product[0][2], 0) << "not yet";
    double slowest = 1e9;
    ASSERT_TRUE(rig.until(
        [&] {
            if (rig.point()[0] > 20 && rig.point()[1] < 10) slowest = std::min(slowest, rig.view().path_velocity);
            return rig.status(first.id) == CommandStatus::done;
        },
        5000));
    EXPECT_EQ(rig.status(setting.id), CommandStatus::done);
    EXPECT_EQ(rig.status(next.id), CommandStatus::active);
    EXPECT_EQ(rig.groups.equipment(GroupRig::ref)->frames.product[0][2], 5);
    ASSERT_TRUE(done(rig, next.id));
    expect_at(rig, 30, 30, 0);
    EXPECT_GT(slowest, 5) << "no stop at the corner";
}

// G-028: delayed, it counts when the running command is over: in front of what waits. What waits keeps what it was accepted with (G-029).
TEST(GroupFrames, ADelayedFrameComesBehindTheRunningCommand) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    const auto running = rig.give(in(mcPCS, line({20, 0, 0}, 50)));
    const auto waiting = rig.give(in(mcPCS, line({20, 20, 0}, 50, mcBuffered)));
    const auto setting = rig.give(set_frame(mcPCS, {0, 0, 5}, mcDelayed));
    const auto behind = rig.give(in(mcPCS, line({20, 20, 5}, 50, mcBuffered)));
    ASSERT_TRUE(done(rig, running.id));
    ASSERT_TRUE(rig.until([&] { return rig.status(waiting.id) == CommandStatus::active; }, 50));
    EXPECT_EQ(rig.status(setting.id), CommandStatus::done);
    ASSERT_TRUE(done(rig, waiting.id));
    expect_at(rig, 20, 20, 0);
    ASSERT_TRUE(done(rig, behind.id));
    expect_at(rig, 20, 20, 10);
}

// G-028: what waits and is aborted never counts; at standstill all three ways are at once.
TEST(GroupFrames, AnAbortedFrameNeverCounts) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    (void)rig.give(in(mcPCS, line({20, 0, 0}, 50)));
    const auto setting = rig.give(set_frame(mcPCS, {0, 0, 5}, mcQueued));
    rig.run(20);
    const auto aborting = rig.give(in(mcPCS, line({10, 0, 0}, 50)));
    EXPECT_EQ(rig.status(setting.id), CommandStatus::aborted);
    ASSERT_TRUE(done(rig, aborting.id));
    expect_at(rig, 10, 0, 0);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 20));
    for (const auto mode : {mcImmediately, mcQueued, mcDelayed}) {
        const auto at_once = rig.give(set_frame(mcPCS, {static_cast<double>(mode), 0, 0}, mode));
        EXPECT_EQ(rig.status(at_once.id), CommandStatus::done);
        EXPECT_EQ(rig.groups.equipment(GroupRig::ref)->frames.product[0][0], static_cast<double>(mode));
    }
}

TEST(GroupFrames, WhatCannotBeSetIsRefused) {
    GroupRig rig(3, cartesian_arm());
    for (const auto frame : {mcACS, mcWCS, mcFCS, mcTCS})
        EXPECT_EQ(rig.submit(set_frame(frame, {1})).error, ErrorId::not_supported) << static_cast<int>(frame);
    EXPECT_EQ(rig.submit(set_frame(static_cast<MC_CoordSystem>(mcPCS_8 + 1), {1})).error, ErrorId::invalid_parameter);
    EXPECT_EQ(rig.submit(set_frame(mcPCS, {std::nan("")})).error, ErrorId::invalid_position);
    EXPECT_EQ(rig.submit(set_frame(mcPCS, {1e13})).error, ErrorId::invalid_position) << "no place of a machine";
    EXPECT_EQ(rig.submit(write_tool(1, {1e13})).error, ErrorId::invalid_position);
    EXPECT_EQ(rig.submit(set_frame(mcPCS, {1})).error, ErrorId::none) << "also of a disabled group: nothing moves";
    EXPECT_EQ(rig.submit(write_tool(0, {})).error, ErrorId::invalid_tool);
    EXPECT_EQ(rig.submit(write_tool(32, {})).error, ErrorId::invalid_tool);
    rig.enable();
    EXPECT_EQ(rig.submit(in(mcFCS, line({1, 0, 0}, 10))).error, ErrorId::not_supported);
    EXPECT_EQ(rig.submit(in(static_cast<MC_CoordSystem>(mcPCS_8 + 1), line({1, 0, 0}, 10))).error, ErrorId::invalid_parameter);
    GroupRig axes(2);
    axes.enable();
    EXPECT_EQ(axes.submit(in(mcPCS, line({1, 0}, 10))).error, ErrorId::no_kinematics);
}

/// Two links of 200 and 150, degrees.
Arm scara_arm() {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = rad_per_degree;
    return arm_of(description);
}
std::vector<AxisConfig> axes_of_scara() {
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    return {group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)};
}
/// A point that stands `ahead` in front of the flange, by hand.
std::array<double, 2> point_ahead(const JointVector& q, double ahead) {
    const double a = q[0] * rad_per_degree, b = a + q[1] * rad_per_degree, c = b + q[3] * rad_per_degree;
    return {200 * std::cos(a) + 150 * std::cos(b) + ahead * std::cos(c), 200 * std::sin(a) + 150 * std::sin(b) + ahead * std::sin(c)};
}
void stand(GroupRig& rig) {
    rig.enable();
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 20}});
    ASSERT_TRUE(done(rig, there.id));
    rig.run(3);
}

// G-079, G-080: the tool's point is what goes along the line, 50 in front of the flange, and its offset below it is no path's matter.
TEST(GroupTools, TheToolsPointGoesAlongTheLine) {
    GroupRig rig(axes_of_scara(), scara_arm());
    stand(rig);
    ASSERT_EQ(rig.give(write_tool(3, {50, 0, -10, 0, 0, 0})).error, ErrorId::none);
    ASSERT_EQ(rig.set(SelectTool{3}), ErrorId::none);
    rig.run(1);
    const auto start = point_ahead(rig.point(), 50);
    EXPECT_NEAR(rig.view().tool_set[0], start[0], 1e-9);
    EXPECT_NEAR(rig.view().tool_set[1], start[1], 1e-9);
    EXPECT_NEAR(rig.view().tool_set[2], -10, 1e-9);
    // The tool turns by 60 degrees on the way: the flange's own way is no line then.
    const auto from = rig.path.size();
    const auto move =
        rig.give(in(mcMCS, line({start[0] - 20, start[1] + 100, -10, 0, 0, 70 * rad_per_degree + std::numbers::pi / 3}, 150)));
    ASSERT_EQ(move.error, ErrorId::none);
    ASSERT_TRUE(done(rig, move.id)) << static_cast<int>(rig.error_of(move.id));
    double bent = 0;
    for (std::size_t n = from; n < rig.path.size(); ++n) {
        const auto off = [&](const std::array<double, 2>& p, const std::array<double, 2>& a) {
            return ((p[0] - a[0]) * 100 + (p[1] - a[1]) * 20) / std::hypot(100, 20);
        };
        EXPECT_LE(std::abs(off(point_ahead(rig.path[n], 50), start)), 1e-9 * 300);
        bent = std::max(bent, std::abs(off(point_ahead(rig.path[n], 0), point_ahead(rig.path[from - 1], 0))));
    }
    EXPECT_GT(bent, 1) << "or the flange would have gone it";
    EXPECT_NEAR(point_ahead(rig.point(), 50)[1], start[1] + 100, 1e-9 * 300);
}

// G-029, G-079: selecting a tool is for the commands that come; the running one keeps its own, which is the active one until it is over.
TEST(GroupTools, ASelectedToolIsForTheNextCommand) {
    GroupRig rig(axes_of_scara(), scara_arm());
    stand(rig);
    ASSERT_EQ(rig.give(write_tool(1, {50, 0, 0})).error, ErrorId::none);
    const auto* equipment = rig.groups.equipment(GroupRig::ref);
    const auto start = point_ahead(rig.point(), 0);
    const double turn = 70 * rad_per_degree;
    const auto running = rig.give(in(mcMCS, line({start[0], start[1] + 60, 0, 0, 0, turn}, 100)));
    rig.run(50);
    ASSERT_EQ(rig.status(running.id), CommandStatus::active);
    ASSERT_EQ(rig.set(SelectTool{1}), ErrorId::none);
    EXPECT_EQ(equipment->active_tool, 0);
    EXPECT_EQ(equipment->selected_tool, 1);
    // Blending is asked for, and another tool's path is another path: the corner is stood at.
    auto next = in(mcMCS, line({start[0] + 20, start[1] + 60, 0, 0, 0, turn}, 100, mcBlendingHigh));
    next.transition = mcTMCornerDistance;
    next.transition_parameter = 10;
    const auto later = rig.give(next);
    ASSERT_EQ(later.error, ErrorId::none);
    bool stood = false;
    ASSERT_TRUE(rig.until(
        [&] {
            const auto p = point_ahead(rig.point(), 0);
            stood = stood || std::hypot(p[0] - start[0], p[1] - start[1] - 60) < 1e-9;
            return rig.status(running.id) == CommandStatus::done;
        },
        5000));
    ASSERT_TRUE(rig.until(
        [&] {
            const auto p = point_ahead(rig.point(), 0);
            stood = stood || std::hypot(p[0] - start[0], p[1] - start[1] - 60) < 1e-9;
            return rig.view().path_velocity > 10;
        },
        500));
    EXPECT_TRUE(stood) << "the flange at the end of its line";
    EXPECT_EQ(equipment->active_tool, 1);
    ASSERT_TRUE(done(rig, later.id)) << static_cast<int>(rig.error_of(later.id));
    EXPECT_NEAR(point_ahead(rig.point(), 50)[0], start[0] + 20, 1e-9 * 300) << "the tool's point at the end of the other";
    EXPECT_NEAR(point_ahead(rig.point(), 50)[1], start[1] + 60, 1e-9 * 300);
}

// G-028, G-029: a tool that is measured anew between two motions; the one in front goes by the old numbers.
TEST(GroupTools, AQueuedToolHasItsPlaceBetweenMotions) {
    GroupRig rig(axes_of_scara(), scara_arm());
    stand(rig);
    ASSERT_EQ(rig.give(write_tool(1, {50, 0, 0})).error, ErrorId::none);
    ASSERT_EQ(rig.set(SelectTool{1}), ErrorId::none);
    const auto start = point_ahead(rig.point(), 50);
    const double turn = 70 * rad_per_degree;
    const auto first = rig.give(in(mcMCS, line({start[0], start[1] + 40, 0, 0, 0, turn}, 100)));
    ASSERT_EQ(rig.give(write_tool(1, {60, 0, 0}, mcQueued)).error, ErrorId::none);
    const auto second = rig.give(in(mcMCS, line({start[0], start[1] + 40, 0, 0, 0, turn}, 100, mcBuffered)));
    ASSERT_TRUE(done(rig, first.id));
    EXPECT_NEAR(point_ahead(rig.point(), 50)[1], start[1] + 40, 1e-9 * 300);
    ASSERT_TRUE(done(rig, second.id));
    EXPECT_NEAR(point_ahead(rig.point(), 60)[1], start[1] + 40, 1e-9 * 300);
    EXPECT_NEAR(point_ahead(rig.point(), 60)[0], start[0], 1e-9 * 300);
}

// G-075: TCS of a buffered command is the tool's frame where the command before ends, not where it is when the command comes: 10 along the tool's X,
// which stands at 110 degrees then.
TEST(GroupTools, TcsIsWhereTheCommandBeforeEnds) {
    GroupRig rig(axes_of_scara(), scara_arm());
    stand(rig);
    ASSERT_EQ(rig.give(write_tool(1, {50, 0, 0})).error, ErrorId::none);
    ASSERT_EQ(rig.set(SelectTool{1}), ErrorId::none);
    const auto start = point_ahead(rig.point(), 50);
    const double turn = 110 * rad_per_degree;
    const auto first = rig.give(in(mcMCS, line({start[0], start[1] + 40, 0, 0, 0, turn}, 100)));
    const auto ahead = rig.give(in(mcTCS, line({10, 0, 0, 0, 0, 0}, 100, mcBuffered)));
    const auto around = rig.give(in(mcTCS, line_by({0, 5, 0, 0, 0, -turn}, 100, mcBuffered)));
    ASSERT_EQ(ahead.error, ErrorId::none);
    ASSERT_TRUE(done(rig, first.id));
    ASSERT_TRUE(done(rig, ahead.id)) << static_cast<int>(rig.error_of(ahead.id));
    const double x = start[0] + 10 * std::cos(turn), y = start[1] + 40 + 10 * std::sin(turn);
    EXPECT_NEAR(point_ahead(rig.point(), 50)[0], x, 1e-9 * 300);
    EXPECT_NEAR(point_ahead(rig.point(), 50)[1], y, 1e-9 * 300);
    ASSERT_TRUE(done(rig, around.id)) << static_cast<int>(rig.error_of(around.id));
    // 5 along the tool's Y, and the tool turned back to the machine's directions.
    EXPECT_NEAR(point_ahead(rig.point(), 50)[0], x - 5 * std::sin(turn), 1e-9 * 300);
    EXPECT_NEAR(point_ahead(rig.point(), 50)[1], y + 5 * std::cos(turn), 1e-9 * 300);
    EXPECT_NEAR(rig.point()[0] + rig.point()[1] + rig.point()[3], 0, 1e-9 * 300);
}

// G-079: what is not defined is not selected; number 0 is there and is not written.
TEST(GroupTools, NumbersThatAreNotThereAreRefused) {
    GroupRig rig(axes_of_scara(), scara_arm());
    EXPECT_EQ(rig.set(SelectTool{5}), ErrorId::invalid_tool);
    EXPECT_EQ(rig.set(SelectPayload{5}), ErrorId::invalid_tool);
    EXPECT_EQ(rig.set(SelectTool{0}), ErrorId::none);
    EXPECT_EQ(rig.set(SelectPayload{0}), ErrorId::none);
    EXPECT_EQ(rig.set(WritePayload{0, {}}), ErrorId::invalid_tool);
    EXPECT_EQ(rig.set(WritePayload{32, {}}), ErrorId::invalid_tool);
    EXPECT_EQ(rig.set(WritePayload{5, {.mass = -1}}), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.set(WritePayload{5, {.mass = 2}}), ErrorId::none);
    EXPECT_EQ(rig.set(SelectPayload{5}), ErrorId::none);
    EXPECT_EQ(rig.groups.equipment(GroupRig::ref)->selected_payload, 5);
    EXPECT_EQ(rig.groups.equipment(GroupRig::ref)->selected_tool, 0);
    EXPECT_EQ(rig.set(WriteBodies{9, {}}), ErrorId::invalid_parameter);
}

// An arm that cannot turn its tool keeps the tool turned as it is: a camera that is screwed on askew, a machine that is mounted askew. In both
// positions by hand; the paths are those of any arm.
TEST(GroupTools, AnArmThatCannotTurnCarriesATurnedTool) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give(write_tool(1, {5, 6, 7, 0, 0, 0.3})).error, ErrorId::none);
    ASSERT_EQ(rig.set(SelectTool{1}), ErrorId::none);
    const auto by = rig.give(in(mcMCS, line_by({3, 2, 1}, 50)));
    ASSERT_TRUE(done(rig, by.id)) << static_cast<int>(rig.error_of(by.id));
    expect_at(rig, 3, 2, 1);
    const auto to = rig.give(in(mcMCS, line({15, 16, 17, 0, 0, 0.3}, 50)));  // of the tool's point
    ASSERT_TRUE(done(rig, to.id));
    expect_at(rig, 10, 10, 10);
    GroupCommand arc = in(mcMCS, line({25, 16, 17, 0, 0, 0.3}, 50));
    arc.kind = GroupCommandKind::circular_absolute;
    arc.circle = {.mode = mcBORDER, .aux = {20, 21, 17}};
    const auto half = rig.give(arc);
    ASSERT_TRUE(done(rig, half.id));
    expect_at(rig, 20, 10, 10);
}
TEST(GroupTools, AMachineThatIsMountedTurnedGoesItsLines) {
    KinematicsDescription turned{.arm = CartesianAxes{}};
    turned.base = pose_of_numbers({100, 0, 0, 0, 0, right_angle});  // its X is the machine's Y
    GroupRig rig(3, arm_of(turned));
    rig.enable();
    const auto by = rig.give(in(mcMCS, line_by({3, 2, 1}, 50)));
    ASSERT_TRUE(done(rig, by.id)) << static_cast<int>(rig.error_of(by.id));
    expect_at(rig, 2, -3, 1);
    const auto to = rig.give(in(mcMCS, line({90, 5, 4, 0, 0, right_angle}, 50)));
    ASSERT_TRUE(done(rig, to.id));
    expect_at(rig, 5, 10, 4);
}

// G-078 by hand: RZ = 90 about Z takes X to Y; RY = 90 then about the new Y, which is -X, takes the new X (Y) to -Z; and RX = 90 about that X.
TEST(GroupFrames, ThreeAnglesTurnAboutZThenTheNewYThenTheNewX) {
    const auto seen = [](const SixNumbers& six, const std::array<double, 3>& point) {
        const Pose p = seen_through(pose_of_numbers(six), pose_of_numbers({point[0], point[1], point[2], 0, 0, 0}));
        return p.position;
    };
    const auto expect = [&](const SixNumbers& six, const std::array<double, 3>& point, const std::array<double, 3>& there) {
        const auto at = seen(six, point);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(at[i], there[i], 1e-15) << i;
    };
    expect({0, 0, 0, 0, 0, right_angle}, {1, 0, 0}, {0, 1, 0});
    expect({0, 0, 0, 0, right_angle, 0}, {1, 0, 0}, {0, 0, -1});
    expect({0, 0, 0, right_angle, 0, 0}, {0, 1, 0}, {0, 0, 1});
    // The order: Z first. X -> Y -> (about -X by 90) -> -Z.
    expect({0, 0, 0, 0, right_angle, right_angle}, {1, 0, 0}, {0, 0, -1});
    // The new Y is -X and stays so.
    expect({0, 0, 0, 0, right_angle, right_angle}, {0, 1, 0}, {-1, 0, 0});
    // Then about the new X (-Z) by 90: the new Y (-X) goes to the new Z, which after both is the Z of (RZ 90, RY 90): Z -> Z -> Y.
    expect({0, 0, 0, right_angle, right_angle, right_angle}, {0, 1, 0}, {0, 1, 0});
    expect({10, 20, 30, 0, 0, right_angle}, {1, 0, 0}, {10, 21, 30});
    // And back, also where RY is a right angle: RZ is 0 then.
    const auto back = numbers_of(pose_of_numbers({1, 2, 3, 0.3, -0.4, 2.5}));
    const SixNumbers given{1, 2, 3, 0.3, -0.4, 2.5};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back[i], given[i], 1e-14) << i;
    const auto upright = numbers_of(pose_of_numbers({0, 0, 0, 0.3, right_angle, 1.0}));
    EXPECT_NEAR(upright[5], 0, 1e-12);
    EXPECT_NEAR(upright[4], right_angle, 1e-12);
    EXPECT_NEAR(upright[3], 0.3 - 1.0, 1e-12) << "about one axis: their difference is what there is";
}

// Real time: taking frames and tools, and asking for places, takes no memory.
TEST(GroupFrames, NothingOfItTakesMemory) {
    GroupRig rig(axes_of_scara(), scara_arm());
    stand(rig);
    std::size_t taken = 0;
    rig.step([&] {
        NoAllocationScope none;
        (void)rig.submit(set_frame(mcPCS, {300, 0, 0, 0, 0, 0.2}));
        (void)rig.submit(write_tool(1, {50, 0, 0, 0, 0, 0}));
        (void)rig.set(SelectTool{1});
        (void)rig.submit(in(mcPCS, line_by({1, 1, 0}, 50)));
        (void)rig.submit(set_frame(mcPCS, {300, 0, 0, 0, 0, 0.3}, mcQueued));
        (void)rig.submit(in(mcTCS, line_by({1, 1, 0}, 50, mcBuffered)));
        (void)rig.groups.transformed(GroupRig::ref, {.from = mcTCS, .to = mcACS, .place = {}});
        (void)rig.groups.position_in(GroupRig::ref, mcPCS, mcSetValue);
        (void)rig.groups.velocity_in(GroupRig::ref, mcPCS, mcSetValue);
        taken = none.used().total();
    });
    EXPECT_EQ(taken, 0u);
    EXPECT_EQ(rig.view().queued_count, 2);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 2000));
}

}  // namespace
}  // namespace taktwerk::axes::test

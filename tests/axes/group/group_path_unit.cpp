// Paths of a group: blended corners, arcs, arms that bend every line. The rig asserts limits and continuity of every member in every cycle.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/guard/allocation_guard.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

GroupCommand in_machine(GroupCommand command) {
    command.frame = mcMCS;
    return command;
}
GroupCommand blended(GroupCommand command, MC_TransitionMode transition, double parameter, MC_BufferMode mode = mcBlendingHigh) {
    command.transition = transition;
    command.transition_parameter = parameter;
    command.buffer_mode = mode;
    return command;
}
GroupCommand arc(MC_CIRC_MODE mode, const std::array<double, 3>& aux, const JointVector& end, double velocity) {
    auto command = in_machine(line(end, velocity));
    command.kind = GroupCommandKind::circular_absolute;
    command.circle = {.mode = mode, .aux = aux};
    return command;
}

/// Distance of the set-points since `from` from the nearest of two lines a-b and b-c.
double off_corner(const GroupRig& rig, std::size_t from, double& nearest_to_b, const JointVector& a, const JointVector& b,
                  const JointVector& c) {
    double worst = 0;
    const auto off = [&](const JointVector& p, const JointVector& u, const JointVector& v) {
        const double dx = v[0] - u[0], dy = v[1] - u[1], length = std::hypot(dx, dy);
        const double t = std::clamp(((p[0] - u[0]) * dx + (p[1] - u[1]) * dy) / (length * length), 0.0, 1.0);
        return std::hypot(p[0] - u[0] - t * dx, p[1] - u[1] - t * dy);
    };
    nearest_to_b = 1e9;
    for (std::size_t n = from; n < rig.path.size(); ++n) {
        const auto& p = rig.path[n];
        worst = std::max(worst, std::min(off(p, a, b), off(p, b, c)));
        nearest_to_b = std::min(nearest_to_b, std::hypot(p[0] - b[0], p[1] - b[1]));
    }
    return worst;
}

// G-051, G-055, G-057, G-058, G-061: the curve leaves the first line 4 before the corner and joins the second one 4 behind it, without a stop.
// Its middle is (16 - 5 k)/32 d |t1 - t0| from the corner with k = 2 - 0.1 |t1 - t0|^2 (docs/motion/path.md): at a right angle k = 1.8 and
// 7/32 * 4 * sqrt 2 = 1.2374.
TEST(GroupPath, ACornerIsRoundedByItsDistance) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    const auto first = rig.give(line({30, 0}, 50));
    const auto second = rig.give(blended(line({30, 30}, 50), mcTMCornerDistance, 4));
    double slowest = 1e9;
    CommandStatus seen = CommandStatus::active;
    double x_at_done = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            const auto p = rig.point();
            if (p[0] > 20 && p[1] < 10) slowest = std::min(slowest, rig.view().path_velocity);
            if (seen == CommandStatus::active && rig.status(first.id) == CommandStatus::done) x_at_done = p[0];
            seen = rig.status(first.id);
            return rig.status(second.id) == CommandStatus::done;
        },
        5000));
    EXPECT_GT(slowest, 5) << "no stop at the corner";
    double nearest = 0;
    const double off = off_corner(rig, from, nearest, {0, 0}, {30, 0}, {30, 30});
    EXPECT_NEAR(nearest, 7.0 / 32 * 4 * std::sqrt(2.0), 0.05) << "but for the places between two cycles";
    EXPECT_LE(off, nearest / std::sqrt(2.0) + 1e-9);
    for (std::size_t n = from; n < rig.path.size(); ++n) {
        if (rig.path[n][0] < 26) {
            EXPECT_NEAR(rig.path[n][1], 0, 1e-9) << "in front of the curve it is on the line";
        }
        if (rig.path[n][1] > 4) {
            EXPECT_NEAR(rig.path[n][0], 30, 1e-9);
        }
    }
    EXPECT_GT(x_at_done, 28) << "the first is done in the middle of the curve";
    EXPECT_LT(x_at_done, 29.9);
    EXPECT_EQ(rig.point()[0], 30);
    EXPECT_EQ(rig.point()[1], 30);
}

// G-052: exactly as far as asked, where the lines are long enough.
TEST(GroupPath, ACornerIsRoundedByItsDeviation) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    (void)rig.give(line({30, 0}, 30));
    const auto second = rig.give(blended(line({30, 30}, 30), mcTMMaxCornerDeviation, 0.5));
    ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 5000));
    double nearest = 0;
    (void)off_corner(rig, from, nearest, {0, 0}, {30, 0}, {30, 30});
    EXPECT_GE(nearest, 0.5 - 1e-9);
    EXPECT_LE(nearest, 0.5 + 0.02);
}

// G-049, G-059, G-071: places of a rounded corner are the same whatever the velocity, the mode of blending and the override.
TEST(GroupPath, NoVelocityBendsARoundedCorner) {
    const auto crossing = [](double factor, MC_BufferMode mode, double velocity) {
        GroupRig rig(2);
        rig.enable();
        EXPECT_EQ(rig.set(Override{factor, 1, 1}), ErrorId::none);
        const auto from = rig.path.size();
        (void)rig.give(line({20, 0}, velocity));
        const auto second = rig.give(blended(line({20, 20}, 40), mcTMCornerDistance, 6, mode));
        rig.run(100);
        EXPECT_EQ(rig.set(Override{1, 0.5, 1}), ErrorId::none);
        EXPECT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 20000));
        std::vector<JointVector> places(rig.path.begin() + static_cast<std::ptrdiff_t>(from), rig.path.end());
        return places;
    };
    // y over x, of which one run has more places than the other has: on the same curve of fifth degree, between two neighbours.
    const auto one = crossing(1, mcBlendingHigh, 40), other = crossing(0.1, mcBlendingLow, 15);
    std::size_t compared = 0;
    for (const auto& p : one) {
        if (p[0] < 14.5 || p[1] > 5.5 || p[1] < 0.01) continue;
        for (std::size_t n = 1; n < other.size(); ++n) {
            const auto &a = other[n - 1], &b = other[n];
            if (!(a[1] <= p[1] && p[1] <= b[1]) || b[1] == a[1]) continue;
            const double x = a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]);
            EXPECT_NEAR(p[0], x, 2e-3) << "a chord of a hundredth's curve";
            ++compared;
            break;
        }
    }
    EXPECT_GT(compared, 20u);
}

// G-048: lines that continue each other keep their velocity without a curve; a corner without one is stood at, exactly.
TEST(GroupPath, LinesThatContinueEachOtherArePassed) {
    GroupRig rig(2);
    rig.enable();
    (void)rig.give(line({30, 0}, 50));
    (void)rig.give(line({60, 0}, 50, mcBlendingHigh));
    const auto third = rig.give(line({60, 20}, 50, mcBlendingHigh));
    bool stood = false;
    ASSERT_TRUE(rig.until(
        [&] {
            const auto p = rig.point();
            if (p[0] > 20 && p[0] < 40) {
                EXPECT_GT(rig.view().path_velocity, 49);
            }
            stood = stood || (p[0] == 60 && p[1] == 0);
            return rig.status(third.id) == CommandStatus::done;
        },
        5000));
    EXPECT_TRUE(stood);
}

// G-056: a command that comes while the first one runs is blended; one that comes in its last ramp is not, and nothing jumps.
TEST(GroupPath, ALateCommandIsBlendedAsFarAsThereIsTime) {
    for (const int late : {50, 200, 400, 560, 590, 600, 610, 640}) {
        GroupRig rig(2);
        rig.enable();
        (void)rig.give(line({30, 0}, 50));
        rig.run(late);
        const auto second = rig.give(blended(line({30, 30}, 50), mcTMCornerDistance, 4, mcBlendingLow));
        ASSERT_EQ(second.error, ErrorId::none);
        const auto from = rig.path.size();
        ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 5000)) << late;
        double nearest = 0;
        (void)off_corner(rig, from, nearest, {0, 0}, {30, 0}, {30, 30});
        if (late <= 200) {
            EXPECT_GT(nearest, 1.2) << late;
        }
        EXPECT_EQ(rig.point()[0], 30);
        EXPECT_EQ(rig.point()[1], 30);
    }
}

// G-037, G-038, G-039, G-040: true arcs, each cycle. The circle about (10, 0) with radius 10.
TEST(GroupPath, ArcsAreArcsInEveryCycle) {
    struct Case {
        GroupCommand command;
        double turn;  // of the circle
    };
    auto clockwise = arc(mcCENTER, {10, 0, 0}, {10, 10, 0}, 20);
    clockwise.circle.clockwise = true;
    const Case cases[] = {
        {arc(mcBORDER, {10, 10, 0}, {20, 0, 0}, 20), 0.5},
        {arc(mcCENTER, {10, 0, 0}, {10, 10, 0}, 20), 0.75},  // counter-clockwise about +Z from (0, 0): by (10, -10), (20, 0)
        {clockwise, 0.25},
        {arc(mcRADIUS, {0, 0, 10}, {10, -10, 0}, 20), 0.25},
    };
    for (const auto& one : cases) {
        GroupRig rig(3, cartesian_arm());
        rig.enable();
        const auto from = rig.path.size();
        const auto move = rig.give(one.command);
        ASSERT_EQ(move.error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 8000));
        double gone = 0, worst = 0;
        for (std::size_t n = from; n < rig.path.size(); ++n) {
            const auto& p = rig.path[n];
            worst = std::max(worst, std::abs(std::hypot(p[0] - 10, p[1]) - 10));
            if (n > from) gone += std::hypot(p[0] - rig.path[n - 1][0], p[1] - rig.path[n - 1][1]);
        }
        EXPECT_LE(worst, 1e-9 * 10);
        EXPECT_NEAR(gone, one.turn * 20 * std::numbers::pi, 0.01);
        EXPECT_NEAR(rig.point()[0], one.command.target[0], 1e-9);
        EXPECT_NEAR(rig.point()[1], one.command.target[1], 1e-9);
        EXPECT_TRUE(rig.view().tool_known);
        EXPECT_NEAR(rig.view().tool_set[1], one.command.target[1], 1e-9);
    }
}

TEST(GroupPath, PointsThatMakeNoArcEndTheCommandWithItsReason) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    const auto flat = rig.give(arc(mcBORDER, {5, 0, 0}, {10, 0, 0}, 20));
    ASSERT_TRUE(rig.until([&] { return rig.status(flat.id) == CommandStatus::error; }, 50));
    EXPECT_EQ(rig.error_of(flat.id), ErrorId::invalid_arc);
    EXPECT_EQ(rig.point()[0], 0);
    auto flat_axes = arc(mcBORDER, {5, 5, 0}, {10, 0, 0}, 20);
    flat_axes.frame = mcACS;
    EXPECT_EQ(rig.submit(flat_axes).error, ErrorId::no_kinematics) << "axes have no plane";
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 50));
}

// G-015, G-062: one that makes no way, between two that are blended over it, ends with its reason as if it stood alone.
TEST(GroupPath, ABadCommandBetweenTwoBlendedOnesEndsWithItsReason) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    const auto first = rig.give(in_machine(line({30, 0, 0}, 50)));
    const auto flat = rig.give(blended(arc(mcBORDER, {35, 0, 0}, {40, 0, 0}, 50), mcTMCornerDistance, 2));
    const auto nothing = rig.give(blended(in_machine(line_by({0, 0, 0}, 50)), mcTMCornerDistance, 2));
    const auto last = rig.give(blended(in_machine(line({30, 30, 0}, 50)), mcTMCornerDistance, 2));
    ASSERT_EQ(flat.error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(last.id) >= CommandStatus::done; }, 5000));
    EXPECT_EQ(rig.status(first.id), CommandStatus::done);
    EXPECT_EQ(rig.status(flat.id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(flat.id), ErrorId::invalid_arc);
    EXPECT_EQ(rig.status(nothing.id), CommandStatus::done);
    EXPECT_EQ(rig.status(last.id), CommandStatus::done);
}

/// A SCARA of 200 and 150 in degrees for its rotary axes, fast enough for its size.
constexpr double degree = std::numbers::pi / 180;
Arm scara() {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = degree;
    return arm_of(description);
}
std::vector<AxisConfig> scara_axes() {
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    return {group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)};
}
/// Of two links, by hand.
std::array<double, 2> tool_of(const JointVector& q) {
    const double a = q[0] * degree, b = (q[0] + q[1]) * degree;
    return {200 * std::cos(a) + 150 * std::cos(b), 200 * std::sin(a) + 150 * std::sin(b)};
}

// G-033, G-034, G-042 through an arm: the tool's point is on its line in every cycle and no axis beyond its limits (the rig's oracle), also where the
// axes have to be fastest. FK by hand.
TEST(GroupPath, AScaraDrawsALineAndAnArc) {
    GroupRig rig(scara_axes(), scara());
    rig.enable();
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    const auto start = tool_of(rig.point());
    EXPECT_NEAR(rig.view().tool_set[0], start[0], 1e-9);
    const double turn = rig.view().tool_set[5];
    const auto from = rig.path.size();
    JointVector goal{start[0] - 20, start[1] + 180, 5, 0, 0, turn};
    const auto move = rig.give(in_machine(line(goal, 150)));
    ASSERT_EQ(move.error, ErrorId::none);
    double fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, rig.view().path_velocity);
            return rig.status(move.id) == CommandStatus::done;
        },
        8000))
        << static_cast<int>(rig.error_of(move.id));
    const auto end = rig.path.size();
    for (std::size_t n = from; n < end; ++n) {
        const auto p = tool_of(rig.path[n]);
        const double off = ((p[0] - start[0]) * 180 + (p[1] - start[1]) * 20) / std::hypot(180, 20);
        EXPECT_LE(std::abs(off), 1e-9 * 300);
    }
    EXPECT_GT(fastest, 100);
    EXPECT_NEAR(tool_of(rig.point())[1], goal[1], 1e-9 * 300);

    const auto begin = rig.path.size();
    const std::array<double, 2> c{goal[0] + 30, goal[1]};
    auto round = arc(mcCENTER, {c[0], c[1], 5}, {c[0] + 30, c[1], 5, 0, 0, turn}, 100);
    round.circle.aux[0] = c[0];
    round.target = {c[0], c[1] - 30, 5, 0, 0, turn};
    const auto second = rig.give(round);
    ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::done; }, 8000)) << static_cast<int>(rig.error_of(second.id));
    for (std::size_t n = begin; n < rig.path.size(); ++n) {
        const auto p = tool_of(rig.path[n]);
        EXPECT_LE(std::abs(std::hypot(p[0] - c[0], p[1] - c[1]) - 30), 1e-9 * 300);
    }
}

// A beam that is askew stands where no pose has it: a path of the tool would begin with a step of its motors. Its members alone bring it square first.
TEST(GroupPath, ABeamThatIsAskewGoesNoPathOfTheTool) {
    GroupRig rig(4, arm_of({.arm = BeamGantryShape{.span = 800}}));
    rig.enable();
    const auto goes = [&](const GroupCommand& command) {
        const auto id = rig.give(command).id;
        EXPECT_TRUE(rig.until([&] { return rig.status(id) == CommandStatus::done || rig.status(id) == CommandStatus::error; }, 5000));
        rig.run(3);
        return rig.error_of(id);
    };
    ASSERT_EQ(goes(line({20, 25, 30, 40}, 50)), ErrorId::none) << "the members, of which the second guide's is 5 ahead";
    auto by = line_by({10, 0, 0}, 50);
    by.frame = mcMCS;
    EXPECT_EQ(goes(by), ErrorId::out_of_reach);
    by.kind = GroupCommandKind::circular_relative;
    by.circle = {.mode = mcBORDER, .aux = {5, 5, 0}};
    EXPECT_EQ(goes(by), ErrorId::out_of_reach);
    EXPECT_EQ(rig.point()[1], 25) << "nothing has moved";
    ASSERT_EQ(goes(line({20, 20, 30, 40}, 50)), ErrorId::none);
    EXPECT_EQ(goes(by), ErrorId::none);
    EXPECT_NEAR(rig.point()[0], 30, 1e-9);
    EXPECT_NEAR(rig.point()[1], 30, 1e-9);
}

// G-044, G-024: what the whole way shows is refused before anything moves: through the middle of the arm; beyond its reach in between; beyond a
// software limit between two ends that are inside.
TEST(GroupPath, WhatTheWholeWayShowsIsRefusedBeforeItStarts) {
    GroupRig rig(scara_axes(), scara());
    rig.enable();
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {0, 90, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    const double turn = rig.view().tool_set[5];
    const auto place = rig.point();
    // From (200, 150) to (-200, -150), through the shoulder, which is nearer than 200 - 150 = 50.
    const auto through = rig.give(in_machine(line({-200, -150, 0, 0, 0, turn}, 100)));
    ASSERT_TRUE(rig.until([&] { return rig.status(through.id) == CommandStatus::error; }, 50));
    EXPECT_EQ(rig.error_of(through.id), ErrorId::out_of_reach);
    // To 0.002 in front of the edge of the reach, where both links are in line: the sine of the elbow is 0.0066, and below 0.01 a path is refused.
    const auto stretched = rig.give(in_machine(line({280, 209.997, 0, 0, 0, turn}, 100)));
    ASSERT_TRUE(rig.until([&] { return rig.status(stretched.id) == CommandStatus::error; }, 50));
    EXPECT_EQ(rig.error_of(stretched.id), ErrorId::singular_path);
    EXPECT_EQ(rig.submit(in_machine(line({300, 300, 0, 0, 0, turn}, 100))).error, ErrorId::out_of_reach) << "known at once";
    EXPECT_EQ(rig.point(), place);
}

TEST(GroupPath, ASoftwareLimitInTheMiddleOfALineIsSeen) {
    auto axes = scara_axes();
    axes[1].limits.position_max = 100;
    axes[1].homing.kind = HomingKind::set_here;
    GroupRig rig(axes, scara());
    ASSERT_EQ(rig.axes[1].submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(1).homed && rig.axis(1).state == AxisState::Standstill; }, 100));
    rig.enable();
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-60, 90, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    // Mirrored about the X axis: in the middle the tool is nearer to the shoulder, and the elbow beyond 100 degrees. At both ends it is at 90.
    const auto start = tool_of(rig.point());
    const double turn = rig.view().tool_set[5];
    const double reach = std::hypot(start[0], start[1]), angle = std::atan2(start[1], start[0]);
    const JointVector mirrored{reach * std::cos(angle + 2), reach * std::sin(angle + 2), 0, 0, 0, turn};
    const auto move = rig.give(in_machine(line(mirrored, 100)));
    ASSERT_EQ(move.error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::error; }, 50));
    EXPECT_EQ(rig.error_of(move.id), ErrorId::beyond_software_limit);
}

// G-063: also in a cruise of ten seconds a stop begins soon: behind the piece that is under way (20 ms), its lead of 8 ms with the piece that this ends in,
// and 22 ms for the first 2 u/s (at nine tenths of the jerk).
TEST(GroupPath, AStopInALongCruiseDoesNotWaitForItsEnd) {
    GroupRig rig(2);
    rig.enable();
    (void)rig.give(line({1000, 0}, 100));
    for (int wait = 300; wait < 4000; wait += 611) {
        rig.run(wait);
        ASSERT_GT(rig.view().path_velocity, 99);
        (void)rig.give(simply(GroupCommandKind::interrupt));
        int cycles = 0;
        ASSERT_TRUE(rig.until([&] { return ++cycles, rig.view().path_velocity < 98; }, 200));
        EXPECT_LE(cycles, 65);
        ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 500));
        ASSERT_EQ(rig.give(simply(GroupCommandKind::resume)).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.view().path_velocity > 99; }, 1000));
        if (rig.point()[0] > 700) break;
    }
}

// A halt that comes while the path still brakes for an override of nearly nothing: it stands as soon as any other, and does not creep there.
TEST(GroupPath, AHaltBehindALoweredOverrideDoesNotCreep) {
    for (const int later : {1, 30, 60, 90, 130}) {
        GroupRig rig(2);
        rig.enable();
        (void)rig.give(line({500, 0}, 100));
        rig.run(500);
        ASSERT_GT(rig.view().path_velocity, 99);
        ASSERT_EQ(rig.set(Override{1e-5, 1, 1}), ErrorId::none);
        rig.run(later);
        (void)rig.give(simply(GroupCommandKind::interrupt));
        EXPECT_TRUE(rig.until([&] { return rig.view().interrupted; }, 500)) << later;
    }
}

// Interrupted, overridden and stopped in the middle of a rounded corner: the path stays.
TEST(GroupPath, HoldingInACurveStaysOnTheCurve) {
    for (const int cycle : {450, 520, 560, 600, 640}) {
        GroupRig rig(2), free(2);
        std::vector<CommandId> last;
        for (auto* one : {&rig, &free}) {
            one->enable();
            (void)one->give(line({20, 0}, 40));
            last.push_back(one->give(blended(line({20, 20}, 40), mcTMCornerDistance, 8)).id);
        }
        rig.run(cycle);
        (void)rig.give(simply(GroupCommandKind::interrupt));
        ASSERT_TRUE(rig.until([&] { return rig.view().interrupted; }, 1000));
        ASSERT_EQ(rig.give(simply(GroupCommandKind::resume)).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.status(last[0]) == CommandStatus::done; }, 4000)) << cycle;
        ASSERT_TRUE(free.until([&] { return free.status(last[1]) == CommandStatus::done; }, 4000));
        double a = 0, b = 0;
        (void)off_corner(rig, 0, a, {0, 0}, {20, 0}, {20, 20});
        (void)off_corner(free, 0, b, {0, 0}, {20, 0}, {20, 20});
        EXPECT_NEAR(a, b, 0.02) << cycle;
        EXPECT_EQ(rig.point()[1], 20);
    }
}

// The cycle's side takes no memory, whatever the way is.
TEST(GroupPath, NothingInTheCycleTakesMemory) {
    GroupRig rig(scara_axes(), scara());
    rig.enable();
    const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    const auto at = rig.view().tool_set;
    std::size_t taken = 0;
    const auto guarded = [&](const GroupCommand* command) {
        rig.now += GroupRig::cycle;
        for (auto& one : rig.axes) one.update(rig.now);
        NoAllocationScope none;
        rig.groups.update(rig.now);
        if (command != nullptr) {
            EXPECT_EQ(rig.submit(*command).error, ErrorId::none);
        }
        rig.groups.plan(rig.now, GroupRig::cycle);
        taken += none.used().total();
        plan_axes(rig.axes, rig.now, GroupRig::cycle);
        for (auto& one : rig.axes) one.encode(rig.now);
    };
    const auto first = in_machine(line({at[0], at[1] + 60, 0, 0, 0, at[5]}, 150));
    auto second = in_machine(blended(line({at[0] - 40, at[1] + 60, 0, 0, 0, at[5]}, 150), mcTMCornerDistance, 10));
    guarded(&first);
    guarded(&second);
    for (int i = 0; i < 2000 && rig.view().state != GroupStandby; ++i) {
        rig.groups.service();
        guarded(nullptr);
    }
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_NEAR(rig.view().tool_set[0], at[0] - 40, 1e-9 * 300);
    EXPECT_EQ(taken, 0u);
}

}  // namespace
}  // namespace taktwerk::axes::test

// Orientation along a group's path: turns alone, turns with a way, turns about more than one axis. Angles by hand; the rig asserts the members' limits in every cycle.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::axes::test {
namespace {

using std::numbers::pi;

/// X, Y, Z and a turn about Z, in degrees.
struct TurningRig : GroupRig {
    TurningRig()
        : GroupRig(named(4), all_of(named(4), arm_of(in_degrees({.arm = CartesianAxes{.turn_about = 2}}, {false, false, false, true})))) {
        enable();
    }
    bool done(CommandId id) {
        return until([&] { return status(id) == CommandStatus::done || status(id) == CommandStatus::error; }, 9000) &&
               status(id) == CommandStatus::done;
    }
};
GroupCommand by_pose(const Six& distance, double velocity) {
    auto command = line_by({distance[0], distance[1], distance[2], distance[3], distance[4], distance[5]}, velocity);
    command.frame = mcMCS;
    return command;
}

// G-035: 1 rad with Velocity 0.5 is half a radian a second, 28.65 degrees/s of the turning member; the others stand.
TEST(GroupTurn, ATurnAloneHasRadiansASecond) {
    TurningRig rig;
    const auto turn = rig.give(by_pose({0, 0, 0, 0, 0, 1}, 0.5));
    double fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, rig.axis(3).set_velocity);
            for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig.axis(i).set_position, 0);
            return rig.status(turn.id) == CommandStatus::done;
        },
        5000));
    EXPECT_NEAR(fastest, 0.5 * 180 / pi, 0.02 * 0.5 * 180 / pi);
    EXPECT_LE(fastest, 0.5 * 180 / pi * (1 + 1e-6));
    EXPECT_NEAR(rig.axis(3).set_position, 180 / pi, 1e-9);
}

// G-035: with a way Velocity is the point's, 20 u/s over 10 u; the turn of 0.1 rad begins and ends with it, in proportion.
TEST(GroupTurn, ATurnOnAWayGoesWithIt) {
    TurningRig rig;
    const auto move = rig.give(by_pose({6, 8, 0, 0, 0, 0.1}, 20));
    double fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, std::hypot(rig.axis(0).set_velocity, rig.axis(1).set_velocity));
            EXPECT_NEAR(rig.axis(3).set_position, 0.1 * 180 / pi * rig.axis(0).set_position / 6, 1e-9);
            EXPECT_NEAR(rig.axis(3).set_velocity, 0.1 * 180 / pi * rig.axis(0).set_velocity / 6, 1e-9);
            return rig.status(move.id) == CommandStatus::done;
        },
        5000));
    EXPECT_NEAR(fastest, 20, 0.4);
    EXPECT_LE(fastest, 20 * (1 + 1e-6));
}

// G-035: a turn that the turning member can only do in longer than the way would take holds the way back: 2 rad, 114.6 degrees, at 100 degrees/s at most.
TEST(GroupTurn, TheSlowerOfBothRules) {
    TurningRig rig;
    const auto move = rig.give(by_pose({10, 0, 0, 0, 0, 2}, 50));
    double turning = 0, going = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            turning = std::max(turning, rig.axis(3).set_velocity);
            going = std::max(going, rig.axis(0).set_velocity);
            return rig.status(move.id) == CommandStatus::done;
        },
        5000));
    EXPECT_GT(turning, 97);
    EXPECT_LE(turning, 100 * (1 + 1e-6));
    EXPECT_NEAR(going, turning * 10 / (2 * 180 / pi), 1e-6);
}

struct Turn {
    std::array<double, 3> axis{};  // of length 2 sin(angle)
    double angle = 0;
};
/// From one matrix to another, seen from where both are.
Turn turn_between(const HandFrame& a, const HandFrame& b) {
    HandFrame from = a, to = b;
    from.o = to.o = {};
    const HandFrame d = to * back(from);
    return {{d.r[2][1] - d.r[1][2], d.r[0][2] - d.r[2][0], d.r[1][0] - d.r[0][1]},
            std::acos(std::clamp((d.r[0][0] + d.r[1][1] + d.r[2][2] - 1) / 2, -1.0, 1.0))};
}
HandFrame tool_frame_of(const GroupRig& rig) { return hand_frame(rig.view().tool_set); }

// G-043: six joints, the tool turned by 30, -20 and 25 degrees about X, Y and Z on a way of 60 mm: about one axis that does not change, by the shortest angle, in
// proportion to the way.
TEST(GroupTurn, OrientationTurnsTheShortestWayAboutOneAxis) {
    for (const auto& arm : every_kind_of_arm()) {
        if (arm.name != "six_with_wrist" && arm.name != "six_without_wrist") continue;
        GroupRig rig(axes_of(arm), GroupRig::all_of(axes_of(arm), arm_of(arm.description)));
        rig.enable();
        auto there = line(arm.start, 50);
        there.kind = GroupCommandKind::direct_absolute;
        const auto first = rig.give(there);
        ASSERT_TRUE(rig.until([&] { return rig.status(first.id) == CommandStatus::done; }, 20000)) << arm.name;
        rig.step();
        const HandFrame from = tool_frame_of(rig);
        const Six turned{0, 0, 0, pi / 6, -pi / 9, 25 * pi / 180};
        const auto move = rig.give(by_pose({40, -20, 40, turned[3], turned[4], turned[5]}, 100));  // a way of 60
        const double whole = turn_between({}, hand_frame(turned)).angle;
        ASSERT_LT(whole, pi);
        HandFrame goal = hand_frame(turned);
        goal = goal * [&] {
            HandFrame r = from;
            r.o = {};
            return r;
        }();
        const Turn all = turn_between(from, goal);
        ASSERT_NEAR(all.angle, whole, 1e-9);
        int seen = 0;
        ASSERT_TRUE(rig.until(
            [&] {
                const HandFrame now = tool_frame_of(rig);
                const double way =
                    std::sqrt(std::pow(now.o[0] - from.o[0], 2) + std::pow(now.o[1] - from.o[1], 2) + std::pow(now.o[2] - from.o[2], 2));
                const Turn turn = turn_between(from, now);
                if (way > 1) {  // a cosine near 1 has few digits
                    ++seen;
                    EXPECT_NEAR(turn.angle, whole * way / 60, 1e-7) << arm.name;
                    for (std::size_t i = 0; i < 3; ++i)
                        EXPECT_NEAR(turn.axis[i] / (2 * std::sin(turn.angle)), all.axis[i] / (2 * std::sin(all.angle)), 1e-6) << arm.name;
                }
                return rig.status(move.id) == CommandStatus::done || rig.status(move.id) == CommandStatus::error;
            },
            20000));
        EXPECT_EQ(rig.status(move.id), CommandStatus::done) << arm.name << ' ' << static_cast<int>(rig.error_of(move.id));
        EXPECT_GT(seen, 300) << arm.name;
        HandFrame end = goal;
        end.o = {from.o[0] + 40, from.o[1] - 20, from.o[2] + 40};
        EXPECT_LT(apart(tool_frame_of(rig), end), 1e-6) << arm.name;
    }
}

}  // namespace
}  // namespace taktwerk::axes::test

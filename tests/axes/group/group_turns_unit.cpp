// How the tool turns on its way, and which way of the arm it keeps.

#include <gtest/gtest.h>

#include <numbers>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using std::numbers::pi;
constexpr double degree_of_axis = pi / 180;

GroupCommand in_the_machine(GroupCommand command) {
    command.frame = mcMCS;
    return command;
}
GroupCommand directly(GroupCommand command) {
    command.kind = GroupCommandKind::direct_absolute;
    return in_the_machine(command);
}
/// Joints 1, 2 and 4 in degrees: links of 200 and 150.
Arm scara_in_degrees() {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150}};
    for (const std::size_t joint : {0u, 1u, 3u}) description.joints[joint].unit = degree_of_axis;
    return arm_of(description);
}

// G-043. Which way round half a turn goes is nobody's choice: it is refused. A little less goes the short way, and the tool turns evenly.
TEST(GroupTurns, HalfATurnIsRefusedAndALittleLessGoesTheShortWay) {
    GroupRig rig(4, arm_of({.arm = CartesianAxes{.turn_about = 2}}));
    rig.enable();
    const auto half = rig.give(in_the_machine(line({50, 0, 0, 0, 0, pi}, 100)));
    ASSERT_TRUE(rig.until([&] { return rig.status(half.id) == CommandStatus::error; }, 100));
    EXPECT_EQ(rig.error_of(half.id), ErrorId::half_turn);
    EXPECT_EQ(rig.point()[0], 0);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupState::GroupStandby; }, 10));

    const auto from = rig.path.size();
    const auto less = rig.give(in_the_machine(line({50, 0, 0, 0, 0, -3}, 100)));
    ASSERT_TRUE(rig.until([&] { return rig.status(less.id) == CommandStatus::done; }, 20'000)) << static_cast<int>(rig.error_of(less.id));
    EXPECT_NEAR(rig.point()[3], -3, 1e-9);
    for (std::size_t n = from; n < rig.path.size(); ++n) EXPECT_NEAR(rig.path[n][3], -3 * rig.path[n][0] / 50, 1e-9);
}

// Where the tool only turns, what a command says is of its turn: 0.5 rad/s, not half a unit of the path's length.
TEST(GroupTurns, AFeedOfATurnIsInRadians) {
    GroupRig rig(4, arm_of({.arm = CartesianAxes{.turn_about = 2}}));
    rig.enable();
    const auto turn = rig.give(in_the_machine(line({0, 0, 0, 0, 0, 2}, 0.5)));
    double fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, rig.axis(3).set_velocity);
            return rig.status(turn.id) == CommandStatus::done;
        },
        20'000));
    EXPECT_LE(fastest, 0.5 * (1 + 1e-6));
    EXPECT_GT(fastest, 0.49);

    // And where it does both, of the way of its point: 3 u and 2 rad at 1.5 u/s take 2 s and the ramps.
    const auto both = rig.give(in_the_machine(line({3, 0, 0, 0, 0, 0}, 1.5)));
    fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, rig.axis(0).set_velocity);
            return rig.status(both.id) == CommandStatus::done;
        },
        20'000));
    EXPECT_LE(fastest, 1.5 * (1 + 1e-6));
    EXPECT_GT(fastest, 1.47);
}

// G-042. A line keeps the way in which the arm stands: one that is told to end in another is none. A move of the axes goes there.
TEST(GroupTurns, ALineKeepsTheElbowADirectMoveMayChangeIt) {
    GroupRig rig(4, scara_in_degrees());
    rig.enable();
    const auto bent = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(bent.id) == CommandStatus::done; }, 10'000));
    rig.run(3);
    const auto& at = rig.view().tool_set;
    const JointVector goal{at[0] - 5, at[1] + 20, 0, 0, 0, at[5]};

    auto across = in_the_machine(line(goal, 100));
    across.wanted.branch.elbow = Elbow::down;
    const auto refused = rig.give(across);
    rig.until([&] { return rig.status(refused.id) == CommandStatus::error; }, 100);
    EXPECT_EQ(rig.status(refused.id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(refused.id), ErrorId::out_of_reach);
    EXPECT_EQ(rig.point()[1], 80);
    rig.until([&] { return rig.view().state == GroupState::GroupStandby; }, 10);

    auto same = in_the_machine(line(goal, 100));
    same.wanted.branch.elbow = Elbow::up;
    const auto kept = rig.give(same);
    ASSERT_TRUE(rig.until([&] { return rig.status(kept.id) == CommandStatus::done; }, 10'000));
    EXPECT_GT(rig.point()[1], 0);

    auto direct = directly(across);
    const auto changed = rig.give(direct);
    ASSERT_TRUE(rig.until([&] { return rig.status(changed.id) == CommandStatus::done; }, 10'000));
    EXPECT_LT(rig.point()[1], 0);
    EXPECT_NEAR(rig.view().tool_set[0], goal[0], 1e-9 * 300);
    EXPECT_NEAR(rig.view().tool_set[1], goal[1], 1e-9 * 300);
}

// G-073. A relative turn is about the axes of its frame, also where the tool stands turned.
TEST(GroupTurns, ARelativeTurnIsInTheDirectionsOfItsFrame) {
    // ABB, product specification IRB 120 (3HAC035960), in mm; axes in degrees.
    KinematicsDescription description{.arm = SixJoints{.geometry = WristArmLengths{.a2 = -70, .c1 = 290, .c2 = 270, .c3 = 302, .c4 = 72}}};
    for (auto& joint : description.joints) joint.unit = degree_of_axis;
    description.joints[2].zero = pi / 2;
    GroupRig rig(6, arm_of(description));
    rig.enable();
    const auto stand = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {10, 15, 10, 20, 40, 10}});
    ASSERT_TRUE(rig.until([&] { return rig.status(stand.id) == CommandStatus::done; }, 10'000));
    rig.run(3);
    const auto before = rig.view().tool_set;
    const auto turn = rig.give(in_the_machine(line_by({0, 0, 0, 0, 0, -0.3}, 0.5)));
    ASSERT_TRUE(rig.until([&] { return rig.status(turn.id) == CommandStatus::done; }, 20'000)) << static_cast<int>(rig.error_of(turn.id));
    // Turned about Z first, then about the new Y and X: a turn about the frame's Z adds to the first number alone.
    const auto after = rig.view().tool_set;
    EXPECT_NEAR(after[5], before[5] - 0.3, 1e-9);
    EXPECT_NEAR(after[4], before[4], 1e-9);
    EXPECT_NEAR(after[3], before[3], 1e-9);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-9 * 300) << "about its point";
}

}  // namespace
}  // namespace taktwerk::axes::test

// Where an arm's tool comes over the travels of its axes, against what its lengths say.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "axes/group/arm_reach.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes::test {
namespace {

AxisGroupConfig reaching_group(const KinematicsDescription& description) {
    const auto arm = Kinematics::make(description);
    EXPECT_TRUE(arm) << (arm ? "" : arm.error().text());
    AxisGroupConfig group;
    group.name = "arm";
    if (arm) group.kinematics = std::make_shared<const Kinematics>(*arm);
    return group;
}
AxisGroupConfig reaching_scara() { return reaching_group({.arm = ScaraLengths{.first = 200, .second = 150, .height = 30}}); }

WorkspaceRoom reached_room(const std::array<double, 3>& middle, double half) {
    WorkspaceRoom room{.name = "room", .half = {half, half, half}};
    room.middle.position = middle;
    return room;
}

TEST(ArmReach, OfCartesianAxesIsTheBoxOfTheirTravelsAndTheirTool) {
    KinematicsDescription portal{.arm = CartesianAxes{}};
    portal.base.position = {1000, 0, 0};
    auto group = reaching_group(portal);
    const std::array<AxisTravel, 3> travels{{{0, 400}, {-100, 100}, {-50, 0}}};
    const auto reach = arm_reach(group, travels);
    ASSERT_TRUE(reach);
    EXPECT_EQ(reach->points.size(), reach->looked_at);
    EXPECT_EQ(reach->least, (std::array<double, 3>{1000, -100, -50}));
    EXPECT_EQ(reach->most, (std::array<double, 3>{1400, 100, 0}));
    EXPECT_NEAR(reach->size(), std::hypot(400, 200, 50), 1e-9);
    EXPECT_EQ(reach->distance_to(reached_room({1200, 0, 0}, 50)), 0);
    EXPECT_NEAR(reach->distance_to(reached_room({1500, 0, 0}, 20)), 80, 1e-3) << "100 from its end, 20 of it the room's";
    EXPECT_TRUE(reach->far_from(reached_room({1500, 0, 0}, 20)));
    EXPECT_TRUE(reach->far_from(reached_room({1421, 0, 0}, 20))) << "1 away";
    EXPECT_FALSE(reach->far_from(reached_room({1420, 120, 20}, 20))) << "touched at a corner";
}

TEST(ArmReach, AnEndOfAJointIsAnEndOfTheReach) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 30}};
    const double degree = std::numbers::pi / 180;
    for (const std::size_t joint : {0, 1, 3}) description.joints[joint].unit = degree;
    description.joints[1].low = -90 * degree, description.joints[1].high = 90 * degree;
    const auto reach = arm_reach(reaching_group(description), std::array<AxisTravel, 4>{{{}, {-120, 120}, {-80, 0}, {}}});
    ASSERT_TRUE(reach);
    // Of 240 degrees of the elbow 180 are left.
    EXPECT_NEAR(static_cast<double>(reach->points.size()) / static_cast<double>(reach->looked_at), 0.75, 0.01);
    double nearest = 1e9, farthest = 0;
    for (const auto& p : reach->points) {
        nearest = std::min(nearest, std::hypot(p[0], p[1]));
        farthest = std::max(farthest, std::hypot(p[0], p[1]));
    }
    EXPECT_NEAR(nearest, 250, 1) << "with its elbow at 90 degrees: 200 and 150 at a right angle";
    EXPECT_GE(nearest, 250 - 1e-9);
    EXPECT_NEAR(farthest, 350, 1);
    EXPECT_LE(farthest, 350 + 1e-9);
    EXPECT_NEAR(reach->most[2] - reach->least[2], 80, 0.1);
    EXPECT_NEAR(reach->distance_to(reached_room({0, 0, 0}, 50)), 250 - 50 * std::numbers::sqrt2, 0.1)
        << "in the hole of the ring: never come to";
    EXPECT_TRUE(reach->far_from(reached_room({0, 0, 0}, 50)));
    EXPECT_FALSE(reach->far_from(reached_room({0, 300, 0}, 50)));
}

TEST(ArmReach, WhatHasNoEndsOrNoArmHasNoReach) {
    EXPECT_FALSE(arm_reach(AxisGroupConfig{}, std::array<AxisTravel, 2>{{{0, 1}, {0, 1}}}));
    EXPECT_FALSE(arm_reach(reaching_scara(), std::array<AxisTravel, 4>{{{}, {}, {}, {}}})) << "its straight axis has no ends";
    EXPECT_FALSE(arm_reach(reaching_scara(), std::array<AxisTravel, 3>{{{}, {}, {-80, 0}}})) << "a member too few";
    const auto turns = arm_reach(reaching_scara(), std::array<AxisTravel, 4>{{{}, {}, {-80, 0}, {}}});
    ASSERT_TRUE(turns) << "rotary axes are looked at over a turn";
    EXPECT_NEAR(turns->most[0], 350, 0.1);
    EXPECT_NEAR(turns->least[0], -350, 0.1);
}

KinematicsDescription reaching_in_degrees(const ArmDescription& arm, std::initializer_list<std::size_t> turning) {
    KinematicsDescription out{.arm = arm};
    for (const std::size_t joint : turning) out.joints[joint].unit = std::numbers::pi / 180;
    return out;
}

// A SCARA that folds by 145 degrees leaves a hole of 187 around its column, a ninth of the reach from corner to corner.
TEST(ArmReach, ARoomInASmallHoleIsNotComeTo) {
    const auto arm = reaching_in_degrees(ScaraLengths{.first = 325, .second = 275, .height = 400}, {0, 1, 3});
    const auto reach = arm_reach(reaching_group(arm), std::array<AxisTravel, 4>{{{-180, 180}, {-145, 145}, {-300, 5}, {-360, 360}}});
    ASSERT_TRUE(reach);
    const double hole = std::sqrt(325 * 325 + 275 * 275 + 2 * 325 * 275 * std::cos(145 * std::numbers::pi / 180));
    WorkspaceRoom post{.name = "post", .shape = WorkspaceRoom::Shape::cylinder, .half = {150, 150, 1000}};
    EXPECT_NEAR(reach->distance_to(post), hole - 150, 0.1);
    EXPECT_TRUE(reach->far_from(post));
    post.half[0] = post.half[1] = hole + 1;
    EXPECT_FALSE(reach->far_from(post)) << "its wall is reached into by 1";
}

// KUKA KR 6 R900: axis 1 to 2, both links, the wrist bent by the few degrees by which its centre stands off the forearm.
TEST(ArmReach, OfSixJointsIsWhereTheyAreStretched) {
    const WristArmLengths lengths{.a1 = 25, .a2 = -35, .c1 = 400, .c2 = 455, .c3 = 420, .c4 = 80};
    const auto arm = reaching_in_degrees(SixJoints{.geometry = lengths}, {0, 1, 2, 3, 4, 5});
    const auto reach = arm_reach(reaching_group(arm), std::array<AxisTravel, 6>{});
    ASSERT_TRUE(reach);
    const double links = 455 + std::hypot(420, 35) + 80, out = 25 + links;
    for (const std::size_t i : {0, 1}) {
        EXPECT_NEAR(reach->most[i], out, out / 500);
        EXPECT_NEAR(reach->least[i], -out, out / 500);
        EXPECT_LE(std::max(reach->most[i], -reach->least[i]), out + 1e-9);
    }
    EXPECT_NEAR(reach->most[2], 400 + links, out / 500);
}

// Its masters are commanded to one X; of all places of both most would be a beam that is torn off its guides.
TEST(ArmReach, OfABeamGantryIsThatOfASquareBeam) {
    KinematicsDescription arm{.arm = BeamGantryShape{.span = 600}};
    arm.joints[1].zero = 0.4;  // what homing found
    auto group = reaching_group(arm);
    ASSERT_TRUE(group.equipment.tools.define(1, {.frame = {100, 50, -35, 0, 0, 0}}));
    group.equipment.selected_tool = 1;
    const auto reach = arm_reach(group, std::array<AxisTravel, 4>{{{0, 1000}, {-1, 1000}, {-200, 800}, {-150, 5}}});
    ASSERT_TRUE(reach);
    EXPECT_EQ(reach->text(), "X 100 to 1100, Y -150 to 850, Z -185 to -30");
    EXPECT_EQ(reach->points.size(), reach->looked_at);
}

// 4096 turns: places at equal distances would all be one angle.
TEST(ArmReach, OfAnAxisOfManyTurnsIsAllRound) {
    const auto arm = reaching_in_degrees(ScaraLengths{.first = 200, .second = 150, .height = 30}, {0, 1, 3});
    const double turns = 2048 * 360;
    const auto reach = arm_reach(reaching_group(arm), std::array<AxisTravel, 4>{{{-turns, turns}, {0, 90}, {-80, 0}, {}}});
    ASSERT_TRUE(reach);
    EXPECT_EQ(reach->text(), "X -350 to 350, Y -350 to 350, Z -50 to 30");
}

TEST(ArmReach, WhatHasNoEndsIsLookedAtOverThoseOfItsJoint) {
    auto arm = reaching_in_degrees(ScaraLengths{.first = 200, .second = 150, .height = 30}, {0, 1, 3});
    constexpr double degree = std::numbers::pi / 180;
    arm.joints[0].low = 190 * degree, arm.joints[0].high = 260 * degree;
    arm.joints[2].low = -80, arm.joints[2].high = 0;
    arm.coupling[2][3] = -20 / (2 * std::numbers::pi);  // the lift's screw: its axis goes with the turn, too
    arm.joints[3].low = -90 * degree, arm.joints[3].high = 90 * degree;
    const auto reach = arm_reach(reaching_group(arm), std::array<AxisTravel, 4>{{{}, {0, 0.001}, {}, {}}});
    ASSERT_TRUE(reach);
    EXPECT_GT(reach->points.size(), 0u);
    EXPECT_EQ(reach->text(), "X -344.7 to -60.8, Y -344.7 to -60.8, Z -50 to 30") << "350 times the cosines of 190 and 260 degrees";
}

// Four digits of the whole, in any unit of length, and none that say nothing.
TEST(ArmReach, IsShownInPlainNumbers) {
    const auto shown = [](double unit) {
        const auto group = reaching_group({.arm = CartesianAxes{}});
        const std::array<AxisTravel, 3> travels{{{-1234.5678 * unit, 1500 * unit}, {0, 250 * unit}, {-1e-9 * unit, 20 * unit}}};
        return arm_reach(group, travels)->text();
    };
    EXPECT_EQ(shown(1), "X -1235 to 1500, Y 0 to 250, Z 0 to 20");
    EXPECT_EQ(shown(0.001), "X -1.235 to 1.5, Y 0 to 0.25, Z 0 to 0.02");
    EXPECT_EQ(shown(1000), "X -1235000 to 1500000, Y 0 to 250000, Z 0 to 20000");
    const std::array<AxisTravel, 3> flat{{{0, 40000}, {-3, 3}, {20, 325}}};
    EXPECT_EQ(arm_reach(reaching_group({.arm = CartesianAxes{}}), flat)->text(), "X 0 to 40000, Y -3 to 3, Z 20 to 325");
    const std::array<AxisTravel, 3> one_place{{{7, 7}, {0, 0}, {0.5, 0.5}}};
    EXPECT_EQ(arm_reach(reaching_group({.arm = CartesianAxes{}}), one_place)->text(), "X 7 to 7, Y 0 to 0, Z 0.5 to 0.5");
}

TEST(ArmReach, RoomsThatAreKeptFreeMayLeaveItNothing) {
    const auto reach = arm_reach(reaching_scara(), std::array<AxisTravel, 4>{{{}, {}, {-80, 0}, {}}});
    ASSERT_TRUE(reach);
    Workspace space{{reached_room({0, 0, 0}, 400)}};
    space.rooms[0].kept_free = true;
    EXPECT_TRUE(reach->outside_of(space));
    space.rooms[0].half[0] = 340;
    EXPECT_FALSE(reach->outside_of(space)) << "stretched along X it stands 10 before the room";
}

// Its elbows stand 150 + 300 cos(q) from the middle: rods of 310 span that beyond 57.8 degrees alone.
TEST(ArmReach, ADeltaThatDoesNotCloseEverywhereSaysSo) {
    RotaryDeltaLengths lengths;
    lengths.base_radius = 200, lengths.platform_radius = 50, lengths.upper = 300, lengths.rod = 310;
    const auto group = reaching_group({.arm = lengths});
    const auto over = [&](double least, double most) {
        const auto reach = arm_reach(group, std::array<AxisTravel, 3>{{{least, most}, {least, most}, {least, most}}});
        return reach ? static_cast<double>(reach->points.size()) / static_cast<double>(reach->looked_at) : -1;
    };
    EXPECT_EQ(over(0, 0.9), 0);
    EXPECT_GT(over(0, 1.4), 0);
    EXPECT_LT(over(0, 1.4), 1);
    EXPECT_EQ(over(1.1, 1.4), 1);
}

}  // namespace
}  // namespace taktwerk::axes::test

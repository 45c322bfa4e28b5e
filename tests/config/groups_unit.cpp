// `groups:` of a machine file: what the arm becomes. What must be refused, with its line and column: tests/config/bad/group_*.yaml.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "axes/group/workspace.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "runtime/check/reach_remarks.hpp"

namespace taktwerk::config {
namespace {

LoadedMachine loaded_groups() {
    auto result = load_machine(std::string(TAKTWERK_SOURCE_DIR) + "/tests/config/good/groups.yaml");
    if (const auto* errors = std::get_if<1>(&result)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    return std::get<0>(std::move(result));
}

TEST(GroupsOfAFile, TheArmStandsWhereItsAxesSay) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& arm = machine.axis_groups[0];
    EXPECT_EQ(arm.name, "arm");
    EXPECT_EQ(arm.members, (std::vector<std::string>{"a", "b", "z", "c"}));
    EXPECT_EQ(arm.default_dynamics.velocity, 100);
    EXPECT_EQ(arm.default_dynamics.acceleration, 0);
    EXPECT_EQ(arm.default_dynamics.jerk, 1000);
    EXPECT_EQ(axes::setup_velocity_of(arm), 120) << "12 cm/s";
    EXPECT_EQ(axes::setup_velocity_of(machine.axis_groups[1]), 250) << "reduced speed of ISO 10218-1, where nothing is said";
    ASSERT_TRUE(arm.kinematics);
    // a = 30 deg; b = 20 deg counts backwards from 10: 10 - 20 = -10 deg of the picture. The base stands at x = 1000 mm, turned by 90 deg.
    const auto at = arm.kinematics->forward({30, 20, 5, 0, 0, 0}, {});
    ASSERT_TRUE(at.miss.ok());
    const double degree = std::numbers::pi / 180;
    const double x = 200 * std::cos(30 * degree) + 150 * std::cos(20 * degree),
                 y = 200 * std::sin(30 * degree) + 150 * std::sin(20 * degree);
    EXPECT_NEAR(at.pose.position[0], 1000 - y, 1e-9);
    EXPECT_NEAR(at.pose.position[1], x, 1e-9);
    EXPECT_NEAR(at.pose.position[2], 35, 1e-9);
    EXPECT_TRUE(arm.kinematics->limits_of({0, 119, 0, 0, 0, 0}).ok());
    EXPECT_FALSE(arm.kinematics->limits_of({0, 121, 0, 0, 0, 0}).ok());
}

// Its tool's point comes 350 + 120 from the base at X = 1000 at most; the cell ends at X = 300, 230 before that.
TEST(GroupsOfAFile, ARoomThatTheToolNeverComesToIsRemarked) {
    auto machine = loaded_groups().machine;
    EXPECT_TRUE(runtime::reach_remarks(machine).empty()) << "the lift has no ends: nothing is known";
    for (auto& binding : machine.axes)
        if (binding.axis.name == "z") binding.axis.limits.position_min = 0, binding.axis.limits.position_max = 100;
    const auto found = runtime::reach_remarks(machine);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "remark.reach");
    EXPECT_EQ(found[0].subject, "groups.arm.workspace.cell");
    auto moved = *machine.axis_groups[0].workspace;
    moved.rooms[0].middle.position[0] = 1000;
    machine.axis_groups[0].workspace = std::make_shared<const axes::Workspace>(moved);
    EXPECT_TRUE(runtime::reach_remarks(machine).empty()) << "a cell around the arm; the post is to be kept free, wherever it stands";
}

// Of 200 and 150 mm and a gripper of 120 mm; its base stands at X = 1000.
TEST(GroupsOfAFile, ARoomThatOneOfItsToolsComesToIsNotRemarked) {
    auto machine = loaded_groups().machine;
    for (auto& binding : machine.axes)
        if (binding.axis.name == "z") binding.axis.limits.position_min = 0, binding.axis.limits.position_max = 100;
    auto& arm = machine.axis_groups[0];
    auto space = *arm.workspace;
    space.rooms[0].middle.position = {1450, 0, 30};
    space.rooms[0].half = {10, 10, 50};
    arm.workspace = std::make_shared<const axes::Workspace>(space);
    EXPECT_TRUE(runtime::reach_remarks(machine).empty()) << "the gripper, which is selected";
    arm.equipment.selected_tool = 31;
    EXPECT_TRUE(runtime::reach_remarks(machine).empty()) << "the pen does not; a program may select the gripper";
    arm.equipment.tools = {};
    arm.equipment.selected_tool = 0;
    const auto found = runtime::reach_remarks(machine);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found[0].what.find("no nearer to this room than 90"), std::string::npos) << found[0].what << ": from 1350 to 1440";
}

TEST(GroupsOfAFile, RoomsThatLeaveTheToolNoPlaceAreRemarked) {
    auto machine = loaded_groups().machine;
    for (auto& binding : machine.axes)
        if (binding.axis.name == "z") binding.axis.limits.position_min = 0, binding.axis.limits.position_max = 100;
    axes::Workspace space{{{.name = "press", .kept_free = true, .half = {500, 500, 500}}}};
    space.rooms[0].middle.position = {1000, 0, 0};
    machine.axis_groups[0].workspace = std::make_shared<const axes::Workspace>(space);
    const auto found = runtime::reach_remarks(machine);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].subject, "groups.arm.workspace");
}

// Lengths in the group's unit, angles in rad, masses in kg, inertias in kg m2.
TEST(GroupsOfAFile, FramesAndToolsAreThereFromTheBeginning) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& equipment = machine.axis_groups[0].equipment;
    const double degree = std::numbers::pi / 180;
    const auto expect = [](const axes::SixNumbers& six, const axes::SixNumbers& wanted) {
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(six[i], wanted[i], 1e-12) << i;
    };
    expect(equipment.frames.machine, {2000, 0, 0, 0, 0, 90 * degree});
    expect(equipment.frames.product[0], {0, 100, 0, 0, -45 * degree, 0});
    expect(equipment.frames.product[7], {0, 0, 5, 1, 0, 0});
    expect(equipment.frames.product[3], {});
    ASSERT_NE(equipment.tools.find(3), nullptr);
    expect(equipment.tools.find(3)->frame, {120, 0, -40, 0, 0, 180 * degree});
    EXPECT_NEAR(equipment.tools.find(3)->body.mass, 0.85, 1e-12);
    EXPECT_NEAR(equipment.tools.find(3)->body.centre[2], 20, 1e-12);
    EXPECT_NEAR(equipment.tools.find(3)->body.inertia[0], 1e-3, 1e-15);
    EXPECT_NEAR(equipment.tools.find(3)->body.inertia[2], 2e-3, 1e-15);
    EXPECT_NE(equipment.tools.find(31), nullptr);
    EXPECT_EQ(equipment.tools.find(4), nullptr);
    ASSERT_NE(equipment.payloads.find(1), nullptr);
    EXPECT_EQ(equipment.payloads.find(1)->mass, 2);
    EXPECT_NEAR(equipment.payloads.find(1)->centre[0], 30, 1e-12);
    EXPECT_EQ(equipment.selected_tool, 3);
    EXPECT_EQ(equipment.selected_payload, 1);
    EXPECT_EQ(machine.axis_groups[1].equipment.selected_tool, 0);
}

// x from -300 to 300, y from 10 to 50, z without an end; a cylinder from 0 to 30 about x = 120.
TEST(GroupsOfAFile, RoomsOfTheToolAndItsFollowingError) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& arm = machine.axis_groups[0];
    ASSERT_TRUE(arm.workspace);
    ASSERT_EQ(arm.workspace->rooms.size(), 2u);
    EXPECT_EQ(arm.workspace->rooms[1].name, "post");
    EXPECT_NEAR(arm.workspace->clearance({-297, 30, 1e6}), 3, 1e-9);
    EXPECT_NEAR(arm.workspace->clearance({0, 60, 0}), -10, 1e-9);
    EXPECT_NEAR(arm.workspace->clearance({120, 30, 15}), -15, 1e-9) << "15 from the post's ends, 30 from its side";
    EXPECT_NEAR(arm.workspace->clearance({120, 30, 33}), 3, 1e-9);
    EXPECT_EQ(arm.following.window, 2);
    EXPECT_EQ(arm.following.time, std::chrono::milliseconds{20});
    EXPECT_FALSE(machine.axis_groups[1].workspace);
}

// Axes in different units of length make one machine in the group's unit.
TEST(GroupsOfAFile, UnitsOfAxesBecomeTheGroups) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& portal = machine.axis_groups[1];
    ASSERT_TRUE(portal.kinematics);
    const auto at = portal.kinematics->forward({7, 7, 0, 0, 0, 0}, {});
    EXPECT_NEAR(at.pose.position[0], 70, 1e-9) << "cm";
    EXPECT_NEAR(at.pose.position[1], 7, 1e-9);
}

// Universal Robots' own table of the UR5e: at 0 it lies along -x, a2 + a3 long; d4 and d6 to -y; d1 up, d5 down. Calibration adds 1 mm along
// the flange's z, which points to -y there.
TEST(GroupsOfAFile, SixJointsByATable) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& arm = machine.axis_groups[2];
    ASSERT_TRUE(arm.kinematics);
    const auto at = arm.kinematics->forward({}, {});
    ASSERT_TRUE(at.miss.ok());
    EXPECT_NEAR(at.pose.position[0], -.425 - .3922, 1e-9) << "m";
    EXPECT_NEAR(at.pose.position[1], -.1333 - .0996 - .001, 1e-9);
    EXPECT_NEAR(at.pose.position[2], .1625 - .0997, 1e-9);
    EXPECT_FALSE(arm.kinematics->closed_form()) << "calibrated";
}

// A hollow wrist: motor 5 goes with joint 4 by a fiftieth, so at 50 degrees of joint 4 motor 5 says 1 where its joint is at 0.
TEST(GroupsOfAFile, AMotorThatGoesWithAnotherJoint) {
    const auto machine = loaded_groups().machine;
    ASSERT_EQ(machine.axis_groups.size(), 5u);
    const auto& arm = machine.axis_groups[3];
    ASSERT_TRUE(arm.kinematics);
    const auto at = arm.kinematics->forward({0, 0, 0, 50, 1, 0}, {});
    ASSERT_TRUE(at.miss.ok());
    EXPECT_NEAR(at.pose.position[0], -70, 1e-9) << "straight up: joint 5 does not bend it";
    EXPECT_NEAR(at.pose.position[1], 0, 1e-9);
    EXPECT_NEAR(at.pose.position[2], 290 + 270 + 302 + 72, 1e-9);

    // A SCARA's screw: a turn of 40 degrees lowers the motor's count by 2 mm while the lift stands.
    const auto& scara = machine.axis_groups[4];
    ASSERT_TRUE(scara.kinematics);
    EXPECT_NEAR(scara.kinematics->forward({0, 0, 3, 40, 0, 0}, {}).pose.position[2], 30 + 3 + 2, 1e-9);
}

}  // namespace
}  // namespace taktwerk::config

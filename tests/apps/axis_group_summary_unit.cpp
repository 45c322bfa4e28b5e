// What `taktwerk check` says of groups and their paths: what a builder of machines compares with the arm in front of him.

#include <numbers>

#include <gmock/gmock.h>

#include "apps/machine/axis_group_summary.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Two links of 200 and 150 mm, stretched along X where its axes are at 0.
runtime::MachineConfig scara() {
    axes::ScaraLengths lengths;
    lengths.first = 200;
    lengths.second = 150;
    axes::AxisGroupConfig group{.name = "arm", .members = {"j1", "j2", "j3", "j4"}};
    group.kinematics = std::make_shared<const axes::Kinematics>(axes::Kinematics::make({.arm = lengths}).value());
    runtime::MachineConfig config;
    config.axis_groups.push_back(group);
    return config;
}

TEST(AxisGroupSummary, SaysWhichArmItIsAndWhereItStands) {
    auto config = scara();
    const auto bare = axis_groups_text(config);
    EXPECT_THAT(bare, HasSubstr("arm              j1, j2, j3, j4\n    a SCARA: 4 joints, commands X Y Z C of its tool\n"));
    EXPECT_THAT(bare, HasSubstr("the tool's point stands at X 350 Y 0 Z 0 mm"));
    EXPECT_THAT(bare, HasSubstr("no tool is selected at the start: its point is the flange"));
    EXPECT_THAT(bare, HasSubstr("no workspace"));
    EXPECT_THAT(bare, HasSubstr("at most 250 mm/s")) << "ISO 10218-1, 5.6.2";

    auto& equipment = config.axis_groups[0].equipment;
    ASSERT_TRUE(equipment.tools.define(3, {.frame = {0, 0, 120, 0, 0, 0}, .body = {.mass = 0.8}}));
    equipment.selected_tool = 3;
    equipment.frames.product[1] = {40, 400, 280, 0, 0, 0};
    config.axis_groups[0].setup_velocity = 100;
    const auto dressed = axis_groups_text(config);
    EXPECT_THAT(dressed, HasSubstr("tool 3: its point stands at X 0 Y 0 Z 120 mm, RX 0 RY 0 RZ 0 deg, seen from the flange; 0.8 kg; "
                                   "selected at the start"));
    EXPECT_THAT(dressed, Not(HasSubstr("no tool")));
    EXPECT_THAT(dressed, HasSubstr("pcs_2 stands in the world at X 40 Y 400 Z 280 mm"));
    EXPECT_THAT(dressed, HasSubstr("at most 100 mm/s"));
    EXPECT_EQ(axis_groups_json(config)[0]["arm"], "a SCARA");
    EXPECT_EQ(axis_groups_text({}), "");
}

TEST(AxisGroupSummary, TellsScriptsWhereItStandsAndComes) {
    auto config = scara();
    auto group = axis_groups_json(config)[0];
    EXPECT_EQ(group["unit"], "mm");
    EXPECT_EQ(group["at_zero"]["X"], 350);
    EXPECT_EQ(group["at_zero"]["C"], 0);
    EXPECT_TRUE(group["reach"].is_null()) << "of an axis j3 without ends";

    for (const char* name : {"j1", "j2", "j3", "j4"}) {
        runtime::AxisBinding binding;
        binding.axis.name = name;
        binding.axis.limits.position_min = std::string(name) == "j3" ? -80 : -std::numbers::pi / 2;
        binding.axis.limits.position_max = std::string(name) == "j3" ? 20 : std::numbers::pi / 2;
        config.axes.push_back(binding);
    }
    group = axis_groups_json(config)[0];
    EXPECT_EQ(group["reach"]["Z"], (nlohmann::ordered_json{-80.0, 20.0}));
    EXPECT_NEAR(group["reach"]["X"][1].get<double>(), 350, 0.4);
    EXPECT_NEAR(group["reach"]["X"][0].get<double>(), -150, 0.4) << "j1 and j2 at 90 degrees, the same way";
    EXPECT_EQ(group["reach"]["without_pose"], 0);
}

TEST(AxisGroupSummary, SaysWhatAPathAsksFor) {
    runtime::MachineConfig config;
    EXPECT_EQ(paths_text(config), "");
    runtime::PathConfig path{.name = "plate", .file = "plate.ngc"};
    path.text = std::make_shared<const std::string>("G21 G90\nT7 M6\nG0 X10 Y-20\nG1 X60 F600\nM2\n");
    config.paths.push_back(path);
    const auto text = paths_text(config);
    EXPECT_THAT(text, HasSubstr("Paths in G-code\n  plate            plate.ngc, 5 lines\n"));
    EXPECT_THAT(text, HasSubstr("in the machine: X 0 to 60 mm, Y -20 to 0 mm\n"));
    EXPECT_THAT(text, HasSubstr("tools that it asks for: 7\n"));
    EXPECT_EQ(paths_json(config)[0]["extents"]["X"], (nlohmann::ordered_json{0.0, 60.0}));

    config.paths[0].text = std::make_shared<const std::string>("G21 G90\nG0 X10\nG1 X60 F-1\nM2\n");
    EXPECT_THAT(paths_text(config), HasSubstr("up to its fault"));
    EXPECT_EQ(paths_json(config)[0]["whole"], false);
}

}  // namespace
}  // namespace taktwerk::apps

// What is no arm is refused when it is made, with what, where and what to do; tools by number.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "axes/kinematics/tools.hpp"
#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {
namespace {

using ::testing::HasSubstr;

void expect_refused(const KinematicsDescription& description, const std::string& code, const std::string& words) {
    const Result<Kinematics> made = Kinematics::make(description);
    ASSERT_FALSE(made.ok()) << code << " " << words;
    EXPECT_EQ(made.error().code, code);
    EXPECT_THAT(made.error().text(), HasSubstr(words));
    EXPECT_FALSE(made.error().remedy.empty());
}

TEST(MakeKinematics, RefusesLengthsThatAreNone) {
    expect_refused({.arm = ScaraLengths{.first = .2, .second = 0}}, "kinematics.length", "scara.second: 0 where it must be above 0");
    expect_refused({.arm = PalletizerLengths{.upper = -1, .fore = 1}}, "kinematics.length", "palletizer.upper: -1 where");
    expect_refused({.arm = RotaryDeltaLengths{.base_radius = .2, .platform_radius = .05, .upper = .3, .rod = std::nan("")}},
                   "kinematics.length", "rotary_delta.rod: nan where it must be above 0");
    expect_refused({.arm = LinearDeltaLengths{.base_radius = .5, .platform_radius = .1, .rod = .3}}, "kinematics.length",
                   "rod less both radii's difference");
    expect_refused({.arm = BeamGantryShape{}}, "kinematics.length", "beam_gantry.span: 0 where");
    expect_refused({.arm = SixJoints{.geometry = WristArmLengths{.c1 = 1, .c3 = 1}}}, "kinematics.length", "six_joints.c2: 0 where");
    SixJoints::Table table = ur5e_table();
    table.rows[2].alpha = std::numeric_limits<double>::infinity();
    expect_refused({.arm = SixJoints{.geometry = table}}, "kinematics.length", "six_joints.rows.2.alpha: inf where it must be a number");
    SixJoints bent{.geometry = ur5e_table()};
    bent.deviations[3].turn[1] = std::nan("");
    expect_refused({.arm = bent}, "kinematics.length", "six_joints.a deviation's turn: nan where");
}

TEST(MakeKinematics, RefusesWhatIsNoArm) {
    expect_refused({.arm = CartesianAxes{.linear = {true, false, false}}}, "kinematics.geometry", "1 linear axes");
    expect_refused({.arm = CartesianAxes{.turn_about = 3}}, "kinematics.geometry", "a turn about 3");
    SixJoints::Table parallel = ur5e_table();
    parallel.rows[0].alpha = 0;  // axis 2 along axis 1
    expect_refused({.arm = SixJoints{.geometry = parallel}}, "kinematics.geometry", "axes 1 and 2 are parallel");
    SixJoints::Table shrunk = ur5e_table();
    shrunk.rows[1].a = shrunk.rows[2].a = 0;
    expect_refused({.arm = SixJoints{.geometry = shrunk}}, "kinematics.geometry", "two joints are one");
}

TEST(MakeKinematics, RefusesJointsCouplingsAndBases) {
    KinematicsDescription d = epson_g10().description;
    d.joints[1].sign = .5;
    expect_refused(d, "kinematics.joint", "scara, joint 2: sign is 0.5");
    d = epson_g10().description;
    d.joints[3].unit = 0;
    expect_refused(d, "kinematics.joint", "joint 4: unit is 0");
    d = epson_g10().description;
    d.joints[2].zero = std::nan("");
    expect_refused(d, "kinematics.joint", "joint 3: zero is nan");
    d = epson_g10().description;
    d.joints[0].low = 1, d.joints[0].high = -1;
    expect_refused(d, "kinematics.joint", "its limits are 1 to -1");
    d = epson_g10().description;
    d.coupling[2][2] = 0;
    expect_refused(d, "kinematics.coupling", "no inverse");
    d = epson_g10().description;
    d.coupling[3][4] = .1;  // there is no fifth joint
    expect_refused(d, "kinematics.coupling", "axes that this arm does not have");
    d = epson_g10().description;
    d.base.orientation = {1, 1, 0, 0};
    expect_refused(d, "kinematics.base", "length 1.414");
}

// The screw of a SCARA's last joint lifts its shaft: 20 mm a turn, as a coupling of the lift's motor.
TEST(MakeKinematics, CouplesTheScrewOfAScara) {
    KinematicsDescription d = epson_g10().description;
    d.coupling[2][3] = -.020 / (2 * std::numbers::pi);
    const Kinematics scara = Kinematics::make(d).value();
    const Pose turned = scara.forward({0, 90 * degree, 0, 180 * degree, 0, 0}, {}).pose;
    EXPECT_NEAR(turned.position[2], .010, 1e-15);
    const AxisSolution way = scara.inverse(turned, {}, {}, {0, 90 * degree, 0, 180 * degree, 0, 0});
    ASSERT_TRUE(way.ok());
    EXPECT_NEAR(way.axes[2], 0, 1e-12);
}

// A written table and lengths of the same arm are the same arm; either is recognised as a closed form, a bent wrist is not.
TEST(MakeKinematics, KnowsClosedForms) {
    // IRB 120 in the classic convention.
    const SixJoints::Table table{
        {{{0, -right, .290, 0}, {.270, 0, 0, -right}, {.070, -right, 0, 0}, {0, right, .302, 0}, {0, -right, 0, 0}, {0, 0, .072, 0}}},
        DhConvention::classic};
    const Kinematics written = Kinematics::make({.arm = SixJoints{.geometry = table}}).value(), lengths = made(irb_120());
    for (const Joints& q : {degrees({0, 0, 0, 0, 0, 0}), degrees({10, -20, 30, -40, 50, 60}), degrees({-100, 70, 20, 140, -80, 200})}) {
        const Pose a = written.forward(q, {}).pose, b = lengths.forward(q, {}).pose;
        EXPECT_LT((position_of(a) - position_of(b)).norm(), 1e-14);
    }
    EXPECT_TRUE(written.closed_form());
    EXPECT_TRUE(lengths.closed_form());
    EXPECT_TRUE(made(ur5e()).closed_form());
    EXPECT_TRUE(made(tx40()).closed_form());
    EXPECT_FALSE(made(calibrated(irb_120())).closed_form());
    EXPECT_FALSE(made(crx_10ia()).closed_form());
}

TEST(MakeKinematics, NamesWhatAnArmCommands) {
    EXPECT_EQ(made(irb_120()).joint_count(), 6U);
    EXPECT_EQ(made(epson_g10()).commands(), (std::array<bool, 6>{true, true, true, false, false, true}));
    EXPECT_EQ(made(linear_delta()).commands(), (std::array<bool, 6>{true, true, true, false, false, false}));
    EXPECT_EQ(made(beam_gantry()).joint_count(), 5U);
    EXPECT_EQ(made(cartesian()).rotary(), (std::array<bool, 6>{false, false, false, true, false, false}));
    EXPECT_EQ(pose_component_names[5], "C");
    EXPECT_EQ(name(KinematicFault::does_not_close), "does_not_close");
}

// PLCopen Part 4 (G-079): number 0 is the flange or nothing, readable and not writable; an undefined number is not there.
TEST(MakeKinematics, ToolsAndPayloadsByNumber) {
    Tools tools;
    ASSERT_NE(tools.find(0), nullptr);
    EXPECT_EQ(*tools.find(0), Tool{});
    EXPECT_FALSE(tools.define(0, {{0, 0, 1, 0, 0, 0}, {}}));
    EXPECT_EQ(*tools.find(0), Tool{});
    EXPECT_EQ(tools.find(3), nullptr);
    EXPECT_TRUE(tools.define(3, {{0, 0, .1, 0, 0, 0}, {.mass = 1.5}}));
    EXPECT_EQ(tools.find(3)->body.mass, 1.5);
    EXPECT_FALSE(tools.define(tool_numbers, {}));
    EXPECT_EQ(tools.find(tool_numbers), nullptr);
}

}  // namespace
}  // namespace taktwerk::axes

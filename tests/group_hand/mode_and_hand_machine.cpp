// What two hands and a mode switch do to each other at one group, one case each.

#include "tests/group_hand/hand_rig.hpp"

namespace taktwerk::group_hand {
namespace {

using axes::GroupState;

// A selector that is turned from manual over automatic to set-up mode while the group still brakes: each mode waits until it stands.
TEST(GroupHandMode, ASwitchThatIsTurnedThroughAutomaticStopsOnThePath) {
    HandRig rig({.manual = 200, .setup = 20});
    ASSERT_TRUE(rig.jog({"acs", "shoulder+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+"}, 300ms).accepted());
    ASSERT_TRUE(rig.mode(Mode::automatic).accepted());
    rig.run(20ms);
    ASSERT_GT(rig.m.axis("shoulder").set_velocity, 50) << "it brakes still";
    ASSERT_TRUE(rig.mode(Mode::setup).accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    rig.run(2ms);
    EXPECT_EQ(rig.seen().state, GroupState::GroupStandby) << rig.seen().error;
    ASSERT_TRUE(rig.order(rig.a, CommandKind::enable, "all").accepted()) << "automatic mode has taken a person's power back";
    ASSERT_TRUE(rig.until([&] { return rig.seen().powered; }, 3s));
    rig.run(10ms);
    ASSERT_TRUE(rig.jog({"acs", "shoulder-"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder-"}, 400ms).accepted());
    EXPECT_NEAR(rig.m.axis("shoulder").set_velocity, -20, 0.1) << "as slowly as the last mode says";
}

// Automatic mode and the start right behind it, while the group still brakes: the program has its axes when they stand, and runs as it would have.
TEST(GroupHandMode, AProgramThatIsStartedWhileTheGroupBrakesRuns) {
    HandRig rig({.manual = 200, .setup = 20});
    ASSERT_TRUE(rig.jog({"acs", "shoulder+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+"}, 300ms).accepted());
    ASSERT_TRUE(rig.mode(Mode::automatic).accepted());
    ASSERT_TRUE(rig.order(rig.a, CommandKind::program_start, "scara_arcs").accepted());
    ASSERT_GT(rig.m.axis("shoulder").set_velocity, 50) << "it brakes still";
    EXPECT_TRUE(rig.until(
        [&] { return rig.seen().state == GroupState::GroupMoving && rig.seen().block != nullptr && rig.seen().along.velocity > 50; }, 20s))
        << static_cast<int>(rig.seen().state) << rig.m.alarms();
    EXPECT_EQ(rig.m.alarms(), "");
}

// Who holds a key of one axis and presses one of the group beside it is refused, and lets go of the first all the same.
TEST(GroupHandMode, ARefusedPressKeepsWhatIsHeldReleasable) {
    HandRig rig;
    hmi::CommandRequest alone;
    alone.kind = CommandKind::jog;
    alone.target = "elbow";
    alone.value = 30;
    alone.press = true;
    alone.valid_for = 250ms;
    ASSERT_TRUE(rig.reply(rig.a, rig.send(alone, rig.a)).accepted());
    rig.run(50ms);
    alone.press = false;
    ASSERT_TRUE(rig.reply(rig.a, rig.send(alone, rig.a)).accepted());
    const auto refused = rig.jog({"acs", "shoulder+"});
    EXPECT_EQ(refused.axis_error, axes::ErrorId::member_moves) << refused.error.what;
    ASSERT_GT(rig.m.axis("elbow").set_velocity, 10);
    alone.value = 0;
    ASSERT_TRUE(rig.reply(rig.a, rig.send(alone, rig.a)).accepted());
    const double then = rig.m.axis("elbow").set_velocity;
    rig.run(5ms);
    EXPECT_LT(rig.m.axis("elbow").set_velocity, then) << "let go is let go, at once";
    rig.run(longest_ramp);
    EXPECT_EQ(rig.m.alarms(), "") << "it was let go, its lease did not run out";
}

// One axis is somebody else's: he is named, and not who has the others and asks.
TEST(GroupHandMode, WhoHasOneOfTheAxesIsNamed) {
    HandRig rig;
    hmi::CommandRequest take;
    take.kind = CommandKind::take_control;
    take.target = "lift";
    take.commissioning = true;
    ASSERT_TRUE(rig.reply(rig.b, rig.send(take, rig.b)).accepted());
    const auto refused = rig.jog({"acs", "shoulder+"});
    EXPECT_EQ(refused.answer, Answer::no_control);
    EXPECT_NE(refused.error.what.find("commissioning has control"), std::string::npos) << refused.error.what;
}

// The same the other way round: the group is held, and one of its axes is pressed.
TEST(GroupHandMode, ARefusedPressOfAnAxisKeepsTheGroupHeld) {
    HandRig rig;
    ASSERT_TRUE(rig.jog({"acs", "shoulder+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+"}, 200ms).accepted());
    hmi::CommandRequest alone;
    alone.kind = CommandKind::jog;
    alone.target = "elbow";
    alone.value = 30;
    alone.press = true;
    alone.valid_for = 250ms;
    EXPECT_EQ(rig.reply(rig.a, rig.send(alone, rig.a)).axis_error, axes::ErrorId::axis_grouped);
    EXPECT_TRUE(rig.hold({"acs", "shoulder+"}, 200ms).accepted()) << "another key's refusal ends nothing";
    EXPECT_FALSE(rig.order(rig.b, CommandKind::move, "elbow", 10, 10).accepted());
    ASSERT_TRUE(rig.let_go().accepted());
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_EQ(rig.m.alarms(), "");
}

// A renewal that says another distance is refused in words that say so; what is held can still be let go.
TEST(GroupHandMode, ARenewalWithAnotherDistanceIsRefusedAndLetGo) {
    HandRig rig;
    ASSERT_TRUE(rig.jog({"acs", "elbow+", 1, 100}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow+", 1, 100}, 200ms).accepted());
    const auto other = rig.jog({"acs", "elbow+", 1, 50, false});
    EXPECT_EQ(other.answer, Answer::bad_value);
    EXPECT_NE(other.error.what.find("distance"), std::string::npos) << other.error.what;
    ASSERT_TRUE(rig.let_go().accepted());
    const double then = rig.m.axis("elbow").set_velocity;
    rig.run(60ms);
    EXPECT_LT(rig.m.axis("elbow").set_velocity, then);
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_EQ(rig.m.alarms(), "") << "it was let go, its lease did not run out";
}

// A turn of more than half a turn ends where it was told to, too: 270 and then 200 deg of a wrist that goes from -360 to 360.
TEST(GroupHandMode, ATurnOfMoreThanHalfATurnEndsExactly) {
    HandRig rig({.manual = 250, .setup = 200});
    rig.bend();
    ASSERT_TRUE(rig.jog({"acs", "wrist-", 1, 200}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "wrist-", 1, 200}, 2s).accepted());
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, 1s));
    for (const auto& [way, degrees] :
         {std::pair{"rz+", 270.0}, std::pair{"rz-", 200.0}, std::pair{"rz+", 180.0}, std::pair{"rz-", 360.0}}) {
        const double from = rig.at("wrist");
        ASSERT_TRUE(rig.jog({"mcs", way, 1, degrees}).accepted());
        const auto last = rig.hold({"mcs", way, 1, degrees}, 4s);
        EXPECT_TRUE(last.accepted()) << last.error.what;
        EXPECT_NEAR(rig.at("wrist") - from, way[2] == '+' ? degrees : -degrees, 1e-6) << way;
        EXPECT_EQ(rig.seen().jog_end, axes::JogEnd::distance);
        ASSERT_TRUE(rig.let_go().accepted());
        ASSERT_TRUE(rig.until([&] { return rig.stands(); }, 1s));
        rig.run(50ms);
    }
}

}  // namespace
}  // namespace taktwerk::group_hand

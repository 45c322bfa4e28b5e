// A person jogs the SCARA through the gateway. What must hold in every cycle stands in the rig.

#include "tests/group_hand/hand_rig.hpp"

namespace taktwerk::group_hand {
namespace {

using axes::GroupState;

// Each member at what the mode leaves it: 75 deg/s in manual mode, 15 in set-up mode; half of it with 0.5.
TEST(GroupHand, AnAxisOfTheGroupGoesWhileItIsHeld) {
    HandRig rig;
    ASSERT_TRUE(rig.jog({"acs", "elbow+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 500ms).accepted());
    EXPECT_EQ(rig.seen().state, GroupState::GroupMoving);
    EXPECT_NEAR(rig.m.axis("elbow").set_velocity, 75, 0.1);
    EXPECT_EQ(rig.m.axis("shoulder").set_velocity, 0);
    ASSERT_TRUE(rig.hold({"acs", "elbow+", 0.5}, 500ms).accepted());
    EXPECT_NEAR(rig.m.axis("elbow").set_velocity, 37.5, 0.1);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    EXPECT_EQ(rig.seen().state, GroupState::GroupStandby);

    ASSERT_TRUE(rig.mode(Mode::setup).accepted());
    ASSERT_TRUE(rig.jog({"acs", "elbow-"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow-"}, 500ms).accepted());
    EXPECT_NEAR(rig.m.axis("elbow").set_velocity, -15, 0.1);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    EXPECT_EQ(rig.m.alarms(), "");
}

// In the machine's directions the tool's point is on its line, at 250 mm/s as far as its axes allow (at 75 deg/s and 350 mm they do not: the jog
// is as fast as they are).
TEST(GroupHand, TheToolGoesAStraightLineInTheMachine) {
    HandRig rig;
    rig.bend();
    const auto begin = rig.seen().tool.set;
    ASSERT_TRUE(rig.jog({"mcs", "x-"}).accepted());
    ASSERT_TRUE(rig.hold({"mcs", "x-"}, 400ms).accepted());
    EXPECT_GT(rig.seen().tool.speed, 50);
    EXPECT_LE(rig.seen().tool.speed, 250);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    const auto end = rig.seen().tool.set;
    EXPECT_LT(end[0], begin[0] - 20);
    EXPECT_NEAR(end[1], begin[1], 1e-6);
    EXPECT_NEAR(end[2], begin[2], 1e-6);
    EXPECT_NEAR(std::remainder(end[5] - begin[5], 360), 0, 1e-6) << "turned as it was";
}

// The tool's own directions: it stands turned by shoulder + elbow + wrist = 60 deg, so its X is (cos 60, sin 60) of the machine. And a turn about Z, 20 deg.
TEST(GroupHand, TheToolGoesInItsOwnDirectionsAndTurns) {
    HandRig rig;
    rig.bend();
    const auto begin = rig.seen().tool.set;
    ASSERT_TRUE(rig.jog({"tcs", "x-", 1, 30}).accepted());
    ASSERT_TRUE(rig.hold({"tcs", "x-", 1, 30}, 2s).accepted());
    const auto end = rig.seen().tool.set;
    EXPECT_NEAR(end[0] - begin[0], -30 * 0.5, 1e-6);
    EXPECT_NEAR(end[1] - begin[1], -30 * std::sqrt(3) / 2, 1e-6);
    ASSERT_TRUE(rig.let_go().accepted());
    rig.run(100ms);
    ASSERT_TRUE(rig.jog({"mcs", "rz+", 1, 20}).accepted());
    ASSERT_TRUE(rig.hold({"mcs", "rz+", 1, 20}, 2s).accepted());
    EXPECT_NEAR(rig.seen().tool.set[5] - end[5], 20, 1e-6);
    EXPECT_NEAR(rig.seen().tool.set[0], end[0], 1e-6);
    EXPECT_NEAR(rig.seen().tool.set[1], end[1], 1e-6);
}

// An increment ends exactly there, with the key still down; what ended it is told. The next press goes the next one.
TEST(GroupHand, AnIncrementEndsExactly) {
    HandRig rig;
    rig.bend();
    const auto begin = rig.seen().tool.set;
    for (int i = 1; i <= 2; ++i) {
        ASSERT_TRUE(rig.jog({"mcs", "y-", 1, 10}).accepted());
        ASSERT_TRUE(rig.hold({"mcs", "y-", 1, 10}, 1s).accepted()) << "as far as was asked for: the key may stay down";
        EXPECT_TRUE(rig.stands());
        EXPECT_NEAR(rig.seen().tool.set[1], begin[1] - 10 * i, 1e-9);
        EXPECT_NEAR(rig.seen().tool.set[0], begin[0], 1e-6);
        EXPECT_EQ(rig.seen().jog_end, axes::JogEnd::distance);
        ASSERT_TRUE(rig.let_go().accepted());
        rig.run(100ms);
    }
}

// What stops it is said: the stretched arm, which no line in the machine leads out of, but its axes do; a limit of a member, with whose.
TEST(GroupHand, WhatEndsAJogIsSaid) {
    HandRig rig;
    const auto singular = rig.jog({"mcs", "x-"});
    if (singular.accepted()) rig.run(50ms);
    const auto answer = singular.accepted() ? rig.jog({"mcs", "x-", 1, 0, false}) : singular;
    EXPECT_EQ(answer.answer, Answer::refused_by_axis);
    EXPECT_EQ(answer.axis_error, axes::ErrorId::singular_path);
    EXPECT_NE(answer.error.remedy.find("--frame acs"), std::string::npos) << answer.error.remedy;

    ASSERT_TRUE(rig.jog({"acs", "lift+"}).accepted());
    const auto over = rig.hold({"acs", "lift+"}, 6s);
    EXPECT_EQ(over.axis_error, axes::ErrorId::beyond_software_limit) << over.error.what << rig.m.alarms() << rig.at("lift");
    EXPECT_EQ(rig.at("lift"), 100);
    EXPECT_EQ(rig.seen().jog_end, axes::JogEnd::member_limit);
    EXPECT_EQ(rig.seen().jog_hindrance.place, 2) << "the lift is the third member";
    rig.bend();
    ASSERT_TRUE(rig.jog({"mcs", "x+"}).accepted());
    const auto reach = rig.hold({"mcs", "x+"}, 6s);
    EXPECT_EQ(reach.answer, Answer::refused_by_axis);
    EXPECT_EQ(rig.seen().jog_end, axes::JogEnd::singularity) << "towards the stretched arm";
    EXPECT_EQ(rig.m.alarms(), "");
}

// Nobody renews it: the lease runs out in the cycle, the group stops, and an alarm says so. A late heartbeat starts nothing; a press does.
TEST(GroupHand, WithoutARenewalItStops) {
    HandRig rig;
    rig.watches_hand = true;
    ASSERT_TRUE(rig.jog({"acs", "elbow+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 300ms).accepted());
    const auto lease = rig.m.config().axes[0].axis.patience.jog_lease;
    rig.run(lease + longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_NE(rig.m.alarms().find("no renewal"), std::string::npos) << rig.m.alarms();
    const auto late = rig.jog({"acs", "elbow+", 1, 0, false});
    EXPECT_EQ(late.answer, Answer::stale) << late.error.what;
    rig.run(200ms);
    EXPECT_TRUE(rig.stands());
    ASSERT_TRUE(rig.jog({"acs", "elbow-"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow-"}, 200ms).accepted());
    EXPECT_LT(rig.m.axis("elbow").set_velocity, -30);
    ASSERT_TRUE(rig.let_go().accepted());
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
}

// The connection goes: a level stops it at once, long before the lease.
TEST(GroupHand, WhoIsGoneStopsIt) {
    HandRig rig;
    ASSERT_TRUE(rig.jog({"acs", "elbow+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 300ms).accepted());
    const double before = rig.m.axis("elbow").set_velocity;
    rig.gateway.close(rig.a);
    // The planner's lead of 8 ms and the piece under way, before it brakes.
    rig.run(60ms);
    EXPECT_LT(rig.m.axis("elbow").set_velocity, before);
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_EQ(rig.m.alarms(), "") << "it was let go, its lease did not run out";
}

// Who jogs the group jogs its axes: no second client moves one of them, nor the group, nor keeps the jog alive behind the holder's back; and its stop is
// everybody's, and no heartbeat goes on behind it.
TEST(GroupHand, ASecondClientCannotDefeatTheDeadMan) {
    HandRig rig;
    rig.watches_hand = true;
    ASSERT_TRUE(rig.jog({"acs", "elbow+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 200ms).accepted());
    for (const auto& refused : {rig.order(rig.b, CommandKind::move, "elbow", 100, 50), rig.order(rig.b, CommandKind::home, "lift"),
                                rig.jog({"acs", "elbow+"}, rig.b), rig.jog({"acs", "elbow+", 1, 0, false}, rig.b)}) {
        EXPECT_EQ(refused.answer, Answer::no_control);
        EXPECT_NE(refused.error.what.find("panel A is jogging"), std::string::npos) << refused.error.what;
    }
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 100ms).accepted());
    EXPECT_GT(rig.m.axis("elbow").set_velocity, 70) << "and it goes on undisturbed";
    (void)rig.let_go(rig.b);
    ASSERT_TRUE(rig.hold({"acs", "elbow+"}, 100ms).accepted());
    EXPECT_GT(rig.m.axis("elbow").set_velocity, 70) << "another client's release is none";

    ASSERT_TRUE(rig.order(rig.b, CommandKind::stop, "").accepted());
    const auto after = rig.jog({"acs", "elbow+", 1, 0, false});
    EXPECT_EQ(after.axis_error, axes::ErrorId::aborted_by_command) << after.error.what;
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_EQ(rig.seen().state, GroupState::GroupStandby);
}

// A press that was given before a stop, and comes to its turn behind it, starts nothing.
TEST(GroupHand, APressFromBeforeAStopIsStale) {
    HandRig rig;
    auto request = HandRig::jog_of({"acs", "elbow+"});
    const auto before = rig.m.machine().levels_raised();
    ASSERT_TRUE(rig.order(rig.b, CommandKind::group_halt, "arm").accepted());
    request.client = rig.a;
    request.sequence = ++rig.sequence;
    request.arrival.after = before;
    rig.gateway.handle(request, rig.m.now());
    EXPECT_EQ(rig.reply(rig.a, request.sequence).answer, Answer::stale);
    rig.run(100ms);
    EXPECT_TRUE(rig.stands());
}

// Requests that say nothing, or nonsense, are refused with what is wrong; and nothing moves.
TEST(GroupHand, WhatIsNoJogIsRefused) {
    HandRig rig;
    const auto refused = [&](const HandRig::Given& given, const std::string& what) {
        const auto answer = rig.jog(given);
        EXPECT_EQ(answer.answer, Answer::bad_value) << what;
        EXPECT_NE(answer.error.what.find(what), std::string::npos) << answer.error.what;
        EXPECT_EQ(answer.error.subject, "group arm");
        EXPECT_NE(answer.error.remedy, "");
    };
    refused({"mcs", ""}, "no direction");
    refused({"mcs", "x+ x-"}, "both senses");
    refused({"mcs", "elbow+"}, "\"elbow+\"");
    refused({"acs", "elbw+"}, "\"elbw+\"");
    refused({"mcs", "x"}, "\"x\"");
    refused({"sky", "x+"}, "no frame \"sky\"");
    refused({"mcs", "x+", 1.5}, "1.5");
    refused({"mcs", "x+", -0.5}, "-0.5");
    refused({"mcs", "x+", 1, -3}, "-3 is no distance");
    refused({"mcs", "x+ rz+", 1, 10}, "ways or of turns");
    EXPECT_EQ(rig.jog({"mcs", "rx+"}).answer, Answer::accepted)
        << "a SCARA turns its tool, though not about X: the walk ends where it begins";
    rig.run(500ms);
    EXPECT_TRUE(rig.stands());
}

// A program has the group: its owner is named, and what to do.
TEST(GroupHand, AProgramsGroupIsRefusedWithItsOwner) {
    HandRig rig;
    ASSERT_TRUE(rig.mode(Mode::automatic).accepted());
    rig.run(1s);
    const auto answer = rig.jog({"acs", "elbow+"});
    EXPECT_EQ(answer.answer, Answer::no_control);
    EXPECT_NE(answer.error.what.find("a program has control"), std::string::npos) << answer.error.what;
    EXPECT_NE(answer.error.remedy.find("manual mode"), std::string::npos) << answer.error.remedy;
    rig.run(100ms);
    EXPECT_TRUE(rig.stands());
}

// The machine without power on its axes, and a group that is not enabled, are said in a person's words.
TEST(GroupHand, WhatIsMissingIsSaid) {
    HandRig rig;
    ASSERT_TRUE(rig.order(rig.a, CommandKind::group_disable, "arm").accepted());
    const auto disabled = rig.jog({"acs", "elbow+"});
    EXPECT_EQ(disabled.axis_error, axes::ErrorId::group_disabled);
    EXPECT_NE(disabled.error.remedy.find("taktwerk group enable arm"), std::string::npos) << disabled.error.remedy;
    ASSERT_TRUE(rig.order(rig.a, CommandKind::group_enable, "arm").accepted());
    ASSERT_TRUE(rig.order(rig.a, CommandKind::disable, "wrist").accepted());
    ASSERT_TRUE(rig.until([&] { return !rig.m.axis("wrist").powered; }, 2s));
    const auto unpowered = rig.jog({"acs", "elbow+"});
    EXPECT_EQ(unpowered.axis_error, axes::ErrorId::not_powered) << unpowered.error.what;
}

// Set-up mode, axes that could do much more: shoulder and elbow together at 200 deg/s would move the tool at 350 mm x 3.49 rad/s + ... > 1000 mm/s. It
// goes 250, the view says what holds it, and in manual mode nothing of the kind holds an axis' jog.
TEST(GroupHand, InSetUpModeTheToolGoesNoFasterThanReducedSpeed) {
    HandRig rig({.manual = 200, .setup = 200});
    ASSERT_TRUE(rig.mode(Mode::setup).accepted());
    rig.run(longest_ramp + 10ms);
    rig.fastest_tool = 0;
    ASSERT_TRUE(rig.jog({"acs", "shoulder+ elbow+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+ elbow+"}, 700ms).accepted());
    EXPECT_EQ(rig.seen().along.limiter, axes::PathLimiter::setup_velocity);
    EXPECT_EQ(rig.seen().along.tool_limit, 250);
    EXPECT_GT(rig.fastest_tool, 0.98 * 250);
    EXPECT_LE(rig.fastest_tool, 250);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    ASSERT_TRUE(rig.mode(Mode::manual).accepted());
    rig.run(20ms);
    rig.fastest_tool = 0;
    ASSERT_TRUE(rig.jog({"acs", "shoulder-"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder-"}, 400ms).accepted());
    EXPECT_EQ(rig.seen().along.tool_limit, 0);
    EXPECT_GT(rig.fastest_tool, 500);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    EXPECT_EQ(rig.m.alarms(), "");
}

TEST(GroupHand, ALowerSetUpVelocityHolds) {
    HandRig rig({.manual = 200, .setup = 200, .tool = 60});
    ASSERT_TRUE(rig.mode(Mode::setup).accepted());
    rig.run(longest_ramp + 10ms);
    rig.bend();
    rig.fastest_tool = 0;
    ASSERT_TRUE(rig.jog({"acs", "shoulder+ elbow-"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+ elbow-"}, 1s).accepted());
    EXPECT_GT(rig.fastest_tool, 0.98 * 60);
    EXPECT_LE(rig.fastest_tool, 60);
    ASSERT_TRUE(rig.let_go().accepted());
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    rig.fastest_tool = 0;
    ASSERT_TRUE(rig.jog({"mcs", "y+"}).accepted());
    ASSERT_TRUE(rig.hold({"mcs", "y+"}, 500ms).accepted());
    EXPECT_GT(rig.fastest_tool, 0.98 * 60);
    EXPECT_LE(rig.fastest_tool, 60);
}

// The mode changes while the group is jogged: it comes to rest on its path, is not in an error for it, and goes on only by a press, as slowly as the new
// mode says. Also into automatic mode.
TEST(GroupHand, AChangeOfModeStopsFirst) {
    HandRig rig({.manual = 200, .setup = 20});
    ASSERT_TRUE(rig.jog({"acs", "shoulder+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+"}, 300ms).accepted());
    EXPECT_GT(rig.m.axis("shoulder").set_velocity, 150);
    ASSERT_TRUE(rig.mode(Mode::setup).accepted());
    const auto again = rig.jog({"acs", "shoulder+"});
    EXPECT_EQ(again.axis_error, axes::ErrorId::state_forbids) << again.error.what;
    ASSERT_TRUE(rig.until([&] { return rig.stands(); }, longest_ramp));
    rig.run(2ms);
    EXPECT_EQ(rig.seen().state, GroupState::GroupStandby);
    const auto stale = rig.jog({"acs", "shoulder+", 1, 0, false});
    EXPECT_FALSE(stale.accepted());
    ASSERT_TRUE(rig.jog({"acs", "shoulder+"}).accepted());
    ASSERT_TRUE(rig.hold({"acs", "shoulder+"}, 400ms).accepted());
    EXPECT_NEAR(rig.m.axis("shoulder").set_velocity, 20, 0.1);
    ASSERT_TRUE(rig.mode(Mode::automatic).accepted());
    rig.run(longest_ramp);
    EXPECT_TRUE(rig.stands());
    EXPECT_NE(rig.seen().state, GroupState::GroupErrorStop);
    EXPECT_EQ(rig.m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::group_hand

// An axis whose drive comes and goes with its group (hot connect): what it refuses while it is away, what being taken away means, how it comes up.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr AlarmId pulled = 0x6019;

struct ToolRig : Rig {
    explicit ToolRig(const AxisConfig& config = plain_axis()) : Rig(config) {}

    void absent() {
        drive.offline = true;
        (void)axis.connect(Presence::absent, pulled);
    }
    void present() {
        drive.offline = false;
        (void)axis.connect(Presence::present, pulled);
    }
    /// What MC_Power is told in the next cycle.
    ErrorId wish() {
        now += cycle;
        axis.update(now);
        axis.supervise(now);
        const auto error = axis.power(true, true, true, Owner::program);
        axis.plan(now, cycle);
        axis.encode(now);
        return error;
    }
};

TEST(AxisPresence, WithoutAGroupItIsAlwaysThere) {
    Rig rig;
    rig.run(3);

    EXPECT_EQ(rig.view().presence, Presence::always);
}

// No alarm, no state but Disabled: a tool that lies in its rack is no trouble.
TEST(AxisPresence, AnAbsentAxisRefusesPowerAndMotionWithoutAnAlarm) {
    ToolRig rig;
    rig.absent();
    rig.run(50);

    EXPECT_EQ(rig.view().presence, Presence::absent);
    EXPECT_EQ(rig.wish(), ErrorId::not_connected);
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::not_connected);
    EXPECT_EQ(rig.refuse(stop()), ErrorId::not_connected);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::home}), ErrorId::not_connected);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::move_superimposed, .position = 1, .velocity = 1}), ErrorId::not_connected);
    for (int i = 0; i < 20'000; ++i) (void)rig.wish();  // longer than any patience of the axis
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    rig.fetch_alarms();
    EXPECT_TRUE(rig.alarms.empty());
}

// Its process data already runs while it comes up: nothing is given to it before the group as a whole is there.
TEST(AxisPresence, AJoiningAxisIsNotPowered) {
    ToolRig rig;
    rig.absent();
    rig.run(10);
    rig.drive.offline = false;
    (void)rig.axis.connect(Presence::joining, pulled);

    for (int i = 0; i < 200; ++i) EXPECT_EQ(rig.wish(), ErrorId::not_connected);

    EXPECT_NE(rig.drive.power, PowerState::enabled);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
}

// A level, as after another party had the axis: MC_Power that holds Enable powers the axis once its group is there.
TEST(AxisPresence, PowerComesWithThePresenceWithoutAReset) {
    ToolRig rig;
    rig.absent();
    rig.enable = true;
    rig.run(100);
    rig.present();

    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));

    EXPECT_TRUE(rig.alarms.empty());
    rig.accept(relative(1));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    rig.expect_no_jump();
}

// Laid down as it should be: power off first. Any number of times, and never an alarm.
TEST(AxisPresence, ADisabledAxisLeavesAndJoinsWithoutAWord) {
    ToolRig rig;
    rig.present();
    for (int round = 0; round < 5; ++round) {
        rig.enable = true;
        ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200)) << round;
        rig.enable = false;
        ASSERT_TRUE(rig.run_until([&] { return rig.drive.power != PowerState::enabled; }, 200)) << round;
        rig.run(5);
        rig.drive.offline = true;
        EXPECT_FALSE(rig.axis.connect(Presence::absent, pulled)) << round;
        rig.run(100);
        EXPECT_EQ(rig.view().state, AxisState::Disabled) << round;
        rig.present();
        rig.run(5);
    }
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
}

// Whichever is seen first, the missing feedback or the presence: it stops, and the caller is told once.
TEST(AxisPresence, PulledUnderPowerItStopsInErrorStop) {
    for (const bool feedback_first : {true, false}) {
        ToolRig rig;
        rig.present();
        rig.power_on();
        rig.accept(at_velocity(50));
        rig.run(300);

        rig.drive.offline = true;
        if (feedback_first) rig.run(20);
        EXPECT_TRUE(rig.axis.connect(Presence::absent, pulled)) << feedback_first;
        EXPECT_FALSE(rig.axis.connect(Presence::absent, pulled));
        rig.run(500);

        EXPECT_EQ(rig.view().state, AxisState::ErrorStop) << feedback_first;
        EXPECT_EQ(rig.view().set_velocity, 0);
        EXPECT_FALSE(rig.view().powered);
        EXPECT_EQ(rig.raised(AxisAlarm::axis_feedback_lost), feedback_first);
        rig.expect_no_jump();
    }
}

// Nobody has to bring the tool back before the machine goes on.
TEST(AxisPresence, PulledItIsResetWhileItIsAwayAndComesUpLater) {
    ToolRig rig;
    rig.present();
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(300);
    rig.enable = false;
    rig.absent();
    rig.run(500);
    ASSERT_EQ(rig.view().state, AxisState::ErrorStop);

    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 50));

    EXPECT_TRUE(rig.axis.active_alarms().empty());
    rig.drive.power = PowerState::disabled;  // it was without supply
    rig.present();
    rig.power_on();
    rig.expect_no_jump();
}

// An incremental encoder comes back with another zero; an absolute one has not lost its place (the rule of every drive that was away).
TEST(AxisPresence, LosesItsReferenceWhereTheEncoderForgets) {
    for (const bool absolute_encoder : {false, true}) {
        auto config = plain_axis();
        config.homing.kind = HomingKind::set_here;
        config.memory.absolute = absolute_encoder;
        ToolRig rig(config);
        rig.present();
        rig.power_on();
        rig.accept({.kind = CommandKind::home});
        ASSERT_TRUE(rig.run_until([&] { return rig.view().homed; }, 200));
        rig.enable = false;
        rig.run(100);

        rig.absent();
        rig.run(100);
        rig.present();
        rig.run(100);

        EXPECT_EQ(rig.view().homed, absolute_encoder);
    }
}

}  // namespace
}  // namespace taktwerk::axes::test

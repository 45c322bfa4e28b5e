// A stop never turns the axis round, whoever stops it and however hard it brakes already; it makes it no faster; and what ends every motion (limit
// switches, permitted directions, software limits) ends a gentle stop too.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand with_jerk(CommandKind kind, double jerk) { return {.kind = kind, .jerk = jerk}; }

struct Watched : Rig {
    using Rig::Rig;
    /// Until it stands; at most `cycles`.
    void watch(int cycles = 3000) {
        for (int i = 0; i < cycles; ++i) {
            step();
            lowest = std::min(lowest, view().set_velocity);
            highest = std::max(highest, view().set_velocity);
            least = std::min(least, view().set_position);
            furthest = std::max(furthest, view().set_position);
        }
    }
    double lowest = 1e9, highest = -1e9;  ///< u/s, of the set velocity
    double least = 1e9, furthest = -1e9;  ///< u, of the set position
};

/// An axis that brakes with 1000 u/s2 from 100 u/s, at 28 u/s: its own ramp would end with 25 u/s while it gives the deceleration back.
void brake_to_28(Watched& rig, double target = 100) {
    rig.power_on();
    rig.accept(absolute(target, 100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration < -900 && rig.view().set_velocity < 29; }));
    ASSERT_GT(rig.view().set_velocity, 25);
}

AxisConfig twice_as_fast() {
    auto config = plain_axis();
    config.limits.velocity = 200;
    return config;
}

/// A motion and an addition, each with 1000 u/s2.
void speed_up_with_both(Watched& rig) {
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.accept(on_top(100, 100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration > 1999; }));
}

// Two layers brake at once: together with nearly 2000 u/s2, which one jerk takes away over 80 u/s.
TEST(StopSense, OfTwoLayersThatBrake) {
    const std::vector<std::function<void(Rig&)>> stops{
        [](Rig& rig) { rig.axis.demand_emergency_stop(EmergencyStop::stop); },
        [](Rig& rig) { rig.axis.demand_emergency_stop(EmergencyStop::stop_and_power_off); },
        [](Rig& rig) { rig.axis.stop_for_error(AlarmId{4711}, false); },
        [](Rig& rig) { rig.accept(stop()); },
        [](Rig& rig) { rig.accept(halt()); },
        [](Rig& rig) { rig.accept(at_velocity(0)); },
        [](Rig& rig) { rig.enable = false; },
        [](Rig& rig) { rig.axis.set_mode(OperatingMode::manual); },
        [](Rig& rig) { rig.axis.take_control(Owner::operator_panel); },
        [](Rig& rig) { rig.permit_positive = false; },
    };
    for (std::size_t i = 0; i < stops.size(); ++i) {
        SCOPED_TRACE(i);
        Watched rig;
        rig.power_on();
        rig.accept(absolute(30, 60));
        rig.run(10);
        rig.accept(on_top(20, 40));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration < -1700 && rig.view().set_velocity < 42; }));
        const double before = rig.view().set_velocity;
        ASSERT_GT(before, 30);
        stops[i](rig);
        rig.watch(1000);
        EXPECT_EQ(rig.lowest, 0);
        EXPECT_LE(rig.highest, before);
        EXPECT_EQ(rig.view().set_velocity, 0);
    }
}

// Less jerk than the motion that it ends.
TEST(StopSense, OfLessJerkWhileTheAxisBrakes) {
    for (const auto kind : {CommandKind::stop, CommandKind::halt})
        for (const double jerk : {10'000.0, 5'000.0, 1'000.0, 1.0}) {
            SCOPED_TRACE(jerk);
            Watched rig;
            brake_to_28(rig);
            const double v = rig.view().set_velocity, a = rig.view().set_acceleration, from = rig.view().set_position;
            rig.accept(with_jerk(kind, jerk));
            rig.watch();
            EXPECT_EQ(rig.lowest, 0);
            EXPECT_EQ(rig.view().set_velocity, 0);
            // With the jerk a^2 / (2 v) both end together, after v / (2/3 a) of way.
            EXPECT_NEAR(rig.view().set_position - from, 2 * v * v / (3 * -a), 1e-6);
        }
}

// Less jerk for errors than for motion: harmless while the axis brakes, and while it speeds up.
TEST(StopSense, OfAConfiguredStopJerkBelowTheJerk) {
    auto config = plain_axis();
    config.limits.stop_jerk = 4000;
    EXPECT_TRUE(check(config).empty());
    Watched braking(config);
    brake_to_28(braking);
    braking.axis.demand_emergency_stop(EmergencyStop::stop);
    braking.watch();
    EXPECT_EQ(braking.lowest, 0);

    Watched rising(config);
    rising.power_on();
    rising.accept(at_velocity(100));
    ASSERT_TRUE(rising.run_until([&] { return rising.view().set_acceleration > 999; }));
    const double v = rising.view().set_velocity;
    rising.axis.demand_emergency_stop(EmergencyStop::stop);
    rising.watch();
    EXPECT_LE(rising.highest, v + 25 + 1e-9) << "what the motion itself needs to give its acceleration back: 1000^2 / (2 * 20000)";
    EXPECT_EQ(rising.lowest, 0);
}

// Two layers that speed up, folded by the stop: with the jerk of one their acceleration would carry the axis twice as far up.
TEST(StopSense, OfTwoLayersThatSpeedUp) {
    Watched rig(twice_as_fast());
    speed_up_with_both(rig);
    const double v = rig.view().set_velocity;
    auto soft = stop();
    soft.jerk = 3000;
    rig.accept(soft);
    rig.watch();
    EXPECT_LE(rig.highest, v + 50 + 1e-6) << "25 u/s of each";
    EXPECT_EQ(rig.lowest, 0);
}

// Two stops before the next set-point: what the addition had counts once. The rig's oracle would see the jerk of three.
TEST(StopSense, OfTwoLayersTwiceInACycle) {
    Watched rig(twice_as_fast());
    speed_up_with_both(rig);
    const double v = rig.view().set_velocity;
    rig.axis.set_mode(OperatingMode::manual);
    rig.axis.stop_for_error(AlarmId{4711}, false);
    rig.watch();
    EXPECT_NEAR(rig.highest, v + 50, 0.1);
    EXPECT_EQ(rig.lowest, 0);
}

// A motion that is about to turn round is stopped at the turning point, not behind it; one that has just begun to speed up the other way stops there.
TEST(StopSense, OfAMotionThatTurnsRound) {
    for (const double at : {5.0, 0.6, 0.2, -0.3, -20.0}) {
        SCOPED_TRACE(at);
        Watched rig;
        rig.power_on();
        rig.accept(at_velocity(80));
        rig.run(300);
        rig.accept(at_velocity(-80));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity <= at; }));
        const double v = rig.view().set_velocity, a = rig.view().set_acceleration;
        ASSERT_LT(a, -900);
        rig.axis.demand_emergency_stop(EmergencyStop::stop);
        rig.watch(400);
        EXPECT_GE(rig.lowest, v > 0 ? 0 : v - a * a / (2 * 20000) - 1e-9);
        EXPECT_LE(rig.highest, std::max(v, 0.0));
        EXPECT_EQ(rig.view().set_velocity, 0);
    }
}

// The addition alone: what it rides on goes on.
TEST(StopSense, OfAnAdditionAlone) {
    for (const double jerk : {20'000.0, 5'000.0, 500.0}) {
        SCOPED_TRACE(jerk);
        Watched braking;
        braking.power_on();
        braking.accept(at_velocity(20));
        braking.run(300);
        braking.accept(on_top(20, 60));
        ASSERT_TRUE(braking.run_until([&] { return braking.view().set_acceleration < -900 && braking.view().set_velocity < 46; }));
        braking.accept(with_jerk(CommandKind::halt_superimposed, jerk));
        braking.watch(1500);
        EXPECT_GE(braking.lowest, 20 - 1e-9);
        EXPECT_NEAR(braking.view().set_velocity, 20, 1e-9);

        Watched rising;
        rising.power_on();
        rising.accept(at_velocity(20));
        rising.run(300);
        rising.accept(on_top(40, 60));
        ASSERT_TRUE(rising.run_until([&] { return rising.view().set_acceleration > 790; }));
        const double v = rising.view().set_velocity, a = rising.view().set_acceleration;
        rising.accept(with_jerk(CommandKind::halt_superimposed, jerk));
        rising.watch(1500);
        EXPECT_LE(rising.highest, v + a * a / (2 * 20'000) + 1e-9);
        EXPECT_GE(rising.lowest, 20 - 1e-9);
    }
}

// A jog that nobody renews ends while it turns round, beside an addition that goes on: the base takes its acceleration away as fast as that needs,
// the addition knows nothing of it.
TEST(StopSense, OfABaseThatTurnsRoundBesideAnAddition) {
    auto config = plain_axis();
    config.patience.jog_lease = 10ms;
    int turning = 0;
    for (int renewals = 20; renewals < 60; ++renewals) {
        SCOPED_TRACE(renewals);
        Watched rig(config);
        rig.power_on();
        const auto id = rig.accept(jog(-30));
        double velocity = -30;
        int left = 200;
        rig.program = [&] {
            if (left-- > 0) (void)rig.axis.renew_jog(id, velocity, Owner::program);
        };
        rig.run(150);
        rig.accept(on_top(20, 40));
        velocity = 30;
        left = renewals;
        ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::error; }, 500));
        EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::jog_lease_expired));
        if (rig.view().set_velocity < 39) ++turning;  // the addition is not at its velocity yet
        rig.watch(1500);
        EXPECT_EQ(rig.view().state, AxisState::Standstill);
        EXPECT_GE(rig.lowest, 0);
        EXPECT_LE(rig.highest, 40 + 1e-9);
    }
    EXPECT_GT(turning, 5);
}

// --- what ends every motion -------------------------------------------------------------------------------------------------------

AxisConfig homed_between(double low, double high) {
    auto config = plain_axis();
    config.limits.position_min = low;
    config.limits.position_max = high;
    config.homing.kind = HomingKind::set_here;
    return config;
}

// A soft stop near a software limit does not swing back through it.
TEST(GuardedStop, StaysInsideTheLimitBehindIt) {
    Watched rig(homed_between(0, 200));
    rig.power_on();
    rig.accept(home(0));
    rig.run(10);
    brake_to_28(rig, 20);
    rig.accept(with_jerk(CommandKind::stop, 100));
    rig.watch(5000);
    EXPECT_GE(rig.least, 0);
    EXPECT_TRUE(rig.alarms.empty());
}

// A limit that is moved into the way of a soft stop, as far as the axis can still stop before: it does, and says so.
TEST(GuardedStop, MeetsALimitThatWasMovedIntoItsWay) {
    Watched rig(homed_between(-50, 300));
    rig.power_on();
    rig.accept(home(0));
    rig.run(10);
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 50; }));
    rig.accept({.kind = CommandKind::stop, .deceleration = 40});  // 125 u and more
    rig.run(5);
    ASSERT_EQ(rig.axis.set(WriteParameter{software_limit_positive, 100}, Owner::program), ErrorId::none);
    rig.watch();
    EXPECT_LE(rig.furthest, 100 * (1 + 1e-12));
    EXPECT_TRUE(rig.raised(AxisAlarm::software_limit_reached));
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
}

// A gentle stop that runs into a limit switch is the axis' hard stop, with the alarm.
TEST(GuardedStop, StopsHardAtALimitSwitch) {
    for (const auto kind : {CommandKind::stop, CommandKind::halt}) {
        Watched rig(plain_axis(), [](FakeDrive& drive) {
            drive.switches = true;
            drive.positive_end = 50'000;
        });
        rig.power_on();
        rig.accept(at_velocity(100));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 40; }));
        rig.accept({.kind = kind, .deceleration = 20});
        rig.run(20);
        EXPECT_TRUE(rig.alarms.empty());
        rig.watch(1000);
        EXPECT_TRUE(rig.raised(AxisAlarm::positive_limit_switch));
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        EXPECT_LT(rig.furthest, 58) << "50, the time until it is seen, and 100^2 / 2000 with the ramps of 20000 u/s3";
        EXPECT_EQ(rig.view().set_velocity, 0);
    }
}

// In a direction that is not permitted any more a gentle stop is as hard as the axis' own; whose stop it is does not change.
TEST(GuardedStop, StopsHardInABarredDirection) {
    for (const auto kind : {CommandKind::stop, CommandKind::halt}) {
        Watched rig;
        rig.power_on();
        rig.accept(at_velocity(100));
        rig.run(300);
        const auto id = rig.accept({.kind = kind, .deceleration = 5});
        rig.run(20);
        const double from = rig.view().set_position;
        rig.permit_positive = false;
        rig.watch(400);
        EXPECT_EQ(rig.view().set_velocity, 0);
        EXPECT_LT(rig.furthest - from, 8);
        EXPECT_EQ(rig.status(id), CommandStatus::done);
        EXPECT_TRUE(rig.alarms.empty());
    }
}

/// A drive that leaves its torque at standstill only: a stop brakes in torque first.
struct OutOfTorque : Watched {
    explicit OutOfTorque(const std::function<void(FakeDrive&)>& prepare = {})
        : Watched(config(), [&](FakeDrive& made) {
              made.caps.mode_change_at_standstill = true;
              made.caps.velocity_limit = true;
              if (prepare) prepare(made);
          }) {
        power_on();
        accept(home(0));
        run(20);
        accept({.kind = CommandKind::torque, .velocity = 60, .details = TorqueDetails{0.3, 0}});
    }
    static AxisConfig config() {
        auto config = homed_between(-50, 50);
        config.control.rated_acceleration = 2000;
        return config;
    }
    double furthest_motor = 0;
    void watch_motor(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            step();
            furthest_motor = std::max(furthest_motor, view().actual_position);
        }
    }
};

// 1000 u/s2 go on until the axis has its own mode again, and count.
TEST(GuardedStop, OutOfTorqueThatStillSpeedsTheAxisUp) {
    for (const double limit : {2.0, 5.0, 8.0}) {
        auto config = homed_between(-50, limit);
        config.control.rated_acceleration = 2000;
        Watched rig(config);
        rig.power_on();
        rig.accept(home(0));
        rig.run(20);
        rig.accept({.kind = CommandKind::torque, .velocity = 100, .details = TorqueDetails{0.5, 0}});
        double furthest = 0;
        for (int i = 0; i < 500; ++i) {
            rig.step();
            furthest = std::max(furthest, rig.view().actual_position);
        }
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        EXPECT_LE(furthest, limit);
        EXPECT_GT(furthest, limit - 1);
    }
}

TEST(GuardedStop, OutOfTorqueEndsBeforeTheSoftwareLimit) {
    for (const auto kind : {CommandKind::stop, CommandKind::halt}) {
        OutOfTorque rig;
        ASSERT_TRUE(rig.run_until([&] { return rig.view().actual_position > 20; }, 2000));
        rig.accept({.kind = kind, .deceleration = 30});  // 60 u
        rig.watch_motor(3000);
        EXPECT_LT(rig.furthest_motor, 50);
        EXPECT_GT(rig.furthest_motor, 45) << "gentle as long as there is room";
        EXPECT_TRUE(rig.raised(AxisAlarm::software_limit_reached));
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    }
}

TEST(GuardedStop, OutOfTorqueStopsHardAtALimitSwitch) {
    OutOfTorque rig([](FakeDrive& made) {
        made.switches = true;
        made.positive_end = 30'000;
    });
    ASSERT_TRUE(rig.run_until([&] { return rig.view().actual_position > 20; }, 2000));
    rig.accept({.kind = CommandKind::stop, .deceleration = 30});
    rig.watch_motor(3000);
    EXPECT_TRUE(rig.raised(AxisAlarm::positive_limit_switch));
    EXPECT_LT(rig.furthest_motor, 33);
}

TEST(GuardedStop, OutOfTorqueStopsHardInABarredDirection) {
    OutOfTorque rig;
    ASSERT_TRUE(rig.run_until([&] { return rig.view().actual_position > 20; }, 2000));
    rig.accept({.kind = CommandKind::stop, .deceleration = 30});
    rig.run(20);
    rig.permit_positive = false;
    rig.watch_motor(3000);
    EXPECT_LT(rig.furthest_motor, 25);
    EXPECT_TRUE(rig.alarms.empty());
}

}  // namespace
}  // namespace taktwerk::axes::test

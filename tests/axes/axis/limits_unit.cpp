// Software limits, limit switches, permitted directions: none is ever crossed by our doing, and the way out stays open.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig fenced() {
    auto config = plain_axis();
    config.limits.position_min = -50;
    config.limits.position_max = 150;
    config.homing.kind = HomingKind::set_here;
    return config;
}

struct FencedRig : Rig {
    explicit FencedRig(const AxisConfig& config = fenced()) : Rig(config) {
        power_on();
        accept(home(0));
        run(3);
        EXPECT_TRUE(view().homed);
    }
};

TEST(SoftwareLimits, TargetsBeyondAreRefusedAndTheAxisIsUntouched) {
    FencedRig rig;
    EXPECT_EQ(rig.refuse(absolute(150.001)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.refuse(absolute(-50.001)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.refuse(relative(151)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);

    rig.accept(absolute(150));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 150);
    EXPECT_EQ(rig.refuse(jog(1)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.refuse(at_velocity(1)), ErrorId::beyond_software_limit);
    rig.accept(at_velocity(-5));
}

// A waiting relative move is checked where it begins.
TEST(SoftwareLimits, WaitingRelativeMoveIsCheckedAtItsStart) {
    FencedRig rig;
    rig.accept(absolute(100));
    const auto waiting = rig.accept(relative(60, 100, mcBuffered));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(waiting), CommandStatus::error);
    EXPECT_EQ(rig.error_of(waiting), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.view().set_position, 100);
}

// A velocity command runs until it must brake, ends exactly on the limit, and is an axis error.
TEST(SoftwareLimits, VelocityCommandEndsOnTheLimitWithAnAlarm) {
    for (const double velocity : {100.0, 37.0, -80.0, 3.0}) {
        FencedRig rig;
        const auto id = rig.accept(at_velocity(velocity));
        const double edge = velocity > 0 ? 150 : -50;
        double farthest = 0;
        ASSERT_TRUE(rig.run_until(
            [&] {
                farthest = std::max(farthest, rig.view().set_position * (velocity > 0 ? 1 : -1));
                return rig.view().state == AxisState::ErrorStop && rig.view().set_velocity == 0;
            },
            60000))
            << velocity;
        EXPECT_DOUBLE_EQ(rig.view().set_position, edge);
        EXPECT_LE(farthest, std::abs(edge) * (1 + 1e-15));
        EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::software_limit_reached));
        EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-9));
        rig.expect_no_jump();
    }
}

// Started so near the limit that it never reaches its speed.
TEST(SoftwareLimits, AccelerationNearTheLimitIsCutShort) {
    FencedRig rig;
    rig.accept(absolute(149));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(at_velocity(100));
    double farthest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        farthest = std::max(farthest, rig.view().set_position);
        return rig.view().state == AxisState::ErrorStop && rig.view().set_velocity == 0;
    }));
    EXPECT_LE(farthest, 150 * (1 + 1e-15));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 150);
}

// A jog stops on the limit and is done, without an error; the other direction works.
TEST(SoftwareLimits, JogStopsOnTheLimitAndStands) {
    FencedRig rig;
    auto id = rig.accept(jog(90));
    rig.program = [&] { (void)rig.axis.renew_jog(id, 90, Owner::program); };
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 150);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_TRUE(rig.alarms.empty());

    id = rig.accept(jog(-90));
    rig.program = [&] { (void)rig.axis.renew_jog(id, -90, Owner::program); };
    rig.run(200);
    EXPECT_LT(rig.view().set_position, 149);
}

// An aborting move with gentle dynamics, given at full speed close to the limit, must not overshoot through it.
TEST(SoftwareLimits, GentleAbortNearTheLimitBrakesHardEnough) {
    FencedRig rig;
    rig.accept(absolute(150));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 138; }));
    auto gentle = absolute(0, 10);
    gentle.deceleration = 50;
    gentle.acceleration = 50;
    gentle.jerk = 500;
    rig.accept(gentle);
    double farthest = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
            farthest = std::max(farthest, rig.view().set_position);
            return rig.view().state == AxisState::Standstill;
        },
        60000));
    EXPECT_LE(farthest, 150);
    EXPECT_NEAR(rig.view().set_position, 0, 1e-12);
}

// Before homing the coordinates mean nothing, so neither do the limits.
// The limits come over it with its coordinates. It stops where it is: nobody asked for the way back, which may be as long as the number.
TEST(SoftwareLimits, MovedWithTheCoordinatesOfAMovingAxisTheyStopItAndItDoesNotRunBack) {
    for (const double jerk : {20'000.0, infinity}) {
        for (const double velocity : {50.0, -50.0}) {
            for (const double shift : {1000.0, 160.0}) {
                for (const bool by_jog : {false, true}) {
                    auto config = fenced();
                    config.limits.jerk = jerk;
                    config.patience.jog_lease = 10s;
                    FencedRig rig(config);
                    const double sense = velocity > 0 ? 1 : -1;
                    const auto id = rig.accept(by_jog ? jog(velocity) : at_velocity(velocity));
                    rig.run(100);
                    ASSERT_EQ(rig.axis.set(SetPosition{sense * shift, true}, Owner::program), ErrorId::none);
                    const double from = rig.view().set_position;
                    ASSERT_TRUE(rig.run_until(
                        [&] {
                            EXPECT_GE(sense * rig.view().set_velocity, 0);
                            return rig.view().set_velocity == 0;
                        },
                        200));
                    rig.run(50);
                    EXPECT_EQ(rig.view().set_velocity, 0);
                    // v^2 / 2a = 1.25 u and with a jerk v * a / 2j = 1.25 u more; and the cycle that saw it.
                    EXPECT_LE(sense * (rig.view().set_position - from), (jerk == infinity ? 1.25 : 2.5) + 0.051);
                    EXPECT_EQ(rig.status(id), by_jog ? CommandStatus::done : CommandStatus::error);
                    EXPECT_EQ(rig.raised(AxisAlarm::software_limit_reached), !by_jog);
                    EXPECT_EQ(rig.view().state, by_jog ? AxisState::Standstill : AxisState::ErrorStop);
                }
            }
        }
    }
}

TEST(SoftwareLimits, DoNotHoldBeforeHoming) {
    Rig rig(fenced());
    rig.power_on();
    const auto id = rig.accept(absolute(200));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 200) << "through 150, unhindered";
    EXPECT_TRUE(rig.alarms.empty());

    rig.accept(home(0));  // the same axis, once it knows where it is
    rig.run(3);
    ASSERT_TRUE(rig.view().homed);
    EXPECT_EQ(rig.refuse(absolute(200)), ErrorId::beyond_software_limit);
}

// A limit switch in the direction of motion stops hard, with an alarm; the way out is free after the reset, the way in is not.
TEST(LimitSwitch, StopsMotionFurtherInAndLetsItOut) {
    Rig rig(plain_axis(), [](FakeDrive& drive) {
        drive.switches = true;
        drive.positive_end = 50'000;
    });
    rig.power_on();
    rig.accept(absolute(70, 50));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop));
    EXPECT_TRUE(rig.raised(AxisAlarm::positive_limit_switch));
    EXPECT_FALSE(rig.raised(AxisAlarm::negative_limit_switch));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0; }, 300));
    EXPECT_LT(rig.view().set_position, 56);

    rig.run(10);
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_EQ(rig.refuse(absolute(80)), ErrorId::interlocked);
    EXPECT_EQ(rig.refuse(jog(5)), ErrorId::interlocked);
    EXPECT_EQ(rig.refuse(at_velocity(5)), ErrorId::interlocked);
    const auto out = rig.accept(absolute(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(out), CommandStatus::done);
    rig.expect_no_jump();
}

// The drive's positive end is the negative end of an inverted axis.
TEST(LimitSwitch, InvertedAxisExchangesTheSwitches) {
    auto config = plain_axis();
    config.gearing.inverted = true;
    Rig rig(config, [](FakeDrive& drive) {
        drive.switches = true;
        drive.positive_end = 50'000;
    });
    rig.power_on();
    rig.accept(absolute(-70, 50));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop));
    EXPECT_TRUE(rig.raised(AxisAlarm::negative_limit_switch));
    EXPECT_TRUE(rig.view().negative_limit_switch);
}

// P1-119, U-07: EnablePositive/EnableNegative are levels. Taken away in motion: the axis stops, the command ends with an error, no axis error.
TEST(PermittedDirection, IsRefusedAtTheStartAndStopsInMotion) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(at_velocity(30));
    rig.run(200);
    rig.step();
    bool positive = false;
    const auto cycle = [&] {
        rig.now += Rig::cycle;
        rig.axis.update(rig.now);
        rig.axis.supervise(rig.now);
        rig.axis.power(true, positive, true, Owner::program);
        rig.axis.plan(rig.now, Rig::cycle);
        rig.axis.encode(rig.now);
    };
    cycle();
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);  // Stopping is MC_Stop's (figure 2)
    EXPECT_EQ(rig.error_of(id), ErrorId::interlocked);
    for (int i = 0; i < 300; ++i) cycle();
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.refuse(relative(1)), ErrorId::interlocked);
    const auto back = rig.accept(relative(-1));
    for (int i = 0; i < 300; ++i) cycle();
    EXPECT_EQ(rig.status(back), CommandStatus::done);
}

// No axis is at both its ends: inputs of the wrong polarity, or no cable. That is said, beside the refusal, until one of them goes.
TEST(AxisLimits, BothLimitSwitchesAtOnceAreSaid) {
    Rig rig;
    rig.drive.switches = true;
    rig.power_on();
    EXPECT_FALSE(rig.raised(AxisAlarm::both_limit_switches));
    rig.drive.positive_end = -1;
    rig.run(5);
    EXPECT_FALSE(rig.raised(AxisAlarm::both_limit_switches));
    rig.drive.negative_end = 1;
    rig.run(5);
    EXPECT_TRUE(rig.raised(AxisAlarm::both_limit_switches));
    EXPECT_EQ(rig.refuse(relative(1)), ErrorId::interlocked);
    EXPECT_EQ(rig.refuse(relative(-1)), ErrorId::interlocked);
    rig.drive.negative_end = -1000;
    rig.run(5);
    EXPECT_TRUE(rig.axis.active_alarms().empty());
}

}  // namespace
}  // namespace taktwerk::axes::test

// The mode an axis runs in: the position loop in the drive or here, feed-forward, and set_controller_mode.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig velocity_axis(double feed_forward, double kv = 20) {
    auto config = plain_axis();
    config.control.mode = ControlMode::velocity;
    config.control.kv = kv;
    config.control.feed_forward = feed_forward;
    return config;
}
AxisCommand controller_mode(DriveMode mode, MC_BufferMode buffer = mcAborting) {
    return {.kind = CommandKind::set_controller_mode, .buffer_mode = buffer, .position = static_cast<double>(mode)};
}

// With feed-forward 1 there is no lag at constant velocity, without it v / Kv: 40 / 20 = 2 u.
TEST(VelocityMode, TheLagIsThatOfTheGainAndTheFeedForward) {
    for (const double feed_forward : {1.0, 0.5, 0.0}) {
        Rig rig(velocity_axis(feed_forward));
        rig.power_on();
        EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_velocity);
        rig.accept(at_velocity(40));
        rig.run(1000);
        EXPECT_NEAR(rig.view().actual_velocity, 40, 0.1);
        EXPECT_NEAR(rig.view().following_error, (1 - feed_forward) * 2, 0.005) << feed_forward;
        EXPECT_TRUE(rig.alarms.empty());
    }
}

TEST(VelocityMode, AMoveEndsAtItsTargetAndIsHeldThere) {
    Rig rig(velocity_axis(1));
    rig.power_on();
    rig.accept(absolute(12.345));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.run(300);
    EXPECT_NEAR(rig.view().actual_position, 12.345, 0.001);
    EXPECT_TRUE(rig.view().in_position);
    rig.drive.position += 500;  // somebody pushes the motor by half a u
    rig.run(500);
    EXPECT_NEAR(rig.view().actual_position, 12.345, 0.002);
}

// The limit of the output: 20 / s times 10 u would be 200 u/s.
TEST(VelocityMode, TheOutputIsLimited) {
    auto config = velocity_axis(1);
    config.control.output_limit = 7;
    Rig rig(config);
    rig.power_on();
    rig.drive.position += 10000;
    rig.run(3);
    double fastest = 0;
    for (int i = 0; i < 100; ++i) {
        rig.step();
        fastest = std::max(fastest, std::abs(rig.drive.last.velocity));
    }
    EXPECT_NEAR(fastest, 7000, 1e-6);
}

// A silent drive must not creep on with the last lag.
TEST(VelocityMode, WithoutFeedbackNothingButTheSetVelocityIsGiven) {
    Rig rig(velocity_axis(0));
    rig.power_on();
    rig.accept(at_velocity(40));
    rig.run(500);
    rig.drive.silent = true;
    rig.run(500);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.drive.last.velocity, 0);
}

TEST(VelocityMode, NeedsItsGain) {
    auto config = velocity_axis(1, 0);
    ASSERT_EQ(check(config).size(), 1u);
    EXPECT_EQ(check(config)[0].subject, "axes.x.control.kv");
    config = plain_axis();
    config.control.torque_feed_forward = 1;
    ASSERT_EQ(check(config).size(), 1u) << "no inertia known";
}

// 60B1h and 60B2h: the set velocity and the torque that its acceleration needs, in counts/s and rated torques.
TEST(FeedForward, VelocityAndTorqueGoToTheDrive) {
    auto config = plain_axis();
    config.gearing.inverted = true;
    config.control = {.feed_forward = 0.5, .torque_feed_forward = 0.8, .rated_acceleration = 2000};
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(70);
    ASSERT_EQ(rig.view().set_acceleration, 1000);
    EXPECT_NEAR(rig.drive.last.velocity, -0.5 * rig.view().set_velocity * 1000, 1e-6);
    EXPECT_NEAR(rig.drive.last.torque, -0.8 * 1000 / 2000, 1e-12);
    rig.run(200);
    EXPECT_EQ(rig.drive.last.torque, 0);
}

TEST(ControllerMode, ChangesAtStandstillAndTheAxisStaysInIt) {
    auto config = plain_axis();
    config.control.kv = 20;
    Rig rig(config);
    rig.power_on();
    rig.accept(absolute(5));
    const auto id = rig.accept(controller_mode(DriveMode::cyclic_velocity, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_velocity);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.accept(absolute(8));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.run(200);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_velocity);
    EXPECT_NEAR(rig.view().actual_position, 8, 0.002);
    const auto back = rig.accept(controller_mode(DriveMode::cyclic_position));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(back) == CommandStatus::done; }, 100));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
}

TEST(ControllerMode, TorqueIsZeroUntilACommandAndAMotionTakesItsOwnModeAgain) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    Rig rig(config);
    rig.drive.friction = 0.1;
    rig.power_on();
    const auto id = rig.accept(controller_mode(DriveMode::cyclic_torque));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }, 100));
    rig.run(50);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_torque);
    EXPECT_EQ(rig.drive.last.torque, 0);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_EQ(rig.drive.last.position, 5000);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(ControllerMode, IsRefusedInMotionAndWhereTheModeIsMissing) {
    auto config = plain_axis();
    config.control.kv = 20;
    Rig rig(config);
    rig.power_on();
    EXPECT_EQ(rig.refuse(controller_mode(DriveMode::homing)), ErrorId::not_supported);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::set_controller_mode, .position = 0.5}), ErrorId::invalid_parameter);
    rig.accept(absolute(50));
    rig.run(100);
    EXPECT_EQ(rig.refuse(controller_mode(DriveMode::cyclic_velocity)), ErrorId::not_at_standstill);
    Rig open;  // without kv nobody would hold the position
    open.power_on();
    EXPECT_EQ(open.refuse(controller_mode(DriveMode::cyclic_velocity)), ErrorId::not_supported);
}

TEST(ControllerMode, ADriveThatDoesNotTakeItIsAnErrorAfterATime) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    Rig rig(config, [](FakeDrive& drive) { drive.refuses_torque_mode = true; });
    rig.power_on();
    const auto id = rig.accept(controller_mode(DriveMode::cyclic_torque));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::error; }, 1000));
    EXPECT_EQ(rig.error_of(id), ErrorId::drive_mode_refused);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_TRUE(rig.alarms.empty());
}

// The motor is 30 counts behind what it is told. Told its own place instead, it would be pulled back by as much.
TEST(ControllerMode, AChangeTakenBackBeforeTheDriveShowedItMovesNothing) {
    auto config = plain_axis();
    config.control.kv = 20;
    config.patience.feedback = 10;
    for (const auto mode : {DriveMode::cyclic_position, DriveMode::cyclic_velocity}) {
        Rig rig(config);
        rig.drive.lag = 30;
        rig.power_on();
        rig.accept(absolute(5));
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        rig.run(20);
        ASSERT_DOUBLE_EQ(rig.view().actual_position, 4.97);
        rig.drive.silent = true;
        rig.accept(controller_mode(mode));
        rig.step();
        rig.accept(halt());
        for (int i = 0; i < 3; ++i) {
            rig.step();
            EXPECT_EQ(rig.drive.last.position, 5000) << name(mode);
            EXPECT_EQ(rig.view().set_position, 5) << name(mode);
        }
        rig.drive.silent = false;
        ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
        rig.run(20);
        EXPECT_EQ(rig.view().set_position, 5) << name(mode);
    }
}

// Torque was asked for in motion and given up in the next cycle, while the feedback is missing: 50 u/s go on, 0.05 u in each cycle.
TEST(ControllerMode, ATorqueGivenUpBeforeTheDriveShowedItLetsTheMotionGoOn) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    config.patience.feedback = 10;
    Rig rig(config);
    rig.drive.lag = 30;
    rig.power_on();
    rig.accept(at_velocity(50));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().active_in_target; }));
    rig.run(5);
    const double from = rig.view().set_position;
    rig.drive.silent = true;
    rig.accept({.kind = CommandKind::torque, .velocity = 60, .details = TorqueDetails{0.1, 0}});
    rig.step();
    rig.accept(at_velocity(50));
    for (int i = 2; i < 5; ++i) {
        rig.step();
        EXPECT_NEAR(rig.view().set_position, from + i * 0.05, 1e-9);
        EXPECT_EQ(rig.drive.last.position, std::llround(rig.view().set_position * 1000));
    }
    rig.drive.silent = false;
    rig.run(20);
    EXPECT_NEAR(rig.view().set_position, from + 24 * 0.05, 1e-9);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_TRUE(rig.alarms.empty());
}

}  // namespace
}  // namespace taktwerk::axes::test

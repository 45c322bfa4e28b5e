// Torque feed-forward of what the load takes beside its inertia: gravity and friction.

#include "axes/axis/load_feed_forward.hpp"

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// Against the motion in either sense: of 0.1 at the friction velocity 1 / sqrt(2), at ten times it all but half a percent; viscous on top.
TEST(LoadFeedForward, FrictionIsFedAgainstTheMotion) {
    LoadFeedForward load({.coulomb_friction = 0.1, .viscous_friction = 0.002, .friction_velocity = 2}, 100);
    for (const double sense : {1.0, -1.0}) {
        EXPECT_NEAR(load.step(sense * 2, true, 0.001), sense * (0.1 / std::sqrt(2.0) + 0.004), 1e-12);
        EXPECT_NEAR(load.step(sense * 20, true, 0.001), sense * 0.14, 0.0006);
    }
    EXPECT_EQ(load.step(0, true, 0.001), 0) << "an axis that stands is not pushed";
}

// Through zero it rises all the way, and nowhere by more than its steepest part: 0.1 / 2 for each u/s.
TEST(LoadFeedForward, GoesSmoothlyThroughStandstill) {
    LoadFeedForward load({.coulomb_friction = 0.1, .friction_velocity = 2}, 100);
    double before = load.step(-10, true, 0.001);
    for (double velocity = -9.99; velocity < 10; velocity += 0.01) {
        const double now = load.step(velocity, true, 0.001);
        EXPECT_GT(now, before);
        EXPECT_LE(now - before, 0.01 * 0.1 / 2 * (1 + 1e-9));
        before = now;
    }
}

TEST(LoadFeedForward, GravityComesInOverATenthOfASecondAndGoesWithThePower) {
    LoadFeedForward load({.gravity = -0.3}, 100);
    for (int i = 0; i < 50; ++i) (void)load.step(0, true, 0.001);
    EXPECT_NEAR(load.step(0, true, 0.001), -0.3 * 0.51, 1e-12);
    for (int i = 0; i < 100; ++i) (void)load.step(0, true, 0.001);
    EXPECT_EQ(load.step(0, true, 0.001), -0.3);
    EXPECT_EQ(load.step(0, false, 0.001), 0);
    EXPECT_NEAR(load.step(0, true, 0.001), -0.003, 1e-12);
}

AxisConfig loaded_axis() {
    auto config = plain_axis();
    config.control.load = {.gravity = 0.2, .coulomb_friction = 0.05, .viscous_friction = 0.001};
    config.control.torque_feed_forward = 1;
    config.control.rated_acceleration = 5000;
    return config;
}

// 60B2h at 60 u/s without acceleration: 0.2 + 0.06 + 0.05 * 60 / sqrt(60^2 + 1); a hundredth of the velocity limit is the friction velocity. While it
// speeds up with 1000 u/s2, 0.2 more. A drive that turns the other way gets all of it with the other sign.
TEST(LoadTorque, GoesToTheDriveBesideTheTorqueOfTheAcceleration) {
    for (const double sense : {1.0, -1.0}) {
        auto config = loaded_axis();
        config.gearing.inverted = sense < 0;
        Rig rig(config);
        rig.power_on();
        rig.run(200);
        EXPECT_NEAR(rig.drive.last.torque, sense * 0.2, 1e-12);
        rig.accept(at_velocity(60));
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration == 1000; }, 200));
        const double v = rig.view().set_velocity;
        EXPECT_NEAR(rig.drive.last.torque, sense * (0.4 + 0.001 * v + 0.05 * v / std::hypot(v, 1)), 1e-12);
        rig.run(300);
        EXPECT_NEAR(rig.drive.last.torque, sense * (0.26 + 0.05 * 60 / std::hypot(60, 1)), 1e-12);
    }
}

// It ends with the power, and comes in again with it.
TEST(LoadTorque, IsThereWhileTheDriveFollows) {
    Rig rig(loaded_axis());
    rig.run(50);
    EXPECT_EQ(rig.drive.last.torque, 0) << "without power";
    rig.power_on();
    EXPECT_LT(rig.drive.last.torque, 0.1);
    rig.run(200);
    EXPECT_EQ(rig.drive.last.torque, 0.2);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    rig.run(50);
    EXPECT_EQ(rig.drive.last.torque, 0);
}

// In torque the command is the torque: nothing is added to it. Back in its own mode the weight comes in over a tenth of a second.
TEST(LoadTorque, AddsNothingToACommandedTorque) {
    Rig rig(loaded_axis());
    rig.drive.friction = 0.5;
    rig.power_on();
    rig.run(200);
    AxisCommand torque{.kind = CommandKind::torque};
    torque.details = TorqueDetails{0.1, 0};
    const auto id = rig.accept(torque);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }, 200));
    EXPECT_EQ(rig.drive.last.torque, 0.1);
    rig.accept(halt());
    ASSERT_TRUE(rig.run_until([&] { return rig.view().drive_mode == DriveMode::cyclic_position; }, 200));
    double before = 0;
    for (int i = 0; i < 150; ++i) {
        rig.step();
        ASSERT_LE(std::abs(rig.drive.last.torque - before), 0.01) << i;
        before = rig.drive.last.torque;
    }
    EXPECT_EQ(before, 0.2);
}

TEST(LoadTorque, HasItsBounds) {
    auto config = plain_axis();
    config.control.load = {.gravity = -3.1, .coulomb_friction = -0.1, .viscous_friction = 0.031, .friction_velocity = 101};
    std::string subjects;
    for (const auto& problem : check(config)) subjects += problem.subject.substr(sizeof("axes.x.control.load.") - 1) + " ";
    EXPECT_EQ(subjects, "gravity coulomb_friction viscous_friction friction_velocity ");
}

}  // namespace
}  // namespace taktwerk::axes::test

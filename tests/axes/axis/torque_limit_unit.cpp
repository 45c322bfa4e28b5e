// MC_SetTorqueLimit on an axis: who has limits, what the drive is told, when it is done, and what else bounds a torque.

#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand torque_limit(double positive, double negative) {
    AxisCommand command{.kind = CommandKind::set_torque_limit};
    command.details = TorqueLimitDetails{positive, negative};
    return command;
}
/// 60E0h and 60E1h in each frame.
void maps_both(FakeDrive& drive) { drive.caps.torque_limits = drive.caps.torque_limit_per_direction = true; }
/// The same by SDO, five cycles late.
void writes_both(FakeDrive& drive) {
    drive.caps.torque_limits_written = drive.caps.torque_limit_per_direction = true;
    drive.limit_delay = 5;
}
AxisConfig pressing_axis() {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    return config;
}

TEST(TorqueLimit, GoesToTheDriveInItsOwnSenseAndIsDone) {
    for (const bool inverted : {false, true}) {
        auto config = plain_axis();
        config.gearing.inverted = inverted;
        Rig rig(config, maps_both);
        rig.run(5);
        EXPECT_TRUE(std::isinf(rig.drive.last.torque_limit_positive)) << "nobody asked for one";
        const auto id = rig.accept(torque_limit(0.5, 0.3));
        EXPECT_EQ(rig.status(id), CommandStatus::active);
        rig.run(2);
        EXPECT_EQ(rig.status(id), CommandStatus::done);
        EXPECT_EQ(rig.drive.last.torque_limit_positive, inverted ? 0.3 : 0.5);
        EXPECT_EQ(rig.drive.last.torque_limit_negative, inverted ? 0.5 : 0.3);
        EXPECT_EQ(rig.view().torque_limit_positive, 0.5);
        EXPECT_EQ(find_parameter(1045)->read(rig.view()), 0.5);
        EXPECT_EQ(find_parameter(1046)->read(rig.view()), 0.3);
    }
}

// It is no motion: any state will do, no command ends it, and power does not either.
TEST(TorqueLimit, HoldsInEveryStateUntilAnotherIsSet) {
    Rig rig(plain_axis(), maps_both);
    rig.run(5);
    rig.accept(torque_limit(0.5, 0.3));
    rig.power_on();
    const auto move = rig.accept(at_velocity(50));
    rig.run(100);
    rig.accept(torque_limit(0.4, 0.4));
    EXPECT_EQ(rig.status(move), CommandStatus::in_target) << "nor does it end a motion";
    rig.accept(stop());
    rig.run(300);
    rig.drive.fault_code = 0x7500;
    rig.run(10);
    ASSERT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.4);
    rig.accept(torque_limit(0.2, 0.2));
    rig.enable = false;
    rig.run(300);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.2);
    rig.accept(torque_limit(0, 0));
    rig.run(2);
    EXPECT_TRUE(std::isinf(rig.drive.last.torque_limit_positive)) << "as configured: there is nothing";
}

// What is configured holds from the first cycle on; a block stays below it, and 0 goes back to it.
TEST(TorqueLimit, NeverPassesWhatIsConfigured) {
    auto config = plain_axis();
    config.limits.torque = 1.5;
    config.limits.negative.torque = 0.6;
    Rig rig(config, maps_both);
    rig.run(2);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 1.5);
    EXPECT_EQ(rig.drive.last.torque_limit_negative, 0.6);
    rig.accept(torque_limit(2, 0.4));
    rig.run(2);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 1.5);
    EXPECT_EQ(rig.drive.last.torque_limit_negative, 0.4);
    rig.accept(torque_limit(0.2, 0));
    rig.run(2);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.2);
    EXPECT_EQ(rig.drive.last.torque_limit_negative, 0.6);
}

TEST(TorqueLimit, IsRefusedWhereItMeansNothing) {
    Rig none;
    EXPECT_EQ(none.refuse(torque_limit(0.5, 0.5)), ErrorId::no_torque_limit);
    Rig rig(plain_axis(), maps_both);
    for (const double wrong : {-0.1, 0.0005, infinity, std::nan("")}) {
        EXPECT_EQ(rig.refuse(torque_limit(wrong, 0.5)), ErrorId::invalid_torque_limit) << wrong;
        EXPECT_EQ(rig.refuse(torque_limit(0.5, wrong)), ErrorId::invalid_torque_limit) << wrong;
    }
    EXPECT_EQ(rig.refuse(torque_limit(0.5, 0.5), Owner::operator_panel), ErrorId::owned_by_other);
    Rig one(plain_axis(), [](FakeDrive& drive) { drive.caps.torque_limits = true; });  // 6072h
    EXPECT_EQ(one.refuse(torque_limit(0.5, 0.3)), ErrorId::invalid_torque_limit);
    one.accept(torque_limit(0.5, 0.5));
}

// By SDO it takes as long as the drive does; another one meanwhile takes its place.
TEST(TorqueLimit, IsDoneWhenTheDriveHasTakenIt) {
    Rig rig(plain_axis(), writes_both);
    rig.run(10);
    const auto first = rig.accept(torque_limit(0.5, 0.5));
    rig.run(4);
    EXPECT_EQ(rig.status(first), CommandStatus::active);
    const auto second = rig.accept(torque_limit(0.4, 0.5));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    rig.run(5);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    rig.run(3);
    EXPECT_EQ(rig.status(second), CommandStatus::done);
}

// Refused, the limits before hold on, also in the view; the drive is told them again, not the refused ones for ever.
TEST(TorqueLimit, ARefusedOneLeavesWhatWasBefore) {
    Rig rig(plain_axis(), writes_both);
    rig.run(10);
    const auto good = rig.accept(torque_limit(0.5, 0.5));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(good) == CommandStatus::done; }, 20));
    rig.drive.refuses_torque_limits = true;
    const auto bad = rig.accept(torque_limit(0.4, 0.4));
    rig.accept(torque_limit(0.3, 0.3));
    const auto worse = rig.view().last_id;
    ASSERT_TRUE(rig.run_until([&] { return rig.status(worse) == CommandStatus::error; }, 20));
    EXPECT_EQ(rig.status(bad), CommandStatus::aborted);
    EXPECT_EQ(rig.error_of(worse), ErrorId::torque_limit_refused);
    EXPECT_EQ(rig.view().torque_limit_positive, 0.5);
    rig.run(2);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.5);
}

// Nothing was ever limited, and nothing is to be: the drive has that, too.
TEST(TorqueLimit, NoneIsDoneAsWell) {
    Rig rig(plain_axis(), maps_both);
    rig.run(5);
    const auto id = rig.accept(torque_limit(0, 0));
    rig.run(2);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_TRUE(std::isinf(rig.drive.last.torque_limit_positive));
}

// Without feedback nobody knows whether the drive has it.
TEST(TorqueLimit, IsNotDoneWhileTheDriveIsAway) {
    Rig rig(plain_axis(), maps_both);
    rig.run(5);
    rig.drive.offline = true;
    rig.run(2);
    const auto id = rig.accept(torque_limit(0.5, 0.5));
    rig.run(50);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.drive.offline = false;
    rig.run(2);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
}

// MC_TorqueControl stays inside: what is told is 0.3 of the 0.8 commanded, and InTorque says so; with more room it goes on by itself.
TEST(TorqueLimit, BoundsACommandedTorque) {
    Rig rig(pressing_axis(), maps_both);
    rig.drive.friction = 1;  // holds the motor
    rig.power_on();
    rig.accept(torque_limit(0.3, 0.2));
    AxisCommand press{.kind = CommandKind::torque};
    press.details = TorqueDetails{0.8, 4};
    const auto id = rig.accept(press);
    double most = 0;
    for (int i = 0; i < 500; ++i) {
        rig.step();
        most = std::max(most, rig.drive.last.torque);
    }
    EXPECT_EQ(most, 0.3);
    EXPECT_EQ(rig.status(id), CommandStatus::active) << "not the commanded torque: InTorque is FALSE";
    rig.accept(torque_limit(0, 0));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }, 500));
    EXPECT_EQ(rig.drive.last.torque, 0.8);
    std::get<TorqueDetails>(press.details).torque = -0.5;
    press.direction = mcShortestWay;
    rig.accept(torque_limit(0.3, 0.2));
    rig.accept(press);
    rig.run(500);
    EXPECT_EQ(rig.drive.last.torque, -0.2);
    EXPECT_TRUE(rig.alarms.empty());
}

// The search for a fixed stop has a limit of its own: the lower one of both holds while it presses, and afterwards the set one again.
TEST(TorqueLimit, TheLowerOneHoldsWhileHomingPressesAgainstABlock) {
    auto config = homing_by(HomingKind::block);
    config.homing.torque = 0.3;
    config.homing.negative = false;
    Rig rig(config, [](FakeDrive& drive) {
        maps_both(drive);
        drive.positive_stop = 20'000;
        drive.stiffness = 0.0005;
    });
    rig.accept(torque_limit(0.8, 0.1));
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().actual_torque > 0.2; }));
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.3);
    EXPECT_EQ(rig.drive.last.torque_limit_negative, 0.1);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    rig.run(2);
    EXPECT_EQ(rig.drive.last.torque_limit_positive, 0.8);
}

TEST(TorqueLimit, HasItsBoundsInTheConfiguration) {
    const auto subject = [](const AxisLimits& limits) {
        auto config = plain_axis();
        config.limits = limits;
        const auto problems = check(config);
        return problems.size() == 1 ? problems[0].subject : std::to_string(problems.size());
    };
    auto limits = plain_axis().limits;
    EXPECT_EQ(subject(limits), "0");
    limits.torque = 0.0005;
    EXPECT_EQ(subject(limits), "axes.x.limits.torque");
    limits.torque = 1.5;
    limits.positive.torque = 1.6;
    EXPECT_EQ(subject(limits), "axes.x.limits.positive.torque");
}

}  // namespace
}  // namespace taktwerk::axes::test

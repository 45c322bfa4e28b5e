// The holding brake that the controller works: with MC_Power, in errors, and by MC_SetBrake.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig with_brake(bool without_power = false) {
    auto config = plain_axis();
    config.limits.jerk = infinity;
    config.brake = {.by = BrakeBy::object, .release = 100ms, .engage = 150ms, .release_without_power = without_power};
    return config;
}

struct Braked : Rig {
    explicit Braked(const AxisConfig& config = with_brake()) : Rig(config, [](FakeDrive& drive) { drive.caps.brake = true; }) {}
    ErrorId set_brake(bool release) { return axis.set(SetBrake{release}, Owner::program); }
    [[nodiscard]] bool told_open() const { return drive.last.brake == BrakeRequest::open; }
};

TEST(Brake, OpensWithThePowerAndMotionWaitsForIt) {
    Braked rig;
    rig.run(20);
    EXPECT_EQ(rig.drive.last.brake, BrakeRequest::close);
    EXPECT_EQ(rig.view().brake, BrakeState::closed);
    rig.enable = true;
    ASSERT_TRUE(rig.run_until(
        [&] {
            EXPECT_TRUE(!rig.told_open() || rig.drive.power == PowerState::enabled) << "never before the motor has torque";
            return rig.told_open();
        },
        100));
    const auto told = rig.now;
    EXPECT_EQ(rig.view().brake, BrakeState::opening);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    EXPECT_EQ(rig.now - told, 100ms);
    rig.step();
    EXPECT_EQ(rig.view().brake, BrakeState::open);
}

TEST(Brake, ClosesBeforeThePowerGoes) {
    Braked rig;
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(200);
    rig.enable = false;
    ASSERT_TRUE(rig.run_until([&] { return !rig.told_open(); }));
    EXPECT_EQ(rig.view().set_velocity, 0) << "a holding brake is none for motion";
    EXPECT_EQ(rig.drive.last.power, PowerRequest::on);
    const auto closed = rig.now;
    const auto held = rig.drive.last.position;
    ASSERT_TRUE(rig.run_until([&] {
        EXPECT_EQ(rig.drive.last.position, held);
        return rig.drive.last.power == PowerRequest::off;
    }));
    EXPECT_EQ(rig.now - closed, 150ms);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_EQ(rig.view().brake, BrakeState::closed);
    // The wish comes back while it closes: the power goes first.
    rig.power_on();
    rig.enable = false;
    rig.run(20);
    rig.enable = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::disabled; }, 300));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 300));
    rig.expect_no_jump();
}

// Nobody waits for a brake while the power goes at once, or has gone.
TEST(Brake, ClosesAtOnceWherePowerGoesAtOnce) {
    for (const bool fault : {false, true}) {
        auto config = with_brake();
        config.reactions.choose(AxisAlarm::drive_warning, ErrorReaction::power_off);
        Braked rig(config);
        rig.power_on();
        rig.accept(at_velocity(50));
        rig.run(200);
        if (fault) rig.drive.fault_code = 0x7500;
        else rig.drive.warning = true;
        ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 5));
        rig.run(2);
        EXPECT_FALSE(rig.told_open());
        EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
    }
}

TEST(Brake, StaysOpenWhileTheDriveStopsTheMotor) {
    auto config = with_brake();
    config.reactions.choose(AxisAlarm::drive_warning, ErrorReaction::quick_stop);
    Braked rig(config);
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(200);
    rig.drive.warning = true;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 5));
    for (double before = rig.drive.position - 1; rig.drive.position != before;) {
        before = rig.drive.position;
        rig.step();
        if (rig.drive.position != before) {
            ASSERT_TRUE(rig.told_open());
        }
    }
    rig.run(3);
    EXPECT_FALSE(rig.told_open());
}

// Given up while it opens: it may be open already, so the drive holds on until it has closed again.
TEST(Brake, GivenUpWhileItOpensTheDriveHoldsOnUntilItHasClosed) {
    for (const bool emergency : {false, true}) {
        Braked rig;
        rig.enable = true;
        ASSERT_TRUE(rig.run_until([&] { return rig.told_open(); }, 100));
        rig.run(90);  // of 100
        ASSERT_EQ(rig.view().state, AxisState::Disabled);
        if (emergency) rig.axis.demand_emergency_stop(EmergencyStop::stop_and_power_off);
        else rig.enable = false;
        ASSERT_TRUE(rig.run_until([&] { return !rig.told_open(); }, 5));
        EXPECT_EQ(rig.drive.last.power, PowerRequest::on);
        const auto closed = rig.now;
        ASSERT_TRUE(rig.run_until([&] { return rig.drive.last.power == PowerRequest::off; }, 500));
        EXPECT_EQ(rig.now - closed, 150ms);
        rig.run(10);
        EXPECT_NE(rig.view().state, AxisState::Standstill);
        EXPECT_EQ(rig.drive.power, PowerState::disabled);
    }
}

// A drive that nobody hears holds nothing that anybody knows of: its own watchdog has taken its power by now.
TEST(Brake, ClosesWhereTheDriveIsLost) {
    for (const bool moves : {false, true}) {
        Braked rig;
        rig.power_on();
        rig.run(5);
        if (moves) rig.accept(at_velocity(50));
        rig.run(200);
        rig.drive.offline = true;
        ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 10));
        rig.run(500);
        EXPECT_FALSE(rig.told_open());
    }
}

TEST(SetBrake, ClosesUnderPowerAndNothingMovesUntilItIsOpen) {
    Braked rig;
    rig.power_on();
    rig.run(5);
    ASSERT_EQ(rig.set_brake(false), ErrorId::none);
    rig.step();
    EXPECT_FALSE(rig.told_open());
    EXPECT_EQ(rig.drive.last.power, PowerRequest::on);
    EXPECT_EQ(rig.view().brake, BrakeState::closing);
    EXPECT_EQ(rig.refuse(absolute(5)), ErrorId::brake_closed);
    EXPECT_EQ(rig.refuse(jog(5)), ErrorId::brake_closed);
    EXPECT_EQ(rig.refuse(on_top(1, 5)), ErrorId::brake_closed);
    EXPECT_EQ(rig.refuse(home(0)), ErrorId::brake_closed);
    rig.run(150);
    EXPECT_EQ(rig.view().brake, BrakeState::closed);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    ASSERT_EQ(rig.set_brake(true), ErrorId::none);
    EXPECT_EQ(rig.refuse(absolute(5)), ErrorId::brake_closed) << "it has just been told";
    rig.run(99);
    EXPECT_EQ(rig.refuse(absolute(5)), ErrorId::brake_closed) << "it opens yet";
    rig.run(2);
    EXPECT_EQ(rig.view().brake, BrakeState::open);
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    // Power takes it back: it comes up open again.
    ASSERT_EQ(rig.set_brake(false), ErrorId::none);
    rig.enable = false;
    rig.run(300);
    rig.power_on();
    rig.run(2);
    EXPECT_EQ(rig.view().brake, BrakeState::open);
    rig.accept(absolute(0));
}

TEST(SetBrake, IsRefusedWhereItWouldDoHarm) {
    Braked rig;
    rig.run(5);
    EXPECT_EQ(rig.set_brake(true), ErrorId::not_powered) << "nothing would hold the load";
    EXPECT_EQ(rig.set_brake(false), ErrorId::none);
    rig.power_on();
    rig.accept(at_velocity(20));
    rig.run(10);
    EXPECT_EQ(rig.set_brake(false), ErrorId::state_forbids) << "a holding brake is none for motion";
    rig.accept(halt());
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.axis.set(WriteOutput{0, true}, Owner::program), ErrorId::not_supported);
    rig.drive.caps.digital_outputs = true;
    EXPECT_EQ(rig.axis.set(WriteOutput{0, true}, Owner::program), ErrorId::invalid_output) << "this bit is the brake's";
    EXPECT_EQ(rig.axis.set(WriteOutput{1, true}, Owner::program), ErrorId::none);
    rig.axis.demand_emergency_stop(EmergencyStop::stop);
    EXPECT_EQ(rig.set_brake(true), ErrorId::interlocked);
    rig.drive.caps.brake = false;
    EXPECT_EQ(rig.set_brake(false), ErrorId::not_supported);

    Rig plain;
    EXPECT_EQ(plain.axis.set(SetBrake{true}, Owner::program), ErrorId::brake_not_controlled);
    plain.power_on();
    EXPECT_EQ(plain.axis.set(SetBrake{false}, Owner::program), ErrorId::brake_not_controlled);
    EXPECT_EQ(plain.drive.last.brake, BrakeRequest::none);
    EXPECT_EQ(plain.view().brake, BrakeState::not_controlled);
}

// Where no load can sink, and the machine file says so.
TEST(SetBrake, OpensWithoutPowerWherePermittedAndAnythingUnusualClosesIt) {
    const auto opened = [](Braked& rig) {
        rig.run(5);
        ASSERT_EQ(rig.set_brake(true), ErrorId::none);
        rig.run(102);
        ASSERT_EQ(rig.view().brake, BrakeState::open);
        ASSERT_EQ(rig.drive.last.power, PowerRequest::off);
    };
    {
        Braked rig(with_brake(true));
        opened(rig);
        rig.drive.position += 5000;  // pushed by hand
        rig.run(100);
        ASSERT_EQ(rig.set_brake(false), ErrorId::none);
        rig.step();
        EXPECT_FALSE(rig.told_open());
    }
    {
        Braked rig(with_brake(true));
        opened(rig);
        rig.axis.demand_emergency_stop(EmergencyStop::stop);
        rig.step();
        EXPECT_FALSE(rig.told_open());
    }
    {
        Braked rig(with_brake(true));
        opened(rig);
        rig.axis.take_control(Owner::operator_panel);
        rig.step();
        EXPECT_FALSE(rig.told_open());
    }
    {
        Braked rig(with_brake(true));
        opened(rig);
        rig.drive.offline = true;
        rig.run(2);
        EXPECT_FALSE(rig.told_open());
    }
    {
        Braked rig(with_brake(true));
        opened(rig);
        rig.power_on();  // and it is what power makes of it from here on
        EXPECT_TRUE(rig.told_open());
        rig.enable = false;
        rig.run(300);
        EXPECT_FALSE(rig.told_open());
    }
}

TEST(Brake, TimesAreCheckedAndThoseOfADriveAreTheDrives) {
    const auto problem_of = [](const BrakeConfig& brake) {
        auto config = plain_axis();
        config.brake = brake;
        const auto problems = check(config);
        return problems.size() == 1 ? problems[0].subject : std::to_string(problems.size());
    };
    EXPECT_EQ(problem_of({.by = BrakeBy::object, .release = -1ms}), "axes.x.brake.release");
    EXPECT_EQ(problem_of({.by = BrakeBy::output, .engage = 6s}), "axes.x.brake.engage");
    EXPECT_EQ(problem_of({.by = BrakeBy::drive, .engage = 100ms}), "axes.x.brake.by");
    EXPECT_EQ(problem_of({.by = BrakeBy::output, .release = 5s, .engage = 5s, .release_without_power = true}), "0");
}

}  // namespace
}  // namespace taktwerk::axes::test

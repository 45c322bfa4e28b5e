// Every command of runtime/operator_command.hpp: what it does, and by whom and when it is refused.

#include <limits>

#include "axes/axis/alarms.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;
using axes::ErrorId;
using axes::Owner;
using enum OperatorAction;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

struct Commands : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    void start(MachineConfig config = machine_config(2)) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(machine->up());
    }
    /// Enabled and homed in place: x at 0.
    void ready() {
        auto config = machine_config(2);
        for (auto& binding : config.axes) binding.axis.homing.kind = axes::HomingKind::set_here;
        start(std::move(config));
        for (std::uint16_t i = 0; i < 2; ++i) {
            m().enable(i);
            m().home(i);
        }
    }
    TestMachine& m() { return *machine; }
    CommandAnswer as(Owner owner, OperatorAction action, std::uint16_t axis, bool flag = false, double value = 0, double value2 = 0) {
        OperatorCommand c;
        c.action = action;
        c.owner = owner;
        c.axis = axis;
        c.flag = flag;
        c.value = value;
        c.value2 = value2;
        return m().command(c);
    }
    Answer program(OperatorAction action, std::uint16_t index = 0) { return m().command(action, index).answer; }
    /// The program's start has been asked for, and has not been carried out.
    bool start_under_way() {
        start(with_program(1, &entry_of<Idle>));
        program(program_stop);
        m().run(3ms);
        OperatorCommand c;
        c.index = 0;
        c.action = program_start;
        return m().machine->submit(c);
    }
    bool stands(std::uint16_t axis = 0) {
        return m().until([&] { return m().axis(axis).state == AxisState::Standstill && m().axis(axis).set_velocity == 0; }, 3s);
    }
};

TEST_F(Commands, AnAxisThatDoesNotExistOrIsDisabledIsUnknown) {
    auto config = machine_config(2);
    config.axes[1].axis.disabled = true;
    start(std::move(config));
    for (const auto action : {take_control, release_control, power, home, jog, move_absolute, OperatorAction::stop, reset}) {
        EXPECT_EQ(m().command(action, 1, true, 1, 1).answer, Answer::unknown_name) << int(action);
        EXPECT_EQ(m().command(action, 7, true, 1, 1).answer, Answer::unknown_name) << int(action);
    }
    EXPECT_EQ(m().command(none).answer, Answer::unknown_name);
    EXPECT_EQ(m().command(static_cast<OperatorAction>(200), 0).answer, Answer::unknown_name);
    for (const auto action : {home, jog, move_absolute})
        EXPECT_EQ(m().command(action, 0xFFFF, true, 1, 1).answer, Answer::unknown_name) << "not for all";
}

TEST_F(Commands, AnExpiredCommandIsStaleAndDoesNothingButAStopIsNeverTooLate) {
    ready();
    OperatorCommand c;
    c.action = move_absolute;
    c.axis = 0;
    c.value = 100;
    c.value2 = 50;
    c.expires = m().clock.now();
    m().run(2ms);
    EXPECT_EQ(m().command(c).answer, Answer::stale);
    EXPECT_EQ(m().axis(0).state, AxisState::Standstill);

    ASSERT_EQ(m().command(move_absolute, 0, false, 100, 50).answer, Answer::accepted);
    m().run(100ms);
    c.action = OperatorAction::stop;
    EXPECT_EQ(m().command(c).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    EXPECT_LT(m().axis(0).set_position, 50);
}

TEST_F(Commands, NobodyButAPersonCommandsAxesFromOutside) {
    ready();
    for (const auto owner : {Owner::none, Owner::program}) {
        EXPECT_EQ(as(owner, move_absolute, 0, false, 100, 50).answer, Answer::no_control);
        EXPECT_EQ(as(owner, power, 0, false).answer, Answer::no_control);
        EXPECT_EQ(as(owner, take_control, 0).answer, Answer::no_control);
    }
}

TEST_F(Commands, PowerOffWhileMovingRampsDownFirst) {
    ready();
    ASSERT_EQ(m().command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 190; }, 3s));
    ASSERT_EQ(m().command(power, 0, false).answer, Answer::accepted);
    EXPECT_EQ(m().axis(0).state, AxisState::Stopping);
    EXPECT_TRUE(m().axis(0).powered);
    EXPECT_GT(m().axis(0).set_velocity, 100);

    double last_velocity = 0;
    ASSERT_TRUE(m().until(
        [&] {
            if (m().axis(0).powered) last_velocity = m().axis(0).set_velocity;
            return m().axis(0).state == AxisState::Disabled;
        },
        3s));
    EXPECT_LT(last_velocity, 1.0) << "u/s when power went";
    m().run(1s);
    EXPECT_NE(m().axis(0).drive_state, axes::PowerState::enabled) << "the wish is taken back";
    m().expect_no_jump();
}

TEST_F(Commands, PowerIsRefusedToWhoHasNoControlAndInErrorStopAndInAnEmergency) {
    ready();
    EXPECT_EQ(as(Owner::commissioning, power, 0, true).answer, Answer::no_control);
    m().world.set_input("estop_ok", false);
    m().run(1s);
    const auto refused = m().command(power, 0, true);
    EXPECT_EQ(refused.answer, Answer::refused_by_axis);
    EXPECT_EQ(refused.error, ErrorId::interlocked);
    m().world.set_input("estop_ok", true);
    m().run(10ms);
    EXPECT_EQ(m().command(power, 0, true).error, ErrorId::in_error_stop);
}

TEST_F(Commands, PowerForAllAsksEveryAxisAndAnswersTheFirstRefusal) {
    start();
    ASSERT_EQ(as(Owner::commissioning, take_control, 0).answer, Answer::accepted);
    EXPECT_EQ(m().command(power, 0xFFFF, true).answer, Answer::no_control);
    EXPECT_TRUE(m().until([&] { return m().axis(1).powered; }, 3s));
    EXPECT_FALSE(m().axis(0).powered);
}

// Nobody switches on by a reset: what fell by an emergency stop or an error stays off until a person says power again.
TEST_F(Commands, AResetDoesNotSwitchOnWhatHasFallen) {
    ready();
    m().world.set_input("estop_ok", false);
    m().run(1s);
    m().world.set_input("estop_ok", true);
    m().run(10ms);
    EXPECT_EQ(m().command(reset).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 3s));
    m().run(2s);
    EXPECT_EQ(m().axis(0).state, AxisState::Disabled);

    m().enable(0);
    m().world.drive("x")->raise(0x3130);
    m().run(100ms);
    EXPECT_EQ(m().command(reset).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 3s));
    m().run(2s);
    EXPECT_EQ(m().axis(0).state, AxisState::Disabled);
}

TEST_F(Commands, TakingControlStopsTheAxisKeepsItsPowerAndRefusesTheOtherOne) {
    ready();
    ASSERT_EQ(m().command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
    m().run(500ms);
    ASSERT_EQ(as(Owner::commissioning, take_control, 0).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    EXPECT_LT(m().axis(0).set_position, 300);

    const auto refused = m().command(move_absolute, 0, false, 10, 50);
    EXPECT_EQ(refused.answer, Answer::no_control);
    EXPECT_EQ(refused.owner, Owner::commissioning);
    EXPECT_EQ(m().command(release_control, 0).answer, Answer::no_control);
    m().run(1s);
    EXPECT_TRUE(m().axis(0).powered);
    EXPECT_EQ(as(Owner::commissioning, move_absolute, 0, false, 10, 50).answer, Answer::accepted);
    EXPECT_TRUE(stands());

    EXPECT_EQ(as(Owner::commissioning, release_control, 0).answer, Answer::accepted);
    EXPECT_EQ(m().axis(0).owner, Owner::operator_panel);
    EXPECT_EQ(m().command(power, 0, false).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 3s)) << "the power went over with the control";
    m().run(500ms);
    EXPECT_FALSE(m().axis(0).powered);
    m().expect_no_jump();
}

// Manual speeds hold outside automatic mode only.
TEST_F(Commands, InAutomaticModeNobodyTakesAnAxisFromThePrograms) {
    auto config = machine_config(1);
    config.start_mode = Mode::automatic;
    start(std::move(config));
    EXPECT_EQ(m().command(take_control, 0).answer, Answer::wrong_mode);
    EXPECT_EQ(m().command(power, 0, true).answer, Answer::no_control);
    EXPECT_EQ(m().command(jog, 0, true, 10).answer, Answer::no_control);
}

TEST_F(Commands, AMoveIsRefusedWithTheAxisReason) {
    start();
    EXPECT_EQ(m().command(move_absolute, 0, false, 100, 50).error, ErrorId::not_powered);
    m().enable(0);
    EXPECT_EQ(m().command(move_absolute, 0, false, nan_value, 50).error, ErrorId::invalid_position);
    EXPECT_EQ(m().command(move_absolute, 0, false, 100, 0).error, ErrorId::invalid_velocity);
    const auto before = m().state().statistics.commands_refused;
    EXPECT_EQ(m().command(home, 1).error, ErrorId::not_powered);
    EXPECT_EQ(m().state().statistics.commands_refused, before + 1);
}

TEST_F(Commands, AJogStartsWithAPressLivesOnHeartbeatsAndEndsWithZero) {
    ready();
    EXPECT_EQ(m().command(jog, 0, false, 50).answer, Answer::stale) << "a heartbeat starts nothing";
    EXPECT_EQ(m().command(jog, 0, true, nan_value).answer, Answer::bad_value);
    ASSERT_EQ(m().command(jog, 0, true, 50).answer, Answer::accepted);
    for (int i = 0; i < 10; ++i) {
        m().run(50ms);
        ASSERT_EQ(m().command(jog, 0, false, 50).answer, Answer::accepted);
    }
    EXPECT_EQ(m().command(jog, 0, false, 0).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    EXPECT_EQ(m().command(jog, 0, false, 50).answer, Answer::stale) << "a heartbeat that was on its way starts nothing";
    EXPECT_FALSE(m().has_alarm(id(axes::AxisAlarm::jog_lease_expired)));
    m().expect_no_jump();
}

TEST_F(Commands, AFreshPressStartsAJogAgainWhileTheExpiredOneRampsDown) {
    ready();
    ASSERT_EQ(m().command(jog, 0, true, 200).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().has_alarm(id(axes::AxisAlarm::jog_lease_expired)); }, 1s));
    ASSERT_GT(m().axis(0).set_velocity, 50);
    EXPECT_EQ(m().command(jog, 0, false, 200).answer, Answer::stale);
    EXPECT_EQ(m().command(jog, 0, true, 200).answer, Answer::accepted);
    m().run(150ms);
    EXPECT_GT(m().axis(0).set_velocity, 150);
    m().expect_no_jump();
}

// The next heartbeat after the end of a jog hears why it is over, and that is no lease.
TEST_F(Commands, AJogThatEndsAtASoftwareLimitSaysSo) {
    auto config = machine_config(1);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    config.axes[0].axis.limits.position_min = -20, config.axes[0].axis.limits.position_max = 20;
    start(std::move(config));
    m().enable(0);
    ASSERT_EQ(m().command(home, 0).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).homed; }, 1s));
    auto heard = m().command(jog, 0, true, 100);
    for (int i = 0; i < 40 && heard.answer == Answer::accepted; ++i) {
        m().run(50ms);
        heard = m().command(jog, 0, false, 100);
    }
    EXPECT_EQ(heard.answer, Answer::refused_by_axis);
    EXPECT_EQ(heard.error, ErrorId::beyond_software_limit);
    EXPECT_NEAR(m().axis(0).set_position, 20, 1e-6);
    EXPECT_FALSE(m().has_alarm(id(axes::AxisAlarm::jog_lease_expired)));
    m().expect_no_jump();
}

TEST_F(Commands, AJogIsHeldToTheManualSpeed) {
    ready();
    ASSERT_EQ(m().command(jog, 0, true, 500).answer, Answer::accepted);
    m().run(190ms);
    EXPECT_LE(m().watch[0].largest_velocity, 200 * (1 + 1e-9)) << "manual.fast";
}

TEST_F(Commands, StopIsEverybodysRightInEveryState) {
    ready();
    EXPECT_EQ(m().command(OperatorAction::stop, 1).answer, Answer::accepted) << "standing";
    ASSERT_EQ(m().command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
    m().run(300ms);
    EXPECT_EQ(as(Owner::none, OperatorAction::stop, 0).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    ASSERT_EQ(m().command(jog, 0, true, 100).answer, Answer::accepted);
    m().run(100ms);
    EXPECT_EQ(as(Owner::commissioning, OperatorAction::stop, 0xFFFF).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    m().command(power, 0, false);
    m().run(500ms);
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted) << "disabled";
    m().expect_no_jump();
}

TEST_F(Commands, StopEndsAHomingOfTheDriveAndTheAxisIsUsableAgain) {
    start();
    m().enable(0);
    ASSERT_EQ(m().command(home, 0).answer, Answer::accepted);
    m().run(300ms);
    ASSERT_EQ(m().axis(0).state, AxisState::Homing);
    ASSERT_GT(std::abs(m().axis(0).actual_velocity), 10) << "it must be on its way";

    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted) << "again, while it stops";
    EXPECT_TRUE(stands()) << axes::name(m().axis(0).state);
    m().run(200ms);
    EXPECT_NEAR(m().axis(0).actual_velocity, 0, 1);
    EXPECT_FALSE(m().axis(0).homed);
    m().home(0);
    m().expect_no_jump();
}

TEST_F(Commands, StopEndsAHomingOfTheMaster) {
    auto config = machine_config(1);
    auto& homing = config.axes[0].axis.homing;
    homing.kind = axes::HomingKind::home_switch;
    start(std::move(config));
    m().enable(0);
    ASSERT_EQ(m().command(home, 0).answer, Answer::accepted);
    m().run(300ms);
    ASSERT_EQ(m().axis(0).state, AxisState::Homing);
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    EXPECT_FALSE(m().axis(0).homed);
    m().expect_no_jump();
}

TEST_F(Commands, AnOutputIsSetByHandWhileNoProgramRuns) {
    start(with_program(1, &entry_of<Idle>));
    EXPECT_EQ(m().command(set_output, 0, false, 1).answer, Answer::wrong_mode);
    m().mode(Mode::manual);
    m().run(5ms);
    EXPECT_EQ(m().command(set_output, 0, false, 1).answer, Answer::accepted);
    m().run(3ms);
    EXPECT_TRUE(m().world.output("lamp"));
    EXPECT_EQ(m().command(set_output, 9, false, 1).answer, Answer::unknown_name);
    for (const double value : {2.0, -1.0, 0.5, 1e300, nan_value})
        EXPECT_EQ(m().command(set_output, 0, false, value).answer, Answer::bad_value) << value;
}

TEST_F(Commands, AParameterIsHeldToItsRange) {
    start(with_program(1, &entry_of<Idle>));
    EXPECT_EQ(m().command(set_parameter, 0, false, 7).answer, Answer::accepted);
    m().run(2ms);
    EXPECT_EQ(m().state().parameters[0], 7.0);
    for (const double value : {-0.1, 10.1, nan_value}) EXPECT_EQ(m().command(set_parameter, 0, false, value).answer, Answer::bad_value);
    EXPECT_EQ(m().command(set_parameter, 1, false, 1).answer, Answer::unknown_name);
    EXPECT_EQ(m().state().parameters[0], 7.0);
}

TEST_F(Commands, AModeThatDoesNotExistIsABadValue) {
    start();
    EXPECT_EQ(m().mode(static_cast<Mode>(9)).answer, Answer::bad_value);
    EXPECT_EQ(m().state().mode, Mode::manual);
}

// --- programs: start() and stop() run on the service side, so starting and stopping take a moment --------------------------------

TEST_F(Commands, AStartBeforeTheLastStopIsThroughIsRefusedNotLost) {
    start(with_program(1, &entry_of<Idle>));
    ASSERT_EQ(program(program_start), Answer::accepted) << "it runs already";
    // Both in one cycle: stop() cannot have run in between.
    OperatorCommand c;
    c.index = 0;
    c.action = program_stop;
    ASSERT_TRUE(m().machine->submit(c));
    EXPECT_EQ(program(program_start), Answer::not_possible_now);
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);
    EXPECT_EQ(program(program_start), Answer::accepted);
    m().run(3ms);
    EXPECT_EQ(m().state().programs[0], ProgramState::running);
}

TEST_F(Commands, AStopTakesBackAStartThatIsUnderWay) {
    ASSERT_TRUE(start_under_way());
    EXPECT_EQ(program(program_stop), Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);
}

TEST_F(Commands, LeavingAutomaticModeTakesBackAStartThatIsUnderWay) {
    ASSERT_TRUE(start_under_way());
    EXPECT_EQ(m().mode(Mode::manual).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped) << "no program runs in manual mode";
}

TEST_F(Commands, AProgramThatThrowsInStartIsInFaultAndSaysWhy) {
    start(with_program(1, &entry_of<ThrowsInStart>));
    m().run(5ms);
    EXPECT_EQ(m().state().programs[0], ProgramState::fault);
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::program_fault)));
    EXPECT_EQ(m().machine->program_fault(0), "start() threw: no recipe");
    EXPECT_NE(m().alarms().find("no recipe"), std::string::npos);
    EXPECT_EQ(program(program_start), Answer::not_possible_now);
    EXPECT_EQ(program(program_reset), Answer::accepted);
    EXPECT_EQ(program(program_start, 5), Answer::unknown_name);
}

TEST_F(Commands, AStoppedProgramStartsWithItsFirstScan) {
    start(with_program(1, &entry_of<Idle>));
    m().run(20ms);
    program(program_stop);
    m().run(3ms);
    program(program_start);
    m().run(20ms);
    EXPECT_EQ(variable(m(), "first_scans"), 2.0);
}

TEST_F(Commands, WhileTheRunEndsOnlyStopsAreTaken) {
    ready();
    ASSERT_EQ(m().command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
    m().run(500ms);
    EXPECT_EQ(m().command(shutdown).answer, Answer::accepted);
    EXPECT_EQ(m().command(move_absolute, 1, false, 50, 50).answer, Answer::not_possible_now);
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);
    m().expect_no_jump();
}

// Whoever stands beside the axis may acknowledge: it takes no control, powers nothing that nobody wishes, moves nothing.
TEST_F(Commands, AResetByAnotherPartyThanTheOwnerLeavesControlPowerAndPlaceAsTheyAre) {
    ready();
    ASSERT_EQ(as(Owner::commissioning, take_control, 0).answer, Answer::accepted);
    ASSERT_TRUE(stands());
    m().world.drive("x")->jam(true);
    ASSERT_EQ(as(Owner::commissioning, move_absolute, 0, false, 100, 50).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 2s));
    m().world.drive("x")->jam(false);
    m().run(1s);
    ASSERT_TRUE(m().axis(0).drive_state == axes::PowerState::enabled) << "a following error leaves the power on";
    const double place = m().axis(0).set_position;

    ASSERT_EQ(as(Owner::operator_panel, reset, 0).answer, Answer::accepted);
    EXPECT_TRUE(stands());
    EXPECT_EQ(m().axis(0).owner, Owner::commissioning);
    EXPECT_EQ(m().axis(0).set_position, place);
    EXPECT_EQ(m().command(move_absolute, 0, false, 10, 50).answer, Answer::no_control) << "the operator still has none";
    m().expect_no_jump();
}

// The operator's factor, under a program that knows nothing of it; it outlives the program, and no limit is passed by it.
TEST(OperatorsOverride, HoldsUnderAProgramUntilItIsChanged) {
    TestMachine m{with_program(2, &entry_of<RunsX>)};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s));
    ASSERT_EQ(m.command(override_velocity, 0, false, 0.5).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 25.0; }, 1s));
    EXPECT_EQ(m.axis(0).limiter, axes::VelocityLimiter::override_factor);
    EXPECT_EQ(m.axis(0).owner, Owner::program);
    EXPECT_EQ(m.axis(1).operators_override, 1) << "one axis alone";
    ASSERT_EQ(m.command(override_velocity, 0xFFFF, false, 0).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0.0; }, 1s));
    EXPECT_EQ(m.axis(0).state, AxisState::ContinuousMotion) << "it is halted, not stopped";
    EXPECT_EQ(m.axis(1).operators_override, 0);
    ASSERT_EQ(m.command(override_velocity, 0xFFFF, false, 0.2).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 10.0; }, 1s));
    ASSERT_EQ(m.command(program_stop, 0).answer, Answer::accepted);
    ASSERT_EQ(m.mode(Mode::manual).answer, Answer::accepted);
    m.run(1s);
    EXPECT_EQ(m.axis(0).operators_override, 0.2);
    for (const double bad : {-0.1, 1.1, nan_value}) EXPECT_EQ(m.command(override_velocity, 0, false, bad).answer, Answer::bad_value) << bad;
    EXPECT_EQ(m.command(override_velocity, 2, false, 1).answer, Answer::unknown_name);
    m.expect_no_jump();
}

TEST(OperatorsView, PeaksAndTimesBeginAnewWhenSomebodyAsksForIt) {
    TestMachine m{with_program(1, &entry_of<RunsX>)};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s));
    const auto peak = m.state().following_peaks[0];
    EXPECT_LT(peak.minimum, peak.maximum);
    EXPECT_GE(peak.maximum, m.axis(0).following_error);
    ASSERT_EQ(m.command(stop, 0).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0 && m.axis(0).following_error == 0; }, 2s));
    ASSERT_EQ(m.command(reset_peaks, 0).answer, Answer::accepted);
    m.run(2ms);
    EXPECT_EQ(m.state().following_peaks[0].maximum, 0);

    const auto runs = [&] {
        std::uint64_t all = 0;
        for (std::size_t i = 0; i < Histogram::bucket_count; ++i) all += m.machine->times().cycle->compute.bucket(i);
        return all;
    };
    EXPECT_EQ(runs(), m.state().cycle) << "every cycle since it was armed, once";
    EXPECT_GT(m.machine->times().tasks->at(0).longest().cycle, 0u);
    EXPECT_LE(m.machine->times().cycle->compute.longest().cycle, m.state().cycle);
    ASSERT_EQ(m.command(reset_statistics).answer, Answer::accepted);
    EXPECT_LE(runs(), 10u);
    EXPECT_GT(m.state().statistics.cycles, 100u) << "counters count on";
}

TEST_F(Commands, AFullInboxRefusesItsSender) {
    start();
    OperatorCommand c;
    c.action = acknowledge_alarms;
    int taken = 0;
    while (taken < 1000 && m().machine->submit(c)) ++taken;
    EXPECT_EQ(taken, 64);
    m().run(20ms);  // four a cycle
    EXPECT_TRUE(m().machine->submit(c));
}

}  // namespace
}  // namespace taktwerk::runtime::testing

// A command that an axis refuses, or that ends early, is an event: whose it was, who stands in the way. And who makes cycles late is named.

#include "axes/axis/alarms.hpp"
#include "core/stopwatch.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "runtime/tasks/watched_requests.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;
using axes::CommandKind;
using axes::ErrorId;
using What = CommandEvent::What;

std::vector<CommandEvent> events(TestMachine& m) {
    const auto& s = m.state();
    return {s.events.begin(), s.events.begin() + static_cast<std::ptrdiff_t>(s.event_count)};
}

/// Powers x, sets its zero, then moves it; `hold` is an MC_Stop of its own that may lock it.
class Mover : public Program {
public:
    static inline double velocity = 50;
    static inline bool hold_wanted = false, move_wanted = true, endless = false;
    MC_Power power;
    MC_Home home;
    MC_MoveAbsolute move;
    MC_MoveVelocity run;
    MC_Stop hold;
    void declare(Declaration& d) override {
        power.Axis = home.Axis = move.Axis = run.Axis = hold.Axis = d.axis("x");
        d.block("lift", move);
        d.block("hold", hold);
        d.task<&Mover::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Enable = true;
        power(ctx);
        home.Execute = power.Status;
        home(ctx);
        hold.Deceleration = 500;
        hold.Execute = home.Done && hold_wanted;
        hold(ctx);
        move.Position = 300;
        move.Velocity = velocity;
        move.Execute = home.Done && move_wanted && !move.Error;  // asks again and again
        move(ctx);
        run.Velocity = 10;
        run.Execute = home.Done && endless;
        run(ctx);
    }
};

/// Another program that wants the same axis, 100 ms after the first one moves.
class Rival : public Program {
public:
    static inline bool wanted = false;
    MC_MoveRelative push;
    void declare(Declaration& d) override {
        push.Axis = d.axis("x");
        d.block("push", push);
        d.task<&Rival::scan>("main");
    }
    void scan(TaskContext& ctx) {
        push.Distance = 20;
        push.Velocity = 20;
        push.Execute = wanted;
        push(ctx);
    }
};

struct CommandEventsOf : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    TestMachine& m() { return *machine; }
    void SetUp() override {
        Mover::velocity = 50;
        Mover::hold_wanted = Mover::endless = Rival::wanted = false;
        Mover::move_wanted = true;
    }
    void start(MachineConfig config) {
        for (auto& binding : config.axes) binding.axis.homing.kind = axes::HomingKind::set_here;
        machine = std::make_unique<TestMachine>(std::move(config));
        m().replayed.leave_out();  // Mover and Rival do what the test tells them
        ASSERT_TRUE(machine->up());
    }
    static MachineConfig two_programs() {
        auto config = with_program(1, &entry_of<Mover>);
        add_program(config, "q", &entry_of<Rival>);
        return config;
    }
    std::string_view block(const CommandGiver& giver) { return m().machine->layout().block_at(giver.block); }
    bool moves() {
        return m().until([&] { return m().axis(0).state == AxisState::DiscreteMotion && m().axis(0).set_velocity > 40; }, 10s);
    }
};

TEST_F(CommandEventsOf, AMoveThatAnotherBlocksStopHoldsBackNamesBoth) {
    Mover::hold_wanted = true;
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(m().until([&] { return m().axis(0).lock != 0; }, 10s)) << m().alarms();
    m().run(1s);

    const auto list = events(m());
    ASSERT_EQ(list.size(), 1u) << "asked for in each second scan, told once";
    EXPECT_EQ(list[0].what, What::refused);
    EXPECT_EQ(list[0].axis, 0);
    EXPECT_EQ(block(list[0].given), "p.lift");
    EXPECT_EQ(list[0].given.kind, CommandKind::move_absolute);
    EXPECT_EQ(list[0].given.program, 0);
    EXPECT_EQ(block(list[0].by), "p.hold");
    EXPECT_TRUE(list[0].held);
    EXPECT_EQ(list[0].error, ErrorId::state_forbids);
    EXPECT_GT(list[0].times, 400u);
}

TEST_F(CommandEventsOf, AMoveThatCannotBeIsRefusedWithItsReason) {
    Mover::velocity = -1;
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(m().until([&] { return m().state().event_count > 0; }, 10s));

    const auto list = events(m());
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].error, ErrorId::invalid_velocity);
    EXPECT_FALSE(list[0].held);
    EXPECT_EQ(block(list[0].given), "p.lift");
}

TEST_F(CommandEventsOf, TwoProgramsThatTakeAnAxisFromEachOtherAreNamedAndWhoWon) {
    start(two_programs());
    ASSERT_TRUE(moves());
    EXPECT_EQ(m().state().event_count, 0u);
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::axis_of_two_programs)));

    Rival::wanted = true;
    m().run(5ms);

    const auto list = events(m());
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].what, What::aborted);
    EXPECT_EQ(block(list[0].given), "p.lift");
    EXPECT_EQ(block(list[0].by), "q.push");
    EXPECT_EQ(list[0].by.program, 1);
    ASSERT_TRUE(m().has_alarm(id(MachineAlarm::axis_of_two_programs)));
    EXPECT_NE(m().alarms().find("axis x: Two programs command this axis: 'q' has it, 'p' lost it"), std::string::npos) << m().alarms();
    m().run(WatchedRequests::rivals_shown + 100ms);
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::axis_of_two_programs))) << "told long enough";
}

// An endless motion has reached what it was for: whoever takes the axis from it within its program goes on with it.
TEST_F(CommandEventsOf, WhatEndsAsItWasMeantIsNoEvent) {
    Mover::move_wanted = false;
    Mover::endless = true;
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(m().until([&] { return m().axis(0).active_in_target; }, 10s));
    Mover::move_wanted = true;
    ASSERT_TRUE(moves());
    EXPECT_EQ(m().state().event_count, 0u);

    Mover::hold_wanted = true;  // a stop of the same program ends the move: asked for, too
    m().run(5ms);
    EXPECT_EQ(m().state().event_count, 0u);
}

TEST_F(CommandEventsOf, AMoveThatTheOperatorStopsIsHis) {
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(moves());
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);

    const auto list = events(m());
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].what, What::aborted);
    EXPECT_EQ(block(list[0].given), "p.lift");
    EXPECT_EQ(list[0].by.kind, CommandKind::halt);
    EXPECT_EQ(list[0].by.program, no_program);
    EXPECT_EQ(list[0].by.owner, axes::Owner::operator_panel) << "no program's";
}

// At its velocity an endless motion is where it was meant to be: a program that takes it on is no news, a person who ends it is.
TEST_F(CommandEventsOf, AnEndlessMotionThatTheOperatorStopsIsHis) {
    Mover::move_wanted = false;
    Mover::endless = true;
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(m().until([&] { return m().axis(0).active_in_target; }, 10s));
    EXPECT_EQ(m().command(OperatorAction::stop, 0).answer, Answer::accepted);

    auto list = events(m());
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].what, What::aborted);
    EXPECT_EQ(list[0].given.kind, CommandKind::move_velocity);
    EXPECT_EQ(list[0].given.program, 0);
    EXPECT_EQ(list[0].by.kind, CommandKind::halt);
    EXPECT_EQ(list[0].by.owner, axes::Owner::operator_panel);

    Mover::hold_wanted = true;  // the program stops what is stopping already
    m().run(5ms);
    list = events(m());
    EXPECT_EQ(list.size(), 1u);
}

TEST_F(CommandEventsOf, AnErrorOfTheAxisEndsItsCommandByName) {
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(moves());
    m().world.drive("x")->jam(true);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 2s));
    m().run(10ms);

    const auto list = events(m());
    ASSERT_GE(list.size(), 1u);
    EXPECT_EQ(list[0].what, What::aborted);
    EXPECT_EQ(block(list[0].given), "p.lift");
    EXPECT_EQ(list[0].by, CommandGiver{});
    EXPECT_NE(list[0].axis_error, 0);
}

TEST_F(CommandEventsOf, AnEmergencyStopAndTheEndOfTheRunNeedNoEventOfTheirOwn) {
    start(with_program(1, &entry_of<Mover>));
    ASSERT_TRUE(moves());
    Mover::move_wanted = false;
    m().world.set_input("estop_ok", false);
    m().run(1s);
    EXPECT_EQ(m().state().event_count, 0u);
}

// The slower the more is told: someone who asks for more than set-up mode gives gets an answer that says so.
TEST_F(CommandEventsOf, AnAnswerSaysWhatTheModeLimitsTheVelocityTo) {
    auto config = machine_config(1);
    config.axes[0].axis.manual.setup_velocity = 5;
    start(std::move(config));
    m().enable(0);
    m().home(0);
    ASSERT_EQ(m().mode(Mode::setup).answer, Answer::accepted);
    m().enable(0);

    const auto slowed = m().command(OperatorAction::move_absolute, 0, false, 10, 100);
    EXPECT_EQ(slowed.answer, Answer::accepted);
    EXPECT_EQ(slowed.limited_to, 5);
    EXPECT_EQ(slowed.limited_in, Mode::setup);
    const auto granted = m().command(OperatorAction::move_absolute, 0, false, 10, 4);
    EXPECT_EQ(granted.answer, Answer::accepted);
    EXPECT_EQ(granted.limited_to, 0);
}

/// Takes longer than its cycle once; how long is measured, not slept.
class LongScan final : public Idle {
public:
    static inline std::int64_t long_scan = 0;
    void declare(Declaration& d) override {
        Idle::declare(d);
        d.task<&LongScan::work>("work");
    }
    void work(TaskContext&) {
        if (scans != long_scan) return;
        Stopwatch watch;
        for (Duration taken{}; taken < 4ms;) taken += watch.lap();
    }
};

// The base task took 4 ms of a 1 ms cycle, so three grid points were missed: the task is named, with its time and its count. The kernel,
// another process and power saving have nothing to do with it.
TEST_F(CommandEventsOf, ACycleThatABaseTaskMakesLateIsBlamedOnThatTask) {
    LongScan::long_scan = -1;
    start(with_program(1, &entry_of<LongScan>));
    const auto cycle = [&](Duration late, std::uint32_t missed) {
        m().clock.advance(1ms * (missed + 1));
        const auto now = m().clock.now();
        m().machine->cycle({now, now + late, missed});
        m().machine->service(now);
    };
    LongScan::long_scan = static_cast<std::int64_t>(variable(m(), "scans")) + 1;
    cycle({}, 0);
    cycle(400us, 3);

    const auto& s = m().state();
    std::size_t place = 0;
    while (place < m().machine->layout().tasks.size() && m().machine->layout().tasks[place] != "p.work") ++place;
    ASSERT_LT(place, s.tasks.size());
    EXPECT_EQ(s.tasks[place].overruns, 1u);
    EXPECT_GE(s.tasks[place].run_max, 4ms);
    ASSERT_TRUE(m().has_alarm(id(MachineAlarm::base_task_overrun))) << m().alarms();
    EXPECT_EQ(m().alarms().rfind("task p.work: The task took ", 0), 0u) << m().alarms();
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::late_wakeups))) << m().alarms();
    for (std::size_t i = 0; i < s.alarm_count; ++i) {
        if (s.alarms[i].fact.id != id(MachineAlarm::cycle_overrun)) continue;
        EXPECT_EQ(m().machine->describe(s.alarms[i].fact).cause.find("another process"), std::string::npos);
        EXPECT_EQ(m().machine->describe(s.alarms[i].fact).source, "task p.work");
    }
}

// The control to it: late without a long task is the host's doing, as ever.
TEST_F(CommandEventsOf, ACycleThatIsLateByItselfIsTheHosts) {
    LongScan::long_scan = -1;
    start(with_program(1, &entry_of<LongScan>));
    m().clock.advance(1ms);
    const auto now = m().clock.now();
    m().machine->cycle({now, now + 900us, 0});
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::late_wakeups)));
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::base_task_overrun)));
}

/// Forgot its input in declare(), and raises alarms that nobody declared.
class Forgetful final : public Idle {
public:
    static inline std::uint8_t number = 0;
    static inline bool reads = false;
    Input<bool> forgotten;
    void declare(Declaration& d) override {
        Idle::declare(d);
        d.alarm(6, Reaction::stop_machine, "six", "六", "six");
        d.task<&Forgetful::work>("work");
    }
    void work(TaskContext& ctx) {
        if (reads) (void)ctx.get(forgotten);
        if (number != 0) ctx.alarm(number, true);
    }
};

TEST_F(CommandEventsOf, WhatWasNeverDeclaredIsToldWhenItIsUsed) {
    Forgetful::number = 0;
    Forgetful::reads = false;
    const auto run = [&] {
        machine.reset();
        start(with_program(1, &entry_of<Forgetful>));
        m().run(20ms);
    };
    run();
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::undeclared_use)));

    Forgetful::reads = true;
    run();
    EXPECT_NE(m().alarms().find("program p: The program uses an input, output or parameter"), std::string::npos) << m().alarms();

    Forgetful::reads = false;
    for (const std::uint8_t number : {std::uint8_t{70}, std::uint8_t{7}}) {  // beyond the last; and one without a text. 70 is no 6
        Forgetful::number = number;
        run();
        EXPECT_NE(m().alarms().find("The program raises alarm " + std::to_string(number) + ","), std::string::npos) << m().alarms();
        EXPECT_FALSE(m().has_alarm(0x5006)) << "the declared one stops the machine";
    }
    Forgetful::number = 6;
    run();
    EXPECT_TRUE(m().has_alarm(0x5006));
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::undeclared_use)));
}

class Twice final : public Idle {
    void declare(Declaration& d) override {
        Idle::declare(d);
        d.monitor("scans", first_scans);
        d.parameter("p", {.value = 1, .minimum = 0, .maximum = 2, .unit = "", .doc = ""});
    }
};

std::vector<std::string> codes_of(MachineConfig config) {
    VirtualClock clock{Instant{} + 1s};
    World world{config, clock.now()};
    auto built = Machine::build(std::move(config), world.transport(), world.serial().lines());
    std::vector<std::string> out;
    if (auto* errors = std::get_if<1>(&built))
        for (const auto& error : *errors) out.push_back(error.code);
    return out;
}

TEST(ProgramDeclarations, TwoOfOneNameAreRefused) {
    EXPECT_EQ(codes_of(with_program(1, &entry_of<Twice>)), (std::vector<std::string>{"program.duplicate_name", "program.duplicate_name"}));
    EXPECT_TRUE(codes_of(with_program(1, &entry_of<Idle>)).empty());
}

// The configuration and the program each have a mistake: both are told at once.
TEST(ProgramDeclarations, WhatAProgramHasWrongIsToldBesideWhatTheFileHasWrong) {
    auto config = with_program(1, &entry_of<Twice>);
    config.commands_per_cycle = 0;
    const auto codes = codes_of(std::move(config));
    ASSERT_EQ(codes.size(), 3u);
    EXPECT_EQ(codes[0], "machine.commands_per_cycle");
    EXPECT_EQ(codes[1], "program.duplicate_name");
}

struct Counting final : Idle {
    void declare(Declaration& d) override {
        Idle::declare(d);
        parts = d.parameter("parts", {.value = 3, .minimum = 0, .maximum = 10, .unit = "", .doc = "", .kind = ParameterKind::whole});
    }
    Parameter parts;
};

class CountsInHalves final : public Idle {
    void declare(Declaration& d) override {
        Idle::declare(d);
        (void)d.parameter("parts", {.value = 2.5, .minimum = 0, .maximum = 10, .unit = "", .doc = "", .kind = ParameterKind::whole});
    }
};

TEST(ProgramDeclarations, AParameterThatCountsTakesWholeNumbersOnly) {
    auto config = with_program(1, &entry_of<Counting>);
    ParameterValue value;
    value.name = "parts";
    value.value = 1.5;
    config.programs[0].parameters = {value};
    EXPECT_EQ(codes_of(config), std::vector<std::string>{"program.parameter_range"});
    config.programs[0].parameters[0].value = 7;
    EXPECT_TRUE(codes_of(config).empty());
    EXPECT_EQ(codes_of(with_program(1, &entry_of<CountsInHalves>)), std::vector<std::string>{"program.parameter_range"});

    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_EQ(m.machine->layout().parameters[1].name, "parts");
    EXPECT_EQ(m.command(OperatorAction::set_parameter, 1, false, 4.5).answer, Answer::bad_value);
    EXPECT_EQ(m.command(OperatorAction::set_parameter, 1, false, 4).answer, Answer::accepted);
    EXPECT_EQ(m.command(OperatorAction::set_parameter, 0, false, 4.5).answer, Answer::accepted) << "the other one takes any";
}

/// "60 mm" as the loader hands it over; Idle's parameter p has no unit.
TEST(ProgramDeclarations, AParameterWithAUnitNeedsOneThatConverts) {
    auto config = with_program(1, &entry_of<Idle>);
    ParameterValue value;
    value.name = "p";
    value.text = "60 mm";
    value.in_units = {{"mm", 60}, {"cm", 6}};
    config.programs[0].parameters = {value};
    EXPECT_EQ(codes_of(config), std::vector<std::string>{"program.parameter_unit"});
}

// A hand holds an analog value of a slave that is described like a drive, from the file and while it runs.
TEST(SimulatedInputs, AnInputOfADriveIsHeldAtWhatTheFieldGives) {
    auto config = machine_config(1);
    IoPoint analog;
    analog.name = "load";
    analog.slave = "x_drive";
    analog.index = 0x6077;  // torque actual value, signed
    analog.simulated = -321;
    config.io.push_back(analog);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    const auto load = [&] {
        const auto& names = m.machine->layout().inputs;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == "load") return m.state().inputs[i];
        return std::int64_t{0};
    };
    m.run(10ms);
    EXPECT_EQ(load(), -321);
    SimulationEvent event;
    event.kind = SimulationEvent::Kind::input;
    event.target = "load";
    event.value = 1234;
    m.world.happen(event);
    m.run(10ms);
    EXPECT_EQ(load(), 1234);
}

}  // namespace
}  // namespace taktwerk::runtime::testing

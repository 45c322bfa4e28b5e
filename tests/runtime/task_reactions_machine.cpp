// A slower task that does not keep its time stops its own program, and nothing else. In virtual time a task does not come back when nobody
// runs it (tests/runtime/threads/task_threads_machine.cpp has one that really does not).

#include "runtime/alarms.hpp"
#include "runtime/tasks/task_watch.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;

/// Requests that were taken. Not a variable of the program: those are shown while it runs only.
int asked = 0;

/// Powers and runs one axis from task "main"; p drives the lamp from task "panel", which asks a drive for an object in each scan.
template <char axis_name, bool shines>
class WithPanel final : public Program {
public:
    AxisRef axis;
    Output<bool> lamp;
    fb::MC_Power power;
    fb::MC_MoveVelocity move;
    std::int64_t scans = 0, stops = 0;
    DeviceRef drive;
    void declare(Declaration& d) override {
        axis = d.axis(std::string_view(&name, 1));
        d.monitor("scans", scans);
        d.monitor("stops", stops);
        if (shines) {
            lamp = d.output("lamp");
            drive = d.device("x_drive");
            d.task<&WithPanel::panel>("panel");
        }
        d.task<&WithPanel::scan>("main");
    }
    void start() override {
        power = {};
        move = {};
    }
    void stop() override { ++stops; }
    void scan(TaskContext& ctx) {
        ++scans;
        power.Axis = move.Axis = axis;
        power.Enable = true;
        power(ctx);
        move.Velocity = 60;
        move.Execute = power.Status;
        move(ctx);
    }
    void panel(TaskContext& ctx) {
        ctx.set(lamp, true);
        const auto ticket = ctx.objects->read(drive, 0x6041, 0);
        if (ticket.valid()) ++asked;
        ctx.objects->release(ticket);
    }

private:
    static constexpr char name = axis_name;
};

/// p: base task "main" moves x, "panel" every 4 cycles. q: base task moves y.
struct TaskReactions : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    double slowest_y = 60;
    bool y_lost_power = false;
    TaskConfig panel = [] {
        TaskConfig task;
        task.name = "panel";
        task.program = "p";
        task.divisor = 4;
        return task;
    }();

    TestMachine& m() { return *machine; }
    void begin() {
        auto config = with_program(2, &entry_of<WithPanel<'x', true>>);
        add_program(config, "q", &entry_of<WithPanel<'y', false>>);
        config.tasks.push_back(panel);
        machine = std::make_unique<TestMachine>(config);
        ASSERT_TRUE(m().up());
        ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity == 60 && m().axis(1).set_velocity == 60; }, 3s));
        ASSERT_TRUE(m().until([&] { return m().world.output("lamp"); }, 1s));
        // To the cycle in which it has just been released: what happens from here on is counted.
        const auto releases = [&] { return m().state().tasks[0].releases; };
        const auto before = releases();
        ASSERT_TRUE(m().until([&] { return releases() > before; }, 100ms));
    }
    /// One cycle; its task has no processor.
    void cycle() {
        m().clock.advance(1ms);
        const auto now = m().clock.now();
        m().machine->cycle({now, now, 0});
        m().machine->service(now);
        m().runner->after_cycle(now);
        slowest_y = std::min(slowest_y, m().axis(1).set_velocity);
        y_lost_power = y_lost_power || !m().axis(1).powered;
    }
    /// So many cycles until x is told to be slower; -1: not within `most`.
    int cycles_until_ramp(int most) {
        for (int n = 1; n <= most; ++n) {
            cycle();
            if (m().axis(0).set_velocity < 60) return n;
        }
        return -1;
    }
    void expect_the_rest_is_unharmed() {
        EXPECT_EQ(slowest_y, 60) << "the other program's axis slowed down";
        EXPECT_FALSE(y_lost_power);
        EXPECT_EQ(m().axis(1).state, AxisState::ContinuousMotion);
        EXPECT_EQ(m().state().programs[1], ProgramState::running);
        m().expect_no_jump();
    }
    std::vector<AlarmId> alarm_ids() {
        std::vector<AlarmId> out;
        for (std::size_t i = 0; i < m().state().alarm_count; ++i) out.push_back(m().state().alarms[i].fact.id);
        return out;
    }
    void expect_x_and_lamp_are_off() {
        for (int i = 0; i < 1000 && m().axis(0).state != AxisState::Disabled; ++i) cycle();
        EXPECT_EQ(m().axis(0).state, AxisState::Disabled);
        EXPECT_EQ(m().axis(0).set_velocity, 0);
        EXPECT_FALSE(m().world.output("lamp")) << "its output is safe";
    }
};

// The run before has ended: the release 4 cycles on is in time, and nothing comes of it any more. From there 20 cycles are allowed; in the
// 21st the program is stopped, and in that cycle the axis is planned slower.
TEST_F(TaskReactions, ARunBeyondItsWatchdogStopsItsProgramAlone) {
    panel.overrun = OverrunReaction::count;
    panel.watchdog = 20ms;
    begin();

    EXPECT_EQ(cycles_until_ramp(100), 4 + 21);

    EXPECT_EQ(m().state().programs[0], ProgramState::fault);
    cycle();
    EXPECT_EQ(alarm_ids(), std::vector{id(MachineAlarm::task_watchdog)}) << m().alarms();
    const auto words = m().machine->describe(m().state().alarms[0].fact);
    EXPECT_EQ(words.source, "task p.panel");
    EXPECT_NE(words.english.find("21 ms since its release, allowed 20 ms"), std::string::npos) << words.english;
    EXPECT_EQ(m().state().alarms[0].reaction, Reaction::stop_axis);
    expect_x_and_lamp_are_off();
    expect_the_rest_is_unharmed();
    EXPECT_EQ(m().machine->program_fault(0), "task 'panel' did not end within its watchdog time");
}

// The control of the tests here: the same machine, and the task is run.
TEST_F(TaskReactions, ATaskInTimeStopsNothing) {
    panel.watchdog = 4ms;  // it is back in the cycle after its release
    begin();
    m().run(2s);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().axis(0).set_velocity, 60);
    EXPECT_TRUE(m().world.output("lamp"));
    EXPECT_EQ(m().state().tasks[0].overruns, 0u);
}

// Releases at 4 (in time), 8, 12, 16, 20: with three allowed the fourth missed one is too many.
TEST_F(TaskReactions, TooManyMissedReleasesStopTheProgramByDefault) {
    begin();
    EXPECT_EQ(cycles_until_ramp(100), 20);
    cycle();
    EXPECT_EQ(alarm_ids(), std::vector{id(MachineAlarm::task_late)}) << m().alarms();
    EXPECT_NE(m().alarms().find("task p.panel: A task was not finished at its next release, 4 times in a row (allowed 3)"),
              std::string::npos)
        << m().alarms();
    expect_x_and_lamp_are_off();
    expect_the_rest_is_unharmed();
}

// 10 periods are 40 ms; a thread may be kept so long from its processor where nothing is real-time.
TEST_F(TaskReactions, WithoutAWatchdogInTheFileItIsTenPeriodsAndAtLeast250Ms) {
    panel.overrun = OverrunReaction::count;
    begin();
    EXPECT_EQ(cycles_until_ramp(1000), 4 + 251);
    EXPECT_EQ(TaskWatch::watchdog_of(panel, m().machine->config()), 250ms);
    panel.divisor = 100;
    EXPECT_EQ(TaskWatch::watchdog_of(panel, m().machine->config()), 1s);
}

TEST_F(TaskReactions, WithoutAnyLimitItIsOnlyCounted) {
    panel.overrun = OverrunReaction::count;
    panel.watchdog = Duration{};
    begin();
    EXPECT_EQ(cycles_until_ramp(3000), -1);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().state().tasks[0].overruns, 749u) << "of 750 releases in 3000 cycles the first was in time";
    m().run(10ms);
    EXPECT_TRUE(m().world.output("lamp"));
}

TEST_F(TaskReactions, StopMachineStopsAllAxes) {
    panel.overrun = OverrunReaction::stop_machine;
    begin();
    EXPECT_EQ(cycles_until_ramp(100), 21) << "told in the cycle behind the fourth missed release";
    EXPECT_EQ(alarm_ids(), std::vector{id(MachineAlarm::task_overrun)}) << m().alarms();
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(m().axis(1).state, AxisState::ErrorStop);
}

// A hand can still stop what is left, and end the machine.
TEST_F(TaskReactions, WhileItHangsTheOtherAxesCanBeStoppedAndTheMachineEnded) {
    panel.watchdog = 20ms;
    panel.overrun = OverrunReaction::count;
    begin();
    ASSERT_GT(cycles_until_ramp(100), 0);
    m().machine->request_stop(1);
    cycle();
    cycle();
    EXPECT_LT(m().axis(1).set_velocity, 60);
    m().machine->request_shutdown();
    for (int i = 0; i < 2000 && m().machine->phase() != MachinePhase::stopped; ++i) cycle();
    EXPECT_EQ(m().machine->phase(), MachinePhase::stopped);
}

// Until its thread is back nobody may begin the program anew: two runs of one task would have the same variables.
TEST_F(TaskReactions, ItsProgramStartsAgainOnlyWhenTheTaskHasComeBack) {
    panel.watchdog = 20ms;
    begin();
    ASSERT_GT(cycles_until_ramp(100), 0);
    expect_x_and_lamp_are_off();
    const auto ask = [&](OperatorAction action) {
        OperatorCommand c;
        c.action = action;
        c.index = 0;
        EXPECT_TRUE(m().machine->submit(c));
        cycle();
        const auto answer = m().machine->next_answer();
        EXPECT_TRUE(answer);
        return answer.value_or(CommandAnswer{});
    };

    EXPECT_EQ(ask(OperatorAction::program_start).answer, Answer::not_possible_now) << "it is in fault";
    EXPECT_EQ(ask(OperatorAction::program_reset).answer, Answer::accepted);
    const auto hangs = ask(OperatorAction::program_start);
    EXPECT_EQ(hangs.answer, Answer::not_possible_now);
    EXPECT_EQ(hangs.error, axes::ErrorId::state_forbids);
    for (int i = 0; i < 100; ++i) cycle();
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::task_late))) << "it says why, also behind the reset: " << m().alarms();
    EXPECT_EQ(m().machine->program_at_work(), "task 'panel' of program 'p'");

    m().run(10ms);  // it comes back
    EXPECT_EQ(m().machine->program_at_work(), "");
    EXPECT_FALSE(m().world.output("lamp")) << "what it did since reaches nobody";
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).set_velocity == 60 && m().world.output("lamp"); }, 3s)) << m().alarms();
    EXPECT_EQ(variable(m(), "stops"), 1) << "its stop() ran when the task had come back";
    expect_the_rest_is_unharmed();
}

// Once it has come back one reset is enough: with the fault its alarm goes, too.
TEST_F(TaskReactions, OneResetTakesTheFaultAndItsAlarm) {
    for (const auto reaction : {OverrunReaction::stop_program, OverrunReaction::stop_machine}) {
        panel.overrun = reaction;
        begin();
        ASSERT_GT(cycles_until_ramp(100), 0);
        m().run(20ms);  // it comes back
        ASSERT_EQ(m().state().alarm_count, 1u) << m().alarms();
        EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
        m().run(20ms);
        EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    }
}

// It may compute for ever as long as its program runs; who stops the program and cannot start it again finds the reason among the alarms.
TEST_F(TaskReactions, OfAProgramThatAPersonHasStoppedTheTaskThatHangsIsNamed) {
    panel.watchdog = 500ms;
    panel.overrun = OverrunReaction::count;
    begin();
    for (int i = 0; i < 10; ++i) cycle();  // the release at 4 is the last one that it ended in time
    OperatorCommand stop;
    stop.action = OperatorAction::program_stop;
    stop.index = 0;
    EXPECT_TRUE(m().machine->submit(stop));
    cycle();
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);
    for (int i = 0; i < 400; ++i) cycle();
    EXPECT_EQ(m().state().alarm_count, 0u) << "the control: its time is not over: " << m().alarms();
    for (int i = 0; i < 200; ++i) cycle();
    EXPECT_EQ(alarm_ids(), std::vector{id(MachineAlarm::task_watchdog)}) << m().alarms();
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);

    m().run(10ms);  // it comes back
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).set_velocity == 60; }, 3s)) << m().alarms();
}

// Without a watchdog it may compute as long as it likes while its program runs. Ten periods, at least 250 ms, after a person has stopped that, it is named
// all the same, with the time since its release and what it was given.
TEST_F(TaskReactions, WithoutAWatchdogTheTaskThatHangsIsNamedSomeTimeAfterTheStop) {
    panel.watchdog = Duration{};
    panel.overrun = OverrunReaction::count;
    begin();
    for (int i = 0; i < 1000; ++i) cycle();
    EXPECT_EQ(m().state().alarm_count, 0u) << "the control: nobody has stopped it: " << m().alarms();
    OperatorCommand stop;
    stop.action = OperatorAction::program_stop;
    stop.index = 0;
    EXPECT_TRUE(m().machine->submit(stop));
    cycle();
    ASSERT_EQ(m().state().programs[0], ProgramState::stopped);
    for (int i = 0; i < 240; ++i) cycle();
    EXPECT_EQ(m().state().alarm_count, 0u) << "the control: its time is not over: " << m().alarms();
    for (int i = 0; i < 20; ++i) cycle();
    EXPECT_EQ(alarm_ids(), std::vector{id(MachineAlarm::task_watchdog)}) << m().alarms();
    EXPECT_EQ(m().state().alarms[0].fact.b, 250);
    EXPECT_GT(m().state().alarms[0].fact.a, 1240);
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);

    m().run(10ms);  // it comes back
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).set_velocity == 60; }, 3s)) << m().alarms();
    for (int i = 0; i < 400; ++i) cycle();
    EXPECT_EQ(m().state().alarm_count, 0u) << "its time begins with a stop: " << m().alarms();
}

/// Notes what its tasks are told of themselves.
class Asks final : public Program {
public:
    std::vector<TaskInfo> slow_told, base_told;
    void declare(Declaration& d) override {
        slow_told.reserve(10'000);
        base_told.reserve(10'000);
        newest = this;
        d.task<&Asks::slow>("slow");
        d.task<&Asks::base>("base");
    }
    void slow(TaskContext& ctx) { slow_told.push_back(ctx.task()); }
    void base(TaskContext& ctx) { base_told.push_back(ctx.task()); }
    static inline Asks* newest = nullptr;
};

// What is counted is the same everywhere; what is measured is 0, or a program that looks at it would do something else in each run.
TEST_F(TaskReactions, InVirtualTimeATaskIsToldHowOftenItRanAndThatItTookNoTime) {
    auto config = with_program(1, &entry_of<Asks>);
    config.tasks[0].name = "base";
    panel.name = "slow";
    panel.overrun = OverrunReaction::count;
    panel.watchdog = Duration{};
    config.tasks.push_back(panel);
    machine = std::make_unique<TestMachine>(config);
    ASSERT_TRUE(m().up());
    m().run(200ms);
    auto& program = *Asks::newest;
    ASSERT_GT(program.slow_told.size(), 40u);
    for (std::size_t i = 0; i < program.slow_told.size(); ++i) {
        EXPECT_EQ(program.slow_told[i].runs, i) << "this one has not ended";
        EXPECT_EQ(program.slow_told[i].missed, 0u);
    }
    for (std::size_t i = 0; i < program.base_told.size(); ++i) EXPECT_EQ(program.base_told[i].runs, i);
    EXPECT_EQ(program.slow_told.back().period, 4ms);
    EXPECT_EQ(program.base_told.back().period, 1ms);

    // To the cycle behind a release: five later ones find it at work, the first of them is in time.
    const auto releases = m().state().tasks[0].releases;
    ASSERT_TRUE(m().until([&] { return m().state().tasks[0].releases > releases; }, 100ms));
    for (int i = 0; i < 20; ++i) {
        m().clock.advance(1ms);
        m().machine->cycle({m().clock.now(), m().clock.now(), 0});
        m().machine->service(m().clock.now());
    }
    const auto starved = program.slow_told.size();
    m().run(12ms);
    ASSERT_GT(program.slow_told.size(), starved + 1);
    EXPECT_EQ(program.slow_told[starved].missed, 0u) << "told at its release, before it was late";
    EXPECT_EQ(program.slow_told[starved + 1].missed, 4u);
    EXPECT_EQ(program.slow_told[starved + 2].missed, 0u);
    EXPECT_EQ(m().state().tasks[0].overruns, 4u);
    for (const auto* told : {&program.slow_told, &program.base_told})
        for (const auto& info : *told) {
            ASSERT_EQ(info.run.last, Duration{});
            ASSERT_EQ(info.run.maximum, Duration{});
            ASSERT_EQ(info.lateness_max, Duration{});
        }
    // The control: people are shown what it took.
    EXPECT_GT(m().state().tasks[0].run_max, Duration{});
    EXPECT_LE(m().state().tasks[0].run_min, m().state().tasks[0].run_mean());
    EXPECT_LE(m().state().tasks[0].run_mean(), m().state().tasks[0].run_max);
}

TEST_F(TaskReactions, WhatIsStoppedAsksNoDriveForObjectsAnyMore) {
    begin();
    ASSERT_GT(asked, 0) << "it could before";
    ASSERT_GT(cycles_until_ramp(100), 0);
    const auto given_up = asked;
    ASSERT_TRUE(m().machine->run_slow_task(0)) << "its run goes on, and asks";
    EXPECT_EQ(asked, given_up);

    m().run(10ms);
    ASSERT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(10ms);
    ASSERT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return asked > given_up; }, 1s)) << "and can when it was started anew";
}

}  // namespace
}  // namespace taktwerk::runtime::testing

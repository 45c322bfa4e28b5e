// What the machine watches, beyond the faults of fault_machine.cpp: emergency stop to its time limit, late cycles and tasks, reactions,
// the end of the run.

#include "axes/axis/alarms.hpp"
#include "core/recorder.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "runtime/recording/inbox_record.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;
using axes::PowerState;

struct Supervised : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    void start(MachineConfig config) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(machine->up());
    }
    /// x homed in place and on its way at 200 mm/s.
    void moving(MachineConfig config = machine_config(1)) {
        config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
        start(std::move(config));
        m().enable(0);
        m().home(0);
        ASSERT_EQ(m().command(OperatorAction::move_absolute, 0, false, 700, 200).answer, Answer::accepted);
        ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 195; }, 5s));
    }
    TestMachine& m() { return *machine; }
    /// One cycle as a late or stalled host would call it.
    void cycle(Duration late, std::uint32_t missed = 0) {
        m().clock.advance(1ms * (missed + 1));
        const auto now = m().clock.now();
        m().machine->cycle({now, now + late, missed});
        m().machine->service(now);
        m().runner->after_cycle(now);
    }
};

// From 500 mm/s at 500 mm/s3 a stop takes 2 sqrt(500/500) = 2 s, which check() accepts. But an axis that is still accelerating must
// first take its acceleration away, which makes it faster and costs time.
TEST_F(Supervised, PowerGoesAtTheLatestWhenTheTimeOfTheEmergencyStopIsUp) {
    auto config = machine_config(1);
    auto& axis = config.axes[0].axis;
    axis.limits.acceleration = 500;
    axis.limits.jerk = 500;
    axis.manual.fast = 500;
    axis.homing.kind = axes::HomingKind::set_here;
    config.emergency_stop.power_off_after = 2s;
    start(std::move(config));
    m().enable(0);
    m().home(0);
    ASSERT_EQ(m().command(OperatorAction::move_absolute, 0, false, 700, 500).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 150; }, 5s)) << m().alarms();

    m().world.set_input("estop_ok", false);
    m().run(1990ms);
    EXPECT_TRUE(m().axis(0).powered) << "it still ramps";
    EXPECT_GT(m().axis(0).set_velocity, 10);
    m().run(20ms);
    EXPECT_NE(m().axis(0).drive_state, PowerState::enabled);
}

// The axes are off, then the bus goes down: nobody has pressed a button by that.
TEST_F(Supervised, ABusThatGoesDownAtTheEndIsNoEmergencyStop) {
    moving();
    std::size_t pressed = 0, silent = 0;
    m().on_cycle = [&] {
        pressed += m().state().emergency_stop ? 1 : 0;
        silent += m().state().bus_phase != ecat::Master::Phase::operational ? 1 : 0;
    };
    m().runner->shut_down();
    EXPECT_EQ(m().machine->phase(), MachinePhase::stopped);
    EXPECT_EQ(m().machine->bus().phase(), ecat::Master::Phase::stopped);
    EXPECT_GT(silent, 0u) << "the button was unreadable for a while";
    EXPECT_EQ(pressed, 0u);
}

TEST_F(Supervised, AnAxisThatStopsForAnotherPartNamesItsAlarm) {
    start(machine_config(1));
    const auto told = [&](AlarmId cause) {
        return m()
            .machine->describe({axes::id(axes::AxisAlarm::stopped_by_machine), AlarmSource::axis, 0, static_cast<double>(cause), 0})
            .english;
    };
    EXPECT_EQ(told(id(MachineAlarm::program_fault)), "Stopped because of another part of the machine (program_fault)");
    EXPECT_EQ(told(0x5003), "Stopped because of another part of the machine (program_alarm_3)");
    EXPECT_EQ(told(0x0ABC), "Stopped because of another part of the machine (alarm 0ABCh)") << "in no list: the number, as everywhere";
}

TEST_F(Supervised, AnEmergencyStopThatCannotBeReadCountsAsPressed) {
    moving();
    m().world.set_slave_power("io", false);
    EXPECT_TRUE(m().until([&] { return m().state().emergency_stop; }, 20ms));
    EXPECT_TRUE(m().until([&] { return m().axis(0).drive_state != PowerState::enabled; }, 600ms));
    m().expect_no_jump();
}

// Acknowledging is not the same as resetting, and one alarm that waits does not hide what another one demands.
TEST_F(Supervised, AnUnacknowledgedEmergencyStopDoesNotHideAnotherReaction) {
    moving();
    m().world.set_input("estop_ok", false);
    m().run(1s);
    m().world.set_input("estop_ok", true);
    m().run(10ms);
    ASSERT_TRUE(m().has_alarm(id(MachineAlarm::emergency_stop))) << "it waits for its acknowledgement";
    for (int i = 0; i < 3; ++i) m().command(OperatorAction::reset, 0);  // the axis alone, not the machine
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 3s));
    m().enable(0);
    cycle(0ms, 11);  // ten are allowed
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::cycle_overrun)));
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
}

/// Keeps x powered, and has two things to say at once.
class Shouts final : public Idle {
public:
    static inline bool loud = false;
    void declare(Declaration& d) override {
        (void)d.axis("x");
        d.alarm(0, Reaction::stop_machine, "one", "一", "one");
        d.alarm(1, Reaction::power_off, "two", "二", "two");
        d.alarm(2, Reaction::stop_machine, "three", "三", "three");
        d.task<&Shouts::scan>("main");
    }
    void scan(TaskContext& ctx) {
        (void)ctx.requests->power({0}, true, true, true, ctx.owner);
        for (std::uint8_t number = 0; number < 3; ++number) ctx.alarm(number, loud);
    }
};

// Of all alarms that stand the strongest reaction is carried out.
TEST_F(Supervised, TheStrongestOfSeveralReactionsIsCarriedOut) {
    Shouts::loud = false;
    start(with_program(1, &entry_of<Shouts>));
    m().replayed.leave_out();  // the test tells it when
    ASSERT_TRUE(m().until([&] { return m().axis(0).powered; }, 3s)) << m().alarms();
    Shouts::loud = true;
    m().run(500ms);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_FALSE(m().axis(0).powered);
    Shouts::loud = false;
}

TEST_F(Supervised, TooManyMissedTicksInARowStopTheMachineUntilAReset) {
    auto config = machine_config(1);
    config.watch.overruns_allowed = 2;
    moving(std::move(config));
    cycle(0ms, 2);
    m().run(5ms);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion) << "two are allowed " << m().alarms();
    cycle(0ms, 2);
    cycle(0ms, 1);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop) << "three in a row";
    EXPECT_TRUE(m().axis(0).powered) << "stop_machine leaves the power on";

    m().run(2s);
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::cycle_overrun)));
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(5ms);
    EXPECT_EQ(m().axis(0).state, AxisState::Standstill) << m().alarms();
    EXPECT_EQ(m().state().statistics.missed_ticks, 5u);
    EXPECT_EQ(m().state().statistics.overruns, 3u);
    m().expect_no_jump();
}

TEST_F(Supervised, RelaxedSupervisionIsAHundredTimesWider) {
    auto config = machine_config(1);
    config.simulation.supervision = Supervision::relaxed;
    moving(std::move(config));
    cycle(0ms, 400);
    m().run(5ms);
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::cycle_overrun)));
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion) << m().alarms();
}

// The base cycle on a host without real time is late every few cycles: one line for the operator, no reaction.
TEST_F(Supervised, LateWakeUpsAreOneAlarmThatGoesByItself) {
    moving();
    for (int i = 0; i < 100; ++i) {
        cycle(i % 3 == 0 ? 400us : 10us);
        EXPECT_TRUE(m().has_alarm(id(MachineAlarm::late_wakeups)));
    }
    ASSERT_EQ(m().state().alarm_count, 1u) << m().alarms();
    EXPECT_EQ(m().state().alarms[0].count, 1u) << "it did not come and go";
    EXPECT_EQ(m().state().alarms[0].fact.a, 400.0);
    EXPECT_EQ(m().state().statistics.lateness_max, 400us);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion);
    m().run(1100ms);
    EXPECT_EQ(m().state().alarm_count, 0u);
    cycle(300us);  // another one tells its own worst, not that of the one before
    EXPECT_EQ(m().state().alarms[0].fact.a, 300.0);
}

// Where memory is locked a page fault in operation is nothing that may happen: one line for the operator, no reaction.
TEST_F(Supervised, MemoryThatTheCycleWaitedForIsAWarningThatGoesByItself) {
    moving();
    m().machine->tell_page_faults({3, 0, true});
    m().run(2s);
    ASSERT_EQ(m().state().alarm_count, 1u) << m().alarms();
    EXPECT_EQ(m().state().alarms[0].fact.id, id(MachineAlarm::page_faults));
    EXPECT_EQ(m().state().alarms[0].fact.a, 3.0);
    EXPECT_EQ(m().state().alarms[0].fact.b, 0.0);
    EXPECT_EQ(m().state().alarms[0].reaction, Reaction::warn);
    EXPECT_EQ(m().state().statistics.page_faults, 3u);
    EXPECT_EQ(m().axis(0).state, AxisState::DiscreteMotion);

    m().machine->tell_page_faults({4, 2, true});  // three more, two of them from a disk, while the first are shown
    m().run(4900ms);
    ASSERT_EQ(m().state().alarm_count, 1u) << "it did not come and go " << m().alarms();
    EXPECT_EQ(m().state().alarms[0].count, 1u);
    EXPECT_EQ(m().state().alarms[0].fact.a, 6.0);
    EXPECT_EQ(m().state().alarms[0].fact.b, 2.0);

    m().run(200ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().state().statistics.page_faults, 6u) << "counted they stay";
    EXPECT_EQ(m().state().statistics.disk_page_faults, 2u);
    m().machine->tell_page_faults({5, 2, true});  // another one tells its own
    m().run(10ms);
    ASSERT_EQ(m().state().alarm_count, 1u);
    EXPECT_EQ(m().state().alarms[0].fact.a, 1.0);
}

TEST_F(Supervised, WithoutLockedMemoryOnlyAPageOfADiskIsAnAlarm) {
    moving();
    m().machine->tell_page_faults({1000, 0, false});
    m().run(10ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().state().statistics.page_faults, 1000u);
    m().machine->tell_page_faults({1001, 1, false});
    m().run(10ms);
    ASSERT_EQ(m().state().alarm_count, 1u);
    EXPECT_EQ(m().state().alarms[0].fact.a, 1.0);
    EXPECT_EQ(m().state().alarms[0].fact.b, 1.0);
}

TEST_F(Supervised, TheRunEndsAlthoughADriveDoesNotAnswer) {
    moving();
    m().world.set_slave_power("x_drive", false);
    m().run(100ms);
    m().machine->request_shutdown();
    EXPECT_TRUE(m().until([&] { return m().machine->phase() == MachinePhase::stopped; }, 7s));
}

TEST_F(Supervised, ARequestToEndBeforeTheMachineIsArmedEndsTheBringUp) {
    TestMachine early{machine_config(1)};
    early.machine->start_bus();
    early.machine->request_shutdown();
    early.machine->cycle({early.clock.now() + 1ms, early.clock.now() + 1ms, 0});
    EXPECT_EQ(early.machine->phase(), MachinePhase::stopped);
}

// Outputs leave at the start of the next cycle: one cycle more of dead time, known to the following error.
TEST_F(Supervised, SendAtTickMovesTheAxisToTheSamePlaceWithoutAlarms) {
    auto config = machine_config(1);
    config.send = SendMode::at_tick;
    moving(std::move(config));
    EXPECT_LT(std::abs(m().axis(0).following_error), 0.5) << "one cycle at 200 mm/s is 0.2 mm";
    ASSERT_TRUE(m().until([&] { return m().axis(0).in_position; }, 10s)) << m().alarms();
    EXPECT_EQ(m().axis(0).set_position, 700.0);
    EXPECT_NEAR(m().axis(0).actual_position, 700.0, 0.05);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    m().expect_no_jump();
}

// --- tasks that take longer than their period: in virtual time a task is late when nobody runs it -------------------------------------

struct LateTask : Supervised {
    void begin(OverrunReaction reaction) {
        auto config = with_program(1, &entry_of<RunsX>, 4);
        config.tasks[0].overrun = reaction;
        config.tasks[0].overruns_allowed = 3;
        config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
        start(std::move(config));
        ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity > 45; }, 5s)) << m().alarms();
    }
    /// The task's thread is starved: cycles run, it does not.
    void starve(int releases) {
        for (int i = 0; i < 4 * releases; ++i) cycle(0ms);
    }
};

TEST_F(LateTask, IsCountedAndGoesOnAtTheNextRelease) {
    begin(OverrunReaction::stop_machine);
    starve(3);
    // Twelve cycles hold three of its releases; the first of them is still in time, because the run before has ended.
    EXPECT_EQ(m().state().tasks[0].overruns, 2u);
    EXPECT_EQ(m().axis(0).state, AxisState::ContinuousMotion) << "three are allowed, and its power wish holds meanwhile";
    const auto releases = m().state().tasks[0].releases;
    m().run(20ms);
    EXPECT_GE(m().state().tasks[0].releases, releases + 4) << "none is caught up, all later ones come";
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
}

TEST_F(LateTask, StopsTheMachineWhenItStaysLateAndAResetBringsItBack) {
    begin(OverrunReaction::stop_machine);
    starve(6);
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::task_overrun)));
    EXPECT_NE(m().alarms().find("task p.main"), std::string::npos) << m().alarms();
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    m().run(1s);
    EXPECT_EQ(m().axis(0).set_velocity, 0.0);
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::task_overrun))) << "until the reset";

    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    m().run(50ms);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
    EXPECT_EQ(m().axis(0).state, AxisState::Standstill) << "the program's power wish holds; its motion is over";
    m().expect_no_jump();
}

TEST_F(LateTask, WithReactionCountNothingStops) {
    begin(OverrunReaction::count);
    starve(20);
    EXPECT_GE(m().state().tasks[0].overruns, 18u);
    EXPECT_EQ(m().axis(0).state, AxisState::ContinuousMotion);
    EXPECT_EQ(m().state().alarm_count, 0u) << m().alarms();
}

// stop() must not run beside a task that is still at work.
TEST_F(LateTask, StopOfTheProgramWaitsForItsTask) {
    begin(OverrunReaction::count);
    starve(2);  // released, not run
    OperatorCommand c;
    c.action = OperatorAction::program_stop;
    c.index = 0;
    ASSERT_TRUE(m().machine->submit(c));
    starve(2);
    c.action = OperatorAction::program_start;
    ASSERT_TRUE(m().machine->submit(c));
    cycle(0ms);
    std::vector<Answer> answers;
    while (const auto answer = m().machine->next_answer()) answers.push_back(answer->answer);
    EXPECT_EQ(answers, (std::vector{Answer::accepted, Answer::not_possible_now}));
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);
    m().run(10ms);  // now it ends
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(m().state().programs[0], ProgramState::running);
}

// Task names and their numbers stand at the same index, whatever the order of declaration and the divisors.
TEST_F(Supervised, TaskStatisticsStandInTheOrderOfTheirNames) {
    class TwoTasks final : public Program {
    public:
        std::int64_t fast_scans = 0;
        void declare(Declaration& d) override {
            d.monitor("fast_scans", fast_scans);
            d.task<&TwoTasks::slow>("slow");
            d.task<&TwoTasks::fast>("fast");
        }
        void slow(TaskContext& ctx) { ctx.alarm(1, true); }
        void fast(TaskContext&) { ++fast_scans; }
    };
    auto config = with_program(1, &entry_of<TwoTasks>, 10);
    config.tasks[0].name = "slow";
    start(std::move(config));
    m().run(100ms);
    ASSERT_EQ(m().machine->layout().tasks, (std::vector<std::string>{"p.slow", "p.fast"}));
    EXPECT_NEAR(static_cast<double>(m().state().tasks[0].releases), 10, 1);
    EXPECT_GE(m().state().tasks[1].releases, 99u);
    EXPECT_GE(variable(m(), "fast_scans"), 99.0);
}

// --- the recorded inbox ----------------------------------------------------------------------------------------------------------------

TEST(Inbox, TicksFramesAndCommandsAreRecordedInTheOrderInWhichTheCycleTookThem) {
    Recorder recorder{1 << 22, Recorder::Policy::drop_newest};
    TestMachine m{machine_config(1)};
    m.machine->record(recorder);
    ASSERT_TRUE(m.up());
    recorder.clear();
    OperatorCommand c;
    c.action = OperatorAction::set_mode;
    c.mode = Mode::setup;
    c.value = 2.5;
    ASSERT_EQ(m.command(c).answer, Answer::accepted);

    std::vector<RecordChannel> order;
    std::vector<std::byte> command;
    recorder.for_each([&](const RecordView& record) {
        order.push_back(record.channel);
        if (record.channel == command_channel) command.assign(record.bytes.begin(), record.bytes.end());
        if (record.channel == tick_channel) {
            EXPECT_EQ(record.bytes.size(), 20u);
        }
        if (record.channel == frame_channel) {
            EXPECT_GE(record.bytes.size(), 60u) << "a whole Ethernet frame";
        }
    });
    ASSERT_GE(order.size(), 3u);
    EXPECT_EQ(order[0], tick_channel);
    EXPECT_EQ(order[1], frame_channel);
    EXPECT_NE(std::find(order.begin(), order.end(), command_channel), order.end());
    ASSERT_EQ(command.size(), 52u);
    EXPECT_EQ(static_cast<OperatorAction>(command[0]), OperatorAction::set_mode);
    EXPECT_EQ(static_cast<Mode>(command[2]), Mode::setup);
    EXPECT_EQ(recorder.dropped(), 0u);
}

}  // namespace
}  // namespace taktwerk::runtime::testing

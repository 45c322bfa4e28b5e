// A stop is a level: it acts in the cycle after it was raised, whatever stands in the inbox, and what was given before it does not start
// the axis again behind it. In virtual time; the ways in which threads, terminals and clients get in the way are in tests/apps.

#include <array>
#include <functional>

#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "runtime/recording/inbox_reader.hpp"
#include "runtime/run/advance_watch.hpp"
#include "runtime/run/end_watch.hpp"
#include "tests/patience.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

class Levels : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(m.up());
        for (const std::uint16_t axis : std::array<std::uint16_t, 2>{0, 1}) {
            m.enable(axis);
            m.home(axis);
        }
    }
    void move(std::uint16_t axis) {
        ASSERT_EQ(m.command(OperatorAction::move_absolute, axis, false, 700, 100).answer, Answer::accepted);
        ASSERT_TRUE(m.until([&] { return m.axis(axis).set_velocity == 100.0; }, 5s));
    }
    void flood() {
        OperatorCommand c;
        c.action = OperatorAction::acknowledge_alarms;
        for (Patience patience; patience.lasts(m.machine->submit(c));) {}
    }
    void two_cycles() { m.run(2 * m.machine->config().cycle); }
    /// Decelerating towards a stop.
    void expect_stopping(std::uint16_t axis) {
        EXPECT_LT(m.axis(axis).set_acceleration, 0.0) << "within two cycles the ramp has begun";
        EXPECT_TRUE(m.until([&] { return m.axis(axis).set_velocity == 0.0; }, 5s));
        EXPECT_LT(m.axis(axis).set_position, 690.0) << "it did not run to its target";
        m.expect_no_jump();
    }
    TestMachine m{machine_config(2)};
};

TEST_F(Levels, AStopActsWithinTwoCyclesAlthoughTheInboxIsFull) {
    move(0);
    flood();
    const auto ticket = m.machine->request_stop(0);
    EXPECT_FALSE(m.machine->taken(ticket));
    two_cycles();
    EXPECT_TRUE(m.machine->taken(ticket));
    expect_stopping(0);
}

TEST_F(Levels, AStopOfAllStopsAllAndAStopOfOneOnlyThatOne) {
    move(0);
    move(1);
    m.machine->request_stop(1);
    two_cycles();
    EXPECT_LT(m.axis(1).set_acceleration, 0.0);
    EXPECT_EQ(m.axis(0).set_velocity, 100.0);
    m.machine->request_stop(StopLevels::all_axes);
    two_cycles();
    expect_stopping(0);
}

TEST_F(Levels, AMoveThatWasGivenBeforeAStopAndComesBehindItIsStale) {
    OperatorCommand before;
    before.action = OperatorAction::move_absolute;
    before.axis = 0;
    before.value = 300;
    before.value2 = 50;
    before.after = m.machine->levels_raised();
    m.machine->request_stop(0);
    EXPECT_EQ(m.command(before).answer, Answer::stale);
    m.run(100ms);
    EXPECT_EQ(m.axis(0).set_velocity, 0.0);

    // Of another axis it is none of that stop's business, and what is given after it starts.
    auto other = before;
    other.axis = 1;
    EXPECT_EQ(m.command(other).answer, Answer::accepted);
    auto after = before;
    after.after = m.machine->levels_raised();
    EXPECT_EQ(m.command(after).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity > 0; }, 1s));
}

TEST_F(Levels, AJogLetGoStopsWhateverMovesTheAxisByHand) {
    ASSERT_EQ(m.command(OperatorAction::jog, 0, true, 20).answer, Answer::accepted);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 700, 100).answer, Answer::accepted) << "the cycle knows no clients";
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 100.0; }, 5s));
    flood();
    m.machine->release_jog(0);
    two_cycles();
    expect_stopping(0);
}

TEST_F(Levels, AShutdownActsAlthoughTheInboxIsFull) {
    move(0);
    flood();
    m.machine->request_shutdown();
    two_cycles();
    EXPECT_EQ(m.machine->phase(), MachinePhase::stopping);
    expect_stopping(0);
}

TEST(LevelsRecorded, EachIsOneRecordInTheOrderInWhichTheCycleTookThemBeforeTheCommands) {
    Recorder recorder{1 << 22, Recorder::Policy::drop_newest};
    TestMachine m{machine_config(2)};
    m.machine->record(recorder);
    ASSERT_TRUE(m.up());
    recorder.clear();
    m.machine->request_stop(1);
    m.machine->release_jog(0);
    OperatorCommand c;
    c.action = OperatorAction::acknowledge_alarms;
    c.client = 7;
    ASSERT_TRUE(m.machine->submit(c));
    m.machine->request_shutdown();
    m.run(2ms);

    std::vector<std::string> order;
    recorder.for_each([&](const RecordView& record) {
        if (record.channel == level_channel) {
            const auto level = read_level(record.bytes);
            ASSERT_TRUE(level);
            const char* const names[] = {"stop", "release_jog", "shutdown"};
            order.push_back(names[static_cast<std::size_t>(level->level)] + (" " + std::to_string(level->axis)) + " #" +
                            std::to_string(level->number));
        }
        if (record.channel != command_channel) return;
        const auto command = read_command(record.bytes);
        ASSERT_TRUE(command);
        EXPECT_EQ(command->action, OperatorAction::acknowledge_alarms);
        order.push_back("command of " + std::to_string(command->client));
    });
    // Numbers: in the order in which they were raised. Places: stops, jogs let go, the end (stop_levels.hpp).
    const std::vector<std::string> expected{"stop 1 #1", "release_jog 0 #2", "shutdown 65535 #3", "command of 7"};
    EXPECT_EQ(order, expected);
}

// --- a program's axis ------------------------------------------------------------------------------------------------------------------

TEST(LevelsOfPrograms, AProgramsAxisIsSparedByAJogLetGoAndStoppedByAStop) {
    TestMachine m{with_program(1, &entry_of<RunsX>)};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s));
    m.machine->release_jog(0);
    m.run(50ms);
    EXPECT_EQ(m.axis(0).set_velocity, 50.0) << "nobody jogged it: that press was refused";
    m.machine->request_stop(0);
    EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0.0; }, 5s));
}

/// Its start() takes long: what happens meanwhile happens in there.
class SlowStarter final : public RunsX {
public:
    inline static std::function<void()> meanwhile;
    inline static int ended = 0;
    void start() override {
        RunsX::start();
        if (meanwhile) meanwhile();
    }
    void stop() override { ++ended; }
};

struct StopWhileStarting : ::testing::Test {
    void SetUp() override {
        SlowStarter::meanwhile = {};
        SlowStarter::ended = 0;
    }
    void TearDown() override { SlowStarter::meanwhile = {}; }
    static MachineConfig config(bool autostart) {
        auto config = with_program(2, &entry_of<SlowStarter>);
        config.programs[0].autostart = autostart;
        return config;
    }
    static void expect_never_moves(TestMachine& m) {
        for (int i = 0; i < 50; ++i) {
            m.run(100ms);
            ASSERT_EQ(m.axis(0).set_velocity, 0.0);
            ASSERT_FALSE(m.axis(0).powered);
        }
        EXPECT_EQ(m.state().programs[0], ProgramState::stopped);
        EXPECT_TRUE(m.has_alarm(id(MachineAlarm::start_withdrawn))) << m.alarms();
        EXPECT_EQ(SlowStarter::ended, 1) << "its stop() ends what start() has begun";
    }
    static void expect_starts(TestMachine& m) {
        SlowStarter::meanwhile = {};
        EXPECT_EQ(m.command(OperatorAction::program_start, 0).answer, Answer::accepted);
        EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s)) << "what is given after the stop starts";
    }
};

TEST_F(StopWhileStarting, AProgramWhoseStartWasGivenBeforeAStopDoesNotBeginBehindIt) {
    TestMachine m{config(false)};
    m.replayed.leave_out();  // its start() reaches out of it
    ASSERT_TRUE(m.up());
    SlowStarter::meanwhile = [&] { m.machine->request_stop(0); };
    OperatorCommand start;
    start.action = OperatorAction::program_start;
    start.index = 0;
    start.after = m.machine->levels_raised();
    ASSERT_EQ(m.command(start).answer, Answer::accepted);
    expect_never_moves(m);
    expect_starts(m);
    m.machine->request_stop(0);
    EXPECT_EQ(m.state().programs[0], ProgramState::running) << "one that runs goes on";
}

TEST_F(StopWhileStarting, AStopOfAllBindsItToo) {
    TestMachine m{config(true)};
    m.replayed.leave_out();  // its start() reaches out of it
    SlowStarter::meanwhile = [&] { m.machine->request_stop(StopLevels::all_axes); };
    ASSERT_TRUE(m.up());
    expect_never_moves(m);
    expect_starts(m);
}

TEST_F(StopWhileStarting, AStopOfAnAxisThatItDoesNotUseIsNoneOfItsBusiness) {
    TestMachine m{config(true)};
    m.replayed.leave_out();  // its start() reaches out of it
    SlowStarter::meanwhile = [&] { m.machine->request_stop(1); };
    ASSERT_TRUE(m.up());
    EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s));
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::start_withdrawn)));
}

TEST_F(StopWhileStarting, AStopDuringTheBringUpKeepsAProgramThatStartsByItselfFromStarting) {
    TestMachine m{config(true)};
    m.replayed.leave_out();  // its start() reaches out of it
    m.machine->request_stop(StopLevels::all_axes);
    ASSERT_TRUE(m.up());
    expect_never_moves(m);
    expect_starts(m);
}

TEST_F(StopWhileStarting, AStartThatComesToItsTurnBehindAStopIsStale) {
    TestMachine m{config(false)};
    m.replayed.leave_out();  // its start() reaches out of it
    ASSERT_TRUE(m.up());
    OperatorCommand start;
    start.action = OperatorAction::program_start;
    start.index = 0;
    start.after = m.machine->levels_raised();
    m.machine->request_stop(0);
    EXPECT_EQ(m.command(start).answer, Answer::stale);
    m.run(1s);
    EXPECT_EQ(m.state().programs[0], ProgramState::stopped);
    start.after = m.machine->levels_raised();
    EXPECT_EQ(m.command(start).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity == 50.0; }, 5s));
}

// --- the cycle, seen from outside ------------------------------------------------------------------------------------------------------

TEST(Advance, ACycleThatStandsIsSeenAfterItsPatienceAndOneThatRunsIsNot) {
    TestMachine m{machine_config(1)};
    ASSERT_TRUE(m.up());
    AdvanceWatch watch{*m.machine};
    for (int i = 0; i < 1000; ++i) {
        m.run(1ms);
        ASSERT_FALSE(watch.look(m.clock.now()));
    }
    auto now = m.clock.now();
    for (const auto end = now + watch.patience() - 10ms; now < end; now += 10ms) ASSERT_FALSE(watch.look(now));
    std::optional<StuckCycle> stuck;
    for (const auto end = now + 50ms; now < end && !stuck; now += 10ms) stuck = watch.look(now);
    ASSERT_TRUE(stuck);
    EXPECT_GE(stuck->lasts, watch.patience());
    EXPECT_EQ(stuck->program, "") << "it does not stand in a program";
    m.run(1ms);
    EXPECT_FALSE(watch.look(now + 10ms));
}

// Before its first cycle a machine shows nothing that could be old, however long the start takes.
TEST(Advance, BeforeTheFirstCycleNothingIsStuck) {
    TestMachine m{machine_config(1)};
    AdvanceWatch watch(*m.machine);
    for (Instant now{}; now < Instant{} + 3s; now += 50ms) EXPECT_FALSE(watch.look(now));
}

TEST(Advance, WhoDidNotLookForLongAccusesNobody) {
    TestMachine m{machine_config(1)};
    ASSERT_TRUE(m.up());
    AdvanceWatch watch{*m.machine};
    EXPECT_FALSE(watch.look(m.clock.now()));
    EXPECT_FALSE(watch.look(m.clock.now() + 10s)) << "the process was stopped as a whole";
}

TEST(End, ComesInThePromisedTimeWhenTheCycleStands) {
    TestMachine m{machine_config(1)};
    ASSERT_TRUE(m.up());
    EndWatch watch{*m.machine};
    auto now = m.clock.now();
    for (const auto end = now + 60s; now < end; now += 20ms) ASSERT_FALSE(watch.look(now)) << "nobody has asked for an end";
    EXPECT_TRUE(watch.stuck()) << "it is seen all the same";
    m.machine->request_shutdown();
    const auto asked = now;
    std::optional<Error> hopeless;
    for (; now < asked + 60s && !hopeless; now += 20ms) hopeless = watch.look(now);
    ASSERT_TRUE(hopeless);
    EXPECT_LE(now - asked, m.machine->longest_stop() + 100ms);
    EXPECT_NE(hopeless->what.find("has not advanced"), std::string::npos) << hopeless->what;
}

class TwoTasks final : public Program {
public:
    void declare(Declaration& d) override {
        d.task<&TwoTasks::scan>("main");
        d.task<&TwoTasks::scan>("plan");
    }
    void scan(TaskContext&) {}
};

TEST(End, NamesTheSlowTaskThatNeverComesBack) {
    auto config = with_program(1, &entry_of<TwoTasks>);
    TaskConfig slow;
    slow.name = "plan";
    slow.program = "p";
    slow.divisor = 2;
    slow.overrun = OverrunReaction::count;
    config.tasks.push_back(slow);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    // It was released and nobody runs it: to the machine that is a task that does not come back.
    auto now = m.clock.now();
    const auto cycles = [&](int count) {
        for (; count > 0; --count, now += 1ms) m.machine->cycle({now, now, 0});
    };
    cycles(4);
    ASSERT_EQ(m.machine->program_at_work(), "task 'plan' of program 'p'");
    EndWatch watch{*m.machine};
    m.machine->request_shutdown();
    std::optional<Error> hopeless;
    for (int i = 0; i < 1000 && m.machine->phase() != MachinePhase::stopped; ++i) {
        cycles(1);
        hopeless = watch.look(now);
    }
    ASSERT_EQ(m.machine->phase(), MachinePhase::stopped) << "the axes do not wait for it";
    ASSERT_FALSE(hopeless);
    watch.only_threads_left();
    for (int i = 0; i < 10'000 && !hopeless; ++i) {
        cycles(1);
        hopeless = watch.look(now);
    }
    ASSERT_TRUE(hopeless);
    EXPECT_NE(hopeless->what.find("task 'plan' of program 'p' does not return"), std::string::npos) << hopeless->what;
}

}  // namespace
}  // namespace taktwerk::runtime::testing

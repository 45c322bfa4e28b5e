// The same machine on its real threads, for about a second: cycle, slower task, service and operator beside each other. Its worth is
// under the thread sanitizer (preset tsan). Nothing here depends on how well the host keeps the cycle.

#include <atomic>

#include "fb_library/all_blocks.hpp"
#include "runtime/recording/row_cursor.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "tests/patience.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// A base task that moves x, and a slower one that moves y and writes an output.
class TwoThreads final : public Program {
public:
    AxisRef x, y;
    fb::MC_Power power_x, power_y;
    fb::MC_MoveVelocity move_x;
    fb::MC_MoveRelative move_y;
    Output<bool> lamp;
    std::int64_t scans = 0;
    std::int64_t slow_scans = 0;  // the slower task's alone, not monitored
    void declare(Declaration& d) override {
        x = d.axis("x");
        y = d.axis("y");
        lamp = d.output("lamp");
        d.monitor("scans", scans);
        d.alarm(0, Reaction::warn, "a warning", "警告", "nothing to do");
        d.task<&TwoThreads::base>("base");
        d.task<&TwoThreads::slow>("slow");
    }
    void start() override {
        scans = slow_scans = 0;
        move_x = {};
        move_y = {};
    }
    void stop() override { scans = -1; }
    void base(TaskContext& ctx) {
        ++scans;
        power_x.Axis = move_x.Axis = x;
        power_x.Enable = true;
        power_x(ctx);
        move_x.Velocity = 20;
        move_x.Execute = power_x.Status;
        move_x(ctx);
    }
    void slow(TaskContext& ctx) {
        ++slow_scans;
        power_y.Axis = move_y.Axis = y;
        power_y.Enable = true;
        power_y(ctx);
        move_y.Distance = 1;
        move_y.Velocity = 20;
        move_y.Execute = power_y.Status && !move_y.Done && !move_y.Error && !move_y.CommandAborted;
        move_y(ctx);
        ctx.set(lamp, slow_scans % 2 == 0);
        ctx.alarm(0, slow_scans % 3 == 0);
    }
};

/// No base task: the slower one's variables go through its own latch.
class OnlySlow final : public Idle {};

MachineConfig realtime_config() {
    auto config = machine_config(2);
    config.cycle = 4ms;
    config.bus.cycle = 4ms;
    config.simulation.supervision = Supervision::relaxed;
    config.realtime.priority = 0;
    config.realtime.lock_memory = false;
    config.start_mode = Mode::automatic;
    config.programs.push_back({"p", {}, &entry_of<TwoThreads>, {}, true});
    config.programs.push_back({"q", {}, &entry_of<OnlySlow>, {}, true});
    TaskConfig task;
    task.overrun = OverrunReaction::count;
    task.divisor = 2;
    task.program = "p";
    task.name = "slow";
    config.tasks.push_back(task);
    task.program = "q";
    task.name = "main";
    config.tasks.push_back(task);
    return config;
}

TEST(Realtime, CycleTasksServiceAndOperatorRunBesideEachOther) {
    auto config = realtime_config();
    SystemClock clock;
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u) << std::get<1>(built)[0].text();
    auto& machine = *std::get<0>(built);
    RowCursor trace{machine.signals()};
    RealtimeRunner runner{machine, &world};
    ASSERT_TRUE(runner.start().ok());

    Instant up{};
    int step = 0;
    std::uint64_t sequence = 0;
    bool ran = false, stopped_once = false;
    std::size_t rows = 0, answers = 0;
    Patience patience{60'000};  // a call about each millisecond
    const auto served = runner.serve([&](Instant now) {
        if (machine.phase() != MachinePhase::running) return patience.lasts(true);
        if (up == Instant{}) up = now;
        while (!trace.next().empty()) ++rows;
        while (machine.next_answer()) ++answers;
        if (const auto* s = machine.latest()) {
            ran = ran || (s->axes[0].set_velocity > 0 && s->tasks[1].releases > 0 && s->variables[1] > 0);
            stopped_once = stopped_once || s->programs[0] == ProgramState::stopped;
            for (std::size_t i = 0; i < s->alarm_count; ++i) (void)machine.describe(s->alarms[i].fact);
        }
        (void)machine.bus_progress();
        // Every 50 ms something is asked: stop and start programs, a parameter, an alarm acknowledged, a stop.
        if (now - up > 50ms * (step + 1)) {
            OperatorCommand c;
            c.sequence = ++sequence;
            c.index = static_cast<std::uint16_t>(step / 5 % 2);
            c.value = step % 10;
            constexpr OperatorAction turn[] = {OperatorAction::set_parameter, OperatorAction::stop, OperatorAction::acknowledge_alarms,
                                               OperatorAction::program_stop, OperatorAction::program_start};
            c.action = turn[step++ % 5];
            if (c.action == OperatorAction::set_parameter) c.index = 0;
            machine.submit(c);
        }
        return now - up < 1500ms;
    });
    runner.finish();

    EXPECT_TRUE(served.ok()) << served.error().text();
    EXPECT_EQ(machine.phase(), MachinePhase::stopped);
    EXPECT_EQ(machine.bus().phase(), ecat::Master::Phase::stopped);
    EXPECT_TRUE(ran) << "both tasks of p, and q, must have run";
    EXPECT_TRUE(stopped_once);
    EXPECT_GT(rows, 50u);
    EXPECT_GT(answers, 10u);
    EXPECT_NE(world.drive("x")->state(), axes::sim::Cia402Axis::State::enabled);
}

TEST(Realtime, AnEndDuringTheBringUpTakesTheBusDownInOrder) {
    auto config = realtime_config();
    SystemClock clock;
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u);
    auto& machine = *std::get<0>(built);
    RealtimeRunner runner{machine, &world};
    ASSERT_TRUE(runner.start().ok());
    int calls = 0;
    const auto served = runner.serve([&](Instant) { return ++calls < 20; });
    runner.finish();
    ASSERT_FALSE(served) << "a machine that never ran has not ended well";
    EXPECT_EQ(served.error().code, RealtimeRunner::ended_early);
    EXPECT_EQ(machine.bus().phase(), ecat::Master::Phase::stopped);
    EXPECT_EQ(machine.phase(), MachinePhase::stopped);
}

}  // namespace
}  // namespace taktwerk::runtime::testing

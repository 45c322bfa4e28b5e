// Slower tasks on their real threads: the same machine as everywhere, in real time. Nothing here depends on how well the host keeps the cycle; what
// the images are worth shows under the thread sanitizer, too (preset tsan).

#include <sched.h>

#include <array>
#include <atomic>

#include "core/realtime.hpp"
#include "runtime/alarms.hpp"
#include "runtime/recording/task_times_record.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "runtime/run/task_threads.hpp"
#include "tests/machines/replay_check.hpp"
#include "tests/patience.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;

std::atomic<bool> hangs{false};      ///< the slower task computes without an end
std::atomic<int> task_thread{0};     ///< the kernel's number of its thread
std::atomic<std::uint64_t> torn{0};  ///< something changed within a run
std::atomic<std::uint64_t> seen{0};  ///< different images
std::atomic<std::uint64_t> told{0};  ///< times that were not 0

/// Moves x from a slower task, which comes back only while `hangs` is FALSE. What it is told of its times is on the lamp, so that a replay that is
/// told other ones shows it.
class Looping final : public Program {
public:
    AxisRef x;
    Output<bool> lamp;
    fb::MC_Power power;
    fb::MC_MoveVelocity move;
    void declare(Declaration& d) override {
        x = d.axis("x");
        lamp = d.output("lamp");
        d.task<&Looping::scan>("loop");
    }
    void scan(TaskContext& ctx) {
        task_thread = this_thread_number();
        power.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        move.Velocity = 50;
        move.Execute = power.Status;
        move(ctx);
        const auto& mine = ctx.task();
        if (mine.run.last > Duration{}) ++told;
        ctx.set(lamp, (mine.run.last + mine.run.maximum + mine.lateness).count() % 2 != 0);
        while (hangs.load(std::memory_order_relaxed)) {}
    }
};

/// Moves y from the cycle.
class Going final : public Program {
public:
    AxisRef y;
    fb::MC_Power power;
    fb::MC_MoveVelocity move;
    Output<bool> odd;
    void declare(Declaration& d) override {
        y = d.axis("y");
        odd = d.output("odd");
        d.task<&Going::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = move.Axis = y;
        power.Enable = true;
        power(ctx);
        move.Velocity = 60;
        move.Execute = power.Status;
        move(ctx);
        ctx.set(odd, ctx.task().run.last.count() % 2 != 0);
    }
};

void add_output(MachineConfig& config, const std::string& name, std::uint8_t channel) {
    IoPoint p;
    p.name = name;
    p.direction = IoDirection::output;
    p.slave = "io";
    p.index = 0x7000;
    p.sub = channel;
    config.io.push_back(p);
}

MachineConfig real_machine() {
    auto config = machine_config(2);
    config.cycle = 4ms;
    config.bus.cycle = 4ms;
    config.simulation.supervision = Supervision::relaxed;
    config.realtime.priority = 0;
    config.realtime.lock_memory = false;
    config.start_mode = Mode::automatic;
    return config;
}

MachineConfig looping_machine() {
    auto config = real_machine();
    add_output(config, "odd", 2);
    add_program(config, "p", &entry_of<Looping>, 5);
    add_program(config, "q", &entry_of<Going>);
    config.tasks[0].name = "loop";
    config.tasks[0].overrun = OverrunReaction::count;
    config.tasks[0].watchdog = 600ms;  // long beside what a busy host does to an ordinary thread
    return config;
}

/// Runs a machine in real time until `done` says so; false: it did not within the patience.
template <class Each>
bool run(RealtimeRunner& runner, Machine& machine, Each each, int calls = 60'000) {
    Patience patience{calls};  // a call about each millisecond
    bool done = false;
    const auto served = runner.serve([&](Instant) {
        if (machine.phase() != MachinePhase::running) return patience.lasts(true);
        done = done || each();
        return patience.lasts(!done);
    });
    EXPECT_TRUE(served.ok()) << served.error().text();
    return done;
}

const ActiveAlarm* find(const Snapshot& s, MachineAlarm alarm) {
    for (std::size_t i = 0; i < s.alarm_count; ++i)
        if (s.alarms[i].fact.id == id(alarm)) return &s.alarms[i];
    return nullptr;
}

// The acceptance of it all: an endless loop is its program's fault. Recorded on its way, and the recording does the same again, byte by byte.
TEST(TaskThreads, AnEndlessLoopStopsItsProgramAloneAndTheRecordingIsTheSameAgain) {
    hangs = false;
    told = 0;
    const auto config = looping_machine();
    SystemClock clock;
    World world{config, clock.now()};
    RecordedInMemory recorded;
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u) << std::get<1>(built)[0].text();
    auto& machine = *std::get<0>(built);
    recorded.watch(machine, nullptr, clock.now(), RecordedThreads::several);
    RealtimeRunner runner{machine, &world};
    runner.record_in_step();
    ASSERT_TRUE(runner.start().ok());

    enum class At { moving, hanging, stopping_y, coming_back, resetting } at = At::moving;
    double slowest_y = 60;
    bool y_off = false, x_stood = false, still_fault = false;
    std::string words, at_work;
    Instant since{};
    std::uint64_t sequence = 0;
    const bool done = run(runner, machine, [&] {
        recorded.drain();
        const auto* s = machine.latest();
        if (s == nullptr) return false;
        const auto& x = s->axes[0];
        const auto& y = s->axes[1];
        if (at == At::hanging || at == At::coming_back) {
            if (at == At::hanging) slowest_y = std::min(slowest_y, y.set_velocity);
            y_off = y_off || !y.powered;
        }
        switch (at) {
            case At::moving:
                if (x.set_velocity != 50 || y.set_velocity != 60 || s->tasks[0].releases < 10) return false;
                hangs = true;
                at = At::hanging;
                return false;
            case At::hanging:
                if (find(*s, MachineAlarm::task_watchdog) == nullptr || x.state != AxisState::Disabled) return false;
                words = machine.describe(find(*s, MachineAlarm::task_watchdog)->fact).source;
                x_stood = x.set_velocity == 0;
                at_work = machine.program_at_work();
                machine.request_stop(1);
                at = At::stopping_y;
                return false;
            case At::stopping_y:
                if (y.set_velocity != 0) return false;
                still_fault = s->programs[0] == ProgramState::fault;
                hangs = false;
                since = clock.now();
                at = At::coming_back;
                return false;
            case At::coming_back:
                if (!machine.program_at_work().empty() || clock.now() - since < 100ms) return false;
                for (const auto action : {OperatorAction::reset, OperatorAction::program_start}) {
                    OperatorCommand c;
                    c.action = action;
                    if (action == OperatorAction::program_start) c.index = 0;
                    c.sequence = ++sequence;
                    machine.submit(c);
                }
                at = At::resetting;
                return false;
            case At::resetting: return s->axes[0].set_velocity == 50;
        }
        return false;
    });
    const bool as_expected = at == At::resetting;
    hangs = false;
    runner.finish();
    recorded.drain();

    ASSERT_TRUE(done) << "it got as far as step " << static_cast<int>(at);
    EXPECT_TRUE(as_expected);
    EXPECT_EQ(slowest_y, 60) << "the other program's axis slowed down";
    EXPECT_FALSE(y_off) << "the other program's axis lost its power";
    EXPECT_EQ(words, "task p.loop");
    EXPECT_EQ(at_work, "task 'loop' of program 'p'");
    EXPECT_TRUE(x_stood);
    EXPECT_TRUE(still_fault);
    EXPECT_EQ(machine.phase(), MachinePhase::stopped);
    EXPECT_GT(told, 10u) << "in real time it is told how long it took";

    auto& recording = recorded.recording();
    ASSERT_EQ(recording.lost, 0u);
    const auto replayed = replay_all(config, recording);
    EXPECT_TRUE(replayed.identical()) << replayed.text();
    EXPECT_GT(replayed.cycles, 50u);
    // The control: the times are in it, and are what the lamp shows.
    const auto times = std::ranges::find_if(
        recording.frames, [n = 0](const Recording::Frame& frame) mutable { return frame.channel == task_times_channel && ++n == 20; });
    ASSERT_NE(times, recording.frames.end());
    recording.bytes[times->offset + 10] ^= std::byte{1};  // the last nanosecond of the last run
    EXPECT_FALSE(replay_all(config, recording).identical());
}

/// Four outputs that always change together, from the cycle.
class Writes final : public Program {
public:
    std::array<Output<bool>, 4> all;
    bool on = false;
    void declare(Declaration& d) override {
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = d.output("w" + std::to_string(i));
        d.task<&Writes::scan>("main");
    }
    void scan(TaskContext& ctx) {
        on = !on;
        for (const auto output : all) ctx.set(output, on);
    }
};

/// Two slower tasks look at them through all of a run, and each writes two outputs of its own that always change together: the base task looks at
/// those.
class Looks final : public Program {
public:
    std::array<Output<bool>, 4> all, mine;
    AxisRef x;
    std::array<bool, 2> on{};
    std::array<bool, 2> last{};
    void declare(Declaration& d) override {
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = d.output("w" + std::to_string(i));
        for (std::size_t i = 0; i < mine.size(); ++i) mine[i] = d.output("m" + std::to_string(i));
        x = d.axis("x");
        d.task<&Looks::first>("first");
        d.task<&Looks::second>("second");
        d.task<&Looks::check>("check");
    }
    void first(TaskContext& ctx) { look(ctx, 0); }
    void second(TaskContext& ctx) { look(ctx, 1); }
    void look(TaskContext& ctx, std::size_t which) {
        const bool was = ctx.get(all[0]);
        const double position = ctx.view(x)->set_position;
        if (was != last[which]) ++seen;
        last[which] = was;
        on[which] = !on[which];
        ctx.set(mine[2 * which], on[which]);
        for (int i = 0; i < 20'000; ++i) {  // longer than a cycle takes to write them
            for (const auto output : all)
                if (ctx.get(output) != was) ++torn;
            if (ctx.view(x)->set_position != position) ++torn;
        }
        ctx.set(mine[2 * which + 1], on[which]);
    }
    void check(TaskContext& ctx) {
        if (ctx.get(mine[0]) != ctx.get(mine[1]) || ctx.get(mine[2]) != ctx.get(mine[3])) ++torn;
    }
};

TEST(TaskThreads, EachTaskHasImagesOfItsOwnAndNobodySeesHalfOfOne) {
    torn = seen = 0;
    auto config = real_machine();
    for (std::uint8_t i = 0; i < 4; ++i) add_output(config, "w" + std::to_string(i), static_cast<std::uint8_t>(2 + i));
    for (std::uint8_t i = 0; i < 3; ++i) add_output(config, "m" + std::to_string(i), static_cast<std::uint8_t>(6 + i));
    std::ranges::find(config.io, "lamp", &IoPoint::name)->name = "m3";
    add_program(config, "writes", &entry_of<Writes>);
    add_program(config, "looks", &entry_of<Looks>);
    config.tasks[1].name = "check";
    for (const auto* name : {"first", "second"}) {
        TaskConfig task;
        task.name = name;
        task.program = "looks";
        task.divisor = std::string_view(name) == "first" ? 2 : 3;
        task.overrun = OverrunReaction::count;
        config.tasks.push_back(task);
    }
    SystemClock clock;
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u) << std::get<1>(built)[0].text();
    auto& machine = *std::get<0>(built);
    RealtimeRunner runner{machine, &world};
    ASSERT_TRUE(runner.start().ok());
    const bool done = run(runner, machine, [&] {
        const auto* s = machine.latest();
        return s != nullptr && s->tasks[1].releases > 60 && s->tasks[2].releases > 60 && seen > 20;
    });
    runner.finish();
    EXPECT_TRUE(done) << seen << " different images";
    EXPECT_EQ(torn, 0u);
}

// The kernel gives real-time threads 950 ms of a second: who computes without an end must not have them.
TEST(TaskThreads, WhoComputesTooLongLosesItsPriorityUntilItComesBack) {
    hangs = false;
    task_thread = 0;
    auto config = looping_machine();
    config.realtime.priority = 20;
    config.tasks[0].watchdog = 100ms;
    SystemClock clock;
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u) << std::get<1>(built)[0].text();
    auto& machine = *std::get<0>(built);
    RealtimeRunner runner{machine, &world};
    const auto report = runner.start();
    ASSERT_TRUE(report.ok());
    const auto item =
        std::ranges::find_if(report->items, [](const RealtimeItem& i) { return i.what.find("slower tasks") != std::string::npos; });
    ASSERT_NE(item, report->items.end());
    EXPECT_EQ(item->what, "SCHED_FIFO for slower tasks: p.loop 18") << "below the cycle, and below the watch over it";
    if (!item->granted) {
        runner.finish();
        GTEST_SKIP() << "no real-time priorities here: " << item->reason;
    }
    const auto policy = [] { return ::sched_getscheduler(task_thread) & ~SCHED_RESET_ON_FORK; };
    const auto priority = [] {
        sched_param now{};
        ::sched_getparam(task_thread, &now);
        return now.sched_priority;
    };
    int before = -1, before_priority = -1, hanging = -1, after = -1;
    bool lost = false;
    const bool done = run(runner, machine, [&] {
        const auto* s = machine.latest();
        if (s == nullptr || task_thread == 0 || s->tasks[0].releases < 5) return false;
        if (before < 0) {
            before = policy();
            before_priority = priority();
            hangs = true;
        }
        if (hangs && policy() == SCHED_OTHER) {
            hanging = policy();
            lost = s->programs[0] == ProgramState::fault || lost;
            if (lost) hangs = false;
        }
        if (lost && policy() == SCHED_FIFO) after = priority();
        return after > 0;
    });
    hangs = false;
    runner.finish();
    EXPECT_TRUE(done);
    EXPECT_EQ(before, SCHED_FIFO);
    EXPECT_EQ(before_priority, 18);
    EXPECT_EQ(hanging, SCHED_OTHER);
    EXPECT_EQ(after, 18);
}

/// Time that passes when somebody sleeps, and how often that was; ends after ten seconds.
class CountingClock final : public Clock {
public:
    explicit CountingClock(std::atomic<bool>& stop) : stop_(stop) {}
    [[nodiscard]] Instant now() const noexcept override { return now_.load(); }
    void sleep_until(Instant deadline) noexcept override {
        ++sleeps;
        now_ = std::max(deadline, now_.load());
        if (now_.load() > Instant{} + 110s) stop_ = true;
    }
    std::atomic<int> sleeps{0};

private:
    std::atomic<Instant> now_{Instant{} + 100s};
    std::atomic<bool>& stop_;
};

// Four looks a cycle are 10,000 wake-ups in these ten seconds. An eighth of the period, 2.5 ms, are 4,000: it costs next to nothing, and
// the first run behind a start is early enough.
TEST(TaskThreads, TheTaskOfAProgramAtRestSeldomLooksForItsRelease) {
    auto config = looping_machine();
    config.start_mode = Mode::manual;
    TestMachine m{config};
    std::atomic<bool> stop{false};
    CountingClock clock{stop};
    TaskThreads threads{*m.machine, clock};
    (void)threads.start(stop, 0);
    threads.join();
    EXPECT_NEAR(clock.sleeps, 4000, 10);
}

}  // namespace
}  // namespace taktwerk::runtime::testing

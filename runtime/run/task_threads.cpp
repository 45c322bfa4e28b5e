#include "runtime/run/task_threads.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/math.hpp"
#include "runtime/run/task_priorities.hpp"
#include "runtime/tasks/code_at_work.hpp"
#include "runtime/tasks/task_watch.hpp"

namespace taktwerk::runtime {

namespace {

/// Between two looks whether the run has ended: somebody may be waiting for the thread.
constexpr Duration longest_sleep = std::chrono::milliseconds{50};
/// A program at rest may start at any time, and its task's first run begins within an eighth of a period.
constexpr Duration longest_rest = std::chrono::milliseconds{10};
constexpr std::size_t touched_stack = std::size_t{128} << 10;

}  // namespace

RealtimeReport TaskThreads::start(const std::atomic<bool>& stop, int cycle_priority) {
    std::vector<TaskConfig> tasks;
    for (std::size_t i = 0; i < machine_.slow_task_count(); ++i) tasks.push_back(machine_.slow_task(i));
    const auto priorities = task_priorities(tasks, cycle_priority);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        auto& place = places_.emplace_back();
        place.task = i;
        place.priority = priorities[i];
        const auto watchdog = TaskWatch::watchdog_of(tasks[i], machine_.config());
        // Multiplied by what it is compared with, for a watchdog of hours times a sensitivity of thousands is more than a Duration holds.
        const auto sensitivity = std::max<Duration::rep>(1, tasks[i].watchdog_sensitivity);
        if (watchdog > Duration{} && watchdog < longest_at_priority)
            place.at_priority = std::min(longest_at_priority, watchdog * sensitivity);
    }
    for (auto& place : places_) place.thread = std::thread{[this, &place, &stop] { run(place, stop); }};

    RealtimeReport report;
    std::string names;
    Result<void> granted;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const auto& place = places_[i];
        while (!place.ready.load(std::memory_order_acquire)) std::this_thread::yield();
        if (priorities[i] == 0) continue;
        names += fmt::format("{}{}.{} {}", names.empty() ? "" : ", ", tasks[i].program, tasks[i].name, priorities[i]);
        if (!place.granted) granted = place.granted;
    }
    if (!names.empty())
        report.items.push_back(realtime_item(fmt::format("SCHED_FIFO for slower tasks: {}", names), granted,
                                             "any other program on this computer can make them miss their releases"));
    return report;
}

void TaskThreads::run(Place& place, const std::atomic<bool>& stop) {
    const CrashStack crash_stack;
    place.number.store(this_thread_number(), std::memory_order_relaxed);
    if (place.priority > 0) {
        // Without them a run is slower at times, and its priority is what was asked for.
        (void)prefault_stack(touched_stack);
        (void)set_timer_slack(Duration{1});
        place.granted = set_fifo_priority(place.priority);
        if (!place.granted) place.priority = 0;
    }
    place.ready.store(true, std::memory_order_release);
    math::set_stepping_thread_float_environment();
    while (!stop.load(std::memory_order_acquire)) {
        place.began.store(clock_.now(), std::memory_order_relaxed);
        const bool ran = machine_.run_slow_task(place.task);
        place.began.store(Instant{}, std::memory_order_release);
        if (place.taken.exchange(false, std::memory_order_acq_rel)) (void)set_fifo_priority(place.priority);
        if (ran) wait_for_release(place, stop);
        else clock_.sleep_until(clock_.now() + until_next_look(place, clock_.now()));
    }
}

// Four looks in each cycle while a release is due; where none has come for two periods its program rests, or the cycle stands still.
Duration TaskThreads::until_next_look(const Place& place, Instant now) const {
    const Duration often = machine_.config().cycle / 4;
    const Duration period = machine_.config().cycle * static_cast<Duration::rep>(machine_.slow_task(place.task).divisor);
    const bool rests = now - machine_.slow_task_released(place.task) > 2 * period;
    return rests ? std::max(often, std::min(period / 8, longest_rest)) : often;
}

// The cycle never wakes anybody (that would be a system call): a task looks for its release itself, often enough. It need not look before a whole
// period has passed, but for what the bus' clock may shorten it by: a hundredth of each cycle (docs/architecture.md, "Time").
void TaskThreads::wait_for_release(const Place& place, const std::atomic<bool>& stop) {
    const Duration cycle = machine_.config().cycle;
    const Duration period = cycle * static_cast<Duration::rep>(machine_.slow_task(place.task).divisor);
    const Instant earliest = machine_.slow_task_released(place.task) + period - period / 50 - cycle;
    for (auto now = clock_.now(); now < earliest && !stop.load(std::memory_order_acquire); now = clock_.now())
        clock_.sleep_until(std::min(earliest, now + longest_sleep));
}

void TaskThreads::look(Instant now) {
    for (auto& place : places_) {
        const auto began = place.began.load(std::memory_order_acquire);
        if (place.priority == 0 || began == Instant{} || now - began < place.at_priority) continue;
        if (place.taken.load(std::memory_order_acquire)) continue;
        // In this order: a run that ends in between finds the flag behind its next look, and takes its priority back.
        if (!take_priority(place.number.load(std::memory_order_relaxed))) continue;
        place.taken.store(true, std::memory_order_release);
    }
}

void TaskThreads::join() {
    for (auto& place : places_)
        if (place.thread.joinable()) place.thread.join();
    // The places stay: the watch looks at them until everything else is home.
}

}  // namespace taktwerk::runtime

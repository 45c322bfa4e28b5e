#include "runtime/run/realtime_runner.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/math.hpp"
#include "runtime/run/bring_up_patience.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

namespace {

constexpr Duration service_period = std::chrono::milliseconds{1};
constexpr Duration bring_up_patience = std::chrono::seconds{30};
constexpr Duration bus_down_patience = std::chrono::seconds{5};
/// With the request before and the last one of these (2 s each at most, `timeout`) less than the watch waits for threads.
constexpr Duration last_outputs = std::chrono::milliseconds{500};
constexpr Duration watch_period = std::chrono::milliseconds{20};

}  // namespace

RealtimeRunner::RealtimeRunner(Machine& machine, World* world)
    : machine_(machine), world_(world), end_watch_(machine), fault_watch_(machine), tasks_(machine, clock_) {
    const auto& wanted = machine.config().realtime;
    request_.priority = wanted.priority > 0 ? std::optional<int>{wanted.priority} : std::nullopt;
    request_.cpus = wanted.cpus;
    request_.lock_memory = wanted.lock_memory;
    machine.tell_measured_times();
}

RealtimeRunner::~RealtimeRunner() { finish(); }

void RealtimeRunner::cycle_thread() {
    const CrashStack crash_stack;
    report_ = prepare_cycle_thread(request_);
    cycle_priority_ = has_fifo_priority() ? request_.priority.value_or(0) : 0;
    math::set_stepping_thread_float_environment();
    fault_watch_.this_is_it();
    ready_.store(true, std::memory_order_release);
    CyclicConfig config;
    config.period = machine_.config().cycle;
    CyclicThread loop{clock_, config};
    loop.run(
        [this, &loop](const CycleTiming& timing) {
            if (world_) world_->apply_events(timing.scheduled);
            machine_.cycle({timing.scheduled, timing.woken, static_cast<std::uint32_t>(timing.missed)});
            if (in_step_) in_step_->between_cycles();
            loop.shift_grid(machine_.bus().period_correction());
        },
        stop_);
    counters_ = loop.counters();
}

// Work that may wait. The last round comes after the cycle has ended: a program's stop(), the places where the axes came to rest.
void RealtimeRunner::beside(const std::function<void(Instant)>& work) {
    const CrashStack crash_stack;
    bool ending = false;
    do {
        ending = stop_.load(std::memory_order_acquire) && !cycle_running_.load(std::memory_order_acquire);
        work(clock_.now());
        if (!ending) clock_.sleep_until(clock_.now() + service_period);
    } while (!ending);
}

// Its last round comes after the cycle has ended, too: then the outputs have their safe values.
void RealtimeRunner::modbus_thread(std::size_t device) {
    beside([this, device](Instant now) { machine_.service_modbus(device, now); });
    const auto until = clock_.now() + last_outputs;
    while (clock_.now() < until && machine_.end_modbus(device, clock_.now())) {}
}

// Above the tasks: it has to get a processor while one of them computes without an end. Where the cycle has no priority, tasks have none either.
void RealtimeRunner::guard_thread() {
    if (cycle_priority_ > 1) (void)set_fifo_priority(cycle_priority_ - 1);
    while (!all_home_.load(std::memory_order_acquire)) {
        tasks_.look(clock_.now());
        clock_.sleep_until(clock_.now() + watch_period);
    }
}

// An ordinary thread: of a processor that a hung cycle holds the kernel leaves a share to these alone, and nothing to a real-time priority below the cycle's.
void RealtimeRunner::watch_thread() {
    bool was_stuck = false, given_up = false;
    while (!all_home_.load(std::memory_order_acquire)) {
        const auto hopeless = end_watch_.look(clock_.now());
        const auto& stuck = end_watch_.stuck();
        if (stuck.has_value() != was_stuck && on_stuck) on_stuck(stuck ? &*stuck : nullptr);
        was_stuck = stuck.has_value();
        if (hopeless && !given_up && give_up) give_up(*hopeless);
        given_up = given_up || hopeless;
        fault_watch_.look(clock_.now());
        clock_.sleep_until(clock_.now() + watch_period);
    }
}

Result<RealtimeReport> RealtimeRunner::start() {
    auto whole = prepare_process(request_, latency_);
    fault_watch_.memory_is_locked(
        std::any_of(whole.items.begin(), whole.items.end(), [](const auto& item) { return item.what == memory_locked && item.granted; }));
    machine_.signals().touch();  // where memory may not be locked, too
    cycle_running_.store(true, std::memory_order_release);
    cycle_ = std::thread{[this] { cycle_thread(); }};
    while (!ready_.load(std::memory_order_acquire)) std::this_thread::yield();
    whole.items.insert(whole.items.end(), report_.items.begin(), report_.items.end());
    const auto tasks = tasks_.start(stop_, cycle_priority_);
    whole.items.insert(whole.items.end(), tasks.items.begin(), tasks.items.end());
    if (machine_.config().realtime.required && !whole.all_granted()) {
        finish();
        return Error{"realtime.refused", "realtime", "the configuration requires real time, and the system refuses it:\n" + whole.text(),
                     "give the process CAP_SYS_NICE and CAP_IPC_LOCK, or set `realtime.required: false`"};
    }
    beside_.emplace_back([this] { beside([this](Instant) { machine_.service_programs(); }); });
    beside_.emplace_back([this] { beside([this](Instant now) { machine_.service_disk(now); }); });
    if (machine_.group_count() > 0 && !in_step_) beside_.emplace_back([this] { beside([this](Instant) { machine_.service_groups(); }); });
    for (std::size_t i = 0; i < machine_.modbus_count(); ++i) beside_.emplace_back([this, i] { modbus_thread(i); });
    if (machine_.slow_task_count() > 0) guard_ = std::thread{[this] { guard_thread(); }};
    watch_ = std::thread{[this] { watch_thread(); }};
    return whole;
}

void RealtimeRunner::service() {
    next_service_ = std::max(next_service_ + service_period, clock_.now());
    clock_.sleep_until(next_service_);
    if (!in_step_) machine_.service_bus(clock_.now());
}

bool RealtimeRunner::asked(const std::function<bool(Instant)>& keep_on) {
    const auto mine = service_side();
    return keep_on(clock_.now());
}

/// Where it has a thread of its own, that is the caller's.
std::unique_lock<std::mutex> RealtimeRunner::service_side() { return in_step_ ? in_step_->look() : std::unique_lock<std::mutex>{}; }

Result<void> RealtimeRunner::arm() {
    if (!in_step_) return machine_.arm();
    in_step_->arm();
    while (!in_step_->armed()) service();
    return *in_step_->armed();
}

Result<void> RealtimeRunner::serve(const std::function<bool(Instant)>& keep_on) {
    next_service_ = clock_.now();
    if (in_step_) in_step_->start_bus();
    else machine_.start_bus();
    auto up = bring_up(keep_on);
    while (up && machine_.phase() != MachinePhase::stopped) {
        service();
        if (!asked(keep_on)) machine_.request_shutdown();
    }
    // However it ended: slaves are left in INIT, not to their watchdogs.
    if (in_step_) in_step_->stop_bus();
    else machine_.stop_bus();
    const auto down = clock_.now() + bus_down_patience;
    while (machine_.bus().phase() != ecat::Master::Phase::stopped && clock_.now() < down) service();
    return up;
}

Result<void> RealtimeRunner::bring_up(const std::function<bool(Instant)>& keep_on) {
    const Duration patience = bring_up_patience + patience_with(machine_.bus().slave_count(), machine_.config().cycle);
    const auto until = clock_.now() + patience;
    while (!machine_.bus_operational()) {
        service();
        {
            const auto mine = service_side();
            if (auto failure = machine_.bus_failure()) return *failure;
        }
        if (!asked(keep_on)) machine_.request_shutdown();
        const auto mine = service_side();
        if (machine_.phase() == MachinePhase::stopped)
            return Error{std::string(ended_early), "run",
                         fmt::format("ended: the bus was not operational yet; last: {}", machine_.bus_progress()),
                         "nothing has moved; start it again"};
        if (clock_.now() > until)
            return Error{"bus.timeout", "bus",
                         fmt::format("not operational after {:.0f} s; last: {}", to_seconds(patience), machine_.bus_progress()),
                         "look at the slave that this line names"};
    }
    return arm();
}

void RealtimeRunner::finish() {
    stop_.store(true, std::memory_order_release);
    end_watch_.only_threads_left();
    if (cycle_.joinable()) cycle_.join();
    cycle_running_.store(false, std::memory_order_release);
    tasks_.join();
    for (auto& thread : beside_)
        if (thread.joinable()) thread.join();
    beside_.clear();
    all_home_.store(true, std::memory_order_release);
    for (auto* thread : {&guard_, &watch_})
        if (thread->joinable()) thread->join();
}

}  // namespace taktwerk::runtime

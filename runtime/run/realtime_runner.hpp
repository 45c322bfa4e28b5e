#pragma once
// A machine in real time. Each thread does one kind of work, so that what waits holds up only its own:
//
//   cycle      the machine's cycle
//   tasks      one for each slower task, at priorities below the cycle's (task_threads.hpp)
//   service    the caller's of serve(): bus scripts, drives' services, and what the caller does in keep_on; nothing there may wait
//   programs   start() and stop() of programs: foreign code
//   disk       positions, until they are on the disk
//   modbus     one for each Modbus TCP device: connecting, asking, waiting for its answer
//   guard      where there are slower tasks: takes its priority from one that computes without an end; its own is right below the cycle's
//   watch      looks whether the cycle advances, whether an end that was asked for comes (end_watch.hpp), and at the cycle's page faults (fault_watch.hpp)

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/clock.hpp"
#include "core/cyclic_thread.hpp"
#include "core/realtime.hpp"
#include "core/result.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/run/end_watch.hpp"
#include "runtime/run/fault_watch.hpp"
#include "runtime/run/in_step.hpp"
#include "runtime/run/task_threads.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::runtime {

class RealtimeRunner {
public:
    /// Code of the error with which a run ends that was told to before it was up.
    static constexpr std::string_view ended_early = "run.ended_early";

    /// `world` is null on a real bus. Both outlive the runner.
    RealtimeRunner(Machine& machine, World* world);
    ~RealtimeRunner();

    /// Before start(), called on the watch thread. `on_stuck`: the cycle does not advance (once), or advances again (nullptr).
    std::function<void(const StuckCycle*)> on_stuck;
    /// Called once, when the run cannot end by itself: what hangs holds a thread that nobody can take back, so finish() would wait for ever.
    /// Whoever runs a machine ends the process here.
    std::function<void(const Error&)> give_up;

    /// Before start(): bus scripts and the drives' services run on the cycle's thread, between two cycles, so that a recording (Machine::record(),
    /// RecordedThreads::several) has them in their order. They are skipped while keep_on looks at the machine. Programs' start() and stop(), slower
    /// tasks, Modbus devices and the disk keep their threads: of these the cycle records what it takes.
    void record_in_step() { in_step_ = std::make_unique<InStep>(machine_, clock_); }

    /// Starts the threads; the report says what the system granted. Error when `realtime.required` and something was refused.
    [[nodiscard]] Result<RealtimeReport> start();
    /// `keep_on` is called about each millisecond on the calling thread; when it says no the axes stop, power goes off, the bus goes
    /// down in order, and serve() returns. Brings the bus up first; an error of the bring-up comes back, the bus taken down.
    [[nodiscard]] Result<void> serve(const std::function<bool(Instant)>& keep_on);
    /// Ordered end; idempotent.
    void finish();

    [[nodiscard]] const CycleCounters& counters() const noexcept { return counters_; }
    [[nodiscard]] Clock& clock() noexcept { return clock_; }

private:
    void cycle_thread();
    void modbus_thread(std::size_t device);
    void beside(const std::function<void(Instant)>& work);
    void guard_thread();
    void watch_thread();
    void service();
    [[nodiscard]] bool asked(const std::function<bool(Instant)>& keep_on);
    [[nodiscard]] Result<void> arm();
    [[nodiscard]] std::unique_lock<std::mutex> service_side();
    Result<void> bring_up(const std::function<bool(Instant)>& keep_on);

    Machine& machine_;
    World* world_;
    SystemClock clock_;
    CpuLatencyHold latency_;
    RealtimeRequest request_;
    RealtimeReport report_;
    int cycle_priority_ = 0;  // that it has; 0: none. Written before ready_
    CycleCounters counters_;
    EndWatch end_watch_;
    FaultWatch fault_watch_;
    std::atomic<bool> stop_{false}, ready_{false}, cycle_running_{false}, all_home_{false};
    std::thread cycle_, guard_, watch_;
    TaskThreads tasks_;
    std::vector<std::thread> beside_;
    Instant next_service_{};
    std::unique_ptr<InStep> in_step_;  // of a run that is recorded
};

}  // namespace taktwerk::runtime

#pragma once
// A machine in real time: the cycle on a thread of its own, slower tasks on theirs, everything acyclic on the caller's.

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/clock.hpp"
#include "core/cyclic_thread.hpp"
#include "core/realtime.hpp"
#include "core/result.hpp"
#include "runtime/machine.hpp"
#include "runtime/world.hpp"

namespace taktwerk::runtime {

class RealtimeRunner {
public:
    /// `world` is null on a real bus. Both outlive the runner.
    RealtimeRunner(Machine& machine, World* world);
    ~RealtimeRunner();

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
    void task_thread(std::size_t index);
    void service();
    Result<void> bring_up(const std::function<bool(Instant)>& keep_on);

    Machine& machine_;
    World* world_;
    SystemClock clock_;
    CpuLatencyHold latency_;
    RealtimeRequest request_;
    RealtimeReport report_;
    CycleCounters counters_;
    std::atomic<bool> stop_{false}, ready_{false};
    std::thread cycle_;
    std::vector<std::thread> tasks_;
    Instant next_service_{};
};

}  // namespace taktwerk::runtime

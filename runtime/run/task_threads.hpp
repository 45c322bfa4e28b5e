#pragma once
// A thread for each slower task, below the cycle's priority. A run that does not come to its end keeps its thread, and nobody can take it back; what
// it does not keep is its priority, so that it cannot hold up the rest of the computer.

#include <atomic>
#include <deque>
#include <string>
#include <thread>

#include "core/clock.hpp"
#include "core/realtime.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::runtime {

class TaskThreads {
public:
    /// So long a run has real-time priority. The kernel lets real-time threads have 950 ms of each second of a CPU (sched(7), sched_rt_runtime_us),
    /// and takes what is left from all of them together: the cycle, too, would stand still for 50 ms.
    static constexpr Duration longest_at_priority = std::chrono::milliseconds{500};

    /// Both outlive the threads.
    TaskThreads(Machine& machine, Clock& clock) : machine_(machine), clock_(clock) {}

    /// One item for all of them, with what was asked for and whether it was granted; none where nothing was. `cycle_priority`: that the cycle has; 0: none,
    /// and then they have none either. They end when `stop` is set.
    [[nodiscard]] RealtimeReport start(const std::atomic<bool>& stop, int cycle_priority);
    /// Often, from another thread: who has computed too long becomes an ordinary thread until that run has ended.
    void look(Instant now);
    /// Waits for those whose task comes back; for ever for one that does not.
    void join();

private:
    struct Place {
        std::thread thread;
        std::size_t task = 0;  ///< of Machine::run_slow_task()
        int priority = 0;      ///< 0: an ordinary thread
        Duration at_priority = longest_at_priority;
        Result<void> granted{};          ///< written before `ready`
        std::atomic<int> number{0};      ///< of the kernel
        std::atomic<bool> ready{false};  ///< it has begun
        std::atomic<bool> taken{false};  ///< its priority was taken away
        std::atomic<Instant> began{};    ///< of the run at work; Instant{}: none
    };
    void run(Place& place, const std::atomic<bool>& stop);
    [[nodiscard]] Duration until_next_look(const Place& place, Instant now) const;
    void wait_for_release(const Place& place, const std::atomic<bool>& stop);

    Machine& machine_;
    Clock& clock_;
    std::deque<Place> places_;
};

}  // namespace taktwerk::runtime

#pragma once
// What the operating system can do for punctuality, asked for one thing at a time. Every refusal is reported with its
// reason and with what it costs; none is fatal: the demo runs without privileges. All of it before the first cycle, none is
// real-time safe. Sources: sched(7), mlockall(2), PR_SET_TIMERSLACK(2), kernel Documentation/power/pm_qos_interface.rst.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk {

struct RealtimeRequest {
    std::optional<int> priority = 80;         ///< SCHED_FIFO, 1..99; above IRQ threads (50), below the watchdog (99)
    std::vector<int> cpus;                    ///< the cycle thread's CPUs; empty: any
    bool lock_memory = true;                  ///< mlockall: no page fault in the cycle
    bool hold_cpu_latency = true;             ///< /dev/cpu_dma_latency: no deep sleep states
    std::size_t prefault_stack = 256 * 1024;  ///< bytes of stack touched beforehand; 0: none
};

/// RealtimeItem::what of RealtimeRequest::lock_memory.
inline constexpr std::string_view memory_locked = "memory locked";

/// One thing that was asked for, for the log, `monitor` and `--json`.
struct RealtimeItem {
    std::string what;  ///< "SCHED_FIFO priority 80"
    bool granted = false;
    std::string reason;       ///< why not, and how to change that; empty when granted
    std::string consequence;  ///< what it costs; empty when granted
};

struct RealtimeReport {
    std::vector<RealtimeItem> items;

    [[nodiscard]] bool all_granted() const noexcept;
    /// One line an item: "granted: ..." or "refused: ... (reason): consequence".
    [[nodiscard]] std::string text() const;
};

/// Keeps the CPUs out of deep sleep states for as long as it lives.
class CpuLatencyHold {
public:
    /// Errors: realtime.cpu_latency.
    [[nodiscard]] static Result<CpuLatencyHold> acquire(Duration worst_wake_up = Duration{0},
                                                        const std::string& device = "/dev/cpu_dma_latency");
    CpuLatencyHold() = default;
    ~CpuLatencyHold();
    CpuLatencyHold(CpuLatencyHold&& other) noexcept;
    CpuLatencyHold& operator=(CpuLatencyHold&& other) noexcept;
    [[nodiscard]] bool held() const noexcept { return file_ >= 0; }

private:
    explicit CpuLatencyHold(int file) noexcept : file_(file) {}
    int file_ = -1;
};

/// Once for the process, before threads start: memory, sleep states, and whether the kernel is PREEMPT_RT.
/// `hold` has to live as long as the machine runs.
[[nodiscard]] RealtimeReport prepare_process(const RealtimeRequest& request, CpuLatencyHold& hold);

/// On the cycle thread itself, before its first cycle: stack, CPUs, timer slack, and last of all the priority. Helper threads
/// started later by this thread do not inherit it.
[[nodiscard]] RealtimeReport prepare_cycle_thread(const RealtimeRequest& request);

/// One line of a report, for what is asked for elsewhere.
[[nodiscard]] RealtimeItem realtime_item(std::string what, const Result<void>& result, std::string consequence);

// The single steps, each for the calling thread unless said otherwise.

/// 1..99. Errors: realtime.priority.
[[nodiscard]] Result<void> set_fifo_priority(int priority);
/// The kernel's number of the calling thread, for take_priority().
[[nodiscard]] int this_thread_number() noexcept;
/// Whether the calling thread has a SCHED_FIFO priority now. One system call.
[[nodiscard]] bool has_fifo_priority() noexcept;
/// Another thread of this process becomes an ordinary one. It can get its priority back by itself: set_fifo_priority(). Errors: realtime.priority.
[[nodiscard]] Result<void> take_priority(int thread);
/// Whole process, present and future pages; also stops malloc from giving memory back. Errors: realtime.lock_memory.
[[nodiscard]] Result<void> lock_memory();
/// Errors: realtime.cpus.
[[nodiscard]] Result<void> pin_to_cpus(const std::vector<int>& cpus);
/// Errors: realtime.timer_slack.
[[nodiscard]] Result<void> set_timer_slack(Duration slack);
/// Touches `bytes` of stack below the caller. Errors: realtime.stack when the thread's stack is smaller (with 64 KB to spare).
[[nodiscard]] Result<void> prefault_stack(std::size_t bytes);
/// From /sys/kernel/realtime, which only PREEMPT_RT kernels have.
[[nodiscard]] bool kernel_is_preempt_rt();

}  // namespace taktwerk

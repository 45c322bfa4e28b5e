#pragma once
// The beat of the machine: a step on an absolute grid of instants. With SystemClock in real time, with VirtualClock as
// fast as the CPU allows, by the same code.

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "core/clock.hpp"
#include "core/time.hpp"

namespace taktwerk {

/// What the step is told about its cycle. With VirtualClock lateness is 0. Recorded, so that a recording can be replayed.
struct CycleTiming {
    Instant scheduled;         ///< the grid instant this cycle belongs to
    Instant woken;             ///< when it really began
    Duration lateness{0};      ///< woken - scheduled, >= 0
    std::uint64_t cycle = 0;   ///< executed cycles before this one; a missed tick is not a cycle
    std::uint64_t missed = 0;  ///< grid instants skipped between the cycle before and this one
};

enum class CycleVerdict : std::uint8_t { carry_on, stop };

/// Asked when `limit` cycles in a row have overrun, and again at each further multiple; on the cycle thread: real-time safe.
/// `stop` ends run() after the cycle. A limit of 0 never asks.
struct OverrunPolicy {
    std::uint32_t limit = 0;
    CycleVerdict (*decide)(void* context, const CycleTiming& last, std::uint32_t consecutive) noexcept = nullptr;
    void* context = nullptr;
};

struct CyclicConfig {
    Duration period{1'000'000};  ///< > 0
    /// Grid instant of the first cycle; before or at the clock's now() when run() starts: one period from then.
    Instant first{};
    OverrunPolicy on_overruns{};
};

/// A cycle overruns when its step ends after the next grid instant.
struct CycleCounters {
    std::uint64_t cycles = 0;       ///< executed
    std::uint64_t missed = 0;       ///< grid instants skipped, never caught up
    std::uint64_t overruns = 0;     ///< cycles that overran
    std::uint32_t consecutive = 0;  ///< overruns in a row up to now
    std::uint32_t worst_run = 0;    ///< most overruns in a row
};

enum class CycleEnd : std::uint8_t {
    asked,     ///< the stop flag was set
    step,      ///< the step said stop
    overruns,  ///< the overrun policy said stop
};

/// Runs a step on a grid, on the thread that calls run(): preparing that thread is core/realtime.hpp's business.
/// Missed instants are counted and skipped: after an overrun the next cycle starts at the next instant of the same grid,
/// never in a burst. From run() on: no allocation, waiting is the only system call.
class CyclicThread {
public:
    CyclicThread(Clock& clock, const CyclicConfig& config) noexcept : clock_(clock), config_(config), next_(config.first) {}

    /// `step`: CycleVerdict(const CycleTiming&) noexcept, or void. `stop` is looked at once before each wait.
    template <class Step>
    CycleEnd run(Step&& step, const std::atomic<bool>& stop) noexcept {
        while (!stop.load(std::memory_order_acquire)) {
            const CycleTiming timing = wait();
            if constexpr (std::is_void_v<decltype(step(timing))>) {
                step(timing);
            } else {
                if (step(timing) == CycleVerdict::stop) return finish(timing), CycleEnd::step;
            }
            if (finish(timing) == CycleVerdict::stop) return CycleEnd::overruns;
        }
        return CycleEnd::asked;
    }

    /// Moves all later grid instants, at most half a period either way: how the loop locks to the bus' reference clock.
    /// From within the step.
    void shift_grid(Duration by) noexcept;

    /// On the cycle thread, or after run() has returned.
    [[nodiscard]] const CycleCounters& counters() const noexcept { return counters_; }

private:
    CycleTiming wait() noexcept;
    CycleVerdict finish(const CycleTiming& timing) noexcept;

    Clock& clock_;
    CyclicConfig config_;
    Instant next_;
    Duration shift_{0};
    std::uint64_t just_missed_ = 0;
    CycleCounters counters_;
    bool started_ = false;
};

}  // namespace taktwerk

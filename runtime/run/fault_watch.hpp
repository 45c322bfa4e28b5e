#pragma once
// Page faults of the cycle's thread, seen from another one: from a second after the machine runs on they are told to it. Before, everything is met for
// the first time.

#include <atomic>
#include <optional>

#include "core/page_faults.hpp"
#include "core/realtime.hpp"
#include "core/time.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::runtime {

class FaultWatch {
public:
    explicit FaultWatch(Machine& machine) : machine_(machine) {}

    /// The cycle's thread, before its first cycle: that is the one.
    void this_is_it() noexcept { thread_.store(this_thread_number(), std::memory_order_release); }
    /// Before look(): whether its memory was locked.
    void memory_is_locked(bool locked) noexcept { locked_ = locked; }
    /// The watch thread, often.
    void look(Instant now);

private:
    Machine& machine_;
    std::atomic<int> thread_{0};
    bool locked_ = false;
    std::optional<ThreadPageFaults> faults_;
    std::optional<PageFaults> before_;  // operation
    std::optional<Instant> running_since_;
    Instant next_{};
};

}  // namespace taktwerk::runtime

#pragma once
// Memory that the cycle's thread had to wait for while the machine operates. Whoever looks at the thread from outside tells it; the cycle takes it,
// records it, counts it and raises the alarm.

#include <atomic>
#include <cstdint>
#include <optional>

#include "runtime/machine/machine_body.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

class PageFaultAlarm {
public:
    explicit PageFaultAlarm(MachineBody& body) : body_(body) {}

    /// One thread, not the cycle's.
    void tell(const FaultsSeen& faults) noexcept {
        minor_.store(faults.minor, std::memory_order_relaxed);
        major_.store(faults.major, std::memory_order_relaxed);
        locked_.store(faults.memory_locked, std::memory_order_relaxed);
    }
    /// In the place of tell().
    void replay(const FaultsSeen& faults) noexcept { replayed_ = faults; }

    /// Once a cycle; real-time safe.
    void watch() noexcept;

private:
    MachineBody& body_;
    std::atomic<std::uint64_t> minor_{0}, major_{0};
    std::atomic<bool> locked_{false};
    std::optional<FaultsSeen> replayed_;

    // cycle
    FaultsSeen seen_;
    std::uint64_t shown_ = 0, shown_major_ = 0;  // of the alarm that is shown
    Instant shown_until_{};
};

}  // namespace taktwerk::runtime

#pragma once
// Who tells the time. The cycle is handed a Clock once; everything inside the cycle gets an Instant as an argument.

#include "core/time.hpp"

namespace taktwerk {

class Clock {
public:
    virtual ~Clock() = default;
    [[nodiscard]] virtual Instant now() const noexcept = 0;
    /// Returns at or after `deadline` (at once when it has passed). Real-time safe: waiting is its only system call.
    virtual void sleep_until(Instant deadline) noexcept = 0;
};

/// CLOCK_MONOTONIC and clock_nanosleep(TIMER_ABSTIME): a step of the calendar clock never moves an axis.
class SystemClock final : public Clock {
public:
    [[nodiscard]] Instant now() const noexcept override;
    void sleep_until(Instant deadline) noexcept override;
};

/// Time that passes only when someone waits: a machine on this clock runs in lock-step, as fast as the CPU allows.
class VirtualClock final : public Clock {
public:
    explicit VirtualClock(Instant start = Instant{}) noexcept : now_(start) {}
    [[nodiscard]] Instant now() const noexcept override { return now_; }
    void sleep_until(Instant deadline) noexcept override {
        if (deadline > now_) now_ = deadline;
    }
    void advance(Duration by) noexcept { now_ += by; }

private:
    Instant now_;
};

}  // namespace taktwerk

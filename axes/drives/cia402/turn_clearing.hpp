#pragma once
// The encoder forgets its turns, by an object (SV33-E P20.05) or by a bit of the control word (TSVM 5.3.2). Guarded: only while the motor
// has no power. From the request on the axis has no reference, whatever the drive answers. The service side asks, the cycle shows.

#include <atomic>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::cia402 {

class TurnClearing {
public:
    /// Of the service by the control word; the bus' own tickets are small numbers that rise.
    static constexpr ServiceTicket by_control_word = 0xFFFFFFFF;
    /// How long the bit stands: edge or level, and for how long, is not stated (TSVM 5.3.2).
    static constexpr Duration pulse = std::chrono::milliseconds{100};

    // --- service side -----------------------------------------------------------------------------------------------------
    [[nodiscard]] bool permitted() const noexcept { return unpowered_.load(std::memory_order_acquire) && !pulsing(); }
    void begin(bool by_bit) noexcept {
        if (by_bit) asked_.store(true, std::memory_order_release);
        count_.fetch_add(1, std::memory_order_acq_rel);
    }
    [[nodiscard]] bool pulsing() const noexcept { return asked_.load(std::memory_order_acquire); }

    // --- in the cycle; real-time safe -----------------------------------------------------------------------------------
    void note(PowerState power) noexcept {
        const bool off = power == PowerState::disabled || power == PowerState::ready || power == PowerState::fault;
        unpowered_.store(off, std::memory_order_release);
    }
    /// True in the cycle that first sees a request.
    [[nodiscard]] bool begun() noexcept {
        const auto count = count_.load(std::memory_order_acquire);
        const bool another = count != seen_;
        seen_ = count;
        return another;
    }
    /// The bit is to be set in this cycle.
    [[nodiscard]] bool bit(Instant now) noexcept {
        if (!pulsing()) return false;
        if (!since_running_) {
            since_running_ = true;
            since_ = now;
        }
        if (now - since_ < pulse && unpowered_.load(std::memory_order_relaxed)) return true;
        since_running_ = false;
        asked_.store(false, std::memory_order_release);
        return false;
    }

private:
    std::atomic<bool> unpowered_{false}, asked_{false};
    std::atomic<std::uint16_t> count_{0};
    std::uint16_t seen_ = 0;
    bool since_running_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes::cia402

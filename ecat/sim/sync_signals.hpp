#pragma once
// The SYNC generators of a slave controller. SYNC0: pulse k stands at start + k * cycle of the slave's own system time; SYNC1
// follows it. Real-time safe. Source: ETG.1000.4 (0980h..09A7h).

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/time.hpp"
#include "ecat/sim/dc_clock.hpp"

namespace taktwerk::ecat::sim {

class Sync0 {
public:
    /// 0981h was written with SYNC0 on. A start that lies in the past is never reached: the controller waits for the clock
    /// to come around, and so does a master that read the time too early.
    void activate(std::int64_t start, std::uint32_t cycle, const DcClock& clock, Instant now) noexcept {
        active_ = true;
        cycle_ = cycle;
        next_ = start;
        waiting_ = start > clock.system(now) && (cycle == 0 || cycle >= shortest_cycle_ns);
        pulses_ = 0;
    }
    /// The clock was set. When it jumped over the next pulse by more than a cycle, that pulse and all others are missed, too.
    void clock_changed(const DcClock& clock, Instant now) noexcept {
        const auto late = static_cast<std::int64_t>(static_cast<std::uint64_t>(clock.system(now)) - static_cast<std::uint64_t>(next_));
        if (late > std::max<std::int64_t>(cycle_, 1'000'000)) waiting_ = false;
    }
    void deactivate() noexcept { active_ = waiting_ = false; }

    [[nodiscard]] bool active() const noexcept { return active_; }
    /// Pulses come or will come. False when inactive, when the start was missed, and after the only pulse of a cycle of 0.
    [[nodiscard]] bool runs() const noexcept { return active_ && waiting_; }
    [[nodiscard]] Duration cycle() const noexcept { return Duration{cycle_}; }
    [[nodiscard]] std::int64_t next_system() const noexcept { return next_; }
    [[nodiscard]] std::uint64_t pulses() const noexcept { return pulses_; }
    [[nodiscard]] std::optional<Instant> due(const DcClock& clock) const noexcept {
        if (!runs()) return std::nullopt;
        return clock.when_system(next_);
    }
    void fire() noexcept {
        ++pulses_;
        next_ += cycle_;
        waiting_ = cycle_ != 0;
    }

    static constexpr std::uint32_t shortest_cycle_ns = 1000;  ///< the unit makes no faster pulses

private:
    bool active_ = false, waiting_ = false;
    std::uint32_t cycle_ = 0;
    std::int64_t next_ = 0;
    std::uint64_t pulses_ = 0;
};

/// SYNC1 follows SYNC0: a time of its own starts with a SYNC0 pulse, ends with the SYNC1 pulse, and starts again with the next SYNC0.
/// Shorter than a SYNC0 cycle it is a delay; n cycles give every n-th pulse. 0: together with SYNC0.
class Sync1 {
public:
    void activate(std::uint32_t cycle) noexcept { active_ = true, cycle_ = cycle, waiting_ = false, pulses_ = 0; }
    void deactivate() noexcept { active_ = waiting_ = false; }
    [[nodiscard]] bool active() const noexcept { return active_; }
    void sync0_fired(std::int64_t system) noexcept {
        if (!active_ || waiting_) return;
        waiting_ = true;
        next_ = system + cycle_;
    }
    [[nodiscard]] std::int64_t next_system() const noexcept { return next_; }
    [[nodiscard]] std::uint64_t pulses() const noexcept { return pulses_; }
    [[nodiscard]] std::optional<Instant> due(const DcClock& clock) const noexcept {
        if (!waiting_) return std::nullopt;
        return clock.when_system(next_);
    }
    void fire() noexcept { waiting_ = false, ++pulses_; }

private:
    bool active_ = false, waiting_ = false;
    std::uint32_t cycle_ = 0;
    std::int64_t next_ = 0;
    std::uint64_t pulses_ = 0;
};

}  // namespace taktwerk::ecat::sim

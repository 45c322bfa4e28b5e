#pragma once
// What a simulated drive watches of its motor's torque: heat by I2t, standing still with all the torque there is, and a torque that lasts too
// long. It says so; which alarm that is stands elsewhere.

#include <algorithm>

#include "axes/sim/inner_step.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class LoadWatch {
public:
    static constexpr Duration stall_time = std::chrono::milliseconds{200};  ///< at the torque limit without turning (SV33-E P08.18)

    void power_on() noexcept { high_lasts_ = {}; }
    /// The drive has started: the motor is cold.
    void start() noexcept {
        heat_ = 0;
        stalled_ = {};
    }
    /// One inner step with `load` rated torques; `stuck`: at the torque limit at standstill.
    void step(double load, bool stuck) noexcept {
        heat_ = std::max(0.0, heat_ + (load * load - 1) * inner_seconds);
        stalled_ = stuck ? stalled_ + inner_period : Duration{};
    }
    /// Twice the rated torque for `seconds` gives 3 rated torques2 s a second above what the motor sheds. 0: no check.
    [[nodiscard]] bool hot(double seconds) const noexcept { return seconds > 0 && heat_ > 3 * seconds; }
    [[nodiscard]] bool stalled() const noexcept { return stalled_ >= stall_time; }
    /// One inner step; true: the torque is `high`, and has been for longer than `allowed` (TSVM 7.2, alarm 29).
    bool high_too_long(bool high, Duration allowed) noexcept {
        high_lasts_ = high ? high_lasts_ + inner_period : Duration{};
        return high && high_lasts_ > allowed;
    }

private:
    double heat_ = 0;  ///< above the rated torque, in (rated torques)2 seconds
    Duration stalled_{}, high_lasts_{};
};

}  // namespace taktwerk::axes::sim

#pragma once
// What a simulated XP200 watches of its motor's torque: heat and peak, and how long it has been overloaded or stalled (manual 6.1: alarms 6, 13,
// 29).

#include <cmath>

#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

class MotorLoad {
public:
    void power_on() noexcept { heat_ = peak_ = 0; }
    /// One step of `seconds` with `share` of the rated torque; `constant` s of the heat.
    void step(double share, double seconds, double constant, Instant now) noexcept {
        heat_ += (share * share - heat_) * seconds / constant;
        if (std::abs(share) >= peak_ || now - peak_at_ > std::chrono::seconds{1}) {
            peak_ = std::abs(share);
            peak_at_ = now;
        }
    }
    /// Nothing is watched: without current, or in an alarm.
    void rest(Instant now) noexcept { overload_since_ = stalled_since_ = now; }
    /// It has been so for longer than `allowed`.
    bool overloaded(bool is, Instant now, Duration allowed) noexcept { return lasts(overload_since_, is, now, allowed); }
    bool stalled(bool is, Instant now, Duration allowed) noexcept { return lasts(stalled_since_, is, now, allowed); }

    [[nodiscard]] double heat() const noexcept { return heat_; }  ///< (rated torques)2
    [[nodiscard]] double peak() const noexcept { return peak_; }  ///< rated torques

private:
    static bool lasts(Instant& since, bool is, Instant now, Duration allowed) noexcept {
        if (!is) since = now;
        return is && now - since > allowed;
    }

    double heat_ = 0, peak_ = 0;
    Instant peak_at_{}, overload_since_{}, stalled_since_{};
};

}  // namespace taktwerk::axes::sim::xp200

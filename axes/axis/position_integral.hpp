#pragma once
// The I part of the position loop that is closed here: what it adds to the velocity of the P part. Knows no axis; real-time safe.
//
// Three things keep it from doing harm: inside the dead band it holds what it has (friction would make it hunt around the target), it never adds more than
// its limit, and where the velocity that goes to the drive is cut off already it does not grow in that sense (no wind-up).

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_config.hpp"

namespace taktwerk::axes {

class IntegralPart {
public:
    /// `kv` 1/s; `velocity_limit` u/s, of the axis as configured.
    IntegralPart(const PositionIntegral& config, double kv, double velocity_limit) noexcept
        : gain_(config.used() ? kv / to_seconds(config.time) : 0),
          limit_(config.limit > 0 ? config.limit : velocity_limit / 10),
          dead_band_(config.dead_band),
          seconds_(to_seconds(config.time)) {}

    [[nodiscard]] bool used() const noexcept { return gain_ > 0; }
    [[nodiscard]] double value() const noexcept { return value_; }

    /// `dt` seconds on, with a following error of `error` u, beside a velocity of `given` u/s that is cut off at `most`. What it adds, u/s.
    double step(double error, double given, double most, double dt) noexcept {
        const double rate = gain_ * std::copysign(std::max(0.0, std::abs(error) - dead_band_), error);
        const double sum = given + value_;
        const bool cut_off = std::abs(sum) >= most && sum * rate > 0;
        if (!cut_off) value_ = std::clamp(value_ + rate * dt, -limit_, limit_);
        return value_;
    }
    /// Nothing is to be held any more: it goes away with its own time. At once it would be a step of the velocity.
    double run_out(double dt) noexcept { return value_ -= value_ * std::min(1.0, dt / seconds_); }
    void clear() noexcept { value_ = 0; }

private:
    double gain_ = 0;  // 1/s2
    double limit_ = 0, dead_band_ = 0, seconds_ = 0;
    double value_ = 0;  // u/s
};

}  // namespace taktwerk::axes

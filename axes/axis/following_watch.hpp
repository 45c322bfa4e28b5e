#pragma once
// How far the motor is behind its set-points, for how long it may be, and whether it has arrived.

#include <cmath>

#include "axes/axis/axis_motion.hpp"
#include "axes/axis/following_error.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class FollowingWatch {
public:
    /// u: set-point in effect at the latch, minus actual.
    [[nodiscard]] double error() const noexcept { return error_; }
    [[nodiscard]] bool in_position(const AxisBody& body) const noexcept {
        return in_window_ && body.now - in_window_since_ >= body.config.windows.in_position_time;
    }
    /// True: it has been too far for too long. `pressed`: against a block.
    [[nodiscard]] bool watch(const Measured& measured, const AxisMotion& motion, double actual, bool pressed) noexcept;
    /// The set-point follows the motor: there is nothing to watch.
    void rest() noexcept {
        error_ = 0;
        timer_.clear();
        in_window_ = false;
    }
    void record(Instant effective, std::int64_t counts) noexcept { history_.record(effective, counts); }
    void forget() noexcept { history_.clear(); }

private:
    FollowingErrorTimer timer_;
    double error_ = 0;
    Instant in_window_since_{};
    bool in_window_ = false;
    bool lag_forgiven_ = false;  // the set-point was ahead of an axis that could not follow
    SetpointHistory history_;
};

}  // namespace taktwerk::axes

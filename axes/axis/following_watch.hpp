#pragma once
// How far the motor is behind its set-points, for how long it may be, and whether it has arrived.

#include <cmath>
#include <limits>

#include "axes/axis/axis_motion.hpp"
#include "axes/axis/following_error.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/stopping_way.hpp"

namespace taktwerk::axes {

class FollowingWatch {
public:
    /// u: set-point in effect at the latch, minus actual.
    [[nodiscard]] double error() const noexcept { return error_; }
    /// u: what error() may be at the set velocity of that instant, and behind a stop that the drive made by itself.
    [[nodiscard]] double window() const noexcept { return window_; }
    [[nodiscard]] bool in_position(const AxisBody& body) const noexcept {
        return in_window_ && body.now - in_window_since_ >= body.config.windows.in_position_time;
    }
    /// True: it has been too far for too long. `pressed`: against a block.
    [[nodiscard]] bool watch(const Measured& measured, const AxisMotion& motion, double actual, bool pressed) noexcept;
    /// The set-point follows the motor: there is nothing to watch.
    void rest() noexcept {
        error_ = 0;
        timer_.clear();
        stopping_.clear();
        in_window_ = false;
    }
    void record(Instant effective, std::int64_t counts) noexcept { history_.record(effective, counts); }
    void forget() noexcept { history_.clear(); }
    /// The set-point was put where the motor came to rest: it is not behind those of before, and the position loop does not drive it there.
    void begin_anew() noexcept {
        error_ = 0;
        timer_.clear();
        stopping_.clear();
        history_.clear();
    }

private:
    [[nodiscard]] double beyond_by_stopping(const Measured& measured, const AxisMotion& motion) noexcept;

    FollowingErrorTimer timer_;
    StoppingWay stopping_;  // of a drive on a slow line
    double error_ = 0;
    double window_ = std::numeric_limits<double>::infinity();  // nothing is watched yet
    Instant in_window_since_{};
    bool in_window_ = false;
    bool lag_forgiven_ = false;  // the set-point was ahead of an axis that could not follow
    SetpointHistory history_;
};

[[gnu::always_inline]] inline bool FollowingWatch::watch(const Measured& measured, const AxisMotion& motion, double actual,
                                                         bool pressed) noexcept {
    const auto& feedback = measured.feedback;
    const auto& body = measured.body;
    if (!feedback.fresh) return false;
    error_ = history_.error_at(feedback.latched, feedback.position) / body.units.counts_per_unit();
    // Pressed against a block the set-point runs ahead; that is no error until the axis has caught up.
    const auto& allowed = body.config.following;
    window_ = allowed.window;
    // The velocity of the same instant as the error: an axis that has just stopped is still behind.
    if (allowed.per_velocity > Duration::zero())
        window_ += to_seconds(allowed.per_velocity) * std::abs(history_.velocity_at(feedback.latched) / body.units.counts_per_unit());
    if (body.slow_line) window_ += beyond_by_stopping(measured, motion);
    const bool beyond = std::abs(error_) > window_;
    lag_forgiven_ = pressed || (lag_forgiven_ && beyond);
    bool too_long = false;
    if (!beyond || lag_forgiven_) timer_.clear();
    else too_long = timer_.lasts(feedback.latched, allowed.time);

    const auto& setpoint = motion.setpoint;
    const bool inside = setpoint.at_rest() && std::abs(setpoint.state().position - actual) <= body.config.windows.in_position;
    if (inside && !in_window_) in_window_since_ = body.now;
    in_window_ = inside;
    return too_long;
}

}  // namespace taktwerk::axes

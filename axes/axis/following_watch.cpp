#include "axes/axis/following_watch.hpp"

namespace taktwerk::axes {

bool FollowingWatch::watch(const Measured& measured, const AxisMotion& motion, double actual, bool pressed) noexcept {
    const auto& feedback = measured.feedback;
    const auto& body = measured.body;
    if (!feedback.fresh) return false;
    error_ = history_.error_at(feedback.latched, feedback.position) / body.units.counts_per_unit();
    // Pressed against a block the set-point runs ahead; that is no error until the axis has caught up.
    const bool beyond = std::abs(error_) > body.config.following.window;
    lag_forgiven_ = pressed || (lag_forgiven_ && beyond);
    bool too_long = false;
    if (!beyond || lag_forgiven_) timer_.clear();
    else too_long = timer_.lasts(feedback.latched, body.config.following.time);

    const auto& setpoint = motion.setpoint;
    const bool inside = setpoint.at_rest() && std::abs(setpoint.state().position - actual) <= body.config.windows.in_position;
    if (inside && !in_window_) in_window_since_ = body.now;
    in_window_ = inside;
    return too_long;
}

}  // namespace taktwerk::axes

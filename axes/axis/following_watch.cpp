#include "axes/axis/following_watch.hpp"

#include <cmath>

namespace taktwerk::axes {

/// The motor may be on its way to the speed of the set-point when it hears of the stop.
double FollowingWatch::beyond_by_stopping(const Measured& measured, const AxisMotion& motion) noexcept {
    const auto& body = measured.body;
    const auto& drive = body.port.capabilities();
    return stopping_.allowance({.told_to_stop = motion.goal.kind == Goal::Kind::stop,
                                .place = measured.local(),
                                .velocity = measured.velocity(),
                                .error = error_,
                                .speed = std::abs(motion.setpoint.state().velocity),
                                .deceleration = motion.goal.limits.deceleration,
                                .latency = to_seconds(drive.command_latency + drive.feedback_period),
                                .window = window_});
}

}  // namespace taktwerk::axes

#include "axes/planner/brake_choice.hpp"

#include <algorithm>

#include "axes/planner/ramp.hpp"

namespace taktwerk::axes {

namespace {

constexpr double limit_lost = 1e10;  // times the limit: its digits are gone from what was braked
constexpr double beyond_reason = 1e15;

/// From (`top`, 0) down to (v1, a1), in a frame where top > 0: backwards in time and mirrored it is a climb.
double descent(double top, double v1, double a1, const FrameLimits& limits) noexcept {
    const FrameLimits back = limits.reversed().mirrored();
    const double released = released_velocity(v1, -a1, back);
    return Ramp{climb_above_release(v1, -a1, released, std::max(top - released, 0.0), back), back}.travel();
}

}  // namespace

Brake brake_towards(double v, double a, double v1, double a1, double way, const FrameLimits& limits) noexcept {
    Brake brake{v, a, limits};
    if (!(brake.beyond() > limit_lost)) return brake;
    Brake down = brake;
    down.go_to_limit(limits);
    const double s = brake.sense();
    const FrameLimits l = s > 0 ? limits : limits.mirrored();
    if (brake.beyond() > beyond_reason || s * (way - down.travel()) >= descent(l.up.velocity, s * v1, s * a1, l)) brake = down;
    return brake;
}

}  // namespace taktwerk::axes

// A run that an axis drives: its length comes from PathDrive, and each set-point is looked at before it is given. MC_SyncGroupToAxis.

#include <cmath>

#include "axes/group/path_run_inside.hpp"

namespace taktwerk::axes {
namespace {

constexpr double limit_digits = 1e-9, jerk_slack = 1e-3;

}  // namespace

ErrorId PathRun::refuse_driver(const PathDriver& driver, const GroupMembers& members) const noexcept {
    return inside_->drive.refuse(driver, members);
}
void PathRun::watch(Instant now, Duration period) noexcept { inside_->drive.watch(now, period); }
PathDriverView PathRun::driver() const noexcept { return inside_->drive.view(); }
ErrorId PathRun::lets_go() const noexcept { return inside_->drive.fault(); }

void PathRun::begin_driven() noexcept {
    auto& in = *inside_;
    in.driven_part = 0;
    in.velocity = in.acceleration = {};
    in.drive.begin(in.track->drive);
}

/// The section that holds the place, from the one of the cycle before on.
void PathRun::find_part() noexcept {
    auto& in = *inside_;
    const double s = in.place();
    const std::uint32_t last = in.track->drive.sections - 1;
    const auto begin = [&](std::uint32_t part) { return in.track->section(part).section.begin; };
    // From one end of a lap to the other.
    if (s < begin(std::min(1u, last))) in.driven_part = 0;
    else if (s >= begin(last)) in.driven_part = last;
    while (in.driven_part < last && s >= begin(in.driven_part + 1)) ++in.driven_part;
    while (in.driven_part > 0 && s < begin(in.driven_part)) --in.driven_part;
}

/// A member would become too fast here, or in a bend from which braking has to begin now.
bool PathRun::too_fast_ahead() const noexcept {
    const auto& in = *inside_;
    const auto& at = in.drive.state();
    const auto& room = in.drive.path().room;
    const RunSection& run = in.track->section(in.driven_part);
    const double s = in.place(), faster = at.velocity * at.acceleration > 0 ? at.acceleration : 0;
    const double soon = std::abs(at.velocity) + faster * faster / (2 * room.jerk);
    if (soon > run.fastest * (1 + limit_digits)) return true;
    const bool on = at.velocity >= 0;
    const double left = on ? run.section.end() - s : s - run.section.begin, then = on ? run.fastest_at_end : run.fastest_at_begin;
    return soon * soon > (then * then + 2 * braking_counted_on * room.deceleration * std::max(left, 0.0)) * (1 + limit_digits);
}

/// Where that is for the members. False: a set-point would be outside a limit, and nothing has changed.
bool PathRun::look_driven() noexcept {
    auto& in = *inside_;
    const auto q = in.q, velocity = in.velocity, acceleration = in.acceleration;
    const auto states = states_;
    s_ = in.drive.state();
    find_part();
    look();
    bool inside = fault_ == ErrorId::none;
    for (std::size_t k = 0; inside && k < in.members; ++k) {
        const auto& limits = in.limits[k];
        const double jump = std::abs(in.acceleration[k] - acceleration[k]);
        // What is measured trembles: of that the jerk is what it is.
        const bool smooth = !in.drive.planned() || jump <= limits.jerk * in.period * (1 + jerk_slack) + limit_digits;
        inside = smooth && std::abs(in.velocity[k]) <= limits.velocity * (1 + limit_digits) &&
                 std::abs(in.acceleration[k]) <= limits.acceleration * (1 + limit_digits) &&
                 std::abs(in.velocity[k] - velocity[k]) <= limits.acceleration * in.period * (1 + jerk_slack) + limit_digits &&
                 in.q[k] <= limits.high + limit_digits && in.q[k] >= limits.low - limit_digits;
    }
    if (inside) return true;
    in.q = q;
    in.velocity = velocity;
    in.acceleration = acceleration;
    states_ = states;
    return false;
}

void PathRun::go_driven(Duration period) noexcept {
    auto& in = *inside_;
    in.period = to_seconds(period);
    in.before = in.acceleration;
    in.drive.step(period);
    find_part();
    const bool ahead = in.drive.follows() && too_fast_ahead();
    if (!ahead && look_driven()) return;
    fault_ = ErrorId::none;
    if (in.drive.brake_instead(ErrorId::path_limit, period) && look_driven()) return;
    fault_ = ErrorId::path_limit;
}

}  // namespace taktwerk::axes

// A run that an axis drives: its length comes from PathDrive, and each set-point is looked at before it is given. MC_SyncGroupToAxis.

#include <algorithm>
#include <cmath>

#include "axes/group/path_run_inside.hpp"

namespace taktwerk::axes {
namespace {

constexpr double limit_digits = 1e-9, jerk_slack = 1e-3, last_digits = 1e-15;

/// One motion, inside what a member has, and what its axis takes (Axis::lead). Of what is measured place and velocity are what they are.
bool goes_on(const MotionState& from, const MotionState& to, const MemberLimits& limits, bool planned, double period) noexcept {
    const double more = 1 + limit_digits, change = limits.acceleration * period, step = to.velocity - from.velocity;
    const double way = to.position - from.position, far = last_digits * std::abs(to.position);
    if (!(std::abs(to.velocity) <= limits.velocity * more && std::abs(way) <= limits.velocity * period * more + far)) return false;
    if (!(std::abs(to.acceleration) <= limits.acceleration * more && std::abs(step) <= change * more)) return false;
    if (!(std::abs(way - period * (to.velocity + from.velocity) / 2) <= change * period + far)) return false;
    // What it speeds up by is taken away with its jerk before it is too fast.
    const double soon = to.velocity * to.acceleration > 0 ? to.acceleration * to.acceleration / (2 * limits.jerk) : 0;
    if (std::abs(to.velocity) + soon > limits.velocity * more) return false;
    if (!planned) return true;
    // A master that is planned behind the group and bends harder than half of that: what was foreseen of it does not fit to what it does.
    const double bend = limits.jerk * period * (1 + jerk_slack);
    return std::abs(to.acceleration - from.acceleration) <= bend + limit_digits &&
           std::abs(step - period * (to.acceleration + from.acceleration) / 2) <= bend * period / 2 + limit_digits;
}

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
    const auto& path = in.drive.path();
    const bool on = at.velocity > 0 || (at.velocity == 0 && at.acceleration >= 0);
    // Its acceleration has to go first: so fast it becomes, and so far on.
    const double faster = at.velocity * at.acceleration > 0 ? std::abs(at.acceleration) : 0, t = faster / path.room.jerk;
    const double soon = std::abs(at.velocity) + faster * t / 2;
    double way = std::abs(at.velocity) * t + faster * t * t / 3, s = in.place();
    std::uint32_t part = in.driven_part;
    for (std::uint32_t looked = 0; looked < path.sections; ++looked) {
        const RunSection& run = in.track->section(part);
        if (soon > run.fastest * (1 + limit_digits)) return true;
        const double left = (on ? run.section.end() - s : s - run.section.begin) - way;
        if (left >= 0) {
            const double then = on ? run.fastest_at_end : run.fastest_at_begin;
            return soon > fastest_in_front_of(then, left, path.room) * (1 + limit_digits);
        }
        way = -left;
        if (part == (on ? path.sections - 1 : 0) && path.driver.mode != mcPeriodic) return false;
        part = on ? (part + 1) % path.sections : (part + path.sections - 1) % path.sections;
        s = on ? in.track->section(part).section.begin : in.track->section(part).section.end();
    }
    return false;
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
    // What is measured trembles: its acceleration is told no sooner than the members could have it.
    for (std::size_t k = 0; !in.drive.planned() && k < in.members; ++k) {
        const double most = in.limits[k].jerk * in.period;
        in.acceleration[k] = std::clamp(in.acceleration[k], acceleration[k] - most, acceleration[k] + most);
        states_[in.places[k]].acceleration = in.acceleration[k];
    }
    for (std::size_t k = 0; inside && k < in.members; ++k) {
        const MotionState from{q[k], velocity[k], acceleration[k]}, to{in.q[k], in.velocity[k], in.acceleration[k]};
        inside = goes_on(from, to, in.limits[k], in.drive.planned(), in.period) && in.q[k] <= in.limits[k].high + limit_digits &&
                 in.q[k] >= in.limits[k].low - limit_digits;
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
    const bool ahead = in.drive.may_brake() && too_fast_ahead();
    if (!ahead && look_driven()) return;
    fault_ = ErrorId::none;
    if (in.drive.brake_instead(ErrorId::path_limit, period) && look_driven()) return;
    fault_ = ErrorId::path_limit;
}

}  // namespace taktwerk::axes

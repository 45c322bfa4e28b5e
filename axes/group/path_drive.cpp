#include "axes/group/path_drive.hpp"

#include <algorithm>
#include <cmath>

#include "axes/group/leading_axis.hpp"

namespace taktwerk::axes {
namespace {

/// Lengths are their own numbers.
constexpr SlaveFrame plain{0, 1};
constexpr double digits = 1e-9;  // of a length
/// Nothing that a master can do is held back: limits are watched, member by member (PathRun).
constexpr double beyond_master = 2;

double braking_way(double speed, const MotionLimits& ramp) noexcept {
    const double a = ramp.deceleration, j = ramp.jerk;
    return speed * j >= a * a ? speed * speed / (2 * a) + speed * a / (2 * j) : speed * std::sqrt(speed / j);
}

/// Between which places it stays if it begins to brake now: first its acceleration is taken away, and against its velocity that may turn it round.
struct RestSpan {
    double low, high;
};
RestSpan rest_span(const MotionState& at, const MotionLimits& ramp) noexcept {
    const double sense = at.velocity < 0 ? -1 : 1, v = std::abs(at.velocity), a = sense * at.acceleration, t = std::abs(a) / ramp.jerk;
    double on = 0, back = 0;
    if (a >= 0) {
        on = v * t + a * t * t / 3 + braking_way(v + a * t / 2, ramp);
    } else {
        on = braking_way(v, ramp);
        const double turned = -a * t / 2 - v;
        if (turned > 0) back = std::max(0.0, -a * t * t / 3 - v * t + braking_way(turned, ramp));
    }
    return sense > 0 ? RestSpan{at.position - back, at.position + on} : RestSpan{at.position - on, at.position + back};
}

double least_said(double said, double most) noexcept { return said > 0 ? std::min(said, most) : most; }

}  // namespace

double fastest_in_front_of(double then, double left, const MotionLimits& ramp) noexcept {
    const double lost = ramp.deceleration * ramp.deceleration / (2 * ramp.jerk);
    return std::max(then, std::sqrt(lost * lost + then * then + 2 * ramp.deceleration * std::max(left, 0.0)) - lost);
}

ErrorId PathDrive::refuse(const PathDriver& driver, const GroupMembers& members) const noexcept {
    if (driver.mode > mcPeriodic) return ErrorId::invalid_parameter;
    if (driver.numerator == 0 || driver.denominator == 0) return ErrorId::invalid_ratio;
    if (driver.master.index >= axes_.size() || members.contains(driver.master)) return ErrorId::invalid_master;
    // Who follows a member follows the path.
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i) && members.axis(i).is_followed_by(axes_[driver.master.index])) return ErrorId::coupling_loop;
    return leading_reading(axes_[driver.master.index]).usable ? ErrorId::none : ErrorId::invalid_master;
}

void PathDrive::begin(const DrivenPath& path) noexcept {
    end();
    path_ = path;
    const auto reading = leading_reading(axes_[path.driver.master.index]);
    feed_ = reading.feed;
    fastest_ = std::isfinite(reading.largest_velocity) ? reading.largest_velocity : 0;
    phase_ = Phase::waiting;
}

void PathDrive::end() noexcept {
    phase_ = Phase::off;
    fault_ = ErrorId::none;
    state_ = before_ = {};
    track_.forget();
    master_.reset();
    from_.reset();
    in_sync_ = locked_ = watched_ = false;
}

void PathDrive::watch(Instant now, Duration period) noexcept {
    if (!on()) return;
    const Axis& axis = axes_[path_.driver.master.index];
    watched_ = true;
    planned_ = leading_reading(axis).planned;
    period_ = to_seconds(period);
    master_.reset();
    if (axis.view().state != AxisState::ErrorStop) master_ = next_of_leading(track_, axis, now, period_);
    if (!from_ && master_) from_ = master_->place;
}

/// The master's way in u of the path. Of one product each, so that its rounding does not add up.
EndlessMotion PathDrive::demand() const noexcept {
    const double n = path_.driver.denominator, d = path_.driver.numerator;
    const auto& m = *master_;
    return {{0, n * way(*from_, m.place, feed_) / d}, n * m.velocity / d, n * m.acceleration / d, n * m.trend / d};
}

/// Coming up to the master and making up are inside the path's room; the master itself is not held back.
FollowerLimits PathDrive::limits(double demanded) const noexcept {
    const double ratio = std::abs(static_cast<double>(path_.driver.denominator) / path_.driver.numerator);
    const double most = beyond_master * std::max({fastest_ * ratio, path_.room.velocity, std::abs(demanded)});
    FollowerLimits all;
    all.axis = {most, most / period_, most / period_, std::numeric_limits<double>::infinity()};
    all.approach = path_.room;
    all.approach.acceleration = least_said(path_.said.acceleration, path_.room.acceleration);
    all.approach.deceleration = least_said(path_.said.deceleration, path_.room.deceleration);
    all.approach.jerk = least_said(path_.said.jerk, path_.room.jerk);
    const double making_up = std::max(path_.room.velocity, (1 + digits) * std::abs(demanded));
    all.forward = all.backward = in_sync_ ? most : std::max(making_up, std::abs(state_.velocity));
    return all;
}

MotionState PathDrive::next_of(Follower& follower, Duration period) const noexcept {
    const auto wanted = demand();
    follower.set_limits(limits(wanted.velocity));
    return follower.step(wanted, {}, state_, plain, period);
}

std::optional<double> PathDrive::end_passed(const MotionState& at) const noexcept {
    if (path_.driver.mode == mcPeriodic) return std::nullopt;
    const double grain = digits * std::max(1.0, path_.length);
    const auto [low, high] = rest_span(at, path_.room);
    if (!(low >= -grain)) return 0.0;
    if (!(high <= path_.length + grain)) return path_.length;
    return std::nullopt;
}

/// At rest: it goes with the master as soon as that leads along the path.
void PathDrive::wait(Duration period) noexcept {
    Follower trial = follower_;
    GearLine line;
    const auto wanted = demand();
    const double here = locked_ ? offset_ : state_.position - wanted.place.local;
    (void)line.set({1, 1}, 1, 1, {0, 0}, {0, here});
    trial.begin(line, locked_ ? RunDown::position : RunDown::velocity, limits(wanted.velocity));
    const MotionState next = next_of(trial, period);
    in_sync_ = false;
    if (end_passed(next)) return;
    follower_ = trial;
    phase_ = Phase::following;
    state_ = next;
}

void PathDrive::follow(Duration period) noexcept {
    const MotionState next = next_of(follower_, period);
    if (const auto end = end_passed(next)) return plan_to_end(*end, path_.room);
    state_ = next;
}

/// To rest at an end of the path, which it does not pass.
void PathDrive::plan_to_end(double end, const MotionLimits& ramp) noexcept {
    const double v = std::abs(state_.velocity), change = state_.acceleration * state_.acceleration / (2 * ramp.jerk);
    const double fastest = state_.velocity * state_.acceleration > 0 ? v + change : std::max(v, change - v);
    MotionLimits most = ramp;
    most.velocity = std::max(fastest, 1e-3 * path_.room.velocity);
    plan_ = plan_to_position(state_, end, most);
    since_ = {};
    phase_ = Phase::ending;
    in_sync_ = false;
}

void PathDrive::run_plan(Duration period) noexcept {
    since_ += period;
    const double t = to_seconds(since_);
    const auto& profile = plan_.profile;
    state_ = profile.at(std::min(t, profile.duration()));
    if (t < profile.duration()) return;
    state_.velocity = state_.acceleration = 0;
    phase_ = phase_ == Phase::ending ? Phase::waiting : Phase::resting;
}

void PathDrive::step(Duration period) noexcept {
    before_ = state_;
    if (!watched_) return;
    if (follows() && !master_) {
        fault_ = ErrorId::master_lost;
        stand({});
    }
    if (phase_ == Phase::waiting) wait(period);
    else if (phase_ == Phase::following) follow(period);
    if (phase_ == Phase::following) {
        in_sync_ = follower_.in_sync();
        locked_ = locked_ || in_sync_;
        if (in_sync_) offset_ = state_.position - demand().place.local;
    }
    if (phase_ == Phase::ending || phase_ == Phase::braking) run_plan(period);
}

void PathDrive::stand(const PathDynamics& wanted) noexcept {
    if (!follows() && phase_ != Phase::braking) return;
    MotionLimits ramp = path_.room;
    ramp.deceleration = least_said(wanted.deceleration, ramp.deceleration);
    ramp.jerk = least_said(wanted.jerk, ramp.jerk);
    ramp.velocity = std::max(ramp.velocity, 2 * std::abs(state_.velocity));
    soft_ = ramp.deceleration < path_.room.deceleration || ramp.jerk < path_.room.jerk;
    plan_ = plan_stop(state_, ramp);
    const double rests = plan_.profile.at(plan_.profile.duration()).position;
    if (path_.driver.mode != mcPeriodic && (rests < 0 || rests > path_.length)) plan_to_end(rests < 0 ? 0 : path_.length, path_.room);
    since_ = {};
    phase_ = Phase::braking;
    in_sync_ = false;
}

void PathDrive::go() noexcept {
    if (phase_ != Phase::resting) return;
    phase_ = Phase::waiting;
    locked_ = false;
}

bool PathDrive::brake_instead(ErrorId why, Duration period) noexcept {
    const bool followed = follows(), may = may_brake();
    state_ = before_;
    if (!may) return false;
    if (followed) fault_ = why;
    stand({});
    run_plan(period);
    return true;
}

double PathDrive::place() const noexcept {
    const double s = state_.position, all = path_.length;
    if (path_.driver.mode != mcPeriodic) return std::clamp(s, 0.0, all);
    const double lap = s - std::floor(s / all) * all;
    return lap < all ? std::max(lap, 0.0) : 0.0;
}

}  // namespace taktwerk::axes

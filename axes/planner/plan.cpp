#include "axes/planner/plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "axes/planner/velocity_ramp.hpp"

// How a position is reached. Let "push" be the fastest way to the velocity limit in one direction, held there for as long as one
// likes. Push for a while, then stop as fast as possible: the longer the push, the further the end, and no other motion gets to that
// end earlier. So the position problem has one unknown, the moment at which pushing ends. Pushing goes up if the plain stop
// ends below the target, down (in mirrored coordinates) if it ends beyond.

namespace taktwerk::axes {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

PlanError check(const MotionState& from, double target, const MotionLimits& limits) noexcept {
    const std::array inputs{from.position, from.velocity, from.acceleration, target};
    const std::array bounds{limits.velocity, limits.acceleration, limits.deceleration};
    for (double x : inputs) {
        if (!std::isfinite(x)) return PlanError::invalid_input;
    }
    for (double x : bounds) {
        if (!(x > 0) || std::isinf(x)) return PlanError::invalid_input;
    }
    if (!(limits.jerk > 0)) return PlanError::invalid_input;

    for (double x : inputs) {
        if (std::abs(x) > PlanBounds::largest) return PlanError::out_of_bounds;
    }
    for (double x : bounds) {
        if (x > PlanBounds::largest || x < PlanBounds::smallest_limit) return PlanError::out_of_bounds;
    }
    const bool jerk_in_bounds = limits.jerk >= PlanBounds::smallest_limit && limits.jerk <= PlanBounds::largest;
    return jerk_in_bounds || std::isinf(limits.jerk) ? PlanError::none : PlanError::out_of_bounds;
}

double without_negligible(double x) noexcept { return std::abs(x) < PlanBounds::negligible ? 0 : x; }

Plan refuse(const MotionState& from, PlanError error) noexcept { return {Profile{from}, error}; }

Plan to_velocity(const MotionState& from, double target_velocity, const TwoWayLimits& limits) noexcept {
    const VelocityRamp ramp{without_negligible(from.velocity), without_negligible(from.acceleration), without_negligible(target_velocity),
                            limits};
    // Only the last piece counts back from the end: it makes velocity and acceleration exact, the way is whatever it is.
    const auto stretches = ramp.stretches();
    const std::size_t forward = stretches.empty() ? 0 : stretches.size() - 1;
    return {Profile{from, stretches.first(forward), stretches.subspan(forward), {from.position + ramp.travel(), target_velocity, 0}},
            PlanError::none};
}

/// A cube root to within 5 %, for a first guess: a third of the exponent.
double rough_cube_root(double x) noexcept {
    constexpr std::uint64_t bias = 0x3FF0'0000'0000'0000;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + (bias - bias / 3));
}

/// A point of the push, positions counted from the start of the motion.
struct PushPoint {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;

    [[nodiscard]] PushPoint after(double t, double jerk) const noexcept {
        return {position + t * (velocity + t * (acceleration / 2 + t * (jerk / 6))), velocity + t * (acceleration + t * (jerk / 2)),
                acceleration + t * jerk};
    }
};

/// How much further the stop ends per unit of acceleration at its start, for a stop that takes acceleration away, holds, and gives it
/// back. It is the costate of the acceleration: a quadratic in time whose roots are the ends of the last stretch.
double end_per_acceleration(const VelocityRamp& stop) noexcept {
    const auto s = stop.stretches();
    if (s.size() < 2) return 0;
    const double first = s.front().duration;
    const double last_begins = stop.duration() - s.back().duration;
    return first * (last_begins + stop.duration() - first) / 2;
}

/// Finds the moment at which pushing ends, in coordinates where pushing goes up.
class PushSearch {
public:
    PushSearch(double way, double velocity, double acceleration, const TwoWayLimits& limits) noexcept
        : way_{way}, limits_{limits}, point_{0, velocity, acceleration} {}

    /// Stretches of the push, last one shortened to the found moment.
    std::array<Stretch, 7> push{};
    int push_count = 0;

    /// Returns the stop that follows the push.
    VelocityRamp run() noexcept {
        const double top = limits_.up.velocity;
        const VelocityRamp full{point_.velocity, point_.acceleration, top, limits_};
        const VelocityRamp from_top{top, 0, 0, limits_};
        const double shortest_with_cruise = full.travel() + from_top.travel();
        if (way_ >= shortest_with_cruise) {
            for (const Stretch& s : full.stretches()) push[static_cast<std::size_t>(push_count++)] = s;
            push[static_cast<std::size_t>(push_count++)] = {(way_ - shortest_with_cruise) / top, 0, 0};
            return from_top;
        }

        for (const Stretch& stretch : full.stretches()) {
            PushPoint begin = point_;
            begin.acceleration = stretch.acceleration;
            const PushPoint end = begin.after(stretch.duration, stretch.jerk);
            const double end_position = stop_position(end);
            push[static_cast<std::size_t>(push_count)] = stretch;
            ++push_count;
            if (end_position >= way_) {
                Stretch& last = push[static_cast<std::size_t>(push_count - 1)];
                last.duration = moment_within(stretch, begin, end_position);
                return stop_after(begin.after(last.duration, stretch.jerk));
            }
            point_ = end;
        }
        // Rounding only: the whole ramp and its stop fall short of what cruising would begin with.
        return stop_after(point_);
    }

private:
    VelocityRamp stop_after(const PushPoint& p) const noexcept { return {p.velocity, p.acceleration, 0, limits_}; }
    double stop_position(const PushPoint& p) const noexcept { return p.position + stop_after(p).travel(); }

    /// The root of a monotone function inside one stretch, by Newton's method kept inside a shrinking bracket.
    double moment_within(const Stretch& stretch, const PushPoint& begin, double end_position) const noexcept {
        if (std::isinf(limits_.up.jerk_on)) return moment_without_jerk(stretch, begin);

        double low = 0;
        double high = stretch.duration;
        // The end grows between linearly and with the fourth power of the moment; the cube is typical.
        const double none = stop_position(begin);
        if (way_ <= none) return 0;  // by rounding only
        double t = high * std::min(rough_cube_root((way_ - none) / (end_position - none)), 0.999);
        double best = high;
        double best_miss = std::abs(end_position - way_);
        double last_miss = std::numeric_limits<double>::infinity();
        for (int i = 0; i < max_root_steps; ++i) {
            const PushPoint p = begin.after(t, stretch.jerk);
            const VelocityRamp stop = stop_after(p);
            const double beyond = p.position + stop.travel() - way_;
            const double miss = std::abs(beyond);
            if (miss < best_miss) {
                best = t;
                best_miss = miss;
            }
            if (miss <= 2 * epsilon * (std::abs(way_) + stop.path())) break;
            (beyond < 0 ? low : high) = t;

            const double stop_jerk = stop.stretches().empty() ? 0 : stop.stretches().front().jerk;
            const double slope = (stretch.jerk - stop_jerk) * end_per_acceleration(stop);
            double next = t - beyond / slope;
            if (!(next > low && next < high) || miss > last_miss / 2) next = low + (high - low) / 2;
            last_miss = miss;
            if (next == t || !(next > low && next < high)) break;
            t = next;
        }
        return best;
    }

    /// Without a jerk limit the way up to speed v and down again is v^2/2a + v^2/2d: closed form.
    double moment_without_jerk(const Stretch& stretch, const PushPoint& begin) const noexcept {
        const double up = 1 / (2 * stretch.acceleration);
        const double down = 1 / (2 * limits_.down.slowing_down);
        const double v = begin.velocity;
        const double peak = std::sqrt(std::max((way_ - begin.position + v * v * up) / (up + down), 0.0));
        return std::clamp((peak - v) / stretch.acceleration, 0.0, stretch.duration);
    }

    double way_;
    TwoWayLimits limits_;
    PushPoint point_;
};

}  // namespace

Plan plan_to_velocity(const MotionState& from, double target_velocity, const MotionLimits& limits) noexcept {
    if (const PlanError error = check(from, target_velocity, limits); error != PlanError::none) return refuse(from, error);
    if (std::abs(target_velocity) > limits.velocity) return refuse(from, PlanError::out_of_bounds);
    return to_velocity(from, target_velocity, two_way(limits));
}

Plan plan_stop(const MotionState& from, const MotionLimits& limits) noexcept {
    if (const PlanError error = check(from, 0, limits); error != PlanError::none) return refuse(from, error);
    return to_velocity(from, 0, two_way(limits));
}

double stopping_distance(const MotionState& from, const MotionLimits& limits) noexcept {
    if (check(from, 0, limits) != PlanError::none) return std::numeric_limits<double>::quiet_NaN();
    return VelocityRamp{without_negligible(from.velocity), without_negligible(from.acceleration), 0, two_way(limits)}.travel();
}

Plan plan_to_position(const MotionState& from, double target, const MotionLimits& limits) noexcept {
    if (const PlanError error = check(from, target, limits); error != PlanError::none) return refuse(from, error);

    const TwoWayLimits both = two_way(limits);
    const double way = without_negligible(target - from.position);
    const double velocity = without_negligible(from.velocity);
    const double acceleration = without_negligible(from.acceleration);
    const MotionState end{target, 0, 0};
    const VelocityRamp stop{velocity, acceleration, 0, both};
    // As close as the numbers can tell. A correction of a rounding error would cost time that grows with its cube root.
    const double rounding = epsilon * (2 * stop.path() + std::max(std::abs(target), std::abs(from.position)) / 2);
    const double missing = way - stop.travel();
    if (missing == 0 || (std::abs(missing) <= rounding && !stop.stretches().empty()))
        return {Profile{from, {}, stop.stretches(), end}, PlanError::none};

    const double sign = missing > 0 ? 1 : -1;
    PushSearch search{sign * way, sign * velocity, sign * acceleration, sign > 0 ? both : both.mirrored()};
    const VelocityRamp last = search.run();

    std::array<Stretch, 6> backward{};
    std::size_t backward_count = 0;
    for (const Stretch& s : last.stretches()) backward[backward_count++] = {s.duration, sign * s.acceleration, sign * s.jerk};
    for (Stretch& s : search.push) s = {s.duration, sign * s.acceleration, sign * s.jerk};
    return {Profile{from, std::span{search.push}.first(static_cast<std::size_t>(search.push_count)),
                    std::span{backward}.first(backward_count), end},
            PlanError::none};
}

}  // namespace taktwerk::axes

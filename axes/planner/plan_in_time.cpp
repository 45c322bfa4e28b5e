// Fixed time. For a given duration the motions inside the limits form a convex set (where acceleration and deceleration are
// alike), so the ends they reach are an interval: from the least far extremal to the furthest. Inside it there is always a motion.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "axes/planner/bracketed_root.hpp"
#include "axes/planner/extremal.hpp"
#include "axes/planner/mixture.hpp"
#include "axes/planner/plan.hpp"
#include "axes/planner/plan_checks.hpp"
#include "axes/planner/precision.hpp"
#include "axes/planner/reduced_problem.hpp"

namespace taktwerk::axes {

namespace {

/// A ramp to velocity c, c held, a ramp to the end: with the time given, the end rises with c, whatever the signs of the velocities.
class Plateau {
public:
    Plateau(const Problem& problem, double time) noexcept
        : problem_{problem},
          back_{problem.limits.reversed().mirrored()},
          mirrored_{problem.limits.mirrored()},
          mirrored_back_{back_.mirrored()},
          time_{time},
          released1_{released_velocity(problem.v1, -problem.a1, back_)} {}

    struct At {
        Ramp first;
        Ramp last;
        double first_sign;
        double last_sign;
        double velocity;
        [[nodiscard]] double ramps() const noexcept { return first.duration() + last.duration(); }
        [[nodiscard]] double travel(double time) const noexcept {
            return first_sign * first.travel() + last_sign * last.travel() + velocity * (time - ramps());
        }
    };

    [[nodiscard]] At at(double c) const noexcept {
        const double up = c - problem_.released0;
        const double down = c - released1_;
        const double s = up < 0 ? -1 : 1;
        const double e = down < 0 ? -1 : 1;
        const FrameLimits& l = s < 0 ? mirrored_ : problem_.limits;
        const FrameLimits& b = e < 0 ? mirrored_back_ : back_;
        return {Ramp{climb_above_release(s * problem_.v0, s * problem_.a0, s * problem_.released0, std::abs(up), l), l},
                Ramp{climb_above_release(e * problem_.v1, -e * problem_.a1, e * released1_, std::abs(down), b), b}, s, e, c};
    }

    /// Between velocities `low` and `high`; nothing where the ramps to the velocity that would do take too long.
    [[nodiscard]] std::optional<Motion> between(double low, double high) const noexcept {
        // Counted from standstill where that lies between: near it a velocity has all its digits.
        double base = low;
        double sign = 1;
        double most = high - low;
        if (low < 0 && high > 0) {
            base = 0;
            sign = at(0).travel(time_) <= problem_.way ? 1 : -1;
            most = sign > 0 ? high : -low;
        }
        const auto miss_at = [&](double x) noexcept -> RootSample {
            const At m = at(base + sign * x);
            const double slope = (time_ - m.ramps()) + (m.first.fall_duration() + m.last.fall_duration()) / 2;
            const double rounding = 2 * epsilon * (std::abs(problem_.way) + m.first.path() + m.last.path() + std::abs(m.velocity) * time_);
            return {sign * (m.travel(time_) - problem_.way), slope, rounding};
        };
        const double c = base + sign * bracketed_root(miss_at, 0, most, most / 2, true);
        const At m = at(c);
        const double cruise = time_ - m.ramps();
        const double miss = std::abs(m.travel(time_) - problem_.way);
        const double scale = std::abs(problem_.way) + m.first.path() + m.last.path() + std::abs(c) * time_;
        if (cruise < 0 || miss > 16 * epsilon * scale) return std::nullopt;
        Motion motion;
        add_climb(motion.forward, m.first, m.first_sign);
        if (cruise > 0) motion.forward.add({cruise, 0, 0, c - m.first_sign * m.first.end_velocity()}, 1);
        add_descent(motion.backward, m.last, m.last_sign);
        return motion;
    }

    [[nodiscard]] double released1() const noexcept { return released1_; }

private:
    const Problem& problem_;
    FrameLimits back_;
    FrameLimits mirrored_;
    FrameLimits mirrored_back_;
    double time_;
    double released1_;
};

/// The highest (sign 1) or lowest velocity that an extremal of this duration cruises at or peaks at, or how far a plateau need be looked for.
double plateau_end(const Problem& problem, const Extremal& e, double released1, double sign) noexcept {
    const double from_ends = sign * std::max(sign * problem.released0, sign * released1);
    if (e.curve != Curve::peak_up && e.curve != Curve::peak_down) return from_ends;
    const Problem p = sign < 0 ? problem.mirrored() : problem;
    return sign * PeakFamily{p}.at(e.found.parameter).peak_velocity;
}

struct Interval {
    Extremal least;
    Extremal most;
    Motion least_motion;
    Motion most_motion;
    Walked least_walked;
    Walked most_walked;
};

std::optional<Interval> reach_in(const Problem& problem, double time, double slack) noexcept {
    Interval i;
    i.most = furthest(problem, time, slack);
    i.least = least_far(problem, time, slack);
    if (!i.most.found.found || !i.least.found.found) return std::nullopt;
    i.most_motion = motion_of(problem, i.most);
    i.least_motion = motion_of(problem, i.least);
    i.most_walked = walk(problem.v0, i.most_motion);
    i.least_walked = walk(problem.v0, i.least_motion);
    return i;
}

std::optional<Motion> solve(const Problem& problem, double time, double slack, double known_to) noexcept {
    const auto reach = reach_in(problem, time, slack);
    if (!reach) return std::nullopt;
    // Each end has rounding errors of its own: the other one may be astronomically far.
    const auto rounding = [&](const Walked& w) noexcept -> double {
        return known_to + epsilon * (64 * (std::abs(problem.way) + w.path) + 8 * w.top * time);
    };
    const double most = reach->most_walked.travel;
    const double least = reach->least_walked.travel;
    const double of_most = rounding(reach->most_walked);
    const double of_least = rounding(reach->least_walked);
    if (problem.way > most + of_most || problem.way < least - of_least) return std::nullopt;
    if (problem.way >= most - of_most) return reach->most_motion;
    if (problem.way <= least + of_least) return reach->least_motion;

    const Plateau plateau{problem, time};
    const double low = plateau_end(problem, reach->least, plateau.released1(), -1);
    const double high = plateau_end(problem, reach->most, plateau.released1(), 1);
    if (auto motion = plateau.between(low, high)) return motion;
    if (!problem.limits.convex() && !keeps_direction(problem.v0, reach->least_motion, reach->most_motion)) return std::nullopt;
    const double share = (problem.way - least) / (most - least);
    return mixture(reach->least_motion, reach->most_motion, share);
}

/// The same bounds on both sides of velocity 0: the smaller.
SignedLimits made_convex(const SignedLimits& l) noexcept {
    SignedLimits same = l;
    for (SignLimits* s : {&same.positive, &same.negative}) s->speeding_up = s->slowing_down = std::min(s->speeding_up, s->slowing_down);
    return same;
}

std::optional<Profile> arrive(const MotionState& from, const MotionState& target, double duration, const SignedLimits& limits) noexcept {
    const ReducedProblem reduced{from, target, limits};
    if (reduced.target_is_outside() || !reduced.target_releases()) return std::nullopt;
    const double slack = 32 * epsilon * duration;
    const double time = duration - reduced.brake.duration();
    if (time < -slack) return std::nullopt;
    const auto motion = solve(reduced.problem, std::max(time, 0.0), slack, reduced.rounding());
    if (!motion) return std::nullopt;
    return reduced.profile(*motion);
}

}  // namespace

Plan plan_in_time(const MotionState& from, const MotionState& target, double duration, const SignedLimits& limits) noexcept {
    PlanError error = worse(check_plan(from, target, limits), check_number(duration));
    if (error == PlanError::none && duration < 0) error = PlanError::invalid_input;
    if (error == PlanError::none && ReducedProblem{from, target, limits}.target_is_outside()) error = PlanError::target_outside_limits;
    if (error != PlanError::none) return {Profile{from}, error};

    auto profile = arrive(from, target, duration, limits);
    if (!profile && !frame_limits(limits).convex()) profile = arrive(from, target, duration, made_convex(limits));
    if (!profile) return {Profile{from}, PlanError::no_solution};
    return {*profile, PlanError::none};
}

}  // namespace taktwerk::axes

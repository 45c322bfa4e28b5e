#pragma once
// Random motions from any state to any state over all scales, with limits per sign, some of them infinite.

#include <array>
#include <cstddef>
#include <ostream>
#include <stdexcept>

#include "axes/planner/reduced_problem.hpp"
#include "tests/axes/planner/plan_figures.hpp"
#include "tests/axes/planner/random_motion.hpp"

namespace taktwerk::axes {

struct StateCase {
    MotionState from;
    MotionState target;
    SignedLimits limits;

    friend std::ostream& operator<<(std::ostream& out, const StateCase& c) {
        out.precision(17);
        const auto state = [&](const MotionState& s) { out << "{" << s.position << ", " << s.velocity << ", " << s.acceleration << "}, "; };
        const auto sign = [&](const SignLimits& l) {
            out << "{" << l.velocity << ", " << l.speeding_up << ", " << l.slowing_down << ", " << l.jerk << "}";
        };
        state(c.from);
        state(c.target);
        sign(c.limits.positive);
        out << ", ";
        sign(c.limits.negative);
        return out;
    }
};

class RandomStates {
public:
    explicit RandomStates(std::uint64_t seed) : random_{seed} {}

    RandomMotion& numbers() { return random_; }

    /// The target is one at which a motion inside the limits can arrive; the start is anything.
    StateCase next() {
        for (int draws = 0; draws < 100'000; ++draws)
            if (StateCase c = draw(); can_arrive(c)) return c;
        throw std::logic_error{"no target of 100,000 at which a motion inside the limits can arrive"};
    }

private:
    static bool can_arrive(const StateCase& c) {
        const FrameLimits back = frame_limits(c.limits).reversed().mirrored();
        const double a = back.jerk_free() ? 0 : c.target.acceleration;
        return keeps_limits(c.target.velocity, -a, back, 0) && is_inside(c.target.velocity, -c.target.acceleration, back, 0);
    }
    StateCase draw() {
        const double length = random_.decades(-6, 9);
        const double time = random_.decades(-3, 3);
        const double v = length / time;
        const double a = v / time;
        const double j = a / time;
        StateCase c{{}, {}, limits(v * random_.decades(-1.5, 1.5), a * random_.decades(-1.5, 1.5), j * random_.decades(-1.5, 3))};
        c.from = {length * random_.uniform(-1, 1), state_of(c.limits.positive.velocity, c.limits.negative.velocity, v),
                  state_of(c.limits.positive.speeding_up, c.limits.negative.speeding_up, a)};
        if (random_.one_of(6) == 0) c.from.velocity = c.from.acceleration = 0;
        if (random_.one_of(5) == 0) {
            // Close by: a few moments of constant jerk away, ahead or behind.
            const double t = time * random_.decades(-4, 0);
            const double jerk = random_.uniform(-1, 1) * (std::isinf(c.limits.positive.jerk) ? j : c.limits.positive.jerk);
            const MotionState& s = c.from;
            c.target = {s.position + t * (s.velocity + t * (s.acceleration / 2 + t * jerk / 6)),
                        s.velocity + t * (s.acceleration + t * jerk / 2), s.acceleration + t * jerk};
            if (random_.one_of(2) == 0) c.target.position = 2 * s.position - c.target.position;
            return c;
        }
        c.target.velocity = state_of(c.limits.positive.velocity, c.limits.negative.velocity, v);
        c.target.acceleration = state_of(c.limits.positive.slowing_down, c.limits.negative.slowing_down, a);
        switch (random_.one_of(5)) {
            case 0: c.target.position = c.from.position; break;
            case 1: c.target.position = c.from.position + (c.from.velocity + c.target.velocity) / 2 * time * random_.decades(-2, 1); break;
            case 2: c.target.position = c.from.position + sign() * length * random_.decades(-9, 0); break;
            default: c.target.position = c.from.position + sign() * length * random_.decades(-2, 2); break;
        }
        return c;
    }

    SignedLimits limits(double v, double a, double j) {
        const double d = a * random_.decades(-1, 1);
        SignLimits up{v, a, a, j};
        SignLimits down = up;
        switch (random_.one_of(4)) {
            case 0: break;
            case 1: up.slowing_down = down.slowing_down = d; break;
            case 2: down = {v * random_.decades(-1, 1), d, d, j * random_.decades(-1, 1)}; break;
            default:
                up.slowing_down = d;
                down = {v * random_.decades(-1, 1), a * random_.decades(-1, 1), a * random_.decades(-1, 1), j * random_.decades(-1, 1)};
                break;
        }
        if (random_.one_of(8) == 0) up.jerk = down.jerk = unlimited;
        else if (random_.one_of(8) == 0) up.jerk = unlimited;
        else if (random_.one_of(8) == 0) down.speeding_up = up.slowing_down = unlimited;
        else if (random_.one_of(8) == 0) up.speeding_up = up.slowing_down = down.speeding_up = down.slowing_down = unlimited;
        if (random_.one_of(8) == 0) up.velocity = unlimited;
        if (random_.one_of(8) == 0) down.velocity = unlimited;
        SignedLimits l{up, down};
        const bool nothing = check_limits(l) != PlanError::none;
        if (nothing) l.positive.velocity = l.negative.velocity = v;
        return l;
    }

    double sign() { return random_.one_of(2) == 0 ? -1 : 1; }
    double state_of(double up, double down, double typical) {
        const double s = sign();
        const double limit = s > 0 ? up : down;
        const double most = std::isinf(limit) ? typical : limit;
        switch (random_.one_of(10)) {
            case 0:
            case 1: return 0;
            case 2: return s * most;
            case 3: return s * most * (1 + random_.uniform(-1e-12, 1e-12));
            case 4: return s * most * random_.uniform(1, 3);
            case 5: return s * most * random_.decades(-12, 0);
            default: return s * most * random_.uniform(0, 1);
        }
    }

    RandomMotion random_;
};

/// What is extreme on the way: at the ends of the pieces and where the acceleration passes 0.
template <typename See>
void for_extremes(const Profile& profile, See see) {
    for (int i = 0; i < profile.piece_count(); ++i) {
        const double begin = profile.piece_begin(i);
        const double end = profile.piece_end(i);
        const MotionState first = profile.on_piece(i, begin);
        const MotionState last = profile.on_piece(i, end);
        see(first, i);
        if (first.acceleration * last.acceleration < 0) see(profile.on_piece(i, begin - first.acceleration / profile.piece_jerk(i)), i);
        see(last, i);
    }
}

/// Magnitudes on the way, for tolerances. The time of a state is known to a rounding of the whole duration, and of the time in which
/// the jerk builds an acceleration up (that one is known to its own rounding), so each derivative times that belongs to the magnitude
/// of what it changes.
struct Magnitudes {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    double time = 0;

    Magnitudes(const StateCase& c, const Profile& profile) : time{profile.duration()} {
        see(c.from);
        see(c.target);
        for_extremes(profile, [&](const MotionState& s, int) { see(s); });
        double jerk = 0;
        for (int i = 0; i < profile.piece_count(); ++i) jerk = std::max(jerk, std::abs(profile.piece_jerk(i)));
        const double gentlest = std::min(c.limits.positive.jerk, c.limits.negative.jerk);
        const double known = time + (std::isinf(gentlest) ? 0 : acceleration / gentlest);
        position += velocity * known;
        velocity += acceleration * known;
        acceleration += jerk * time;
    }

private:
    void see(const MotionState& s) {
        position = std::max(position, std::abs(s.position));
        velocity = std::max(velocity, std::abs(s.velocity));
        acceleration = std::max(acceleration, std::abs(s.acceleration));
    }
};

}  // namespace taktwerk::axes

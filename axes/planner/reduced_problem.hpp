#pragma once
// A plan from start to target, reduced to the problem that begins where braking into the limits ends. Internal to the planner.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/planner/brake_choice.hpp"
#include "axes/planner/extremal.hpp"
#include "axes/planner/plan_checks.hpp"
#include "axes/planner/precision.hpp"

namespace taktwerk::axes {

struct ReducedProblem {
    ReducedProblem(const MotionState& start, const MotionState& end, const SignedLimits& signed_limits) noexcept
        : from{start},
          target{end},
          limits{frame_limits(signed_limits)},
          brake{brake_towards(without_negligible(start.velocity), without_negligible(start.acceleration), without_negligible(end.velocity),
                              limits.jerk_free() ? 0 : without_negligible(end.acceleration), end.position - start.position, limits)},
          problem{brake.velocity(),
                  brake.acceleration(),
                  without_negligible(end.velocity),
                  limits.jerk_free() ? 0 : without_negligible(end.acceleration),
                  without_negligible((end.position - start.position) - brake.travel()),
                  brake.released(),
                  brake.reduced_velocity(),
                  limits} {}

    struct Unbraked {};
    /// From the start as it is.
    ReducedProblem(const MotionState& start, const MotionState& end, const SignedLimits& signed_limits, Unbraked) noexcept
        : from{start},
          target{end},
          limits{frame_limits(signed_limits)},
          brake{0, 0, limits},
          problem{start.velocity,
                  start.acceleration,
                  end.velocity,
                  end.acceleration,
                  end.position - start.position,
                  released_velocity(start.velocity, start.acceleration, limits),
                  false,
                  limits} {}

    /// Outside the limits, or bound to cross velocity 0 outside them before the target. (Otherwise a brake only prevents what would
    /// come later.)
    [[nodiscard]] bool start_is_outside() const noexcept {
        FrameLimits at_any_velocity = limits;
        at_any_velocity.up.velocity = at_any_velocity.down.velocity = std::numeric_limits<double>::infinity();
        const double v = from.velocity;
        const double a = from.acceleration;
        // Beyond a velocity limit, and not on a sure way back inside.
        const double released = released_velocity(v, a, limits);
        const bool runs_away =
            (v > limits.up.velocity && released > limits.up.velocity) || (-v > limits.down.velocity && -released > limits.down.velocity);
        return limits.jerk_free() || runs_away || !is_inside(v, a, at_any_velocity, 0) ||
               (v * target.velocity < 0 && !keeps_limits(v, a, at_any_velocity, 0));
    }
    [[nodiscard]] bool target_is_at_rest() const noexcept { return problem.v1 == 0 && problem.a1 == 0; }
    [[nodiscard]] bool target_is_outside() const noexcept {
        if (target_is_at_rest()) return false;
        return !is_inside(problem.v1, -problem.a1, limits.reversed().mirrored(), slack);
    }
    /// Could a motion inside the limits arrive with the target's acceleration built up from 0? Backwards in time it must be able to leave.
    [[nodiscard]] bool target_releases() const noexcept {
        if (target_is_at_rest()) return true;
        return keeps_limits(problem.v1, -problem.a1, limits.reversed().mirrored(), slack);
    }

    /// What the way is known to: a few units in the last place of the positions and of what braking covers. A correction of a rounding
    /// error would cost time that grows with its cube root, and more where both ends move: a target just missed has to be approached
    /// again. From rest or to rest one unit in the last place is a move.
    [[nodiscard]] double rounding() const noexcept {
        const bool both_move = (problem.v0 != 0 || problem.a0 != 0) && (problem.v1 != 0 || problem.a1 != 0);
        double known_to = std::max(std::abs(from.position), std::abs(target.position)) * (both_move ? 4 : 0.5) + 2 * brake.path();
        if (both_move) {
            // An acceleration known to its rounding is a time known to that over the jerk.
            const double ease = std::max(limits.up.ease, limits.down.ease);
            known_to += 2 * ease * (std::abs(problem.v0 * problem.a0) + std::abs(problem.v1 * problem.a1));
        }
        return epsilon * known_to;
    }

    [[nodiscard]] Profile profile(const Motion& motion) const noexcept {
        if (brake.stretches().empty()) return Profile{from, motion.forward.stretches(), motion.backward.stretches(), target};
        Chain forward;
        for (const Stretch& s : brake.stretches()) forward.add(s, 1);
        for (const Stretch& s : motion.forward.stretches()) forward.add(s, 1);
        return Profile{from, forward.stretches(), motion.backward.stretches(), target};
    }

    static constexpr double slack = 16 * epsilon;

    MotionState from;
    MotionState target;
    FrameLimits limits;
    Brake brake;
    Problem problem;
};

}  // namespace taktwerk::axes

#include "axes/axis/junction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "axes/planner/reach.hpp"

namespace taktwerk::axes {

namespace {

// A velocity taken from a search is true to some 1e-15; a motion that would need a little more must not go back and forth for it.
constexpr double surely = 1 - 1e-10;

[[nodiscard]] MotionLimits with_velocity(MotionLimits limits, double velocity) noexcept {
    limits.velocity = velocity;
    return limits;
}

[[nodiscard]] SignedLimits with_velocity(SignedLimits limits, double velocity) noexcept {
    limits.positive.velocity = limits.negative.velocity = velocity;
    return limits;
}

/// The highest speed with which `move` can begin so that it ends with `exit` (signed).
double highest_entry(const ChainMove& move, double exit, double rule) noexcept {
    if (move.end == ChainMove::End::none) return std::numeric_limits<double>::infinity();
    const auto limits = with_velocity(move.limits, std::max({rule, move.speed, std::abs(exit)}));
    const double highest = std::abs(highest_entry_velocity(move.way, exit, SignedLimits{limits}));
    return std::isnan(highest) ? 0 : highest;
}

}  // namespace

double blending_velocity(MC_BufferMode mode, double first, double second) noexcept {
    switch (mode) {
        case mcBlendingLow: return std::min(first, second);
        case mcBlendingPrevious: return first;
        case mcBlendingNext: return second;
        case mcBlendingHigh: return std::max(first, second);
        case mcAborting:
        case mcBuffered: break;
    }
    return 0;
}

double junction_velocity(std::span<const ChainMove> chain) noexcept {
    if (chain.empty()) return 0;
    const auto& last = chain.back();
    double exit = last.end == ChainMove::End::velocity ? last.end_velocity : 0;
    for (std::size_t i = chain.size() - 1; i > 0; --i) {
        const auto& first = chain[i - 1];
        const auto& second = chain[i];
        if (first.end == ChainMove::End::velocity) {
            exit = first.end_velocity;
            continue;
        }
        const double rule = blending_velocity(second.mode, first.speed, second.speed);
        const bool turns = first.way * second.way < 0 || first.way == 0;
        if (turns || rule == 0) {
            exit = 0;
            continue;
        }
        const double highest = highest_entry(second, exit, rule);
        exit = std::copysign(rule <= highest ? rule : highest * surely, first.way);
    }
    return exit;
}

double nearest_reachable(double wanted, const MotionState& from, double position, const SignedLimits& limits) noexcept {
    const double sense = wanted < 0 ? -1 : 1;
    const double way = sense * (position - from.position);
    if (wanted == 0 || !(way > 0)) return 0;
    const MotionState here{0, sense * from.velocity, sense * from.acceleration};
    const double speed = sense * wanted;
    const double fastest = std::max({limits.positive.velocity, limits.negative.velocity, speed, std::abs(from.velocity)});
    const auto free = with_velocity(sense < 0 ? SignedLimits{limits.negative, limits.positive} : limits, fastest * 2);
    const auto travel = [&](double velocity) noexcept { return plan_to_velocity(here, velocity, free).profile.end().position; };
    if (travel(speed) <= way) return wanted;

    const double highest = highest_reachable_velocity(way, here.velocity, here.acceleration, free);
    if (!(highest > 0)) return 0;
    if (speed >= highest) return sense * highest * surely;
    // Too fast to get down to it before P1: the lowest velocity that can be had there. Travel falls while the velocity rises.
    double low = speed, high = highest;
    for (int i = 0; i < 48; ++i) {
        const double middle = low + (high - low) / 2;
        (travel(middle) <= way ? high : low) = middle;
    }
    return sense * high;
}

Plan plan_through(const MotionState& from, const MotionState& target, const SignedLimits& limits) noexcept {
    const double arrival = std::abs(target.velocity);
    const bool back = target.velocity < 0;
    const double along = (back ? limits.negative : limits.positive).velocity;
    if (arrival <= along) return plan_to_state(from, target, limits);

    // The last part: from the move's own velocity up to the one it has to arrive with, counted back from the target.
    auto fast = limits;
    const double against = (back ? limits.positive : limits.negative).velocity;
    if (against == along) fast = with_velocity(limits, arrival);
    else (back ? fast.negative : fast.positive).velocity = arrival;
    const double own = std::copysign(along, target.velocity);
    const Profile ramp = plan_to_velocity({0, own, 0}, target.velocity, fast).profile;
    const MotionState middle{target.position - ramp.end().position, own, 0};
    const double sense = target.velocity < 0 ? -1 : 1;
    const bool onward = sense * (target.position - from.position) > 0;
    const bool too_short = onward && sense * (middle.position - plan_to_velocity(from, own, fast).profile.end().position) < 0;
    if (!too_short) {
        Plan plan = plan_to_state(from, middle, limits);
        std::array<Stretch, Profile::max_pieces> stretches{};
        std::size_t count = 0;
        for (int i = 0; i < ramp.piece_count(); ++i)
            stretches[count++] = {ramp.piece_end(i) - ramp.piece_begin(i), ramp.on_piece(i, ramp.piece_begin(i)).acceleration,
                                  ramp.piece_jerk(i), 0};
        const Profile last{middle, {}, std::span<const Stretch>(stretches.data(), count), target};
        if (plan.error == PlanError::none && plan.profile.append(last)) return plan;
    }
    return plan_to_state(from, target, fast);
}

}  // namespace taktwerk::axes

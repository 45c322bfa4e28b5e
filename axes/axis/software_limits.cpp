#include "axes/axis/software_limits.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/direction_limits.hpp"
#include "axes/axis/stop_reach.hpp"
#include "axes/axis/superimposed_motion.hpp"

namespace taktwerk::axes {

double SoftwareLimits::layers_in_base() const noexcept { return motion_.summed && motion_.setpoint.superimposed_finished() ? 2 : 1; }

void SoftwareLimits::brake_as_both_layers(const MotionState& from, double sense, double room, MotionLimits& limits) const noexcept {
    if (layers_in_base() == 1 || reach_of_stop(from, in_each_direction(limits, body_.config.limits), sense) <= room) return;
    limits.deceleration = std::max(limits.deceleration, layers_in_base() * body_.config.limits.deceleration);
    limits.jerk = std::max(limits.jerk, layers_in_base() * body_.config.limits.jerk);
}

void SoftwareLimits::brake_inside_limits(const MotionState& from, MotionLimits& limits) const noexcept {
    if (!body_.software_limits_hold() || (from.velocity == 0 && from.acceleration == 0)) return;
    for (const double sense : {1.0, -1.0}) {
        const double edge = body_.units.to_local(sense > 0 ? body_.config.limits.position_max : body_.config.limits.position_min);
        const double room = sense * (edge - from.position);
        const auto& axis = body_.config.limits;
        if (room >
            stops_within(from,
                         {.deceleration = limits.deceleration, .jerk = limits.jerk, .positive = axis.positive, .negative = axis.negative}))
            continue;
        // What turns back in front of the limit was within it by that only: the next command could not rely on it.
        const double reach = reach_of_stop(from, in_each_direction(limits, axis), sense);
        if (reach <= 0 || (reach <= room && !turns_back(from, limits.jerk, sense))) continue;
        limits.deceleration = std::max(limits.deceleration, body_.config.limits.deceleration);
        limits.jerk = std::max(limits.jerk, body_.config.limits.jerk);
        brake_as_both_layers(from, sense, room, limits);
    }
}

bool SoftwareLimits::release_below_limit(const MotionState& from, MotionLimits& limits) const noexcept {
    if (from.acceleration == 0) return false;
    const double sense = from.acceleration > 0 ? 1 : -1;
    const double beside = addition_.reach(sense);
    const double room = body_.config.limits.velocity_towards(sense) - beside - sense * from.velocity;
    const double needed = from.acceleration * from.acceleration / 2;
    if (needed <= limits.jerk * room) return false;
    constexpr double surely = 1 + 1e-9;
    const double most = body_.config.limits.jerk * layers_in_base();
    limits.jerk = std::max(limits.jerk, room > 0 ? std::min(surely * needed / room, most) : most);
    return true;
}

bool SoftwareLimits::leaves_limits(const Profile& profile) const noexcept {
    if (!body_.software_limits_hold()) return false;
    const double low = body_.units.to_local(body_.config.limits.position_min);
    const double high = body_.units.to_local(body_.config.limits.position_max);
    const auto outside = [&](double position) noexcept { return position < low || position > high; };
    if (profile.end().velocity != 0) return true;  // it goes on
    for (int i = 0; i < profile.piece_count(); ++i) {
        const double begin = profile.piece_begin(i);
        const double length = profile.piece_end(i) - begin;
        const auto first = profile.on_piece(i, begin);
        const auto last = profile.on_piece(i, begin + length);
        // Inside a piece the position turns where the velocity is 0; no further away than the way at its highest speed.
        const double jerk = profile.piece_jerk(i);
        const double top = jerk != 0 ? -first.acceleration / jerk : -1;  // where the acceleration is 0
        const double extreme = top > 0 && top < length ? first.velocity + first.acceleration * top / 2 : first.velocity;
        const double most = length * std::max({std::abs(first.velocity), std::abs(last.velocity), std::abs(extreme)});
        const bool turns = first.velocity * last.velocity < 0 || first.velocity * extreme < 0;
        if (i > 0 && outside(first.position)) return true;
        if (turns && (outside(first.position - most) || outside(first.position + most))) return true;
    }
    return false;
}

bool SoftwareLimits::sum_stays_inside() const noexcept {
    if (motion_.setpoint.end().velocity != 0) return false;
    const double base = motion_.setpoint.base().position, part = motion_.setpoint.superimposed().position;
    const double base_way = motion_.setpoint.end().position - base, part_way = motion_.setpoint.superimposed_rest();
    const double highest = base + part + std::max(base_way, 0.0) + std::max(part_way, 0.0);
    const double lowest = base + part + std::min(base_way, 0.0) + std::min(part_way, 0.0);
    const double rounding = 1e-12 * (std::abs(highest) + std::abs(lowest));
    return highest <= body_.units.to_local(body_.config.limits.position_max) + rounding &&
           lowest >= body_.units.to_local(body_.config.limits.position_min) - rounding;
}

}  // namespace taktwerk::axes

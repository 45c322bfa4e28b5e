#pragma once
// A straight line in the members' own coordinates, and the members' limits along it. Real-time safe.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "axes/axis/axis_config.hpp"
#include "axes/group/group_types.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// From a point to another: at the length s every member is at from + s * direction, and at `to` where s is `length`.
struct StraightWay {
    JointVector from{}, to{}, direction{};
    double length = 0;  ///< Euclidean norm over the members

    /// Places whose numbers are equal in both do not move.
    [[nodiscard]] static StraightWay between(const JointVector& from, const JointVector& to) noexcept {
        StraightWay way{from, to, {}, 0};
        // Scaled by the largest, so that squares neither vanish nor overflow.
        double largest = 0;
        for (std::size_t i = 0; i < most_members; ++i) largest = std::max(largest, std::abs(to[i] - from[i]));
        if (largest == 0) return way;
        double sum = 0;
        for (std::size_t i = 0; i < most_members; ++i) {
            const double part = (to[i] - from[i]) / largest;
            sum += part * part;
        }
        way.length = largest * std::sqrt(sum);
        for (std::size_t i = 0; i < most_members; ++i) way.direction[i] = (to[i] - from[i]) / way.length;
        return way;
    }
    [[nodiscard]] MotionState at(std::size_t place, const MotionState& s) const noexcept {
        const double position = s.position == length ? to[place] : from[place] + s.position * direction[place];
        return {position, direction[place] * s.velocity, direction[place] * s.acceleration};
    }
};

/// What the members' limits leave along a way, and whose velocity is the narrowest.
struct WayLimits {
    MotionLimits along{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    std::uint8_t narrowest = 0;

    void take(std::size_t place, double direction, const AxisLimits& axis) noexcept {
        const double share = std::abs(direction);
        if (share == 0) return;
        if (const double velocity = axis.velocity_towards(direction) / share; velocity < along.velocity) {
            along.velocity = velocity;
            narrowest = static_cast<std::uint8_t>(place);
        }
        along.acceleration = std::min(along.acceleration, axis.acceleration_towards(direction) / share);
        along.deceleration = std::min(along.deceleration, axis.deceleration_towards(direction) / share);
        along.jerk = std::min(along.jerk, axis.jerk / share);
    }
};

}  // namespace taktwerk::axes

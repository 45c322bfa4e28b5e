#pragma once
// The torque that the load takes beside its inertia: gravity, Coulomb and viscous friction at the set velocity. Knows no axis; real-time safe.
//
// Coulomb friction changes its sign with the velocity; fed forward as a step it would be a blow at each reversal. v / sqrt(v^2 + w^2) goes through zero
// smoothly: 0 at standstill, so that an axis at rest is not pushed, 0.71 at the friction velocity w, 0.98 at five times it. Gravity comes in over
// a tenth of a second: the drive's own loop has it already when it begins to hold, and gives it back meanwhile.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_config.hpp"

namespace taktwerk::axes {

class LoadFeedForward {
public:
    static constexpr double comes_in = 0.1;  ///< s

    /// `velocity_limit` u/s, of the axis as configured.
    LoadFeedForward(const LoadTorque& load, double velocity_limit) noexcept
        : load_(load), width_(load.friction_velocity > 0 ? load.friction_velocity : velocity_limit / 100), used_(load.used()) {}

    [[nodiscard]] bool used() const noexcept { return used_; }

    /// One period of `dt` seconds at the set velocity, u/s; `held`: the drive follows set-points. Rated torques, in the axis' sense.
    double step(double velocity, bool held, double dt) noexcept {
        share_ = held ? std::min(1.0, share_ + dt / comes_in) : 0;
        return share_ * load_.gravity + load_.viscous_friction * velocity +
               load_.coulomb_friction * velocity / std::sqrt(velocity * velocity + width_ * width_);
    }

private:
    LoadTorque load_;
    double width_;  // u/s
    bool used_;
    double share_ = 0;  // of gravity
};

}  // namespace taktwerk::axes

#pragma once
// Stands of an arm: anywhere, and on or next to its singularities and the angles at which formulas degenerate.

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {

class RandomStands {
public:
    explicit RandomStands(std::uint64_t seed) : random_{seed} {}

    double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }
    int one_of(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
    /// 0, or of either sign from 1e-15 to 0.1.
    double tiny() { return one_of(4) == 0 ? 0 : (one_of(2) == 0 ? 1 : -1) * std::pow(10.0, uniform(-15, -1)); }

    Joints next(const PublishedArm& arm, const std::array<bool, max_joints>& rotary) {
        Joints q{};
        for (std::size_t i = 0; i < max_joints; ++i) q[i] = uniform(arm.low[i], arm.high[i]);
        // One or more joints at a multiple of 90 degrees, or almost, within the range.
        if (one_of(2) == 0)
            for (std::size_t i = 0; i < max_joints; ++i) {
                if (!rotary[i] || one_of(2) == 0) continue;
                const double angle = 90 * degree * (one_of(5) - 2) + tiny();
                q[i] = std::clamp(angle, arm.low[i], arm.high[i]);
            }
        return q;
    }

private:
    std::mt19937_64 random_;
};

}  // namespace taktwerk::axes

#pragma once
// The last step to a pose by Newton's method, for arms that have no closed form: from a seed that a neighbouring arm gave. Pure, real-time
// safe: at most max_refine_steps steps.

#include "axes/kinematics/chain.hpp"

namespace taktwerk::axes {

inline constexpr int max_refine_steps = 60;
/// Of all seeds together, where one way is asked for.
inline constexpr int max_refine_steps_in_all = 120;
/// What may be left of a pose: position as a share of `reach`, orientation in rad.
inline constexpr double refine_rounding = 1e-12;

struct Refined {
    Joints joints{};
    double left = 0;  ///< length of what is left: position over reach with the rotation vector
    int steps = 0;

    [[nodiscard]] bool ok() const noexcept { return left <= refine_rounding; }
};

/// Joints of `chain` that bring its flange to `flange`, near `seed`, in `steps` steps at most. Plain Newton steps while they help; where one does not (near a singularity,
/// or from a far seed), damped ones. `reach` > 0 weighs lengths against angles.
[[nodiscard]] Refined refine(const JointChain& chain, const Frame<double>& flange, const Joints& seed, double reach,
                             int steps = max_refine_steps) noexcept;

}  // namespace taktwerk::axes

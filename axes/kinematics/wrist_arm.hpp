#pragma once
// Six joints with a spherical wrist, in closed form: all eight ways of reaching a pose. Pure, real-time safe.

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/chain.hpp"

namespace taktwerk::axes {

/// A chain read as an arm with parallel axes 2 and 3, both at right angles to axis 1, and axes 4 to 6 through one point. Where the chain is
/// not quite that (calibrated, or with an offset in its wrist), this is a neighbour of it: its solutions are where a numeric solver begins.
class WristArm {
public:
    WristArm() = default;
    /// Axes 1 and 2 must not be parallel, nor axis 4 and axis 2, nor may axes 2 and 3, or 3 and the wrist's centre, be one.
    explicit WristArm(const JointChain& chain) noexcept;

    /// All ways, in the chain's joints, in whatever turn. `near`: what keeps its value where a joint is free (in a singularity).
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    [[nodiscard]] Branch branch(const Joints& joints) const noexcept;
    /// shoulder: distance of the wrist's centre from axis 1, over the reach. elbow: sine of the angle between upper arm and the line from axis
    /// 3 to the wrist's centre. wrist: sine of joint 5, from where axes 4 and 6 are one.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
    /// From axis 2 to the wrist's centre, stretched.
    [[nodiscard]] double reach_of_links() const noexcept { return upper_ + fore_; }

private:
    /// Of the model, whose zero is straight up: sign and offset of each joint.
    [[nodiscard]] double model(const Joints& joints, std::size_t i) const noexcept { return sign_[i] * joints[i] + offset_[i]; }
    [[nodiscard]] double forward_of_axis_1(double second, double bend) const noexcept;

    Frame<double> to_model_;       ///< from the arm's base to axis 1's frame, height of axis 2
    Frame<double> from_flange_;    ///< from the flange to the wrist's centre
    double forward_ = 0;           ///< axis 1 to axis 2
    double aside_ = 0;             ///< axis 1 to the wrist's centre, across
    double upper_ = 1, fore_ = 1;  ///< axis 2 to axis 3, axis 3 to the wrist's centre
    double bend_ = 0;              ///< angle between the forearm's axis and the line from axis 3 to the wrist's centre
    double bend_sine_ = 0, bend_cosine_ = 1;
    Joints sign_{1, 1, 1, 1, 1, 1};
    Joints offset_{};
};

}  // namespace taktwerk::axes

#pragma once
// Six joints with three parallel axes (2, 3 and 4) and no spherical wrist, as Universal Robots', in closed form: all eight ways of reaching
// a pose. Pure, real-time safe.

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/chain.hpp"

namespace taktwerk::axes {

/// A chain read as an arm with axes 2, 3 and 4 parallel and at right angles to axis 1, axis 5 at right angles to 4 and meeting it, axis 6 at
/// right angles to 5 and meeting it. Where the chain is not quite that, this is a neighbour of it.
class ParallelArm {
public:
    ParallelArm() = default;
    explicit ParallelArm(const JointChain& chain) noexcept;

    /// As WristArm's.
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    [[nodiscard]] Branch branch(const Joints& joints) const noexcept;
    /// shoulder: how far the point where axes 5 and 6 meet is from the line through axis 1 across to the arm, over the reach. elbow: sine of
    /// the angle between the links. wrist: sine of joint 5.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
    [[nodiscard]] double reach_of_links() const noexcept { return upper_ + fore_; }

private:
    [[nodiscard]] double model(const Joints& joints, std::size_t i) const noexcept { return sign_[i] * joints[i] + offset_[i]; }
    [[nodiscard]] double front_of_axis_1(const Joints& joints) const noexcept;

    Frame<double> to_model_;     ///< from the arm's base to axis 1's frame, height of axis 2; axis 2 along -y
    Frame<double> from_flange_;  ///< from the flange to where axes 5 and 6 meet
    double forward_ = 0;         ///< axis 1 to axis 2
    double aside_ = 0;           ///< from axis 1 to where axes 5 and 6 meet, along axis 2
    double upper_ = 1, fore_ = 1;
    double hand_ = 0;  ///< from axis 4 to where axes 5 and 6 meet, along axis 5
    Joints sign_{1, 1, 1, 1, 1, 1};
    Joints offset_{};
};

}  // namespace taktwerk::axes

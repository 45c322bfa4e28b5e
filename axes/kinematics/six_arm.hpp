#pragma once
// Arms of six rotary joints: in closed form where the geometry has one, otherwise by a few steps of Newton from the nearest that has. Pure,
// real-time safe; making one is not for the cycle.

#include <variant>

#include "axes/kinematics/chain.hpp"
#include "axes/kinematics/parallel_arm.hpp"
#include "axes/kinematics/wrist_arm.hpp"

namespace taktwerk::axes {

class SixArm {
public:
    SixArm() = default;
    /// `real` is the arm, `nominal` the geometry that the closed form is taken from: the same, or what the arm was meant to be. Axes 2 and 4
    /// within 45 degrees of parallel: read as three parallel axes; else as a spherical wrist.
    SixArm(const JointChain& real, const JointChain& nominal) noexcept;

    [[nodiscard]] static std::size_t joint_count() noexcept { return 6; }
    [[nodiscard]] static std::array<bool, max_joints> rotary() noexcept { return {true, true, true, true, true, true}; }
    [[nodiscard]] static std::array<bool, 6> commands() noexcept { return {true, true, true, true, true, true}; }

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& joints) const noexcept {
        return chain_.forward(joints);
    }
    /// The joints' frames, and the flange; what JointChain makes velocities of.
    [[nodiscard]] std::array<Frame<double>, 7> frames(const Joints& joints) const noexcept { return chain_.frames(joints); }
    [[nodiscard]] Jacobian jacobian(const Joints& joints) const noexcept { return JointChain::jacobian(chain_.frames(joints)); }
    /// All ways. Without a closed form: those that Newton's method reached from `near` and from the
    /// neighbour's, each once; there may be more.
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    /// Of the ways that answer `wanted` the one nearest to `near`, for arms without a closed form: refines only what is asked for.
    [[nodiscard]] ArmSolutions solve_one(const Frame<double>& flange, const Branch& wanted, const Joints& near) const noexcept;
    /// Of the nominal arm.
    [[nodiscard]] Branch branch(const Joints& joints) const noexcept;
    /// In closed form the neighbour's; otherwise numeric: smallest over largest singular value of the Jacobian, lengths over the reach.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;

    [[nodiscard]] bool closed_form() const noexcept { return exact_; }
    [[nodiscard]] bool three_parallel_axes() const noexcept { return std::holds_alternative<ParallelArm>(nominal_); }
    [[nodiscard]] double reach() const noexcept { return reach_; }
    /// Is there an arm of this kind at all? False: axes 1 and 2 parallel, links without length, and the like.
    [[nodiscard]] bool sound() const noexcept { return sound_; }

private:
    [[nodiscard]] ArmSolutions solve_nominal(const Frame<double>& flange, const Joints& near) const noexcept;

    JointChain chain_;
    std::variant<WristArm, ParallelArm> nominal_;
    double reach_ = 1;
    bool exact_ = false;
    bool sound_ = false;
};

}  // namespace taktwerk::axes

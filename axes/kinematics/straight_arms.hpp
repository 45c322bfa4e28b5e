#pragma once
// Linear axes at right angles, with at most one turn at their end; and the portal whose beam has a motor at either end. Pure, real-time safe.

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// Which of X, Y, Z there are, and about which of them the tool turns behind them all. Joints in this order, the turn last.
struct CartesianAxes {
    std::array<bool, 3> linear{true, true, true};
    int turn_about = -1;  ///< 0 X (A), 1 Y (B), 2 Z (C); -1: it does not turn
};

class Cartesian {
public:
    Cartesian() = default;
    explicit Cartesian(const CartesianAxes& axes) noexcept : a_{axes} {}

    [[nodiscard]] std::size_t joint_count() const noexcept;
    [[nodiscard]] std::array<bool, max_joints> rotary() const noexcept;
    [[nodiscard]] std::array<bool, 6> commands() const noexcept;

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        Frame<S> f;
        std::size_t joint = 0;
        for (std::size_t i = 0; i < 3; ++i)
            if (a_.linear[i]) f.origin[i] = q[joint++];
        if (a_.turn_about >= 0) f.turn(static_cast<std::size_t>(a_.turn_about), q[joint]);
        return f;
    }
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    [[nodiscard]] static Branch branch(const Joints&) noexcept { return {}; }
    /// Never.
    [[nodiscard]] static Singularity singularity(const Joints&) noexcept { return {}; }
    /// For weighing lengths against angles only: such an arm has no reach.
    [[nodiscard]] static double reach() noexcept { return 1; }

private:
    CartesianAxes a_;
};

/// A beam along Y on two guides along X. Joints: X of the first guide (at y = 0), X of the second (at y = span), Y along the beam from the first
/// guide, Z up, and, if it turns, C at the end. The beam turns about its bearing on the first guide; the second one lets it slide.
struct BeamGantryShape {
    double span = 0;  ///< between the guides, > 0
    bool turns = false;
};

class BeamGantry {
public:
    BeamGantry() = default;
    explicit BeamGantry(const BeamGantryShape& shape) noexcept : s_{shape} {}

    [[nodiscard]] std::size_t joint_count() const noexcept { return s_.turns ? 5 : 4; }
    [[nodiscard]] std::array<bool, max_joints> rotary() const noexcept { return {false, false, false, false, s_.turns, false}; }
    [[nodiscard]] std::array<bool, 6> commands() const noexcept { return {true, true, true, false, false, s_.turns}; }

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        using std::sqrt;
        const S skew = q[1] - q[0], length = sqrt(S(s_.span * s_.span) + skew * skew);
        const S sine = skew / length, cosine = S(s_.span) / length;
        Frame<S> f;
        f.turn(2, -sine, cosine);
        if (s_.turns) f.turn(2, q[4]);
        f.origin = {q[0] + q[2] * sine, q[2] * cosine, q[3]};
        return f;
    }
    /// The beam stands square: both masters get the same X.
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    [[nodiscard]] static Branch branch(const Joints&) noexcept { return {}; }
    /// Never: a beam cannot stand along its guides.
    [[nodiscard]] static Singularity singularity(const Joints&) noexcept { return {}; }
    [[nodiscard]] double reach() const noexcept { return s_.span; }
    /// By how much the second master is ahead of the first, unit of length: what the group watches, and brings to 0 when it homes.
    [[nodiscard]] static double skew(const Joints& joints) noexcept { return joints[1] - joints[0]; }

private:
    BeamGantryShape s_;
};

}  // namespace taktwerk::axes

#pragma once
// SCARA and palletizer: four joints, the tool turns about the vertical only. Pure, real-time safe.

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// Two level links, a lift and a turn at its end. At 0 the arm points along x and the flange has the orientation of the base; joints: both
/// links counter-clockwise from above, lift up, turn counter-clockwise.
struct ScaraLengths {
    double first = 0;   ///< axis 1 to axis 2
    double second = 0;  ///< axis 2 to axis 4
    double height = 0;  ///< of the flange when the lift is at 0
};

class Scara {
public:
    [[nodiscard]] static std::size_t joint_count() noexcept { return 4; }
    [[nodiscard]] static std::array<bool, max_joints> rotary() noexcept { return {true, true, false, true, false, false}; }
    [[nodiscard]] static std::array<bool, 6> commands() noexcept { return {true, true, true, false, false, true}; }

    Scara() = default;
    explicit Scara(const ScaraLengths& lengths) noexcept : l_{lengths} {}

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        using std::cos;
        using std::sin;
        const S both = q[0] + q[1];
        Frame<S> f;
        f.turn(2, both + q[3]);
        f.origin = {S(l_.first) * cos(q[0]) + S(l_.second) * cos(both), S(l_.first) * sin(q[0]) + S(l_.second) * sin(both),
                    S(l_.height) + q[2]};
        return f;
    }
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    /// elbow: up (joint 2 counter-clockwise) or down.
    [[nodiscard]] Branch branch(const Joints& joints) const noexcept;
    /// elbow: sine of joint 2.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
    [[nodiscard]] double reach() const noexcept { return l_.first + l_.second; }

private:
    ScaraLengths l_;
};

/// A turning column with two links whose parallelograms keep the flange level. At 0 the upper arm stands up, the forearm is level to the
/// front, the flange has the orientation of the base; joints: column counter-clockwise from above, upper arm to the front, forearm down (its
/// angle to the horizon: the parallelogram of its motor makes it so), flange counter-clockwise.
struct PalletizerLengths {
    double shoulder = 0;  ///< axis 1 to axis 2, forward
    double height = 0;    ///< base to axis 2
    double upper = 0;     ///< axis 2 to axis 3
    double fore = 0;      ///< axis 3 to the wrist
    double wrist = 0;     ///< the wrist to the flange's axis, forward
    double drop = 0;      ///< the wrist to the flange, down
};

class Palletizer {
public:
    [[nodiscard]] static std::size_t joint_count() noexcept { return 4; }
    [[nodiscard]] static std::array<bool, max_joints> rotary() noexcept { return {true, true, true, true, false, false}; }
    [[nodiscard]] static std::array<bool, 6> commands() noexcept { return {true, true, true, false, false, true}; }

    Palletizer() = default;
    explicit Palletizer(const PalletizerLengths& lengths) noexcept : l_{lengths} {}

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        using std::cos;
        using std::sin;
        const S radius = S(l_.shoulder + l_.wrist) + S(l_.upper) * sin(q[1]) + S(l_.fore) * cos(q[2]);
        Frame<S> f;
        f.turn(2, q[0] + q[3]);
        f.origin = {radius * cos(q[0]), radius * sin(q[0]), S(l_.height - l_.drop) + S(l_.upper) * cos(q[1]) - S(l_.fore) * sin(q[2])};
        return f;
    }
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    /// shoulder: the flange in front of axis 1 or behind it; elbow: up or down.
    [[nodiscard]] Branch branch(const Joints& joints) const noexcept;
    /// shoulder: the flange's distance from axis 1 over the reach. elbow: sine of the angle between the links.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
    [[nodiscard]] double reach() const noexcept { return l_.upper + l_.fore; }

private:
    [[nodiscard]] double radius(const Joints& joints) const noexcept {
        return l_.shoulder + l_.wrist + l_.upper * std::sin(joints[1]) + l_.fore * std::cos(joints[2]);
    }
    PalletizerLengths l_;
};

}  // namespace taktwerk::axes

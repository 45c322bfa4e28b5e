#pragma once
// Three arms that hold one level platform: rotary (upper arms that swing) and linear (carriages on upright rails). Pure, real-time safe.
// Both: z up, the platform hangs below; arm i stands 120 degrees counter-clockwise behind arm i - 1, seen from above.

#include <numbers>

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// Where three rods of one length hang a platform: the lower of the two points that far from all three centres, which stand counter-clockwise
/// seen from above. `square`: of the height of the centres' triangle above the platform; below 0 the rods do not meet (what is returned then
/// is their triangle's middle, and is good for nothing).
template <class S>
[[nodiscard]] Triple<S> hung_from(const std::array<Triple<S>, 3>& centre, double rod, S& square) noexcept {
    using std::sqrt;
    const Triple<S> a = minus(centre[1], centre[0]), b = minus(centre[2], centre[0]), normal = cross(a, b);
    const S size = dot(normal, normal);
    const S aa = dot(a, a), bb = dot(b, b);
    const Triple<S> weighted{aa * b[0] - bb * a[0], aa * b[1] - bb * a[1], aa * b[2] - bb * a[2]};
    const Triple<S> middle = plus(Triple<S>{}, S(1) / (S(2) * size), cross(weighted, normal));
    square = S(rod * rod) - dot(middle, middle);
    return plus(plus(centre[0], S(1), middle), -sqrt(square / size), normal);
}

struct RotaryDeltaLengths {
    double base_radius = 0;      ///< axis of an upper arm to the middle of the base
    double platform_radius = 0;  ///< joint of a rod to the middle of the platform
    double upper = 0;            ///< upper arm
    double rod = 0;              ///< forearm
    double first_arm_at = 0;     ///< direction of the first arm, rad, counter-clockwise from x
    bool turns = false;          ///< a fourth joint turns the tool (telescopic shaft)
};

struct LinearDeltaLengths {
    double base_radius = 0;      ///< joint of a rod at its carriage to the middle
    double platform_radius = 0;  ///< joint of a rod to the middle of the platform
    double rod = 0;
    double first_arm_at = 0;  ///< rad, counter-clockwise from x
    bool turns = false;
};

/// What both kinds share: the joints of their rods, and the fourth axis.
template <class Lengths>
class DeltaShape {
public:
    [[nodiscard]] std::size_t joint_count() const noexcept { return l_.turns ? 4 : 3; }
    [[nodiscard]] std::array<bool, 6> commands() const noexcept { return {true, true, true, false, false, l_.turns}; }
    [[nodiscard]] static Branch branch(const Joints&) noexcept { return {}; }
    [[nodiscard]] double reach() const noexcept { return l_.rod; }

protected:
    DeltaShape() noexcept : DeltaShape{Lengths{}} {}
    explicit DeltaShape(const Lengths& lengths) noexcept : l_{lengths} {
        for (std::size_t i = 0; i < 3; ++i) {
            const double angle = l_.first_arm_at + 2 * std::numbers::pi / 3 * static_cast<double>(i);
            along_[i] = {std::cos(angle), std::sin(angle)};
        }
    }
    template <class S>
    [[nodiscard]] Frame<S> hung(const std::array<Triple<S>, 3>& centres, const S& turn) const noexcept {
        Frame<S> f;
        if (l_.turns) f.turn(2, turn);
        S square{};
        f.origin = hung_from(centres, l_.rod, square);
        return f;
    }
    Lengths l_;
    std::array<std::array<double, 2>, 3> along_{};  ///< cosine and sine of each arm's direction
};

/// Joints: upper arms, 0 level, positive down.
class RotaryDelta : public DeltaShape<RotaryDeltaLengths> {
public:
    RotaryDelta() = default;
    explicit RotaryDelta(const RotaryDeltaLengths& lengths) noexcept : DeltaShape{lengths} {}
    [[nodiscard]] std::array<bool, max_joints> rotary() const noexcept { return {true, true, true, l_.turns, false, false}; }

    template <class S>
    [[nodiscard]] std::array<Triple<S>, 3> centres(const std::array<S, max_joints>& q) const noexcept {
        using std::cos;
        using std::sin;
        std::array<Triple<S>, 3> c;
        for (std::size_t i = 0; i < 3; ++i) {
            const S out = S(l_.base_radius - l_.platform_radius) + S(l_.upper) * cos(q[i]);
            c[i] = {out * S(along_[i][0]), out * S(along_[i][1]), -(S(l_.upper) * sin(q[i]))};
        }
        return c;
    }
    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        return hung(centres(q), q[3]);
    }
    /// How far the rods are from meeting, unit of length; 0 when they do.
    [[nodiscard]] double gap(const Joints& joints) const noexcept;
    /// One way: elbows outward.
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    /// inner: part of a rod's direction along the way that its elbow takes, the smallest. outer: volume that the rods' directions span.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
};

/// Joints: carriages, positive up.
class LinearDelta : public DeltaShape<LinearDeltaLengths> {
public:
    LinearDelta() = default;
    explicit LinearDelta(const LinearDeltaLengths& lengths) noexcept : DeltaShape{lengths} {}
    [[nodiscard]] std::array<bool, max_joints> rotary() const noexcept { return {false, false, false, l_.turns, false, false}; }

    template <class S>
    [[nodiscard]] std::array<Triple<S>, 3> centres(const std::array<S, max_joints>& q) const noexcept {
        std::array<Triple<S>, 3> c;
        for (std::size_t i = 0; i < 3; ++i) {
            const double out = l_.base_radius - l_.platform_radius;
            c[i] = {S(out * along_[i][0]), S(out * along_[i][1]), q[i]};
        }
        return c;
    }
    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& q) const noexcept {
        return hung(centres(q), q[3]);
    }
    [[nodiscard]] double gap(const Joints& joints) const noexcept;
    /// One way: carriages above the platform.
    [[nodiscard]] ArmSolutions solve(const Frame<double>& flange, const Joints& near) const noexcept;
    /// inner: upright part of a rod's direction, the smallest. outer: as RotaryDelta's.
    [[nodiscard]] Singularity singularity(const Joints& joints) const noexcept;
};

}  // namespace taktwerk::axes

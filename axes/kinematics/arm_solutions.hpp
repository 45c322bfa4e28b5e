#pragma once
// What every arm of this folder answers with: the joints that reach a pose, at most eight, each with its flags; how near a singularity is.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "axes/kinematics/fault.hpp"
#include "axes/kinematics/joints.hpp"

namespace taktwerk::axes {

/// Which singularity is nearest. `inner`: a delta's arm whose elbow no rod moves; `outer`: its platform is not held by the rods.
enum class SingularityKind : std::uint8_t { none, shoulder, elbow, wrist, inner, outer, numeric };

/// measure: 1 far away .. 0 at the singularity, where some velocity of the tool asks for an infinite one of a joint (outer: where the tool
/// moves although the joints stand). What it is made of stands with each arm in docs/motion/kinematics.md. Not in proportion to anything else.
struct Singularity {
    SingularityKind kind = SingularityKind::none;
    double measure = 1;

    constexpr void consider(SingularityKind other, double its_measure) noexcept {
        if (its_measure < measure) *this = {other, its_measure};
    }
};

struct ArmSolution {
    Joints joints{};
    Branch branch;
};

struct ArmSolutions {
    std::array<ArmSolution, 8> at{};
    int count = 0;
    Miss miss;  ///< why there is none, where there is none

    constexpr void add(const Joints& joints, const Branch& branch) noexcept { at[static_cast<std::size_t>(count++)] = {joints, branch}; }
    /// Keeps the mildest reason: of several branches the one that lacks least.
    constexpr void missed(KinematicFault fault, double amount) noexcept {
        if (miss.ok() || amount < miss.amount) miss = {fault, -1, amount};
    }
};

/// Rounding that a pose at the very edge of the reach may be outside by, as a share of the reach: it counts as on the edge.
inline constexpr double edge_rounding = 1e-11;
/// How far an orientation may be from what an arm of fewer than six joints can do, rad.
inline constexpr double tilt_rounding = 1e-9;

template <class E>
[[nodiscard]] constexpr E flag(double determinant) noexcept {
    return determinant >= 0 ? E(1) : E(-1);
}

/// The nearest whole number, of less than 2^51; halves to the even one. Without a branch: of angles nobody can foretell.
[[nodiscard]] constexpr double nearest_whole(double x) noexcept {
    constexpr double beyond_fractions = 0x1.8p52;
    return (x + beyond_fractions) - beyond_fractions;
}
/// In [-pi, pi].
[[nodiscard]] constexpr double principal(double angle) noexcept {
    constexpr double turn = 2 * std::numbers::pi;
    return angle - turn * nearest_whole(angle / turn);
}

}  // namespace taktwerk::axes

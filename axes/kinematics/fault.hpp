#pragma once
// Why a pose has no joints: what is returned instead of an exception.

#include <cstdint>
#include <string_view>

namespace taktwerk::axes {

enum class KinematicFault : std::uint8_t {
    none,
    not_finite,      ///< a NaN, an infinity or a number above 1e12 came in, or an orientation whose length is not 1
    out_of_reach,    ///< amount: by how much, unit of length
    orientation,     ///< the arm cannot turn its tool that way (a SCARA does not tilt). amount: by how much, rad
    joint_limit,     ///< joint: which; amount: by how much, rad or unit of length
    other_branch,    ///< the pose can be reached, but not with the flags or turns that were wanted
    singular,        ///< velocities have no answer here. amount: the measure of the singularity
    no_convergence,  ///< of a numeric solver, in its bounded work. amount: what is left, as a share of the reach or in rad
    does_not_close,  ///< forward: with these joints the rods of a delta do not meet. amount: by how much, unit of length
};
inline constexpr std::size_t kinematic_fault_count = 9;

/// "out_of_reach", as in messages and logs.
[[nodiscard]] constexpr std::string_view name(KinematicFault fault) noexcept {
    constexpr std::string_view names[kinematic_fault_count] = {
        "none", "not_finite", "out_of_reach", "orientation", "joint_limit", "other_branch", "singular", "no_convergence", "does_not_close"};
    return names[static_cast<std::size_t>(fault)];
}

/// A fault with its figures. joint counts from 0; -1 where none is to blame.
struct Miss {
    KinematicFault fault = KinematicFault::none;
    int joint = -1;
    double amount = 0;

    [[nodiscard]] constexpr bool ok() const noexcept { return fault == KinematicFault::none; }
};

}  // namespace taktwerk::axes

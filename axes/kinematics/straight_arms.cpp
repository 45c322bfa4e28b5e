#include "axes/kinematics/straight_arms.hpp"

#include <algorithm>

#include "axes/kinematics/level_turn.hpp"

namespace taktwerk::axes {

std::size_t Cartesian::joint_count() const noexcept {
    return static_cast<std::size_t>(std::count(a_.linear.begin(), a_.linear.end(), true)) + (a_.turn_about >= 0 ? 1 : 0);
}

std::array<bool, max_joints> Cartesian::rotary() const noexcept {
    std::array<bool, max_joints> which{};
    if (a_.turn_about >= 0) which[joint_count() - 1] = true;
    return which;
}

std::array<bool, 6> Cartesian::commands() const noexcept {
    std::array<bool, 6> which{a_.linear[0], a_.linear[1], a_.linear[2], false, false, false};
    if (a_.turn_about >= 0) which[static_cast<std::size_t>(3 + a_.turn_about)] = true;
    return which;
}

ArmSolutions Cartesian::solve(const Frame<double>& flange, const Joints&) const noexcept {
    ArmSolutions found;
    double tilt = 0, turn = 0;
    if (a_.turn_about >= 0) turn = turn_about(static_cast<std::size_t>(a_.turn_about), flange, tilt);
    else tilt = turn_from_base(flange);
    if (tilt > tilt_rounding) {
        found.missed(KinematicFault::orientation, tilt);
        return found;
    }
    Joints q{};
    std::size_t joint = 0;
    double beside = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (a_.linear[i]) q[joint++] = flange.origin[i];
        else beside = flange.origin[i];
    }
    // What is asked of a missing axis may be the rounding of the frames before it.
    if (std::abs(beside) > 1e-9 * std::max(1.0, std::abs(q[0]) + std::abs(q[1]))) {
        found.missed(KinematicFault::out_of_reach, std::abs(beside));
        return found;
    }
    if (a_.turn_about >= 0) q[joint] = turn;
    found.add(q, {});
    return found;
}

ArmSolutions BeamGantry::solve(const Frame<double>& flange, const Joints&) const noexcept {
    ArmSolutions found;
    double tilt = 0, turn = 0;
    if (s_.turns) turn = turn_about(2, flange, tilt);
    else tilt = turn_from_base(flange);
    if (tilt > tilt_rounding) found.missed(KinematicFault::orientation, tilt);
    else found.add({flange.origin[0], flange.origin[0], flange.origin[1], flange.origin[2], turn, 0}, {});
    return found;
}

}  // namespace taktwerk::axes

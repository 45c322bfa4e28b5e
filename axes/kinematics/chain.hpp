#pragma once
// Six rotary joints in a row: each turns about the z axis of the frame that the link before it carries. Pure, real-time safe.

#include <array>

#include <Eigen/Core>

#include "axes/kinematics/frame.hpp"
#include "axes/kinematics/joints.hpp"

namespace taktwerk::axes {

using Jacobian = Eigen::Matrix<double, 6, 6>;

struct JointChain {
    Frame<double> base;                 ///< the first joint's frame at 0, in the arm's base
    std::array<Frame<double>, 6> link;  ///< behind joint i: the next joint's frame at 0, at last the flange

    template <class S>
    [[nodiscard]] Frame<S> forward(const std::array<S, max_joints>& joints) const noexcept {
        Frame<S> at = Frame<S>{} * base;
        for (std::size_t i = 0; i < 6; ++i) {
            at.turn(2, joints[i]);
            at = at * link[i];
        }
        return at;
    }

    /// The joints' frames before they turn, and the flange.
    [[nodiscard]] std::array<Frame<double>, 7> frames(const Joints& joints) const noexcept {
        std::array<Frame<double>, 7> at;
        at[0] = base;
        for (std::size_t i = 0; i < 6; ++i) {
            Frame<double> turned = at[i];
            turned.turn(2, joints[i]);
            at[i + 1] = turned * link[i];
        }
        return at;
    }

    /// Rows: velocity of the flange's origin, angular velocity, both in the base.
    [[nodiscard]] static Jacobian jacobian(const std::array<Frame<double>, 7>& at) noexcept {
        Jacobian j;
        for (std::size_t i = 0; i < 6; ++i) {
            const Triple<double>& z = at[i].axis[2];
            const auto column = static_cast<Eigen::Index>(i);
            j.block<3, 1>(0, column) = vector_of(cross(z, minus(at[6].origin, at[i].origin)));
            j.block<3, 1>(3, column) = vector_of(z);
        }
        return j;
    }
};

}  // namespace taktwerk::axes

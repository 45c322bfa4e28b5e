#pragma once
// Six rotary joints in a row: each turns about the z axis of the frame that the link before it carries. Pure, real-time safe.

#include <array>

#include <Eigen/Core>

#include "axes/kinematics/frame.hpp"
#include "axes/kinematics/joints.hpp"

namespace taktwerk::axes {

using Jacobian = Eigen::Matrix<double, 6, 6>;

/// Of a frame: velocity of the origin and angular velocity, with their first two derivatives.
struct FrameMotion {
    std::array<Eigen::Vector3d, 3> linear{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    std::array<Eigen::Vector3d, 3> angular{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

    /// Of another point of the same body, which lies `lever` further; what is beyond `orders` (1 to 3) is not computed.
    [[nodiscard]] FrameMotion further(const Eigen::Vector3d& lever, int orders) const noexcept {
        FrameMotion m = *this;
        m.add(lever, orders);
        return m;
    }
    /// The origin's motion becomes that of the point that lies `lever` further.
    void add(const Eigen::Vector3d& lever, int orders) noexcept {
        const Eigen::Vector3d first = angular[0].cross(lever);
        linear[0] += first;
        if (orders < 2) return;
        const Eigen::Vector3d second = angular[1].cross(lever) + angular[0].cross(first);
        linear[1] += second;
        if (orders < 3) return;
        linear[2] += angular[2].cross(lever) + 2 * angular[1].cross(first) + angular[0].cross(second);
    }
};

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

    /// Of the flange in the base, for the joints' velocities, accelerations and jerks: from link to link.
    [[nodiscard]] static FrameMotion motion(const std::array<Frame<double>, 7>& at, const std::array<Joints, 3>& joints,
                                            int orders) noexcept {
        FrameMotion m;
        auto& w = m.angular;
        for (std::size_t i = 0; i < 6; ++i) {
            const Eigen::Vector3d z = vector_of(at[i].axis[2]);
            const double q1 = joints[0][i], q2 = joints[1][i], q3 = joints[2][i];
            // The axis turns with the link before it.
            const Eigen::Vector3d z1 = w[0].cross(z);
            if (orders > 2) w[2] += (w[1].cross(z) + w[0].cross(z1)) * q1 + 2 * q2 * z1 + q3 * z;
            if (orders > 1) w[1] += z1 * q1 + z * q2;
            w[0] += z * q1;
            m.add(vector_of(minus(at[i + 1].origin, at[i].origin)), orders);
        }
        return m;
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

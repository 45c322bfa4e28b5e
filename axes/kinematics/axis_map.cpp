#include "axes/kinematics/axis_map.hpp"

#include <Eigen/LU>

namespace taktwerk::axes {

AxisMap::AxisMap(const std::array<JointSettings, max_joints>& joints, const Coupling& coupling) noexcept : settings_{joints} {
    for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index k = 0; k < 6; ++k) to_axes_(i, k) = coupling[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    const Eigen::FullPivLU<JointMatrix> lu{to_axes_};
    sound_ = to_axes_.allFinite() && lu.isInvertible();
    to_joints_ = sound_ ? JointMatrix{lu.inverse()} : JointMatrix{JointMatrix::Identity()};
    if (to_axes_.isIdentity(0)) to_joints_ = to_axes_;  // to the last bit
    for (Eigen::Index i = 0; i < 6; ++i) {
        const double unit = settings_[static_cast<std::size_t>(i)].unit;
        sound_ = sound_ && std::isfinite(unit) && unit > 0;
        to_axes_.row(i) /= unit;
        to_joints_.col(i) *= unit;
    }
    plain_ = sound_ && to_axes_.isIdentity(0);
}

Joints AxisMap::arm_of(const Joints& joints) const noexcept {
    Joints arm;
    for (std::size_t i = 0; i < max_joints; ++i) arm[i] = settings_[i].sign * joints[i] + settings_[i].zero;
    return arm;
}

Joints AxisMap::joints_of_arm(const Joints& arm) const noexcept {
    Joints joints;
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = settings_[i].sign * (arm[i] - settings_[i].zero);
    return joints;
}

Joints AxisMap::times(const JointMatrix& m, const Joints& v) noexcept {
    Joints r;
    Eigen::Map<Eigen::Matrix<double, 6, 1>>{r.data()} = m * Eigen::Map<const Eigen::Matrix<double, 6, 1>>{v.data()};
    return r;
}

}  // namespace taktwerk::axes

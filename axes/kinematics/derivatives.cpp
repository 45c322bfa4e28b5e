// Velocities and what follows: the Jacobian, and derivatives of the axes along a path.

#include <Eigen/LU>

#include "axes/kinematics/jet.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using JetJoints = std::array<Jet, max_joints>;

/// Below this share of its largest pivot a Jacobian's smallest is rounding.
constexpr double singular_below = 1e-11;

/// Of a frame's motion: velocity of the origin and angular velocity, with their first two derivatives.
struct Motion {
    std::array<Vector6, 3> order;
};

Triple<double> part(const Triple<Jet>& t, int order) noexcept {
    const auto pick = [order](const Jet& j) { return order == 0 ? j.v : order == 1 ? j.d1 : order == 2 ? j.d2 : j.d3; };
    return {pick(t[0]), pick(t[1]), pick(t[2])};
}

/// With R' = W R: the angular velocity is half the sum of axis x axis'; the jets of that product give its derivatives.
Motion motion_of(const Frame<Jet>& f) noexcept {
    Triple<Jet> turn{};
    for (const Triple<Jet>& a : f.axis) {
        const auto slope = [](const Jet& j) { return Jet{j.d1, j.d2, j.d3, 0}; };
        const Triple<Jet> along{slope(a[0]), slope(a[1]), slope(a[2])};
        turn = plus(turn, Jet{0.5}, cross(a, along));
    }
    Motion m;
    for (int k = 0; k < 3; ++k) m.order[static_cast<std::size_t>(k)] << vector_of(part(f.origin, k + 1)), vector_of(part(turn, k));
    return m;
}

/// A pose on a path as a jet of its matrix: R' = W R, R'' = (W' + W W) R, R''' = (W'' + 2 W' W + W W' + W W W) R.
Frame<Jet> jet_of(const Frame<double>& at, const PathDerivatives& path) noexcept {
    const auto skew = [](const std::array<double, 3>& w) {
        Eigen::Matrix3d m;
        m << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
        return m;
    };
    const Eigen::Matrix3d w = skew(path.turn[0]), w1 = skew(path.turn[1]), w2 = skew(path.turn[2]);
    const Eigen::Matrix3d second = w1 + w * w, third = w2 + 2 * w1 * w + w * w1 + w * w * w;
    Frame<Jet> f;
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d axis = vector_of(at.axis[k]), d1 = w * axis, d2 = second * axis, d3 = third * axis;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto e = static_cast<Eigen::Index>(i);
            f.axis[k][i] = {axis[e], d1[e], d2[e], d3[e]};
        }
    }
    for (std::size_t i = 0; i < 3; ++i) f.origin[i] = {at.origin[i], path.position[0][i], path.position[1][i], path.position[2][i]};
    return f;
}

/// `fixed` does not move.
Frame<Jet> seen_from(const Frame<double>& fixed, const Frame<Jet>& f) noexcept {
    Frame<Jet> r;
    const auto turn = [&](const Triple<Jet>& v) {
        Triple<Jet> out{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i) out[i] = out[i] + Jet{fixed.axis[k][i]} * v[k];
        return out;
    };
    for (std::size_t k = 0; k < 3; ++k) r.axis[k] = turn(f.axis[k]);
    r.origin = turn(f.origin);
    for (std::size_t i = 0; i < 3; ++i) r.origin[i] = r.origin[i] + Jet{fixed.origin[i]};
    return r;
}

/// Of the flange in the arm's base, by the arm's own joints.
template <class Arm>
Jacobian arm_jacobian(const Arm& arm, const Joints& joints) noexcept {
    if constexpr (requires { arm.jacobian(joints); }) {
        return arm.jacobian(joints);
    } else {
        Jacobian j = Jacobian::Zero();
        JetJoints jets;
        for (std::size_t i = 0; i < max_joints; ++i) jets[i] = joints[i];
        for (std::size_t i = 0; i < arm.joint_count(); ++i) {
            jets[i].d1 = 1;
            j.col(static_cast<Eigen::Index>(i)) = motion_of(arm.forward(jets)).order[0];
            jets[i].d1 = 0;
        }
        return j;
    }
}

/// Which components of the flange's motion the joints answer for, as rows; a beam's skew, which has to stay, as the row behind them.
struct Rows {
    std::array<Eigen::Index, 6> of{};
    Eigen::Index count = 0;
    bool beam = false;

    [[nodiscard]] Jacobian matrix(const Jacobian& j) const noexcept {
        Jacobian m = Jacobian::Identity();
        for (Eigen::Index i = 0; i < count; ++i) m.row(i) = j.row(of[static_cast<std::size_t>(i)]);
        if (beam) m.row(count) << -1, 1, 0, 0, 0, 0;
        return m;
    }
    [[nodiscard]] Vector6 vector(const Vector6& v) const noexcept {
        Vector6 r = Vector6::Zero();
        for (Eigen::Index i = 0; i < count; ++i) r[i] = v[of[static_cast<std::size_t>(i)]];
        return r;
    }
};

template <class Arm>
AxisDerivatives arm_derivatives(const Arm& arm, const Joints& joints, const Motion& flange) noexcept {
    Rows rows;
    const auto commanded = arm.commands();
    for (std::size_t i = 0; i < 6; ++i)
        if (commanded[i]) rows.of[static_cast<std::size_t>(rows.count++)] = static_cast<Eigen::Index>(i);
    rows.beam = std::is_same_v<Arm, BeamGantry>;
    const Eigen::PartialPivLU<Jacobian> lu{rows.matrix(arm_jacobian(arm, joints))};

    AxisDerivatives d;
    const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
    if (!(pivots.minCoeff() > singular_below * pivots.maxCoeff())) {
        d.miss = {KinematicFault::singular, -1, arm.singularity(joints).measure};
        return d;
    }
    // Order by order: what the lower orders already do to the flange is the rest's to make up for.
    JetJoints jets;
    for (std::size_t i = 0; i < max_joints; ++i) jets[i] = joints[i];
    for (std::size_t order = 0; order < 3; ++order) {
        const Vector6 done = order == 0 ? Vector6{Vector6::Zero()} : motion_of(arm.forward(jets)).order[order];
        const Vector6 step = lu.solve(rows.vector(flange.order[order] - done));
        for (std::size_t i = 0; i < arm.joint_count(); ++i) {
            const double value = step[static_cast<Eigen::Index>(i)];
            d.of[order][i] = value;
            (order == 0 ? jets[i].d1 : order == 1 ? jets[i].d2 : jets[i].d3) = value;
        }
    }
    return d;
}

}  // namespace

Jacobian Kinematics::jacobian(const Joints& axes, const Pose& tool) const noexcept {
    const Joints joints = map_.arm_of(map_.joints_of(axes));
    Jacobian j = std::visit([&](const auto& arm) { return arm_jacobian(arm, joints); }, arm_);
    const Frame<double> flange = std::visit([&](const auto& arm) { return arm.forward(joints); }, arm_);
    const Eigen::Vector3d lever = vector_of(rotated(flange, tool.position));
    Eigen::Matrix3d turn;
    for (int k = 0; k < 3; ++k) turn.col(k) = vector_of(base_.axis[static_cast<std::size_t>(k)]);
    for (Eigen::Index i = 0; i < 6; ++i) {
        const Eigen::Vector3d spin = j.block<3, 1>(3, i), speed = j.block<3, 1>(0, i) + spin.cross(lever);
        j.block<3, 1>(0, i) = turn * speed;
        j.block<3, 1>(3, i) = turn * spin;
    }
    for (Eigen::Index i = 0; i < 6; ++i) j.col(i) *= map_.settings(static_cast<std::size_t>(i)).sign;
    return j * map_.to_joints();
}

AxisDerivatives Kinematics::derivatives(const Joints& axes, const Pose& tool, const PathDerivatives& path) const noexcept {
    const Joints joints = map_.arm_of(map_.joints_of(axes));
    const Frame<double> tool_frame = frame_of(tool);
    const Frame<double> flange = std::visit([&](const auto& arm) { return arm.forward(joints); }, arm_);
    const Frame<Jet> tool_point = jet_of(base_ * flange * tool_frame, path);
    const Motion motion = motion_of(seen_from(to_base_, tool_point * inverse_of(tool_frame)));
    AxisDerivatives d = std::visit([&](const auto& arm) { return arm_derivatives(arm, joints, motion); }, arm_);
    for (Joints& order : d.of) {
        for (std::size_t i = 0; i < max_joints; ++i) order[i] *= map_.settings(i).sign;
        order = map_.axes_of(order);
    }
    return d;
}

}  // namespace taktwerk::axes

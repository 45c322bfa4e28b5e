// Velocities and what follows: the Jacobian, and derivatives of the axes along a path.

#include <Eigen/LU>

#include "axes/kinematics/jet.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/kinematics/soundness.hpp"

namespace taktwerk::axes {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Below this share of its largest pivot a Jacobian's smallest is rounding.
constexpr double singular_below = 1e-11;

[[nodiscard]] Vector6 order_of(const FrameMotion& m, std::size_t order) noexcept {
    Vector6 v;
    v << m.linear[order], m.angular[order];
    return v;
}

/// With R' = W R: the angular velocity is half the sum of axis x axis'; the jets of that product give its derivatives.
template <int Order>
[[nodiscard]] FrameMotion motion_of(const Frame<JetOf<Order>>& f) noexcept {
    using S = JetOf<Order>;
    Triple<S> turn{};
    for (const Triple<S>& a : f.axis) {
        const auto slope = [](const S& j) { return S{j.d1, j.d2, j.d3, 0}; };
        const Triple<S> half = cross(a, Triple<S>{slope(a[0]), slope(a[1]), slope(a[2])});
        for (std::size_t i = 0; i < 3; ++i) turn[i] += half[i] * 0.5;
    }
    FrameMotion m;
    m.linear[0] = {f.origin[0].d1, f.origin[1].d1, f.origin[2].d1};
    m.angular[0] = {turn[0].v, turn[1].v, turn[2].v};
    if constexpr (Order > 1) {
        m.linear[1] = {f.origin[0].d2, f.origin[1].d2, f.origin[2].d2};
        m.angular[1] = {turn[0].d1, turn[1].d1, turn[2].d1};
    }
    if constexpr (Order > 2) {
        m.linear[2] = {f.origin[0].d3, f.origin[1].d3, f.origin[2].d3};
        m.angular[2] = {turn[0].d2, turn[1].d2, turn[2].d2};
    }
    return m;
}

/// An arm at a place: the flange, its Jacobian, its motion for that of the joints, all in the arm's base. By jets of what every arm has.
template <class Arm>
class Stand {
public:
    Stand(const Arm& arm, const Joints& joints) noexcept : arm_(arm), joints_(joints) {}

    [[nodiscard]] Frame<double> flange() const noexcept { return arm_.forward(joints_); }
    [[nodiscard]] Jacobian jacobian() const noexcept {
        Jacobian j = Jacobian::Zero();
        std::array<JetOf<1>, max_joints> jets;
        for (std::size_t i = 0; i < max_joints; ++i) jets[i] = joints_[i];
        for (std::size_t i = 0; i < arm_.joint_count(); ++i) {
            jets[i].d1 = 1;
            j.col(static_cast<Eigen::Index>(i)) = order_of(motion_of(arm_.forward(jets)), 0);
            jets[i].d1 = 0;
        }
        return j;
    }
    [[nodiscard]] FrameMotion motion(const std::array<Joints, 3>& of, int orders) const noexcept {
        return orders == 1 ? by_jets<1>(of) : orders == 2 ? by_jets<2>(of) : by_jets<3>(of);
    }

private:
    template <int Order>
    [[nodiscard]] FrameMotion by_jets(const std::array<Joints, 3>& of) const noexcept {
        std::array<JetOf<Order>, max_joints> jets;
        for (std::size_t i = 0; i < max_joints; ++i) jets[i] = {joints_[i], of[0][i], of[1][i], of[2][i]};
        return motion_of(arm_.forward(jets));
    }

    const Arm& arm_;
    const Joints& joints_;
};

/// Of a chain: all from the frames of its joints.
template <>
class Stand<SixArm> {
public:
    Stand(const SixArm& arm, const Joints& joints) noexcept : at_(arm.frames(joints)) {}

    [[nodiscard]] const Frame<double>& flange() const noexcept { return at_[6]; }
    [[nodiscard]] Jacobian jacobian() const noexcept { return JointChain::jacobian(at_); }
    [[nodiscard]] FrameMotion motion(const std::array<Joints, 3>& of, int orders) const noexcept {
        return JointChain::motion(at_, of, orders);
    }

private:
    std::array<Frame<double>, 7> at_;
};

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
AxisDerivatives arm_derivatives(const Arm& arm, const Joints& joints, const FrameMotion& tool_point, const Triple<double>& to_tool,
                                std::size_t orders) noexcept {
    Rows rows;
    const auto commanded = arm.commands();
    for (std::size_t i = 0; i < 6; ++i)
        if (commanded[i]) rows.of[static_cast<std::size_t>(rows.count++)] = static_cast<Eigen::Index>(i);
    rows.beam = std::is_same_v<Arm, BeamGantry>;
    const Stand<Arm> stand{arm, joints};
    const FrameMotion flange = tool_point.further(-vector_of(rotated(stand.flange(), to_tool)), static_cast<int>(orders));
    const Eigen::PartialPivLU<Jacobian> lu{rows.matrix(stand.jacobian())};

    AxisDerivatives d;
    const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
    if (!(pivots.minCoeff() > singular_below * pivots.maxCoeff())) {
        d.miss = {KinematicFault::singular, -1, arm.singularity(joints).measure};
        return d;
    }
    // Order by order: what the lower orders already do to the flange is the rest's to make up for.
    for (std::size_t order = 0; order < orders; ++order) {
        Vector6 wanted = order_of(flange, order);
        if (order > 0) wanted -= order_of(stand.motion(d.of, static_cast<int>(order) + 1), order);
        const Vector6 step = lu.solve(rows.vector(wanted));
        for (std::size_t i = 0; i < arm.joint_count(); ++i) d.of[order][i] = step[static_cast<Eigen::Index>(i)];
    }
    return d;
}

}  // namespace

Jacobian Kinematics::jacobian(const Joints& axes, const Pose& tool) const noexcept {
    const Joints joints = map_.arm_of(map_.joints_of(axes));
    Frame<double> flange;
    Jacobian j = std::visit(
        [&]<class A>(const A& arm) {
            const Stand<A> stand{arm, joints};
            flange = stand.flange();
            return stand.jacobian();
        },
        arm_);
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

AxisDerivatives Kinematics::derivatives(const Joints& axes, const Pose& tool, const PathDerivatives& path, int orders) const noexcept {
    const Joints joints = map_.arm_of(map_.joints_of(axes));
    const auto count = static_cast<std::size_t>(orders);
    FrameMotion tool_point;
    for (std::size_t k = 0; k < count; ++k) {
        tool_point.linear[k] = vector_of(rotated(to_base_, path.position[k]));
        tool_point.angular[k] = vector_of(rotated(to_base_, path.turn[k]));
    }
    AxisDerivatives d = std::visit([&](const auto& arm) { return arm_derivatives(arm, joints, tool_point, tool.position, count); }, arm_);
    for (std::size_t k = 0; k < count; ++k) {
        for (std::size_t i = 0; i < max_joints; ++i) d.of[k][i] *= map_.settings(i).sign;
        d.of[k] = map_.axes_of(d.of[k]);
    }
    return d;
}

MovingPose Kinematics::moving(const Joints& axes, const Joints& velocities, const Pose& tool) const noexcept {
    if (!finite(axes) || !finite(velocities) || !sound(tool)) return {{}, {}, {KinematicFault::not_finite}};
    const Joints joints = map_.arm_of(map_.joints_of(axes));
    std::array<Joints, 3> of{map_.joints_of(velocities)};
    for (std::size_t i = 0; i < max_joints; ++i) of[0][i] = i < joint_count_ ? of[0][i] * map_.settings(i).sign : 0;
    double gap = 0;
    Frame<double> flange;
    FrameMotion motion = std::visit(
        [&]<class A>(const A& arm) {
            if constexpr (requires { arm.gap(joints); }) gap = arm.gap(joints);
            if (gap > 0) return FrameMotion{};
            const Stand<A> stand{arm, joints};
            flange = stand.flange();
            return stand.motion(of, 1);
        },
        arm_);
    if (gap > 0) return {{}, {}, {KinematicFault::does_not_close, -1, gap}};
    motion.add(vector_of(rotated(flange, tool.position)), 1);
    const Triple<double> speed = rotated(base_, triple_of(motion.linear[0])), spin = rotated(base_, triple_of(motion.angular[0]));
    return {pose_of(base_ * flange * frame_of_scaled(tool)), {speed[0], speed[1], speed[2], spin[0], spin[1], spin[2]}, {}};
}

}  // namespace taktwerk::axes

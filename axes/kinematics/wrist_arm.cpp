#include "axes/kinematics/wrist_arm.hpp"

#include <algorithm>

#include "axes/kinematics/angle_of.hpp"
#include "axes/kinematics/axis_lines.hpp"
#include "axes/kinematics/two_links.hpp"
#include "axes/kinematics/wrist_angles.hpp"

namespace taktwerk::axes {

WristArm::WristArm(const JointChain& chain) noexcept {
    const auto at = chain.frames({});
    const auto z = [&](std::size_t joint) { return vector_of(at[joint - 1].axis[2]); };
    const auto point = [&](std::size_t joint) { return vector_of(at[joint - 1].origin); };

    // The model's base: z along axis 1, y along axis 2.
    const Eigen::Vector3d up = z(1), left = (z(2) - z(2).dot(up) * up).normalized(), front = left.cross(up);
    const Eigen::Vector3d to_shoulder = point(2) - point(1);
    forward_ = to_shoulder.dot(front);
    to_model_ = inverse_of({{{triple_of(front), triple_of(left), triple_of(up)}}, triple_of(point(1) + to_shoulder.dot(up) * up)});

    // Angles in the plane of the arm are from `up` towards `front`.
    const auto angle = [&](const Eigen::Vector3d& v) { return std::atan2(v.dot(front), v.dot(up)); };
    const auto in_plane = [&](const Eigen::Vector3d& v) { return std::hypot(v.dot(front), v.dot(up)); };
    const Eigen::Vector3d upper = point(3) - point(2);
    upper_ = in_plane(upper);
    sign_[2] = z(3).dot(left) < 0 ? -1 : 1;

    const Eigen::Vector3d centre = middle_of(point(4), z(4), point(5), z(5), point(6), z(6));
    const Eigen::Vector3d along = (z(4) - z(4).dot(left) * left).normalized(), fore = centre - point(3);
    fore_ = in_plane(fore);
    aside_ = (centre - point(1)).dot(left);
    const double fore_angle = angle(along);
    bend_ = angle(fore) - fore_angle;
    bend_sine_ = std::sin(bend_);
    bend_cosine_ = std::cos(bend_);
    offset_[1] = angle(upper);
    offset_[2] = fore_angle - offset_[1];

    // The wrist's frame when its model stands at 0: z along the forearm, y across; then axis 5, then axis 6.
    const Eigen::Vector3d x4 = left.cross(along);
    offset_[3] = std::atan2(-z(5).dot(x4), z(5).dot(left));
    const Eigen::Vector3d y5 = std::cos(offset_[3]) * left - std::sin(offset_[3]) * x4, x5 = y5.cross(along);
    offset_[4] = std::atan2(z(6).dot(x5), z(6).dot(along));
    const Eigen::Vector3d x6 = std::cos(offset_[4]) * x5 - std::sin(offset_[4]) * along;
    const Eigen::Vector3d z6 = std::sin(offset_[4]) * x5 + std::cos(offset_[4]) * along;
    const Frame<double> wrist{{{triple_of(x6), triple_of(y5), triple_of(z6)}}, triple_of(centre)};
    from_flange_ = inverse_of(at[6]) * wrist;
}

ArmSolutions WristArm::solve(const Frame<double>& flange, const Joints& near) const noexcept {
    ArmSolutions found;
    const Frame<double> wrist = to_model_ * flange * from_flange_;
    const double x = wrist.origin[0], y = wrist.origin[1], z = wrist.origin[2];
    const double radius = std::sqrt(x * x + y * y), aside = std::abs(aside_), rounding = edge_rounding * (upper_ + fore_);
    if (radius < aside - rounding) {
        found.missed(KinematicFault::out_of_reach, aside - radius);
        return found;
    }
    const double ahead = std::sqrt(std::max(0.0, (radius - aside) * (radius + aside))), square = radius * radius;
    const bool on_axis = radius < rounding;
    for (const double side : {1.0, -1.0}) {
        const double reached = side * ahead;
        const double c1 = on_axis ? std::cos(model(near, 0)) : (x * reached + y * aside_) / square;
        const double s1 = on_axis ? std::sin(model(near, 0)) : (y * reached - x * aside_) / square;
        TwoLinks ways[2];
        double lacking = 0;
        if (!links_reach(upper_, fore_, z, reached - forward_, model(near, 1), ways, lacking)) {
            found.missed(KinematicFault::out_of_reach, lacking);
            continue;
        }
        const double first = angle_of(s1, c1), between = ways[0].between();
        for (const TwoLinks& way : ways) {
            const double bent = &way == &ways[0] ? between : -between;
            const double second = way.angle(), third = bent - bend_;
            // The forearm's own angle: that of the line to the wrist's centre, less the bend.
            const TwoLinks line = way.with_end_turned();
            const double s23 = line.sine * bend_cosine_ - line.cosine * bend_sine_,
                         c23 = line.cosine * bend_cosine_ + line.sine * bend_sine_;
            // (Rz(first) Ry(second + third))^T, from the left
            Frame<double> turn;
            for (std::size_t k = 0; k < 3; ++k) {
                const Triple<double>& v = wrist.axis[k];
                const double level = c1 * v[0] + s1 * v[1];
                turn.axis[k] = {c23 * level - s23 * v[2], c1 * v[1] - s1 * v[0], s23 * level + c23 * v[2]};
            }
            WristAngles wrists[2];
            wrist_angles(turn, model(near, 3), wrists);
            for (const WristAngles& w : wrists) {
                const Joints angles{first, second, third, w.first, w.second, w.third};
                Joints joints;
                for (std::size_t i = 0; i < 6; ++i) joints[i] = sign_[i] * (angles[i] - offset_[i]);
                found.add(joints, {flag<Shoulder>(side), flag<Elbow>(&way == &ways[0] ? 1 : -1), flag<Wrist>(&w == &wrists[0] ? 1 : -1)});
            }
        }
    }
    return found;
}

double WristArm::forward_of_axis_1(double second, double bend) const noexcept {
    return forward_ + upper_ * std::sin(second) + fore_ * std::sin(second + bend);
}

Branch WristArm::branch(const Joints& joints) const noexcept {
    const double bent = model(joints, 2) + bend_;
    return {flag<Shoulder>(forward_of_axis_1(model(joints, 1), bent)), flag<Elbow>(std::sin(bent)),
            flag<Wrist>(std::sin(model(joints, 4)))};
}

Singularity WristArm::singularity(const Joints& joints) const noexcept {
    const double bent = model(joints, 2) + bend_;
    Singularity s;
    s.consider(SingularityKind::shoulder, std::abs(forward_of_axis_1(model(joints, 1), bent)) / (upper_ + fore_));
    s.consider(SingularityKind::elbow, std::abs(std::sin(bent)));
    s.consider(SingularityKind::wrist, std::abs(std::sin(model(joints, 4))));
    return s;
}

}  // namespace taktwerk::axes

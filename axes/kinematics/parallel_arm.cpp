#include "axes/kinematics/parallel_arm.hpp"

#include <algorithm>

#include "axes/kinematics/angle_of.hpp"
#include "axes/kinematics/axis_lines.hpp"
#include "axes/kinematics/two_links.hpp"
#include "axes/kinematics/wrist_angles.hpp"

namespace taktwerk::axes {

// The plane of the arm has coordinates front and up; angles in it are from `front` towards `up`, about axis 2.

ParallelArm::ParallelArm(const JointChain& chain) noexcept {
    const auto at = chain.frames({});
    const auto z = [&](std::size_t joint) { return vector_of(at[joint - 1].axis[2]); };
    const auto point = [&](std::size_t joint) { return vector_of(at[joint - 1].origin); };

    const Eigen::Vector3d up = z(1), across = (z(2) - z(2).dot(up) * up).normalized(), front = up.cross(across);
    const Eigen::Vector3d to_shoulder = point(2) - point(1);
    forward_ = to_shoulder.dot(front);
    to_model_ = inverse_of({{{triple_of(front), triple_of(-across), triple_of(up)}}, triple_of(point(1) + to_shoulder.dot(up) * up)});

    const auto angle = [&](const Eigen::Vector3d& v) { return std::atan2(v.dot(up), v.dot(front)); };
    const auto in_plane = [&](const Eigen::Vector3d& v) { return std::hypot(v.dot(front), v.dot(up)); };
    const Eigen::Vector3d upper = point(3) - point(2), fore = point(4) - point(3);
    upper_ = in_plane(upper);
    fore_ = in_plane(fore);
    sign_[2] = z(3).dot(across) < 0 ? -1 : 1;
    sign_[3] = z(4).dot(across) < 0 ? -1 : 1;
    offset_[1] = angle(upper);
    offset_[2] = angle(fore) - offset_[1];

    // Axis 5 points to (sin, -cos) of the sum of the three angles.
    const Eigen::Vector3d fifth = (z(5) - z(5).dot(across) * across).normalized();
    const double sum = std::atan2(fifth.dot(front), -fifth.dot(up));
    offset_[3] = sum - angle(fore);
    const Eigen::Vector3d meet = middle_of(point(5), z(5), point(6), z(6));
    aside_ = (meet - point(1)).dot(across);
    hand_ = (meet - point(4)).dot(fifth);

    // Behind axis 4, at the sum of the angles: x in the plane, y against axis 5, z across.
    const Eigen::Vector3d x4 = std::cos(sum) * front + std::sin(sum) * up;
    offset_[4] = std::atan2(-z(6).dot(x4), z(6).dot(across));
    const Eigen::Vector3d x6 = std::cos(offset_[4]) * x4 + std::sin(offset_[4]) * across;
    const Eigen::Vector3d z6 = -std::sin(offset_[4]) * x4 + std::cos(offset_[4]) * across;
    const Frame<double> wrist{{{triple_of(x6), triple_of(-fifth), triple_of(z6)}}, triple_of(meet)};
    from_flange_ = inverse_of(at[6]) * wrist;
}

ArmSolutions ParallelArm::solve(const Frame<double>& flange, const Joints& near) const noexcept {
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
        const double c1 = on_axis ? std::cos(model(near, 0)) : (x * reached - y * aside_) / square;
        const double s1 = on_axis ? std::sin(model(near, 0)) : (y * reached + x * aside_) / square;
        const double first = angle_of(s1, c1);
        // In the frame of the arm's plane: front, up, across.
        Frame<double> turn;
        for (std::size_t k = 0; k < 3; ++k) {
            const Triple<double>& v = wrist.axis[k];
            turn.axis[k] = {c1 * v[0] + s1 * v[1], v[2], s1 * v[0] - c1 * v[1]};
        }
        WristAngles wrists[2];
        wrist_angles(turn, model(near, 1) + model(near, 2) + model(near, 3), wrists);
        for (const WristAngles& w : wrists) {
            // wrist_angles turns by Ry(second), the joint by Ry(-fifth): the way with second >= 0 is the one with fifth <= 0.
            TwoLinks ways[2];
            double lacking = 0;
            const double px = reached - forward_ - hand_ * std::sin(w.first), py = z + hand_ * std::cos(w.first);
            if (!links_reach(upper_, fore_, px, py, model(near, 1), ways, lacking)) {
                found.missed(KinematicFault::out_of_reach, lacking);
                continue;
            }
            for (const TwoLinks& way : ways) {
                const double second = way.angle(), third = way.between();
                const Joints angles{first, second, third, w.first - second - third, -w.second, w.third};
                Joints joints;
                for (std::size_t i = 0; i < 6; ++i) joints[i] = sign_[i] * (angles[i] - offset_[i]);
                found.add(joints, {flag<Shoulder>(side), flag<Elbow>(&way == &ways[0] ? 1 : -1), flag<Wrist>(&w == &wrists[1] ? 1 : -1)});
            }
        }
    }
    return found;
}

double ParallelArm::front_of_axis_1(const Joints& joints) const noexcept {
    const double second = model(joints, 1), third = second + model(joints, 2), fourth = third + model(joints, 3);
    return forward_ + upper_ * std::cos(second) + fore_ * std::cos(third) + hand_ * std::sin(fourth);
}

Branch ParallelArm::branch(const Joints& joints) const noexcept {
    return {flag<Shoulder>(front_of_axis_1(joints)), flag<Elbow>(std::sin(model(joints, 2))), flag<Wrist>(std::sin(model(joints, 4)))};
}

Singularity ParallelArm::singularity(const Joints& joints) const noexcept {
    Singularity s;
    s.consider(SingularityKind::shoulder, std::abs(front_of_axis_1(joints)) / (upper_ + fore_));
    s.consider(SingularityKind::elbow, std::abs(std::sin(model(joints, 2))));
    s.consider(SingularityKind::wrist, std::abs(std::sin(model(joints, 4))));
    return s;
}

}  // namespace taktwerk::axes

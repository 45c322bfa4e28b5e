#include "axes/path/path_chart.hpp"

#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

/// cos(r/2) and sin(r/2)/r with its derivatives by n = r^2.
struct HalfAngle {
    double cosine;
    std::array<double, 4> sine;  // D, dD/dn, d2D/dn2, d3D/dn3
};

HalfAngle half_angle(double n) {
    HalfAngle h{};
    const double r = std::sqrt(n);
    h.cosine = math::cos(r / 2);
    if (n > 1) {
        h.sine[0] = math::sin(r / 2) / r;
        h.sine[1] = (h.cosine / 2 - h.sine[0]) / (2 * n);
        h.sine[2] = (-h.sine[0] / 8 - 3 * h.sine[1]) / (2 * n);
        h.sine[3] = (-h.sine[1] / 8 - 5 * h.sine[2]) / (2 * n);
        return h;
    }
    // sum of (-1)^k n^k / (2^(2k+1) (2k+1)!), term by term with its derivatives
    double coefficient = 0.5;
    std::array<double, 12> c{};
    for (int k = 0; k < 12; ++k) {
        c[static_cast<std::size_t>(k)] = coefficient;
        coefficient *= -1.0 / (4.0 * (2 * k + 2) * (2 * k + 3));
    }
    for (int k = 11; k >= 0; --k) {
        h.sine[3] = h.sine[3] * n + 3 * h.sine[2];
        h.sine[2] = h.sine[2] * n + 2 * h.sine[1];
        h.sine[1] = h.sine[1] * n + h.sine[0];
        h.sine[0] = h.sine[0] * n + c[static_cast<std::size_t>(k)];
    }
    return h;
}

/// A product of quaternions that are not of length 1.
Eigen::Quaterniond times(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) { return a * b; }

Eigen::Vector3d twice_vector(const Eigen::Quaterniond& q) { return 2 * q.vec(); }

Eigen::Quaterniond make(double w, const Eigen::Vector3d& v) { return {w, v.x(), v.y(), v.z()}; }

}  // namespace

PosePoint pose_point(const PathPoint& point, const PathChart& chart) noexcept {
    PosePoint p;
    p.position = point.at.head<3>();
    p.linear = {point.first.head<3>(), point.second.head<3>(), point.third.head<3>()};
    p.angular = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    const Eigen::Quaterniond reference(chart.reference[0], chart.reference[1], chart.reference[2], chart.reference[3]);
    p.orientation = reference;
    if (chart.lever <= 0) return p;
    const double scale = 1 / chart.lever;
    const Eigen::Vector3d r = scale * point.at.segment<3>(3), r1 = scale * point.first.segment<3>(3);
    const Eigen::Vector3d r2 = scale * point.second.segment<3>(3), r3 = scale * point.third.segment<3>(3);
    const double n = r.squaredNorm(), n1 = 2 * r.dot(r1), n2 = 2 * (r1.dot(r1) + r.dot(r2)), n3 = 2 * (3 * r1.dot(r2) + r.dot(r3));
    const HalfAngle h = half_angle(n);
    const auto& d = h.sine;
    // D(n(s)) and its derivatives by s; those of the cosine follow from d(cos)/dn = -D/4.
    const double d1 = d[1] * n1, d2 = d[2] * n1 * n1 + d[1] * n2;
    const double d3 = d[3] * n1 * n1 * n1 + 3 * d[2] * n1 * n2 + d[1] * n3;
    const Eigen::Quaterniond q0 = make(h.cosine, d[0] * r);
    const Eigen::Quaterniond q1 = make(-d[0] * n1 / 4, d1 * r + d[0] * r1);
    const Eigen::Quaterniond q2 = make(-(d1 * n1 + d[0] * n2) / 4, d2 * r + 2 * d1 * r1 + d[0] * r2);
    const Eigen::Quaterniond q3 = make(-(d2 * n1 + 2 * d1 * n2 + d[0] * n3) / 4, d3 * r + 3 * d2 * r1 + 3 * d1 * r2 + d[0] * r3);
    p.orientation = reference * q0;
    const Eigen::Quaterniond back = q0.conjugate(), back1 = q1.conjugate(), back2 = q2.conjugate();
    const Eigen::Matrix3d turn = reference.toRotationMatrix();
    p.angular[0] = turn * twice_vector(times(q1, back));
    p.angular[1] = turn * (twice_vector(times(q2, back)) + twice_vector(times(q1, back1)));
    p.angular[2] = turn * (twice_vector(times(q3, back)) + 2 * twice_vector(times(q2, back1)) + twice_vector(times(q1, back2)));
    return p;
}

Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept {
    Eigen::Quaterniond q = from.conjugate() * to;
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    if (sine < 1e-9) return 2 * q.vec();  // cubic below
    return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

}  // namespace taktwerk::axes

#pragma once
// A rotation matrix with an origin, over any kind of number: forward kinematics are written once and fed with plain numbers, with jets (for
// derivatives) and, in tests, with complex ones. Pure, real-time safe.

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "axes/pose_math.hpp"

namespace taktwerk::axes {

template <class S>
using Triple = std::array<S, 3>;

template <class S>
[[nodiscard]] constexpr Triple<S> cross(const Triple<S>& a, const Triple<S>& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class S>
[[nodiscard]] constexpr S dot(const Triple<S>& a, const Triple<S>& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
[[nodiscard]] constexpr Triple<S> minus(const Triple<S>& a, const Triple<S>& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
/// a + factor * b
template <class S>
[[nodiscard]] constexpr Triple<S> plus(const Triple<S>& a, const S& factor, const Triple<S>& b) noexcept {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

template <class S>
struct Frame {
    std::array<Triple<S>, 3> axis{{{S(1), S(0), S(0)}, {S(0), S(1), S(0)}, {S(0), S(0), S(1)}}};  ///< x, y, z: columns of the matrix
    Triple<S> origin{};

    /// Turns about its own axis `around` (0 x, 1 y, 2 z), given sine and cosine.
    constexpr void turn(std::size_t around, const S& sine, const S& cosine) noexcept {
        Triple<S>& a = axis[(around + 1) % 3];
        Triple<S>& b = axis[(around + 2) % 3];
        for (std::size_t i = 0; i < 3; ++i) {
            const S along = a[i];
            a[i] = cosine * along + sine * b[i];
            b[i] = cosine * b[i] - sine * along;
        }
    }
    void turn(std::size_t around, const S& angle) noexcept {
        using std::cos;
        using std::sin;
        turn(around, sin(angle), cos(angle));
    }
};

/// Seen from this frame, in the frame that `f` is seen from.
template <class S>
[[nodiscard]] constexpr Triple<S> rotated(const Frame<S>& f, const Triple<double>& v) noexcept {
    Triple<S> r;
    for (std::size_t i = 0; i < 3; ++i) r[i] = f.axis[0][i] * v[0] + f.axis[1][i] * v[1] + f.axis[2][i] * v[2];
    return r;
}
template <class S>
[[nodiscard]] constexpr Frame<S> operator*(const Frame<S>& outer, const Frame<double>& inner) noexcept {
    Frame<S> r;
    for (std::size_t k = 0; k < 3; ++k) r.axis[k] = rotated(outer, inner.axis[k]);
    const Triple<S> way = rotated(outer, inner.origin);
    for (std::size_t i = 0; i < 3; ++i) r.origin[i] = outer.origin[i] + way[i];
    return r;
}

/// Of plain numbers: two at once, each by the same operations in the same order.
[[nodiscard]] inline Frame<double> operator*(const Frame<double>& outer, const Frame<double>& inner) noexcept {
    using Two [[gnu::vector_size(16)]] = double;
    const Triple<double>&x = outer.axis[0], &y = outer.axis[1], &z = outer.axis[2];
    const Two x01{x[0], x[1]}, y01{y[0], y[1]}, z01{z[0], z[1]};
    const std::array<const Triple<double>*, 4> in{&inner.axis[0], &inner.axis[1], &inner.axis[2], &inner.origin};
    std::array<Two, 4> first;
    for (std::size_t k = 0; k < 4; ++k) first[k] = x01 * (*in[k])[0] + y01 * (*in[k])[1] + z01 * (*in[k])[2];
    std::array<Two, 2> last;
    for (std::size_t k = 0; k < 2; ++k) {
        const Triple<double>&a = *in[2 * k], &b = *in[2 * k + 1];
        last[k] = x[2] * Two{a[0], b[0]} + y[2] * Two{a[1], b[1]} + z[2] * Two{a[2], b[2]};
    }
    return {{{{first[0][0], first[0][1], last[0][0]}, {first[1][0], first[1][1], last[0][1]}, {first[2][0], first[2][1], last[1][0]}}},
            {outer.origin[0] + first[3][0], outer.origin[1] + first[3][1], outer.origin[2] + last[1][1]}};
}

[[nodiscard]] constexpr Frame<double> inverse_of(const Frame<double>& f) noexcept {
    Frame<double> r;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) r.axis[k][i] = f.axis[i][k];
    r.origin = {};
    for (std::size_t i = 0; i < 3; ++i) r.origin[i] = -dot(f.axis[i], f.origin);
    return r;
}
[[nodiscard]] inline Frame<double> turned(std::size_t around, double angle) noexcept {
    Frame<double> r;
    r.turn(around, angle);
    return r;
}
[[nodiscard]] constexpr Frame<double> shifted(double x, double y, double z) noexcept {
    Frame<double> r;
    r.origin = {x, y, z};
    return r;
}

[[nodiscard]] inline Eigen::Vector3d vector_of(const Triple<double>& t) noexcept { return {t[0], t[1], t[2]}; }
[[nodiscard]] inline Triple<double> triple_of(const Eigen::Vector3d& v) noexcept { return {v.x(), v.y(), v.z()}; }

[[nodiscard]] inline Frame<double> frame_of(const Pose& pose) noexcept {
    const Eigen::Matrix3d turn = orientation_of(pose).toRotationMatrix();
    return {{{triple_of(turn.col(0)), triple_of(turn.col(1)), triple_of(turn.col(2))}}, pose.position};
}
/// The quaternion with w >= 0.
[[nodiscard]] inline Pose pose_of(const Frame<double>& frame) noexcept {
    Eigen::Matrix3d turn;
    for (int k = 0; k < 3; ++k) turn.col(k) = vector_of(frame.axis[static_cast<std::size_t>(k)]);
    Eigen::Quaterniond q{turn};
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    return pose_of(vector_of(frame.origin), q);
}

}  // namespace taktwerk::axes

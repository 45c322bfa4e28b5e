#pragma once
// Where the tool of a machine of config/machines/ is, worked out from that file with nothing of axes/kinematics: sines, cosines, and three spheres that meet.
// Axes in their own units (deg, mm), lengths in mm.

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace taktwerk::group_hand {

using Point = std::array<double, 3>;

/// An arm of config/machines/ with a tool that stands off its flange.
struct MachineArm {
    std::string machine, group;
    std::vector<std::string> joints;
    Point tool{};  ///< its point, seen from the flange
    std::function<Point(const std::vector<double>&, const Point& tool)> place;
    bool turns = true;  ///< its tool
    bool emergency = true;
};

namespace by_hand {

inline constexpr double degree = std::numbers::pi / 180;

inline Point turned_z(const Point& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}
inline Point turned_y(const Point& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]};
}
inline Point sum(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// Two links, a lift, a turn.
inline Point scara(double first, double second, double height, const std::vector<double>& q, const Point& tool) {
    const double one = q[0] * degree, two = one + q[1] * degree, three = two + q[3] * degree;
    const Point flange{first * std::cos(one) + second * std::cos(two), first * std::sin(one) + second * std::sin(two), height + q[2]};
    return sum(flange, turned_z(tool, three));
}

/// Three upper arms, 120 degrees apart, positive down; its rods end on a platform that does not turn.
inline Point delta(double base, double platform, double upper, double rod, const std::vector<double>& q, const Point& tool) {
    std::array<Point, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double a = q[i] * degree;
        c[i] = turned_z({base - platform + upper * std::cos(a), 0, -upper * std::sin(a)}, 120 * degree * static_cast<double>(i));
    }
    // Where spheres of one radius about three points meet: above or below the middle of the circle through these; here below.
    const auto minus = [](const Point& a, const Point& b) { return Point{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
    const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto cross = [](const Point& a, const Point& b) {
        return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Point u = minus(c[1], c[0]), v = minus(c[2], c[0]), n = cross(u, v);
    const double nn = dot(n, n), uu = dot(u, u), vv = dot(v, v);
    const Point a = cross(v, n), b = cross(n, u);
    Point middle{};
    for (std::size_t k = 0; k < 3; ++k) middle[k] = c[0][k] + (uu * a[k] + vv * b[k]) / (2 * nn);
    const Point r = minus(middle, c[0]);
    const double up = std::sqrt(rod * rod - dot(r, r)) / std::sqrt(nn), sense = n[2] > 0 ? -1 : 1;
    Point p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = middle[k] + sense * up * n[k] + tool[k];
    return p;
}

/// KUKA's KR 6 R900 sixx, as five-drives.yaml counts its joints.
inline Point kr6(const std::vector<double>& q, const Point& tool) {
    const std::array<double, 6> j{-q[0] * degree, (q[1] + 90) * degree, q[2] * degree, -q[3] * degree, q[4] * degree, -q[5] * degree};
    Point p = turned_z(sum(tool, {0, 0, 80}), j[5]);
    p = turned_z(turned_y(p, j[4]), j[3]);
    p = turned_y(sum(p, {-35, 0, 420}), j[2]);
    p = turned_y(sum(p, {0, 0, 455}), j[1]);
    return turned_z(sum(p, {25, 0, 400}), j[0]);
}

}  // namespace by_hand

inline std::vector<MachineArm> machine_arms() {
    return {
        {"scara",
         "arm",
         {"shoulder", "elbow", "lift", "wrist"},
         {250, 60, -40},
         [](const std::vector<double>& q, const Point& t) { return by_hand::scara(200, 150, 0, q, t); },
         true,
         false},
        {"five-drives", "arm", {"j1", "j2", "j3", "j4", "j5", "j6"}, {300, 0, 250}, by_hand::kr6, true, true},
        {"delta-picker",
         "delta",
         {"arm1", "arm2", "arm3"},
         {30, -20, -40},
         [](const std::vector<double>& q, const Point& t) { return by_hand::delta(200, 45, 235, 800, q, t); },
         false,
         true},
        {"palletizer",
         "arm",
         {"shoulder", "elbow", "lift", "wrist"},
         {400, 0, -80},
         [](const std::vector<double>& q, const Point& t) { return by_hand::scara(325, 275, 400, q, t); },
         true,
         true},
    };
}

}  // namespace taktwerk::group_hand

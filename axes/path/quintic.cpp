#include "axes/path/quintic.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {
namespace {

// Gauss and Legendre, eight points on [-1, 1] (Abramowitz and Stegun 25.4.30).
constexpr std::array<double, 4> gauss_x{0.1834346424956498049394761, 0.5255324099163289858177390, 0.7966664774136267395915539,
                                        0.9602898564975362316835609};
constexpr std::array<double, 4> gauss_w{0.3626837833783619829651504, 0.3137066458778872873379622, 0.2223810344533744705443560,
                                        0.1012285362903762591525314};

constexpr double parts = 8;             // of a curve that hardly bends
constexpr double part_of_radius = 0.2;  // rad

}  // namespace

Quintic::Quintic(const PathPoint& from, const PathPoint& to, double stretch) noexcept {
    // With derivatives by u at the ends: those by length times stretch and stretch^2 (second by u has no part along the tangent).
    const PathVector d0 = stretch * from.first, d1 = stretch * to.first;
    const PathVector e0 = stretch * stretch * from.second, e1 = stretch * stretch * to.second;
    c_[0] = from.at;
    c_[1] = d0;
    c_[2] = 0.5 * e0;
    const PathVector way = to.at - c_[0] - c_[1] - c_[2], speed = d1 - c_[1] - 2 * c_[2], pull = e1 - 2 * c_[2];
    c_[3] = 10 * way - 4 * speed + 0.5 * pull;
    c_[4] = -15 * way + 7 * speed - pull;
    c_[5] = 6 * way - 3 * speed + 0.5 * pull;
    measure();
}

Quintic::Quintic(const std::array<PathVector, 6>& coefficients) noexcept : c_(coefficients) { measure(); }

PathVector Quintic::point(double u) const noexcept { return c_[0] + u * (c_[1] + u * (c_[2] + u * (c_[3] + u * (c_[4] + u * c_[5])))); }

PathVector Quintic::tangent(double u) const noexcept {
    return c_[1] + u * (2 * c_[2] + u * (3 * c_[3] + u * (4 * c_[4] + u * (5 * c_[5]))));
}

PathVector Quintic::bend(double u) const noexcept { return 2 * c_[2] + u * (6 * c_[3] + u * (12 * c_[4] + u * (20 * c_[5]))); }

/// |dx/du|^2 about the middle, where its terms are smallest: a length then takes a polynomial of one number instead of vectors.
void Quintic::square_speed() noexcept {
    std::array<PathVector, 5> t;  // of the tangent: first by u
    for (std::size_t k = 0; k < t.size(); ++k) t[k] = static_cast<double>(k + 1) * c_[k + 1];
    for (std::size_t round = 0; round + 1 < t.size(); ++round)
        for (std::size_t k = t.size() - 1; k-- > round;) t[k] += 0.5 * t[k + 1];
    speed2_.fill(0);
    for (std::size_t i = 0; i < t.size(); ++i)
        for (std::size_t k = 0; k < t.size(); ++k) speed2_[i + k] += t[i].dot(t[k]);
}

double Quintic::length_between(double from, double to) const noexcept {
    const double half = (to - from) / 2, middle = (from + to) / 2 - 0.5;
    Eigen::Array<double, 8, 1> u, square = Eigen::Array<double, 8, 1>::Constant(speed2_[8]), weight;
    for (int i = 0; i < 4; ++i) {
        const auto k = static_cast<std::size_t>(i);
        u[2 * i] = middle - half * gauss_x[k];
        u[2 * i + 1] = middle + half * gauss_x[k];
        weight[2 * i] = weight[2 * i + 1] = gauss_w[k];
    }
    for (std::size_t i = 8; i-- > 0;) square = square * u + speed2_[i];
    return half * (weight * square.max(0.0).sqrt()).sum();
}

void Quintic::measure() noexcept {
    square_speed();
    lengths_[0] = 0;
    slowest_ = tangent(0).norm();
    for (int i = 0; i <= spans; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double u = static_cast<double>(i) / spans;
        if (i > 0) lengths_[k] = lengths_[k - 1] + length_between(static_cast<double>(i - 1) / spans, u);
        const PathVector t = tangent(u);
        const double speed = std::max(t.norm(), 1e-300);
        rates_[k] = 1 / speed;
        const PathVector b = bend(u);
        bends_[k] = (b / (speed * speed) - t * (t.dot(b) / (speed * speed * speed * speed))).norm();
        rate_slopes_[k] = -t.dot(b) / (speed * speed * speed * speed);
        slowest_ = std::min({slowest_, speed, tangent(std::min(1.0, u + 0.5 / spans)).norm()});
    }
}

double Quintic::length_to(double u) const noexcept {
    const int i = std::clamp(static_cast<int>(u * spans), 0, spans - 1);
    return lengths_[static_cast<std::size_t>(i)] + length_between(static_cast<double>(i) / spans, u);
}

std::size_t Quintic::span_of(double s) const noexcept {
    std::size_t i = 0;
    for (std::size_t step = spans / 2; step > 0; step /= 2)
        if (lengths_[i + step] <= s) i += step;
    return i;
}

double Quintic::feature(double s) const noexcept {
    const std::size_t i = span_of(s);
    return std::min(length() / parts, part_of_radius / std::max({bends_[i], bends_[i + 1], 1e-300}));
}

double Quintic::parameter_at(double s) const noexcept {
    const std::size_t i = span_of(s);
    // Hermite's interpolation of the inverse with two derivatives at both ends, then Newton's method, of which one step mostly does.
    const double h = lengths_[i + 1] - lengths_[i], x = (s - lengths_[i]) / h;
    const double u0 = static_cast<double>(i) / spans;
    const double d0 = h * rates_[i], d1 = h * rates_[i + 1], e0 = h * h * rate_slopes_[i] / 2, e1 = h * h * rate_slopes_[i + 1];
    const double way = 1.0 / spans - d0 - e0, speed = d1 - d0 - 2 * e0, pull = e1 - 2 * e0;
    double u = u0 + x * (d0 + x * (e0 + x * (10 * way - 4 * speed + 0.5 * pull +
                                             x * (-15 * way + 7 * speed - pull + x * (6 * way - 3 * speed + 0.5 * pull)))));
    for (int k = 0; k < 3; ++k) {
        const double step = (lengths_[i] + length_between(u0, u) - s) / tangent(u).norm();
        u -= step;
        if (std::fabs(step) < 1e-8) break;  // the next one would be its square
    }
    return std::clamp(u, 0.0, 1.0);
}

PathPoint Quintic::by_parameter(double u, double stretch) const noexcept {
    const double r = 1 / stretch;
    PathPoint p;
    p.at = point(u);
    p.first = r * tangent(u);
    p.second = r * r * bend(u);
    p.third = r * r * r * (6 * c_[3] + u * (24 * c_[4] + u * (60 * c_[5])));
    return p;
}

PathPoint Quintic::at(double s) const noexcept {
    const double u = parameter_at(s);
    const PathVector t = tangent(u), b = bend(u), twist = 6 * c_[3] + u * (24 * c_[4] + u * (60 * c_[5]));
    const double speed = t.norm();
    const double speed1 = t.dot(b) / speed;
    const double speed2 = (b.squaredNorm() + t.dot(twist) - speed1 * speed1) / speed;
    // du/ds and its derivatives by s
    const double r = 1 / speed;
    const double r1 = -speed1 * r * r * r;
    const double r2 = (3 * speed1 * speed1 * r - speed2) * r * r * r * r;
    PathPoint p;
    p.at = point(u);
    p.first = r * t;
    p.second = r * r * b + r1 * t;
    p.third = r * r * r * twist + 3 * r * r1 * b + r2 * t;
    return p;
}

}  // namespace taktwerk::axes

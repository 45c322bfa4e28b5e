#pragma once
// A number that knows its first three derivatives by a parameter: what a formula is fed with to get the derivatives of its result, exact to
// rounding. Pure, real-time safe.

#include <cmath>

namespace taktwerk::axes {

struct Jet {
    double v = 0;   ///< value
    double d1 = 0;  ///< first, second, third derivative
    double d2 = 0;
    double d3 = 0;

    constexpr Jet() noexcept = default;
    constexpr Jet(double value) noexcept : v{value} {}  // NOLINT(google-explicit-constructor): a constant is a number
    constexpr Jet(double value, double first, double second, double third) noexcept : v{value}, d1{first}, d2{second}, d3{third} {}

    constexpr Jet& operator+=(const Jet& b) noexcept { return *this = Jet{v + b.v, d1 + b.d1, d2 + b.d2, d3 + b.d3}; }
};

[[nodiscard]] constexpr Jet operator+(const Jet& a, const Jet& b) noexcept { return {a.v + b.v, a.d1 + b.d1, a.d2 + b.d2, a.d3 + b.d3}; }
[[nodiscard]] constexpr Jet operator-(const Jet& a, const Jet& b) noexcept { return {a.v - b.v, a.d1 - b.d1, a.d2 - b.d2, a.d3 - b.d3}; }
[[nodiscard]] constexpr Jet operator-(const Jet& a) noexcept { return {-a.v, -a.d1, -a.d2, -a.d3}; }

/// Leibniz' rule.
[[nodiscard]] constexpr Jet operator*(const Jet& a, const Jet& b) noexcept {
    return {a.v * b.v, a.d1 * b.v + a.v * b.d1, a.d2 * b.v + 2 * a.d1 * b.d1 + a.v * b.d2,
            a.d3 * b.v + 3 * a.d2 * b.d1 + 3 * a.d1 * b.d2 + a.v * b.d3};
}

/// f(a), given f and its derivatives at a.v. Faa di Bruno's rule.
[[nodiscard]] constexpr Jet chained(const Jet& a, double f, double f1, double f2, double f3) noexcept {
    return {f, f1 * a.d1, f2 * a.d1 * a.d1 + f1 * a.d2, f3 * a.d1 * a.d1 * a.d1 + 3 * f2 * a.d1 * a.d2 + f1 * a.d3};
}

[[nodiscard]] constexpr Jet operator/(const Jet& a, const Jet& b) noexcept {
    const double r = 1 / b.v;
    return a * chained(b, r, -r * r, 2 * r * r * r, -6 * r * r * r * r);
}
[[nodiscard]] inline Jet sin(const Jet& a) noexcept {
    const double s = std::sin(a.v), c = std::cos(a.v);
    return chained(a, s, c, -s, -c);
}
[[nodiscard]] inline Jet cos(const Jet& a) noexcept {
    const double s = std::sin(a.v), c = std::cos(a.v);
    return chained(a, c, -s, -c, s);
}
[[nodiscard]] inline Jet sqrt(const Jet& a) noexcept {
    const double root = std::sqrt(a.v), r = 1 / a.v;
    return chained(a, root, 0.5 * root * r, -0.25 * root * r * r, 0.375 * root * r * r * r);
}

}  // namespace taktwerk::axes

#pragma once
// A number that knows its first derivatives by a parameter, up to `Order` (1 to 3): what a formula is fed with to get the derivatives of its result,
// exact to rounding. Those beyond stay 0 and cost nothing. Pure, real-time safe.

#include <cmath>

namespace taktwerk::axes {

template <int Order>
struct JetOf {
    double v = 0;   ///< value
    double d1 = 0;  ///< first, second, third derivative
    double d2 = 0;
    double d3 = 0;

    constexpr JetOf() noexcept = default;
    constexpr JetOf(double value) noexcept : v{value} {}  // NOLINT(google-explicit-constructor): a constant is a number
    constexpr JetOf(double value, double first, double second, double third) noexcept : v{value}, d1{first}, d2{second}, d3{third} {}

    constexpr JetOf& operator+=(const JetOf& b) noexcept { return *this = *this + b; }

    friend constexpr JetOf operator+(const JetOf& a, const JetOf& b) noexcept {
        return made(a.v + b.v, a.d1 + b.d1, a.d2 + b.d2, a.d3 + b.d3);
    }
    friend constexpr JetOf operator-(const JetOf& a, const JetOf& b) noexcept {
        return made(a.v - b.v, a.d1 - b.d1, a.d2 - b.d2, a.d3 - b.d3);
    }
    friend constexpr JetOf operator-(const JetOf& a) noexcept { return made(-a.v, -a.d1, -a.d2, -a.d3); }
    friend constexpr JetOf operator*(const JetOf& a, double b) noexcept { return made(a.v * b, a.d1 * b, a.d2 * b, a.d3 * b); }
    friend constexpr JetOf operator*(double a, const JetOf& b) noexcept { return b * a; }

    /// Leibniz' rule.
    friend constexpr JetOf operator*(const JetOf& a, const JetOf& b) noexcept {
        return made(a.v * b.v, a.d1 * b.v + a.v * b.d1, a.d2 * b.v + 2 * a.d1 * b.d1 + a.v * b.d2,
                    a.d3 * b.v + 3 * a.d2 * b.d1 + 3 * a.d1 * b.d2 + a.v * b.d3);
    }
    /// f(a), given f and its derivatives at a.v. Faa di Bruno's rule.
    [[nodiscard]] static constexpr JetOf chained(const JetOf& a, double f, double f1, double f2, double f3) noexcept {
        return made(f, f1 * a.d1, f2 * a.d1 * a.d1 + f1 * a.d2, f3 * a.d1 * a.d1 * a.d1 + 3 * f2 * a.d1 * a.d2 + f1 * a.d3);
    }
    friend constexpr JetOf operator/(const JetOf& a, const JetOf& b) noexcept {
        const double r = 1 / b.v;
        return a * chained(b, r, -r * r, 2 * r * r * r, -6 * r * r * r * r);
    }
    friend JetOf sin(const JetOf& a) noexcept {
        const double s = std::sin(a.v), c = std::cos(a.v);
        return chained(a, s, c, -s, -c);
    }
    friend JetOf cos(const JetOf& a) noexcept {
        const double s = std::sin(a.v), c = std::cos(a.v);
        return chained(a, c, -s, -c, s);
    }
    friend JetOf sqrt(const JetOf& a) noexcept {
        const double root = std::sqrt(a.v), r = 1 / a.v;
        return chained(a, root, 0.5 * root * r, -0.25 * root * r * r, 0.375 * root * r * r * r);
    }

private:
    /// What is beyond the order is not computed.
    [[nodiscard]] static constexpr JetOf made(double value, double first, double second, double third) noexcept {
        return {value, first, Order > 1 ? second : 0, Order > 2 ? third : 0};
    }
};

}  // namespace taktwerk::axes

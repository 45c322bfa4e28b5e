#pragma once
// A polynomial of the fifth degree in u in [0, 1], and itself by arc length. Real-time safe once made.

#include <array>
#include <cstddef>

#include "axes/path/path_vector.hpp"

namespace taktwerk::axes {

class Quintic {
public:
    Quintic() = default;
    /// From a point to a point, with first and second derivatives by length as given, where u = 1 stands for about `stretch` of length. The
    /// curve is twice continuously differentiable by length where it meets others with these derivatives.
    Quintic(const PathPoint& from, const PathPoint& to, double stretch) noexcept;
    /// From its coefficients of 1, u, ... u^5.
    explicit Quintic(const std::array<PathVector, 6>& coefficients) noexcept;

    void shift(const PathVector& by) noexcept { c_[0] += by; }

    /// Within 1e-12 of itself, u.
    [[nodiscard]] double length() const noexcept { return lengths_.back(); }
    /// s in [0, length()].
    [[nodiscard]] PathPoint at(double s) const noexcept;
    /// u at s, and s at u: each is the other's inverse within 1e-12 of the length.
    [[nodiscard]] double parameter_at(double s) const noexcept;
    [[nodiscard]] double length_to(double u) const noexcept;
    /// Whether its speed |dx/du| stays above a twentieth of its length: otherwise it has nearly a cusp.
    [[nodiscard]] bool smooth() const noexcept { return slowest_ > 0.05 * length(); }

    /// The length around s on which its direction changes little: a part of its radius of curvature, and of itself.
    [[nodiscard]] double feature(double s) const noexcept;

    [[nodiscard]] PathVector point(double u) const noexcept;
    /// By a length of which u is one part in `stretch`, whatever the curve's own is.
    [[nodiscard]] PathPoint by_parameter(double u, double stretch) const noexcept;

private:
    static constexpr int spans = 32;  // a power of two

    void measure() noexcept;
    [[nodiscard]] std::size_t span_of(double s) const noexcept;
    [[nodiscard]] PathVector tangent(double u) const noexcept;
    [[nodiscard]] PathVector bend(double u) const noexcept;
    void square_speed() noexcept;
    [[nodiscard]] double length_between(double from, double to) const noexcept;

    std::array<PathVector, 6> c_{};
    std::array<double, spans + 1> lengths_{};      // from 0 to u = i/spans
    std::array<double, spans + 1> rates_{};        // du/ds there
    std::array<double, spans + 1> rate_slopes_{};  // d2u/ds2 there
    std::array<double, spans + 1> bends_{};        // curvature there
    std::array<double, 9> speed2_{};               // |dx/du|^2 as a polynomial of u - 1/2
    double slowest_ = 0;
};

}  // namespace taktwerk::axes

#pragma once
// The angle whose sine and cosine have the ratio of two numbers, without a branch: what closed forms spend most of their time on. std::atan2, right
// to the last bit, takes twice as long for angles that nobody can foretell. Pure, real-time safe.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace taktwerk::axes {

/// atan(t) for |t| <= tan(pi / 8) to 5e-18 of t: t + t^3 P(t^2), P through the values at the zeros of a Chebyshev polynomial.
[[nodiscard]] inline double small_arc_tangent(double t) noexcept {
    constexpr std::array<double, 11> p{-0x1.5555555555555p-2, 0x1.999999999934ap-3, -0x1.24924924360cbp-3, 0x1.c71c7185314cbp-4,
                                       -0x1.745d0b26b83e7p-4, 0x1.3b1262d95579ep-4, -0x1.10fa75382537fp-4, 0x1.dfe61e80903d2p-5,
                                       -0x1.a098bb6ba4941p-5, 0x1.41603647c7a7cp-5, -0x1.3a2b7a07caea9p-6};
    // In pairs, so that a processor computes several at once.
    const double z = t * t, z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
    const double low = (p[0] + p[1] * z) + (p[2] + p[3] * z) * z2;
    const double middle = (p[4] + p[5] * z) + (p[6] + p[7] * z) * z2;
    const double high = (p[8] + p[9] * z) + p[10] * z2;
    return t + t * z * (low + middle * z4 + high * z8);
}

/// In [-pi, pi], right to 4e-16 of the angle; both numbers finite, of less than 1e300. Of 0 and 0, or less than 1e-300: 0. As std::atan2, but for the
/// sign of a cosine of zero, which does not matter. What is no number stays none.
[[nodiscard]] inline double angle_of(double sine, double cosine) noexcept {
    constexpr double eighth = 0x1.921fb54442d18p-1, eighth_rest = 0x1.1a62633145c07p-55;  // pi / 4
    // In this order min and max pass on what is no number.
    const double up = std::abs(sine), along = std::abs(cosine);
    const double less = std::min(up, along), more = std::max(std::max(along, up), std::numeric_limits<double>::min());
    // Numbers of 0 and 1 instead of conditions: compilers make jumps of those, and the angle decides which.
    const auto whether = [](bool yes) { return static_cast<double>(static_cast<int>(yes)); };
    const double far = whether(less > 0x1.a827999fcef32p-2 * more);  // than tan(pi / 8): then the ratio is that of what lacks to pi / 4
    const double steep = whether(up > along), behind = whether(cosine < 0);
    const double t = (less - far * more) / (more + far * less);
    double eighths = far + steep * (2 - 2 * far);
    eighths += behind * (4 - 2 * eighths);
    const double sign = (1 - 2 * steep) * (1 - 2 * behind);
    return std::copysign(eighths * eighth + (sign * small_arc_tangent(t) + eighths * eighth_rest), sine);
}

}  // namespace taktwerk::axes

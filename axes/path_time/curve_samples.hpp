#pragma once
// What samples of a curve say of what lies between them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

/// What a cubic may reach beyond the parabola through three samples, by its third difference: the greatest |t (t^2 - 1)|/6 on [-1, 1].
inline constexpr double cubic_part = 0.065;

/// The greatest |x|, x as parts of a limit, with what a parabola through each three samples reaches between them, and what it may be wrong by: a
/// cubic's part. Where all samples are below 0.9, what lies between them does not count.
[[nodiscard]] inline double sampled_peak(std::span<const double> x) noexcept {
    constexpr double looks_closer = 0.9;
    double most = 0;
    for (const double v : x) most = std::max(most, std::fabs(v));
    if (most < looks_closer) return most;
    for (std::size_t i = 2; i < x.size(); ++i) {
        const double bend = x[i] - 2 * x[i - 1] + x[i - 2], slope = x[i] - x[i - 2];
        if (std::fabs(slope) >= 2.2 * std::fabs(bend)) continue;
        double third = 0;
        if (i > 2) third = std::fabs(bend - (x[i - 1] - 2 * x[i - 2] + x[i - 3]));
        if (i + 1 < x.size()) third = std::max(third, std::fabs(x[i + 1] - 2 * x[i] + x[i - 1] - bend));
        most = std::max(most, std::fabs(x[i - 1] - slope * slope / (8 * bend)) + cubic_part * third);
    }
    return most;
}

/// Near a limit three samples and the fourth differences beside them say that a peak between them may be higher than sampled_peak() has it, by more than a millionth.
[[nodiscard]] inline bool peak_is_unsure(std::span<const double> x) noexcept {
    constexpr double near = 0.999, counts = 1e-6,
                     quartic = 0.042;  // the greatest |(t + 2) (t + 1) t (t - 1)|/24 between two samples at an end
    // All that is added to a sample below is less than 1.02 of the greatest bend: 0.72, and twice and four times that of the parts.
    double most = 0, most_bend = 0;
    for (const double v : x) most = std::max(most, std::fabs(v));
    for (std::size_t i = 2; i < x.size(); ++i) most_bend = std::max(most_bend, std::fabs(x[i] - 2 * x[i - 1] + x[i - 2]));
    if (most + 1.05 * most_bend < near) return false;
    const auto third = [&](std::size_t last) { return x[last] - 3 * (x[last - 1] - x[last - 2]) - x[last - 3]; };
    for (std::size_t i = 2; i < x.size() && x.size() > 4; ++i) {
        const double bend = x[i] - 2 * x[i - 1] + x[i - 2], slope = x[i] - x[i - 2];
        if (std::fabs(slope) >= 2.4 * std::fabs(bend)) continue;
        const std::size_t last = std::clamp<std::size_t>(i + 1, 4, x.size() - 1);
        const double may_miss = quartic * std::fabs(third(last) - third(last - 1));
        if (may_miss > counts && std::fabs(x[i - 1] - slope * slope / (8 * bend)) + cubic_part * std::fabs(third(last)) + may_miss > near)
            return true;
    }
    return false;
}

/// A cusp, or a joint that whips round: narrower than the points lie apart. Then q' changes by more than three tenths from one to the next.
[[nodiscard]] inline bool turns_between(std::span<const TimedCurvePoint> points, std::size_t axes) noexcept {
    constexpr double unresolved = 0.3;
    double before = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        double size = 0, change = 0;
        for (std::size_t i = 0; i < axes; ++i) {
            size += points[k].first[i] * points[k].first[i];
            if (k > 0) change += std::pow(points[k].first[i] - points[k - 1].first[i], 2);
        }
        if (k > 0 && change > unresolved * unresolved * std::max(size, before)) return true;
        before = size;
    }
    return false;
}

}  // namespace taktwerk::axes

#include "axes/path_time/rest_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "axes/path_time/curve_samples.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t fewest_samples = 12, most_samples = 12 * 64;
constexpr double same_square = 3e-5;
constexpr double square_margin = 1 - 1e-5;  // for what rounding leaves

/// What v2 has to be multiplied by so that nothing of this is beyond its limit: they grow with its powers 1/2, 1 and 3/2.
double share_inside(const LimitUse& use) {
    const double root = math::cbrt(use.jerk);
    return 1 / std::max({use.velocity * use.velocity, use.acceleration, root * root});
}

}  // namespace

void RestCheck::sample(const TimedCurve& curve, double at, double length, CurveSide side, std::size_t samples) {
    const double sign = side == CurveSide::after ? 1 : -1;
    points_.resize(samples + 1);
    for (std::size_t k = 0; k <= samples; ++k) {
        const double time = static_cast<double>(k) / static_cast<double>(samples);
        points_[k] = curve.at(at + sign * time * time * time * length, side);
    }
}

LimitUse RestCheck::use(std::span<const PathAxisLimits> limits, double velocity_factor, double length, double sign, double square) {
    const std::size_t count = points_.size();
    const double velocity = std::sqrt(square);
    for (std::vector<double>* all : {&x_, &y_, &z_}) all->resize(count);
    LimitUse whole;
    most_jerk_.assign(count, 0);
    const auto add = [&](const auto& of_point) {
        for (std::size_t k = 0; k < count; ++k) {
            const double time = static_cast<double>(k) / static_cast<double>(count - 1);
            const PathMotion m{0, velocity * time * time, sign * 2 * square / (3 * length) * time,
                               2 * square * velocity / (9 * length * length)};
            const LimitUse u = of_point(points_[k], m);
            x_[k] = u.velocity, y_[k] = u.acceleration, z_[k] = u.jerk;
            most_jerk_[k] = std::max(most_jerk_[k], std::fabs(u.jerk));
        }
        whole.widen({sampled_peak(x_), sampled_peak(y_), sampled_peak(z_)});
    };
    add([&](const TimedCurvePoint& p, const PathMotion& m) {
        return LimitUse{m.velocity / (p.path.velocity * velocity_factor),
                        std::max(m.acceleration / p.path.acceleration, -m.acceleration / p.path.deceleration), m.jerk / p.path.jerk};
    });
    for (std::size_t i = 0; i < limits.size(); ++i)
        add([&](const TimedCurvePoint& p, const PathMotion& m) {
            const double v = m.velocity, a = m.acceleration;
            return LimitUse{p.first[i] * v / limits[i].velocity, (p.first[i] * a + p.second[i] * v * v) / limits[i].acceleration,
                            (p.first[i] * m.jerk + 3 * p.second[i] * v * a + p.third[i] * v * v * v) / limits[i].jerk};
        });
    return whole;
}

double RestCheck::jerk_throughout(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double at, double length,
                                  CurveSide side) {
    sample(curve, at, length, side, fewest_samples);
    (void)use(limits, 1, length, side == CurveSide::after ? 1 : -1, 1);
    const auto [least, most] = std::minmax_element(most_jerk_.begin(), most_jerk_.end());
    return *most > 0 ? *least / *most : 1;
}

/// One motion says it for all: so first one whose v2 is 1, then the one that this allows, near whose limits what is between the samples counts. And
/// with twice as many samples, until they say the same.
double RestCheck::greatest_square(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double velocity_factor, double at,
                                  double length, CurveSide side) {
    const double sign = side == CurveSide::after ? 1 : -1;
    double before = 0;
    for (std::size_t samples = fewest_samples;; samples *= 2) {
        sample(curve, at, length, side, samples);
        double square = share_inside(use(limits, velocity_factor, length, sign, 1));
        square *= std::min(1.0, share_inside(use(limits, velocity_factor, length, sign, square)));
        const bool settled = std::fabs(square - before) < same_square * square && !turns_between(points_, limits.size());
        if (settled || samples >= most_samples) return square_margin * std::min(square, before > 0 ? before : square);
        before = square;
    }
}

}  // namespace taktwerk::axes

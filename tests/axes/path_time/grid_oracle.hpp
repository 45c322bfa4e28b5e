#pragma once
// How fast a curve could be passed without any limit of jerk: a bound from below by an independent method. On a fine grid of s, backwards:
// the greatest v2 from which the next point's set is reached by some acceleration; forwards: the greatest acceleration that stays inside.
// (Pham and Pham 2018, "A new approach to time-optimal path parameterization based on reachability analysis".)

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

class GridOracle {
public:
    /// Seconds from rest to rest over [from, to] in `steps` steps.
    static double time(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double from, double to, int steps) {
        const double h = (to - from) / steps;
        std::vector<TimedCurvePoint> points;
        for (int i = 0; i <= steps; ++i)
            points.push_back(curve.at(from + (to - from) * i / steps, i == steps ? CurveSide::before : CurveSide::after));
        std::vector<double> most(points.size(), 0);
        for (int i = steps - 1; i >= 0; --i) {
            const auto k = static_cast<std::size_t>(i);
            double low = 0, high = cap(points[k], limits);
            for (int n = 0; n < 60; ++n) {
                const double middle = n == 0 ? high : (low + high) / 2;
                const Range a = accelerations(points[k], limits, middle);
                (a.low <= a.high && middle + 2 * h * a.low <= most[k + 1] ? low : high) = middle;
                if (low == high) break;
            }
            most[k] = low;
        }
        double square = 0, time = 0;
        for (int i = 0; i < steps; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double next = std::clamp(square + 2 * h * accelerations(points[k], limits, square).high, 0.0, most[k + 1]);
            time += 2 * h / std::max(std::sqrt(square) + std::sqrt(next), 1e-12);
            square = next;
        }
        return time;
    }

private:
    struct Range {
        double low, high;
    };

    static double cap(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits) {
        double v = p.path.velocity;
        for (std::size_t i = 0; i < limits.size(); ++i) v = std::min(v, limits[i].velocity / std::max(std::fabs(p.first[i]), 1e-12));
        return v * v;
    }

    static Range accelerations(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits, double square) {
        Range r{-p.path.deceleration, p.path.acceleration};
        for (std::size_t i = 0; i < limits.size(); ++i) {
            const double given = p.second[i] * square, q = p.first[i], most = limits[i].acceleration;
            if (std::fabs(q) < 1e-12) {
                if (std::fabs(given) > most) return {1, -1};
                continue;
            }
            const double one = (most - given) / q, other = (-most - given) / q;
            r.low = std::max(r.low, std::min(one, other));
            r.high = std::min(r.high, std::max(one, other));
        }
        return r;
    }
};

}  // namespace taktwerk::axes

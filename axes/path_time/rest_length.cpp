#include "axes/path_time/rest_length.hpp"

#include <algorithm>
#include <cmath>

#include "axes/path_time/along_limits.hpp"

namespace taktwerk::axes {
namespace {

constexpr double rest_share = 0.2;  // of the way with jerk that the piece takes
// Out of rest it cannot be cut, and who wants to stand waits for its end: it lasts no longer than this.
constexpr double longest_beginning = 0.012;  // s
// Nor is it shorter than this part of the run, however slow that is: cells have to be longer than a place's last digits.
constexpr double shortest_rest = 1e-9;
// On a curve something has to use this much of its limit of jerk all along the piece, and as far again: else the piece is cut shorter.
constexpr double used_throughout = 0.9, looked_at = 2;
constexpr double shorter = 0.6;
constexpr int times_shorter = 10;

}  // namespace

/// The velocity from which a motion that knows no jerk but that of the curve itself, as fast as can be, first slows down on its way from that end of the run.
double RestLength::first_peak(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RestRun& run, CurveSide side) {
    const bool begins = side == CurveSide::after;
    const auto way = [&](std::size_t k) {
        const double part = static_cast<double>(k) / places;
        return (run.to - run.from) * part * part;
    };
    for (std::size_t k = 0; k <= places; ++k) {
        const TimedCurvePoint p = curve.at(begins ? run.from + way(k) : run.to - way(k), side);
        const AlongLimits l = along_limits(p, limits, run.velocity_factor);
        double square = l.velocity * l.velocity;
        for (std::size_t i = 0; i < limits.size(); ++i) {
            if (p.second[i] != 0) square = std::min(square, limits[i].acceleration / std::fabs(p.second[i]));
            if (p.third[i] != 0) square = std::min(square, two_thirds(limits[i].jerk / std::fabs(p.third[i])));
        }
        squares_[k] = square;
        accelerations_[k] = std::min(l.acceleration, l.deceleration);
    }
    squares_.front() = squares_.back() = 0;
    for (std::size_t k = 1; k <= places; ++k)
        squares_[k] = std::min(squares_[k], squares_[k - 1] + 2 * accelerations_[k - 1] * (way(k) - way(k - 1)));
    for (std::size_t k = places; k-- > 0;)
        squares_[k] = std::min(squares_[k], squares_[k + 1] + 2 * accelerations_[k + 1] * (way(k + 1) - way(k)));
    std::size_t peak = 1;
    while (peak < places && squares_[peak + 1] >= squares_[peak]) ++peak;
    return std::sqrt(squares_[peak]);
}

double RestLength::length(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RestRun& run, CurveSide side,
                          double room) {
    const bool begins = side == CurveSide::after;
    const double at = begins ? run.from : run.to, whole = run.to - run.from, shortest = shortest_rest * whole;
    const TimedCurvePoint point = curve.at(at, side);
    const AlongLimits l = along_limits(point, limits, run.velocity_factor);
    const auto any = [](const auto& of_axes) { return std::any_of(of_axes.begin(), of_axes.end(), [](double x) { return x != 0; }); };
    const bool bends = (any(point.second) || any(point.third)) && !run.halts;
    double way = whole / 12;  // a motion of jerk alone turns from speeding up to less of it there
    const double a = std::min(l.acceleration, l.deceleration),
                 v = bends ? std::min(l.velocity, first_peak(curve, limits, run, side)) : l.velocity;
    way = std::min(way, a * a * a / (6 * l.jerk * l.jerk));
    way = std::min(way, std::sqrt(v / l.jerk) * v / 6);
    double length = std::min(std::max(rest_share * way, shortest), room / 3);
    if (begins) length = std::min(length, std::max(l.jerk * longest_beginning * longest_beginning * longest_beginning / 6, shortest));
    if (!bends) return length;
    // Its one jerk is what the limits allow all along it: where the curve turns to an axis of little jerk, a long piece is a slow one.
    for (int i = 0; i < times_shorter && length > shortest; ++i) {
        if (check_.jerk_throughout(curve, limits, at, std::min(looked_at * length, room), side) > used_throughout) break;
        length = std::max(shorter * length, shortest);
    }
    return length;
}

}  // namespace taktwerk::axes

#include "axes/measuring/frequency_response.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "axes/measuring/least_squares.hpp"
#include "axes/measuring/step_response.hpp"

namespace taktwerk::axes::measuring {

namespace {

constexpr double least_quality = 0.8;
constexpr double degrees = 180 / std::numbers::pi;

double decibel(double gain) { return 20 * std::log10(gain); }

/// The sine, the cosine, an offset and a drift that explain the actual position best.
FrequencyPoint look_at(const AlignedRun& run, LegRange range, double begin, const ExcitationTone& tone, double resolution) {
    FrequencyPoint point;
    point.frequency = tone.frequency;
    point.amplitude = tone.amplitude;
    const double omega = 2 * std::numbers::pi * tone.frequency;
    LeastSquares<4> equations;
    const double at = run.actual[range.begin];
    double sum = 0, squares = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
        const double t = run.time[i] - begin, y = run.actual[i] - at;
        if (!run.holds[i] || t < tone.rise + tone.settle) continue;
        equations.add({std::sin(omega * t), std::cos(omega * t), 1, t - tone.rise}, y);
        sum += y, squares += y * y;
    }
    const auto solved = equations.solve(1e-9);
    if (!solved.solved) return point;
    const auto n = static_cast<double>(equations.rows());
    point.closed = std::complex(solved.c[0].value, solved.c[1].value) / tone.amplitude;
    point.deviation = std::max(solved.residual, resolution / std::sqrt(12.0)) * std::sqrt(2 / n) / tone.amplitude;
    const double tone_power = std::norm(point.closed) * tone.amplitude * tone.amplitude / 2;
    const double power = squares / n - sum / n * (sum / n);
    point.quality = power > 0 ? std::clamp(tone_power / power, 0.0, 1.0) : 0;
    const double gain = std::abs(point.closed);
    point.usable = point.quality > least_quality && gain > 5 * point.deviation;
    const auto rest = 1.0 - point.closed;
    point.open = point.closed / rest;
    point.open_usable = point.usable && std::abs(rest) > 5 * point.deviation;
    return point;
}

/// Where `value` passes `level` between two points, in Hz; the frequency is interpolated by its logarithm.
double crossing(double f0, double v0, double f1, double v1, double level) {
    return f0 * std::exp(std::log(f1 / f0) * (level - v0) / (v1 - v0));
}

struct Curve {
    std::vector<double> frequency, level, phase;  // Hz, dB, degrees
    [[nodiscard]] double phase_at(double f, std::size_t i) const {
        return phase[i - 1] + (phase[i] - phase[i - 1]) * std::log(f / frequency[i - 1]) / std::log(frequency[i] / frequency[i - 1]);
    }
    [[nodiscard]] double level_at(double f, std::size_t i) const {
        return level[i - 1] + (level[i] - level[i - 1]) * std::log(f / frequency[i - 1]) / std::log(frequency[i] / frequency[i - 1]);
    }
};

Curve curve_of(std::span<const FrequencyPoint> points, std::complex<double> FrequencyPoint::*which, bool FrequencyPoint::*usable) {
    Curve out;
    std::vector<FrequencyPoint> good;
    std::ranges::copy_if(points, std::back_inserter(good), [&](const auto& p) { return p.*usable; });
    out.phase = phases_of(good, which);
    for (const auto& p : good) {
        out.frequency.push_back(p.frequency);
        out.level.push_back(decibel(std::abs(p.*which)));
    }
    return out;
}

/// The deepest point with a rise of 3 dB on both sides.
std::optional<Margin> notch_of(const Curve& closed) {
    std::optional<Margin> out;
    const auto& y = closed.level;
    for (std::size_t i = 1; i + 1 < y.size(); ++i) {
        if (!(y[i] < y[i - 1] && y[i] <= y[i + 1]) || (out && y[i] >= out->value)) continue;
        const double before = *std::max_element(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(i));
        const double behind = *std::max_element(y.begin() + static_cast<std::ptrdiff_t>(i), y.end());
        if (std::min(before, behind) - y[i] >= 3) out = Margin{y[i], closed.frequency[i]};
    }
    return out;
}

}  // namespace

std::vector<double> phases_of(std::span<const FrequencyPoint> points, std::complex<double> FrequencyPoint::*which) {
    std::vector<double> out;
    for (const auto& p : points) {
        double phase = std::arg(p.*which) * degrees;
        if (!out.empty()) phase += 360 * std::round((out.back() - phase) / 360);
        out.push_back(phase);
    }
    return out;
}

LoopMargins margins_of(std::span<const FrequencyPoint> points) {
    LoopMargins out;
    const auto open = curve_of(points, &FrequencyPoint::open, &FrequencyPoint::open_usable);
    for (std::size_t i = 1; i < open.frequency.size(); ++i) {
        const auto falls = [&](const std::vector<double>& v, double level) { return v[i - 1] > level && v[i] <= level; };
        if (falls(open.level, 0)) {  // the last crossing counts: behind it the loop does nothing any more
            const double f = crossing(open.frequency[i - 1], open.level[i - 1], open.frequency[i], open.level[i], 0);
            out.phase = Margin{std::remainder(180 + open.phase_at(f, i), 360), f};
        }
        // Phases repeat after a turn, and the first has been taken for what it may not be.
        const double opposite = 360 * std::floor((open.phase[i - 1] + 180) / 360) - 180;
        if (!out.gain && falls(open.phase, opposite)) {
            const double f = crossing(open.frequency[i - 1], open.phase[i - 1], open.frequency[i], open.phase[i], opposite);
            out.gain = Margin{-open.level_at(f, i), f};
        }
    }
    const auto closed = curve_of(points, &FrequencyPoint::closed, &FrequencyPoint::usable);
    std::size_t top = 0;
    for (std::size_t i = 1; i < closed.frequency.size(); ++i) {
        if (closed.level[i] > closed.level[top]) top = i;
        if (!out.bandwidth && closed.level[i - 1] > -3 && closed.level[i] <= -3) {
            const double f = crossing(closed.frequency[i - 1], closed.level[i - 1], closed.frequency[i], closed.level[i], -3);
            out.bandwidth = Margin{f, f};
        }
        if (!out.phase_bandwidth && closed.phase[i - 1] > -90 && closed.phase[i] <= -90) {
            const double f = crossing(closed.frequency[i - 1], closed.phase[i - 1], closed.frequency[i], closed.phase[i], -90);
            out.phase_bandwidth = Margin{f, f};
        }
    }
    out.notch = notch_of(closed);
    const bool inside = top > 0 && top + 1 < closed.frequency.size();
    if (inside && closed.level[top] > 1) {
        // The top of the parabola through three points, over the logarithm of the frequency.
        const double a = std::log(closed.frequency[top - 1]), b = std::log(closed.frequency[top]), c = std::log(closed.frequency[top + 1]);
        const double ya = closed.level[top - 1], yb = closed.level[top], yc = closed.level[top + 1];
        const double left = (yb - ya) / (b - a), right = (yc - yb) / (c - b), bend = (right - left) / (c - a);
        const double at = bend < 0 ? (a + b) / 2 - left / (2 * bend) : b;
        out.resonance = Margin{ya + left * (at - a) + bend * (at - a) * (at - b), std::exp(at)};
    }
    return out;
}

FrequencyResponse frequency_response(const AlignedRun& run, const ExcitationPlan& plan) {
    FrequencyResponse out;
    const double resolution = resolution_of(run);
    for (std::size_t leg = 0; leg < plan.legs(); ++leg) {
        const auto range = range_of(run, leg);
        const bool whole = range.end > range.begin && (leg + 1 == plan.legs() || range.end < run.size());
        if (!whole) break;
        const auto tone = plan.tone(leg);
        auto point = look_at(run, range, run.leg_begin[leg], tone, resolution);
        point.limited = tone.amplitude < plan.order().distance * (1 - 1e-9);
        out.points.push_back(point);
    }
    out.margins = margins_of(out.points);
    if (out.points.empty()) out.doubt = Doubt::no_samples;
    else if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    else if (std::ranges::none_of(out.points, [](const auto& p) { return p.usable; })) out.doubt = Doubt::nothing_to_see;
    else if (out.points.size() < plan.legs()) out.doubt = Doubt::ended_early;
    return out;
}

}  // namespace taktwerk::axes::measuring

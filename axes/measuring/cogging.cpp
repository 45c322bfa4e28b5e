#include "axes/measuring/cogging.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

namespace taktwerk::axes::measuring {

namespace {

constexpr int most_harmonics = 100;
constexpr std::size_t curve_points = 256;
constexpr double settles = 0.1;  // s at constant velocity before the torque counts

struct Part {
    std::size_t begin = 0, end = 0;
    std::size_t periods = 0;
};

/// Whole periods at constant velocity.
Part whole_periods(const AlignedRun& run, LegRange range, double velocity, double period) {
    std::optional<std::size_t> begin;
    std::size_t end = range.begin;
    for (std::size_t i = range.begin; i < range.end; ++i) {
        if (run.acceleration[i] != 0 || std::abs(run.velocity[i]) < velocity * (1 - 1e-6)) continue;
        if (!begin) begin = i;
        end = i + 1;
    }
    if (!begin) return {};
    const auto way = [&](std::size_t from) { return std::abs(run.actual[end - 1] - run.actual[from]); };
    // What its beginning has stirred up is left out where the way is long enough.
    const auto later = *begin + static_cast<std::size_t>(settles / run.cycle);
    if (later < end && std::floor(way(later) / period) >= std::max(1.0, std::floor(way(*begin) / period))) begin = later;
    const double whole = std::floor(way(*begin) / period * (1 + 1e-6));
    if (!(whole >= 1) || whole > static_cast<double>(end - *begin)) return {};  // none, or more than there are looks at them
    const auto periods = static_cast<std::size_t>(whole);
    while (end > *begin + 2 && std::abs(run.actual[end - 2] - run.actual[*begin]) >= static_cast<double>(periods) * period) --end;
    return {*begin, end, periods};
}

/// What is drawn over the position of one part, gathered at places of the period: the same for every wave, however long the part.
class Gathered {
public:
    Gathered(const AlignedRun& run, const Part& part, double period, const auto& value) : sums_(places) {
        double mean = 0;
        for (std::size_t i = part.begin; i + 1 < part.end; ++i) {
            const double step = run.actual[i + 1] - run.actual[i];
            mean += (value(i) + value(i + 1)) / 2 * step, length_ += step;
        }
        if (length_ == 0) return;
        mean /= length_;
        for (std::size_t i = part.begin; i + 1 < part.end; ++i) {
            // Shared between the two places that it lies between: a place alone would be a step, with waves of its own.
            const double turn = (run.actual[i + 1] + run.actual[i]) / 2 / period;
            const double at = (turn - std::floor(turn)) * places, before = std::floor(at);
            const double share = ((value(i) + value(i + 1)) / 2 - mean) * (run.actual[i + 1] - run.actual[i]);
            const auto place = static_cast<std::size_t>(before) % places;
            sums_[place] += share * (1 - (at - before));
            sums_[(place + 1) % places] += share * (at - before);
        }
    }
    /// Amplitude and phase of the wave `order`.
    [[nodiscard]] std::complex<double> wave(std::size_t order) const {
        static const auto turns = [] {
            std::vector<std::complex<double>> out;
            for (std::size_t i = 0; i < places; ++i)
                out.push_back(std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i) / places));
            return out;
        }();
        if (length_ == 0) return 0;
        std::complex<double> sum = 0;
        for (std::size_t i = 0; i < places; ++i) sum += sums_[i] * turns[order * i % places];
        return 2.0 * sum / length_;
    }

private:
    static constexpr std::size_t places = 4096;  // 40 in a wave of the highest order: a thousandth of its amplitude
    std::vector<double> sums_;
    double length_ = 0;
};

}  // namespace

CoggingResult cogging(const AlignedRun& run, const ExcitationPlan& plan) {
    CoggingResult out;
    out.period = plan.order().period;
    out.velocity = plan.order().velocity;
    if (!(out.period > 0)) {
        out.doubt = Doubt::too_little_motion;
        return out;
    }
    std::vector<Part> parts;
    for (std::size_t leg = 0; leg < plan.legs(); ++leg)
        if (const auto part = whole_periods(run, range_of(run, leg), out.velocity, out.period); part.periods > 0) parts.push_back(part);
    if (parts.empty()) {
        out.doubt = run.size() == 0 ? Doubt::no_samples : Doubt::ended_early;
        return out;
    }
    const double way = out.velocity * run.cycle;  // between two samples
    const int highest = static_cast<int>(std::clamp(out.period / way / 4, 1.0, static_cast<double>(most_harmonics)));
    const auto count = static_cast<double>(parts.size());
    std::vector<Gathered> torques, errors;
    for (const auto& part : parts) {
        torques.emplace_back(run, part, out.period, [&](std::size_t i) { return run.torque[i]; });
        errors.emplace_back(run, part, out.period, [&](std::size_t i) { return run.reference[i] - run.actual[i]; });
    }
    double scatter = 0;
    for (int order = 1; order <= highest; ++order) {
        std::complex<double> torque = 0, error = 0;
        double power = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto one = torques[i].wave(static_cast<std::size_t>(order));
            torque += one / count;
            power += std::norm(one) / count;
            error += errors[i].wave(static_cast<std::size_t>(order)) / count;
        }
        scatter += std::max(0.0, power - std::norm(torque));
        const double omega = 2 * std::numbers::pi * order * out.velocity / out.period;
        out.harmonics.push_back({order, std::abs(torque), std::abs(error), std::abs(error) * omega});
    }
    out.noise = 2 * std::sqrt(scatter / highest / count);
    std::vector<double> sums(curve_points), hits(curve_points);
    for (const auto& part : parts) {
        out.periods += part.periods;
        double mean = 0;
        for (std::size_t i = part.begin; i < part.end; ++i) mean += run.torque[i] / static_cast<double>(part.end - part.begin);
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const double turn = run.actual[i] / out.period;
            const auto bin = std::min(curve_points - 1, static_cast<std::size_t>((turn - std::floor(turn)) * curve_points));
            sums[bin] += run.torque[i] - mean;
            hits[bin] += 1;
        }
    }
    for (std::size_t bin = 0; bin < curve_points; ++bin) {
        if (hits[bin] == 0) continue;
        out.position.push_back((static_cast<double>(bin) + 0.5) / curve_points * out.period);
        out.torque.push_back(sums[bin] / hits[bin]);
    }
    const auto [low, high] = std::ranges::minmax_element(out.torque);
    out.peak_to_peak = *high - *low;
    const bool flat = std::ranges::none_of(out.harmonics, [&](const Harmonic& h) { return h.torque > out.noise && h.torque > 1e-4; });
    if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    else if (flat) out.doubt = Doubt::nothing_to_see;
    return out;
}

}  // namespace taktwerk::axes::measuring

#include "axes/measuring/aligned_run.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::measuring {

namespace {

constexpr double longest_dead_time = 40;  // cycles
constexpr std::size_t least_samples = 10;

/// The first of the samples that is later than `at` cycles behind the first.
std::span<const MeasureSample>::iterator later_than(std::span<const MeasureSample> samples, double at) {
    const auto first = samples.front().cycle;
    const auto is_later = [&](const MeasureSample& s) { return static_cast<double>(s.cycle - first) > at; };
    if (at < 0) return samples.begin();
    // Where none is missing its place is known; where some are, it stands before that.
    const auto guess = std::min(samples.size(), static_cast<std::size_t>(at) + 1);
    const auto place = samples.begin() + static_cast<std::ptrdiff_t>(guess);
    if (!is_later(*(place - 1))) return place;
    return std::partition_point(samples.begin(), place, [&](const MeasureSample& s) { return !is_later(s); });
}

/// `value` of the samples at `at` cycles behind the first, linearly between them.
double between(std::span<const MeasureSample> samples, double MeasureSample::*value, double at) {
    const double first = static_cast<double>(samples.front().cycle);
    const auto later = later_than(samples, at);
    if (later == samples.begin()) return samples.front().*value;
    if (later == samples.end()) return samples.back().*value;
    const auto& before = *(later - 1);
    const double part = (at - (static_cast<double>(before.cycle) - first)) / static_cast<double>(later->cycle - before.cycle);
    return before.*value + part * ((*later).*value - before.*value);
}

/// How badly a dead time of `delay` cycles explains the following error.
double misfit(std::span<const MeasureSample> samples, double delay, std::size_t stride) {
    const double first = static_cast<double>(samples.front().cycle);
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); i += stride) {
        const double at = static_cast<double>(samples[i].cycle) - first - delay;
        if (at < 0 || !samples[i].fresh) continue;
        const double in_effect = samples[i].actual_position + samples[i].following_error;
        const double off = in_effect - between(samples, &MeasureSample::set_position, at);
        sum += off * off;
    }
    return sum;
}

/// cycles
double find_dead_time(std::span<const MeasureSample> samples) {
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 4000);
    double best = 0, least = misfit(samples, 0, stride);
    for (double delay = 0.5; delay <= longest_dead_time; delay += 0.5) {
        const double off = misfit(samples, delay, stride);
        if (off < least) least = off, best = delay;
    }
    double low = std::max(0.0, best - 0.5), high = best + 0.5;
    constexpr double golden = 0.6180339887498949;
    for (int i = 0; i < 25; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (misfit(samples, a, stride) < misfit(samples, b, stride)) high = b;
        else low = a;
    }
    return (low + high) / 2;
}

}  // namespace

void unwrap(std::vector<MeasureSample>& samples, double modulo) {
    if (!(modulo > 0) || samples.empty()) return;
    double set = samples.front().set_position, actual = samples.front().actual_position;
    const auto nearest = [&](double value, double to) { return value + std::round((to - value) / modulo) * modulo; };
    actual = nearest(actual, set);
    for (auto& sample : samples) {
        set = sample.set_position = nearest(sample.set_position, set);
        actual = sample.actual_position = nearest(sample.actual_position, actual);
    }
}

AlignedRun align(const SampleRun& run) {
    AlignedRun out;
    out.cycle = run.plan.bounds().cycle;
    const std::span<const MeasureSample> samples = run.samples;
    if (samples.size() < least_samples) return out;
    const double delay = find_dead_time(samples);
    out.dead_time = delay * out.cycle;
    const auto first = samples.front().cycle;
    out.lost = samples.back().cycle - first + 1 - samples.size();
    for (const auto& sample : samples)
        while (out.leg_begin.size() <= sample.leg) out.leg_begin.push_back((static_cast<double>(sample.cycle - first) - 1) * out.cycle);
    std::size_t labelled = 0;
    for (const auto& sample : samples) {
        const double at = static_cast<double>(sample.cycle - first) - delay;
        if (!sample.fresh) ++out.stale;
        if (at < 0 || !sample.fresh) continue;
        while (labelled + 1 < samples.size() && static_cast<double>(samples[labelled + 1].cycle - first) <= at) ++labelled;
        out.time.push_back(at * out.cycle);
        out.reference.push_back(between(samples, &MeasureSample::set_position, at));
        out.velocity.push_back(between(samples, &MeasureSample::set_velocity, at));
        out.acceleration.push_back(between(samples, &MeasureSample::set_acceleration, at));
        out.actual.push_back(sample.actual_position);
        out.actual_velocity.push_back(sample.actual_velocity);
        out.torque.push_back(sample.torque);
        out.leg.push_back(samples[labelled].leg);
        out.holds.push_back(samples[labelled].holds);
    }
    return out;
}

LegRange range_of(const AlignedRun& run, std::size_t leg) {
    const auto begin = std::lower_bound(run.leg.begin(), run.leg.end(), leg);
    const auto end = std::upper_bound(begin, run.leg.end(), leg);
    return {static_cast<std::size_t>(begin - run.leg.begin()), static_cast<std::size_t>(end - run.leg.begin())};
}

LegRange steady_part(const AlignedRun& run, LegRange leg) {
    LegRange out{leg.end, leg.end};
    for (std::size_t i = leg.begin; i < leg.end; ++i) {
        if (run.acceleration[i] != 0 || run.velocity[i] == 0) continue;
        if (out.begin == leg.end) out.begin = i;
        out.end = i + 1;
    }
    if (out.begin == leg.end) return {leg.begin, leg.begin};
    out.begin += (out.end - out.begin) / 2;
    return out;
}

}  // namespace taktwerk::axes::measuring

#include "axes/measuring/step_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taktwerk::axes::measuring {

namespace {

/// When `values` passes `level` in the sense of `way`, interpolated; nothing: never.
double passes(const AlignedRun& run, LegRange range, double level, double way) {
    for (std::size_t i = range.begin + 1; i < range.end; ++i) {
        const double before = way * (run.actual[i - 1] - level), now = way * (run.actual[i] - level);
        if (before < 0 && now >= 0) return run.time[i - 1] + (run.time[i] - run.time[i - 1]) * before / (before - now);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

MoveResponse look_at(const AlignedRun& run, LegRange range, std::size_t leg, double from, const ExcitationLeg& planned, double window) {
    MoveResponse move;
    move.leg = leg;
    move.distance = planned.target - from;
    const double way = move.distance < 0 ? -1 : 1;
    // The set-point arrives where it begins to rest.
    std::size_t arrived = range.begin;
    while (arrived < range.end && !run.holds[arrived]) ++arrived;
    double squares = 0, sum = 0, velocity = 0, velocity_squares = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
        const double error = run.reference[i] - run.actual[i];
        move.largest_error = std::max(move.largest_error, std::abs(error));
        if (i < arrived) squares += error * error;
        if (i >= arrived) move.overshoot = std::max(move.overshoot, way * (run.actual[i] - planned.target));
    }
    const auto steady = steady_part(run, range);
    for (std::size_t i = steady.begin; i < steady.end; ++i) {
        ++move.cruised;
        sum += way * (run.reference[i] - run.actual[i]);
        velocity += run.actual_velocity[i];
        velocity_squares += run.actual_velocity[i] * run.actual_velocity[i];
    }
    if (arrived > range.begin) move.rms_error = std::sqrt(squares / static_cast<double>(arrived - range.begin));
    if (move.cruised > 0) {
        const auto n = static_cast<double>(move.cruised);
        move.at_velocity = sum / n;
        move.ripple = std::sqrt(std::max(0.0, velocity_squares / n - velocity / n * (velocity / n)));
    }
    move.rise_time = passes(run, range, from + 0.9 * move.distance, way) - passes(run, range, from + 0.1 * move.distance, way);
    if (arrived == range.end) return move;
    // The last sample outside decides; the watch must go on for a while after it.
    std::size_t inside = range.end;
    while (inside > arrived && std::abs(run.actual[inside - 1] - planned.target) <= window) --inside;
    const double watched = static_cast<double>(range.end - inside) * run.cycle;
    move.settled = inside != range.end && watched > planned.rest / 10;
    move.settling_time = move.settled ? run.time[inside] - run.time[arrived] : run.time[range.end - 1] - run.time[arrived];
    return move;
}

Estimate mean(const std::vector<MoveResponse>& moves, double MoveResponse::*value) {
    Estimate out;
    double squares = 0, n = 0;
    for (const auto& move : moves) {
        if (!std::isfinite(move.*value)) continue;
        ++n;
        out.value += move.*value;
        squares += move.*value * (move.*value);
    }
    if (n == 0) return out;
    out.known = true;
    out.value /= n;
    out.deviation = n > 1 ? std::sqrt(std::max(0.0, (squares - n * out.value * out.value) / (n - 1))) : 0;
    return out;
}

}  // namespace

double resolution_of(const AlignedRun& run) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < run.size(); ++i)
        if (const double step = std::abs(run.actual[i] - run.actual[i - 1]); step > 1e-12 * std::abs(run.actual[i]))
            least = std::min(least, step);
    return std::isfinite(least) ? least : 0;
}

StepResponse step_response(const AlignedRun& run, const ExcitationPlan& plan, double window) {
    StepResponse out;
    out.window = window;
    if (run.size() == 0) {
        out.doubt = Doubt::no_samples;
        return out;
    }
    out.resolution = resolution_of(run);
    double from = plan.bounds().start;
    for (std::size_t leg = 0; leg < plan.legs(); ++leg) {
        const auto planned = plan.leg(leg);
        const auto range = range_of(run, leg);
        const bool whole = range.end > range.begin && range.end < run.size() + (leg + 1 == plan.legs() ? 1 : 0);
        if (!whole) break;
        out.moves.push_back(look_at(run, range, leg, from, planned, window));
        from = planned.target;
    }
    if (out.moves.size() < plan.legs()) out.doubt = out.moves.empty() ? Doubt::no_samples : Doubt::ended_early;
    if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    out.overshoot = mean(out.moves, &MoveResponse::overshoot);
    out.settling_time = mean(out.moves, &MoveResponse::settling_time);
    out.rise_time = mean(out.moves, &MoveResponse::rise_time);
    out.largest_error = mean(out.moves, &MoveResponse::largest_error);
    const bool cruised = !out.moves.empty() && std::ranges::all_of(out.moves, [](const auto& m) { return m.cruised >= 5; });
    if (cruised) {
        out.at_velocity = mean(out.moves, &MoveResponse::at_velocity);
        out.ripple = mean(out.moves, &MoveResponse::ripple);
        out.lag = out.at_velocity.value / plan.order().velocity;
    }
    out.all_settled = !out.moves.empty() && std::ranges::all_of(out.moves, [](const auto& m) { return m.settled; });
    // What is a millionth of the way is no answer of a drive, but none at all.
    const double nothing = std::max(1e-6 * std::abs(plan.order().distance), out.resolution);
    if (out.largest_error.value <= nothing && out.doubt == Doubt::none) out.doubt = Doubt::nothing_to_see;
    return out;
}

}  // namespace taktwerk::axes::measuring

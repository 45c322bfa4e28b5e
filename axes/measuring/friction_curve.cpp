#include "axes/measuring/friction_curve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "axes/measuring/least_squares.hpp"
#include "axes/measuring/step_response.hpp"

namespace taktwerk::axes::measuring {

namespace {

constexpr double stirred = 0.1;  // s at constant velocity before the torque counts, or half of the time there
constexpr std::size_t least_steady = 10;
constexpr double leaping = 4e-3;  // s

struct Steady {
    std::size_t begin = 0, end = 0;
};

/// Constant velocity, after what its beginning has stirred up; whole periods of the cogging where there are some.
Steady steady(const AlignedRun& run, LegRange range, double velocity, double period) {
    Steady out{range.end, range.end};
    for (std::size_t i = range.begin; i < range.end; ++i) {
        const bool cruises = run.acceleration[i] == 0 && std::abs(run.velocity[i]) > velocity * (1 - 1e-6);
        if (cruises && out.begin == range.end) out.begin = i;
        if (cruises) out.end = i + 1;
    }
    if (out.begin == range.end) return {};
    const auto there = out.end - out.begin;
    out.begin += std::min(there / 2, static_cast<std::size_t>(stirred / run.cycle));
    const double way = std::abs(run.actual[out.end - 1] - run.actual[out.begin]);
    if (period > 0 && way >= period) {
        const double whole = std::floor(way / period) * period;
        while (out.end > out.begin && std::abs(run.actual[out.end - 1] - run.actual[out.begin]) > whole) --out.end;
    }
    return out;
}

/// The torque in the sense of the motion at which the motor begins to move: the most of the last look at which it had not moved by a count, and the
/// next, in which it may have broken away and the torque fallen. That it moved at all is known only `little` later. Nothing: it never did.
std::optional<double> torque_at_start(const AlignedRun& run, LegRange range, double way, double count, double little) {
    std::size_t moved = range.begin;
    const auto gone = [&](std::size_t i) { return way * (run.actual[i] - run.actual[range.begin]); };
    while (moved < range.end && !run.holds[moved] && gone(moved) <= little) ++moved;
    if (moved == range.end || run.holds[moved]) return std::nullopt;
    std::size_t still = moved;
    while (still > range.begin && gone(still) > 0.5 * count) --still;
    // Set-points of whole counts make the torque of a feed-forward leap from cycle to cycle, above all of short ones.
    const auto looks = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(leaping / run.cycle)));
    const auto mean_until = [&](std::size_t last) {
        const auto first = last - std::min(looks - 1, last - range.begin);
        double sum = 0;
        for (std::size_t i = first; i <= last; ++i) sum += way * run.torque[i];
        return sum / static_cast<double>(last - first + 1);
    };
    return std::max(mean_until(still), mean_until(still + 1));
}

}  // namespace

FrictionCurve friction_curve(const AlignedRun& run, const ExcitationPlan& plan, double limit) {
    FrictionCurve out;
    const double resolution = resolution_of(run);
    double highest = 0, start_up[2] = {0, 0}, start_down[2] = {0, 0};
    for (std::size_t leg = 0; leg < plan.legs(); ++leg) {
        const auto range = range_of(run, leg);
        if (range.end <= range.begin) break;
        const auto planned = plan.leg(leg);
        const double way = planned.target > (leg == 0 ? plan.bounds().start : plan.leg(leg - 1).target) ? 1 : -1;
        const auto part = steady(run, range, planned.velocity, plan.order().period);
        // From rest, slowly: the slowest pairs.
        if (leg < (plan.order().count < 4 ? 2 : 4)) {
            auto& of = way > 0 ? start_up : start_down;
            if (const auto torque = torque_at_start(run, range, way, resolution, 4 * resolution)) of[0] += *torque, of[1] += 1;
        }
        if (part.end - part.begin < least_steady) continue;
        FrictionPoint point{way * planned.velocity, 0, 0, 0};
        const auto n = static_cast<double>(part.end - part.begin);
        for (std::size_t i = part.begin; i < part.end; ++i)
            point.torque += run.torque[i] / n, highest = std::max(highest, std::abs(run.torque[i]));
        for (std::size_t i = part.begin; i < part.end; ++i)
            point.ripple += (run.torque[i] - point.torque) * (run.torque[i] - point.torque) / n;
        point.ripple = std::sqrt(point.ripple);
        point.deviation = point.ripple / std::sqrt(n / 10);  // samples next to each other are not independent
        out.points.push_back(point);
    }
    std::ranges::sort(out.points, {}, &FrictionPoint::velocity);
    LeastSquares<3> both;
    for (const auto& p : out.points) both.add({1, p.velocity > 0 ? 1.0 : -1.0, p.velocity}, p.torque);
    const auto fit = both.solve();
    if (!fit.solved) {
        const auto driven = out.points.size() < plan.legs() ? Doubt::ended_early : Doubt::too_little_motion;
        out.doubt = out.points.empty() ? Doubt::no_samples : driven;
        return out;
    }
    out.gravity = fit.c[0], out.coulomb = fit.c[1], out.viscous = fit.c[2];
    // One direction alone cannot tell gravity from friction: what is the same in both is called gravity.
    const auto of_direction = [&](double way, Estimate& coulomb, Estimate& viscous) {
        LeastSquares<2> line;
        for (const auto& p : out.points)
            if (p.velocity * way > 0) line.add({1, std::abs(p.velocity)}, way * (p.torque - out.gravity.value));
        const auto solved = line.solve();
        if (!solved.solved) return;
        coulomb = solved.c[0], viscous = solved.c[1];
    };
    of_direction(1, out.coulomb_positive, out.viscous_positive);
    of_direction(-1, out.coulomb_negative, out.viscous_negative);
    if (start_up[1] > 0 && start_down[1] > 0) {
        out.breakaway_positive = {start_up[0] / start_up[1] - out.gravity.value, fit.residual, true};
        out.breakaway_negative = {start_down[0] / start_down[1] + out.gravity.value, fit.residual, true};
    }
    if (highest == 0) out.doubt = Doubt::nothing_to_see;
    else if (highest >= 0.98 * limit) out.doubt = Doubt::saturated;
    else if (out.points.size() < plan.legs()) out.doubt = Doubt::ended_early;
    else if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    return out;
}

}  // namespace taktwerk::axes::measuring

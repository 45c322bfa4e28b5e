#include "axes/group/run_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taktwerk::axes {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Set-points may use so much of a jerk limit: a plan holds jerk to 2e-4, and an axis takes no more than its limit.
constexpr double jerk_share = 1 - 5e-4;

// The tool's point in set-up mode. Through the arm its rate is that of the path itself, in closed form. On a line of the axes it is |J(q) q'|, which is
// looked at where time is planned: in twelfths of a cell, with the peak of a parabola through each three of them (cell_check.cpp). What it may be
// between: with w = the sum of the joints' turns per length, each component of J q' is a sum of sines of the joints' angles, so that its second
// derivative by s is at most w^2 times R = sum of lever x rate, its third w^3 R. A cell of an own line is no longer than `most_cell_turn` / w (`feature`),
// at most 2.7 times that in a run of many spans: samples are 0.2 x 2.7 / 12 = 0.045 rad apart, and a parabola misses (0.045)^3 / 15.6 = 6e-6 of R.
// The reserve is 1e-3 of the limit: enough as long as R is no more than 160 times the rate itself, and where it is more (joints that turn against each
// other until the point nearly stands) the rate is so small that other limits hold.
constexpr double tool_share = 1 - 1e-3;
constexpr double most_cell_turn = 0.2;  // rad

double said(double value) noexcept { return value > 0 ? value : infinite; }

}  // namespace

RunCurve::RunCurve(const Kinematics* arm, std::size_t members, std::span<const MemberLimits> limits, double tool_velocity)
    : arm_(arm), tool_velocity_(arm != nullptr && members >= arm->joint_count() ? tool_share * tool_velocity : unlimited) {
    for (std::size_t i = 0; i < members; ++i) limits_.push_back({limits[i].velocity, limits[i].acceleration, jerk_share * limits[i].jerk});
}

void RunCurve::forget_before(std::uint32_t part) {
    const std::size_t count = std::min<std::size_t>(part > forgotten ? part - forgotten : 0, seen.empty() ? 0 : seen.size() - 1);
    if (count < std::max(RunTrack::usual_sections, seen.size() / 2)) return;  // now and then
    path.forget(count);
    seen.erase(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count));
    forgotten += static_cast<std::uint32_t>(count);
}

void RunCurve::wish(bool stands, bool own_ramp, const Override& factors, const PathDynamics& ramp) noexcept {
    manner_ = {stands && !own_ramp, factors, ramp};
}

std::size_t RunCurve::index(double s, CurveSide side) const noexcept {
    std::size_t i = path.index_at(s);
    if (side == CurveSide::before && i > 0 && path.sections()[i].begin >= s) --i;
    return i;
}

const MemberVector& RunCurve::near(std::size_t i, double s) const noexcept {
    const auto& known = seen[i].members;
    const auto& section = path.sections()[i];
    if (known.size() < 2) return known.front();
    const double share = (section.from + s - section.begin) / section.element.length();
    const auto last = static_cast<double>(known.size() - 1);
    return known[static_cast<std::size_t>(std::clamp(share * last + 0.5, 0.0, last))];
}

WayPoint RunCurve::place(std::size_t i, double s) const noexcept {
    const RunSection& run = seen[i].run;
    return way_point(path.sections()[i], run, s, arm_, limits_.size(), run.through_arm ? near(i, s) : MemberVector{});
}

double RunCurve::tool_rate(std::size_t i, double s, const WayPoint& at) const noexcept {
    if (seen[i].run.through_arm) return path.sections()[i].at(s).first.head<3>().norm();
    const auto moving = arm_->moving(joints_of(at.q), joints_of(at.first), seen[i].run.carried.tool);
    return std::hypot(moving.velocity[0], moving.velocity[1], moving.velocity[2]);
}

TimedCurvePoint RunCurve::on(std::size_t i, double s, const Manner& manner) const noexcept {
    const PathSection& section = path.sections()[i];
    const WayPoint w = place(i, s);
    TimedCurvePoint p;
    p.first = w.first;
    p.second = w.second;
    p.third = w.third;
    p.path = {infinite, infinite, infinite, infinite};
    const AlongLimits axes = along_limits(p, limits_, 1);
    // What a command says is of the tool's point, and where only its orientation moves of that, rad.
    double share = 1;
    if (seen[i].run.through_arm) {
        const double linear = section.at(s).first.head<3>().norm();
        share = linear > 1e-9 ? 1 / linear : std::max(section.chart.lever, 1e-9);
    }
    const double velocity = seen[i].velocity > 0 ? seen[i].velocity : section.feed.velocity;
    const double least = std::min(axes.acceleration, axes.deceleration);
    PathLimits& path_limits = p.path;
    path_limits.velocity = std::min(said(velocity) * share, axes.velocity);
    if (tool_limited()) {
        const double rate = tool_rate(i, s, w);
        if (rate * path_limits.velocity > tool_velocity_) path_limits.velocity = tool_velocity_ / rate;
    }
    const double faster = std::min(said(section.feed.acceleration) * share, least);
    path_limits.acceleration = faster * manner.factors.acceleration;
    path_limits.deceleration =
        std::min(said(manner.ramps ? manner.ramp.deceleration : section.feed.deceleration) * share, least) * manner.factors.acceleration;
    path_limits.jerk = std::min(said(manner.ramps ? manner.ramp.jerk : section.feed.jerk) * share, axes.jerk) * manner.factors.jerk;
    return p;
}

TimedCurvePoint RunCurve::at(double s, CurveSide side) const noexcept { return on(index(s, side), s, manner_); }

AlongLimits RunCurve::along(double s) const noexcept { return along_limits(at(s, CurveSide::before), limits_, 1); }

PathFeed RunCurve::feed_at(double s) const noexcept {
    const AlongLimits l = along_limits(on(index(s, CurveSide::before), s, Manner{}), limits_, 1);
    return {l.velocity, l.acceleration, l.deceleration, l.jerk};
}

double RunCurve::next_break(double s) const noexcept {
    const double behind = path.sections()[path.index_at(s)].end();
    return behind > s ? behind : end();
}

double RunCurve::next_stop(double s) const noexcept {
    for (std::size_t i = path.index_at(s) + 1; i < path.sections().size(); ++i)
        if (path.sections()[i].stop_before && path.sections()[i].begin > s) return path.sections()[i].begin;
    return end();
}

double RunCurve::feature(double s, CurveSide side) const noexcept {
    const std::size_t i = index(s, side);
    const PathSection& section = path.sections()[i];
    const double own = section.element.feature(section.from + s - section.begin);
    if (!seen[i].run.through_arm) {
        if (!tool_limited()) return own;
        const WayPoint w = place(i, s);
        double turns = 0;
        for (std::size_t k = 0; k < arm_->joint_count(); ++k)
            if (arm_->rotary()[k]) turns += std::abs(w.first[k] * arm_->map().settings(k).unit);
        return turns > 0 ? std::min(own, most_cell_turn / turns) : own;
    }
    // By how much q' changes, weighed by what each member can do.
    const WayPoint w = place(i, s);
    double first = 0, second = 0, third = 0;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
        const double weight = 1 / limits_[k].velocity;
        first += std::pow(w.first[k] * weight, 2);
        second += std::pow(w.second[k] * weight, 2);
        third += std::pow(w.third[k] * weight, 2);
    }
    const double bent = second > 0 ? std::sqrt(first / second) / 4 : infinite;
    const double bends = third > 0 ? std::sqrt(std::sqrt(first / third)) / 2 : infinite;
    return std::max(std::min({own, bent, bends}), section.length / 500);
}

}  // namespace taktwerk::axes

// Where a plan begins to search, and the ways down that it keeps to: to rest, and to a lowered velocity.

#include <algorithm>
#include <cmath>

#include "axes/path_time/along_limits.hpp"
#include "axes/path_time/braking.hpp"
#include "axes/path_time/run_plan.hpp"

namespace taktwerk::axes {
namespace {

constexpr double slow_share = 0.02;      // of v2: what goes on where a former plan stopped
constexpr double brisk_share = 0.5;      // likewise, where that one finds no way
constexpr double braking_share = 0.7;    // of the deceleration and the jerk, to a lowered velocity
constexpr double guessed_share = 0.75;   // the same where the search begins: a little below
constexpr double rise_share = 0.8;       // of what those leave of the jerk, that is left where an acceleration has to go first
constexpr double below_for_sure = 0.99;  // of that velocity, that an acceleration is gone at with all of the jerk: then it stays below
constexpr double guessed_below = 0.97;   // of that velocity
constexpr double over_ramp = 1.0005;     // of v2 on that braking: what cells cannot follow
constexpr std::size_t most_taken_over = 3000;  // cells of a former plan, which was cut into pieces

}  // namespace

/// How far a halt, or the way to a lowered velocity, reaches: the cells are small there.
void RunPlanner::measure_braking() {
    if (task_.velocity <= 0) return;
    if (task_.halt_share > 0) {
        const Braking braking = halt_braking();
        task_.halt_ramp = braking.ramp_way();
        task_.halt_last = braking.last_way();
    } else if (slower_) {
        const Braking braking = braking_to_factor(guessed_below, braking_share);
        if (braking.top() <= guessed_below * wanted_first()) return;  // it only has to stop speeding up
        const double way = braking.way();
        if (!(way > 0 && way < 0.9 * (task_.to - task_.from))) return;
        task_.brake_way = way;
        task_.halt_ramp = braking.ramp_way();
        task_.halt_last = braking.last_way();
    }
}

/// Velocities without jerk, from both ends, lowered: a beginning from which the limits can be left alone.
void RunPlanner::first_guess(double square) {
    const auto& nodes = grid_.nodes;
    const std::size_t n = nodes.size() - 1;
    const double start_rest = grid_.start.rest_length, end_rest = grid_.end.rest_length;
    middles_.assign(n, 0);
    reach_.resize(n);
    std::vector<double> deceleration(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double s = (nodes[i] + nodes[i + 1]) / 2;
        const TimedCurvePoint& p = check_.middle(i);
        const AlongLimits l = along_limits(p, limits_, task_.velocity_factor);
        deceleration[i] = l.deceleration;
        reach_[i] = l.deceleration / (2 * l.jerk);
        double cap = l.velocity * l.velocity;
        for (const TimedCurvePoint* at : {&check_.begin(i), &p, &check_.end(i)})
            for (std::size_t k = 0; k < limits_.size(); ++k) {
                const double second = std::fabs(at->second[k]), third = std::fabs(at->third[k]);
                if (second * cap > limits_[k].acceleration) cap = limits_[k].acceleration / second;
                if (third * third * cap * cap * cap > limits_[k].jerk * limits_[k].jerk) cap = two_thirds(limits_[k].jerk / third);
            }
        // at constant jerk from rest: v^3 = 4.5 j s^2
        const auto from_rest = [&](double way) {
            const double cube = 4.5 * l.jerk * way * way;
            if (cube * cube < cap * cap * cap) cap = two_thirds(cube);
        };
        if (start_rest > 0) from_rest(s - task_.from);
        from_rest(task_.to - s);
        const double before = i > 0 ? middles_[i - 1] : square;
        const double way = i > 0 ? (nodes[i + 1] - nodes[i - 1]) / 2 : (nodes[1] - nodes[0]) / 2 + start_rest;
        middles_[i] = std::min(cap, before + 1.6 * l.acceleration * way);
    }
    for (std::size_t i = n; i-- > 0;) {
        const double behind = i + 1 < n ? middles_[i + 1] : 0;
        const double way = i + 1 < n ? (nodes[i + 2] - nodes[i]) / 2 : (nodes[n] - nodes[n - 1]) / 2 + end_rest;
        middles_[i] = std::min(middles_[i], behind + 1.6 * deceleration[i] * way);
    }
    for (std::size_t i = 0; i < n; ++i) {
        reach_[i] = middles_[i] / (2 * deceleration[i]) + std::sqrt(middles_[i]) * reach_[i];
        middles_[i] *= 0.5;
    }
}

/// From a moving state: the cells of the former plan as long as it does not brake for its end for good, and its v2 as the first guess. Where
/// that comes near rest but the path goes on, a slow motion that keeps every limit goes on instead.
void RunPlanner::take_over(const RunShape& former) {
    const double whole = task_.to - task_.from, hair = 1e-12 * std::fabs(task_.to);
    const auto begin = std::lower_bound(former.nodes.begin(), former.nodes.end(), task_.from - hair);
    const auto from = static_cast<std::size_t>(begin - former.nodes.begin());
    if (begin == former.nodes.end()) return;
    const bool same_end =
        std::fabs(task_.to - former.end)<1e-9 * whole, own_cells = task_.brake_way> 0 || former.nodes.size() - from > most_taken_over;
    std::size_t kept = former.nodes.size() - 1;
    if (!same_end && !own_cells) {
        while (kept > from && (former.squares[kept] <= former.squares[kept - 1] || former.nodes[kept] > grid_.nodes.back())) --kept;
    } else if (!own_cells) {
        grid_.end.rest_length = task_.to - former.nodes.back();
    }
    std::vector<double> nodes(former.nodes.begin() + static_cast<std::ptrdiff_t>(from),
                              former.nodes.begin() + static_cast<std::ptrdiff_t>(kept) + 1);
    const double brakes_from = former.nodes[kept];
    nodes.front() = task_.from;
    if (!same_end)
        for (const double node : grid_.nodes)
            if (node > nodes.back() + 1e-9 * whole) nodes.push_back(node);
    if (!own_cells) grid_.nodes.swap(nodes);
    if (!own_cells && !same_end) grid_.end.rest_length = task_.to - grid_.nodes.back();  // a last cell of no length was left out
    shares_.assign(grid_.nodes.size() - 1, untouched);
    make_problem();

    // Slow enough for everything, as from rest.
    first_guess(brisk_ ? task_.velocity * task_.velocity : 0);
    std::size_t cell = from;
    const auto former_square = [&](double s) {
        while (cell + 1 < former.middles.size() && former.nodes[cell + 1] < s) ++cell;
        if (s > former.nodes.back() + hair) return 0.0;
        const double x = (s - former.nodes[cell]) / (former.nodes[cell + 1] - former.nodes[cell]), y = 1 - x;
        return y * y * former.squares[cell] + 2 * x * y * former.middles[cell] + x * x * former.squares[cell + 1];
    };
    const double first_wanted = wanted_first();
    const auto wanted_below = [&](std::size_t i) { return check_.middle(i).path.velocity * task_.velocity_factor < 0.9 * first_wanted; };
    // A lowered velocity factor: braking to what is allowed.
    const Braking braking = braking_to_factor(guessed_below, guessed_share);
    BrakingByWay by_way(braking);
    const auto braked_square = [&](double s) { return slower_ ? std::pow(by_way.velocity(s - task_.from), 2) : unlimited; };
    first_window_ = 0;
    double braked_first = braked_square(grid_.nodes.front());
    for (std::size_t i = 0; i + 1 < grid_.nodes.size(); ++i) {
        const double half = (grid_.nodes[i] + grid_.nodes[i + 1]) / 2;
        const double first = former_square(grid_.nodes[i]), middle = former_square(half), last = former_square(grid_.nodes[i + 1]);
        const double braked = braked_square(half), braked_last = braked_square(grid_.nodes[i + 1]);
        double lowered = std::max(slower_ ? 2 * braked - (braked_first + braked_last) / 2 : braked, middles_[i]);
        braked_first = braked_last;
        // Behind that braking as well, where the path itself is slower.
        if (slower_ && half > task_.from + braking.way() && wanted_below(i))
            lowered = std::min(lowered, guessed_below * guessed_below * middles_[i]);
        middles_[i] = std::min(
            std::max(2 * middle - (first + last) / 2, (brisk_ && grid_.nodes[i] >= brakes_from ? brisk_share : slow_share) * middles_[i]),
            lowered);
        if (middle > 0) first_window_ = static_cast<int>(i) + 1;
    }
    if (!slower_) return;
    // Where a faster part of the path joins a slower one, both cells have a part of the node between them.
    for (std::size_t i = 1; i + 1 < grid_.nodes.size(); ++i) {
        if (grid_.nodes[i] <= task_.from + braking.way()) continue;
        const double wanted =
            guessed_below * task_.velocity_factor * std::min(check_.end(i - 1).path.velocity, check_.begin(i).path.velocity);
        if (problem_.node(static_cast<int>(i), middles_) <= wanted * wanted) continue;
        for (double* middle : {&middles_[i - 1], &middles_[i]}) *middle = std::min(*middle, wanted * wanted);
    }
}

/// A halt: the grid is its own, for the former plan's cells are as long as suits who goes on. The first guess is braking in time, along a straight line.
void RunPlanner::brake() {
    first_guess();
    for (std::size_t i = 0; i < middles_.size(); ++i) middles_[i] = std::max(halt_[3 * i + 1], slow_share * middles_[i]);
}

/// v2 of that braking. Nothing is far above it: who only has to be at rest somewhere would go on as it is, and brake harder then.
void RunPlanner::make_halt() {
    halt_.clear();
    if (task_.halt_share <= 0 || from_rest()) return;
    BrakingByWay by_way(halt_braking());
    const auto square = [&](double s) { return std::pow(by_way.velocity(s - task_.from), 2); };
    double first = square(grid_.nodes.front());
    for (std::size_t i = 0; i + 1 < grid_.nodes.size(); ++i) {
        const double middle = square((grid_.nodes[i] + grid_.nodes[i + 1]) / 2), last = square(grid_.nodes[i + 1]);
        halt_.insert(halt_.end(), {first, 2 * middle - (first + last) / 2, last});
        first = last;
    }
}

/// A lowered velocity is come to on a ramp. Without one the search would be below it as soon as can be, with all of the deceleration still on it, and
/// pass far below.
void RunPlanner::make_ramp() {
    ramp_.clear();
    if (task_.velocity <= 0 || task_.velocity_factor >= 1) return;
    const Braking braking = braking_to_factor(1, braking_share);
    // Who is below it, and has been told before, does not come above it.
    const double wanted = wanted_first();
    if (!slower_ && task_.velocity <= wanted) return;
    const double way = braking.way();
    if (!(way > 0) || top_velocity(along_limits(curve_->at(task_.from, CurveSide::after), limits_, 1).jerk) <= below_for_sure * wanted)
        return;
    BrakingByWay by_way(braking);
    // As parts of what is wanted: where the path is slower by itself, so is the ramp. Who was slower than his former factor allows stays so.
    const double former = slower_ ? former_factor_ / task_.velocity_factor : unlimited,
                 most = task_.velocity <= former * wanted ? former * former : unlimited;
    const auto square = [&](double s) {
        return s < task_.from + way ? std::min(most, over_ramp * std::pow(by_way.velocity(s - task_.from) / wanted, 2)) : 0;
    };
    double first = square(grid_.nodes.front());
    for (std::size_t i = 0; i + 1 < grid_.nodes.size() && first > 0; ++i) {
        const double middle = square((grid_.nodes[i] + grid_.nodes[i + 1]) / 2), last = square(grid_.nodes[i + 1]);
        ramp_.insert(ramp_.end(), {first, last > 0 ? std::max(2 * middle - (first + last) / 2, middle) : middle, last});
        first = last;
    }
    ramp_.resize(3 * (grid_.nodes.size() - 1), 0.0);
}

/// As along a straight line, with its share of the limits where it begins.
Braking RunPlanner::halt_braking() const {
    const AlongLimits l = along_limits(curve_->at(task_.from, CurveSide::after), limits_, 1);
    return {task_.velocity, task_.acceleration, task_.halt_share * l.deceleration, task_.halt_share * l.jerk};
}

/// What a lowered velocity factor allows where the task begins.
double RunPlanner::wanted_first() const {
    return along_limits(curve_->at(task_.from, CurveSide::after), limits_, task_.velocity_factor).velocity;
}

/// To which it speeds up while its acceleration goes with this jerk.
double RunPlanner::top_velocity(double jerk) const {
    const double rising = std::max(task_.acceleration, 0.0);
    return task_.velocity + rising * rising / (2 * jerk);
}

/// To this part of it, where the beginning is above it, with this share of the limits.
Braking RunPlanner::braking_to_factor(double part, double share) const {
    const AlongLimits l = along_limits(curve_->at(task_.from, CurveSide::after), limits_, 1);
    const double own = task_.softness * share;
    // An acceleration that is still there goes with nearly all of the jerk, as it would in a plan that stays below: else it would become faster than it ever was to be.
    const double rise_jerk = task_.softness * (1 - rise_share * (1 - share)) * l.jerk;
    const double to = std::min(part * wanted_first(), top_velocity(rise_jerk));
    return {task_.velocity, task_.acceleration, own * l.deceleration, own * l.jerk, to, rise_jerk};
}

/// What a search does not come to is left above a lowered velocity: until when?
void RunPlanner::look_above(RunPlan& out) const {
    constexpr double counts = 1.01 * 1.01;
    out.above_for = out.braking_for = 0;
    if (from_rest() || task_.velocity_factor >= 1 || task_.halt_share > 0) return;
    out.braking_for = braking_to_factor(1, braking_share / task_.softness).duration();
    double time = 0;
    for (int i = 0; i < problem_.cells(); ++i) {
        const auto c = static_cast<std::size_t>(i);
        const double first = problem_.node(i, middles_), last = problem_.node(i + 1, middles_);
        time += TimePiece::moving(grid_.nodes[c], grid_.nodes[c + 1] - grid_.nodes[c], first, middles_[c], last).duration;
        const double wanted = task_.velocity_factor * check_.middle(c).path.velocity;
        if ((first + 2 * middles_[c] + last) / 4 > counts * wanted * wanted) out.above_for = time;
    }
}

}  // namespace taktwerk::axes

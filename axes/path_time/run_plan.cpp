#include "axes/path_time/run_plan.hpp"

#include <algorithm>
#include <cmath>

#include "axes/path_time/along_limits.hpp"
#include "axes/path_time/braking.hpp"
#include "axes/path_time/plan_pieces.hpp"

namespace taktwerk::axes {
namespace {

constexpr int rounds_at_most = 9;
constexpr int slow_downs = 4;
constexpr double least_share = 0.8;  // of a limit, that a cell is lowered to
constexpr int split_rounds = 6, split_rounds_moving = 4;
constexpr double below_factor = 1 - 6e-5;  // of a lowered velocity: what is left of a soft cap is below it
constexpr double over_halt = 0.02;         // of v2 where it begins, that a halt may be above braking as along a line
constexpr int window = 192;                // cells that are solved and stay
constexpr int look_ahead = 48;             // cells behind them that are solved with them, at least: as far as braking would reach
constexpr int beside = 10;                 // cells on both sides that are solved again with one that was beyond a limit

CellShare less(const CellShare& a, const CellShare& b) {
    return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration), std::min(a.jerk, b.jerk)};
}

}  // namespace

void RunPlanner::add_cell(int cell) {
    const auto c = static_cast<std::size_t>(cell);
    const bool moving = grid_.start.rest_length <= 0, straight = check_.straight(c);
    for (const CellPlace place : {CellPlace::begin, CellPlace::middle, CellPlace::end}) {
        problem_.add_place(cell, place);
        const TimedCurvePoint& p = place == CellPlace::begin    ? check_.begin(c)
                                   : place == CellPlace::middle ? check_.middle(c)
                                                                : check_.end(c);
        // The state at a moving beginning, and with it the middle of the first cell, are as they are. A node's limits stand at the end of
        // the cell before, unless something jumps there.
        const bool given = cell == 0 && moving && place != CellPlace::end;
        const bool shared = given || (place == CellPlace::begin && !check_.breaks_before(c));
        const AlongLimits l = along_limits(p, limits_, hard_factor());
        double square = l.velocity * l.velocity;
        if (!shared) {
            // Above a lowered velocity factor a moving beginning may be; it is left as soon as the limits allow.
            const double wanted = below_factor * p.path.velocity * task_.velocity_factor;
            if (moving && task_.velocity_factor < 1 && wanted < unlimited)
                problem_.add_soft_cap(wanted * wanted * std::max(1.0, ramp_.empty() ? 0 : ramp_[3 * c + static_cast<std::size_t>(place)]));
            if (!halt_.empty())
                square = std::min(square, halt_[3 * c + static_cast<std::size_t>(place)] + over_halt * task_.velocity * task_.velocity);
            if (cell == 0 && place == CellPlace::begin) square = std::min(square, begin_square_);
            if (cell + 1 == problem_.cells() && place == CellPlace::end) square = std::min(square, end_square_);
            if (square < unlimited) problem_.add_cap(square);
        }
        // What lies between the nodes shows when all is looked at.
        if (place == CellPlace::middle && (straight || grid_.coarse)) continue;
        if (straight) {  // one row says what all axes say
            if (!shared && l.acceleration < unlimited)
                problem_.add_acceleration({0, 0.5 / l.acceleration, 0, 1, l.deceleration / l.acceleration});
            if (l.jerk < unlimited) problem_.add_jerk({0, 0, 0.5 / l.jerk, 1, 1});
            continue;
        }
        const double most = std::max(p.path.acceleration, p.path.deceleration);
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            // An axis that the path's own limits keep inside its own needs no rows.
            const double one = std::fabs(p.first[i]), two = std::fabs(p.second[i]), three = std::fabs(p.third[i]);
            if (one <= 0 && two <= 0 && three <= 0) continue;
            const double a = limits_[i].acceleration, j = limits_[i].jerk;
            if (!shared && !(two * square + one * most < 0.999 * a)) problem_.add_acceleration({p.second[i] / a, 0.5 * p.first[i] / a, 0});
            if (!((three * square + 3 * two * most) * std::sqrt(square) + one * p.path.jerk < 0.999 * j))
                problem_.add_jerk({p.third[i] / j, 1.5 * p.second[i] / j, 0.5 * p.first[i] / j});
        }
        if (!shared && p.path.acceleration < unlimited)
            problem_.add_acceleration({0, 0.5 / p.path.acceleration, 0, 1, p.path.deceleration / p.path.acceleration});
        if (p.path.jerk < unlimited) problem_.add_jerk({0, 0, 0.5 / p.path.jerk, 1, 1});
    }
}

void RunPlanner::make_problem() {
    check_.sample(*curve_, limits_, grid_.nodes, grid_.breaks);
    problem_.begin(grid_.nodes, grid_.start, grid_.end, untouched);
    make_ramp();
    make_halt();
    const auto most = [&](double at, double length, CurveSide side) {
        return rest_.greatest_square(*curve_, limits_, hard_factor(), at, length, side);
    };
    begin_square_ = from_rest() ? most(task_.from, grid_.start.rest_length, CurveSide::after) : unlimited;
    end_square_ = most(task_.to, grid_.end.rest_length, CurveSide::before);
    for (int i = 0; i < problem_.cells(); ++i) add_cell(i);
    for (int i = 0; i < problem_.cells(); ++i) {
        const CellShare& share = shares_[static_cast<std::size_t>(i)];
        if (share.velocity < untouched.velocity || share.acceleration < untouched.acceleration || share.jerk < untouched.jerk)
            push_share(i);
    }
}

/// What the cell may use, told to all places that it has a part of.
void RunPlanner::push_share(int cell) {
    const auto c = static_cast<std::size_t>(cell);
    const CellShare& own = shares_[c];
    const CellShare first = cell > 0 ? less(own, shares_[c - 1]) : own;
    const CellShare last = c + 1 < shares_.size() ? less(own, shares_[c + 1]) : own;
    problem_.share(cell, CellPlace::begin, first);
    problem_.share(cell, CellPlace::middle, own);
    problem_.share(cell, CellPlace::end, last);
    if (cell > 0) problem_.share(cell - 1, CellPlace::end, first);
    if (c + 1 < shares_.size()) problem_.share(cell + 1, CellPlace::begin, last);
}

/// A cell behind the way down to a lowered velocity, which is there or above it by little. What is allowed there is no limit: if it cannot be had in
/// some rounds, a hair above it is borne.
bool RunPlanner::keeps_to_wanted(std::size_t c) const {
    if (splits_left_ == 0 || from_rest() || task_.velocity_factor >= 1 || (!ramp_.empty() && ramp_[3 * c] > 0)) return false;
    constexpr double little = 1.04;  // of v2
    const auto cell = static_cast<int>(c);
    const double most = std::max({problem_.node(cell, middles_), middles_[c], problem_.node(cell + 1, middles_)});
    const double wanted =
        task_.velocity_factor * std::min({check_.begin(c).path.velocity, check_.middle(c).path.velocity, check_.end(c).path.velocity});
    return most < little * wanted * wanted;
}

CellUse RunPlanner::use_of_cell(std::size_t c) {
    const auto cell = static_cast<int>(c);
    return check_.use(c, {problem_.node(cell, middles_), middles_[c], problem_.node(cell + 1, middles_)},
                      keeps_to_wanted(c) ? task_.velocity_factor : hard_factor());
}

/// Near the end of a search: where a limit will be crossed between nodes by as much as it is used there more than at them, less is allowed at once.
void RunPlanner::come_near(const CellRange& cells, const std::vector<double>&) {
    constexpr double hair = 1 - 2e-4, counts = 0.5, most = 1.03;  // what is more is a matter of the cell's size
    for (int i = cells.first; i < cells.last; ++i) {
        const CellUse use = use_of_cell(static_cast<std::size_t>(i));
        CellShare& share = shares_[static_cast<std::size_t>(i)];
        const auto lower = [&](double peak, double nodes, double& part) {
            if (nodes < counts || peak <= nodes || peak > most * nodes) return false;
            const double now = nodes / peak * hair;
            if (now >= part) return false;
            part = now;
            return true;
        };
        const bool a = lower(use.peak.acceleration, use.nodes.acceleration, share.acceleration);
        const bool j = lower(use.peak.jerk, use.nodes.jerk, share.jerk);
        const bool v = lower(use.peak.velocity, use.nodes.velocity, share.velocity);
        if (a || j || v) push_share(i);
    }
}

/// Looks at the cells of the range; those beyond a limit get less of it, and are remembered.
LimitUse RunPlanner::verify(const CellRange& range) {
    LimitUse whole;
    for (int i = std::max(range.first, 0); i < std::min(range.last, problem_.cells()); ++i) {
        const auto c = static_cast<std::size_t>(i);
        LimitUse use = use_of_cell(c).peak;
        // The pieces at rest grow with the v2 that they meet.
        if (i == 0 && from_rest()) use.velocity = std::max(use.velocity, std::sqrt(problem_.node(0, middles_) / begin_square_));
        if (i + 1 == problem_.cells()) use.velocity = std::max(use.velocity, std::sqrt(problem_.node(i + 1, middles_) / end_square_));
        whole.widen(use);
        uses_[c] = use;
        if (use.inside()) continue;
        beyond_.push_back(i);
        if (keeps_to_wanted(c)) problem_.hold(i);
        // Far beyond, the cell is too long for what happens in it.
        CellShare& share = shares_[c];
        const double most = std::max({use.velocity, use.acceleration, use.jerk}),
                     least = std::min({share.velocity, share.acceleration, share.jerk});
        if (splits_left_ > 0 && (most > 1.02 || least < least_share)) {
            split_.push_back(i);
            continue;
        }
        if (least < least_share) continue;  // what is left is for all to be slower
        constexpr double beyond = 1 + 1e-4;
        if (use.velocity > 1 - 2e-6) share.velocity /= use.velocity * beyond;
        if (use.acceleration > 1 - 2e-6) share.acceleration /= use.acceleration * beyond;
        if (use.jerk > 1) share.jerk /= use.jerk * beyond;
        push_share(i);
    }
    return whole;
}

/// Halves the cells of split_: the same v2, with one more coefficient for each.
void RunPlanner::split_cells() {
    std::vector<double> nodes, middles, reach;
    std::vector<CellShare> shares;
    std::vector<int> beyond;
    std::size_t next = 0, look = 0;
    const auto count = static_cast<std::size_t>(problem_.cells());
    for (std::size_t i = 0; i < count; ++i) {
        const auto cell = static_cast<int>(i);
        if (look < beyond_.size() && beyond_[look] == cell) {
            beyond.push_back(static_cast<int>(middles.size()));
            ++look;
        }
        nodes.push_back(grid_.nodes[i]);
        if (next < split_.size() && split_[next] == cell) {
            ++next;
            const double first = problem_.node(cell, middles_), last = problem_.node(cell + 1, middles_);
            nodes.push_back((grid_.nodes[i] + grid_.nodes[i + 1]) / 2);
            middles.push_back((first + middles_[i]) / 2);
            middles.push_back((middles_[i] + last) / 2);
            shares.insert(shares.end(), 2, shares_[i]);
            reach.insert(reach.end(), 2, reach_[i]);
        } else {
            middles.push_back(middles_[i]);
            shares.push_back(shares_[i]);
            reach.push_back(reach_[i]);
        }
    }
    nodes.push_back(grid_.nodes.back());
    grid_.nodes.swap(nodes);
    middles_.swap(middles);
    shares_.swap(shares);
    reach_.swap(reach);
    beyond_.swap(beyond);
    split_.clear();
    uses_.assign(middles_.size(), {});
    make_problem();
}

/// What is left above a limit after all rounds is a matter of some cells; all are slowed down for it: from rest v2 may be scaled.
void RunPlanner::slow_down(const LimitUse& use) {
    constexpr double margin = 1 - 1e-5;
    const double share = margin * std::min({1.0, 1 / (use.velocity * use.velocity), 1 / use.acceleration, 1 / two_thirds(use.jerk)});
    for (double& middle : middles_) middle *= share;
}

bool RunPlanner::make_pieces(RunPlan& out) const {
    RunShape found;
    found.nodes = grid_.nodes;
    found.middles = middles_;
    for (int node = 0; node <= problem_.cells(); ++node) found.squares.push_back(problem_.node(node, middles_));
    found.end = task_.to;
    found.velocity_factor = task_.velocity_factor;
    found.coarse = grid_.coarse;
    return cut_into_pieces(*curve_, task_.from, grid_.start.rest_length, grid_.end.rest_length, found, out);
}

bool RunPlanner::solve(const CellRange& range, SpeedGuess guess, SpeedWitness* witness, RunPlan& out) {
    const SpeedOutcome outcome = problem_.solve(middles_, range, guess, witness);
    out.steps += outcome.steps;
    if (!outcome.soft_open || guess == SpeedGuess::near) return outcome.feasible;
    // Down to a lowered velocity factor as far as there is a way: once more, from near it.
    out.steps += problem_.solve(middles_, range, SpeedGuess::near, nullptr).steps;
    return outcome.feasible;
}

/// Window by window: each begins with what the one before it found, ends in what lies behind it as it was, and only its first part stays.
bool RunPlanner::sweep(SpeedGuess guess, RunPlan& out) {
    const int n = problem_.cells();
    for (int first = 0; first < n;) {
        int stays = std::min(first + window, n);
        if (first == 0) stays = std::max(stays, std::min(first_window_, n));
        int last = stays;
        if (stays < n) {
            const double reach = grid_.nodes[static_cast<std::size_t>(stays)] + reach_[static_cast<std::size_t>(stays)];
            while (last < n && (last < stays + look_ahead || grid_.nodes[static_cast<std::size_t>(last)] < reach)) ++last;
            if (n - last < window / 2) last = n;
        }
        if (!solve({first, last}, first == 0 || guess != SpeedGuess::outside ? guess : SpeedGuess::inside, this, out)) return false;
        first = last == n ? n : stays;
    }
    return true;
}

/// What a search gains is compared with the time of all that it looks at. Beside a long cruise a slow moment behind the braking to a lowered velocity
/// counts nothing there: so that is looked at by itself. What cannot be bettered stays as it is.
void RunPlanner::settle_braking(RunPlan& out) {
    if (task_.brake_way <= 0) return;
    for (const double share : {20.0, 4.0, 1.5}) {
        const auto behind = std::upper_bound(grid_.nodes.begin(), grid_.nodes.end(), task_.from + share * task_.brake_way);
        const int last = std::min(static_cast<int>(behind - grid_.nodes.begin()), problem_.cells());
        if (last < problem_.cells()) (void)solve({0, last}, SpeedGuess::near, nullptr, out);
    }
}

/// The same of the ramps at both ends of a long run: some tenths of a second that are lost there are little of it, but much to who waits for it to move.
void RunPlanner::settle_ramps(RunPlan& out) {
    if (grid_.coarse) return;
    const int n = problem_.cells();
    double whole = 0;
    for (int c = 0; c < n; ++c)
        whole += (grid_.nodes[static_cast<std::size_t>(c) + 1] - grid_.nodes[static_cast<std::size_t>(c)]) /
                 std::sqrt(middles_[static_cast<std::size_t>(c)]);
    const auto way_of_ramp = [&](double s, CurveSide side) {
        constexpr double many = 20;  // ramps in a long run
        const AlongLimits l = along_limits(curve_->at(s, side), limits_, task_.velocity_factor);
        const double time = l.velocity / std::min(l.acceleration, l.deceleration) + l.acceleration / l.jerk;
        return whole > many * time ? time * l.velocity : 0.0;
    };
    // Who goes on to a raised velocity factor has a ramp as well.
    const double allowed = along_limits(curve_->at(task_.from, CurveSide::after), limits_, task_.velocity_factor).velocity;
    const bool rises = from_rest() || (task_.halt_share <= 0 && task_.velocity < 0.9 * allowed);
    const double up = rises ? way_of_ramp(task_.from, CurveSide::after) : 0, down = way_of_ramp(task_.to, CurveSide::before);
    const auto cell_at = [&](double s) {
        const auto behind = std::upper_bound(grid_.nodes.begin(), grid_.nodes.end(), s);
        return std::clamp(static_cast<int>(behind - grid_.nodes.begin()), 1, n);
    };
    // From many ramps to some: what lies beside is as it was found before.
    for (const double share : {64.0, 8.0, 2.0}) {
        const CellRange first{0, cell_at(task_.from + share * up)}, last{cell_at(task_.to - share * down) - 1, n};
        if (up > 0 && first.last < n) (void)solve(first, SpeedGuess::near, nullptr, out);
        if (down > 0 && last.first > 0 && last.first < n) (void)solve(last, SpeedGuess::near, nullptr, out);
    }
}

/// Solves again around the cells that are beyond a limit, until none is.
bool RunPlanner::mend(RunPlan& out) {
    while (!beyond_.empty() && out.rounds < rounds_at_most) {
        ++out.rounds;
        for (std::vector<int>* cells : {&beyond_, &split_}) {  // a cell may have been looked at twice
            std::sort(cells->begin(), cells->end());
            cells->erase(std::unique(cells->begin(), cells->end()), cells->end());
        }
        if (!split_.empty()) split_cells();
        if (splits_left_ > 0) --splits_left_;
        std::vector<CellRange> ranges;
        for (const int cell : beyond_) {
            const CellRange range{std::max(cell - beside, 0), std::min(cell + beside + 1, problem_.cells())};
            if (!ranges.empty() && range.first <= ranges.back().last + 2) ranges.back().last = range.last;
            else ranges.push_back(range);
        }
        beyond_.clear();
        bool near = true;
        for (const CellRange& range : ranges) near = near && solve(range, SpeedGuess::near, nullptr, out);
        if (near) {
            for (const CellRange& range : ranges) (void)verify({range.first - 1, range.last + 1});
            continue;
        }
        // What is beside holds it there: all together. From rest a little slower is inside everything.
        if (from_rest()) problem_.come_inside(middles_, 0.97);
        if (!sweep(from_rest() ? SpeedGuess::inside : SpeedGuess::outside, out)) return false;
        (void)verify({0, problem_.cells()});
    }
    return beyond_.empty();
}

void RunPlanner::plan_whole(const RunTask& task, RunPlan& out, const RunShape* former) {
    task_ = task;
    out.found = false;
    out.rounds = 0;
    first_window_ = 0;
    beyond_.clear();
    split_.clear();
    splits_left_ = task.velocity > 0 ? split_rounds_moving : split_rounds;
    slower_ = former != nullptr && task.velocity_factor < former->velocity_factor;
    former_factor_ = slower_ ? former->velocity_factor : 1;
    measure_braking();
    grid_.make(*curve_, limits_, task_,
               former != nullptr && former->coarse && task.halt_share <= 0 ? CellGrid::Grain::coarse : CellGrid::Grain::by_run);
    shares_.assign(grid_.nodes.size() - 1, untouched);
    if (task.halt_share > 0 && !from_rest()) {
        make_problem();
        brake();
    } else if (former != nullptr && !from_rest()) {
        take_over(*former);
    } else {
        make_problem();
        first_guess();
        if (from_rest()) problem_.come_inside(middles_, 0.8);
    }
    uses_.assign(middles_.size(), {});
    ++out.rounds;
    const bool solved = sweep(from_rest() ? SpeedGuess::inside : SpeedGuess::outside, out);
    if (solved) {
        settle_braking(out);
        settle_ramps(out);
    }
    if (solved || from_rest()) out.use = verify({0, problem_.cells()});
    out.found = solved && mend(out);
    LimitUse use;
    for (const LimitUse& cell : uses_) use.widen(cell);
    if (!out.found && from_rest()) {
        splits_left_ = 0;
        use = verify({0, problem_.cells()});
        // Slower cells may be looked at in another way than before, and a hair more be seen.
        for (int i = 0; i < slow_downs && !out.found; ++i) {
            slow_down(use);
            beyond_.clear();
            use = verify({0, problem_.cells()});
            out.found = use.inside();
        }
    }
    out.use = use;
    out.cells = out.planned = problem_.cells();
    out.pieces.clear();
    out.found = out.found && make_pieces(out);
    look_above(out);
}

/// The first cell of `former` that a further end has an influence on; 0 where there is none before it.
std::size_t RunPlanner::grows_from(const RunTask& task, const RunShape& former) const {
    if (former.velocity_factor != task.velocity_factor || !(task.to > former.end) || former.nodes.size() < 3) return 0;
    std::size_t brakes = former.nodes.size() - 1;
    while (brakes > 0 && former.squares[brakes] <= former.squares[brakes - 1]) --brakes;
    const double reach = former.end - 2.5 * (former.end - former.nodes[brakes]);
    std::size_t kept = std::min(brakes, former.nodes.size() - std::min<std::size_t>(former.nodes.size(), look_ahead / 2));
    while (kept > 0 && former.nodes[kept] > reach) --kept;
    return former.nodes[kept] > task.from + 1e-9 * (task.to - task.from) ? kept : 0;
}

/// What `former` does from the task's beginning up to its node `kept`, before what was planned from there.
void RunPlanner::keep_before(std::size_t kept, const RunTask& task, const RunShape& former, RunPlan& out) const {
    const auto begin = std::lower_bound(former.nodes.begin(), former.nodes.end(), task.from - 1e-12 * std::fabs(task.to));
    const std::ptrdiff_t from = begin - former.nodes.begin(), to = static_cast<std::ptrdiff_t>(kept);
    std::vector<TimePiece> pieces;
    double time = 0;
    for (auto c = static_cast<std::size_t>(from); c < kept; ++c) {
        TimePiece p = TimePiece::moving(former.nodes[c], former.nodes[c + 1] - former.nodes[c], former.squares[c], former.middles[c],
                                        former.squares[c + 1]);
        p.begin_time = time;
        p.part = curve_->part_at(p.begin + p.length / 2);
        time += p.duration;
        pieces.push_back(p);
    }
    for (TimePiece p : out.pieces) {
        p.begin_time += time;
        pieces.push_back(p);
    }
    out.pieces.swap(pieces);
    const auto put = [&](std::vector<double>& own, const std::vector<double>& before) {
        own.insert(own.begin(), before.begin() + from, before.begin() + to);
    };
    put(out.shape.nodes, former.nodes);
    put(out.shape.squares, former.squares);
    put(out.shape.middles, former.middles);
    out.duration += time;
    if (out.above_for > 0) out.above_for += time;
    out.cells = static_cast<int>(out.shape.middles.size());
}

void RunPlanner::plan(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, RunPlan& out,
                      const RunShape* former) {
    curve_ = &curve;
    limits_ = limits;
    out.steps = 0;
    if (former != nullptr && task.velocity > 0) {
        const std::size_t kept = grows_from(task, *former);
        if (kept > 0) {
            RunTask tail = task;
            tail.from = former->nodes[kept];
            tail.velocity = std::sqrt(former->squares[kept]);
            tail.acceleration = (former->middles[kept] - former->squares[kept]) / (former->nodes[kept + 1] - former->nodes[kept]);
            plan_onward(tail, out, former);
            if (out.found) {
                keep_before(kept, task, *former, out);
                return;
            }
        }
    }
    plan_onward(task, out, former);
}

/// Where an end has moved on, the former plan's braking for it may be no beginning: then from above it.
void RunPlanner::plan_onward(const RunTask& task, RunPlan& out, const RunShape* former) {
    plan_whole(task, out, former);
    if (out.found || former == nullptr || task.velocity <= 0 || task.halt_share > 0 || slower_ || !(task.to > former->end)) return;
    // While its deceleration goes, half of the velocity has to be left: who is nearer to standing is seldom helped, and waits for a second search.
    const double falling = std::min(task.acceleration, 0.0), jerk = along_limits(curve_->at(task.from, CurveSide::after), limits_, 1).jerk;
    if (falling * falling / (2 * jerk) > 0.5 * task.velocity) return;
    brisk_ = true;
    plan_whole(task, out, former);
    brisk_ = false;
}

}  // namespace taktwerk::axes

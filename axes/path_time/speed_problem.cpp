#include "axes/path_time/speed_problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr int max_steps = 80;
constexpr double to_the_boundary = 0.95;  // of the way that a step may go towards it
constexpr double inside_first = 10;       // gap while a bound is relaxed: the goal counts a tenth of it
constexpr double room_beyond = 0.1;       // of a bound that is relaxed
constexpr double settled_gap = 3e-4;      // of the goal: what is left to gain

}  // namespace

void SpeedProblem::begin(const std::vector<double>& nodes, const SpeedEnd& start, const SpeedEnd& end) {
    nodes_ = nodes;
    lengths_.clear();
    for (std::size_t i = 1; i < nodes.size(); ++i) lengths_.push_back(nodes[i] - nodes[i - 1]);
    start_ = start;
    end_ = end;
    points_.clear();
    rows_.clear();
}

/// Node `node` through the middles around `cell`, which is the cell before or behind it.
SpeedProblem::Triple SpeedProblem::node_triple(int node, int cell) const noexcept {
    Triple t;
    const int n = cells();
    if (node == 0) {
        if (start_.rest_length > 0) t.g[1] = 1 / (1 + 2 * lengths_.front() / (3 * start_.rest_length));
        else t.k = start_.square;
    } else if (node == n) {
        t.g[1] = 1 / (1 + 2 * lengths_.back() / (3 * end_.rest_length));
    } else {
        const double before = lengths_[static_cast<std::size_t>(node - 1)], behind = lengths_[static_cast<std::size_t>(node)];
        const int left = node == cell ? 0 : 1;
        t.g[left] = behind / (before + behind);
        t.g[left + 1] = before / (before + behind);
    }
    return t;
}

double SpeedProblem::node(int i, const std::vector<double>& middles) const noexcept {
    const int cell = std::min(i, cells() - 1);
    return value(node_triple(i, cell), cell, middles);
}

double SpeedProblem::value(const Triple& t, int cell, const std::vector<double>& d) const noexcept {
    const auto c = static_cast<std::size_t>(cell);
    double sum = t.k + t.g[1] * d[c];
    if (c > 0) sum += t.g[0] * d[c - 1];
    if (c + 1 < d.size()) sum += t.g[2] * d[c + 1];
    return sum;
}

void SpeedProblem::add_point(const SpeedPoint& at) {
    const double x = at.x, h = lengths_[static_cast<std::size_t>(at.cell)];
    const Triple first = node_triple(at.cell, at.cell), last = node_triple(at.cell + 1, at.cell);
    Triple middle;
    middle.g[1] = 1;
    const auto mix = [&](double a, double b, double c) {
        Triple t;
        for (int i = 0; i < 3; ++i) t.g[i] = a * first.g[i] + b * middle.g[i] + c * last.g[i];
        t.k = a * first.k + c * last.k;
        return t;
    };
    Point p{};
    p.cell = at.cell;
    p.weight = at.weight;
    p.square = mix((1 - x) * (1 - x), 2 * x * (1 - x), x * x);
    p.slope = mix(-2 * (1 - x) / h, 2 * (1 - 2 * x) / h, 2 * x / h);
    p.bend = mix(2 / (h * h), -4 / (h * h), 2 / (h * h));
    p.first_row = static_cast<int>(rows_.size());
    points_.push_back(p);
}

void SpeedProblem::add_row(const SpeedRow& row, Bound bound) {
    Point& p = points_.back();
    Row r{};
    for (int i = 0; i < 3; ++i) r.l.g[i] = row.at * p.square.g[i] + row.slope * p.slope.g[i] + row.bend * p.bend.g[i];
    r.l.k = row.at * p.square.k + row.slope * p.slope.k + row.bend * p.bend.k;
    r.above = row.above;
    r.below = row.below;
    r.bound = bound;
    rows_.push_back(r);
    ++p.rows;
}

void SpeedProblem::add_cap(double square, Bound bound) { add_row({1 / square, 0, 0, 1, 0}, bound); }

void SpeedProblem::add_cap_on_middle(double square) {
    add_cap(square);
    rows_.back().l = {{0, 1 / square, 0}, 0};
}

void SpeedProblem::look(const std::vector<double>& d) {
    for (Point& p : points_) {
        p.v2 = value(p.square, p.cell, d);
        p.over_v = 1 / std::sqrt(p.v2);
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            row.value = value(row.l, p.cell, d);
        }
    }
}

/// Where the present v2 crosses a bound, the bound is put a little beyond it, and never further out again: so every iterate is inside, and
/// what is inside all true bounds once stays there.
void SpeedProblem::relax(Room room) {
    feasible_ = true;
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double over_size = row.bound == Bound::over_velocity ? 1 / p.over_v : 1;
            const auto side = [&](Side& x, double bound, double sign) {
                const double used = sign * row.value * over_size;
                const double wanted = used < bound * (1 - 1e-7) ? bound : used + room_beyond * std::max(bound, used);
                x.bound = room == Room::first ? wanted : std::min(x.bound, wanted);
                x.s = std::max((x.bound - used) / over_size, 1e-9 * x.bound / over_size);
                if (row.bound != Bound::soft_cap) feasible_ = feasible_ && x.bound <= bound;
            };
            side(row.up, row.above, 1);
            if (!one_sided(row)) side(row.down, row.below, -1);
        }
}

/// Slacks as they are, multipliers on the central path of mu.
void SpeedProblem::center(double mu) {
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double size = row.bound == Bound::over_velocity ? p.over_v : 1;
            const auto side = [&](Side& x, double sign) {
                x.s = std::max(x.bound * size - sign * row.value, 1e-9 * x.bound * size);
                x.z = mu / x.s;
            };
            side(row.up, 1);
            if (!one_sided(row)) side(row.down, -1);
        }
}

/// The equations of one step: band_ and right_.
void SpeedProblem::assemble(double mu, SpeedGoal goal) {
    std::fill(band_.begin(), band_.end(), 0);
    std::fill(right_.begin(), right_.end(), 0);
    const int n = cells();
    for (const Point& p : points_) {
        double m00 = 0, m01 = 0, m02 = 0, m11 = 0, m12 = 0, m22 = 0, f0 = 0, f1 = 0, f2 = 0;
        const auto add = [&](double g0, double g1, double g2, double weight, double force) {
            const double w0 = weight * g0, w1 = weight * g1, w2 = weight * g2;
            m00 += w0 * g0;
            m01 += w0 * g1;
            m02 += w0 * g2;
            m11 += w1 * g1;
            m12 += w1 * g2;
            m22 += w2 * g2;
            f0 += force * g0;
            f1 += force * g1;
            f2 += force * g2;
        };
        const double cube = p.over_v / p.v2;  // v^-3
        const double* q = p.square.g;
        if (p.weight > 0) {
            if (goal == SpeedGoal::fastest) add(q[0], q[1], q[2], 0.75 * scale_ * p.weight * cube / p.v2, 0.5 * scale_ * p.weight * cube);
            else add(q[0], q[1], q[2], 0, -scale_ * p.weight);
        }
        for (int i = 0; i < p.rows; ++i) {
            const Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double* l = row.l.g;
            const auto side = [&](const Side& x, double sign) {
                double left = x.bound - sign * row.value, bend = 0;
                if (row.bound == Bound::over_velocity) {
                    left = x.bound * p.over_v - sign * row.value;
                    bend = -0.5 * x.bound * cube;
                }
                const double weight = x.z / x.s, force = x.z + weight * (mu / x.z - left);
                add(bend * q[0] - sign * l[0], bend * q[1] - sign * l[1], bend * q[2] - sign * l[2], weight, force);
            };
            side(row.up, 1);
            if (!one_sided(row)) side(row.down, -1);
        }
        const int c = p.cell;
        double* at = &band_[static_cast<std::size_t>(3 * c)];
        at[0] += m11;
        right_[static_cast<std::size_t>(c)] += f1;
        if (c > 0) {
            at[-3] += m00;
            at[-2] += m01;
            right_[static_cast<std::size_t>(c - 1)] += f0;
            if (c + 1 < n) at[-1] += m02;
        }
        if (c + 1 < n) {
            at[1] += m12;
            at[3] += m22;
            right_[static_cast<std::size_t>(c + 1)] += f2;
        }
    }
}

/// L D L^T of five diagonals. The step replaces right_.
bool SpeedProblem::factor_and_solve() {
    const std::size_t n = right_.size();
    if (start_.rest_length <= 0) {  // the first middle is given by the slope
        band_[0] = 1;
        band_[1] = band_[2] = 0;
        right_[0] = 0;
    }
    for (std::size_t i = 0; i < n; ++i) {
        double* row = &band_[3 * i];
        if (!(row[0] > 0)) return false;
        const double one = row[1] / row[0], two = row[2] / row[0];
        if (i + 1 < n) {
            row[3] -= one * row[1];
            row[4] -= one * row[2];
            right_[i + 1] -= one * right_[i];
        }
        if (i + 2 < n) {
            row[6] -= two * row[2];
            right_[i + 2] -= two * right_[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        const double* row = &band_[3 * i];
        double sum = right_[i];
        if (i + 1 < n) sum -= row[1] * right_[i + 1];
        if (i + 2 < n) sum -= row[2] * right_[i + 2];
        right_[i] = sum / row[0];
    }
    return true;
}

/// How far v2, slacks and multipliers stay positive on the way that right_ says.
SpeedProblem::Steps SpeedProblem::measure_step(double mu, const std::vector<double>& d) {
    Steps steps;
    for (std::size_t i = 0; i < d.size(); ++i)
        if (right_[i] < -0.8 * d[i]) steps.primal = std::min(steps.primal, -0.8 * d[i] / right_[i]);
    const auto stay = [](double now, double change, double& step) {
        if (change < -to_the_boundary * now && change * step < -to_the_boundary * now) step = -to_the_boundary * now / change;
    };
    for (const Point& p : points_) {
        const double square_move = value(p.square, p.cell, right_) - p.square.k;
        if (square_move < -0.8 * p.v2) steps.primal = std::min(steps.primal, -0.8 * p.v2 / square_move);
        const double cube = p.over_v / p.v2;
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double move = value(row.l, p.cell, right_) - row.l.k;
            const auto side = [&](Side& x, double sign) {
                double left = x.bound - sign * row.value, change = -sign * move;
                if (row.bound == Bound::over_velocity) {
                    left = x.bound * p.over_v - sign * row.value;
                    change -= 0.5 * x.bound * cube * square_move;
                }
                x.ds = left - x.s + change;
                x.dz = (mu - x.z * x.ds) / x.s - x.z;
                stay(x.s, x.ds, steps.primal);
                stay(x.z, x.dz, steps.dual);
            };
            side(row.up, 1);
            if (!one_sided(row)) side(row.down, -1);
        }
    }
    return steps;
}

double SpeedProblem::take_step(const Steps& steps, std::vector<double>& d) {
    for (std::size_t i = 0; i < d.size(); ++i) d[i] += steps.primal * right_[i];
    look(d);
    double gap = 0;
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const auto side = [&](Side& x, double sign) {
                const double left = (row.bound == Bound::over_velocity ? x.bound * p.over_v : x.bound) - sign * row.value;
                // A jerk's bound is convex: what the step promised is kept at least. A slack follows what is really there.
                x.s = std::max(x.s + steps.primal * x.ds, left);
                x.z += steps.dual * x.dz;
                gap += x.s * x.z;
            };
            side(row.up, 1);
            if (!one_sided(row)) side(row.down, -1);
        }
    return gap;
}

/// From rest, v2 times a small number keeps every limit: velocity, acceleration and jerk go with its powers 1/2, 1 and 3/2.
void SpeedProblem::make_feasible(std::vector<double>& d, double share) {
    double most = 0;
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            const Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            double use = std::max(row.value / row.above, one_sided(row) ? 0.0 : -row.value / row.below);
            if (row.bound == Bound::over_velocity) {
                const double root = math::cbrt(use / p.over_v);
                use = root * root;
            }
            most = std::max(most, use);
        }
    if (most < share) return;
    for (double& middle : d) middle *= share / most;
    look(d);
}

SpeedOutcome SpeedProblem::solve(std::vector<double>& d, SpeedGoal goal, SpeedGuess guess) {
    SpeedOutcome outcome;
    band_.assign(3 * d.size() + 9, 0);
    right_.assign(d.size(), 0);
    if (moving()) d[0] = start_.square + start_.slope * lengths_[0] / 2;
    look(d);
    if (!moving()) make_feasible(d, guess == SpeedGuess::rough ? 0.8 : 0.97);
    double total = 0, sides = 0;
    for (const Point& p : points_) total += p.weight * (goal == SpeedGoal::fastest ? p.over_v : p.v2);
    scale_ = 1 / total;
    for (const Row& row : rows_) sides += one_sided(row) ? 1 : 2;
    relax(Room::first);
    center(inside_first / sides);
    // While something is relaxed, being inside counts for more than being fast.
    while (!feasible_ && outcome.steps < max_steps) {
        ++outcome.steps;
        const double mu = inside_first / sides;
        assemble(mu, goal);
        if (!factor_and_solve()) return outcome;
        (void)take_step(measure_step(mu, d), d);
        relax(Room::less);
    }
    if (!feasible_) return outcome;
    double mu = (guess == SpeedGuess::rough ? 0.1 : 0.01) / sides, previous = 1;
    center(mu);
    for (const int most = outcome.steps + max_steps; outcome.steps < most && !outcome.settled;) {
        ++outcome.steps;
        assemble(mu, goal);
        if (!factor_and_solve()) break;
        const Steps steps = measure_step(mu, d);
        const double gap = take_step(steps, d);
        const double least = std::min(steps.primal, steps.dual);
        outcome.settled = gap < settled_gap && previous > 0.5 && least > 0.5;
        previous = least;
        mu = std::max(gap / sides * (least > 0.9 ? 0.1 : least > 0.5 ? 0.3 : least > 0.2 ? 0.6 : 1.0), 0.1 * settled_gap / sides);
    }
    outcome.feasible = true;
    return outcome;
}

}  // namespace taktwerk::axes

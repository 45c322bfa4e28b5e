#include "axes/path_time/speed_problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr int max_steps = 80;
constexpr double to_the_boundary = 0.95;  // of the way that a step may go towards it
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

void SpeedProblem::add_cap(double square) { add_row({1 / square, 0, 0, 1, 0}, Bound::cap); }

void SpeedProblem::add_cap_on_middle(double square) {
    add_cap(square);
    rows_.back().l = {{0, 1 / square, 0}, 0};
}

void SpeedProblem::look(const std::vector<double>& d) {
    for (Point& p : points_) {
        p.v2 = value(p.square, p.cell, d);
        p.over_v = 1 / std::sqrt(p.v2);
    }
}

double SpeedProblem::residual(const Row& row, const Point& point, bool up, double l) const noexcept {
    const double bound = up ? row.above : row.below;
    return (row.bound == Bound::over_velocity ? bound * point.over_v : bound) - (up ? l : -l);
}

void SpeedProblem::start_slacks(const std::vector<double>& d, double mu) {
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double l = value(row.l, p.cell, d);
            const double size = row.bound == Bound::over_velocity ? p.over_v : 1;
            row.s_up = std::max(residual(row, p, true, l), 0.05 * row.above * size);
            row.z_up = mu / row.s_up;
            if (row.bound == Bound::cap) continue;
            row.s_down = std::max(residual(row, p, false, l), 0.05 * row.below * size);
            row.z_down = mu / row.s_down;
        }
}

/// The equations of one step. Returns nothing of use but the work: band_ and right_.
double SpeedProblem::assemble(double mu, SpeedGoal goal) {
    std::fill(band_.begin(), band_.end(), 0);
    std::fill(right_.begin(), right_.end(), 0);
    const int n = cells();
    double worst = 0;
    for (const Point& p : points_) {
        double m00 = 0, m01 = 0, m02 = 0, m11 = 0, m12 = 0, m22 = 0, f0 = 0, f1 = 0, f2 = 0;
        const auto add = [&](const double* g, double weight, double force) {
            const double w0 = weight * g[0], w1 = weight * g[1], w2 = weight * g[2];
            m00 += w0 * g[0];
            m01 += w0 * g[1];
            m02 += w0 * g[2];
            m11 += w1 * g[1];
            m12 += w1 * g[2];
            m22 += w2 * g[2];
            f0 += force * g[0];
            f1 += force * g[1];
            f2 += force * g[2];
        };
        const double cube = p.over_v / p.v2;  // v^-3
        if (p.weight > 0) {
            if (goal == SpeedGoal::fastest) add(p.square.g, 0.75 * scale_ * p.weight * cube / p.v2, 0.5 * scale_ * p.weight * cube);
            else add(p.square.g, 0, -scale_ * p.weight);
        }
        for (int i = 0; i < p.rows; ++i) {
            const Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double l = row.move;  // set by the caller to the present value
            if (row.bound == Bound::cap) {
                const double sigma = row.above - l, over = row.z_up / row.s_up;
                worst = std::max(worst, -sigma);
                const double force = mu / row.s_up - over * (sigma - row.s_up);
                add(row.l.g, over, -force);
                continue;
            }
            double up_bend = 0, down_bend = 0, up = row.above, down = row.below;
            if (row.bound == Bound::over_velocity) {
                up_bend = -0.5 * row.above * cube;
                down_bend = -0.5 * row.below * cube;
                up *= p.over_v;
                down *= p.over_v;
            }
            // d(sigma)/dd: bend * square.g -+ l.g
            double g[3];
            const double over_up = row.z_up / row.s_up, over_down = row.z_down / row.s_down;
            for (int k = 0; k < 3; ++k) g[k] = up_bend * p.square.g[k] - row.l.g[k];
            add(g, over_up, mu / row.s_up - over_up * (up - l - row.s_up));
            for (int k = 0; k < 3; ++k) g[k] = down_bend * p.square.g[k] + row.l.g[k];
            add(g, over_down, mu / row.s_down - over_down * (down + l - row.s_down));
            worst = std::max({worst, -(up - l) / up, -(down + l) / down});
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
    return worst;
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

/// From rest, v2 times a small number keeps every limit: velocity, acceleration and jerk go with its powers 1/2, 1 and 3/2.
void SpeedProblem::make_feasible(std::vector<double>& d, double share) {
    double most = 0;
    for (const Point& p : points_)
        for (int i = 0; i < p.rows; ++i) {
            const Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
            const double l = value(row.l, p.cell, d);
            double use = std::max(l / row.above, row.bound == Bound::cap ? 0.0 : -l / row.below);
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
    const auto n = static_cast<std::size_t>(cells());
    band_.assign(3 * n + 9, 0);
    right_.assign(n, 0);
    if (start_.rest_length <= 0) d[0] = start_.square + start_.slope * lengths_[0] / 2;
    look(d);
    if (start_.rest_length > 0) make_feasible(d, guess == SpeedGuess::rough ? 0.8 : 0.97);
    double total = 0, sides = 0;
    for (const Point& p : points_) total += p.weight * (goal == SpeedGoal::fastest ? p.over_v : p.v2);
    scale_ = 1 / total;
    for (const Row& row : rows_) sides += row.bound == Bound::cap ? 1 : 2;
    double mu = (guess == SpeedGuess::rough ? 0.1 : 0.01) / sides;
    start_slacks(d, mu);
    double previous = 1;
    for (; outcome.steps < max_steps; ++outcome.steps) {
        for (Point& p : points_)
            for (int i = 0; i < p.rows; ++i) {
                Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
                row.move = value(row.l, p.cell, d);
            }
        double worst = assemble(mu, goal);
        if (!factor_and_solve()) break;

        // How far: v2 stays positive, slacks and multipliers do.
        double primal = 1, dual = 1;
        for (std::size_t i = 0; i < n; ++i)
            if (right_[i] < -0.8 * d[i]) primal = std::min(primal, -0.8 * d[i] / right_[i]);
        for (Point& p : points_) {
            const double square_move = value(p.square, p.cell, right_) - p.square.k;
            if (square_move < -0.8 * p.v2) primal = std::min(primal, -0.8 * p.v2 / square_move);
            const double cube = p.over_v / p.v2;
            for (int i = 0; i < p.rows; ++i) {
                Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
                const double l = row.move, move = value(row.l, p.cell, right_) - row.l.k;
                const auto side = [&](double bound, double sign, double s, double z, double& ds, double& dz) {
                    double sigma = bound - sign * l, change = -sign * move;
                    if (row.bound == Bound::over_velocity) {
                        sigma = bound * p.over_v - sign * l;
                        change -= 0.5 * bound * cube * square_move;
                    }
                    ds = sigma - s + change;
                    dz = (mu - z * ds) / s - z;
                    if (ds < -to_the_boundary * s) primal = std::min(primal, -to_the_boundary * s / ds);
                    if (dz < -to_the_boundary * z) dual = std::min(dual, -to_the_boundary * z / dz);
                };
                double ds = 0, dz = 0;
                side(row.above, 1, row.s_up, row.z_up, ds, dz);
                if (row.bound != Bound::cap) side(row.below, -1, row.s_down, row.z_down, ds, dz);
            }
        }
        double gap = 0;
        for (Point& p : points_) {
            const double square_move = value(p.square, p.cell, right_) - p.square.k;
            const double cube = p.over_v / p.v2;
            for (int i = 0; i < p.rows; ++i) {
                Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
                const double l = row.move, move = value(row.l, p.cell, right_) - row.l.k;
                const auto side = [&](double bound, double sign, double& s, double& z) {
                    double sigma = bound - sign * l, change = -sign * move;
                    if (row.bound == Bound::over_velocity) {
                        sigma = bound * p.over_v - sign * l;
                        change -= 0.5 * bound * cube * square_move;
                    }
                    const double ds = sigma - s + change;
                    const double dz = (mu - z * ds) / s - z;
                    s += primal * ds;
                    z += dual * dz;
                };
                side(row.above, 1, row.s_up, row.z_up);
                if (row.bound != Bound::cap) side(row.below, -1, row.s_down, row.z_down);
            }
        }
        for (std::size_t i = 0; i < n; ++i) d[i] += primal * right_[i];
        look(d);
        // The jerk's bound is convex: what the step promised is kept at least. A slack follows what is really there.
        worst = 0;
        for (Point& p : points_)
            for (int i = 0; i < p.rows; ++i) {
                Row& row = rows_[static_cast<std::size_t>(p.first_row + i)];
                const double l = value(row.l, p.cell, d);
                const double size = row.bound == Bound::over_velocity ? p.over_v : 1;
                const double up = residual(row, p, true, l);
                worst = std::max(worst, -up / size);
                row.s_up = std::max(row.s_up, up);
                gap += row.s_up * row.z_up;
                if (row.bound == Bound::cap) continue;
                const double down = residual(row, p, false, l);
                worst = std::max(worst, -down / size);
                row.s_down = std::max(row.s_down, down);
                gap += row.s_down * row.z_down;
            }
        outcome.feasible = worst <= 0;
        const double least = std::min(primal, dual);
        if (outcome.feasible && gap < settled_gap && previous > 0.5 && least > 0.5) {
            outcome.settled = true;
            ++outcome.steps;
            break;
        }
        previous = least;
        mu = gap / sides * (least > 0.9 ? 0.1 : least > 0.5 ? 0.3 : least > 0.2 ? 0.6 : 1.0);
        mu = std::max(mu, 0.1 * settled_gap / sides);
    }
    return outcome;
}

}  // namespace taktwerk::axes

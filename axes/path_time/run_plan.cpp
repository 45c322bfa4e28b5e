#include "axes/path_time/run_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/path_time/along_limits.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr double growth = 0.25;       // of a cell's size per way from a smaller one
constexpr int stations_between = 16;  // of a span that bends
constexpr int most_of_run = 24;       // a cell is at most this part of a run
constexpr double rest_share = 0.2;    // of the way with jerk that the piece at rest takes
constexpr int rounds_at_most = 6;
constexpr double slow_share = 0.02;  // of v2: the least that is taken over of a former plan
constexpr double on_share = 1.6;     // of the first guess, which is half of what has no jerk: what goes on where a former plan stopped
constexpr int verified_points = 10;  // per cell
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The greatest use of each limit by equally spaced samples, with what a parabola through three of them reaches in between.
class PeakUse {
public:
    explicit PeakUse(std::size_t axes) : axes_(axes) {}

    void look(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits, double velocity_factor, const PathMotion& m) {
        const double v = m.velocity, a = m.acceleration, j = m.jerk;
        std::size_t n = 0;
        now_[n++] = v / (p.path.velocity * velocity_factor);
        now_[n++] = a > 0 ? a / p.path.acceleration : -a / p.path.deceleration;
        now_[n++] = j / p.path.jerk;
        for (std::size_t i = 0; i < axes_; ++i) {
            now_[n++] = p.first[i] * v / limits[i].velocity;
            now_[n++] = (p.first[i] * a + p.second[i] * v * v) / limits[i].acceleration;
            now_[n++] = (p.first[i] * j + 3 * p.second[i] * v * a + p.third[i] * v * v * v) / limits[i].jerk;
        }
        for (std::size_t i = 0; i < n; ++i) {
            double& peak = peak_[i % 3];
            peak = std::max(peak, std::fabs(now_[i]));
            if (seen_ < 2) continue;
            const double bend = now_[i] - 2 * one_[i] + two_[i], slope = now_[i] - two_[i];
            if (std::fabs(slope) < 2.2 * std::fabs(bend)) peak = std::max(peak, std::fabs(one_[i] - slope * slope / (8 * bend)));
        }
        two_ = one_;
        one_ = now_;
        ++seen_;
    }
    [[nodiscard]] LimitUse use() const { return {peak_[0], peak_[1], peak_[2]}; }

private:
    using Values = std::array<double, 3 * (max_path_axes + 1)>;
    std::size_t axes_;
    int seen_ = 0;
    Values now_{}, one_{}, two_{};
    std::array<double, 3> peak_{};
};

/// What the path's velocity limit is times where nothing may cross it.
double hard_factor(const RunTask& task) { return task.velocity > 0 ? 1 : task.velocity_factor; }

/// x^(2/3).
double two_thirds(double x) {
    const double root = math::cbrt(x);
    return root * root;
}

}  // namespace

void LimitUse::widen(const LimitUse& other) noexcept {
    velocity = std::max(velocity, other.velocity);
    acceleration = std::max(acceleration, other.acceleration);
    jerk = std::max(jerk, other.jerk);
}

LimitUse limit_use(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits, double velocity_factor, const PathMotion& m) noexcept {
    const double v = m.velocity, a = m.acceleration, j = m.jerk;
    LimitUse use{v / (p.path.velocity * velocity_factor), std::max(a / p.path.acceleration, -a / p.path.deceleration),
                 std::fabs(j) / p.path.jerk};
    for (std::size_t i = 0; i < limits.size(); ++i) {
        use.velocity = std::max(use.velocity, std::fabs(p.first[i] * v) / limits[i].velocity);
        use.acceleration = std::max(use.acceleration, std::fabs(p.first[i] * a + p.second[i] * v * v) / limits[i].acceleration);
        use.jerk = std::max(use.jerk, std::fabs(p.first[i] * j + 3 * p.second[i] * v * a + p.third[i] * v * v * v) / limits[i].jerk);
    }
    return use;
}

void RunPlanner::add_breaks(const RunTask& task) {
    breaks_.clear();
    breaks_.push_back(task.from);
    while (breaks_.back() < task.to) {
        const double next = std::min(curve_->next_break(breaks_.back()), task.to);
        // A sliver would be a cell of no length.
        if (next - breaks_.back() < 1e-12 * (std::fabs(task.to) + 1e-300) || (task.to - next < 1e-9 * (task.to - task.from))) {
            breaks_.push_back(task.to);
            break;
        }
        breaks_.push_back(next);
    }
}

/// Places with the size of cells there: all breaks, and some between them where the curve bends.
void RunPlanner::add_stations(double largest) {
    stations_.clear();
    sizes_.clear();
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
        const double a = breaks_[i], length = breaks_[i + 1] - a;
        const double begins = std::min({largest, length, curve_->feature(a, CurveSide::after)});
        if (i == 0) {
            stations_.push_back(a);
            sizes_.push_back(begins);
        } else {
            sizes_.back() = std::min(sizes_.back(), begins);
        }
        const bool bends = curve_->feature(a + length / 2, CurveSide::after) < length;
        const int between = bends ? stations_between : 1;
        for (int k = 1; k <= between; ++k) {
            const double s = k == between ? breaks_[i + 1] : a + length * k / between, gap = length / between;
            double least = std::min({largest, length, curve_->feature(s, CurveSide::before)});
            if (bends)  // a narrow place between two stations
                for (const double part : {0.2, 0.4, 0.6, 0.8}) least = std::min(least, curve_->feature(s - part * gap, CurveSide::after));
            sizes_.back() = std::min(sizes_.back(), std::max(least, sizes_.back() / 16));
            stations_.push_back(s);
            sizes_.push_back(least);
        }
    }
}

/// The size of a cell at s, which lies behind stations_[station] (moved on as far as needed).
double RunPlanner::size_at(double s, std::size_t& station) const {
    while (station + 2 < stations_.size() && stations_[station + 1] <= s) ++station;
    const double before = sizes_[station] + growth * (s - stations_[station]),
                 behind = sizes_[station + 1] + growth * (stations_[station + 1] - s);
    // On a line as the neighbours allow it to grow; where it bends, not beyond what both places say.
    const double straight = std::min({before, behind, (stations_.back() - stations_.front()) / most_of_run});
    return curve_->feature(s, CurveSide::after) < infinite ? std::min(straight, std::max(sizes_[station], sizes_[station + 1])) : straight;
}

/// Cells follow the curve and grow away from where they are small; towards rest they shrink with the distance, as v2 ~ s^(4/3) there.
void RunPlanner::make_nodes(const RunTask& task) {
    add_breaks(task);
    const double whole = task.to - task.from;
    const auto rest_length = [&](double at, CurveSide side, double room) {
        const AlongLimits l = along_limits(curve_->at(at, side), limits_, task.velocity_factor);
        double way = whole / 12;  // a motion of jerk alone turns from speeding up to less of it there
        const double a = std::min(l.acceleration, l.deceleration);
        way = std::min(way, a * a * a / (6 * l.jerk * l.jerk));
        way = std::min(way, std::sqrt(l.velocity / l.jerk) * l.velocity / 6);
        return std::min(rest_share * way, room / 3);
    };
    const bool from_rest = task.velocity <= 0;
    start_ = {};
    end_ = {};
    if (from_rest) start_.rest_length = rest_length(task.from, CurveSide::after, breaks_[1] - breaks_[0]);
    else start_ = {0, task.velocity * task.velocity, 2 * task.acceleration};
    end_.rest_length = rest_length(task.to, CurveSide::before, breaks_.back() - breaks_[breaks_.size() - 2]);

    add_stations(whole / most_of_run);
    // A quadratic with this beginning has to stay positive over the first cell.
    if (!from_rest && start_.slope < 0) sizes_.front() = std::min(sizes_.front(), 0.7 * start_.square / -start_.slope);
    if (from_rest) sizes_.front() = std::min(sizes_.front(), growth * start_.rest_length);
    sizes_.back() = std::min(sizes_.back(), growth * end_.rest_length);
    const std::size_t last = stations_.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) sizes_[i] = std::min(sizes_[i], sizes_[i - 1] + growth * (stations_[i] - stations_[i - 1]));
    for (std::size_t i = last; i-- > 0;) sizes_[i] = std::min(sizes_[i], sizes_[i + 1] + growth * (stations_[i + 1] - stations_[i]));

    nodes_.clear();
    std::size_t station = 0;
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
        double a = breaks_[i], b = breaks_[i + 1];
        if (i == 0) a += start_.rest_length;
        if (i + 2 == breaks_.size()) b -= end_.rest_length;
        const std::size_t first = nodes_.size();
        double s = a;
        while (s < b - 1e-9 * (b - a)) {
            nodes_.push_back(s);
            const double step = size_at(s, station);
            std::size_t ahead = station;
            s += std::min(step, size_at(std::min(s + step, b), ahead));
        }
        const double shrink = (b - a) / (s - a);
        for (std::size_t k = first + 1; k < nodes_.size(); ++k) nodes_[k] = a + (nodes_[k] - a) * shrink;
    }
    nodes_.push_back(task.to - end_.rest_length);
}

/// The greatest v2 at the moving end of a piece at constant jerk from rest (or to rest) over `length`: velocity, acceleration and jerk on it
/// grow with the powers 1/2, 1 and 3/2 of it, so one motion says it for all.
double RunPlanner::rest_square(double at, double length, bool begins, double velocity_factor) const {
    LimitUse use;
    constexpr int samples = 24;
    for (int i = 0; i <= samples; ++i) {
        const double time = static_cast<double>(i) / samples, x = time * time * time;
        const double s = begins ? at + x * length : at - x * length;
        const double sign = begins ? 1 : -1;
        const PathMotion m{s, time * time, sign * 2 / (3 * length) * time, 2 / (9 * length * length)};
        use.widen(limit_use(curve_->at(s, begins ? CurveSide::after : CurveSide::before), limits_, velocity_factor, m));
    }
    // Between the samples, where the curve bends.
    const double margin = curve_->feature(at, begins ? CurveSide::after : CurveSide::before) < infinite ? 1 - 3e-3 : 1 - 1e-4;
    return margin * std::min({1 / (use.velocity * use.velocity), 1 / use.acceleration, 1 / two_thirds(use.jerk)});
}

void RunPlanner::add_cell(int cell, const RunTask& task) {
    const auto c = static_cast<std::size_t>(cell);
    const double begin = nodes_[c], length = nodes_[c + 1] - begin;
    const CellLimits own = cell_limits_[c];
    for (int k = 0; k <= 2; ++k) {
        const double x = 0.5 * k;
        const TimedCurvePoint p = curve_->at(k == 2 ? nodes_[c + 1] : begin + x * length, k == 2 ? CurveSide::before : CurveSide::after);
        problem_.add_point({cell, x, length * (k == 1 ? 4 : 1) / 6});
        // With the end of the cell before, unless something jumps here.
        // The state at the beginning, and with it the middle of the first cell, are as they are.
        const bool given = cell == 0 && k == 0 && start_.rest_length <= 0, given_middle = cell == 0 && k == 1 && start_.rest_length <= 0;
        const bool shared = given || (k == 0 && cell > 0 && !std::binary_search(breaks_.begin(), breaks_.end(), begin));
        const AlongLimits l = along_limits(p, limits_, hard_factor(task));
        const std::size_t beside =
            k == 0 ? std::max<std::size_t>(c, 1) - 1 : std::min(c + static_cast<std::size_t>(k) / 2, cell_limits_.size() - 1);
        const CellLimits& other = cell_limits_[beside];
        const CellLimits share{std::min(own.velocity, other.velocity), std::min(own.acceleration, other.acceleration),
                               std::min(own.jerk, other.jerk)};
        if (!shared) {
            // Above a lowered velocity factor a moving beginning may be; it is left as soon as the limits allow.
            const bool soft = start_.rest_length <= 0 && task.velocity_factor < 1;
            if (soft) {
                const double wanted = p.path.velocity * task.velocity_factor;
                if (wanted < infinite) problem_.add_soft_cap(wanted * wanted);
            }
            double cap = l.velocity * share.velocity;
            cap *= cap;
            if (cell == 0 && k == 0 && start_.rest_length > 0)
                cap = std::min(cap, rest_square(task.from, start_.rest_length, true, hard_factor(task)));
            if (cell + 1 == problem_.cells() && k == 2)
                cap = std::min(cap, rest_square(task.to, end_.rest_length, false, hard_factor(task)));
            // The middle as Bernstein's coefficient: what it may be, v2 on the cell may be.
            if (cap < infinite && !given_middle) k == 1 ? problem_.add_cap_on_middle(cap) : problem_.add_cap(cap);
        }
        double bent = 0;  // how much of the limits the curvature takes
        for (std::size_t i = 0; i < limits_.size(); ++i)
            bent = std::max({bent, std::fabs(p.second[i]) * length / std::max(std::fabs(p.first[i]), 1e-9),
                             std::fabs(p.third[i]) * length * length / std::max(std::fabs(p.first[i]), 1e-9)});
        if (bent < 1e-9) {  // straight: one row says what all axes say
            if (!shared && l.acceleration < infinite) {
                const double a = l.acceleration * share.acceleration;
                problem_.add_acceleration({0, 0.5 / a, 0, 1, l.deceleration / l.acceleration});
            }
            if (k != 1 && l.jerk < infinite) problem_.add_jerk({0, 0, 0.5 / (l.jerk * share.jerk), 1, 1});
            continue;
        }
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            const double a = limits_[i].acceleration * share.acceleration, j = limits_[i].jerk * share.jerk;
            if (!shared) problem_.add_acceleration({p.second[i] / a, 0.5 * p.first[i] / a, 0, 1, 1});
            problem_.add_jerk({p.third[i] / j, 1.5 * p.second[i] / j, 0.5 * p.first[i] / j, 1, 1});
        }
        if (!shared && p.path.acceleration < infinite)
            problem_.add_acceleration(
                {0, 0.5 / (p.path.acceleration * share.acceleration), 0, 1, p.path.deceleration / p.path.acceleration});
        if (p.path.jerk < infinite) problem_.add_jerk({0, 0, 0.5 / (p.path.jerk * share.jerk), 1, 1});
    }
}

void RunPlanner::make_problem(const RunTask& task) {
    problem_.begin(nodes_, start_, end_);
    for (int i = 0; i < problem_.cells(); ++i) add_cell(i, task);
}

/// Velocities without jerk, from both ends, lowered: a beginning from which the limits can be left alone.
void RunPlanner::first_guess(const RunTask& task) {
    const std::size_t n = nodes_.size() - 1;
    middles_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const double s = (nodes_[i] + nodes_[i + 1]) / 2;
        const TimedCurvePoint p = curve_->at(s, CurveSide::after);
        const AlongLimits l = along_limits(p, limits_, task.velocity_factor);
        double cap = l.velocity * l.velocity;
        for (std::size_t k = 0; k < limits_.size(); ++k) {
            cap = std::min(cap, limits_[k].acceleration / std::max(std::fabs(p.second[k]), 1e-300));
            cap = std::min(cap, two_thirds(limits_[k].jerk / std::max(std::fabs(p.third[k]), 1e-300)));
        }
        // at constant jerk from rest: v^3 = 4.5 j s^2
        if (start_.rest_length > 0) cap = std::min(cap, two_thirds(4.5 * l.jerk * (s - task.from) * (s - task.from)));
        cap = std::min(cap, two_thirds(4.5 * l.jerk * (task.to - s) * (task.to - s)));
        const double before = i > 0 ? middles_[i - 1] : task.velocity * task.velocity;
        const double way = i > 0 ? (nodes_[i + 1] - nodes_[i - 1]) / 2 : (nodes_[1] - nodes_[0]) / 2 + start_.rest_length;
        cap = std::min(cap, before + 1.6 * l.acceleration * way);
        middles_[i] = cap;
    }
    for (std::size_t i = n; i-- > 0;) {
        const double s = (nodes_[i] + nodes_[i + 1]) / 2;
        const AlongLimits l = along_limits(curve_->at(s, CurveSide::after), limits_, task.velocity_factor);
        const double behind = i + 1 < n ? middles_[i + 1] : 0;
        const double way = i + 1 < n ? (nodes_[i + 2] - nodes_[i]) / 2 : (nodes_[n] - nodes_[n - 1]) / 2 + end_.rest_length;
        middles_[i] = std::min(middles_[i], behind + 1.6 * l.deceleration * way);
    }
    for (double& m : middles_) m *= 0.5;
}

/// From a moving state: the cells of the former plan as long as it does not brake for its end for good, and its v2 as the first guess. Where
/// that comes near rest but the path goes on, a slow motion that keeps every limit goes on instead.
void RunPlanner::take_over(const RunTask& task, const RunShape& former) {
    const auto begin = std::lower_bound(former.nodes.begin(), former.nodes.end(), task.from - 1e-12 * std::fabs(task.to));
    const auto from = static_cast<std::size_t>(begin - former.nodes.begin());
    if (begin == former.nodes.end()) return;
    const bool same_end = std::fabs(task.to - former.end) < 1e-9 * (task.to - task.from);
    // Who comes to rest before the former end brakes from here on; else it is the former motion as far as that gets faster.
    const bool brakes = !same_end && task.to < former.end;
    std::size_t kept = former.nodes.size() - 1;
    if (!same_end) {
        while (kept > from && (brakes || former.squares[kept] <= former.squares[kept - 1] * (1 + 1e-9))) --kept;
    } else {
        end_.rest_length = task.to - former.nodes.back();
    }
    std::vector<double> nodes(former.nodes.begin() + static_cast<std::ptrdiff_t>(from),
                              former.nodes.begin() + static_cast<std::ptrdiff_t>(kept) + 1);
    nodes.front() = task.from;
    if (!same_end)
        for (const double node : nodes_)
            if (node > nodes.back() + 1e-9 * (task.to - task.from)) nodes.push_back(node);
    nodes_.swap(nodes);
    cell_limits_.assign(nodes_.size() - 1, untouched);

    // Slow enough for everything, as from rest.
    first_guess(task);
    const double goes_on = former.nodes[kept], peak = former.squares[kept];
    std::size_t cell = from;
    const auto former_square = [&](double s) {
        while (cell + 1 < former.middles.size() && former.nodes[cell + 1] < s) ++cell;
        if (s > former.nodes.back() + 1e-12 * std::fabs(task.to)) return 0.0;
        const double x = (s - former.nodes[cell]) / (former.nodes[cell + 1] - former.nodes[cell]), y = 1 - x;
        return y * y * former.squares[cell] + 2 * x * y * former.middles[cell] + x * x * former.squares[cell + 1];
    };
    // Braking without a jump of the acceleration: it begins with what there is and ends as at constant jerk, and is never faster than the former motion.
    const auto braked_square = [&](double s) {
        const double way = task.to - task.from, x = std::clamp((s - task.from) / way, 0.0, 1.0), y = 1 - x;
        const double begun = task.velocity * task.velocity + 2 * task.acceleration * way * x * y * y;
        return std::min(former_square(s), begun * two_thirds(y * y * (1 + 2 * x)));
    };
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
        if (brakes) {
            const double first = braked_square(nodes_[i]), middle = braked_square((nodes_[i] + nodes_[i + 1]) / 2),
                         last = braked_square(nodes_[i + 1]);
            middles_[i] = std::max(2 * middle - (first + last) / 2, slow_share * middles_[i]);
            continue;
        }
        const double first = former_square(nodes_[i]), middle = former_square((nodes_[i] + nodes_[i + 1]) / 2),
                     last = former_square(nodes_[i + 1]);
        const double taken = 2 * middle - (first + last) / 2;
        // Where the former plan brakes for its end, this one goes on.
        middles_[i] =
            same_end || nodes_[i + 1] <= goes_on ? std::max(taken, slow_share * middles_[i]) : std::min(peak, on_share * middles_[i]);
    }
}

LimitUse RunPlanner::use_of_cell(int cell, const RunTask& task) const {
    const auto c = static_cast<std::size_t>(cell);
    const double begin = nodes_[c], length = nodes_[c + 1] - begin;
    const double first = problem_.node(cell, middles_), middle = middles_[c], last = problem_.node(cell + 1, middles_);
    PeakUse peaks(limits_.size());
    for (int k = 0; k <= verified_points; ++k) {
        const double x = static_cast<double>(k) / verified_points, y = 1 - x;
        const double square = y * y * first + 2 * x * y * middle + x * x * last;
        PathMotion m;
        m.s = k == verified_points ? nodes_[c + 1] : begin + x * length;
        m.velocity = std::sqrt(square);
        m.acceleration = (y * (middle - first) + x * (last - middle)) / length;
        m.jerk = (first - 2 * middle + last) / (length * length) * m.velocity;
        peaks.look(curve_->at(m.s, k == verified_points ? CurveSide::before : CurveSide::after), limits_, hard_factor(task), m);
    }
    return peaks.use();
}

LimitUse RunPlanner::verify(const RunTask& task, int round) {
    LimitUse whole;
    split_.clear();
    for (int i = 0; i < problem_.cells(); ++i) {
        const LimitUse use = use_of_cell(i, task);
        whole.widen(use);
        CellLimits& share = cell_limits_[static_cast<std::size_t>(i)];
        constexpr double beyond = 1 + 1e-4;
        if (use.inside()) continue;
        if (use.velocity > 1 - 2e-6) share.velocity /= use.velocity * beyond;
        if (use.acceleration > 1 - 2e-6) share.acceleration /= use.acceleration * beyond;
        if (use.jerk > 1) share.jerk /= use.jerk * beyond;
        if (std::max({use.velocity, use.acceleration, use.jerk}) > (round > 2 ? 1.002 : 1.02))
            split_.push_back(static_cast<std::size_t>(i));
    }
    return whole;
}

/// Halves the cells of split_: the same v2, with one more coefficient for each.
void RunPlanner::split_cells() {
    if (split_.empty()) return;
    std::vector<double> nodes, middles;
    std::vector<CellLimits> limits;
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
        nodes.push_back(nodes_[i]);
        if (next < split_.size() && split_[next] == i) {
            ++next;
            const double first = problem_.node(static_cast<int>(i), middles_), last = problem_.node(static_cast<int>(i) + 1, middles_);
            nodes.push_back((nodes_[i] + nodes_[i + 1]) / 2);
            middles.push_back((first + middles_[i]) / 2);
            middles.push_back((middles_[i] + last) / 2);
            limits.insert(limits.end(), 2, cell_limits_[i]);
        } else {
            middles.push_back(middles_[i]);
            limits.push_back(cell_limits_[i]);
        }
    }
    nodes.push_back(nodes_.back());
    nodes_.swap(nodes);
    middles_.swap(middles);
    cell_limits_.swap(limits);
}

/// What is left above a limit after all rounds is a matter of some cells; all are slowed down for it: from rest v2 may be scaled.
void RunPlanner::slow_down(const LimitUse& use) {
    constexpr double margin = 1 - 1e-5;
    const double share = margin * std::min({1.0, 1 / (use.velocity * use.velocity), 1 / use.acceleration, 1 / two_thirds(use.jerk)});
    for (double& middle : middles_) middle *= share;
}

void RunPlanner::make_pieces(RunPlan& out) {
    out.pieces.clear();
    double time = 0;
    const auto add = [&](TimePiece p) {
        p.begin_time = time;
        p.part = curve_->part_at(p.begin + p.length / 2);
        time += p.duration;
        out.pieces.push_back(p);
    };
    const int n = problem_.cells();
    if (start_.rest_length > 0)
        add(TimePiece::rest(TimePiece::Kind::from_rest, nodes_[0] - start_.rest_length, start_.rest_length, problem_.node(0, middles_)));
    for (int i = 0; i < n; ++i) {
        const auto c = static_cast<std::size_t>(i);
        add(TimePiece::moving(nodes_[c], nodes_[c + 1] - nodes_[c], problem_.node(i, middles_), middles_[c],
                              problem_.node(i + 1, middles_)));
    }
    add(TimePiece::rest(TimePiece::Kind::to_rest, nodes_.back(), end_.rest_length, problem_.node(n, middles_)));
    out.duration = time;
    out.shape.end = nodes_.back() + end_.rest_length;
    out.shape.nodes = nodes_;
    out.shape.middles = middles_;
    out.shape.squares.clear();
    for (int i = 0; i <= n; ++i) out.shape.squares.push_back(problem_.node(i, middles_));
}

void RunPlanner::plan(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, RunPlan& out,
                      const RunShape* former) {
    curve_ = &curve;
    limits_ = limits;
    out.found = false;
    out.steps = out.rounds = 0;
    make_nodes(task);
    out.cells = static_cast<int>(nodes_.size()) - 1;
    cell_limits_.assign(nodes_.size() - 1, untouched);
    if (former != nullptr && start_.rest_length <= 0) take_over(task, *former);
    else first_guess(task);
    while (out.rounds < rounds_at_most && !out.found) {
        ++out.rounds;
        make_problem(task);
        const SpeedOutcome outcome = problem_.solve(middles_, SpeedGoal::fastest, out.rounds == 1 ? SpeedGuess::rough : SpeedGuess::near);
        out.steps += outcome.steps;
        if (!outcome.feasible) {
            out.use = verify(task, out.rounds);
            break;
        }
        out.use = verify(task, out.rounds);
        out.found = out.use.inside();
        if (!out.found && out.rounds < rounds_at_most) split_cells();
    }
    out.cells = static_cast<int>(nodes_.size()) - 1;
    if (!out.found && start_.rest_length > 0 && out.use.velocity > 0) {
        slow_down(out.use);
        out.use = verify(task, out.rounds);
        out.found = out.use.inside();
    }
    make_pieces(out);
}

}  // namespace taktwerk::axes

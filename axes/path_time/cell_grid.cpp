#include "axes/path_time/cell_grid.hpp"

#include <algorithm>
#include <cmath>

#include "axes/path_time/along_limits.hpp"

namespace taktwerk::axes {
namespace {

constexpr double growth = 0.25;      // of a cell's size per way from a smaller one
constexpr int deepest = 12;          // halvings of a cell
constexpr int probes = 15;           // for a narrow place in a span
constexpr int stations_between = 8;  // of a span that bends
// A cell is at most this part of a run; of one where it bends; of one of many spans.
constexpr int most_of_run = 72, most_of_bent_run = 144, most_of_coarse_run = 24;
constexpr std::size_t most_cells = 200'000;  // a run that asks for more is not planned
// Of the way in which a deceleration comes or goes, that cells at its ends are long; and the least part of a run that they are.
constexpr double corner_share = 0.25, shortest_corner = 2.5e-8;
// Of v2, that the first cell behind a state of motion with a lowered velocity may rise.
constexpr double least_rise = 2e-4, most_rise = 0.02;
constexpr double cells_of_braking = 40;  // to a lowered velocity
// Cells per feature of the curve: a run of many spans is planned more coarsely (which costs it half a percent of its time).
constexpr std::size_t long_run = 64;
constexpr double fewer = 2.7;
// A run of few spans costs little however finely it is planned.
constexpr std::size_t short_run = 24;
constexpr double more = 0.4;

}  // namespace

void CellGrid::add_breaks(const RunTask& task) {
    breaks.clear();
    breaks.push_back(task.from);
    while (breaks.back() < task.to) {
        double next = std::min(curve_->next_break(breaks.back()), task.to);
        const double brakes_to = task.from + task.brake_way, gap = 0.1 * task.brake_way;
        if (breaks.back() < brakes_to - gap && brakes_to + gap < next) next = brakes_to;
        // A sliver would be a cell of no length.
        if (next - breaks.back() < 1e-12 * (std::fabs(task.to) + 1e-300) || (task.to - next < 1e-9 * (task.to - task.from))) {
            breaks.push_back(task.to);
            break;
        }
        breaks.push_back(next);
    }
}

/// Places with the size of cells there: all breaks, and some between them where the curve bends.
void CellGrid::add_stations(double largest_of_run, double brake_way) {
    stations_.clear();
    sizes_.clear();
    bends_.clear();
    const double fineness = coarse ? fewer : breaks.size() > short_run ? 1 : more;
    const auto feature = [&](double s, CurveSide side) { return fineness * curve_->feature(s, side); };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const double a = breaks[i], length = breaks[i + 1] - a;
        const bool brakes = a < breaks.front() + 0.95 * brake_way;
        const double largest = brakes ? std::min(largest_of_run, brake_way / cells_of_braking) : largest_of_run;
        const double middle = feature(a + length / 2, CurveSide::after);
        const double begins = std::min({largest, length, feature(a, CurveSide::after)});
        if (i == 0) {
            stations_.push_back(a);
            sizes_.push_back(begins);
        } else {
            sizes_.back() = std::min(sizes_.back(), begins);
        }
        // Where it bends much, narrow places are looked for between the stations as well.
        double narrowest = middle;
        if (middle < length)
            for (int k = 1; k < probes; ++k) narrowest = std::min(narrowest, feature(a + length * k / probes, CurveSide::after));
        const bool sharp = narrowest < length / 8;
        const int between = middle < length ? (sharp ? 2 * stations_between : stations_between) : 1;
        for (int k = 1; k <= between; ++k) {
            const double s = k == between ? breaks[i + 1] : a + length * k / between, gap = length / between;
            double least = std::min({largest, length, feature(s, CurveSide::before)});
            if (sharp)
                for (const double part : {0.2, 0.4, 0.6, 0.8}) least = std::min(least, feature(s - part * gap, CurveSide::after));
            else if (between > 1) least = std::min(least, feature(s - 0.5 * gap, CurveSide::after));
            sizes_.back() = std::min(sizes_.back(), std::max(least, sizes_.back() / 16));
            bends_.push_back(between > 1 || brakes ? Bends::much : middle < unlimited ? Bends::little : Bends::not_at_all);
            stations_.push_back(s);
            sizes_.push_back(least);
        }
    }
}

/// The size of a cell at s, which lies behind stations_[station] (moved on as far as needed).
double CellGrid::size_at(double s, std::size_t& station) const {
    while (station + 2 < stations_.size() && stations_[station + 1] <= s) ++station;
    const double before = sizes_[station] + growth * (s - stations_[station]),
                 behind = sizes_[station + 1] + growth * (stations_[station + 1] - s);
    // On a line, or one that bends little over all of it, as the neighbours allow it to grow; else not beyond what both places say.
    const double whole = stations_.back() - stations_.front();
    const double straight = std::min({before, behind,
                                      whole / (coarse                                 ? most_of_coarse_run
                                               : bends_[station] == Bends::not_at_all ? most_of_run
                                                                                      : most_of_bent_run)});
    return bends_[station] == Bends::much ? std::min(straight, std::max(sizes_[station], sizes_[station + 1])) : straight;
}

void CellGrid::make(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, Grain grain) {
    curve_ = &curve;
    add_breaks(task);
    coarse = grain == Grain::coarse || breaks.size() > long_run;
    const double whole = task.to - task.from;
    const bool from_rest = task.velocity <= 0;
    start = {};
    end = {};
    RestRun run{task.from, task.to, task.velocity_factor, task.halt_share > 0};
    if (from_rest) start.rest_length = rest_.length(curve, limits, run, CurveSide::after, breaks[1] - breaks[0]);
    else start = {0, task.velocity * task.velocity, 2 * task.acceleration};
    end.rest_length = rest_.length(curve, limits, run, CurveSide::before, breaks.back() - breaks[breaks.size() - 2]);

    add_stations(whole / (coarse ? most_of_coarse_run : most_of_run), task.brake_way);
    if (task.halt_share > 0 || task.brake_way > 0) add_corners_of_halt(task);
    // A quadratic with this beginning has to stay positive over the first cell.
    if (!from_rest && start.slope < 0) sizes_.front() = std::min(sizes_.front(), 0.7 * start.square / -start.slope);
    // Nor may it carry one who is below a lowered velocity above it: its middle is given by the slope.
    if (start.slope > 0 && task.velocity_factor < 1 && task.brake_way <= 0) {
        const double wanted = task.velocity_factor * curve.at(task.from, CurveSide::after).path.velocity;
        const double room = wanted * wanted - start.square;
        sizes_.front() = std::min(sizes_.front(), std::clamp(room, least_rise * start.square, most_rise * start.square) / start.slope);
    }
    if (from_rest) sizes_.front() = std::min(sizes_.front(), growth * start.rest_length);
    sizes_.back() = std::min(sizes_.back(), growth * end.rest_length);
    add_nodes();
}

/// A halt, or braking to a lowered velocity, bends v2(s) where its jerk begins and where it ends: in ways that may be ever so short beside the whole one.
void CellGrid::add_corners_of_halt(const RunTask& task) {
    const auto add = [&](double s, double size) {
        const auto behind = std::upper_bound(stations_.begin(), stations_.end(), s);
        const auto i = behind - stations_.begin();
        if (i == 0) return;  // in front of the run: it has less left to brake than its last ramp takes
        if (behind != stations_.end() && s > stations_[static_cast<std::size_t>(i) - 1]) {
            stations_.insert(behind, s);
            sizes_.insert(sizes_.begin() + i, size);
            bends_.insert(bends_.begin() + i, bends_[static_cast<std::size_t>(i) - 1]);
        } else {
            double& before = sizes_[static_cast<std::size_t>(i) - 1];
            before = std::min(before, size);
        }
    };
    const auto corner = [&](double s, double way) { add(s, std::max(corner_share * way, shortest_corner * (task.to - task.from))); };
    // Between its ends they grow.
    if (task.brake_way > 0) add(task.from + task.brake_way / 2, task.brake_way / cells_of_braking);
    corner(task.from, task.halt_ramp);
    corner(task.from + task.halt_ramp, task.halt_ramp);
    corner((task.halt_share > 0 ? task.to : task.from + task.brake_way) - task.halt_last, task.halt_last);
}

/// Cells in whose ends the curve bends more sharply than at any station are halved until they fit.
void CellGrid::split_at_narrow_places() {
    std::vector<double> split;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        split.push_back(nodes[i]);
        for (int depth = 0; depth < deepest && too_long(split.back(), nodes[i + 1]);) {
            double to = nodes[i + 1];
            for (; depth < deepest && too_long(split.back(), to); ++depth) to = (split.back() + to) / 2;
            split.push_back(to);
        }
    }
    split.push_back(nodes.back());
    nodes.swap(split);
}

bool CellGrid::too_long(double a, double b) const {
    constexpr double inside = 0.03, features = 8;  // where in a cell is looked, and how many of them it may be long
    const double length = b - a;
    double least = unlimited;
    for (const double part : {inside, 0.5, 1 - inside}) least = std::min(least, curve_->feature(a + part * length, CurveSide::after));
    return length > features * least;
}

void CellGrid::add_nodes() {
    const std::size_t last = stations_.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) sizes_[i] = std::min(sizes_[i], sizes_[i - 1] + growth * (stations_[i] - stations_[i - 1]));
    for (std::size_t i = last; i-- > 0;) sizes_[i] = std::min(sizes_[i], sizes_[i + 1] + growth * (stations_[i + 1] - stations_[i]));
    nodes.clear();
    std::size_t station = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        double a = breaks[i], b = breaks[i + 1];
        if (i == 0) a += start.rest_length;
        if (i + 2 == breaks.size()) b -= end.rest_length;
        const std::size_t first = nodes.size();
        double s = a;
        while (s < b - 1e-9 * (b - a) && nodes.size() < most_cells) {
            nodes.push_back(s);
            const double step = size_at(s, station);
            std::size_t ahead = station;
            s += std::min(step, size_at(std::min(s + step, b), ahead));
        }
        const double shrink = (b - a) / (s - a);
        for (std::size_t k = first + 1; k < nodes.size(); ++k) nodes[k] = a + (nodes[k] - a) * shrink;
    }
    nodes.push_back(breaks.back() - end.rest_length);
    split_at_narrow_places();
    // To the last bit, so that no piece ends behind the run.
    end.rest_length = breaks.back() - nodes.back();
    if (start.rest_length > 0) start.rest_length = nodes.front() - breaks.front();
}

}  // namespace taktwerk::axes

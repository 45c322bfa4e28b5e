#pragma once
// The least time along a curve under every limit, jerk among them, by a method that shares nothing with the planner's: b = v^2 at the places of a
// fine grid, finite differences for b' and b'' instead of splines, each limit as it stands (no tangent to that of jerk), and a barrier that is lowered
// step by step, from a motion so slow that it is inside of everything (Nocedal, Wright: Numerical Optimization, chapter 19). All iterates are feasible.
// The places are as s = u^3 (10 - 15 u + 6 u^2) of the way, as close as equal times are at rest; there b goes with s^(4/3), which no difference sees, so
// the first and the last cell, eight of those steps long, are at constant jerk. A place lies where q''' jumps, and keeps the limits of both sides: beside
// it a limit would show too late. Nothing stands still on the way: at b = 0 the jerk has no limit, and who is there leaves with any acceleration.
//
// How exact: LeastTime.TheOracleKnowsALine, where the optimum is known. The problem is not convex (the limit of jerk is not), so on a curve it is a least
// time near its beginnings, which differ.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

class LeastTimeOracle {
public:
    /// Which motion the search begins with: all of it as slow as its ends, or fast in its first or its second half.
    enum class Beginning { even, early, late };

    LeastTimeOracle(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double from, double to, int cells,
                    double velocity_factor = 1)
        : limits_(limits), cells_(static_cast<std::size_t>(cells)) {
        constexpr std::size_t at_rest = 8;
        const auto place = [&](std::size_t step) {
            const double u = static_cast<double>(step) / static_cast<double>(cells_ + 2 * (at_rest - 1));
            return from + (to - from) * u * u * u * (10 + u * (6 * u - 15));
        };
        places_.push_back(from);
        for (std::size_t i = 1; i < cells_; ++i) places_.push_back(place(i + at_rest - 1));
        places_.push_back(to);
        std::vector<bool> jumps(cells_ + 1, false);
        for (double s = curve.next_break(from); s < places_[cells_ - 1]; s = curve.next_break(s)) {
            const auto behind = static_cast<std::size_t>(std::upper_bound(places_.begin(), places_.end(), s) - places_.begin());
            const std::size_t nearest = places_[behind] - s < s - places_[behind - 1] ? behind : behind - 1;
            if (nearest < 2 || nearest + 2 > cells_) continue;
            places_[nearest] = s;
            jumps[nearest] = true;
        }
        for (std::size_t i = 1; i < cells_; ++i) {
            add_rows(curve.at(places_[i], CurveSide::after), i, velocity_factor);
            if (jumps[i]) add_rows(curve.at(places_[i], CurveSide::before), i, velocity_factor);
        }
        add_rest(curve.at(from, CurveSide::after), 1, places_[1] - from);
        add_rest(curve.at(to, CurveSide::before), cells_ - 1, to - places_[cells_ - 1]);
    }

    /// Seconds from rest to rest.
    double solve(Beginning beginning = Beginning::even) {
        begin(beginning);
        for (std::size_t i = 1; i < cells_; ++i) rows_.push_back({i, {0, -1, 0}, -slowest * b_[i], false});
        const auto sides = static_cast<double>(rows_.size());
        constexpr double last = 1e-5, lower = 0.25;  // what the barrier costs of the time; by how much it is lowered
        // A search that comes too near to many limits at once goes on in small steps: it is led back between them, and does it again.
        double before = 2 * time(b_);
        for (int round = 0; round < 8 && time(b_) < before * (1 - 1e-4); ++round) {
            before = time(b_);
            for (double mu = (round == 0 ? 1 : 0.1) * before / sides; mu * sides > last * time(b_); mu *= lower)
                for (int i = 0; i < 100 && step(mu) > 1e-2 * mu * sides; ++i) {}
        }
        return time(b_);
    }
    /// Newton steps so far.
    [[nodiscard]] int steps() const { return steps_; }
    /// The greatest use of a limit at the places: below 1, or it is no motion.
    [[nodiscard]] double most_used() const {
        double most = 0;
        for (const Row& r : rows_)
            if (r.limit > 0) most = std::max(most, 1 - slack(r, b_) / limit_at(r, b_));
        return most;
    }
    /// The least b of all places, in parts of the least that is allowed: near 1 a motion stands still somewhere, and is none.
    [[nodiscard]] double slowest_place() const {
        double least = INFINITY;
        for (const Row& r : rows_)
            if (r.limit < 0) least = std::min(least, b_[r.place] / -r.limit);
        return least;
    }

private:
    static constexpr double slowest = 0.25;  // of b of the motion that the search begins with

    /// g . (b of the place before, here, behind) <= limit, or <= limit / sqrt(b here). Negative: of what is at least.
    struct Row {
        std::size_t place;
        std::array<double, 3> g;
        double limit;
        bool of_jerk;
    };

    void add_rows(const TimedCurvePoint& p, std::size_t i, double velocity_factor) {
        const double before = places_[i] - places_[i - 1], behind = places_[i + 1] - places_[i], both = before + behind;
        const std::array<double, 3> at{0, 1, 0};
        std::array<double, 3> slope{-behind / (before * both), (behind - before) / (before * behind), before / (behind * both)};
        std::array<double, 3> bend{2 / (before * both), -2 / (before * behind), 2 / (behind * both)};
        if (i == 1) {  // beside a piece at constant jerk: b' = 4 b/(3 s)
            slope = {0, 4 / (3 * before), 0};
            bend = {0, -2 / (behind * behind) - 8 / (3 * before * behind), 2 / (behind * behind)};
        } else if (i + 1 == cells_) {
            slope = {0, -4 / (3 * behind), 0};
            bend = {2 / (before * before), -2 / (before * before) - 8 / (3 * before * behind), 0};
        }
        const auto add = [&](double one, double two, double three, double above, double below, bool of_jerk) {
            Row up{i, {}, above, of_jerk}, down{i, {}, below, of_jerk};
            for (std::size_t k = 0; k < 3; ++k) {
                up.g[k] = one * at[k] + two * slope[k] + three * bend[k];
                down.g[k] = -up.g[k];
            }
            if (std::isfinite(above)) rows_.push_back(up);
            if (std::isfinite(below)) rows_.push_back(down);
        };
        double most = p.path.velocity * velocity_factor;
        for (std::size_t k = 0; k < limits_.size(); ++k)
            if (p.first[k] != 0) most = std::min(most, limits_[k].velocity / std::fabs(p.first[k]));
        rows_.push_back({i, at, most * most, false});
        add(0, 0.5, 0, p.path.acceleration, p.path.deceleration, false);
        add(0, 0, 0.5, p.path.jerk, p.path.jerk, true);
        for (std::size_t k = 0; k < limits_.size(); ++k) {
            add(p.second[k], 0.5 * p.first[k], 0, limits_[k].acceleration, limits_[k].acceleration, false);
            add(p.third[k], 1.5 * p.second[k], 0.5 * p.first[k], limits_[k].jerk, limits_[k].jerk, true);
        }
    }

    /// From rest at constant jerk over `length`: j = 2 b^(3/2)/(9 length^2).
    void add_rest(const TimedCurvePoint& p, std::size_t i, double length) {
        double jerk = p.path.jerk;
        for (std::size_t k = 0; k < limits_.size(); ++k)
            if (p.first[k] != 0) jerk = std::min(jerk, limits_[k].jerk / std::fabs(p.first[k]));
        rows_.push_back({i, {0, 1, 0}, std::pow(4.5 * jerk * length * length, 2.0 / 3), false});
    }

    [[nodiscard]] double limit_at(const Row& r, const std::vector<double>& b) const {
        return r.of_jerk ? r.limit / std::sqrt(b[r.place]) : r.limit;
    }
    [[nodiscard]] double slack(const Row& r, const std::vector<double>& b) const {
        return limit_at(r, b) - r.g[0] * b[r.place - 1] - r.g[1] * b[r.place] - r.g[2] * b[r.place + 1];
    }

    /// In the first and the last cell at constant jerk, 3 length/v; in the others at constant acceleration.
    [[nodiscard]] double time(const std::vector<double>& b) const {
        double sum =
            3 * (places_[1] - places_[0]) / std::sqrt(b[1]) + 3 * (places_[cells_] - places_[cells_ - 1]) / std::sqrt(b[cells_ - 1]);
        for (std::size_t i = 1; i + 1 < cells_; ++i) sum += 2 * (places_[i + 1] - places_[i]) / (std::sqrt(b[i]) + std::sqrt(b[i + 1]));
        return sum;
    }

    void begin(Beginning beginning) {
        b_.assign(cells_ + 1, 0);
        double size = 0;
        for (std::size_t i = 1; i < cells_; ++i) {
            const double x = (places_[i] - places_[0]) / (places_[cells_] - places_[0]);
            const double lean = beginning == Beginning::even    ? 1
                                : beginning == Beginning::early ? 1 + 8 * (1 - x) * (1 - x)
                                                                : 1 + 8 * x * x;
            b_[i] = lean * std::pow(x * (1 - x), 4.0 / 3);
            size = std::max(size, b_[i]);
        }
        const double scale = std::pow(places_[cells_] - places_[0], 2) / size;
        for (double& b : b_) b *= scale * 1e6;
        while (least_share(b_) < 0.3)
            for (double& b : b_) b *= 0.7;
    }
    /// Of its limit, that is left of the row of which least is left.
    [[nodiscard]] double least_share(const std::vector<double>& b) const {
        double least = 1;
        for (const Row& r : rows_) least = std::min(least, slack(r, b) / std::fabs(limit_at(r, b)));
        return least;
    }

    [[nodiscard]] double merit(const std::vector<double>& b, double mu) const {
        double sum = time(b);
        for (const Row& r : rows_) {
            const double left = slack(r, b);
            if (!(left > 0)) return INFINITY;
            sum -= mu * std::log(left);
        }
        return sum;
    }

    /// One step of Newton's method, whose matrix leaves out what the limit of jerk has of a negative curvature. What it promised.
    double step(double mu) {
        ++steps_;
        const std::size_t n = cells_ + 1;
        diagonal_.assign(n, 0), next_.assign(n, 0), second_.assign(n, 0), right_.assign(n, 0);
        for (std::size_t i = 1; i + 1 < cells_; ++i) {
            const double h = places_[i + 1] - places_[i], x = std::sqrt(b_[i]), y = std::sqrt(b_[i + 1]), sum = x + y;
            right_[i] += h / (sum * sum * x);
            right_[i + 1] += h / (sum * sum * y);
            diagonal_[i] += h / (sum * sum * x * x) * (1 / sum + 0.5 / x);
            diagonal_[i + 1] += h / (sum * sum * y * y) * (1 / sum + 0.5 / y);
            next_[i] += h / (sum * sum * sum * x * y);
        }
        for (const std::size_t i : {std::size_t{1}, cells_ - 1}) {
            const double h = i == 1 ? places_[1] - places_[0] : places_[cells_] - places_[cells_ - 1];
            right_[i] += 1.5 * h / std::pow(b_[i], 1.5);
            diagonal_[i] += 2.25 * h / std::pow(b_[i], 2.5);
        }
        for (const Row& r : rows_) {
            const double over = 1 / slack(r, b_), weight = mu * over * over;
            std::array<double, 3> g = r.g;  // of what is used: minus that of what is left
            if (r.of_jerk) g[1] += 0.5 * r.limit / (b_[r.place] * std::sqrt(b_[r.place]));
            const std::size_t i = r.place;
            for (std::size_t k = 0; k < 3; ++k) right_[i + k - 1] -= mu * over * g[k];
            diagonal_[i - 1] += weight * g[0] * g[0];
            diagonal_[i] += weight * g[1] * g[1];
            diagonal_[i + 1] += weight * g[2] * g[2];
            next_[i - 1] += weight * g[0] * g[1];
            next_[i] += weight * g[1] * g[2];
            second_[i - 1] += weight * g[0] * g[2];
        }
        const double promised = solve_band();
        double most = 1;
        for (std::size_t i = 1; i < cells_; ++i)
            if (right_[i] < 0) most = std::min(most, -0.9 * b_[i] / right_[i]);
        const double now = merit(b_, mu);
        std::vector<double> then(n, 0);
        for (double share = most; share > 1e-10; share *= 0.6) {
            for (std::size_t i = 1; i < cells_; ++i) then[i] = b_[i] + share * right_[i];
            if (merit(then, mu) <= now - 1e-4 * share * promised) {
                b_.swap(then);
                return promised;
            }
        }
        return 0;
    }

    /// L D L^T of five diagonals; the ends of the motion stay. The step replaces right_; how much of the merit it promises comes back.
    double solve_band() {
        double promised = 0;
        for (std::size_t i = 1; i < cells_; ++i) {
            const double one = next_[i] / diagonal_[i], two = second_[i] / diagonal_[i];
            diagonal_[i + 1] -= one * next_[i];
            next_[i + 1] -= one * second_[i];
            if (i + 2 <= cells_) {
                diagonal_[i + 2] -= two * second_[i];
                right_[i + 2] -= two * right_[i];
            }
            right_[i + 1] -= one * right_[i];
            promised += right_[i] * right_[i] / diagonal_[i];
        }
        right_[cells_] = 0;
        double behind = 0, beyond = 0;
        for (std::size_t i = cells_; i-- > 1;) {
            right_[i] = (right_[i] - next_[i] * behind - second_[i] * beyond) / diagonal_[i];
            beyond = behind;
            behind = right_[i];
        }
        return promised;
    }

    std::span<const PathAxisLimits> limits_;
    std::size_t cells_;
    std::vector<double> places_, b_;
    std::vector<Row> rows_;
    std::vector<double> diagonal_, next_, second_, right_;
    int steps_ = 0;
};

}  // namespace taktwerk::axes

#pragma once
// A search for a motion that is faster than a plan, of another make than the planner and its oracle: neither splines nor differences of v^2, but a motion of constant jerk in time between
// fixed places of the path, which is integrated exactly. Its limits are rows at both ends of each piece, each with the curve of its own side, and in the middle; what is found is looked
// at far more finely (look()). Sequential linear programs, each solved by an interior-point method on a band; limits may be crossed on the way (so a beginning need not keep them).
//
// What it finds is feasible, so the least time is at most that; it says nothing about what it does not find.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/time_piece.hpp"

namespace taktwerk::axes {

/// Equations with eight diagonals on both sides, by elimination with pivots.
class BandEquations {
public:
    explicit BandEquations(std::size_t n) : n_(n), a_(n * width), pivot_(n) {}
    void clear() { std::fill(a_.begin(), a_.end(), 0.0); }
    [[nodiscard]] double& at(std::size_t row, std::size_t column) { return a_[row * width + (column + half - row)]; }
    void factor() {
        for (std::size_t i = 0; i < n_; ++i) {
            const std::size_t low = std::min(n_ - 1, i + half), right = std::min(n_ - 1, i + 2 * half);
            std::size_t p = i;
            for (std::size_t r = i + 1; r <= low; ++r)
                if (std::fabs(at(r, i)) > std::fabs(at(p, i))) p = r;
            pivot_[i] = p;
            if (p != i)
                for (std::size_t c = i; c <= right; ++c) std::swap(at(i, c), at(p, c));
            if (at(i, i) == 0) at(i, i) = 1e-300;
            for (std::size_t r = i + 1; r <= low; ++r) {
                const double f = at(r, i) / at(i, i);
                at(r, i) = f;
                if (f == 0) continue;
                for (std::size_t c = i + 1; c <= right; ++c) at(r, c) -= f * at(i, c);
            }
        }
    }
    void solve(std::vector<double>& x) {
        for (std::size_t i = 0; i < n_; ++i) {
            std::swap(x[i], x[pivot_[i]]);
            for (std::size_t r = i + 1; r <= std::min(n_ - 1, i + half); ++r) x[r] -= at(r, i) * x[i];
        }
        for (std::size_t i = n_; i-- > 0;) {
            for (std::size_t c = i + 1; c <= std::min(n_ - 1, i + 2 * half); ++c) x[i] -= at(i, c) * x[c];
            x[i] /= at(i, i);
        }
    }

private:
    static constexpr std::size_t half = 8, width = 3 * half + 1;
    std::size_t n_;
    std::vector<double> a_;
    std::vector<std::size_t> pivot_;
};

class ConstantJerkSearch {
public:
    using MotionAt = std::function<PathMotion(double)>;
    struct Problem {
        double from = 0, to = 0, velocity = 0, acceleration = 0;  ///< to rest
        double velocity_factor = 1;
        std::function<double(double)> cap{};  ///< of v by s, instead of the path's own velocity limit
    };
    struct Looked {
        double velocity = 0, acceleration = 0, jerk = 0, gap = 0;  ///< parts of the limits; by how much pieces do not meet, relative
        double velocity_at = 0, acceleration_at = 0, jerk_at = 0;
        [[nodiscard]] double most() const { return std::max({velocity, acceleration, jerk}); }
    };

    ConstantJerkSearch(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const Problem& problem)
        : curve_(curve), limits_(limits.begin(), limits.end()), problem_(problem) {}

    /// About so many pieces, from break to break of the curve: some by time, some by what the acceleration changes, some for each part between breaks.
    void begin(const MotionAt& motion, double duration, int cells) {
        std::vector<double> breaks{0}, places{problem_.from};  // in time; on the curve
        for (double b = curve_.next_break(problem_.from); b < problem_.to * (1 - 1e-12); b = curve_.next_break(b)) {
            if (b <= problem_.from + 1e-9 * (problem_.to - problem_.from)) continue;
            double low = breaks.back(), high = duration;
            for (int i = 0; i < 200; ++i) (motion((low + high) / 2).s < b ? low : high) = (low + high) / 2;
            breaks.push_back((low + high) / 2);
            places.push_back(b);
        }
        breaks.push_back(duration);
        places.push_back(problem_.to);
        constexpr int samples = 300;
        const std::size_t parts = breaks.size() - 1;
        std::vector<std::array<double, samples>> shares(parts);
        double changes = 1e-300;
        const auto change = [&](std::size_t p, int i) {
            const double dt = (breaks[p + 1] - breaks[p]) / samples;
            return std::fabs(motion(breaks[p] + dt * (i + 1)).acceleration - motion(breaks[p] + dt * i).acceleration);
        };
        for (std::size_t p = 0; p < parts; ++p)
            for (int i = 0; i < samples; ++i) changes += shares[p][static_cast<std::size_t>(i)] = change(p, i);
        std::vector<double> times{0};
        std::vector<std::size_t> at_break{0};
        for (std::size_t p = 0; p < parts; ++p) {
            double whole = 0;
            for (double& share : shares[p])
                whole += share = 0.4 * share / changes + 0.35 * (breaks[p + 1] - breaks[p]) / duration / samples +
                                 0.25 / (samples * static_cast<double>(parts));
            const int count = std::max(4, static_cast<int>(whole * cells));
            double sum = 0;
            int next = 1;
            for (int i = 0; i < samples && next < count; ++i) {
                const double share = shares[p][static_cast<std::size_t>(i)];
                while (next < count && sum + share >= whole * next / count) {
                    times.push_back(breaks[p] + (breaks[p + 1] - breaks[p]) * (i + (whole * next / count - sum) / share) / samples);
                    ++next;
                }
                sum += share;
            }
            times.push_back(breaks[p + 1]);
            at_break.push_back(times.size() - 1);
        }
        const std::size_t n = times.size() - 1;
        s_.resize(n + 1);
        v_.resize(n + 1);
        a_.resize(n + 1);
        j_.resize(n);
        h_.resize(n);
        for (std::size_t k = 0; k <= n; ++k) {
            const PathMotion m = motion(times[k]);
            s_[k] = m.s;
            v_[k] = std::max(m.velocity, 0.0);
            a_[k] = m.acceleration;
        }
        for (std::size_t p = 0; p <= parts; ++p) s_[at_break[p]] = places[p];
        s_[0] = problem_.from;
        v_[0] = problem_.velocity;
        a_[0] = problem_.acceleration;
        s_[n] = problem_.to;
        v_[n] = a_[n] = 0;
        // Beside a break by no more than its last digit, but on its own side.
        for (std::size_t k = n; k-- > 0;) s_[k] = std::min(s_[k], s_[k + 1]);
        for (std::size_t k = 1; k <= n; ++k) s_[k] = std::max(s_[k], s_[k - 1]);
        for (std::size_t k = 0; k < n; ++k) {
            h_[k] = times[k + 1] - times[k];
            j_[k] = (a_[k + 1] - a_[k]) / h_[k];
        }
        spare_.assign(n, {0, 0, 0});
        first_.clear();
        end_.clear();
        for (std::size_t k = 0; k < n; ++k) {
            first_.push_back(curve_.at(s_[k], CurveSide::after));
            end_.push_back(curve_.at(s_[k + 1], CurveSide::before));
        }
        weight_ = 1e-2;
    }
    void refine(int cells) {
        const ConstantJerkSearch old = *this;
        begin([&](double t) { return old.at(t); }, old.duration(), cells);
    }

    [[nodiscard]] double duration() const {
        double t = 0;
        for (const double h : h_) t += h;
        return t;
    }
    [[nodiscard]] PathMotion at(double t) const {
        std::size_t k = 0;
        while (k + 1 < h_.size() && t > h_[k]) t -= h_[k++];
        return in(k, std::clamp(t, 0.0, h_[k]));
    }
    [[nodiscard]] std::size_t cells() const { return h_.size(); }
    /// By how much limits are crossed, all rows together.
    [[nodiscard]] double crossed() const { return crossing(); }

    /// Units of its own for each piece, where a corner may be passed at a thousandth of the velocity: for beginnings that are near.
    void take_own_units() { own_units_ = true; }

    /// Improves as long as it comes on. Number of steps.
    int solve(int most, double enough = 1e-6) {
        int quiet = 0, steps = 0;
        for (; steps < most && quiet < 4; ++steps) {
            const double before = duration(), crossed = crossing();
            const bool taken = step();
            if (!taken && weight_ > 1e6) break;
            const bool still = taken && before - duration() < enough * before && crossed - crossing() < enough;
            quiet = still ? quiet + 1 : taken ? 0 : quiet;
        }
        return steps;
    }
    /// Solve; look between the places, leave a little of what is crossed there; again.
    Looked settle(int rounds, int per_piece = 20) {
        for (int r = 0; r < rounds; ++r) {
            bool any = false;
            for (std::size_t k = 0; k < h_.size(); ++k) {
                const Looked l = look_at(k, per_piece);
                const std::array<double, 3> use{l.velocity, l.acceleration, l.jerk};
                for (std::size_t i = 0; i < 3; ++i)
                    if (use[i] > 1 - 1e-8) {
                        spare_[k][i] += 1.1 * (use[i] - 1) + 1e-7;
                        any = true;
                    }
            }
            if (!any && look(1).gap < 1e-8) break;
            weight_ = std::max(weight_, any ? 1e-4 : 1e-1);
            (void)solve(12, 1e-7);
        }
        return look(200);
    }
    [[nodiscard]] Looked look(int per_piece) const {
        Looked all;
        double top = 0;
        for (const double v : v_) top = std::max(top, v);
        for (std::size_t k = 0; k < h_.size(); ++k) {
            const Looked l = look_at(k, per_piece);
            if (l.velocity > all.velocity) all.velocity = l.velocity, all.velocity_at = l.velocity_at;
            if (l.acceleration > all.acceleration) all.acceleration = l.acceleration, all.acceleration_at = l.acceleration_at;
            if (l.jerk > all.jerk) all.jerk = l.jerk, all.jerk_at = l.jerk_at;
            const PathMotion m = in(k, h_[k]);
            all.gap = std::max({all.gap, std::fabs(m.s - s_[k + 1]) / (problem_.to - problem_.from),
                                std::fabs(m.velocity - v_[k + 1]) / top, std::fabs(m.acceleration - a_[k + 1]) * duration() / (20 * top)});
        }
        return all;
    }

private:
    static constexpr double too_dear = 2;  // what all of a limit beyond it costs, in parts of the whole time
    struct Row {
        std::size_t cell = 0;
        std::array<double, 6> c{};  // of v, a, j, h, v behind, a behind; scaled
        double value = 0, most = 1;
        bool real = true;  // no bound of the step alone
    };

    [[nodiscard]] PathMotion in(std::size_t k, double t) const {
        return {s_[k] + t * (v_[k] + t * (a_[k] / 2 + t * j_[k] / 6)), v_[k] + t * (a_[k] + t * j_[k] / 2), a_[k] + t * j_[k], j_[k]};
    }
    [[nodiscard]] double velocity_limit(const TimedCurvePoint& p, double s) const {
        return problem_.cap ? problem_.cap(s) : p.path.velocity * problem_.velocity_factor;
    }
    [[nodiscard]] Looked look_at(std::size_t k, int parts) const {
        Looked l;
        for (int i = 0; i <= parts; ++i) {
            const PathMotion m = in(k, h_[k] * i / parts);
            const double s = std::clamp(m.s, s_[k], s_[k + 1]);
            const TimedCurvePoint p = i == 0 ? first_[k] : i == parts ? end_[k] : curve_.at(s, CurveSide::after);
            const double v = m.velocity, a = m.acceleration, j = m.jerk;
            const auto widen = [&](double& most, double& where, double use) {
                if (use > most) most = use, where = s;
            };
            widen(l.velocity, l.velocity_at, v / velocity_limit(p, s));
            widen(l.acceleration, l.acceleration_at, a > 0 ? a / p.path.acceleration : -a / p.path.deceleration);
            widen(l.jerk, l.jerk_at, std::fabs(j) / p.path.jerk);
            for (std::size_t x = 0; x < limits_.size(); ++x) {
                widen(l.velocity, l.velocity_at, std::fabs(p.first[x]) * v / limits_[x].velocity);
                widen(l.acceleration, l.acceleration_at, std::fabs(p.second[x] * v * v + p.first[x] * a) / limits_[x].acceleration);
                widen(l.jerk, l.jerk_at, std::fabs(p.third[x] * v * v * v + 3 * p.second[x] * v * a + p.first[x] * j) / limits_[x].jerk);
            }
        }
        return l;
    }

    struct State {
        double v, a, j;
        std::array<double, 6> dv{}, da{}, dj{};
    };
    template <class Take>
    void limits_at(std::size_t k, const TimedCurvePoint& p, double s, const State& x, bool all, const Take& take) const {
        const auto row = [&](double value, double by_v, double by_a, double by_j, double limit, double spare, bool both) {
            if (!(limit < 1e14)) return;
            Row r;
            r.cell = k;
            for (std::size_t i = 0; i < 6; ++i) r.c[i] = (by_v * x.dv[i] + by_a * x.da[i] + by_j * x.dj[i]) / limit;
            r.value = value / limit;
            r.most = 1 - spare;
            take(r);
            if (!both) return;
            r.value = -r.value;
            for (double& c : r.c) c = -c;
            take(r);
        };
        const auto& spare = spare_[k];
        if (all) {
            row(x.v, 1, 0, 0, velocity_limit(p, s), spare[0], false);
            row(x.a, 0, 1, 0, p.path.acceleration, spare[1], false);
            row(-x.a, 0, -1, 0, p.path.deceleration, spare[1], false);
        }
        row(x.j, 0, 0, 1, p.path.jerk, spare[2], true);
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            const double q1 = p.first[i], q2 = p.second[i], q3 = p.third[i], v = x.v, a = x.a, j = x.j;
            if (all) {
                if (q1 != 0) row(std::fabs(q1) * v, std::fabs(q1), 0, 0, limits_[i].velocity, spare[0], false);
                if (q1 != 0 || q2 != 0) row(q2 * v * v + q1 * a, 2 * q2 * v, q1, 0, limits_[i].acceleration, spare[1], true);
            }
            if (q1 != 0 || q2 != 0 || q3 != 0)
                row(q3 * v * v * v + 3 * q2 * v * a + q1 * j, 3 * q3 * v * v + 3 * q2 * a, 3 * q2 * v, q1, limits_[i].jerk, spare[2], true);
        }
    }
    template <class Take>
    void each_row(const Take& take) const {
        for (std::size_t k = 0; k < h_.size(); ++k) {
            const double h = h_[k], v = v_[k], a = a_[k], j = j_[k];
            State x{v, a, j};
            x.dv[0] = x.da[1] = x.dj[2] = 1;
            limits_at(k, first_[k], s_[k], x, k > 0, take);
            x = {v_[k + 1], a_[k + 1], j};
            x.dv[4] = x.da[5] = x.dj[2] = 1;
            limits_at(k, end_[k], s_[k + 1], x, k + 1 < h_.size(), take);
            x = {v + a * h / 2 + j * h * h / 8, a + j * h / 2, j};
            x.dv = {1, h / 2, h * h / 8, a / 2 + j * h / 4, 0, 0};
            x.da = {0, 1, h / 2, j / 2, 0, 0};
            x.dj[2] = 1;
            const double s = std::clamp(s_[k] + h / 2 * (v + h / 2 * (a / 2 + h / 2 * j / 6)), s_[k], s_[k + 1]);
            limits_at(k, curve_.at(s, CurveSide::after), s, x, true, take);
            Row shorter;
            shorter.cell = k;
            shorter.real = false;
            shorter.c[3] = -1 / h;
            shorter.most = 0.5;
            take(shorter);
            if (k == 0) continue;
            Row slower = shorter;
            slower.c[3] = 0;
            slower.c[0] = -1 / v;
            take(slower);
        }
    }
    [[nodiscard]] double unit_s(std::size_t k) const { return own_units_ ? s_[k + 1] - s_[k] : scale_[k][0] * scale_[k][3]; }
    [[nodiscard]] std::array<double, 3> unmet(std::size_t k) const {
        const PathMotion m = in(k, h_[k]);
        return {(m.s - s_[k + 1]) / unit_s(k), (m.velocity - v_[k + 1]) / scale_[k][0], (m.acceleration - a_[k + 1]) / scale_[k][1]};
    }
    [[nodiscard]] double crossing() const {
        double sum = 0;
        each_row([&](const Row& r) { sum += r.real ? std::max(0.0, r.value - r.most) : 0.0; });
        return sum;
    }
    [[nodiscard]] double merit(double whole, double of_gaps) const {
        double gaps = 0;
        for (std::size_t k = 0; k < h_.size(); ++k)
            for (const double u : unmet(k)) gaps += std::fabs(u);
        return duration() / whole + too_dear * crossing() + of_gaps * gaps;
    }

    bool step() {
        const std::size_t n = h_.size(), size = 7 * n + 2;
        const double whole = duration();
        double top = 0;
        for (const double v : v_) top = std::max(top, v);
        scale_.resize(n + 1);
        for (std::size_t k = 0; k <= n; ++k) {
            const double h = k == 0 ? h_[0] : k == n ? h_[n - 1] : std::max(h_[k - 1], h_[k]);
            const double near = own_units_ ? std::max({v_[k], k > 0 ? v_[k - 1] : 0, k < n ? v_[k + 1] : 0, 1e-6 * top}) : top;
            const double beat = own_units_ ? 9 * h : whole / 20;
            scale_[k] = {near, near / beat, near / (beat * beat), k == n ? 0 : own_units_ ? h_[k] : whole / static_cast<double>(n)};
        }
        const auto scale = [&](std::size_t k, std::size_t i) { return i < 4 ? scale_[k][i] : scale_[k + 1][i - 4]; };
        std::vector<Row> rows;
        each_row([&](Row r) {
            for (std::size_t i = 0; i < 6; ++i) r.c[i] *= scale(r.cell, i);
            rows.push_back(r);
        });
        const std::size_t m = rows.size();
        constexpr std::array<std::size_t, 6> place{0, 1, 2, 3, 7, 8};
        // The equations of the pieces.
        std::vector<std::array<std::array<double, 6>, 3>> eq(n);
        std::vector<std::array<double, 3>> rest(n);
        for (std::size_t k = 0; k < n; ++k) {
            const double h = h_[k], j = j_[k];
            const PathMotion e = in(k, h);
            eq[k][0] = {h, h * h / 2, h * h * h / 6, e.velocity, 0, 0};
            eq[k][1] = {1, h, h * h / 2, e.acceleration, -1, 0};
            eq[k][2] = {0, 1, h, j, 0, -1};
            const std::array<double, 3> by{unit_s(k), scale_[k][0], scale_[k][1]};
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t i = 0; i < 6; ++i) eq[k][r][i] *= scale(k, i) / by[r];
            rest[k] = unmet(k);
        }
        const auto fixed = [&](std::size_t i) { return i < 2 || i >= 7 * n; };
        // The interior point.
        std::vector<double> x(size, 0.0), slack(m), beyond(m), price(m);
        for (std::size_t i = 0; i < m; ++i) {
            const double room = rows[i].most - rows[i].value;
            slack[i] = std::max(room, 0.02);
            beyond[i] = std::max(slack[i] - room, 0.02);
            price[i] = std::min(0.5 * too_dear, 0.1 / static_cast<double>(n) / slack[i]);
        }
        BandEquations band(size);
        const double prox = weight_ / static_cast<double>(n);
        std::vector<double> right(size), by_row(m), next(size);
        double sigma = 0.3;
        for (int it = 0; it < 80; ++it) {
            double product = 0;
            for (std::size_t i = 0; i < m; ++i) product += slack[i] * price[i] + beyond[i] * (too_dear - price[i]);
            const double mean = product / (2 * static_cast<double>(m));
            if (product < 1e-8 && it > 3) break;
            const double mu = sigma * mean;
            band.clear();
            std::fill(right.begin(), right.end(), 0.0);
            for (std::size_t k = 0; k < n; ++k) {
                right[7 * k + 3] -= scale_[k][3] / whole;
                for (std::size_t i = 0; i < 4; ++i) {
                    band.at(7 * k + i, 7 * k + i) += prox;
                    right[7 * k + i] -= prox * x[7 * k + i];
                }
                for (std::size_t r = 0; r < 3; ++r) {
                    const std::size_t l = 7 * k + 4 + r;
                    double left = rest[k][r];
                    for (std::size_t i = 0; i < 6; ++i) {
                        const std::size_t c = 7 * k + place[i];
                        band.at(l, c) += eq[k][r][i];
                        band.at(c, l) += eq[k][r][i];
                        left += eq[k][r][i] * x[c];
                        right[c] -= eq[k][r][i] * x[l];
                    }
                    right[l] -= left;
                    band.at(l, l) -= 1e-13;
                }
            }
            for (std::size_t i = 0; i < m; ++i) {
                const Row& r = rows[i];
                double value = r.value;
                for (std::size_t c = 0; c < 6; ++c) value += r.c[c] * x[7 * r.cell + place[c]];
                const double other = too_dear - price[i];
                const double off = r.most - value + beyond[i] - slack[i];  // of the row's equation
                const double stiff = 1 / (slack[i] / price[i] + beyond[i] / other);
                // d(price) = stiff (C dx + by_row)
                by_row[i] = (mu - slack[i] * price[i]) / price[i] - (mu - beyond[i] * other) / other - off;
                for (std::size_t c = 0; c < 6; ++c) {
                    if (r.c[c] == 0) continue;
                    const std::size_t row = 7 * r.cell + place[c];
                    right[row] -= r.c[c] * (price[i] + stiff * by_row[i]);
                    for (std::size_t d = 0; d < 6; ++d) band.at(row, 7 * r.cell + place[d]) += stiff * r.c[c] * r.c[d];
                }
            }
            for (std::size_t i = 0; i < size; ++i) {
                if (!fixed(i)) continue;
                for (std::size_t c = i >= 8 ? i - 8 : 0; c < std::min(size, i + 9); ++c) band.at(i, c) = band.at(c, i) = 0;
                band.at(i, i) = 1;
                right[i] = 0;
            }
            band.factor();
            next = right;
            band.solve(next);
            double alpha = 1;
            std::vector<double>& d_price = by_row;
            for (std::size_t i = 0; i < m; ++i) {
                const Row& r = rows[i];
                double change = 0;
                for (std::size_t c = 0; c < 6; ++c) change += r.c[c] * next[7 * r.cell + place[c]];
                const double other = too_dear - price[i];
                d_price[i] = (change + by_row[i]) / (slack[i] / price[i] + beyond[i] / other);
                const double d_slack = (mu - slack[i] * price[i] - slack[i] * d_price[i]) / price[i];
                const double d_beyond = (mu - beyond[i] * other + beyond[i] * d_price[i]) / other;
                if (d_price[i] < 0) alpha = std::min(alpha, -0.99 * price[i] / d_price[i]);
                if (d_price[i] > 0) alpha = std::min(alpha, 0.99 * other / d_price[i]);
                if (d_slack < 0) alpha = std::min(alpha, -0.99 * slack[i] / d_slack);
                if (d_beyond < 0) alpha = std::min(alpha, -0.99 * beyond[i] / d_beyond);
            }
            for (std::size_t i = 0; i < m; ++i) {
                const double other = too_dear - price[i];
                const double d_slack = (mu - slack[i] * price[i] - slack[i] * d_price[i]) / price[i];
                const double d_beyond = (mu - beyond[i] * other + beyond[i] * d_price[i]) / other;
                slack[i] += alpha * d_slack;
                beyond[i] += alpha * d_beyond;
                price[i] += alpha * d_price[i];
            }
            for (std::size_t i = 0; i < size; ++i) x[i] += alpha * next[i];
            sigma = alpha > 0.9 ? 0.05 : alpha > 0.5 ? 0.2 : 0.5;
        }
        double of_gaps = 1e-3;
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t r = 0; r < 3; ++r) of_gaps = std::max(of_gaps, 2 * std::fabs(x[7 * k + 4 + r]));
        if (!std::isfinite(of_gaps)) {
            weight_ *= 10;
            return false;
        }
        const double before = merit(whole, of_gaps);
        const auto v = v_, a = a_, j = j_, h = h_;
        double expected = 0;  // of the linear model
        {
            double t = 0, cross = 0;
            for (std::size_t k = 0; k < n; ++k) {
                t += h_[k] + scale_[k][3] * x[7 * k + 3];
            }
            for (const Row& r : rows) {
                double value = r.value;
                for (std::size_t c = 0; c < 6; ++c) value += r.c[c] * x[7 * r.cell + place[c]];
                cross += r.real ? std::max(0.0, value - r.most) : 0;
            }
            expected = before - (t / whole + too_dear * cross);
        }
        for (std::size_t k = 0; k < n; ++k) {
            if (k > 0) {
                v_[k] = std::max(v[k] + scale_[k][0] * x[7 * k], 0.2 * v[k]);
                a_[k] = a[k] + scale_[k][1] * x[7 * k + 1];
            }
            j_[k] = j[k] + scale_[k][2] * x[7 * k + 2];
            h_[k] = std::max(h[k] + scale_[k][3] * x[7 * k + 3], 0.2 * h[k]);
        }
        const double after = merit(whole, of_gaps);
        if (after < before - 1e-3 * expected || (expected < 1e-9 && after < before + 1e-9)) {
            weight_ = std::max(weight_ / (before - after > 0.5 * expected ? 4 : before - after > 0.2 * expected ? 1 : 0.5), 1e-9);
            return true;
        }
        v_ = v;
        a_ = a;
        j_ = j;
        h_ = h;
        weight_ *= 5;
        return false;
    }

    const TimedCurve& curve_;
    std::vector<PathAxisLimits> limits_;
    Problem problem_;
    std::vector<double> s_, v_, a_, j_, h_;
    std::vector<std::array<double, 3>> spare_;
    std::vector<TimedCurvePoint> first_, end_;
    std::vector<std::array<double, 4>> scale_;  // of v, a, j, h
    double weight_ = 1e-2;
    bool own_units_ = false;
};

}  // namespace taktwerk::axes

#include "axes/path_time/speed_problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr int max_steps = 60;
constexpr int steps_inside = 60, steps_inside_near = 30;  // until all bounds hold
constexpr int look_every = 8;                             // steps; a search from far outside that came no nearer in them gives up:
constexpr double nearer = 0.95;                           // than to this part of what was beyond its bounds
constexpr double to_the_boundary = 0.95;                  // of the way that a step may go towards it
constexpr double inside_first = 10;                       // gap while a bound is relaxed: the goal counts a tenth of it
constexpr double inside_near = 0.3;                       // the same where little is beyond a bound
constexpr double room_near = 0.02;
constexpr double room_beyond = 0.1;   // of a bound that is relaxed
constexpr double hair = 1e-5;         // of a bound: what has to be left before it is drawn in
constexpr double little_room = 2e-3;  // of one that was lowered on the way
constexpr double settled_gap = 1e-3;  // of the goal: what is left to gain
constexpr double off_centre = 20;     // how far a multiplier may be
constexpr double near_gap = 2e-2;     // where it shows which limits hold back

}  // namespace

void SpeedProblem::begin(const std::vector<double>& nodes, const SpeedEnd& start, const SpeedEnd& end, const CellShare& all) {
    nodes_ = nodes;
    lengths_.clear();
    for (std::size_t i = 1; i < nodes.size(); ++i) lengths_.push_back(nodes[i] - nodes[i - 1]);
    start_ = start;
    end_ = end;
    all_ = all;
    places_.clear();
    plain_.clear();
    jerk_.clear();
    plain_limits_.clear();
    jerk_limits_.clear();
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

void SpeedProblem::add_place(int cell, CellPlace place) {
    const double h = lengths_[static_cast<std::size_t>(cell)], x = 0.5 * static_cast<double>(place);
    const Triple first = node_triple(cell, cell), last = node_triple(cell + 1, cell);
    const auto mix = [&](double a, double b, double c) {
        Triple t;
        for (int i = 0; i < 3; ++i) t.g[i] = a * first.g[i] + c * last.g[i];
        t.g[1] += b;
        t.k = a * first.k + c * last.k;
        return t;
    };
    square_ = mix((1 - x) * (1 - x), 2 * x * (1 - x), x * x);
    slope_ = mix(-2 * (1 - x) / h, 2 * (1 - 2 * x) / h, 2 * x / h);
    bend_ = mix(2 / (h * h), -4 / (h * h), 2 / (h * h));
    Place p;
    p.square = square_;
    p.weight = h * (place == CellPlace::middle ? 4 : 1) / 6;
    p.plain = static_cast<int>(plain_.size());
    p.jerk = static_cast<int>(jerk_.size());
    places_.push_back(p);
    half_ = false;
}

SpeedProblem::Triple SpeedProblem::triple_of(const SpeedRow& row) const noexcept {
    Triple t;
    for (int i = 0; i < 3; ++i) t.g[i] = row.at * square_.g[i] + row.slope * slope_.g[i] + row.bend * bend_.g[i];
    t.k = row.at * square_.k + row.slope * slope_.k + row.bend * bend_.k;
    return t;
}

void SpeedProblem::add_side(const Triple& l, double sign, double limit, Bound kind) {
    if (!half_) {
        // A side that says nothing, until another one takes its place.
        Pair empty{};
        empty.bound = empty.inverse = Lanes{1, 1};
        plain_.push_back(empty);
        plain_limits_.push_back({Lanes{1, 1}, Lanes{1, 1}, {}});
        ++places_.back().plain_count;
    }
    Pair& p = plain_.back();
    const int lane = half_ ? 1 : 0;
    p.g0[lane] = sign * l.g[0];
    p.g1[lane] = sign * l.g[1];
    p.g2[lane] = sign * l.g[2];
    p.k[lane] = sign * l.k;
    PairLimits& limits = plain_limits_.back();
    limits.limit[lane] = limit;
    limits.wanted[lane] = limit * share_of(kind, all_);
    limits.kind[lane] = kind;
    half_ = !half_;
}

void SpeedProblem::add_plain(const SpeedRow& row, Bound kind) {
    // At the middle as Bernstein's coefficient: what it may be, v2 on the cell may be.
    add_side(places_.size() % 3 == 2 ? Triple{{0, row.at, 0}, 0} : triple_of(row), 1, row.above, kind);
}

void SpeedProblem::add_acceleration(const SpeedRow& row) {
    const Triple l = triple_of(row);
    add_side(l, 1, row.above, Bound::acceleration);
    add_side(l, -1, row.below, Bound::acceleration);
}

void SpeedProblem::add_jerk(const SpeedRow& row) {
    const Triple l = triple_of(row);
    Pair p{};
    p.g0 = Lanes{l.g[0], -l.g[0]};
    p.g1 = Lanes{l.g[1], -l.g[1]};
    p.g2 = Lanes{l.g[2], -l.g[2]};
    p.k = Lanes{l.k, -l.k};
    jerk_.push_back(p);
    const Lanes limit{row.above, row.below};
    jerk_limits_.push_back({limit, limit * all_.jerk, {}});
    ++places_.back().jerk_count;
}

double SpeedProblem::share_of(Bound kind, const CellShare& share) noexcept {
    switch (kind) {
        case Bound::acceleration: return share.acceleration;
        case Bound::cap:
        case Bound::held_cap: return share.velocity * share.velocity;
        case Bound::none:
        case Bound::soft_cap: break;
    }
    return 1;
}

void SpeedProblem::share(int cell, CellPlace place, const CellShare& share) {
    const Place& p = places_[3 * static_cast<std::size_t>(cell) + static_cast<std::size_t>(place)];
    for (int i = 0; i < p.plain_count; ++i) {
        PairLimits& pair = plain_limits_[static_cast<std::size_t>(p.plain + i)];
        for (int lane = 0; lane < 2; ++lane) pair.wanted[lane] = pair.limit[lane] * share_of(pair.kind[lane], share);
    }
    for (int i = 0; i < p.jerk_count; ++i) {
        PairLimits& pair = jerk_limits_[static_cast<std::size_t>(p.jerk + i)];
        pair.wanted = pair.limit * share.jerk;
    }
}

/// act(place, cell with its neighbours in d_) for all places on which a cell of the range has an influence.
template <class Do>
void SpeedProblem::each_place(const CellRange& range, const Do& act) {
    const int first = std::max(range.first - 1, 0), last = std::min(range.last + 1, cells());
    for (int c = first; c < last; ++c)
        for (std::size_t k = 0; k < 3; ++k) act(places_[3 * static_cast<std::size_t>(c) + k], static_cast<std::size_t>(c));
}

void SpeedProblem::look_at_squares(const CellRange& range) {
    each_place(range, [&](Place& p, std::size_t c) {
        const double* q = p.square.g;
        p.v2 = p.square.k + q[0] * d_[c] + q[1] * d_[c + 1] + q[2] * d_[c + 2];
        p.over_v = 1 / std::sqrt(p.v2);
        p.cube = p.over_v * p.over_v * p.over_v;
    });
}

/// Where the present v2 crosses a bound, the bound is put a little beyond it, and never further out again: so every iterate is inside, and
/// what is inside all true bounds once stays there.
void SpeedProblem::relax(const CellRange& range, Room room, double beyond) {
    feasible_ = true;
    hard_beyond_ = soft_beyond_ = 0;
    each_place(range, [&](Place& p, std::size_t c) {
        const double d0 = d_[c], d1 = d_[c + 1], d2 = d_[c + 2];
        const auto look = [&](Pair& x, PairLimits& own, double size) {
            const Lanes value = x.k + x.g0 * d0 + x.g1 * d1 + x.g2 * d2, used = value / size, limit = own.wanted;
            const Lanes before = x.bound > limit ? x.bound : limit;
            Lanes bound = used >= limit * (1 - hair) ? used + beyond * (limit > used ? limit : used) : limit;
            if (room == Room::less) bound = bound < before ? bound : before;
            if (room == Room::half) {
                bound = used + 0.5 * (before - used);
                bound = bound > limit ? bound : limit;
            }
            x.bound = bound;
            for (int lane = 0; lane < 2; ++lane) {
                if (!(bound[lane] > limit[lane])) {
                    if (room == Room::first && own.kind[lane] == Bound::soft_cap && holds_) own.kind[lane] = Bound::held_cap;
                    continue;
                }
                // What the cells beside the range do alone stays as it is, whatever it is.
                const bool beside = (static_cast<int>(c) == range.first - 1 && !(x.g2[lane] != 0)) ||
                                    (static_cast<int>(c) == range.last && !(x.g0[lane] != 0));
                if (own.kind[lane] == Bound::soft_cap) {
                    soft_beyond_ += bound[lane] / limit[lane] - 1;
                } else if (!beside) {
                    feasible_ = false;
                    hard_beyond_ += bound[lane] / limit[lane] - 1;
                }
            }
            const Lanes left = size * bound - value, least = 1e-9 * size * bound, inverse = 1 / (left > least ? left : least);
            x.z *= inverse / x.inverse;  // as central as before
            x.inverse = inverse;
        };
        for (int i = 0; i < p.plain_count; ++i) {
            const auto k = static_cast<std::size_t>(p.plain + i);
            look(plain_[k], plain_limits_[k], 1);
        }
        for (int i = 0; i < p.jerk_count; ++i) {
            const auto k = static_cast<std::size_t>(p.jerk + i);
            look(jerk_[k], jerk_limits_[k], p.over_v);
        }
    });
}

/// Caps that a moving beginning may be above are soft again. False: none was held.
bool SpeedProblem::let_go(const CellRange& range) {
    bool any = false;
    each_place(range, [&](Place& p, std::size_t) {
        for (int i = 0; i < p.plain_count; ++i)
            for (Bound& kind : plain_limits_[static_cast<std::size_t>(p.plain + i)].kind)
                if (kind == Bound::held_cap) {
                    kind = Bound::soft_cap;
                    any = true;
                }
    });
    return any;
}

void SpeedProblem::hold(int cell) {
    const auto c = static_cast<std::size_t>(cell);
    for (std::size_t k = cell > 0 ? 3 * c - 1 : 0; k < 3 * c + 3; ++k)  // a node's caps are at the end of the cell before, as a rule
        for (int i = 0; i < places_[k].plain_count; ++i)
            for (Bound& kind : plain_limits_[static_cast<std::size_t>(places_[k].plain + i)].kind)
                if (kind == Bound::soft_cap) kind = Bound::held_cap;
}

/// Multipliers on the central path of mu.
void SpeedProblem::center(const CellRange& range, double mu) {
    each_place(range, [&](Place& p, std::size_t) {
        for (int i = 0; i < p.plain_count; ++i) {
            Pair& x = plain_[static_cast<std::size_t>(p.plain + i)];
            x.z = mu * x.inverse;
        }
        for (int i = 0; i < p.jerk_count; ++i) {
            Pair& x = jerk_[static_cast<std::size_t>(p.jerk + i)];
            x.z = mu * x.inverse;
        }
    });
}

/// The equations of one step: band_ (the diagonal and two above it, for every cell) and right_.
void SpeedProblem::assemble(const CellRange& range, double mu) {
    const int n = cells(), from = std::max(range.first - 1, 0), to = std::min(range.last + 1, n);
    std::fill(band_.begin() + 3 * from, band_.begin() + 3 * (to + 2), 0.0);
    std::fill(right_.begin() + from, right_.begin() + to + 2, 0.0);
    for (int cell = from; cell < to; ++cell) {
        const auto c = static_cast<std::size_t>(cell);
        Lanes m00{}, m01{}, m02{}, m11{}, m12{}, m22{}, f0{}, f1{}, f2{};
        const auto add = [&](const Lanes& g0, const Lanes& g1, const Lanes& g2, const Lanes& weight, const Lanes& force) {
            const Lanes w0 = weight * g0, w1 = weight * g1, w2 = weight * g2;
            m00 += w0 * g0;
            m01 += w0 * g1;
            m02 += w0 * g2;
            m11 += w1 * g1;
            m12 += w1 * g2;
            m22 += w2 * g2;
            f0 -= force * g0;
            f1 -= force * g1;
            f2 -= force * g2;
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const Place& p = places_[3 * c + k];
            const double* q = p.square.g;
            const double pull = 0.5 * scale_ * p.weight * p.cube;
            add(Lanes{q[0], 0}, Lanes{q[1], 0}, Lanes{q[2], 0}, Lanes{1.5 * pull * (p.over_v * p.over_v), 0}, Lanes{-pull, 0});
            for (int i = 0; i < p.plain_count; ++i) {
                const Pair& x = plain_[static_cast<std::size_t>(p.plain + i)];
                add(x.g0, x.g1, x.g2, x.z * x.inverse, mu * x.inverse);
            }
            for (int i = 0; i < p.jerk_count; ++i) {
                const Pair& x = jerk_[static_cast<std::size_t>(p.jerk + i)];
                const Lanes bent = 0.5 * p.cube * x.bound;
                add(x.g0 + bent * q[0], x.g1 + bent * q[1], x.g2 + bent * q[2], x.z * x.inverse, mu * x.inverse);
            }
        }
        double* at = &band_[3 * c];  // of the cell before
        at[0] += m00[0] + m00[1];
        at[1] += m01[0] + m01[1];
        at[2] += m02[0] + m02[1];
        at[3] += m11[0] + m11[1];
        at[4] += m12[0] + m12[1];
        at[6] += m22[0] + m22[1];
        right_[c] += f0[0] + f0[1];
        right_[c + 1] += f1[0] + f1[1];
        right_[c + 2] += f2[0] + f2[1];
    }
    // No middle may come to 0: with all of them positive, v2 is.
    for (auto i = static_cast<std::size_t>(range.first + 1); i <= static_cast<std::size_t>(range.last); ++i) {
        const double over = 1 / d_[i];
        band_[3 * i] += mu * over * over;
        right_[i] += mu * over;
    }
}

/// L D L^T of five diagonals over the range; what lies beside it does not move. The step replaces right_.
bool SpeedProblem::factor_and_solve(const CellRange& range) {
    const auto first = static_cast<std::size_t>(range.first + 1), last = static_cast<std::size_t>(range.last + 1);
    decrement_ = 0;
    for (std::size_t i = first; i < last; ++i) {
        double* row = &band_[3 * i];
        if (!(row[0] > 0)) return false;
        const double over = 1 / row[0], one = row[1] * over, two = row[2] * over, right = right_[i];
        row[3] -= one * row[1];
        row[4] -= one * row[2];
        row[6] -= two * row[2];
        right_[i + 1] -= one * right;
        right_[i + 2] -= two * right;
        row[0] = over;
        decrement_ += right * right * over;
    }
    right_[first - 1] = right_[last] = right_[last + 1] = 0;
    if (first > 1) right_[first - 2] = 0;
    for (std::size_t i = last; i-- > first;) {
        const double* row = &band_[3 * i];
        right_[i] = (right_[i] - row[1] * right_[i + 1] - row[2] * right_[i + 2]) * row[0];
    }
    return true;
}

/// How far v2 and what is left of the bounds stay positive on the way that right_ says.
double SpeedProblem::measure_step(const CellRange& range) {
    double most = 1 / 0.8, shrink = 0;  // the greatest share that something would lose
    for (auto i = static_cast<std::size_t>(range.first + 1); i <= static_cast<std::size_t>(range.last); ++i)
        if (-right_[i] > shrink * d_[i]) shrink = -right_[i] / d_[i];
    Lanes loss{};
    each_place(range, [&](Place& p, std::size_t c) {
        const double r0 = right_[c], r1 = right_[c + 1], r2 = right_[c + 2];
        const double* q = p.square.g;
        const double move = q[0] * r0 + q[1] * r1 + q[2] * r2;
        if (-move > shrink * p.v2) shrink = -move / p.v2;
        for (int i = 0; i < p.plain_count; ++i) {
            Pair& x = plain_[static_cast<std::size_t>(p.plain + i)];
            x.move = (x.g0 * r0 + x.g1 * r1 + x.g2 * r2) * x.inverse;
            loss = loss > x.move ? loss : x.move;
        }
        const double bent = 0.5 * p.cube * move;
        for (int i = 0; i < p.jerk_count; ++i) {
            Pair& x = jerk_[static_cast<std::size_t>(p.jerk + i)];
            x.move = (x.g0 * r0 + x.g1 * r1 + x.g2 * r2 + bent * x.bound) * x.inverse;
            loss = loss > x.move ? loss : x.move;
        }
    });
    most = std::max({1.0, shrink * most, std::max(loss[0], loss[1]) / to_the_boundary});
    return 1 / most;
}

double SpeedProblem::take_step(const CellRange& range, double mu, double step) {
    for (auto i = static_cast<std::size_t>(range.first + 1); i <= static_cast<std::size_t>(range.last); ++i) d_[i] += step * right_[i];
    look_at_squares(range);
    Lanes gap{};
    // A multiplier follows Newton's step, but stays near the central path: it is but the weight that its row has in the next step.
    const auto next = [&](Pair& x, const Lanes& left) {
        const Lanes full = mu * x.inverse + x.z * x.move;
        x.inverse = 1 / left;
        const Lanes middle = mu * x.inverse, least = middle * (1 / off_centre), most = middle * off_centre;
        x.z = full < least ? least : full > most ? most : full;
        gap += x.z * left;
    };
    each_place(range, [&](Place& p, std::size_t c) {
        const double d0 = d_[c], d1 = d_[c + 1], d2 = d_[c + 2];
        for (int i = 0; i < p.plain_count; ++i) {
            Pair& x = plain_[static_cast<std::size_t>(p.plain + i)];
            next(x, x.bound - (x.k + x.g0 * d0 + x.g1 * d1 + x.g2 * d2));
        }
        // A jerk's bound is convex: what the step promised is kept at least.
        for (int i = 0; i < p.jerk_count; ++i) {
            Pair& x = jerk_[static_cast<std::size_t>(p.jerk + i)];
            next(x, x.bound * p.over_v - (x.k + x.g0 * d0 + x.g1 * d1 + x.g2 * d2));
        }
    });
    return gap[0] + gap[1];
}

/// From rest, v2 times a small number keeps every limit: velocity, acceleration and jerk go with its powers 1/2, 1 and 3/2.
void SpeedProblem::come_inside(std::vector<double>& d, double room) {
    d_.assign(d.size() + 3, 0);
    std::copy(d.begin(), d.end(), d_.begin() + 1);
    const CellRange all{0, cells()};
    look_at_squares(all);
    double most = 0;
    each_place(all, [&](Place& p, std::size_t c) {
        const auto use = [&](const Pair& x, const PairLimits& limits) {
            const Lanes u = (x.k + x.g0 * d_[c] + x.g1 * d_[c + 1] + x.g2 * d_[c + 2]) / limits.wanted;
            return std::max(u[0], u[1]);
        };
        for (int i = 0; i < p.plain_count; ++i) {
            const auto k = static_cast<std::size_t>(p.plain + i);
            most = std::max(most, use(plain_[k], plain_limits_[k]));
        }
        for (int i = 0; i < p.jerk_count; ++i) {
            const auto k = static_cast<std::size_t>(p.jerk + i);
            const double cube = use(jerk_[k], jerk_limits_[k]) / p.over_v;
            if (cube * cube > most * most * most) {
                const double root = math::cbrt(cube);
                most = root * root;
            }
        }
    });
    if (most < room) return;
    for (double& middle : d) middle *= room / most;
}

SpeedOutcome SpeedProblem::solve(std::vector<double>& d, const CellRange& wanted, SpeedGuess guess, SpeedWitness* witness) {
    SpeedOutcome outcome;
    CellRange range = wanted;
    if (moving()) {  // the first middle is given by the slope
        d[0] = start_.square + start_.slope * lengths_[0] / 2;
        range.first = std::max(range.first, 1);
    }
    band_.resize(3 * d.size() + 12);
    right_.resize(d.size() + 4);
    d_.assign(d.size() + 3, 0);
    std::copy(d.begin(), d.end(), d_.begin() + 1);
    look_at_squares(range);
    double total = 0, sides = 0;
    each_place(range, [&](Place& p, std::size_t) {
        total += p.weight * p.over_v;
        sides += 2 * (p.plain_count + p.jerk_count);
    });
    scale_ = 1 / total;
    const bool far = guess == SpeedGuess::outside, inside = guess == SpeedGuess::inside;
    relax(range, Room::first, far ? room_beyond : inside ? little_room : room_near);
    const auto finish = [&] { std::copy(d_.begin() + range.first + 1, d_.begin() + range.last + 1, d.begin() + range.first); };
    // While something is relaxed, being inside counts for more than being fast.
    const auto come_in = [&] {
        double mu = (far ? inside_first : inside_near) / sides;
        center(range, mu);
        // Soft caps are come back to as long as there is something to gain.
        double soft = soft_beyond_, hard = hard_beyond_;
        for (int i = 0, idle = 0; i < (far ? steps_inside : steps_inside_near) && (!feasible_ || (soft_beyond_ > 0 && idle < 6)); ++i) {
            ++outcome.steps;
            assemble(range, mu);
            if (!factor_and_solve(range)) return false;
            const double step = measure_step(range);
            (void)take_step(range, mu, step);
            relax(range, far ? Room::less : Room::half, room_beyond);
            idle = soft_beyond_ < 0.999 * soft ? 0 : idle + 1;
            soft = soft_beyond_;
            if (far && !feasible_ && i % look_every == look_every - 1) {
                if (hard_beyond_ > nearer * hard) return false;
                hard = hard_beyond_;
            }
            if (step > 0.9 && !feasible_ && !far) mu *= 3;  // it is central, and still outside: further from all bounds
        }
        return feasible_;
    };
    if (range.first < range.last) {
        if (!inside && (!feasible_ || soft_beyond_ > 0) && !come_in()) {
            if (!holds_ || !let_go(range)) return outcome;
            holds_ = false;
            outcome = solve(d, wanted, guess, witness);
            holds_ = true;
            return outcome;
        }
        double mu = (guess == SpeedGuess::near ? 0.01 : 0.1) / sides;
        center(range, mu);
        for (const int most = outcome.steps + max_steps; outcome.steps < most && !outcome.settled;) {
            ++outcome.steps;
            if (!feasible_ || soft_beyond_ > 0) relax(range, Room::half, little_room);
            assemble(range, mu);
            if (!factor_and_solve(range)) break;
            const double step = measure_step(range), gap = take_step(range, mu, step);
            if (witness != nullptr && gap < near_gap && decrement_ < near_gap) {
                finish();
                witness->come_near(range, d);
                witness = nullptr;
                // What is beyond a lowered bound now is let come back to it; whether it did, who looks at the end sees.
                relax(range, Room::first, little_room);
                continue;
            }
            outcome.settled = gap + decrement_ < settled_gap;
            // Far from the central path (a step promises much) mu waits for it.
            const double aim = gap * (step > 0.9 ? 0.1 : step > 0.5 ? 0.3 : step > 0.2 ? 0.6 : 1.0);
            mu = std::max({aim, std::min(0.3 * decrement_, mu * sides), 0.1 * settled_gap}) / sides;
        }
    }
    finish();
    outcome.soft_open = soft_beyond_ > 0;
    outcome.feasible = true;
    return outcome;
}

}  // namespace taktwerk::axes

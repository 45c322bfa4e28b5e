#include "axes/axis/time_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace taktwerk::axes {

namespace {

constexpr double rounding = 1e-9;  // relative: what a limit may be passed by in the last digits

MotionState travel(const MotionState& from, double jerk, double t) noexcept {
    return {from.position + t * (from.velocity + t * (from.acceleration / 2 + t * (jerk / 6))),
            from.velocity + t * (from.acceleration + t * (jerk / 2)), from.acceleration + t * jerk};
}

bool usable(const CurveScale& scale) noexcept {
    return scale.time > 0 && std::isfinite(scale.time) && std::isfinite(scale.value) && std::isfinite(scale.offset);
}

/// What is left of a table.
struct Rest {
    std::span<const TimePoint> rows;
    double first = 0;  ///< s of the table, to the first of them
};
Rest rest_of(std::span<const TimePoint> rows, double behind) noexcept {
    if (rows.empty()) return {};
    if (behind <= 0) return {rows, to_seconds(rows.front().delta)};
    constexpr double grain = 1e-9;  // s
    double at = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        at += to_seconds(rows[i].delta);
        if (at > behind + grain) return {rows.subspan(i), at - behind};
    }
    return {};
}

/// Times in which the velocity is 0 inside (0, duration); at most two.
struct Turns {
    std::array<double, 2> at{};
    int count = 0;
};
Turns turns(const MotionState& start, double jerk, double duration) noexcept {
    Turns found;
    const auto note = [&](double t) {
        if (t > 0 && t < duration) found.at[static_cast<std::size_t>(found.count++)] = t;
    };
    const double v = start.velocity, a = start.acceleration;
    if (jerk == 0) {
        if (a != 0) note(-v / a);
        return found;
    }
    const double inside = a * a - 2 * jerk * v;
    if (inside < 0) return found;
    const double q = -(a + std::copysign(std::sqrt(inside), a));
    note(q / jerk);
    if (q != 0) note(2 * v / q);
    return found;
}

}  // namespace

void TimeCurve::reserve(std::size_t rows) {
    room_ = rows;
    pieces_.reserve(rows + 3);
    diagonal_.resize(rows + 4);
    right_.resize(rows + 4);
}

void TimeCurve::clear() noexcept {
    pieces_.clear();
    cursor_ = 0;
    duration_ = asked_ = 0;
}

void TimeCurve::add(double duration, const MotionState& start, double jerk) noexcept {
    pieces_.push_back({duration_, duration, start, jerk});
    duration_ += duration;
}

// Knots 0..m, intervals h_k, accelerations a_k unknown but for the two ends. Continuity of velocity at knot k:
//   h_{k-1} a_{k-1} + 2 (h_{k-1} + h_k) a_k + h_k a_{k+1} = 6 ((q_{k+1} - q_k) / h_k - (q_k - q_{k-1}) / h_{k-1})
// The positions of knots 1 and m-1 are free: q_1 = Q_1 + h_0^2 a_1 / 6 with Q_1 = q_0 + h_0 v_0 + h_0^2 a_0 / 3, and the mirror image.
// They lie so that they stand in their own equation and, where they halve the interval, in no other.
ErrorId TimeCurve::make_position(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale,
                                 double tolerance) noexcept {
    clear();
    smooth_ = true;
    auto [rows, ahead] = rest_of(table, scale.behind);
    const auto value = [&](const TimePoint& row) { return scale.value * row.value + scale.offset; };
    if (rows.empty() || rows.size() > room_ || !usable(scale)) return ErrorId::invalid_table;
    for (const auto& row : rows)
        if (!std::isfinite(value(row))) return ErrorId::invalid_table;
    if (rows.front().delta == Duration::zero()) {
        if (!(std::abs(value(rows.front()) - from.position) <= tolerance)) return ErrorId::invalid_position;
        rows = rows.subspan(1);
        if (!rows.empty()) ahead = to_seconds(rows.front().delta);
    }
    if (rows.empty()) return ErrorId::invalid_table;
    for (const auto& row : rows)
        if (row.delta <= Duration::zero()) return ErrorId::invalid_table;

    // Pieces take the knots; the duration of the last one stands apart.
    const auto knot = [&](double h, double position) { pieces_.push_back({0, h, {position, 0, 0}, 0}); };
    const auto seconds = [&](const TimePoint& row) { return to_seconds(row.delta) * scale.time; };
    const double first = ahead * scale.time, last = seconds(rows.back());
    if (rows.size() == 1) {
        for (int i = 0; i < 3; ++i) knot(first / 3, from.position);
    } else {
        knot(first / 2, from.position);
        knot(first / 2, 0);
        for (std::size_t i = 0; i + 1 < rows.size(); ++i) knot(i + 2 == rows.size() ? last / 2 : seconds(rows[i + 1]), value(rows[i]));
        knot(last / 2, 0);
    }
    const std::size_t m = pieces_.size();
    end_ = {value(rows.back()), 0, 0};
    const auto h = [&](std::size_t k) { return pieces_[k].duration; };
    const auto q = [&](std::size_t k) -> double { return k == m ? end_.position : pieces_[k].start.position; };
    const double head = h(0), tail = h(m - 1);
    pieces_[1].start.position = from.position + head * from.velocity + head * head * from.acceleration / 3;  // Q_1
    pieces_[m - 1].start.position = end_.position;                                                           // Q_{m-1}

    // Elimination downwards, then upwards.
    for (std::size_t k = 1; k < m; ++k) {
        double lower = h(k - 1);
        const double upper = h(k);
        double diagonal = 2 * (lower + upper);
        double right = 6 * ((q(k + 1) - q(k)) / upper - (q(k) - q(k - 1)) / lower);
        if (k == 1) {
            diagonal += head + head * head / upper;
            right -= head * from.acceleration;
        }
        if (k == 2) lower -= head * head / lower;
        if (k + 1 == m) diagonal += tail + tail * tail / h(k - 1);
        if (k > 1) {
            const double above = h(k - 1) - (k + 1 == m ? tail * tail / h(k - 1) : 0);  // what the row above holds right of its diagonal
            const double part = lower / diagonal_[k - 1];
            diagonal -= part * above;
            right -= part * right_[k - 1];
        }
        diagonal_[k] = diagonal;
        right_[k] = right;
    }
    pieces_[0].start.acceleration = from.acceleration;
    for (std::size_t k = m - 1; k >= 1; --k) {
        const double upper = h(k) - (k + 2 == m ? tail * tail / h(k) : 0);
        const double next = k + 1 == m ? 0 : pieces_[k + 1].start.acceleration;
        pieces_[k].start.acceleration = (right_[k] - (k + 1 == m ? 0 : upper * next)) / diagonal_[k];
    }
    pieces_[1].start.position += head * head * pieces_[1].start.acceleration / 6;
    pieces_[m - 1].start.position += tail * tail * pieces_[m - 1].start.acceleration / 6;
    for (std::size_t k = 0; k < m; ++k) {
        auto& piece = pieces_[k];
        const double next = k + 1 == m ? 0 : pieces_[k + 1].start.acceleration;
        piece.jerk = (next - piece.start.acceleration) / piece.duration;
        piece.start.velocity =
            k == 0 ? from.velocity
                   : (q(k + 1) - piece.start.position) / piece.duration - piece.duration * (2 * piece.start.acceleration + next) / 6;
        piece.begin = duration_;
        duration_ += piece.duration;
    }
    note_tops();
    return ErrorId::none;
}

ErrorId TimeCurve::make_velocity(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale,
                                 double tolerance) noexcept {
    clear();
    smooth_ = false;
    const auto [rows, ahead] = rest_of(table, scale.behind);
    if (rows.empty() || rows.size() > room_ || !usable(scale)) return ErrorId::invalid_table;
    end_ = {from.position, from.velocity, 0};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double velocity = scale.value * rows[i].value + scale.offset;
        if (!std::isfinite(velocity)) return ErrorId::invalid_table;
        if (i == 0 && rows[i].delta == Duration::zero()) {
            if (!(std::abs(velocity - from.velocity) <= tolerance)) return ErrorId::invalid_velocity;
            continue;
        }
        const double seconds = (i == 0 ? ahead : to_seconds(rows[i].delta)) * scale.time;
        if (!(seconds > 0)) return ErrorId::invalid_table;
        add(seconds, {end_.position, end_.velocity, (velocity - end_.velocity) / seconds}, 0);
        end_ = {end_.position + (end_.velocity + velocity) / 2 * seconds, velocity, 0};
    }
    note_tops();
    return pieces_.empty() ? ErrorId::invalid_table : ErrorId::none;
}

ErrorId TimeCurve::make_acceleration(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale) noexcept {
    clear();
    smooth_ = false;
    const auto [rows, ahead] = rest_of(table, scale.behind);
    if (rows.empty() || rows.size() > room_ || !usable(scale)) return ErrorId::invalid_table;
    end_ = {from.position, from.velocity, 0};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double acceleration = scale.value * rows[i].value + scale.offset;
        const double seconds = (i == 0 ? ahead : to_seconds(rows[i].delta)) * scale.time;
        if (!std::isfinite(acceleration) || !(seconds > 0)) return ErrorId::invalid_table;
        const MotionState start{end_.position, end_.velocity, acceleration};
        add(seconds, start, 0);
        end_ = travel(start, 0, seconds);
        end_.acceleration = 0;
    }
    // A profile whose sum is zero ends standing: what is left of the velocity is the rounding of the sum.
    double swing = 0;
    for (const auto& piece : pieces_) swing = std::max(swing, std::abs(piece.start.velocity));
    if (std::abs(end_.velocity) <= 1e-12 * swing) end_.velocity = 0;
    note_tops();
    return ErrorId::none;
}

double TimeCurve::top_of(const Piece& piece, double sense) noexcept {
    const double start = sense * piece.start.velocity, stop = sense * travel(piece.start, piece.jerk, piece.duration).velocity;
    if (std::isnan(start) || std::isnan(stop)) return std::numeric_limits<double>::quiet_NaN();
    const double turn = piece.jerk != 0 ? -piece.start.acceleration / piece.jerk : 0;
    if (!(turn > 0 && turn < piece.duration)) return std::max(start, stop);
    return std::max({start, stop, sense * travel(piece.start, piece.jerk, turn).velocity});
}

/// From the end to the beginning, once: what is still to come is asked for in each cycle.
void TimeCurve::note_tops() noexcept {
    double top = end_.velocity, low = end_.velocity;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
        auto& piece = pieces_[i];
        piece.top_behind = top;
        piece.low_behind = low;
        top = std::max(top, top_of(piece, 1));
        low = std::min(low, -top_of(piece, -1));
    }
}

double TimeCurve::top_velocity(double sense) const noexcept {
    if (!(asked_ < duration_)) return sense * end_.velocity;
    auto rest = pieces_[cursor_];
    const double gone = std::max(0.0, asked_ - rest.begin);
    rest.start = travel(rest.start, rest.jerk, gone);
    rest.duration -= gone;
    return std::max(top_of(rest, sense), sense > 0 ? rest.top_behind : -rest.low_behind);
}

ErrorId TimeCurve::check_piece(const Piece& piece, const CurveLimits& limits) const noexcept {
    const auto& l = limits.motion;
    const auto beyond = [](double value, double limit) { return !(std::abs(value) <= limit * (1 + rounding)); };
    const auto stop = travel(piece.start, piece.jerk, piece.duration);
    // Not a number is beyond, too.
    if (!(top_of(piece, 1) <= limits.forward * (1 + rounding) + rounding * l.velocity)) return ErrorId::invalid_velocity;
    if (!(top_of(piece, -1) <= limits.backward * (1 + rounding) + rounding * l.velocity)) return ErrorId::invalid_velocity;
    if (smooth_ && beyond(piece.jerk, l.jerk)) return ErrorId::invalid_dynamics;

    const auto turned = turns(piece.start, piece.jerk, piece.duration);
    const auto outside = [&](double p) {
        const double slack = rounding * std::max(std::abs(p), 1.0);
        return p > limits.position_max + slack || p < limits.position_min - slack;
    };
    if (outside(piece.start.position) || outside(stop.position)) return ErrorId::beyond_software_limit;
    for (int i = 0; i < turned.count; ++i)
        if (outside(travel(piece.start, piece.jerk, turned.at[static_cast<std::size_t>(i)]).position))
            return ErrorId::beyond_software_limit;

    if (turned.count > 0) {
        const double both = std::min(l.acceleration, l.deceleration);
        if (beyond(piece.start.acceleration, both) || beyond(stop.acceleration, both)) return ErrorId::invalid_dynamics;
        return ErrorId::none;
    }
    const double sense = travel(piece.start, piece.jerk, piece.duration / 2).velocity;  // of the whole piece
    for (const double a : {piece.start.acceleration, stop.acceleration})
        if (beyond(a, a * sense >= 0 ? l.acceleration : l.deceleration)) return ErrorId::invalid_dynamics;
    return ErrorId::none;
}

ErrorId TimeCurve::check(const CurveLimits& limits) const noexcept {
    for (const auto& piece : pieces_)
        if (const auto error = check_piece(piece, limits); error != ErrorId::none) return error;
    return ErrorId::none;
}

void TimeCurve::seek(double t) noexcept {
    while (cursor_ + 1 < pieces_.size() && t >= pieces_[cursor_ + 1].begin) ++cursor_;
}

MotionState TimeCurve::at(double t) noexcept {
    asked_ = t;
    if (!(t < duration_)) return {end_.position + end_.velocity * (t - duration_), end_.velocity, 0};
    seek(t);
    const auto& piece = pieces_[cursor_];
    return travel(piece.start, piece.jerk, t - piece.begin);
}

double TimeCurve::jerk_at(double t) noexcept {
    if (!(t < duration_)) return 0;
    seek(t);
    return pieces_[cursor_].jerk;
}

}  // namespace taktwerk::axes

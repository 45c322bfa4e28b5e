#include "axes/excitation/excitation_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

// Of the envelope 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7 on [0, 1]: the largest first, second and third derivative.
constexpr double rise_first = 2.1875, rise_second = 7.5132, rise_third = 52.5;
constexpr double no_jerk_limit = 0.01;  // s to the full acceleration where the axis has none
constexpr double friction_span = 32;    // the highest velocity of a friction curve is so many times the lowest
constexpr double least_looks = 8;       // cycles that a period of the cogging takes
constexpr double friction_start = 0.5;  // s from rest to a low velocity: so gently that the torque is seen to rise until it breaks away
constexpr double friction_time = 2;     // s at one velocity, unless a turn of the motor takes longer

/// Of the order's kind, where it names none.
std::uint16_t usual_count(MeasureKind kind) noexcept {
    switch (kind) {
        case MeasureKind::step:
        case MeasureKind::ramp: return 3;
        case MeasureKind::friction: return 8;
        case MeasureKind::sweep: return 25;
        case MeasureKind::following: return 4;
        case MeasureKind::cogging: return 2;
        case MeasureKind::none: break;
    }
    return 1;
}

}  // namespace

ExcitationPlan::ExcitationPlan(const MeasureOrder& order, const ExcitationBounds& bounds) noexcept : order_(order), bounds_(bounds) {
    if (order.kind == MeasureKind::none || static_cast<std::size_t>(order.kind) >= measure_words.size()) return;
    refusal_ = ExcitationRefusal::none;
    for (const double number : {order.velocity, order.acceleration, order.from_hz, order.to_hz, order.period})
        if (!(number >= 0) || !std::isfinite(number)) refusal_ = ExcitationRefusal::bad_number;
    if (!std::isfinite(order.distance)) refusal_ = ExcitationRefusal::bad_number;
    if (!(bounds.velocity > 0)) refusal_ = ExcitationRefusal::no_velocity;
    if (refusal_ != ExcitationRefusal::none) return;
    fill_in();
    if (usable()) measure_path();
}

void ExcitationPlan::fill_in() noexcept {
    auto& o = order_;
    const auto& b = bounds_;
    if (o.count == 0) o.count = usual_count(o.kind);
    if (o.velocity == 0) o.velocity = std::min(b.usual_velocity, b.velocity * share);
    o.velocity = std::min(o.velocity, b.velocity * share);
    if (o.acceleration == 0) o.acceleration = b.acceleration / 2;
    o.acceleration = std::min(o.acceleration, b.acceleration * share);
    jerk_ = std::min(b.jerk * share, o.acceleration / no_jerk_limit);
    if (std::isfinite(b.jerk)) jerk_ = b.jerk * share;
    if (o.period == 0) o.period = b.revolution;
    const double highest = highest_share / b.cycle;
    if (of_tones()) {
        if (o.from_hz == 0) o.from_hz = std::min(2.0, highest / 10);
        if (o.to_hz == 0) o.to_hz = std::min(100.0, highest);
        if (o.distance == 0) o.distance = o.velocity / (2 * std::numbers::pi * o.from_hz) / 2;
        o.distance = std::abs(o.distance);
    }
    if (o.distance != 0) return;
    // Half a second of the way, or what cogging needs, to the side with more room.
    double way = o.velocity / 2 + way_of_ramps(o.velocity, o.acceleration);
    if (o.kind == MeasureKind::cogging && o.period > 0) {
        way = 2 * o.period + way_of_ramps(o.velocity, o.acceleration);
    }
    const double above = b.position_max - b.start, below = b.start - b.position_min;
    o.distance = above >= below ? way : -way;
}

/// From rest to the velocity and back to rest, u.
double ExcitationPlan::way_of_ramps(double velocity, double acceleration) const noexcept {
    // Without reaching the acceleration where the jerk does not let it.
    const double peak = std::min(acceleration, math::sqrt(velocity * jerk_));
    return velocity * (velocity / peak + peak / jerk_);
}

/// s
double ExcitationPlan::time_of_move(double way, double velocity, double acceleration) const noexcept {
    if (way_of_ramps(velocity, acceleration) > way) {  // it turns back before it is that fast
        const double lag = acceleration / jerk_;
        velocity = acceleration / 2 * (math::sqrt(lag * lag + 4 * way / acceleration) - lag);
        if (velocity < acceleration * lag) velocity = math::cbrt(way * way / 4 * jerk_);  // and before it accelerates that hard
    }
    if (!(velocity > 0)) return 0;
    const double peak = std::min(acceleration, math::sqrt(velocity * jerk_));
    return way / velocity + velocity / peak + peak / jerk_;
}

bool ExcitationPlan::usable() noexcept {
    if (order_.count > most_count) {
        refusal_ = ExcitationRefusal::too_many;
        needed_ = most_count;
        return false;
    }
    if (of_tones()) {
        needed_ = highest_share / bounds_.cycle;
        if (order_.from_hz < order_.to_hz && order_.to_hz <= needed_ * (1 + 1e-9)) return true;
        refusal_ = ExcitationRefusal::frequency;
        return false;
    }
    // A stretch of constant velocity must be left, and a turn of it where the position counts.
    const bool cruises = order_.kind == MeasureKind::ramp || order_.kind == MeasureKind::friction || order_.kind == MeasureKind::cogging;
    if (!cruises) return true;
    // Waves that pass between two looks are not seen.
    if (order_.kind == MeasureKind::cogging && order_.period > 0 && order_.period < least_looks * bounds_.cycle * order_.velocity) {
        needed_ = least_looks * bounds_.cycle * order_.velocity;
        refusal_ = ExcitationRefusal::short_period;
        return false;
    }
    const double cruise = order_.kind == MeasureKind::cogging ? order_.period : 20 * bounds_.cycle * order_.velocity;
    needed_ = way_of_ramps(order_.velocity, order_.acceleration) + cruise;
    if (std::abs(order_.distance) * (1 + 1e-9) >= needed_) return true;
    refusal_ = ExcitationRefusal::too_short;
    return false;
}

void ExcitationPlan::measure_path() noexcept {
    const auto& b = bounds_;
    lowest_ = b.start - (of_tones() ? order_.distance : std::max(0.0, -order_.distance));
    highest_ = b.start + (of_tones() ? order_.distance : std::max(0.0, order_.distance));
    for (std::size_t i = 0; i < legs(); ++i) {
        if (of_tones()) {
            const auto t = tone(i);
            duration_ += 2 * t.rise + t.hold;
        } else {
            const auto l = leg(i);
            const double way = std::abs(l.target - (i == 0 ? b.start : leg(i - 1).target));
            duration_ += time_of_move(way, l.velocity, l.acceleration) + l.rest;
        }
    }
    // Wherever it is stopped, the stop must end inside.
    const double stop_jerk = std::min(b.stop_jerk, jerk_);
    margin_ = order_.velocity * (order_.velocity / b.stop + b.stop / stop_jerk) / 2;
    // What is next to nothing divides to infinity: no path of numbers is no path.
    if (!std::isfinite(lowest_) || !std::isfinite(highest_) || !std::isfinite(margin_) || std::isnan(duration_)) {
        refusal_ = ExcitationRefusal::bad_number;
    } else if (lowest_ - margin_ < b.position_min) {
        refusal_ = ExcitationRefusal::below_limit;
        needed_ = b.start - lowest_ + margin_;
        room_ = b.start - b.position_min;
    } else if (highest_ + margin_ > b.position_max) {
        refusal_ = ExcitationRefusal::above_limit;
        needed_ = highest_ - b.start + margin_;
        room_ = b.position_max - b.start;
    } else if (duration_ > longest) {
        refusal_ = ExcitationRefusal::too_long;
    }
}

std::size_t ExcitationPlan::legs() const noexcept { return of_tones() ? order_.count : std::size_t{2} * order_.count; }

/// Acceleration of a friction curve's slower moves: gentle, but on no longer ramps than the fastest has.
double ExcitationPlan::start_of(double velocity) const noexcept {
    const double part = velocity / order_.velocity;
    return std::min(order_.acceleration, std::max(velocity / friction_start, order_.acceleration * part * part));
}

/// How far pair `pair` of a friction curve goes: slow moves do not take for ever.
double ExcitationPlan::reach(std::size_t, double velocity) const noexcept {
    const double way = std::max(friction_time * velocity, order_.period) + way_of_ramps(velocity, start_of(velocity));
    return std::copysign(std::min(std::abs(order_.distance), way), order_.distance);
}

ExcitationLeg ExcitationPlan::leg(std::size_t i) const noexcept {
    const std::size_t pair = i / 2;
    ExcitationLeg leg{0, order_.velocity, order_.acceleration, settle};
    double distance = order_.distance;
    const double place = order_.count > 1 ? static_cast<double>(pair) / (order_.count - 1) : 1;
    if (order_.kind == MeasureKind::friction) {
        leg.velocity = order_.velocity * math::exp(math::log(friction_span) * (place - 1));
        leg.acceleration = start_of(leg.velocity);
        distance = reach(pair, leg.velocity);
    } else if (order_.kind == MeasureKind::following) {
        // Fast and slow, hard and gentle in every combination: else nobody could tell the causes apart.
        leg.velocity *= 0.4 + 0.6 * place;
        leg.acceleration *= pair % 2 == 0 ? 1 : 0.5;
    }
    leg.target = bounds_.start + (i % 2 == 0 ? distance : 0);
    return leg;
}

ExcitationTone ExcitationPlan::tone(std::size_t i) const noexcept {
    const double place = order_.count > 1 ? static_cast<double>(i) / (order_.count - 1) : 0;
    ExcitationTone tone;
    tone.frequency = order_.from_hz * math::exp(math::log(order_.to_hz / order_.from_hz) * place);
    const double period = 1 / tone.frequency;
    tone.rise = std::max(period, 0.05);
    tone.settle = std::max(2 * period, 0.15);
    tone.hold = tone.settle + std::max(4 * period, 0.2);
    const double w = 2 * std::numbers::pi * tone.frequency, r = tone.rise;
    const double first = rise_first / r, second = rise_second / (r * r), third = rise_third / (r * r * r);
    tone.amplitude = std::min({order_.distance, order_.velocity / (w + first), order_.acceleration / (w * w + 2 * w * first + second),
                               jerk_ / (w * w * w + 3 * w * w * first + 3 * w * second + third)});
    return tone;
}

}  // namespace taktwerk::axes

#include "axes/excitation/excitation.hpp"

#include <numbers>

#include "axes/planner/plan.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

Excitation::Excitation(const ExcitationPlan& plan) noexcept : plan_(plan), at_(plan.bounds().start) {}

void Excitation::begin_leg() noexcept {
    begun_ = true;
    cycles_ = 0;
    piece_ = 0;
    if (plan_.of_tones()) {
        tone_ = plan_.tone(leg_);
        length_ = 2 * tone_.rise + tone_.hold;
        return;
    }
    const auto leg = plan_.leg(leg_);
    const auto planned =
        plan_to_position({at_, 0, 0}, leg.target, MotionLimits{leg.velocity, leg.acceleration, leg.acceleration, plan_.jerk()});
    profile_ = planned.error == PlanError::none ? planned.profile : Profile{MotionState{at_, 0, 0}};
    at_ = profile_.end().position;
    length_ = profile_.duration() + leg.rest;
}

/// x = A w(t) sin(2 pi f t): w rises from 0 to 1, stays, and falls, with three continuous derivatives.
MotionState Excitation::on_tone(double t) const noexcept {
    const double omega = 2 * std::numbers::pi * tone_.frequency;
    double w = 1, w1 = 0, w2 = 0;
    const double end = 2 * tone_.rise + tone_.hold;
    const bool falls = t > tone_.rise + tone_.hold;
    const double s = (falls ? end - t : t) / tone_.rise;
    if (s <= 0) return {at_, 0, 0};
    if (s < 1) {
        const double s2 = s * s, s3 = s2 * s;
        const double sense = falls ? -1 : 1;
        w = s3 * s * (35 + s * (-84 + s * (70 - 20 * s)));
        w1 = sense * s3 * (140 + s * (-420 + s * (420 - 140 * s))) / tone_.rise;
        w2 = s2 * (420 + s * (-1680 + s * (2100 - 840 * s))) / (tone_.rise * tone_.rise);
    }
    const double sine = math::sin(omega * t), cosine = math::cos(omega * t), a = tone_.amplitude;
    return {at_ + a * w * sine, a * (w1 * sine + w * omega * cosine), a * (w2 * sine + 2 * w1 * omega * cosine - w * omega * omega * sine)};
}

bool Excitation::step(MotionState& next) noexcept {
    next = {at_, 0, 0};
    if (!begun_ && leg_ >= plan_.legs()) return false;
    if (!begun_) begin_leg();
    ++cycles_;
    const double cycle = plan_.bounds().cycle;
    const double t = static_cast<double>(cycles_) * cycle;
    elapsed_ += cycle;
    if (plan_.of_tones()) {
        next = on_tone(t);
        holds_ = t > tone_.rise && t <= tone_.rise + tone_.hold;
    } else {
        const auto sample = profile_.sample(t, piece_);
        piece_ = sample.piece;
        next = sample.state;
        holds_ = t >= profile_.duration();
        if (holds_) next = {at_, 0, 0};
    }
    if (t < length_) return true;
    begun_ = false;
    return ++leg_ < plan_.legs();
}

}  // namespace taktwerk::axes

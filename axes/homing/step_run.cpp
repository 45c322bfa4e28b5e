#include "axes/homing/step_run.hpp"

#include <cmath>

namespace taktwerk::axes {

void StepRun::start(const StepSettings& settings, Instant now, std::int64_t position) noexcept {
    settings_ = settings;
    phase_ = Phase::searching;
    end_ = End::none;
    demand_ = Demand::stop;
    velocity_ = 0;
    start_ = now;
    from_ = last_ = place_ = position;
    absolute_ = 0;
}

void StepRun::end(End how) noexcept {
    if (phase_ != Phase::searching) return;
    end_ = how;
    phase_ = Phase::stopping;
    demand_ = Demand::stop;
    velocity_ = 0;
}

StepRun::End StepRun::limit_hit(const SearchInput& in) const noexcept {
    const std::int64_t way = in.position < from_ ? from_ - in.position : in.position - from_;
    if (settings_.distance_limit > 0 && way >= settings_.distance_limit) return End::distance_limit;
    const bool block = std::holds_alternative<BlockSearch>(settings_.search);
    if (!block && settings_.torque_limit > 0 && std::abs(in.torque) >= settings_.torque_limit) return End::torque_limit;
    return End::none;
}

void StepRun::step(const SearchInput& in, bool fresh, bool standing) noexcept {
    if (fresh) last_ = in.position;
    switch (phase_) {
        case Phase::idle:
        case Phase::over: return;
        case Phase::stopping:
            if (!standing) return;
            phase_ = Phase::over;
            if (!std::holds_alternative<BlockSearch>(settings_.search)) return;
            if (end_ != End::found) place_ = last_;
            phase_ = Phase::returning;
            demand_ = Demand::place;
            return;
        case Phase::returning:
            if (standing) phase_ = Phase::over;
            return;
        case Phase::searching: break;
    }
    if (fresh) {
        const auto move = std::visit([&in](auto& search) { return search.step(in); }, settings_.search);
        switch (move.kind) {
            case SearchMove::Kind::found:
                place_ = move.place;
                absolute_ = move.absolute;
                end(End::found);
                return;
            case SearchMove::Kind::failed: end(End::failed); return;
            case SearchMove::Kind::move:
                demand_ = Demand::velocity;
                velocity_ = move.sense * (move.fine && settings_.fine_velocity > 0 ? settings_.fine_velocity : settings_.velocity);
                break;
        }
        if (const End limit = limit_hit(in); limit != End::none) end(limit);
    }
    if (settings_.time_limit > Duration::zero() && in.now - start_ >= settings_.time_limit) end(End::time_limit);
}

}  // namespace taktwerk::axes

#include "axes/homing/switch_search.hpp"

namespace taktwerk::axes {

using enum MC_SwitchMode;

void SwitchSearch::begin(bool on) noexcept {
    const bool by_switch = direction_ == MC_HomeDirection::mcSwitchPositive || direction_ == MC_HomeDirection::mcSwitchNegative;
    const bool positive = direction_ == MC_HomeDirection::mcPositiveDirection || direction_ == MC_HomeDirection::mcSwitchPositive;
    way_ = positive ? 1 : -1;
    turn(Phase::search, way_);
    if (!on) return;
    switch (mode_) {
        case mcOn:
        case mcOff:
            if (by_switch) sense_ = -way_;
            break;
        case mcRisingEdge: turn(Phase::leave, -way_); break;
        case mcFallingEdge:
            if (by_switch) turn(Phase::leave, -way_);
            break;
        case mcEdgeSwitchPositive: sense_ = -1; break;  // the edge wanted is the switch's negative end
        case mcEdgeSwitchNegative: sense_ = 1; break;
    }
}

bool SwitchSearch::reached() const noexcept {
    switch (mode_) {
        case mcOn: return edge_.level();
        case mcOff: return !edge_.level();
        case mcRisingEdge: return edge_.rising();
        case mcFallingEdge: return edge_.falling();
        case mcEdgeSwitchPositive: return sense_ > 0 ? edge_.rising() : edge_.falling();
        case mcEdgeSwitchNegative: return sense_ > 0 ? edge_.falling() : edge_.rising();
    }
    return false;
}

SearchMove SwitchSearch::search(const SearchInput& in, bool limit_ahead) noexcept {
    const bool turning = in.set_velocity * sense_ < 0;
    const bool by_level = mode_ == mcOn || mode_ == mcOff;
    if ((by_level || !turning) && reached()) return SearchMove::found(edge_.place());
    if (limit_ahead) {
        if (reversed_) return SearchMove::failed();
        reversed_ = true;
        turn(one_way() ? Phase::pass_on : Phase::search, -sense_);
    }
    return SearchMove::along(sense_, true);
}

SearchMove SwitchSearch::step(const SearchInput& in) noexcept {
    if (phase_ == Phase::start) begin(in.signal);
    edge_.see(in.signal, in.position);
    const bool limit_ahead = sense_ > 0 ? in.positive_limit : in.negative_limit;
    if (phase_ == Phase::search) return search(in, limit_ahead);
    if (limit_ahead) return SearchMove::failed();
    switch (phase_) {
        case Phase::pass_on:
            if (in.signal) turn(Phase::pass_off, sense_);
            break;
        case Phase::leave:
        case Phase::pass_off:
            if (!in.signal) turn(Phase::search, way_);
            break;
        case Phase::start:
        case Phase::search: break;
    }
    return SearchMove::along(sense_);
}

}  // namespace taktwerk::axes

#include "axes/homing/limit_search.hpp"

namespace taktwerk::axes {

using enum MC_SwitchMode;

bool LimitSearch::reached() const noexcept {
    switch (mode_) {
        case mcOn: return edge_.level();
        case mcOff: return !edge_.level();
        case mcRisingEdge: return towards_ && edge_.rising();
        case mcFallingEdge: return !towards_ && edge_.falling();
        case mcEdgeSwitchPositive:
        case mcEdgeSwitchNegative: break;
    }
    return false;
}

SearchMove LimitSearch::step(const SearchInput& in) noexcept {
    const bool on = positive_ ? in.positive_limit : in.negative_limit;
    const bool other_end = positive_ ? in.negative_limit : in.positive_limit;
    edge_.see(on, in.position);
    if (!begun_) {
        begun_ = true;
        towards_ = mode_ == mcOn || !on;
    }
    const int sense = towards_ == positive_ ? 1 : -1;
    const bool turning = in.set_velocity * sense < 0;
    if ((mode_ == mcOn || mode_ == mcOff || !turning) && reached()) return SearchMove::found(edge_.place());
    if (!towards_ && other_end) return SearchMove::failed();
    if (mode_ == mcFallingEdge && towards_ && on) towards_ = false;
    else if (mode_ == mcRisingEdge && !towards_ && !on) towards_ = true;
    const bool fine = mode_ == mcFallingEdge ? !towards_ : towards_ || mode_ == mcOff;
    return SearchMove::along(towards_ == positive_ ? 1 : -1, fine);
}

}  // namespace taktwerk::axes

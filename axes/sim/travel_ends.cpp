#include "axes/sim/travel_ends.hpp"

#include <algorithm>

namespace taktwerk::axes::sim {

bool TravelEnds::limits_count(const AxisInputs& in, bool homed) noexcept {
    const bool on = in.software_limits == SoftwareLimits::on || (in.software_limits == SoftwareLimits::after_homing && homed);
    return on && in.software_minimum < in.software_maximum;
}

double TravelEnds::within_limits(double wanted, const AxisInputs& in, bool homed) noexcept {
    if (!limits_count(in, homed)) return wanted;
    const double held = std::clamp(wanted, static_cast<double>(in.software_minimum), static_cast<double>(in.software_maximum));
    limited_ = held != wanted;
    return held;
}

int TravelEnds::past_switch(const Plant& plant) const noexcept {
    if (!warns_) return 0;
    return plant.negative_limit() ? -1 : plant.positive_limit() ? 1 : 0;
}

int TravelEnds::past_limit(double actual, const AxisInputs& in, bool homed) noexcept {
    if (!limits_count(in, homed)) return 0;
    return actual < static_cast<double>(in.software_minimum) ? -1 : actual > static_cast<double>(in.software_maximum) ? 1 : 0;
}

bool TravelEnds::stop_at(int end) noexcept {
    if (end == stopped_) return false;
    stopped_ = end;
    return true;
}

}  // namespace taktwerk::axes::sim

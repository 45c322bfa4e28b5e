#include "axes/sim/velocity_target.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

void VelocityTarget::ramp(double acceleration, double deceleration, double dt) noexcept {
    double left = dt;
    for (int part = 0; part < 2 && left > 0; ++part) {
        const double way = target_ - demand_;
        if (way == 0) return;
        const bool slower = demand_ != 0 && (demand_ > 0) != (way > 0);
        const double rate = slower ? deceleration : acceleration;
        const double span = slower ? std::min(std::abs(way), std::abs(demand_)) : std::abs(way);
        const double most = rate * left;
        demand_ += std::copysign(std::min(span, most), way);
        if (most <= span) return;
        left -= span / rate;
    }
}

}  // namespace taktwerk::axes::sim

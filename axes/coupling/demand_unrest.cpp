#include "axes/coupling/demand_unrest.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

void DemandUnrest::look(const GearDemand& now) noexcept {
    constexpr double kept = 1 - 1.0 / 32;  // from cycle to cycle: an encoder's counts come up and down in a rhythm of their own
    const double step = now.velocity - last_.velocity, bend = step - step_, turn = now.acceleration - last_.acceleration;
    const bool filtered = now.trend != 0 && now.trend != now.velocity;
    const double swing = filtered && known_ > 2 && bend * bend_ < 0 ? std::min(std::abs(bend), std::abs(bend_)) : 0.0;
    noise_ = std::max(kept * noise_, std::min(swing, once_));
    once_ = std::max(kept * once_, swing);
    change_ = known_ > 1 ? std::min(std::abs(turn), std::abs(turn_)) : 0.0;
    step_ = known_ > 0 ? step : 0.0;
    turn_ = known_ > 0 ? turn : 0.0;
    bend_ = bend;
    last_ = now;
    known_ = std::min(known_ + 1, 3);
}

}  // namespace taktwerk::axes

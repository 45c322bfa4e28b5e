#include "axes/axis/stopping_way.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

double StoppingWay::allowance(const Sample& now) noexcept {
    const bool begins = now.told_to_stop && !stops_;
    stops_ = now.told_to_stop;
    if (!stops_) return allowance_ = std::min(allowance_, std::abs(now.error));
    if (begins) {
        from_ = now.place;
        const double speed = std::max(std::abs(now.velocity), now.speed);
        most_ = now.window + speed * now.latency + (now.deceleration > 0 ? speed * speed / (2 * now.deceleration) : 0);
    }
    return allowance_ = std::abs(now.place - from_) <= most_ ? std::abs(now.error) : 0;
}

}  // namespace taktwerk::axes

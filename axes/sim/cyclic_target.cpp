#include "axes/sim/cyclic_target.hpp"

#include <algorithm>

#include "axes/sim/inner_step.hpp"

namespace taktwerk::axes::sim {

namespace {

// SV33-E E.424, "several times above the single maximum speed"; how often: P0A.33, 3 times from the factory.
constexpr std::uint32_t allowed_strikes = 3;
constexpr double increment_factor = 1.0;

}  // namespace

bool CyclicTarget::leaps(double increment, double fastest, double seconds) noexcept {
    largest_increment_ = std::max(largest_increment_, increment);
    if (fastest > 0 && increment > increment_factor * fastest * seconds) return ++strikes_ >= allowed_strikes;
    strikes_ = 0;
    return false;
}

void CyclicTarget::go(const Demand& from, double wanted, double seconds) noexcept {
    target_ = wanted;
    steps_left_ = std::max<std::int64_t>(1, std::llround(seconds / inner_seconds));
    step_ = (target_ - from.position) / (static_cast<double>(steps_left_) * inner_seconds);
}

void CyclicTarget::step(Demand& demand, double dt) noexcept {
    if (steps_left_ == 0) {
        demand.velocity = 0;
        return;
    }
    --steps_left_;
    demand.velocity = step_;
    demand.position = steps_left_ == 0 ? target_ : demand.position + step_ * dt;
}

}  // namespace taktwerk::axes::sim

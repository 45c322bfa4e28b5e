// How the motor comes to rest when its power is taken, and the holding brake.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

bool Cia402Axis::stands() const noexcept {
    return std::abs(plant_.velocity()) < 0.01 * static_cast<double>(personality_.counts_per_revolution);
}

/// Power goes by command: the motor first stops, then holds until the brake does, as far as this drive does either.
void Cia402Axis::wind_down() noexcept {
    winding_down_ = personality_.off_stop == FaultStop::ramp || (has_brake() && stands());
    winding_down_until_ = now_ + personality_.brake_hold;
    if (winding_down_) demand_ = {plant_.position(), plant_.velocity(), 0};
}

void Cia402Axis::step_brake() noexcept {
    if (winding_down_) {
        if (!stands()) winding_down_until_ = now_ + personality_.brake_hold;
        else if (now_ >= winding_down_until_) winding_down_ = false;
    }
    brake_closed_ = has_brake() && stands() && (state_ == State::enabled ? now_ < brake_opens_ : !energised());
    plant_.hold(brake_closed_);
}

bool Cia402Axis::energised() const noexcept {
    return state_ == State::enabled || state_ == State::quick_stop || winding_down_ ||
           (state_ == State::fault_reaction && personality_.fault_stop == FaultStop::ramp);
}

void Cia402Axis::stop_step(double dt, double deceleration) noexcept {
    const double most = deceleration > 0 ? deceleration * dt : std::abs(demand_.velocity);
    demand_.velocity -= std::clamp(demand_.velocity, -most, most);
    demand_.position += demand_.velocity * dt;
}

double Cia402Axis::stopping_torque(double dt) noexcept {
    stop_step(dt, personality_.quick_stop_deceleration);
    return loop_.velocity_control(plant_, demand_.velocity, 0, torque_limit(), dt);
}

void Cia402Axis::end_stop() noexcept {
    if (state_ == State::fault_reaction && (personality_.fault_stop == FaultStop::coast || stands())) enter(State::fault);
    if (state_ == State::quick_stop && personality_.quick_stop_leaves && demand_.velocity == 0 && stands()) enter(State::disabled);
}

}  // namespace taktwerk::axes::sim

// What makes the motor come to rest: power taken, a quick stop, a halt, a fault; and the holding brake. How it does: stop_run.hpp.

#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

StopOrder Cia402Axis::stop_for(StopCause cause) const noexcept { return stop_order(*profile_, cause, mode_, settings_); }

void Cia402Axis::begin_stop(const StopOrder& order) noexcept {
    if (mode::of_torque(mode_)) motor_.keep_torque();
    stop_.begin(order);
    motor_.demand_motion();
    // What was on its way is discarded by a quick stop (SV-DA200 3.2.7, SV33-E 3.4.3(5)).
    if (state_ != State::enabled || has(Quirk::pp_stop_forgets)) profile_position_.forget(motor_.position());
}

/// Bit 8. Homing has its own abort.
void Cia402Axis::take_halt(const AxisInputs& in) noexcept {
    const bool wanted = (in.control & 0x100u) != 0 && state_ == State::enabled && mode_ != mode::homing;
    if (wanted == stop_.halted()) return;
    if (wanted) begin_stop(stop_for(StopCause::halt));
    stop_.halt(wanted);
    if (wanted || state_ != State::enabled) return;
    motor_.demand_motion();
    velocity_.demand(stands() ? 0 : motor_.velocity());
    cyclic_.rest(motor_.position());
    profile_position_.resume(stands() ? Demand{motor_.position(), 0, 0} : motor_.demand());
}

double Cia402Axis::stopping_torque(double dt) noexcept {
    return stop_.torque(motor_, torque_, {settings_, state_ == State::enabled, origin_.zero()}, dt);
}

void Cia402Axis::end_stop() noexcept {
    if (state_ == State::fault_reaction && (stop_.order().by == StopBy::coast || stands())) {
        stop_.short_phases();
        enter(State::fault);
    }
    if (state_ == State::quick_stop && stop_.order().then == StopThen::free && stop_.over()) enter(State::disabled);
}

/// Power goes by command: the motor first stops, then holds until the brake does, as far as this drive does either.
void Cia402Axis::wind_down(StopCause cause) noexcept {
    const auto order = stop_for(cause);
    if (!stop_.wind_down(order, brake_.present() && stands(), now_ + brake_.hold())) return;
    begin_stop(order.by != StopBy::coast ? order : StopOrder{StopBy::zero_speed, StopThen::free});
}

void Cia402Axis::step_brake() noexcept {
    stop_.step(stands(), now_, brake_.hold());
    motor_.hold(brake_.step({energised(), state_ == State::enabled, stop_.winding_down(), stands(), std::abs(plant().velocity())}, now_));
}

}  // namespace taktwerk::axes::sim

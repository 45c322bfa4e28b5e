// How the motor comes to rest when its power is taken, at a quick stop, a halt and a fault; and the holding brake. The ways are the drive's
// own (DriveStops::options, CiA 402-2 605Ah to 605Eh); where its manual documents none, undocumented_stop() decides.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr double shorted_damping = 20.0;  // 1/s: a motor with shorted phases loses its speed in some 50 ms

bool fits(const StopWay& way, DriveMode mode) noexcept {
    return way.modes.empty() || std::find(way.modes.begin(), way.modes.end(), mode) != way.modes.end();
}

}  // namespace

bool Cia402Axis::stands() const noexcept { return std::abs(seen_velocity()) < 0.01 * static_cast<double>(motor_.counts_per_revolution); }

double Cia402Axis::ramp_of(StopBy by) const noexcept {
    switch (by) {
        case StopBy::ramp:
            return mode_ == mode::homing ? settings_.homing.acceleration
                                         : static_cast<double>(mode_ == mode::profile_position && has(Quirk::pp_shared_ramp)
                                                                   ? settings_.profile_acceleration
                                                                   : settings_.profile_deceleration);
        case StopBy::quick_ramp: return static_cast<double>(settings_.quick_stop_deceleration);
        default: return 0;
    }
}

Cia402Axis::StopOrder Cia402Axis::undocumented_stop(StopCause cause) const noexcept {
    const StopOrder braked{StopBy::zero_speed, StopThen::free};
    const StopOrder let_go{StopBy::coast, StopThen::free};
    switch (cause) {
        case StopCause::quick_stop: return {braked.by, profile_->stops.quick_stop_leaves ? StopThen::free : StopThen::lock};
        case StopCause::fault: return profile_->stops.fault == DriveStop::ramp ? braked : let_go;
        case StopCause::off:
        case StopCause::shutdown:
        case StopCause::disable: return profile_->stops.off == DriveStop::ramp ? braked : let_go;
        case StopCause::halt: {
            const double by_6084 = ramp_of(StopBy::ramp);
            return {by_6084 > 0 ? StopBy::ramp : StopBy::zero_speed, StopThen::lock, by_6084, by_6084 <= 0};
        }
        case StopCause::overtravel: return {StopBy::zero_speed, StopThen::lock};
    }
    return braked;
}

Cia402Axis::StopOrder Cia402Axis::stop_for(StopCause cause) const noexcept {
    const auto& stops = profile_->stops.options;
    const auto of = [&](StopCause wanted) {
        return std::find_if(stops.begin(), stops.end(), [&](const auto& s) { return s.cause == wanted; });
    };
    auto option = of(cause);
    if (option == stops.end() && (cause == StopCause::shutdown || cause == StopCause::disable)) option = of(StopCause::off);
    if (option == stops.end()) return undocumented_stop(cause);
    const auto place = static_cast<std::size_t>(option - stops.begin());
    const auto value = place < most_stop_options ? settings_.stop_values[place] : 0;
    const StopWay* chosen = nullptr;
    for (const auto& way : option->ways) {
        if (!fits(way, mode::meaning(mode_))) continue;
        if (!chosen) chosen = &way;
        if (option->object.index == 0 || way.value == value) {
            chosen = &way;
            break;
        }
    }
    if (!chosen) return undocumented_stop(cause);
    return {chosen->by, chosen->then, ramp_of(chosen->by), chosen->by != StopBy::ramp && chosen->by != StopBy::quick_ramp};
}

void Cia402Axis::begin_stop(const StopOrder& order) noexcept {
    if (mode::of_torque(mode_)) loop_.take_over(torque_);
    stop_ = order;
    stop_done_ = false;
    demand_ = {seen_position(), seen_velocity(), 0};
    // What was on its way is discarded by a quick stop (SV-DA200 3.2.7, SV33-E 3.4.3(5)).
    if (state_ != State::enabled || has(Quirk::pp_stop_forgets)) profile_position_.forget(seen_position());
}

/// Bit 8. Homing has its own abort.
void Cia402Axis::take_halt(const AxisInputs& in) noexcept {
    const bool wanted = (in.control & 0x100u) != 0 && state_ == State::enabled && mode_ != mode::homing;
    if (wanted == halted_) return;
    if (wanted) {
        begin_stop(stop_for(StopCause::halt));
        halted_ = true;
        return;
    }
    halted_ = false;
    if (state_ != State::enabled) return;
    demand_ = {seen_position(), seen_velocity(), 0};
    velocity_demand_ = stands() ? 0 : seen_velocity();
    target_ = seen_position();
    steps_left_ = 0;
    profile_position_.resume(stands() ? Demand{seen_position(), 0, 0} : demand_);
}

double Cia402Axis::brake_torque() const noexcept {
    return std::clamp(-plant_.torque_for(shorted_damping * plant_.velocity()), -torque_limit(), torque_limit());
}

/// Torque while the motor is slowed down.
double Cia402Axis::slowing_torque(double dt) noexcept {
    const auto velocity_loop = [&](double limit) {
        const double most = stop_.at_once ? std::abs(demand_.velocity) : stop_.ramp * dt;
        demand_.velocity -= std::clamp(demand_.velocity, -most, most);
        if (!stepper_) demand_.position += demand_.velocity * dt;
        return velocity_torque(demand_.velocity, 0, limit, dt);
    };
    switch (stop_.by) {
        case StopBy::coast: return 0;
        case StopBy::dynamic_brake: return brake_torque();
        case StopBy::torque_slope:
            torque_target_ = 0;
            ramp_torque(dt);
            return ServoLoop::torque_control(plant_, torque_demand_, fastest_, torque_limit());
        case StopBy::emergency_torque: {
            const double own = torque_of(settings_.emergency_torque);
            return velocity_loop(own > 0 ? std::min(own, torque_limit()) : torque_limit());
        }
        case StopBy::ramp:
        case StopBy::quick_ramp:
        case StopBy::zero_speed: return velocity_loop(torque_limit());
    }
    return 0;
}

double Cia402Axis::stopping_torque(double dt) noexcept {
    if (!stop_done_) {
        const double torque = slowing_torque(dt);
        const bool by_speed = stop_.by != StopBy::coast && stop_.by != StopBy::dynamic_brake && stop_.by != StopBy::torque_slope;
        stop_done_ = stands() && (!by_speed || demand_.velocity == 0) && (stop_.by != StopBy::torque_slope || torque_demand_ == 0);
        if (stop_done_) demand_ = {seen_position(), 0, 0};
        return torque;
    }
    switch (stop_.then) {
        case StopThen::lock: return position_torque(dt);
        case StopThen::clamp: return velocity_torque(0, 0, torque_limit(), dt);
        case StopThen::dynamic_brake:
            return state_ == State::enabled || winding_down_ ? velocity_torque(0, 0, torque_limit(), dt) : brake_torque();
        case StopThen::free: break;
    }
    // While the brake still closes, or the state has not followed yet, the motor holds (SV33-E 3.1.2(3)).
    return state_ == State::enabled ? 0 : velocity_torque(0, 0, torque_limit(), dt);
}

void Cia402Axis::end_stop() noexcept {
    if (state_ == State::fault_reaction && (stop_.by == StopBy::coast || stands())) {
        phases_shorted_ = stop_.then == StopThen::dynamic_brake;
        enter(State::fault);
    }
    if (state_ != State::quick_stop || stop_.then != StopThen::free) return;
    if (stop_.by == StopBy::coast || stop_done_) enter(State::disabled);
}

bool Cia402Axis::energised() const noexcept {
    return state_ == State::enabled || state_ == State::quick_stop || state_ == State::fault_reaction || winding_down_;
}

/// Power goes by command: the motor first stops, then holds until the brake does, as far as this drive does either.
void Cia402Axis::wind_down(StopCause cause) noexcept {
    auto order = stop_for(cause);
    const bool stops = order.by != StopBy::coast;
    const bool holds = has_brake() && stands();
    phases_shorted_ = order.then == StopThen::dynamic_brake;
    winding_down_ = stops || holds;
    winding_down_until_ = now_ + profile_->brake.hold;
    if (!winding_down_) return;
    if (!stops) order = {StopBy::zero_speed, StopThen::free};
    begin_stop(order);
}

void Cia402Axis::step_brake() noexcept {
    if (winding_down_) {
        if (!stands()) winding_down_until_ = now_ + profile_->brake.hold;
        else if (now_ >= winding_down_until_) winding_down_ = false;
    }
    if (energised()) power_went_ = now_;
    const bool told = brake_told_to_close();
    brake_closing_ = told ? brake_closing_ + inner_period : Duration{};
    brake_closed_ = told && brake_closing_ >= plant_.config().brake_closing;
    plant_.hold(brake_closed_);
}

/// The drive's output for the brake. At standstill it says so before it lets go, as long as the machine's brake needs (TSVM PA47, SV33-E
/// P05.14); a brake that is never late closes as the motor lets go. In motion it waits until the motor is slow (TSVM PA48, PA49).
bool Cia402Axis::brake_told_to_close() const noexcept {
    if (bus_opens_brake_) return !*bus_opens_brake_;
    if (!has_brake()) return false;
    const bool told_before = brake_closing_ > Duration::zero();
    if (state_ == State::enabled) return now_ < brake_opens_ && (stands() || told_before);
    if (winding_down_) return stands() && plant_.config().brake_closing > Duration::zero();
    if (energised()) return false;
    const bool slow = std::abs(plant_.velocity()) < brake_moving_speed_;
    const bool waited = profile_->brake.moving_wait > Duration::zero() && now_ - power_went_ >= profile_->brake.moving_wait;
    return stands() || slow || waited || told_before;
}

}  // namespace taktwerk::axes::sim

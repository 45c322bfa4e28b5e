#include "axes/axis/drive_output.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_homing.hpp"
#include "axes/axis/axis_parameters.hpp"
#include "axes/axis/axis_probes.hpp"
#include "axes/axis/axis_reset.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/parameters.hpp"
#include "axes/axis/torque_bounds.hpp"

namespace taktwerk::axes {

namespace {

/// The history is as long as the dead time of a bus. For a slow line it keeps one set-point in several cycles.
bool remembers(const DriveCapabilities& drive, Instant now, Duration cycle) {
    if (drive.setpoints == SetpointClass::cyclic) return true;
    constexpr int kept = 12;  // set-points for a worst latency, of SetpointHistory::depth
    const Duration spacing = std::max<Duration>((drive.command_latency + drive.feedback_period) / kept, cycle);
    const auto at = now.time_since_epoch();
    return at / spacing != (at - cycle) / spacing;
}

}  // namespace

void DriveOutput::encode(Instant now) noexcept {
    command_ = {};
    command_.power = body_.power.request();
    command_.reset_fault = reset_.resetting() && (measured_.faulted() || measured_.feedback.setup_refused);
    command_.start_homing = runs_.drive.start_level();
    if (runs_.drive.busy()) command_.homing = homing_.drive_setup();
    const auto& set = motion_.setpoint.state();
    if (!measured_.compensation.none())
        measured_.compensation.step(body_.units.machine(set.position), set.velocity, body_.homed, body_.cycle);
    fill_targets();
    probes_.command(command_.probes);
    if (runs_.latch.armed()) command_.probes[runs_.latch.probe()] = runs_.latch.command();
    command_.digital_outputs = body_.shown.digital_outputs;
    command_.digital_output_mask = parameters_.output_mask();
    command_.brake = body_.brake.request();
    if (bounds_.used()) fill_torque_limits();
    if (runs_.step.presses() && body_.port.capabilities().torque_limits) {
        command_.torque_limit_positive = std::min(command_.torque_limit_positive, runs_.block_torque);
        command_.torque_limit_negative = std::min(command_.torque_limit_negative, runs_.block_torque);
    }
    body_.port.encode(command_, now);

    if (runs_.motor_leads() || modes_.phase != ModePhase::steady) following_.forget();
    else if (remembers(body_.port.capabilities(), now, body_.cycle))
        following_.record(body_.port.setpoint_effective(now), command_.position);
}

void DriveOutput::encode_setpoint(Instant now) noexcept {
    const auto& set = motion_.setpoint.state();
    command_.position = body_.units.counts(set.position);
    command_.velocity = body_.config.control.feed_forward * set.velocity * body_.units.counts_per_unit();
    command_.torque = torque_per_acceleration_ * set.acceleration;
    body_.port.encode(command_, now);
    following_.record(body_.port.setpoint_effective(now), command_.position);
}

void DriveOutput::fill_targets() noexcept {
    const auto& set = motion_.setpoint.state();
    const auto& control = body_.config.control;
    const double counts = body_.units.counts_per_unit();
    command_.mode = modes_.wanted();
    command_.position = measured_.seeded ? body_.units.counts(set.position + measured_.compensation.offset()) : measured_.feedback.position;
    command_.velocity = control.feed_forward * set.velocity * counts;
    command_.torque = torque_per_acceleration_ * set.acceleration;
    if (load_.used()) {
        const bool held = modes_.phase == ModePhase::steady && !body_.power.follows_actual();
        command_.torque += (body_.config.gearing.inverted ? -1 : 1) * load_.step(set.velocity, held, to_seconds(body_.cycle));
    }
    if (body_.slow_line) {
        // Told to stop, the drive ramps by itself: one word on the line ends the motion, whatever becomes of the line then.
        const bool ends_torque = modes_.phase == ModePhase::leaving || (modes_.phase == ModePhase::torque && !modes_.torque_wanted());
        command_.halt = motion_.goal.kind == Goal::Kind::stop || ends_torque;
        const auto& limits = body_.config.limits;
        const double braking = limits.deceleration_towards(set.velocity);
        const double deceleration = command_.halt ? motion_.goal.limits.deceleration : braking;
        command_.acceleration = limits.acceleration_towards(set.velocity) * std::abs(counts);
        command_.deceleration = deceleration * std::abs(counts);
    }
    if (modes_.own == DriveMode::cyclic_velocity || modes_.own == DriveMode::profile_velocity) {
        const bool closed = modes_.phase == ModePhase::steady && measured_.online() && !body_.power.follows_actual();
        const double limit = control.output_limit > 0 ? control.output_limit : 1.2 * body_.shown.parameters[place_of(velocity_of_system)];
        double velocity = modes_.phase == ModePhase::leaving
                              ? set.velocity
                              : control.feed_forward * set.velocity + (closed ? control.kv * following_.error() : 0);
        if (integral_.used()) velocity += integral_part(velocity, limit, closed);
        command_.velocity = std::clamp(velocity, -limit, limit) * counts;
    }
    if (modes_.phase == ModePhase::steady) return;
    if (modes_.in_profile()) fill_drive_profile();
    else fill_torque();
    command_.halt = command_.halt || modes_.halt;
}

/// Pressed against a block, and where the axis stops for good, an error is no reason to push on.
double DriveOutput::integral_part(double given, double most, bool closed) noexcept {
    if (!closed) {
        integral_.clear();
        return 0;
    }
    const double dt = to_seconds(body_.cycle);
    const bool gives_up = body_.state == AxisState::Stopping || body_.state == AxisState::ErrorStop || runs_.step.presses();
    return gives_up ? integral_.run_out(dt) : integral_.step(following_.error(), given, most, dt);
}

void DriveOutput::fill_torque() noexcept {
    if (modes_.phase == ModePhase::entering) command_.torque = measured_.feedback.torque;  // what the motor has when it takes the mode
    if (modes_.phase != ModePhase::torque) return;
    const double counts = body_.units.counts_per_unit();
    command_.torque = (body_.config.gearing.inverted ? -1 : 1) * modes_.torque.torque();
    command_.velocity_limit = modes_.torque_velocity * std::abs(counts);
}

/// The motor's positive sense may be the axis' negative one.
void DriveOutput::fill_torque_limits() noexcept {
    const auto& range = bounds_.range();
    command_.torque_limit_positive = body_.config.gearing.inverted ? range.negative : range.positive;
    command_.torque_limit_negative = body_.config.gearing.inverted ? range.positive : range.negative;
    bounds_.tell();
}

void DriveOutput::fill_drive_profile() noexcept {
    command_.velocity = command_.torque = 0;
    if (modes_.phase == ModePhase::profile_entering) return;
    const auto& made = modes_.run.setpoint();
    command_.profile = modes_.run.announced();
    if (modes_.run.mode() == DriveMode::profile_position) command_.position = made.position;
    command_.velocity = made.velocity;
    command_.torque = made.torque;
    command_.acceleration = made.acceleration;
    command_.deceleration = made.deceleration;
    command_.torque_slope = made.torque_slope;
    command_.velocity_limit = made.velocity_limit;
    if (!modes_.halt) return;
    command_.torque = 0;  // what the halt does is the drive's affair; at least nothing drives on
    const auto& stopping = body_.queue.active().command;
    const bool error = body_.state == AxisState::ErrorStop;
    const auto braking = error ? stop_limits(body_.config.limits) : dynamics_of(stopping, body_.config.limits, body_.config.defaults);
    command_.deceleration = braking.deceleration * std::abs(body_.units.counts_per_unit());
}

}  // namespace taktwerk::axes

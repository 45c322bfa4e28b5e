#include "axes/axis/view_writer.hpp"

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

ViewWriter::ViewWriter(AxisCore& axis, AxisView& view) : axis_(axis), view_(view) {
    view_ = {};
    view_.simulated = axis.body.config.simulated;
    view_.modulo = axis.body.config.modulo;
    axis.parameters.store();
    axis.parameters.use();
    brake();
    publish();
}

void ViewWriter::publish() noexcept {
    states();
    resets();
    feedback(axis_.measured.local());
    setpoint();
    probes();
    passive_homing();
    side(SideSlot::torque_limit, axis_.bounds.id());
    view_.torque_limit_positive = axis_.bounds.range().positive;
    view_.torque_limit_negative = axis_.bounds.range().negative;
    view_.override_factors = axis_.motion.now.asked;
    view_.operators_override = axis_.motion.now.operators;
    view_.selected_cam = axis_.coupling.links.selected;
    view_.selected_as = axis_.coupling.links.selected_as;
}

void ViewWriter::states() noexcept {
    const auto& body = axis_.body;
    if (view_.state != body.state) resets();
    view_.state = body.state;
    view_.owner = body.owner;
    view_.presence = body.presence;
    view_.powered = body.power.on() && body.state != AxisState::Disabled;
    view_.enable = body.power_wish;
    view_.enable_positive = body.permit_positive;
    view_.enable_negative = body.permit_negative;
    view_.homed = body.homed;
    view_.homing_procedure = body.homing_procedure;
    view_.lock = body.lock;
    view_.error = body.error;
    if (axis_.coupling.links.state.shown) couplings();
    axis_.body.queue.publish(view_);
}

void ViewWriter::resets() noexcept {
    view_.resetting = axis_.reset.resetting();
    view_.reset_error = axis_.conduct.reset_error();
}

void ViewWriter::probes() noexcept {
    side(SideSlot::probe1, axis_.probes.id(0));
    side(SideSlot::probe2, axis_.probes.id(1));
    view_.probe_position = axis_.probes.positions();
    view_.probe_latched = axis_.probes.latched();
}

void ViewWriter::passive_homing() noexcept { side(SideSlot::passive_homing, axis_.homing.passive.id()); }

void ViewWriter::brake() noexcept { view_.brake = axis_.body.brake.state(); }

void ViewWriter::skew() noexcept { view_.skew = axis_.gantry.skew(); }

void ViewWriter::load() noexcept { view_.load_difference = axis_.load.difference(); }

void ViewWriter::couplings() noexcept {
    auto& state = axis_.coupling.links.state;
    state.shown = state.used();  // what is over is shown once more, as gone
    const bool coupled = axis_.motion.now.goal.kind == Goal::Kind::coupled && state.running.id != 0;
    const auto& link = coupled ? state.running : state.next;
    view_.master = link.id != 0 ? link.masters.axes[0] : AxisRef{};
    view_.sync_started = coupled && state.next.id == 0 && state.follower.approaching();
    view_.cam_ends = state.cam_ends;
    view_.phase_shift = state.phase.state().position;
    view_.phase_covered = state.phase.covered();
    view_.phasing_queued = state.phasing_next.id;
    side(SideSlot::phasing, state.phasing.id);
}

void ViewWriter::feedback(double actual) noexcept {
    const auto& measured = axis_.measured;
    const auto& from_drive = measured.feedback;
    view_.online = measured.online();
    view_.answered = from_drive.fresh;
    view_.in_position = axis_.following.in_position(axis_.body);
    view_.following_error = axis_.following.error();
    if (axis_.body.config.following.per_velocity > Duration::zero()) view_.following_window = axis_.following.window();
    view_.warning = from_drive.warning;
    view_.drive_error = from_drive.error_code;

    view_.actual_position = axis_.body.units.to_program(axis_.body.config.load_encoder.shown ? actual + axis_.load.difference() : actual);
    view_.actual_velocity = measured.velocity();
    view_.actual_torque = measured.torque();

    view_.drive_state = from_drive.power;
    view_.drive_mode = from_drive.mode;
    view_.status_word = from_drive.status_word;
    view_.negative_limit_switch = measured.negative_switch;
    view_.positive_limit_switch = measured.positive_switch;
    view_.home_switch = from_drive.home_switch;
    view_.digital_inputs = from_drive.digital_inputs;
}

void ViewWriter::setpoint() noexcept {
    const auto& motion = axis_.motion.now;
    const auto& generator = motion.setpoint;
    const auto& units = axis_.body.units;
    const auto& set = generator.state();
    const double rest = generator.layered() ? generator.superimposed().position + generator.superimposed_rest() : 0;
    const double end = (motion.goal.kind == Goal::Kind::position ? motion.goal.value : generator.end().position) + rest;
    view_.set_position = units.to_program(set.position);
    view_.target_position = units.to_program(end);
    if (units.modulo() > 0) view_.turns = units.turns(set.position);
    view_.set_velocity = set.velocity;
    view_.set_acceleration = set.acceleration;
    view_.set_jerk = generator.jerk();
    view_.superimposed_covered = axis_.motion.addition.covered();
    view_.limiter = generator.at_rest() && !motion.held ? VelocityLimiter::none : motion.limiter();
}

void ViewWriter::target(double place) noexcept { view_.target_position = axis_.body.units.to_program(place); }

}  // namespace taktwerk::axes

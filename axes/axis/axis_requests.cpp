// What others ask of the axis: checked and answered in the same call.

#include <cmath>

#include "axes/axis/axis.hpp"
#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

/// To the queue: behind what is there, or in its place.
Submitted take(AxisCore& axis, const AxisCommand& command, Owner owner) noexcept {
    auto& body = axis.body;
    auto& motion = axis.motion.now;
    // Commands of one cycle are taken one after another (P1-016): this one adds to the target of the one before.
    if (body.begin_pending && command.kind == CommandKind::move_additive) axis.succession.begin_command();
    if (const auto error = axis.admission.refuse(command); error != ErrorId::none) return {0, error};

    const AcceptedCommand accepted{body.queue.next_id(), owner, command};
    if (axis.admission.waits(command)) {
        body.queue.push(accepted);
        // It may let the running move, or one behind it, pass its end without a stop.
        if (command.buffer_mode != mcBuffered && motion.goal.kind == Goal::Kind::position && !body.begin_pending)
            motion.goal_pending = true;
    } else {
        axis.conduct.give_way(command);
        body.queue.activate(accepted);
        if (body.state != AxisState::Stopping) axis.conduct.fire(event_of(command.kind));
        if (command.kind == CommandKind::stop) body.lock = accepted.id;
        body.begin_pending = true;
    }
    if (command.kind == CommandKind::jog) axis.jog.begin();
    return {accepted.id, ErrorId::none};
}

Submitted take_superimposed(AxisCore& axis, const AxisCommand& command, Owner owner) noexcept {
    if (const auto error = axis.admission.refuse_superimposed(command); error != ErrorId::none) return {0, error};
    const AcceptedCommand accepted{axis.body.queue.next_id(), owner, command};
    axis.motion.addition.begin(accepted);
    if (command.kind == CommandKind::move_superimposed && axis.body.state == AxisState::Standstill)
        axis.conduct.fire(AxisEvent::superimposed);  // P1-030
    return {accepted.id, ErrorId::none};
}

Submitted answer(AxisCore& axis, const AxisCommand& command, Owner owner) noexcept {
    using enum kind_table::Slot;
    if (!connected(axis.body.presence)) return {0, ErrorId::not_connected};
    const auto slot = slot_of(command.kind);
    if (slot == probe) return axis.probes.submit(command);  // moves nothing: any party may
    if (!axis.body.may(owner)) return {0, ErrorId::owned_by_other};
    if (slot == torque_limit) return axis.bounds.submit(command);
    if (axis.body.led()) return {0, ErrorId::axis_grouped};
    if (command.kind == CommandKind::group_motion) return {0, ErrorId::not_supported};
    // A set-point for each cycle does not get through a slow line.
    if (axis.body.slow_line && needs_each_cycle(command.kind)) return {0, ErrorId::not_supported};
    if (slot == phasing) return axis.coupling.phasing.submit(command, owner);
    if (slot == setting) return axis.settings.submit(command, owner);
    if (beside(command)) return axis.homing.passive.submit(command);
    if (slot == superimposed) return take_superimposed(axis, command, owner);
    return take(axis, command, owner);
}

/// What a group gives keeps the axis' jerk: a stop takes its acceleration over.
AxisCommand group_command(const AxisLimits& limits, const void* instance) noexcept {
    return {.kind = CommandKind::group_motion, .jerk = std::isfinite(limits.jerk) ? limits.jerk : 0, .instance = instance};
}

void show_all(AxisCore& axis) noexcept {
    (void)axis.settings.changed();
    axis.writer.publish();
}

/// Nobody's axis has gone to the first who asked.
void show_owner(AxisCore& axis) noexcept {
    if (axis.body.shown.owner != axis.body.owner) axis.writer.states();
}

/// Apart, so that the wish renewed in each cycle saves no registers for it.
[[gnu::noinline]] ErrorId wish_for_power(AxisCore& axis, bool enable, bool positive, bool negative, Owner owner) noexcept {
    axis.plain.disturb();
    if (!axis.body.may(owner)) return ErrorId::owned_by_other;
    const bool ends = !enable && axis.body.power_wish;
    const auto error = axis.supply.request(enable, positive, negative);
    if (ends) axis.writer.publish();
    else show_owner(axis);
    return error;
}

}  // namespace

Submitted Axis::submit(const AxisCommand& command, Owner owner) noexcept {
    core_->plain.disturb();
    const auto given = answer(*core_, command, owner);
    // A probe that is refused may have ended the one that it was to replace.
    if (given.id != 0 || slot_of(command.kind) == kind_table::Slot::probe) show_all(*core_);
    else core_->writer.states();
    return given;
}

ErrorId Axis::power(bool enable, bool positive, bool negative, Owner owner) noexcept {
    auto& body = core_->body;
    const bool as_before = enable && positive == body.permit_positive && negative == body.permit_negative && owner == body.owner;
    if (!as_before || !core_->plain.calm()) return wish_for_power(*core_, enable, positive, negative, owner);
    return ++body.power_calls > 1 ? ErrorId::power_conflict : ErrorId::none;
}

ErrorId Axis::reset(Owner) noexcept {
    core_->plain.disturb();
    acknowledge_alarms();
    const auto error = core_->reset.request();
    if (core_->reset.resetting()) core_->writer.publish();
    return error;
}

ErrorId Axis::set(const AxisSetting& setting, Owner owner) noexcept {
    core_->plain.disturb();
    const auto error = core_->settings.apply(setting, owner);
    if (core_->settings.changed()) core_->writer.publish();
    else show_owner(*core_);
    return error;
}

ErrorId Axis::refuses_group(Owner owner) noexcept {
    auto& axis = *core_;
    auto& body = axis.body;
    if (!connected(body.presence)) return ErrorId::not_connected;
    if (!body.may(owner)) return ErrorId::owned_by_other;
    if (body.slow_line) return ErrorId::not_supported;
    if (body.led()) return ErrorId::axis_grouped;
    if (const auto error = axis.admission.refuse(group_command(body.config.limits, nullptr)); error != ErrorId::none) return error;
    const bool free = body.state == AxisState::Standstill && !body.queue.has_active() && body.queue.waiting() == 0 &&
                      !axis.conduct.moves() && axis.homing.passive.id() == 0;
    return free ? ErrorId::none : ErrorId::member_moves;
}

Submitted Axis::join_group(const void* instance, Owner owner) noexcept {
    if (const auto error = refuses_group(owner); error != ErrorId::none) return {0, error};
    auto& axis = *core_;
    axis.plain.disturb();
    const auto given = take(axis, group_command(axis.body.config.limits, instance), owner);
    // At once: its first set-point comes before it plans, and is meant in the coordinates in which it begins.
    if (given.id != 0) axis.succession.begin_command();
    show_all(axis);
    return given;
}

ErrorId Axis::lead(const SetpointFeed& next) noexcept {
    auto& axis = *core_;
    if (!axis.body.led()) return ErrorId::member_left;
    axis.plain.disturb();
    const auto error = axis.motion.given.feed(next);
    if (error == ErrorId::none) return error;
    axis.conduct.end_with(error);
    axis.writer.publish();
    return error;
}

void Axis::leave_group() noexcept {
    auto& axis = *core_;
    if (!axis.body.led()) return;
    axis.plain.disturb();
    axis.conduct.halt_on_own_account();
    axis.writer.publish();
}

void Axis::path_driven_by(AxisRef driver) noexcept { core_->coupling.links.path_master = driver; }

bool Axis::is_followed_by(const Axis& other) const noexcept {
    return core_->coupling.as_master.is_followed_by(other.core_->coupling.as_master);
}

ErrorId Axis::update(CommandId id, const AxisCommand& command, Owner owner) noexcept {
    core_->plain.disturb();
    const bool may = core_->body.may(owner);
    show_owner(*core_);
    return may ? core_->updates.update(id, command) : ErrorId::owned_by_other;
}

void Axis::release_stop(CommandId id, Owner) noexcept {
    auto& axis = *core_;
    if (id == 0 || id != axis.body.lock) return;
    axis.plain.disturb();
    axis.body.lock = 0;
    if (!axis.body.queue.has_active()) axis.writer.no_holder();
    // One that is not done yet ends by itself: the motor may come to rest after the set-point.
    const bool done = !axis.body.queue.has_active() && !axis.conduct.moves() && !axis.motion.now.goal_pending;
    if (axis.body.state == AxisState::Stopping && done && axis.conduct.leave_stopping()) axis.succession.start_waiting(0);
    axis.writer.publish();
}

ErrorId Axis::renew_jog(CommandId id, double velocity, Owner owner) noexcept {
    core_->plain.disturb();
    const bool may = core_->body.may(owner);
    show_owner(*core_);
    return may ? core_->jog.renew(id, velocity) : ErrorId::owned_by_other;
}

void Axis::set_mode(OperatingMode mode) noexcept {
    auto& axis = *core_;
    if (mode == axis.body.mode) return;
    axis.plain.disturb();
    axis.body.mode = mode;
    if (axis.body.state != AxisState::Disabled && axis.body.state != AxisState::ErrorStop && axis.conduct.moves())
        axis.conduct.stop_on_own_account(false);
    release_control(axis.body.owner);
}

double Axis::velocity_of_mode() const noexcept { return core_->body.velocity_cap(); }

void Axis::take_control(Owner owner) noexcept {
    if (owner == core_->body.owner) return;
    core_->plain.disturb();
    core_->conduct.change_hands(owner);
    core_->writer.publish();
}

ErrorId Axis::set_operators_override(double factor) noexcept {
    core_->plain.disturb();
    const auto error = core_->settings.set_operators_override(factor);
    if (core_->settings.changed()) core_->writer.publish();
    return error;
}

void Axis::release_control(Owner owner) noexcept {
    if (owner != core_->body.owner) return;
    take_control(core_->body.mode == OperatingMode::automatic ? Owner::program : Owner::operator_panel);
    core_->writer.publish();
}

}  // namespace taktwerk::axes

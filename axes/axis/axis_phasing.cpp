// MC_PhasingAbsolute, MC_PhasingRelative: a motion of its own, of the master's position as this slave sees it, beside the coupling.

#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

Submitted AxisCore::submit_phasing(const AxisCommand& command, Owner owner) noexcept {
    if (!may(owner)) return {0, ErrorId::owned_by_other};
    if (const auto error = refuse_phasing(command); error != ErrorId::none) return {0, error};
    const AcceptedCommand accepted{queue_.next_id(), owner, command};
    if (command.buffer_mode == mcBuffered) {
        coupling_.phasing_next = accepted;
        coupling_.phasing_behind = coupling_before_phasing(command).id;
        coupling_.shown = true;
    } else {
        end_phasing(Outcome::aborted);
        begin_phasing(accepted);
    }
    publish();
    return {accepted.id, ErrorId::none};
}

ErrorId AxisCore::refuse_phasing(const AxisCommand& command) const noexcept {
    for (const double value : {command.velocity, command.acceleration, command.deceleration, command.jerk})
        if (!(value >= 0) || std::isinf(value)) return value == command.velocity ? ErrorId::invalid_velocity : ErrorId::invalid_dynamics;
    if (!std::isfinite(command.position)) return ErrorId::invalid_position;
    if (command.buffer_mode != mcAborting && command.buffer_mode != mcBuffered) return ErrorId::buffer_mode_not_supported;
    // Between whom? There must be a master, and it must be the one meant where one is named.
    const bool buffered = command.buffer_mode == mcBuffered;
    const auto& coupling = coupling_before_phasing(command);
    const auto& link = coupling_.running.id != 0 ? coupling_.running : coupling_.next;
    const bool coupled = view_.state == AxisState::SynchronizedMotion && (link.id != 0 || couples(queue_.active().command.kind));
    if (buffered ? !couples(coupling.command.kind) : !coupled) return ErrorId::not_coupled;
    const auto master = !buffered && link.id != 0 ? link.masters.axes[0] : masters_of(coupling.command).axes[0];
    if (const auto named = masters_of(command).axes[0]; named.valid() && named != master) return ErrorId::invalid_master;
    if (!buffered) return ErrorId::none;
    // Table 4: nothing is buffered behind a phasing, nor behind a cam that repeats.
    const bool behind_phasing = coupling_.phasing_next.id != 0 || (coupling_.phasing.id != 0 && coupling.id == queue_.active().id);
    return behind_phasing || never_ends(coupling.command) ? ErrorId::buffer_mode_not_supported : ErrorId::none;
}

/// The coupling that a buffered phasing waits for is the last one given; an aborting one acts on the active.
const AcceptedCommand& AxisCore::coupling_before_phasing(const AxisCommand& command) const noexcept {
    if (command.buffer_mode == mcBuffered)
        for (std::size_t i = queue_.waiting(); i > 0; --i)
            if (const auto& before = queue_.waiting_at(i - 1); before.command.kind != CommandKind::setting) return before;
    return queue_.active();
}

/// Table 4: InGear, InSync, of a cam EndOfProfile. Inxxx has been shown for a cycle.
bool AxisCore::lets_phasing_begin() const noexcept {
    if (queue_.active().id != coupling_.phasing_behind) return false;
    if (queue_.active().command.kind != CommandKind::cam_in) return view_.active_in_target;
    const auto* cam = coupling_.running.id == coupling_.phasing_behind ? coupling_.follower.cam() : nullptr;
    return cam && cam->over();
}

void AxisCore::settle_waiting_phasing() noexcept {
    auto& state = coupling_;
    bool alive = queue_.active().id == state.phasing_behind;
    for (std::size_t i = 0; !alive && i < queue_.waiting(); ++i) alive = queue_.waiting_at(i).id == state.phasing_behind;
    if (alive && !lets_phasing_begin()) return;
    const auto next = state.phasing_next;
    state.phasing_next = {};
    if (alive) {
        end_phasing(Outcome::aborted);
        begin_phasing(next);
    } else queue_.record(next.id, Outcome::aborted, ErrorId::none);
}

/// Velocity and ramps are the master's units, so its limits and defaults hold; velocity 0 is its limit.
void AxisCore::begin_phasing(const AcceptedCommand& accepted) noexcept {
    auto& state = coupling_;
    const auto& command = accepted.command;
    const auto& link = state.running.id != 0 ? state.running : state.next;
    const auto ref = link.id != 0 ? link.masters.axes[0] : masters_of(queue_.active().command).axes[0];
    const AxisCore* master = axis_at(ref);
    const auto& config = master ? master->config_ : config_;
    auto limits = dynamics_of(command, config.limits, config.defaults);
    limits.velocity = choose(command.velocity, 0, config.limits.velocity);
    const double from = command.kind == CommandKind::phasing_relative ? state.phase.state().position : 0.0;
    if (state.phase.begin(from + command.position, limits)) {
        state.shown = true;
        state.phasing = accepted;
        state.phase_master = ref;
    } else queue_.record(accepted.id, Outcome::error, ErrorId::invalid_position);
}

void AxisCore::complete_phasing() noexcept {
    auto& state = coupling_;
    if (state.phasing.id == 0 || state.phase.running()) return;
    queue_.record(state.phasing.id, Outcome::done, ErrorId::none);
    state.phasing = {};
}

/// The coupling it belonged to is over (U-16): so is the phasing, and its shift is gone.
void AxisCore::clear_phase() noexcept {
    end_phasing(Outcome::aborted);
    coupling_.phase.clear();
    coupling_.phase_master = {};
}

void AxisCore::end_phasing(Outcome outcome) noexcept {
    auto& state = coupling_;
    if (state.phasing.id != 0) queue_.record(state.phasing.id, outcome, ErrorId::none);
    state.phasing = {};
}

}  // namespace taktwerk::axes

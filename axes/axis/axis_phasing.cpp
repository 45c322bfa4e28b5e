// MC_PhasingAbsolute, MC_PhasingRelative: a motion of its own, of the master's position as this slave sees it, beside the coupling.

#include <cmath>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

Submitted Axis::submit_phasing(const AxisCommand& command, Owner owner) noexcept {
    if (!may(owner)) return {0, ErrorId::owned_by_other};
    if (const auto error = refuse_phasing(command); error != ErrorId::none) return {0, error};
    auto& state = coupling_;
    const AcceptedCommand accepted{queue_.next_id(), owner, command};
    if (command.buffer_mode == mcBuffered && state.phasing.id != 0) {
        state.phasing_queue[state.phasing_waiting++] = accepted;
    } else {
        end_phasing(Outcome::aborted);
        begin_phasing(accepted);
    }
    publish();
    return {accepted.id, ErrorId::none};
}

ErrorId Axis::refuse_phasing(const AxisCommand& command) const noexcept {
    for (const double value : {command.velocity, command.acceleration, command.deceleration, command.jerk})
        if (!(value >= 0) || std::isinf(value)) return value == command.velocity ? ErrorId::invalid_velocity : ErrorId::invalid_dynamics;
    if (!std::isfinite(command.position)) return ErrorId::invalid_position;
    if (command.buffer_mode != mcAborting && command.buffer_mode != mcBuffered) return ErrorId::buffer_mode_not_supported;
    // Between whom? There must be a master, and it must be the one meant where one is named.
    const auto& link = coupling_.running.id != 0 ? coupling_.running : coupling_.next;
    if (view_.state != AxisState::SynchronizedMotion || (link.id == 0 && !couples(queue_.active().command.kind)))
        return ErrorId::not_coupled;
    const auto master = link.id != 0 ? link.masters.axes[0] : masters_of(queue_.active().command).axes[0];
    if (const auto named = masters_of(command).axes[0]; named.valid() && named != master) return ErrorId::invalid_master;
    const bool waits = command.buffer_mode == mcBuffered && coupling_.phasing.id != 0;
    return waits && coupling_.phasing_waiting == coupling_.phasing_queue.size() ? ErrorId::queue_full : ErrorId::none;
}

/// Velocity and ramps are the master's units, so its limits and defaults hold; velocity 0 is its limit.
void Axis::begin_phasing(const AcceptedCommand& accepted) noexcept {
    auto& state = coupling_;
    const auto& command = accepted.command;
    const auto& link = state.running.id != 0 ? state.running : state.next;
    const auto ref = link.id != 0 ? link.masters.axes[0] : masters_of(queue_.active().command).axes[0];
    const Axis* master = scene_.axis(ref);
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

void Axis::complete_phasing() noexcept {
    auto& state = coupling_;
    if (state.phasing.id == 0 || state.phase.running()) return;
    queue_.record(state.phasing.id, Outcome::done, ErrorId::none);
    state.phasing = {};
    if (state.phasing_waiting == 0) return;
    const auto next = state.phasing_queue[0];
    for (std::size_t i = 1; i < state.phasing_waiting; ++i) state.phasing_queue[i - 1] = state.phasing_queue[i];
    --state.phasing_waiting;
    begin_phasing(next);
}

/// The coupling it belonged to is over (U-16): so is the phasing, and its shift is gone.
void Axis::clear_phase() noexcept {
    end_phasing(Outcome::aborted);
    coupling_.phase.clear();
    coupling_.phase_master = {};
}

void Axis::end_phasing(Outcome outcome) noexcept {
    auto& state = coupling_;
    if (state.phasing.id != 0) queue_.record(state.phasing.id, outcome, ErrorId::none);
    state.phasing = {};
    for (std::size_t i = 0; i < state.phasing_waiting; ++i) queue_.record(state.phasing_queue[i].id, outcome, ErrorId::none);
    state.phasing_waiting = 0;
}

}  // namespace taktwerk::axes

#include "axes/axis/phasing.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/coupling_links.hpp"
#include "axes/axis/master_side.hpp"
#include "axes/axis/stop_ramp.hpp"

namespace taktwerk::axes {

Submitted Phasing::submit(const AxisCommand& command, Owner owner) noexcept {
    if (command.kind == CommandKind::halt_phasing) return submit_halt(command, owner);
    if (const auto error = refuse(command); error != ErrorId::none) return {0, error};
    const AcceptedCommand accepted{body_.queue.next_id(), owner, command};
    if (command.buffer_mode == mcBuffered) {
        links_.state.phasing_next = accepted;
        links_.state.phasing_behind = coupling_before_phasing(command).id;
        links_.state.shown = true;
    } else {
        links_.end_phasing(Outcome::aborted);
        begin(accepted);
    }
    return {accepted.id, ErrorId::none};
}

/// As MC_Halt it ends what waits, too. Where nothing runs there is nothing to halt.
Submitted Phasing::submit_halt(const AxisCommand& command, Owner owner) noexcept {
    for (const double value : {command.deceleration, command.jerk})
        if (!(value >= 0) || std::isinf(value)) return {0, ErrorId::invalid_dynamics};
    if (!coupled() && links_.state.phasing_next.id == 0) return {0, ErrorId::not_coupled};
    auto& state = links_.state;
    const AcceptedCommand accepted{body_.queue.next_id(), owner, command};
    state.shown = true;
    if (state.phasing_next.id != 0) body_.queue.record(state.phasing_next.id, Outcome::aborted, ErrorId::none);
    state.phasing_next = {};
    links_.end_phasing(Outcome::aborted);
    if (state.phase.running()) halt(accepted);
    else body_.queue.record(accepted.id, Outcome::done, ErrorId::none);
    return {accepted.id, ErrorId::none};
}

bool Phasing::coupled() const noexcept {
    const auto& link = links_.state.running.id != 0 ? links_.state.running : links_.state.next;
    return body_.state == AxisState::SynchronizedMotion && (link.id != 0 || couples(body_.queue.active().command.kind));
}

ErrorId Phasing::refuse(const AxisCommand& command) const noexcept {
    for (const double value : {command.velocity, command.acceleration, command.deceleration, command.jerk})
        if (!(value >= 0) || std::isinf(value)) return value == command.velocity ? ErrorId::invalid_velocity : ErrorId::invalid_dynamics;
    if (!std::isfinite(command.position)) return ErrorId::invalid_position;
    if (command.buffer_mode != mcAborting && command.buffer_mode != mcBuffered) return ErrorId::buffer_mode_not_supported;
    // Between whom? There must be a master, and it must be the one meant where one is named.
    const bool buffered = command.buffer_mode == mcBuffered;
    const auto& coupling = coupling_before_phasing(command);
    const auto& link = links_.state.running.id != 0 ? links_.state.running : links_.state.next;
    if (buffered ? !couples(coupling.command.kind) : !coupled()) return ErrorId::not_coupled;
    const auto master = !buffered && link.id != 0 ? link.masters.axes[0] : masters_of(coupling.command).axes[0];
    if (const auto named = masters_of(command).axes[0]; named.valid() && named != master) return ErrorId::invalid_master;
    if (!buffered) return ErrorId::none;
    // Table 4: nothing is buffered behind a phasing, nor behind a cam that repeats.
    const bool behind_phasing =
        links_.state.phasing_next.id != 0 || (links_.state.phasing.id != 0 && coupling.id == body_.queue.active().id);
    return behind_phasing || coupling_.never_ends(coupling.command) ? ErrorId::buffer_mode_not_supported : ErrorId::none;
}

/// The coupling that a buffered phasing waits for is the last one given; an aborting one acts on the active.
const AcceptedCommand& Phasing::coupling_before_phasing(const AxisCommand& command) const noexcept {
    if (command.buffer_mode == mcBuffered)
        for (std::size_t i = body_.queue.waiting(); i > 0; --i)
            if (const auto& before = body_.queue.waiting_at(i - 1); before.command.kind != CommandKind::setting) return before;
    return body_.queue.active();
}

/// Table 4: InGear, InSync, of a cam EndOfProfile. Inxxx has been shown for a cycle.
bool Phasing::lets_phasing_begin() const noexcept {
    if (body_.queue.active().id != links_.state.phasing_behind) return false;
    if (body_.queue.active().command.kind != CommandKind::cam_in) return body_.shown.active_in_target;
    const auto* cam = links_.state.running.id == links_.state.phasing_behind ? links_.state.follower.cam() : nullptr;
    return cam && cam->over();
}

void Phasing::settle_waiting() noexcept {
    auto& state = links_.state;
    bool alive = body_.queue.active().id == state.phasing_behind;
    for (std::size_t i = 0; !alive && i < body_.queue.waiting(); ++i) alive = body_.queue.waiting_at(i).id == state.phasing_behind;
    if (alive && !lets_phasing_begin()) return;
    const auto next = state.phasing_next;
    state.phasing_next = {};
    if (alive) {
        links_.end_phasing(Outcome::aborted);
        begin(next);
    } else body_.queue.record(next.id, Outcome::aborted, ErrorId::none);
}

const AxisConfig& Phasing::config_of(AxisRef axis) const noexcept {
    const MasterSide* master = links_.axis(axis);
    return master ? master->config() : body_.config;
}

/// Velocity and ramps are the master's units, so its limits and defaults hold; velocity 0 is its limit.
void Phasing::begin(const AcceptedCommand& accepted) noexcept {
    auto& state = links_.state;
    const auto& command = accepted.command;
    const auto& link = state.running.id != 0 ? state.running : state.next;
    const auto ref = link.id != 0 ? link.masters.axes[0] : masters_of(body_.queue.active().command).axes[0];
    const auto& config = config_of(ref);
    auto limits = dynamics_of(command, config.limits, config.defaults);
    limits.velocity = choose(command.velocity, 0, config.limits.velocity);
    const double from = command.kind == CommandKind::phasing_relative ? state.phase.state().position : 0.0;
    if (state.phase.begin(from + command.position, limits)) {
        state.shown = true;
        state.phasing = accepted;
        state.phase_master = ref;
    } else body_.queue.record(accepted.id, Outcome::error, ErrorId::invalid_position);
}

/// With the master's ramps, as the phasing. As every stop: what speeds up loses its acceleration with the jerk it was built up with, and nothing
/// turns round.
void Phasing::halt(const AcceptedCommand& accepted) noexcept {
    auto& state = links_.state;
    const auto from = state.phase.state();
    const auto& config = config_of(state.phase_master);
    auto limits = dynamics_of(accepted.command, config.limits, config.defaults);
    if (from.velocity * from.acceleration > 0) limits.jerk = std::max(limits.jerk, state.phase.jerk());
    if (state.phase.stop(never_reversing(from, limits, to_seconds(body_.cycle)))) state.phasing = accepted;
    else body_.queue.record(accepted.id, Outcome::error, ErrorId::invalid_dynamics);
}

void Phasing::complete() noexcept {
    auto& state = links_.state;
    if (state.phasing.id == 0 || state.phase.running()) return;
    body_.queue.record(state.phasing.id, Outcome::done, ErrorId::none);
    state.phasing = {};
}

}  // namespace taktwerk::axes

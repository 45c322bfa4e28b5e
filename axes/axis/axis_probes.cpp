#include "axes/axis/axis_probes.hpp"

#include "axes/axis/probe_window.hpp"

namespace taktwerk::axes {

ProbeBoard::Signals AxisProbes::signals() const noexcept {
    // A bus' inputs are as old as its drives' actual values; where the drive hangs on another line they are one cycle old.
    const bool same_bus = body_.port.capabilities().setpoints == SetpointClass::cyclic;
    return {measured_.feedback, body_.scene.inputs, track_, body_.now - (same_bus ? feedback_age_ : body_.cycle), body_.cycle};
}

double AxisProbes::program_position(const FinePosition& place) const noexcept {
    const double position = body_.units.to_program(body_.units.local(place.counts) + place.rest / body_.units.counts_per_unit());
    return body_.config.modulo > 0 ? on_circle(position, body_.config.modulo) : position;
}

Submitted AxisProbes::submit(const AxisCommand& command) noexcept {
    const auto* probe = std::get_if<ProbeDetails>(&command.details);
    if (!probe) return {0, ErrorId::invalid_parameter};
    return command.kind == CommandKind::touch_probe ? arm(*probe) : abort_trigger(probe->trigger);
}

Submitted AxisProbes::arm(const ProbeDetails& probe) noexcept {
    if (probe.replaces != 0) end(probe.replaces, Outcome::aborted, ErrorId::none);  // whatever comes of the new one
    if (const auto error = check_window(probe, body_.config.modulo); error != ErrorId::none) return {0, error};
    if (!measured_.online()) return {0, ErrorId::drive_not_ready};
    const bool by_level = probe.trigger.source == TriggerSource::home_switch || probe.trigger.source == TriggerSource::input;
    if (runs_.latch.armed() && !by_level) return {0, ErrorId::probe_busy};  // homing has the drive's latches
    const auto id = body_.queue.next_id();
    const auto error = board_.arm(id, probe, body_.port.capabilities(), signals());
    return error == ErrorId::none ? Submitted{id, error} : Submitted{0, error};
}

Submitted AxisProbes::abort_trigger(const TriggerRef& trigger) noexcept {
    const auto aborted = board_.release(trigger);
    if (aborted == 0) return {0, ErrorId::probe_idle};
    body_.queue.record(aborted, Outcome::aborted, ErrorId::none);
    const auto id = body_.queue.next_id();
    body_.queue.record(id, Outcome::done, ErrorId::none);
    return {id, ErrorId::none};
}

void AxisProbes::end(CommandId id, Outcome outcome, ErrorId error) noexcept {
    for (std::size_t i = 0; i < ProbeBoard::places; ++i) {
        if (board_.id(i) != id) continue;
        board_.release(id);
        body_.queue.record(id, outcome, error);
        return;
    }
}

bool AxisProbes::watch() noexcept {
    if (measured_.feedback.position_epoch != track_epoch_) track_.clear();  // a line through two zeros says nothing
    track_epoch_ = measured_.feedback.position_epoch;
    if (measured_.feedback.fresh) track();
    const bool armed = board_.armed();
    if (armed) observe();
    return armed;
}

void AxisProbes::observe() noexcept {
    board_.observe(signals());
    for (std::size_t i = 0; i < ProbeBoard::places; ++i) {
        const auto id = board_.id(i);
        if (id == 0) continue;
        if (!measured_.online()) {
            end(id, Outcome::error, ErrorId::drive_not_ready);
            continue;
        }
        const auto event = board_.event(i);
        if (!event) continue;
        const double position = program_position(*event);
        if (!in_window(board_.details(i), position, body_.config.modulo)) continue;  // it waits on
        positions_[i] = position;
        latched_[i] = id;
        end(id, Outcome::done, ErrorId::none);
    }
}

}  // namespace taktwerk::axes

// MC_TouchProbe and MC_AbortTrigger: beside whatever the axis does, in every state, without moving anything or changing the state.
//
// Any party may probe: it commands no motion. A probe lives until its event, MC_AbortTrigger, or until the drive's feedback is lost; errors
// of the axis, power and other commands leave it alone.

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

ProbeBoard::Signals AxisCore::probe_signals() const noexcept {
    // A bus' inputs are as old as its drives' actual values; where the drive hangs on another line they are one cycle old.
    const bool same_bus = port_.capabilities().setpoints == SetpointClass::cyclic;
    return {feedback_, scene_.inputs, track_, now_ - (same_bus ? feedback_age_ : cycle_), cycle_};
}

double AxisCore::program_position(const FinePosition& place) const noexcept {
    const double position = units_.to_program(units_.local(place.counts) + place.rest / units_.counts_per_unit());
    return view_.modulo > 0 ? on_circle(position, view_.modulo) : position;
}

Submitted AxisCore::submit_probe(const AxisCommand& command) noexcept {
    const auto* probe = std::get_if<ProbeDetails>(&command.details);
    if (!probe) return {0, ErrorId::invalid_parameter};
    const auto answer = command.kind == CommandKind::touch_probe ? arm_probe(*probe) : abort_trigger(probe->trigger);
    publish();
    return answer;
}

Submitted AxisCore::arm_probe(const ProbeDetails& probe) noexcept {
    if (probe.replaces != 0) end_probe(probe.replaces, Outcome::aborted, ErrorId::none);  // whatever comes of the new one
    if (const auto error = check_window(probe, view_.modulo); error != ErrorId::none) return {0, error};
    if (!online()) return {0, ErrorId::drive_not_ready};
    const bool by_level = probe.trigger.source == TriggerSource::home_switch || probe.trigger.source == TriggerSource::input;
    if (latch_.armed() && !by_level) return {0, ErrorId::probe_busy};  // homing has the drive's latches
    const auto id = queue_.next_id();
    const auto error = probes_.arm(id, probe, port_.capabilities(), probe_signals());
    return error == ErrorId::none ? Submitted{id, error} : Submitted{0, error};
}

Submitted AxisCore::abort_trigger(const TriggerRef& trigger) noexcept {
    const auto aborted = probes_.release(trigger);
    if (aborted == 0) return {0, ErrorId::probe_idle};
    queue_.record(aborted, Outcome::aborted, ErrorId::none);
    const auto id = queue_.next_id();
    queue_.record(id, Outcome::done, ErrorId::none);
    return {id, ErrorId::none};
}

void AxisCore::end_probe(CommandId id, Outcome outcome, ErrorId error) noexcept {
    for (std::size_t i = 0; i < ProbeBoard::places; ++i) {
        if (probes_.id(i) != id) continue;
        probes_.release(id);
        queue_.record(id, outcome, error);
        return;
    }
}

void AxisCore::watch_probes() noexcept {
    if (feedback_.position_epoch != track_epoch_) track_.clear();  // a line through two zeros says nothing
    track_epoch_ = feedback_.position_epoch;
    if (feedback_.fresh) {
        track_.add(feedback_.latched, feedback_.position);
        feedback_age_ = now_ - feedback_.latched;
    }
    if (probes_.armed()) observe_probes();
}

void AxisCore::observe_probes() noexcept {
    probes_.observe(probe_signals());
    for (std::size_t i = 0; i < ProbeBoard::places; ++i) {
        const auto id = probes_.id(i);
        if (id == 0) continue;
        if (!online()) {
            end_probe(id, Outcome::error, ErrorId::drive_not_ready);
            continue;
        }
        const auto event = probes_.event(i);
        if (!event) continue;
        const double position = program_position(*event);
        if (!in_window(probes_.details(i), position, view_.modulo)) continue;  // it waits on
        view_.probe_position[i] = position;
        view_.probe_latched[i] = id;
        end_probe(id, Outcome::done, ErrorId::none);
    }
    publish_probes();
}

void AxisCore::publish_probes() noexcept {
    show_side(SideSlot::probe1, probes_.id(0));
    show_side(SideSlot::probe2, probes_.id(1));
}

}  // namespace taktwerk::axes

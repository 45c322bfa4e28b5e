#include "axes/axis/probe_board.hpp"

namespace taktwerk::axes {

namespace {

[[nodiscard]] bool latched_by_drive(TriggerSource source) noexcept {
    return source == TriggerSource::probe1 || source == TriggerSource::probe2 || source == TriggerSource::index_pulse;
}

/// The index has no falling edge to wait for.
[[nodiscard]] bool has_edge(const DriveCapabilities& drive, std::uint8_t channel, const TriggerRef& trigger) noexcept {
    const bool falling = trigger.falling && trigger.source != TriggerSource::index_pulse;
    return channel < drive.probes && ((drive.probe_edges >> (2 * channel + (falling ? 1 : 0))) & 1u) != 0;
}

[[nodiscard]] bool level_of(const TriggerRef& trigger, const DriveFeedback& feedback, std::span<const std::int64_t> inputs) noexcept {
    if (trigger.source == TriggerSource::home_switch) return feedback.home_switch;
    return trigger.point < inputs.size() && ((static_cast<std::uint64_t>(inputs[trigger.point]) >> trigger.bit) & 1u) != 0;
}

}  // namespace

bool ProbeBoard::channel_used(std::uint8_t channel) const noexcept {
    for (const auto& place : places_)
        if (place.id != 0 && place.channel == channel) return true;
    return false;
}

ErrorId ProbeBoard::choose_channel(const ProbeDetails& probe, const DriveCapabilities& drive, std::uint8_t& channel) const noexcept {
    const auto& trigger = probe.trigger;
    if (trigger.source == TriggerSource::index_pulse) {  // whichever latch is free
        bool any = false;
        for (channel = 0; channel < drive.probes; ++channel) {
            if (!has_edge(drive, channel, trigger)) continue;
            any = true;
            if (!channel_used(channel)) return ErrorId::none;
        }
        return any ? ErrorId::probe_busy : ErrorId::no_such_probe;
    }
    channel = trigger.source == TriggerSource::probe1 ? 0 : 1;
    if (!has_edge(drive, channel, trigger)) return ErrorId::no_such_probe;
    return channel_used(channel) ? ErrorId::probe_busy : ErrorId::none;
}

ErrorId ProbeBoard::arm(CommandId id, const ProbeDetails& probe, const DriveCapabilities& drive, const Signals& now) noexcept {
    const auto& trigger = probe.trigger;
    Place* free = nullptr;
    for (auto& place : places_) {
        if (place.id == 0 && !free) free = &place;
        if (place.id != 0 && place.probe.trigger == trigger) return ErrorId::probe_busy;
    }
    auto channel = software;
    if (latched_by_drive(trigger.source)) {
        if (const auto error = choose_channel(probe, drive, channel); error != ErrorId::none) return error;
    } else if (trigger.source == TriggerSource::home_switch) {
        if (!now.feedback.has_inputs) return ErrorId::no_such_probe;
    } else if (trigger.point >= now.inputs.size() || trigger.bit >= 64) {
        return ErrorId::invalid_output;
    }
    if (!free) return ErrorId::probe_busy;
    *free = {id, probe, channel, 0, channel == software && level_of(trigger, now.feedback, now.inputs), std::nullopt};
    if (channel != software) letting_go_[channel] = sent_[channel];
    return ErrorId::none;
}

CommandId ProbeBoard::release(const TriggerRef& trigger) noexcept {
    for (auto& place : places_) {
        if (place.id == 0 || place.probe.trigger != trigger) continue;
        const auto id = place.id;
        place = {};
        return id;
    }
    return 0;
}

void ProbeBoard::release(CommandId id) noexcept {
    for (auto& place : places_)
        if (id != 0 && place.id == id) place = {};
}

void ProbeBoard::watch_latch(Place& place, const ProbeFeedback& latch) noexcept {
    if (!latch.latched) {
        place.seen = 0;
        return;
    }
    if (latch.count == place.seen) return;
    place.seen = latch.count;
    place.event = FinePosition{latch.position, 0};
}

void ProbeBoard::watch_level(Place& place, const Signals& now) noexcept {
    const auto& trigger = place.probe.trigger;
    const bool of_drive = trigger.source == TriggerSource::home_switch;
    if (of_drive && !now.feedback.fresh) return;
    const bool level = level_of(trigger, now.feedback, now.inputs);
    const bool edge = level != place.level && level != trigger.falling;
    place.level = level;
    if (edge) place.event = now.track.at(of_drive ? now.track.between() : now.inputs_taken - now.cycle / 2);
}

void ProbeBoard::observe(const Signals& now) noexcept {
    for (auto& place : places_) {
        place.event.reset();
        if (place.id == 0) continue;
        if (place.channel == software) watch_level(place, now);
        else if (now.feedback.fresh && !letting_go_[place.channel]) watch_latch(place, now.feedback.probes[place.channel]);
    }
}

void ProbeBoard::arm_latches(std::array<ProbeCommand, 2>& latches) noexcept {
    for (const auto& place : places_) {
        if (place.id == 0 || place.channel == software || letting_go_[place.channel]) continue;
        const auto& trigger = place.probe.trigger;
        latches[place.channel] = {
            .armed = true,
            .continuous = place.probe.window_only,  // an event outside the window must not use up the latch
            .index_pulse = trigger.source == TriggerSource::index_pulse,
            .edge = trigger.falling ? ProbeEdge::falling : ProbeEdge::rising,
        };
    }
    for (std::size_t i = 0; i < latches.size(); ++i) sent_[i] = latches[i].armed;
    letting_go_ = {};
}

}  // namespace taktwerk::axes

#include "runtime/machine/hand_motion.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/alarms.hpp"

namespace taktwerk::runtime {

using axes::AxisCommand;
using axes::AxisState;
using axes::CommandKind;
using axes::ErrorId;

Verdict verdict_of(ErrorId error) noexcept {
    if (error == ErrorId::none) return {};
    return {error == ErrorId::owned_by_other ? Answer::no_control : Answer::refused_by_axis, error};
}

void HandMotion::note_stop(std::size_t axis, std::uint64_t number) noexcept {
    axes_[axis].stopped_at = std::max(axes_[axis].stopped_at, number);
}

// Stopping is everybody's right: it is carried out in the owner's name.
Verdict HandMotion::stop(std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    axes_[axis].jog = 0;
    if (auto* group = body_.axis_groups.leader_of(ref)) {  // on the path: a member that stops alone would leave it
        group->halt();
        return {};
    }
    // It stands, interrupted: its program would go on behind this stop.
    if (const auto group = body_.axis_groups.group_of(ref); group.valid()) body_.axis_groups[group.index].halt();
    return stop_alone(axis);
}

Verdict HandMotion::let_go(std::size_t axis) noexcept {
    axes_[axis].jog = 0;
    if (auto* group = body_.axis_groups.leader_of({static_cast<std::uint16_t>(axis)})) {
        group->come_to_rest();
        return {};
    }
    return stop_alone(axis);
}

Verdict HandMotion::stop_alone(std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    const auto owner = body_.axes[axis].view().owner;
    switch (body_.axes[axis].view().state) {
        case AxisState::Disabled:
        case AxisState::Stopping:
        case AxisState::ErrorStop: return {};  // it stands, or stops already
        default: break;
    }
    AxisCommand wanted;
    wanted.kind = CommandKind::halt;
    auto submitted = body_.requests.submit(ref, wanted, owner);
    if (submitted.error == ErrorId::state_forbids) {  // the state diagram has no halt out of Homing
        wanted.kind = CommandKind::stop;
        submitted = body_.requests.submit(ref, wanted, owner);
        if (submitted.error == ErrorId::none) body_.requests.release_stop(ref, submitted.id, owner);
    }
    return verdict_of(submitted.error == ErrorId::interlocked ? ErrorId::none : submitted.error);  // an emergency stop is under way
}

Verdict HandMotion::jog(const OperatorCommand& command, std::size_t axis) noexcept {
    auto& running = axes_[axis].jog;
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    if (!std::isfinite(command.value)) return {Answer::bad_value};
    auto ended_by = axes::ErrorId::none;
    const auto status = body_.axes[axis].view().status(running, &ended_by);
    const bool jogging = status == axes::CommandStatus::active || status == axes::CommandStatus::in_target;
    if (command.value == 0) return jogging ? let_go(axis) : Verdict{};
    if (jogging) {
        const auto error = body_.requests.renew_jog(ref, running, command.value, command.owner);
        const bool lease_over = error == ErrorId::state_forbids;
        if (!(lease_over && command.flag)) return lease_over ? Verdict{Answer::stale} : verdict_of(error);
    }
    // A heartbeat of a jog that is over must not start the axis anew: it takes a fresh press (flag). Why it is over is not always its lease.
    if (!command.flag) {
        using enum axes::CommandStatus;
        if (status == done) return verdict_of(axes::ErrorId::beyond_software_limit);  // it went as far as the axis may
        if (status == aborted) return verdict_of(axes::ErrorId::aborted_by_command);
        if (status == error && ended_by != static_cast<axes::ErrorId>(axes::AxisAlarm::jog_lease_expired)) return verdict_of(ended_by);
        return {Answer::stale};
    }
    AxisCommand wanted;
    wanted.kind = CommandKind::jog;
    wanted.velocity = command.value;
    const auto submitted = body_.requests.submit(ref, wanted, command.owner);
    running = submitted.id;
    return verdict_of(submitted.error);
}

}  // namespace taktwerk::runtime

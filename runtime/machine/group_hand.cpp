#include "runtime/machine/group_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "axes/axis/alarms.hpp"

namespace taktwerk::runtime {

using axes::CommandStatus;
using axes::ErrorId;
using axes::JogEnd;

namespace {

constexpr std::size_t first_turn = 3;  // of X Y Z RX RY RZ

axes::JointVector direction_of(const GroupJogOrder& order) noexcept {
    axes::JointVector direction{};
    for (std::size_t i = 0; i < direction.size(); ++i)
        direction[i] = static_cast<double>(order.plus >> i & 1) - static_cast<double>(order.minus >> i & 1);
    return direction;
}

bool is_none(const axes::JointVector& direction) noexcept {
    return std::all_of(direction.begin(), direction.end(), [](double part) { return part == 0; });
}

/// In u, of turns in degrees; in ACS in the member's own unit.
axes::JogPins pins_of(const OperatorCommand& command) noexcept {
    constexpr double radians = std::numbers::pi / 180;
    axes::JogPins pins;
    pins.hand = axes::JogHand::person;
    pins.velocity = command.value;
    pins.linear = command.value2;
    pins.angular = command.group_jog.frame == axes::mcACS ? command.value2 : command.value2 * radians;
    return pins;
}

Verdict ended_by(ErrorId error, const axes::GroupView& view) noexcept {
    auto verdict = verdict_of(error);
    const auto& at = view.jog_hindrance;
    verdict.jog_end = view.jog_end;
    if (at.place < axes::most_members) verdict.limiting = view.members[at.place];
    verdict.room = at.room;
    return verdict;
}

bool turns_and_moves(const GroupJogOrder& order) noexcept {
    constexpr unsigned linear = (1u << first_turn) - 1;
    const unsigned slots = order.plus | order.minus;
    return order.frame != axes::mcACS && (slots & linear) != 0 && (slots & ~linear) != 0;
}

}  // namespace

GroupHand::GroupHand(MachineBody& body) : body_(body), held_(body.axis_groups.size()), waits_(body.config.axes.size()) {}

bool GroupHand::jogs(std::size_t group) const noexcept {
    const auto status = body_.axis_groups[group].view().status(held_[group].id);
    return status == CommandStatus::active;
}

bool GroupHand::mode_waits(std::size_t group) const noexcept {
    const auto& members = body_.axis_groups[group].view().members;
    return std::any_of(members.begin(), members.end(), [&](axes::AxisRef axis) { return axis.valid() && waits_[axis.index] != 0; });
}

Duration GroupHand::lease_of(std::size_t group) const noexcept {
    auto least = Duration::max();
    for (const auto member : body_.axis_groups[group].view().members)
        if (member.valid()) least = std::min(least, body_.axes[member.index].config().patience.jog_lease);
    return least;
}

Verdict GroupHand::jog(const OperatorCommand& command, std::size_t group) noexcept {
    if (!(command.value >= 0 && command.value <= 1) || !(command.value2 >= 0) || !std::isfinite(command.value2)) return {Answer::bad_value};
    if (command.value == 0) {
        if (jogs(group)) body_.axis_groups[group].come_to_rest();
        held_[group].id = 0;
        return {};
    }
    if (command.value2 > 0 && turns_and_moves(command.group_jog)) return {Answer::bad_value};
    const auto& held = held_[group];
    const bool goes_on = jogs(group) && held.order.frame == command.group_jog.frame && held.distance == 0 && command.value2 == 0;
    if (!command.flag || goes_on) {
        const auto verdict = renew(command, group);
        if (!(command.flag && verdict.answer == Answer::stale)) return verdict;
    }
    return press(command, group);
}

Verdict GroupHand::press(const OperatorCommand& command, std::size_t group) noexcept {
    if (mode_waits(group)) return verdict_of(ErrorId::state_forbids);
    axes::GroupCommand wanted;
    wanted.kind = axes::GroupCommandKind::jog;
    wanted.frame = command.group_jog.frame;
    wanted.target = direction_of(command.group_jog);
    wanted.jog = pins_of(command);
    const auto submitted = body_.axis_groups.submit(ref(group), wanted, command.owner);
    if (submitted.error == ErrorId::none) held_[group] = {submitted.id, command.group_jog, command.value2, body_.now, false};
    return verdict_of(submitted.error);
}

/// A heartbeat of a jog that is over must not start the group anew: it takes a fresh press.
Verdict GroupHand::renew(const OperatorCommand& command, std::size_t group) noexcept {
    auto& held = held_[group];
    if (!jogs(group)) return over(group);
    if (held.order.frame != command.group_jog.frame || held.distance != command.value2) return {Answer::bad_value};
    if (body_.now - held.renewed > lease_of(group)) return {Answer::stale};
    axes::HoldJog hold;
    hold.id = held.id;
    hold.direction = direction_of(command.group_jog);
    hold.velocity = command.value;
    if (is_none(hold.direction)) return {Answer::bad_value};
    const auto error = body_.axis_groups.set(ref(group), hold, command.owner);
    if (error == ErrorId::none) {
        held.order = command.group_jog;
        held.renewed = body_.now;
    }
    return verdict_of(error);
}

/// Why there is nothing to renew.
Verdict GroupHand::over(std::size_t group) const noexcept {
    const auto& held = held_[group];
    const auto& view = body_.axis_groups[group].view();
    auto error = ErrorId::none;
    switch (view.status(held.id, &error)) {
        case CommandStatus::done:
            switch (view.jog_end) {
                case JogEnd::distance: return {};  // as far as was asked for: the key may stay down
                case JogEnd::member_limit: return ended_by(ErrorId::beyond_software_limit, view);
                case JogEnd::reach:
                case JogEnd::orientation: return ended_by(ErrorId::out_of_reach, view);
                case JogEnd::workspace: return ended_by(ErrorId::outside_workspace, view);
                case JogEnd::singularity: return ended_by(ErrorId::singular_path, view);
                case JogEnd::none: return {Answer::stale};
            }
            return {Answer::stale};
        case CommandStatus::error: return ended_by(error, view);
        case CommandStatus::aborted: return held.told ? Verdict{Answer::stale} : verdict_of(ErrorId::aborted_by_command);
        default: return {Answer::stale};
    }
}

void GroupHand::raise_alarms() noexcept {
    for (std::size_t group = 0; group < held_.size(); ++group) {
        auto& held = held_[group];
        if (held.id == 0 || held.told || !jogs(group)) continue;
        const auto lease = lease_of(group);
        if (body_.now - held.renewed <= lease) continue;
        held.told = true;
        for (const auto member : body_.axis_groups[group].view().members) {
            if (!member.valid()) continue;
            body_.raise({axes::id(axes::AxisAlarm::jog_lease_expired), AlarmSource::axis, member.index, to_seconds(lease)},
                        axes::axis_alarms);
            break;
        }
    }
}

// An axis that its group leads would leave the path to stop by itself, and the group would be in GroupErrorStop for it.
void GroupHand::set_mode(axes::OperatingMode mode) noexcept {
    const bool by_hand = mode_ != axes::OperatingMode::automatic;  // a program's motion ends as it always did
    mode_ = mode;
    for (std::size_t i = 0; i < body_.axis_groups.size(); ++i) {
        auto& group = body_.axis_groups[i];
        if (by_hand) group.come_to_rest();
        group.set_mode(mode);
        held_[i].id = 0;
    }
    // One that waits already goes on waiting, for this mode: what brings its group to rest is still a person's.
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        const bool led = body_.axis_groups.leader_of({static_cast<std::uint16_t>(i)}) != nullptr;
        waits_[i] = led && (by_hand || waits_[i] != 0) ? 1 : 0;
        if (waits_[i] == 0) body_.axes[i].set_mode(mode);
    }
}

void GroupHand::settle_mode() noexcept {
    if (body_.axis_groups.size() == 0) return;
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        if (waits_[i] == 0 || body_.axis_groups.leader_of({static_cast<std::uint16_t>(i)}) != nullptr) continue;
        waits_[i] = 0;
        body_.axes[i].set_mode(mode_);
    }
}

}  // namespace taktwerk::runtime

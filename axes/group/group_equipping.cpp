// Of an AxisGroup: frames, tools, loads and coordinates, which are set and move nothing.

#include "axes/group/axis_group.hpp"
#include "axes/group/group_places.hpp"

namespace taktwerk::axes {

CommandPlace AxisGroup::place_of(const GroupCommand& command) const noexcept {
    // What waits in front of it will have been done by then; an aborting command does away with it.
    GroupFrames frames = equipment_.frames;
    CommandPlace place;
    place.carried = {equipment_.tool_pose(), equipment_.selected_tool, equipment_.selected_payload};
    if (waits(command))
        for (std::size_t i = 0; i < queue_.waiting(); ++i) {
            const auto& setting = queue_.waiting_at(i).command;
            apply(frames, setting);
            if (setting.kind == GroupCommandKind::write_tool && setting.number == equipment_.selected_tool)
                place.carried.tool = pose_of_numbers(setting.tool.frame);
        }
    place.frame = frames.seen_from_machine(command.frame);
    place.track = frames.track_of(command.frame);
    if (place.track.moves()) place.track.machine = frames.machine;
    return place;
}

/// G-028: at once, behind the running command, or behind all that wait.
Submitted AxisGroup::take_setting(const GroupCommand& wanted, Owner owner) noexcept {
    GroupCommand command = wanted;
    if (command.kind == GroupCommandKind::track_frame)
        if (const auto error = tracking_.take(command.track, equipment_.frames, members_); error != ErrorId::none) return {0, error};
    const auto id = queue_.next_id();
    const bool later = command.execution != mcImmediately && (queue_.has_active() || queue_.waiting() > 0);
    if (!later) {
        apply(equipment_, command);
        queue_.record(id, Outcome::done);
    } else if (command.execution == mcDelayed) {
        queue_.push_front({id, owner, command, {}});
    } else {
        queue_.push({id, owner, command, {}});
    }
    return {id, ErrorId::none};
}

void AxisGroup::finish_setting() noexcept {
    if (!is_setting(queue_.active().command.kind)) return;
    apply(equipment_, queue_.active().command);
    queue_.finish_active(Outcome::done);
}

ErrorId AxisGroup::equip(const GroupSetting& setting) noexcept {
    if (const auto* tool = std::get_if<SelectTool>(&setting)) {
        if (equipment_.tools.find(tool->number) == nullptr) return ErrorId::invalid_tool;
        equipment_.selected_tool = tool->number;
    } else if (const auto* payload = std::get_if<SelectPayload>(&setting)) {
        if (equipment_.payloads.find(payload->number) == nullptr) return ErrorId::invalid_tool;
        equipment_.selected_payload = payload->number;
    } else if (const auto* written = std::get_if<WritePayload>(&setting)) {
        if (!usable(written->body)) return ErrorId::invalid_parameter;
        if (!equipment_.payloads.define(written->number, written->body)) return ErrorId::invalid_tool;
    } else if (const auto* all = std::get_if<WriteBodies>(&setting)) {
        if (all->count > GroupEquipment::most_bodies) return ErrorId::invalid_parameter;
        for (std::size_t i = 0; i < all->count; ++i)
            if (!usable(all->bodies[i])) return ErrorId::invalid_parameter;
        equipment_.bodies = all->bodies;
        equipment_.body_count = all->count;
    }
    return ErrorId::none;
}

/// G-077: all members or none.
ErrorId AxisGroup::set_position(const GroupCommand& command, Owner owner) noexcept {
    const SetGroupPosition wanted{command.frame, command.kind == GroupCommandKind::set_position_relative, command.target, command.wanted};
    if (state_ == GroupState::GroupDisabled) return ErrorId::group_disabled;
    if (state_ == GroupState::GroupErrorStop) return ErrorId::in_error_stop;
    if (state_ != GroupState::GroupStandby || interrupted_) return ErrorId::state_forbids;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members_.has(i)) continue;
        const auto& axis = members_.axis(i).view();
        if (!axis.online) return ErrorId::drive_not_ready;
        if (axis.state != AxisState::Standstill && axis.state != AxisState::Disabled) return ErrorId::member_moves;
    }
    const auto goal = members_for(wanted, view_, equipment_, config_.kinematics.get());
    if (goal.error != ErrorId::none) return goal.error;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members_.has(i)) continue;
        const auto error = members_.axis(i).set(SetPosition{.position = goal.place.axes[i], .relative = false}, owner);
        if (error == ErrorId::none) continue;
        for (std::size_t k = 0; k < i; ++k)  // as it was
            if (members_.has(k)) (void)members_.axis(k).set(SetPosition{.position = view_.actual_position[k], .relative = false}, owner);
        return error;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes

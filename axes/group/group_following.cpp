// Of an AxisGroup: commands in frames that move, and how it goes from one frame to another.

#include "axes/group/axis_group.hpp"
#include "axes/group/group_arm.hpp"
#include "axes/group/motion_target.hpp"
#include "axes/group/tool_motion.hpp"

namespace taktwerk::axes {

MotionState AxisGroup::state_of(std::size_t place) const noexcept {
    if (tracking_.active()) return tracking_.of(place);
    return run_.exists() ? run_.of(place) : MotionState{hold_[place], 0, 0};
}

/// The group moves in the frame, or a command in it waits. The machine's own is in use with each that moves: they are seen from it.
bool AxisGroup::uses_track(MC_CoordSystem frame) const noexcept {
    const auto track = equipment_.frames.track_of(frame);
    const auto is_it = [&](const FrameTrack& used) { return used.moves() && (frame == mcMCS || used.serial == track.serial); };
    if (members_.led() && tracking_.active() && is_it(tracking_.track())) return true;
    if (queue_.has_active() && is_it(queue_.active().place.track)) return true;
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (is_it(queue_.waiting_at(i).place.track)) return true;
    return false;
}

ErrorId AxisGroup::refuse_track(const GroupCommand& command) const noexcept {
    using enum GroupCommandKind;
    if (command.kind == track_frame) {
        const auto& track = command.track;
        if (command.buffer_mode > mcBuffered) return ErrorId::buffer_mode_not_supported;
        if (!track.moves() || !track.master.valid() || members_.contains(track.master)) return ErrorId::invalid_axis;
        if (!has_all_joints(config_.kinematics.get(), members_)) return ErrorId::no_kinematics;
        const auto which = commands_of(*config_.kinematics);
        if (track.kind == FrameTrack::Kind::table && !which[3] && !which[4] && !which[5]) return ErrorId::not_supported;
    }
    // Who queues it behind the commands that use the frame bends none of them (G-085).
    const bool sets = command.kind == track_frame || command.kind == set_frame;
    if (sets) return command.execution == mcImmediately && uses_track(command.frame) ? ErrorId::frame_in_use : ErrorId::none;
    const auto track = place_of(command).track;
    if (!track.moves()) return ErrorId::none;
    if (members_.contains(track.master)) return ErrorId::invalid_axis;  // it has become one since
    return command.kind >= linear_absolute && command.kind <= circular_relative ? ErrorId::none : ErrorId::not_supported;
}

bool AxisGroup::change_frame(const FrameTrack& track, ErrorId& error) noexcept {
    if (tracking_.engaged() && tracking_.is(track)) {
        tracking_.plan_anew(members_);
    } else {
        tracking_.release();
        if (!tracking_.rests()) return false;
        tracking_.clear();
        if (!track.moves()) return true;
        error = tracking_.prepare(track, members_);
    }
    still_ = members_.set_positions();
    return true;
}

/// The path and the frame's way make one set-point.
void AxisGroup::go_with_frame(Duration period) noexcept {
    ToolMotion on_frame;
    const bool moves = run_.see_tool(on_frame);
    if (run_.exists())
        for (std::size_t i = 0; i < most_members; ++i)
            if (members_.has(i)) still_[i] = run_.of(i).position;
    const auto limit = tracking_.step(moves ? &on_frame : nullptr, members_, period);
    if (tracking_.fault() != ErrorId::none) fail(static_cast<std::uint16_t>(tracking_.fault()));
    if (limit == ErrorId::none) return;
    fail(static_cast<std::uint16_t>(limit));
    leave(GroupEvent::error);  // each brakes on its own ramp
}

}  // namespace taktwerk::axes

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "axes/group/group_equipment.hpp"
#include "axes/group/group_words.hpp"
#include "axes/group/written_pose.hpp"
#include "hmi_bridge/state/lcm_text.hpp"
#include "hmi_bridge/state/whole_state.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "hmi_bridge/words/place_text.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

using runtime::SeenGroup;
using taktwerk_lcm::whole_refusal_v1_t;

constexpr double degree = std::numbers::pi / 180;

std::string_view axis_name(axes::AxisRef axis, const runtime::MachineLayout& layout) {
    return axis.valid() && axis.index < layout.axes.size() ? std::string_view(layout.axes[axis.index].name) : std::string_view{};
}

/// Of a member it is an alarm, of the path the number of an error.
void fill_error(whole_group_v3_t& out, const SeenGroup& group, const runtime::MachineLayout& layout) {
    const auto error = group.error;
    const auto axis = axis_name(group.error_axis, layout);
    out.error = error;
    const auto put = [&](std::string_view name, std::string_view text, std::string_view cause, std::string_view remedy) {
        put_text(out.error_name, name);
        put_text(out.error_text, text);
        put_text(out.error_cause, cause);
        put_text(out.error_remedy, remedy);
    };
    const auto* alarm = find_alarm(axes::axis_alarms, error);
    if (!alarm) alarm = find_alarm(runtime::machine_alarms, error);
    const auto* text = axes::find_error(static_cast<axes::ErrorId>(error));
    // Its sentence, with its numbers, stands among the alarms.
    if (alarm) put(alarm->name, axis.empty() ? std::string{} : of_axis(alarm->name, axis), alarm->cause, alarm->remedy);
    else if (text && error != 0 && !axis.empty())
        put(text->name, fmt::format("{}, namely axis {}", text->english.text, axis), text->english.cause, text->english.remedy);
    else if (text && error != 0) put(text->name, text->english.text, text->english.cause, text->english.remedy);
    else put({}, {}, {}, {});
}

/// X Y Z, and turns in degrees, seen from the machine: seen from a frame of it.
void put_from(const axes::Pose& frame, std::array<double, 6> place, double (&out)[6]) {
    for (std::size_t i = 3; i < 6; ++i) place[i] *= degree;
    const auto seen = axes::numbers_of(axes::seen_from(frame, axes::pose_of_numbers(place)));
    for (std::size_t i = 0; i < 6; ++i) out[i] = i < 3 ? seen[i] : seen[i] / degree;
}

void fill_members(whole_group_v3_t& out, const SeenGroup& group, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    out.members.clear();
    for (std::size_t place = 0; place < group.members.size(); ++place) {
        const auto axis = group.members[place].index;
        if (!group.members[place].valid() || axis >= s.axes.size() || axis >= layout.axes.size()) continue;
        auto& member = out.members.emplace_back();
        put_text(member.axis, layout.axes[axis].name);
        member.ident = static_cast<std::int32_t>(place + 1);
        put_text(member.unit, layout.axes[axis].unit);
        member.set_position = s.axes[axis].set_position;
        member.actual_position = s.axes[axis].actual_position;
        member.set_velocity = s.axes[axis].set_velocity;
        member.velocity_use = group.use[place].velocity;
        member.acceleration_use = group.use[place].acceleration;
        member.jerk_use = group.use[place].jerk;
    }
    out.member_count = static_cast<std::int32_t>(out.members.size());
}

/// Those that somebody has set: the others are the machine's, or the world.
void fill_frames(whole_group_v3_t& out, const SeenGroup& group, const runtime::MachineLayout& layout) {
    axes::GroupFrames frames;
    frames.machine = group.frames.machine;
    frames.product = group.frames.product;
    out.frames.clear();
    for (int each = axes::mcWCS; each <= axes::mcPCS_8; ++each) {
        const auto frame = static_cast<axes::MC_CoordSystem>(each);
        if (frame != axes::mcWCS && !axes::is_product(frame)) continue;
        const auto leader = axes::is_product(frame) ? group.frames.leader[axes::product_index(frame)] : axes::AxisRef{};
        const auto from_machine = frames.seen_from_machine(frame);
        if (from_machine == axes::Pose{} && !leader.valid()) continue;
        auto& seen = out.frames.emplace_back();
        put_text(seen.frame, name(frame));
        put_text(seen.axis, axis_name(leader, layout));
        put_from(from_machine, group.tool.set, seen.tool_set);
        put_from(from_machine, group.tool.actual, seen.tool_actual);
        if (group.tool.known) continue;
        std::fill(std::begin(seen.tool_set), std::end(seen.tool_set), 0.0);
        std::fill(std::begin(seen.tool_actual), std::end(seen.tool_actual), 0.0);
    }
    out.frame_count = static_cast<std::int32_t>(out.frames.size());
}

/// With no command left it may still stand on a belt, which takes it along when it starts.
std::string_view what_moves(const SeenGroup& group) {
    if (group.active != 0) return name(group.active_kind);
    switch (group.track.kind) {
        case axes::FrameTrack::Kind::belt: return "MC_TrackConveyorBelt";
        case axes::FrameTrack::Kind::table: return "MC_TrackRotaryTable";
        case axes::FrameTrack::Kind::none: break;
    }
    return {};
}

void fill_way(whole_group_v3_t& out, const SeenGroup& group, const runtime::MachineLayout& layout) {
    out.tool_known = group.tool.known;
    for (std::size_t i = 0; i < 6; ++i) {
        out.tool_set[i] = group.tool.set[i];
        out.tool_actual[i] = group.tool.actual[i];
    }
    out.tool_speed = group.tool.speed;
    out.tool_actual_speed = group.tool.actual_speed;
    const auto& along = group.along;
    out.path_velocity = along.velocity;
    out.path_acceleration = along.acceleration;
    put_text(out.limiter, name(along.limiter));
    const auto limiting = along.limiter == axes::PathLimiter::axis && along.limiting_place < group.members.size()
                              ? group.members[along.limiting_place]
                              : axes::AxisRef{};
    put_text(out.limiting_axis, axis_name(limiting, layout));
    out.path_deviation = group.path_deviation;
    put_text(out.track, name(group.track.kind));
    put_text(out.track_axis, axis_name(group.track.axis, layout));
    out.track_in_sync = group.track.in_sync;
    out.track_lag = group.track.lag;
    out.tool_limit = along.tool_limit;
    put_text(out.command, what_moves(group));
    put_text(out.block, layout.block_at(group.block));
    out.command_id = group.active;
    out.progress = along.progress;
    out.distance_to_go = along.to_go;
    out.remaining_s = to_seconds(along.remaining);
    out.queued = group.queued;
    out.override_velocity = group.override_factor;
    out.operators_override = group.operators_override;
}

/// Of a path that is one axis' own way: that axis'. Of several axes together it is the norm of their numbers, which is no length.
void fill_path_unit(whole_group_v3_t& out, const SeenGroup& group, const runtime::MachineLayout& layout) {
    std::string_view unit = out.unit;
    std::size_t count = 0;
    for (std::size_t place = 0; place < group.members.size(); ++place) {
        const auto axis = group.members[place];
        if ((group.along.members >> place & 1u) == 0 || !axis.valid() || axis.index >= layout.axes.size()) continue;
        unit = count++ == 0 ? std::string_view(layout.axes[axis.index].unit) : std::string_view("u");
    }
    put_text(out.path_unit, unit);
}

void fill_refusal(whole_refusal_v1_t& out, const SeenGroup& group, const runtime::MachineLayout& layout, std::size_t index) {
    const auto& refusal = group.refusal;
    const auto& why = refusal.why;
    const auto& at = why.at;
    const bool any = why.error != axes::ErrorId::none;
    const auto* text = any ? axes::find_error(why.error) : nullptr;
    const auto axis = at.place < group.members.size() ? group.members[at.place] : axes::AxisRef{};
    out.number = refusal.number;
    put_text(out.error, text ? text->name : std::string_view{});
    put_text(out.text, text ? text->english.text : std::string_view{});
    put_text(out.remedy, text ? text->english.remedy : std::string_view{});
    put_text(out.command, any ? name(refusal.kind) : std::string_view{});
    put_text(out.block, any ? layout.block_at(refusal.block) : std::string_view{});
    put_text(out.where, any ? std::string_view(place_text(why, layout, index, group.members)) : std::string_view{});
    put_text(out.room, room_name(at.room, layout, index));
    out.room_kept_free = !out.room.empty() && layout.groups[index].rooms[at.room].kept_free;
    put_text(out.axis, axis_name(axis, layout));
    out.limit_known = at.limit_known;
    out.position = at.position;
    out.limit = at.limit;
    out.on_path = at.on_path;
    out.part = at.part;
    out.length = at.length;
    out.in_space = at.in_space;
    for (std::size_t i = 0; i < at.point.size(); ++i) out.point[i] = at.point[i];
    out.line = why.line;
}

}  // namespace

void fill(whole_group_v3_t& out, const runtime::Snapshot& snapshot, const runtime::MachineLayout& layout, std::size_t index) {
    const auto& group = snapshot.groups[index];
    put_text(out.name, layout.groups[index].name);
    put_text(out.unit, layout.groups[index].unit);
    put_text(out.state, name(group.state));
    out.interrupted = group.interrupted;
    out.held = group.held;
    out.resetting = group.resetting;
    out.powered = group.powered;
    out.online = group.online;
    out.in_position = group.in_position;
    fill_error(out, group, layout);
    fill_members(out, group, snapshot, layout);
    fill_frames(out, group, layout);
    fill_way(out, group, layout);
    fill_path_unit(out, group, layout);
    fill_refusal(out.refusal, group, layout, index);
}

}  // namespace taktwerk::hmi

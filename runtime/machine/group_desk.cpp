#include "runtime/machine/group_desk.hpp"

#include <cmath>
#include <numbers>

#include "axes/group/member_limits.hpp"

namespace taktwerk::runtime {

using axes::ErrorId;
using axes::GroupCommandKind;

namespace {

double length_of(const std::array<double, 6>& velocity) noexcept { return std::hypot(velocity[0], velocity[1], velocity[2]); }

/// X Y Z as they are, turns in degrees.
std::array<double, 6> for_people(std::array<double, 6> pose) noexcept {
    constexpr double degrees = 180 / std::numbers::pi;
    for (std::size_t i = 3; i < 6; ++i) pose[i] *= degrees;
    return pose;
}

float part(double value, double limit) noexcept {
    return limit > 0 && std::isfinite(limit) ? static_cast<float>(std::abs(value) / limit) : 0.0F;
}

}  // namespace

GroupDesk::GroupDesk(MachineBody& body, HandMotion& hands)
    : body_(body), hands_(hands), hand_(body), seen_(body.axis_groups.size()), accelerations_(body.axis_groups.size()) {}

std::uint64_t GroupDesk::newest_stop(std::size_t group) const noexcept {
    std::uint64_t newest = 0;
    if (group < seen_.size())
        for (const auto member : body_.axis_groups[group].view().members)
            if (member.valid()) newest = std::max(newest, hands_.newest_stop(member.index));
    return newest;
}

axes::Owner GroupDesk::owner_of(std::size_t group) const noexcept {
    for (const auto member : body_.axis_groups[group].view().members)
        if (member.valid()) return body_.axes[member.index].view().owner;
    return axes::Owner::none;
}

axes::Owner GroupDesk::owner_against(std::size_t group, axes::Owner owner) const noexcept {
    for (const auto member : body_.axis_groups[group].view().members) {
        if (!member.valid()) continue;
        const auto other = body_.axes[member.index].view().owner;
        if (other != axes::Owner::none && other != owner) return other;
    }
    return owner_of(group);
}

Verdict GroupDesk::submit(std::size_t group, GroupCommandKind kind, axes::Owner owner) noexcept {
    axes::GroupCommand command;
    command.kind = kind;
    return verdict_of(body_.axis_groups.submit(ref(group), command, owner).error);
}

Verdict GroupDesk::halt(std::size_t group) noexcept {
    Verdict first;
    for (const auto member : body_.axis_groups[group].view().members) {
        if (!member.valid()) continue;
        const auto each = hands_.stop(member.index);
        if (first.answer == Answer::accepted) first = each;
    }
    return first;
}

Verdict GroupDesk::interrupt(std::size_t group) noexcept {
    auto& of = body_.axis_groups[group];
    if (const auto error = of.hold(); error != ErrorId::none) return verdict_of(error);
    if (of.leads()) return {};
    // What its program moves alone has no interruption to be kept in.
    for (const auto member : of.view().members)
        if (member.valid() && body_.axes[member.index].view().state != axes::AxisState::Standstill) (void)hands_.stop_alone(member.index);
    return {};
}

// What a program has interrupted, it has for its own reasons: nobody at a panel knows whether they are over.
Verdict GroupDesk::go_on(std::size_t group) noexcept {
    if (body_.emergency) return {Answer::not_possible_now, ErrorId::interlocked};
    auto& of = body_.axis_groups[group];
    auto verdict = verdict_of(of.release_hold());
    verdict.waits_for_program = verdict.answer == Answer::accepted && of.view().program_interrupts;
    return verdict;
}

Verdict GroupDesk::execute(const OperatorCommand& command) noexcept {
    const std::size_t group = command.index;
    if (group >= seen_.size()) return {Answer::unknown_name};
    switch (command.action) {
        case OperatorAction::group_halt: return halt(group);
        case OperatorAction::group_interrupt: return interrupt(group);
        case OperatorAction::group_continue: return go_on(group);
        case OperatorAction::group_override:
            if (body_.axis_groups[group].set_operators_override(command.value) != ErrorId::none) return {Answer::bad_value};
            return {};
        case OperatorAction::group_reset: return verdict_of(body_.axis_groups.reset(ref(group), command.owner));
        case OperatorAction::group_enable: return verdict_of(body_.axis_groups.set(ref(group), axes::EnableGroup{}, command.owner));
        case OperatorAction::group_jog: return hand_.jog(command, group);
        case OperatorAction::group_disable: return submit(group, GroupCommandKind::disable, command.owner);
        default: return {Answer::unknown_name};
    }
}

void GroupDesk::look() noexcept {
    for (std::size_t i = 0; i < seen_.size(); ++i) look_at(i);
}

void GroupDesk::look_at_frames(const axes::GroupFrames& frames, SeenGroup& seen) noexcept {
    seen.frames.machine = frames.machine;
    seen.frames.product = frames.product;
    for (std::size_t i = 0; i < axes::product_frames; ++i)
        seen.frames.leader[i] = frames.tracks[i].moves() ? frames.tracks[i].master : axes::AxisRef{};
}

void GroupDesk::look_at_use(const axes::GroupView& view, std::size_t place, SeenGroup& seen) noexcept {
    const auto& axis = body_.axes[view.members[place].index];
    const auto limits = axes::path_limits_of(axis);
    auto& before = accelerations_[static_cast<std::size_t>(&seen - seen_.data())][place];
    // Without power its set-point is where the motor is: that begins and ends in a step, and uses no limit of anybody's path.
    if (!axis.view().powered) {
        before = 0;
        seen.use[place] = {};
        return;
    }
    const double jerk = (view.set_acceleration[place] - before) / to_seconds(body_.config.cycle);
    before = view.set_acceleration[place];
    seen.use[place] = {part(view.set_velocity[place], limits.velocity), part(view.set_acceleration[place], limits.acceleration),
                       part(jerk, limits.jerk)};
}

void GroupDesk::look_at(std::size_t group) noexcept {
    const auto& view = body_.axis_groups[group].view();
    auto& seen = seen_[group];
    seen.state = view.state;
    seen.error = view.error;
    seen.error_axis = view.has(view.error_place) ? view.members[view.error_place] : axes::AxisRef{};
    seen.interrupted = view.interrupted;
    seen.held = view.held;
    seen.resetting = view.resetting;
    seen.powered = view.powered;
    seen.online = view.online;
    seen.in_position = view.in_position;
    seen.members = view.members;
    for (std::size_t i = 0; i < axes::most_members; ++i) {
        if (view.has(i)) look_at_use(view, i, seen);
        else seen.use[i] = {};
    }
    seen.tool.known = view.tool_known;
    if (view.tool_known) {
        seen.tool.set = for_people(view.tool_set);
        seen.tool.actual = for_people(view.tool_actual);
        seen.tool.speed = length_of(view.tool_velocity);
        seen.tool.actual_speed = length_of(view.tool_actual_velocity);
    } else {
        seen.tool = {};
    }
    seen.along.velocity = view.path_velocity;
    seen.along.acceleration = view.path_acceleration;
    seen.along.members = view.path_members;
    seen.along.limiter = view.limiter;
    seen.along.limiting_place = view.limiting_place;
    seen.along.tool_limit = view.tool_limit;
    seen.jog_end = view.jog_end;
    seen.jog_hindrance = view.jog_hindrance;
    seen.refusal = view.refusal;
    seen.along.to_go = view.remaining_distance;
    seen.along.progress = view.progress;
    seen.along.remaining = view.remaining;
    seen.active_kind = view.active_kind;
    seen.track = {view.track.kind, view.track.axis, view.track.in_sync, view.track.lag};
    seen.path_deviation = view.path_deviation;
    look_at_frames(body_.axis_groups[group].equipment().frames, seen);
    seen.active = view.active;
    seen.block = view.block;
    seen.queued = view.queued_count;
    seen.override_factor = view.override_factors.velocity;
    seen.operators_override = view.operators_override;
}

}  // namespace taktwerk::runtime

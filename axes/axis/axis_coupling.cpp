#include "axes/axis/axis_coupling.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/coupling_links.hpp"
#include "axes/axis/coupling_start.hpp"
#include "axes/axis/master_side.hpp"

namespace taktwerk::axes {

namespace {

template <class... Numbers>
bool finite(Numbers... numbers) noexcept {
    return (std::isfinite(numbers) && ...);
}

ErrorId check_cam(const CamDetails& cam) noexcept {
    const bool usable = finite(cam.master_offset, cam.slave_offset, cam.master_scaling, cam.slave_scaling, cam.master_start_distance,
                               cam.master_sync_position) &&
                        cam.master_scaling != 0;
    return usable ? ErrorId::none : ErrorId::invalid_parameter;
}

/// MasterSyncPosition is a place of the profile; one that repeats has it again in each pass.
bool has_sync_point(const CamDetails& cam, const PreparedCam& table) noexcept {
    const double along = sync_place(cam, table) - table.begin();
    return cam.master_start_distance == 0 || table.periodic() || (along >= 0 && along <= table.length());
}

}  // namespace

ErrorId AxisCoupling::refuse_master(AxisRef ref, MC_Source source) const noexcept {
    const MasterSide* master = links_.axis(ref);
    if (!master || master == &as_master_) return ErrorId::invalid_master;
    // What a master is commanded jumps; only what its generator makes of it can be followed.
    if (source == mcCommandedValue) return ErrorId::invalid_parameter;
    if (!master->reading(source).usable) return ErrorId::invalid_master;
    return as_master_.is_followed_by(*master) ? ErrorId::coupling_loop : ErrorId::none;
}

ErrorId AxisCoupling::refuse(const AxisCommand& command) const noexcept {
    if (uncouples(command.kind)) return body_.state == AxisState::SynchronizedMotion ? ErrorId::none : ErrorId::not_coupled;
    if (!couples(command.kind)) return ErrorId::none;
    const auto ratio_error = [](const GearRatio& ratio) noexcept {
        return ratio.denominator == 0 ? ErrorId::invalid_ratio : ErrorId::none;
    };
    ErrorId error = ErrorId::invalid_parameter;  // details of another kind
    if (const auto* gear = std::get_if<GearDetails>(&command.details); gear && command.kind == CommandKind::gear_in)
        error = ratio_error(gear->ratio);
    if (const auto* point = std::get_if<GearInPosDetails>(&command.details); point && command.kind == CommandKind::gear_in_pos) {
        error = ratio_error(point->ratio);
        if (!finite(point->master_sync_position, point->slave_sync_position, point->master_start_distance))
            error = ErrorId::invalid_position;
        if (!(command.velocity >= 0) || std::isinf(command.velocity)) error = ErrorId::invalid_velocity;
    }
    if (const auto* cam = std::get_if<CamDetails>(&command.details); cam && command.kind == CommandKind::cam_in) {
        error = check_cam(*cam);
        const auto* table = body_.scene.tables ? body_.scene.tables->prepared(cam->table) : nullptr;
        if (error == ErrorId::none && !table) error = ErrorId::invalid_table;
        if (error == ErrorId::none && !has_sync_point(*cam, *table)) error = ErrorId::invalid_position;
    }
    if (const auto* sum = std::get_if<CombineDetails>(&command.details); sum && command.kind == CommandKind::combine) {
        error = ratio_error(sum->ratio1);
        if (error == ErrorId::none) error = ratio_error(sum->ratio2);
        if (error == ErrorId::none) error = refuse_master(sum->master2, sum->source2);
    }
    if (error != ErrorId::none) return error;
    const auto masters = masters_of(command);
    return refuse_master(masters.axes[0], masters.sources[0]);
}

bool AxisCoupling::never_ends(const AxisCommand& command) const noexcept {
    const auto* cam = std::get_if<CamDetails>(&command.details);
    if (!cam || command.kind != CommandKind::cam_in || !body_.scene.tables) return false;
    const auto* table = body_.scene.tables->prepared(cam->table);
    return table && table->periodic();
}

bool AxisCoupling::waits_for_ever() const noexcept {
    for (std::size_t i = body_.queue.waiting(); i > 0; --i)
        if (const auto& before = body_.queue.waiting_at(i - 1).command; before.kind != CommandKind::setting) return never_ends(before);
    return never_ends(body_.queue.active().command);
}

ErrorId AxisCoupling::select_cam(const SelectCam& wanted) noexcept {
    if (!body_.scene.tables) return ErrorId::invalid_table;
    const auto made = body_.scene.tables->prepare(wanted.source, wanted.periodic, wanted.master_absolute, wanted.slave_absolute);
    if (made.error == ErrorId::none) {
        links_.selected = made.id;
        links_.selected_as = wanted;
    }
    return made.error;
}

ErrorId AxisCoupling::join(const AcceptedCommand& accepted) noexcept {
    const AxisCommand command = accepted.command;
    // It may have waited: what was right then need not be now.
    if (const auto error = refuse(command); error != ErrorId::none) return error;
    plan_link(accepted.id, command);
    return ErrorId::none;
}

/// `updated`: the running coupling that goes on with `command`; relative inputs count from its start.
void AxisCoupling::plan_link(CommandId id, const AxisCommand& command, const Link* updated) noexcept {
    links_.drop(links_.state.next);
    auto& link = links_.state.next;
    links_.state.shown = true;
    link.id = id;
    link.command = command;
    link.masters = masters_of(command);
    if (const auto* cam = std::get_if<CamDetails>(&command.details)) {
        link.cam = cam->table;
        body_.scene.tables->hold(link.cam);
    }
    if (updated && updated->masters.axes == link.masters.axes) {
        link.started = true;
        link.master_start = updated->master_start;
        link.second_start = updated->second_start;
        link.slave_start = updated->slave_start;
        link.table_start = updated->table_start;
    }
    start_.find_start(link);
    if (updated) {
        link.waits = false;
        return;
    }
    // A table or a feed belongs to its command and ends with it: until this one begins, the axis keeps its velocity.
    if (motion_.goal.kind == Goal::Kind::given) {
        aim_.at_velocity(motion_.setpoint.base().velocity, full_limits(body_.config.limits));
        motion_.goal.kept = true;
    }
    // A command that this one ended before it began has taken what was superimposed into the base: the former motion is planned anew.
    const auto& base = motion_.setpoint.base();
    if (motion_.setpoint.finished() && (base.velocity != 0 || base.acceleration != 0)) {
        if (motion_.goal.kind == Goal::Kind::rest) aim_.at_velocity(0, full_limits(body_.config.limits));
        else if (motion_.goal.kind != Goal::Kind::coupled) motion_.goal_pending = true;
    }
    // Behind a cam that has just ended the next one begins where that ended, not a part of a cycle later.
    const auto* before = motion_.goal.kind == Goal::Kind::coupled ? links_.state.follower.cam() : nullptr;
    if (!before || !before->over() || command.buffer_mode != mcBuffered || link.masters.axes != links_.state.running.masters.axes) return;
    const auto now = links_.seen(links_.state.running, 0);
    const double since = std::abs(way(before->end(), now.place, links_.axis(link.masters.axes[0])->units().feed()));
    link.chained = since <= 2 * std::abs(now.velocity) * to_seconds(body_.cycle);
    link.master_start = before->end();
    link.slave_start = before->slave_end();
}

ErrorId AxisCoupling::update(const AxisCommand& command) noexcept {
    auto& active = body_.queue.active();
    if (const auto error = refuse(command); error != ErrorId::none) return error;
    if (body_.queue.waiting() > 0 && never_ends(command)) return ErrorId::buffer_mode_not_supported;
    active.command = command;
    if (links_.state.running.id != active.id) {
        // Not begun yet.
        plan_link(active.id, command);
        return ErrorId::none;
    }
    plan_link(active.id, command, &links_.state.running);
    return ErrorId::none;
}

void AxisCoupling::settle() noexcept {
    if (links_.state.next.id != 0 && links_.state.next.id != body_.queue.active().id) links_.drop(links_.state.next);
    if (links_.state.running.id != 0 && motion_.goal.kind != Goal::Kind::coupled) links_.drop(links_.state.running);
    if (links_.state.running.id == 0 && links_.state.next.id == 0 && links_.state.phase_master.valid() &&
        !couples(body_.queue.active().command.kind))
        links_.clear_phase();
}

void AxisCoupling::follow(Duration period) noexcept {
    settle();
    if (links_.state.running.id == 0 && links_.state.next.id == 0) return;
    const auto lost = [&](Link& link) noexcept { return link.id != 0 && !links_.read(link, period); };
    if (lost(links_.state.running) || lost(links_.state.next)) {
        body_.queue.finish_active(Outcome::error, ErrorId::master_lost);
        const auto& link = links_.state.next.id != 0 ? links_.state.next : links_.state.running;
        conduct_.fail(AxisAlarm::master_lost, link.masters.axes[0].index);
        return;
    }
    links_.state.phase.advance(period);
    if (links_.state.next.id == 0 || !start_.starts_now(links_.state.next)) return;
    if (const auto error = start_.engage(period); error != ErrorId::none) {
        body_.queue.finish_active(Outcome::error, error);
        conduct_.halt_on_own_account();  // the motion before was given up for this one
    }
}

void AxisCoupling::step(Duration period) noexcept {
    auto limits = start_.follower_limits(links_.state.running.command);
    // The axis' velocity holds for the sum: what is superimposed has its part in its sense, and the slave falls behind with the rest.
    // Also what it is about to have: it may speed up faster than the slave slows down.
    const auto beside = [&](double sense) noexcept {
        return std::max(sense * motion_.setpoint.superimposed().velocity, motion_.setpoint.superimposed_top(sense));
    };
    limits.forward = std::clamp(body_.config.limits.velocity_towards(1) - beside(1), 0.0, limits.forward);
    limits.backward = std::clamp(body_.config.limits.velocity_towards(-1) - beside(-1), 0.0, limits.backward);
    links_.state.follower.set_limits(limits);
    step_on(period);
}

void AxisCoupling::step_on(Duration period) noexcept {
    if (body_.endless && body_.units.far_from_anchor(motion_.setpoint.base().position)) aim_.reanchor();
    auto& follower = links_.state.follower;
    const bool two = links_.state.running.masters.axes[1].valid();
    const auto first = links_.seen(links_.state.running, 0);
    const auto next = follower.step(first, two ? links_.seen(links_.state.running, 1) : EndlessMotion{}, motion_.setpoint.base(),
                                    links_.slave_frame(), period);
    motion_.setpoint.set(next);
    motion_.goal.limiter = follower.held_back() ? VelocityLimiter::axis_limit : VelocityLimiter::command;
    if (const auto* cam = follower.cam()) {
        if (!follower.approaching()) links_.state.cam_ends += cam->ends() - links_.state.cam_ends_seen;
        links_.state.cam_ends_seen = cam->ends();
    }
}

bool AxisCoupling::complete() noexcept {
    const bool mine = links_.state.next.id == 0 && links_.state.running.id == body_.queue.active().id;
    body_.queue.set_in_target(mine && links_.state.follower.in_sync());
    const auto* cam = links_.state.follower.cam();
    if (!mine || !cam || !cam->over() || body_.queue.waiting() == 0 || body_.queue.front().command.kind == CommandKind::setting)
        return false;
    body_.queue.finish_active(Outcome::aborted);
    return true;
}

}  // namespace taktwerk::axes

// Following masters: what is accepted, who follows whom, the slave's part of a cycle, and how it ends. How a relation begins is in
// axis_coupling_start.cpp, phasing in axis_phasing.cpp.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

template <class... Numbers>
bool finite(Numbers... numbers) noexcept {
    return (std::isfinite(numbers) && ...);
}

/// MasterSyncPosition is a place of the profile; one that repeats has it again in each pass.
bool has_sync_point(const CamDetails& cam, const PreparedCam& table) noexcept {
    const double along = sync_place(cam, table) - table.begin();
    return cam.master_start_distance == 0 || table.periodic() || (along >= 0 && along <= table.length());
}

ErrorId check_cam(const CamDetails& cam) noexcept {
    const bool usable = finite(cam.master_offset, cam.slave_offset, cam.master_scaling, cam.slave_scaling, cam.master_start_distance,
                               cam.master_sync_position) &&
                        cam.master_scaling != 0;
    return usable ? ErrorId::none : ErrorId::invalid_parameter;
}

}  // namespace

// --- as a master ------------------------------------------------------------------------------------------------------------

MasterTrack::Reading AxisCore::as_master(MC_Source source) const noexcept {
    MasterTrack::Reading reading;
    reading.feed = units_.feed();
    reading.largest_velocity = config_.limits.velocity;
    if (source == mcActualValue) {
        reading.motion = {{units_.anchor(), actual_local()}, feedback_.velocity / units_.counts_per_unit(), 0};
        reading.usable = online();
        reading.fresh = feedback_.fresh;
        reading.planned = false;
        reading.taken = feedback_.latched;
        return reading;
    }
    const auto& set = setpoint_.state();
    reading.motion = {{units_.anchor(), set.position}, set.velocity, set.acceleration};
    reading.usable = seeded_;
    // A drive without power moves as it likes, and its set-point with it: a measured position.
    reading.planned = !power_.follows_actual() && !drive_homing_.busy();
    reading.taken = now_;
    return reading;
}

MasterList AxisCore::masters() const noexcept {
    MasterList list;
    const auto add = [&](const MasterChoice& choice) noexcept {
        for (const auto axis : choice.axes)
            if (axis.valid()) list.axes[list.count++] = axis;
    };
    if (coupling_.running.id != 0) add(coupling_.running.masters);
    if (coupling_.next.id != 0) add(coupling_.next.masters);
    if (couples(queue_.active().command.kind)) add(masters_of(queue_.active().command));
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (couples(queue_.waiting_at(i).command.kind)) add(masters_of(queue_.waiting_at(i).command));
    return list;
}

/// Depth first from `master` along all couplings that run or wait. Each axis is looked at once.
bool AxisCore::follows_me(const AxisCore& master) const noexcept {
    const std::uint64_t walk = (static_cast<std::uint64_t>(++walks_) << 16) | index_;
    const AxisCore* at = &master;
    at->walk_ = walk;
    at->walk_back_ = nullptr;
    while (at) {
        if (at == this) return true;
        const auto list = at->masters();
        const AxisCore* further = nullptr;
        for (std::size_t i = 0; i < list.count && !further; ++i) {
            const AxisCore* next = axis_at(list.axes[i]);
            if (next && next->walk_ != walk) further = next;
        }
        if (further) {
            further->walk_ = walk;
            further->walk_back_ = at;
            at = further;
        } else at = at->walk_back_;
    }
    return false;
}

// --- what is accepted -------------------------------------------------------------------------------------------------------

ErrorId AxisCore::refuse_master(AxisRef ref, MC_Source source) const noexcept {
    const AxisCore* master = axis_at(ref);
    if (!master || master == this) return ErrorId::invalid_master;
    // What a master is commanded jumps; only what its generator makes of it can be followed.
    if (source == mcCommandedValue) return ErrorId::invalid_parameter;
    if (!master->as_master(source).usable) return ErrorId::invalid_master;
    return follows_me(*master) ? ErrorId::coupling_loop : ErrorId::none;
}

ErrorId AxisCore::refuse_coupling(const AxisCommand& command) const noexcept {
    if (uncouples(command.kind)) return view_.state == AxisState::SynchronizedMotion ? ErrorId::none : ErrorId::not_coupled;
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
        const auto* table = scene_.tables ? scene_.tables->prepared(cam->table) : nullptr;
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

/// A cam that repeats for ever.
bool AxisCore::never_ends(const AxisCommand& command) const noexcept {
    const auto* cam = std::get_if<CamDetails>(&command.details);
    if (!cam || command.kind != CommandKind::cam_in || !scene_.tables) return false;
    const auto* table = scene_.tables->prepared(cam->table);
    return table && table->periodic();
}

/// Behind it nothing gets its turn (P1-092), neither while it runs nor while it waits itself. Settings pass it.
bool AxisCore::waits_for_ever() const noexcept {
    for (std::size_t i = queue_.waiting(); i > 0; --i)
        if (const auto& before = queue_.waiting_at(i - 1).command; before.kind != CommandKind::setting) return never_ends(before);
    return never_ends(queue_.active().command);
}

ErrorId AxisCore::select_cam(const SelectCam& wanted) noexcept {
    if (!scene_.tables) return ErrorId::invalid_table;
    const auto made = scene_.tables->prepare(wanted.source, wanted.periodic, wanted.master_absolute, wanted.slave_absolute);
    if (made.error == ErrorId::none) {
        view_.selected_cam = made.id;
        view_.selected_as = wanted;
    }
    return made.error;
}

// --- from command to coupling -------------------------------------------------------------------------------------------------

/// The active command's coupling: it begins in the next follow_masters(), or when its master comes to the place where it begins.
ErrorId AxisCore::join(const AcceptedCommand& accepted) noexcept {
    const AxisCommand command = accepted.command;
    if (uncouples(command.kind)) {
        start_at_base();
        aim_at_velocity(setpoint_.base().velocity, full_limits(config_.limits));
        goal_.kept = true;  // P1-271
        queue_.finish_active(Outcome::done);
        // Table 4: with Done begins what was buffered behind it.
        while (queue_.waiting() > 0 && queue_.front().command.kind == CommandKind::setting) carry_out(queue_.pop());
        if (queue_.waiting() > 0) start_waiting(0);
        return ErrorId::none;
    }
    // It may have waited: what was right then need not be now.
    if (const auto error = refuse_coupling(command); error != ErrorId::none) return error;
    plan_link(accepted.id, command);
    return ErrorId::none;
}

/// `updated`: the running coupling that goes on with `command`; relative inputs count from its start.
void AxisCore::plan_link(CommandId id, const AxisCommand& command, const Link* updated) noexcept {
    drop(coupling_.next);
    auto& link = coupling_.next;
    coupling_.shown = true;
    link.id = id;
    link.command = command;
    link.masters = masters_of(command);
    if (const auto* cam = std::get_if<CamDetails>(&command.details)) {
        link.cam = cam->table;
        scene_.tables->hold(link.cam);
    }
    if (updated && updated->masters.axes == link.masters.axes) {
        link.started = true;
        link.master_start = updated->master_start;
        link.second_start = updated->second_start;
        link.slave_start = updated->slave_start;
        link.table_start = updated->table_start;
    }
    find_start(link);
    if (updated) {
        link.waits = false;
        return;
    }
    // A table or a feed belongs to its command and ends with it: until this one begins, the axis keeps its velocity.
    if (goal_.kind == Goal::Kind::given) {
        aim_at_velocity(setpoint_.base().velocity, full_limits(config_.limits));
        goal_.kept = true;
    }
    // A command that this one ended before it began has taken what was superimposed into the base: the former motion is planned anew.
    const auto& base = setpoint_.base();
    if (setpoint_.finished() && (base.velocity != 0 || base.acceleration != 0)) {
        if (goal_.kind == Goal::Kind::rest) aim_at_velocity(0, full_limits(config_.limits));
        else if (goal_.kind != Goal::Kind::coupled) goal_pending_ = true;
    }
    // Behind a cam that has just ended the next one begins where that ended, not a part of a cycle later.
    const auto* before = goal_.kind == Goal::Kind::coupled ? coupling_.follower.cam() : nullptr;
    if (!before || !before->over() || command.buffer_mode != mcBuffered || link.masters.axes != coupling_.running.masters.axes) return;
    const auto now = seen(coupling_.running, 0);
    const double since = std::abs(way(before->end(), now.place, axis_at(link.masters.axes[0])->units_.feed()));
    link.chained = since <= 2 * std::abs(now.velocity) * to_seconds(cycle_);
    link.master_start = before->end();
    link.slave_start = before->slave_end();
}

void AxisCore::drop(Link& link) noexcept {
    if (link.cam.value != 0) scene_.tables->release(link.cam);
    if (link.waits) alarms_.clear(AxisAlarm::coupling_start_passed);
    link = {};
}

/// ContinuousUpdate of the active command: another coupling of the same kind, with the relative inputs of the first one's start.
ErrorId AxisCore::update_coupling(const AxisCommand& command) noexcept {
    auto& active = queue_.active();
    if (const auto error = refuse_coupling(command); error != ErrorId::none) return error;
    if (queue_.waiting() > 0 && never_ends(command)) return ErrorId::buffer_mode_not_supported;
    active.command = command;
    if (coupling_.running.id != active.id) {
        // Not begun yet.
        plan_link(active.id, command);
        return ErrorId::none;
    }
    plan_link(active.id, command, &coupling_.running);
    return ErrorId::none;
}

// --- the cycle ----------------------------------------------------------------------------------------------------------------

bool AxisCore::read_masters(Link& link, Duration period) noexcept {
    for (std::size_t i = 0; i < link.masters.axes.size(); ++i) {
        if (!link.masters.axes[i].valid()) continue;
        const AxisCore* master = axis_at(link.masters.axes[i]);
        if (!master) return false;
        auto reading = master->as_master(link.masters.sources[i]);
        // What is planned now acts at the drive a little later than what was measured: there the master will be.
        if (link.masters.sources[i] == mcActualValue)
            reading.age = std::max(0.0, to_seconds(port_.setpoint_effective(now_) - reading.taken));
        if (!link.tracks[i].next(reading, to_seconds(period))) return false;
    }
    return true;
}

EndlessMotion AxisCore::seen(const Link& link, std::size_t master) const noexcept {
    auto motion = link.tracks[master].motion();
    if (master != 0 || link.masters.axes[0] != coupling_.phase_master) return motion;
    const auto& shift = coupling_.phase.state();
    motion.place.local += shift.position;
    motion.velocity += shift.velocity;
    motion.trend += shift.velocity;
    motion.acceleration += shift.acceleration;
    return motion;
}

/// Whatever took the axis has ended the coupling.
void AxisCore::settle_couplings() noexcept {
    if (coupling_.next.id != 0 && coupling_.next.id != queue_.active().id) drop(coupling_.next);
    if (coupling_.running.id != 0 && goal_.kind != Goal::Kind::coupled) drop(coupling_.running);
    if (coupling_.running.id == 0 && coupling_.next.id == 0 && coupling_.phase_master.valid() && !couples(queue_.active().command.kind))
        clear_phase();
}

void AxisCore::follow_masters(Duration period) noexcept {
    settle_couplings();
    if (coupling_.running.id == 0 && coupling_.next.id == 0) return;
    const auto lost = [&](Link& link) noexcept { return link.id != 0 && !read_masters(link, period); };
    if (lost(coupling_.running) || lost(coupling_.next)) {
        queue_.finish_active(Outcome::error, ErrorId::master_lost);
        const auto& link = coupling_.next.id != 0 ? coupling_.next : coupling_.running;
        fail(AxisAlarm::master_lost, link.masters.axes[0].index);
        return;
    }
    coupling_.phase.advance(period);
    if (coupling_.next.id == 0 || !starts_now(coupling_.next)) return;
    if (const auto error = engage(period); error != ErrorId::none) {
        queue_.finish_active(Outcome::error, error);
        halt_on_own_account();  // the motion before was given up for this one
    }
}

void AxisCore::step_coupled(Duration period) noexcept {
    if (endless_ && units_.far_from_anchor(setpoint_.base().position)) reanchor();
    auto& follower = coupling_.follower;
    auto limits = follower_limits(coupling_.running.command);
    // The axis' velocity holds for the sum: what is superimposed has its part in its sense, and the slave falls behind with the rest.
    // Also what it is about to have: it may speed up faster than the slave slows down.
    const auto beside = [&](double sense) noexcept {
        return std::max(sense * setpoint_.superimposed().velocity, setpoint_.superimposed_top(sense));
    };
    limits.forward = std::clamp(config_.limits.velocity - beside(1), 0.0, limits.forward);
    limits.backward = std::clamp(config_.limits.velocity - beside(-1), 0.0, limits.backward);
    follower.set_limits(limits);
    const bool two = coupling_.running.masters.axes[1].valid();
    const auto first = seen(coupling_.running, 0);
    const auto next = follower.step(first, two ? seen(coupling_.running, 1) : EndlessMotion{}, setpoint_.base(), slave_frame(), period);
    setpoint_.set(next);
    goal_.limiter = follower.held_back() ? VelocityLimiter::axis_limit : VelocityLimiter::command;
    if (const auto* cam = follower.cam()) {
        if (!follower.approaching()) coupling_.cam_ends += cam->ends() - coupling_.cam_ends_seen;
        coupling_.cam_ends_seen = cam->ends();
    }
}

void AxisCore::complete_coupled() noexcept {
    const bool mine = coupling_.next.id == 0 && coupling_.running.id == queue_.active().id;
    queue_.set_in_target(mine && coupling_.follower.in_sync());
    // A cam that is over hands over at once (P1-092: EndOfProfile); other couplings when their Inxxx has been seen.
    const auto* cam = coupling_.follower.cam();
    if (!mine || !cam || !cam->over() || queue_.waiting() == 0 || queue_.front().command.kind == CommandKind::setting) return;
    queue_.finish_active(Outcome::aborted);
    start_waiting(0);
}

void AxisCore::publish_coupling() noexcept {
    coupling_.shown = coupling_.used();  // what is over is shown once more, as gone
    const bool coupled = goal_.kind == Goal::Kind::coupled && coupling_.running.id != 0;
    const auto& link = coupled ? coupling_.running : coupling_.next;
    view_.master = link.id != 0 ? link.masters.axes[0] : AxisRef{};
    view_.sync_started = coupled && coupling_.next.id == 0 && coupling_.follower.approaching();
    view_.cam_ends = coupling_.cam_ends;
    view_.phase_shift = coupling_.phase.state().position;
    view_.phase_covered = coupling_.phase.covered();
    view_.phasing_queued = coupling_.phasing_next.id;
    show_side(SideSlot::phasing, coupling_.phasing.id);
}

}  // namespace taktwerk::axes

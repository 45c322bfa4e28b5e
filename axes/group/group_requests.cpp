// What others ask of a group: checked and answered in the same call.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "axes/group/axis_group.hpp"
#include "axes/group/group_software_limits.hpp"
#include "axes/group/motion_target.hpp"
#include "axes/group/path_shelf.hpp"

namespace taktwerk::axes {

namespace {

bool usable(const Override& factors) noexcept {
    const auto factor = [](double value) { return value > 0 && value <= 1; };
    return factors.velocity >= 0 && factors.velocity <= 1 && factor(factors.acceleration) && factor(factors.jerk);
}

ErrorId check_dynamics(const PathDynamics& dynamics) noexcept {
    if (!std::isfinite(dynamics.velocity)) return ErrorId::invalid_velocity;
    const bool finite = std::isfinite(dynamics.acceleration) && std::isfinite(dynamics.deceleration) && std::isfinite(dynamics.jerk);
    return finite ? ErrorId::none : ErrorId::invalid_dynamics;
}

/// Of percents of the reference dynamics u/s, u/s2, u/s3; 0 or less stays what it is.
ErrorId in_units(PathDynamics& dynamics, const ReferenceDynamics& reference) noexcept {
    if (!reference.percent) return ErrorId::none;
    const auto scale = [](double& value, double whole) {
        if (!(value > 0)) return true;
        if (value > 100 || !(whole > 0)) return false;
        value *= whole / 100;
        return true;
    };
    if (!scale(dynamics.velocity, reference.of.velocity)) return ErrorId::invalid_velocity;
    const bool rest = scale(dynamics.acceleration, reference.of.acceleration) && scale(dynamics.deceleration, reference.of.deceleration) &&
                      scale(dynamics.jerk, reference.of.jerk);
    return rest ? ErrorId::none : ErrorId::invalid_dynamics;
}

ErrorId refuse_transition(const GroupCommand& command) noexcept {
    if (command.transition > mcTMMaxCornerDeviation) return ErrorId::invalid_parameter;
    const bool by_velocity = command.transition == mcTMStartVelocity || command.transition == mcTMConstantVelocity;
    const double most = by_velocity ? 1 : std::numeric_limits<double>::max();
    const bool usable = command.transition_parameter >= 0 && command.transition_parameter <= most;
    return command.transition == mcTMNone || usable ? ErrorId::none : ErrorId::invalid_parameter;
}

/// Who jogs by hand is the person himself.
bool by_hand(const GroupCommand& command) noexcept { return command.kind == GroupCommandKind::jog && command.jog.hand == JogHand::person; }

}  // namespace

bool AxisGroup::waits(const GroupCommand& command) const noexcept {
    return command.buffer_mode != mcAborting && (queue_.has_active() || queue_.waiting() > 0 || interrupted_ || interrupting_ != 0);
}

/// Nobody but the person who holds it lets it go: what a program would begin at once begins then (G-069).
bool AxisGroup::waits_for_person(const GroupCommand& command) const noexcept {
    const bool rests = interrupted_ || interrupting_ != 0;
    return hand_.holds && rests && command.buffer_mode == mcAborting && has_place_in_queue(command.kind) && !by_hand(command);
}

/// G-011, G-064: what the state has an answer to.
ErrorId AxisGroup::refuse_state(const GroupCommand& command) const noexcept {
    using enum GroupState;
    const auto kind = command.kind;
    if (kind == GroupCommandKind::disable) return disabling_ == 0 ? ErrorId::none : ErrorId::state_forbids;
    if (state_ == GroupDisabled) return ErrorId::group_disabled;
    if (state_ == GroupErrorStop) return ErrorId::in_error_stop;
    if (disabling_ != 0 || going_off_ != 0) return ErrorId::state_forbids;
    if (kind == GroupCommandKind::stop) return lock_ == 0 ? ErrorId::none : ErrorId::state_forbids;
    if (state_ == GroupStopping) return ErrorId::state_forbids;
    if (state_ == GroupHoming) return ErrorId::state_forbids;
    if (kind == GroupCommandKind::home)
        return state_ != GroupStandby ? ErrorId::state_forbids : hand_.holds ? ErrorId::held_by_person : ErrorId::none;
    if (waits_for_person(command)) {
        const bool can_wait = kind != GroupCommandKind::jog && kind != GroupCommandKind::driven_path;
        return can_wait ? ErrorId::none : ErrorId::held_by_person;
    }
    if ((jogs() || is_driven()) && has_place_in_queue(kind) && waits(command)) return ErrorId::state_forbids;  // G-090
    // For a program that asks while a person holds it, it is the first one.
    const bool interrupts = hand_.holds ? hand_.program_interrupts : interrupted_ || interrupting_ != 0;
    if (kind == GroupCommandKind::interrupt) return interrupts ? ErrorId::state_forbids : ErrorId::none;
    if (kind == GroupCommandKind::resume)
        return !interrupted_ ? ErrorId::nothing_interrupted : hand_.holds ? ErrorId::held_by_person : ErrorId::none;
    return interrupting_ != 0 && !waits(command) ? ErrorId::state_forbids : ErrorId::none;
}

ErrorId AxisGroup::refuse_way(const GroupCommand& command) const noexcept {
    if (command.kind == GroupCommandKind::path) return refuse_stored(command);
    if (command.kind == GroupCommandKind::driven_path) return refuse_driven(command);
    if (command.orientation != mcLinear) return ErrorId::not_supported;
    if (is_circular(command.kind) && (command.circle.mode > mcRADIUS || !(command.circle.tolerance >= 0)))
        return ErrorId::invalid_parameter;
    if (const auto error = refuse_transition(command); error != ErrorId::none) return error;
    if (const auto error = refuse_frame(command, config_.kinematics.get(), members_); error != ErrorId::none) return error;
    // Relative to what: a command that waits, or brakes another one first, is checked where it begins. What only the whole way shows the planner
    // says before it starts.
    const bool known = !is_relative(command.kind) || (!waits(command) && run_.over());
    if (!known) return ErrorId::none;
    const auto at = here();
    if (const auto error = refuse_target(command, target_of(command, at, members_), members_); error != ErrorId::none) return error;
    return refuse_reach(command, place_of(command), at, config_.kinematics.get());
}

/// The stored path itself was looked through when it was selected; what only its places show, the planner says where it comes to them.
ErrorId AxisGroup::refuse_stored(const GroupCommand& command) const noexcept {
    if (command.transition != mcTMNone || command.frame == mcACS) return ErrorId::not_supported;
    if (const auto error = refuse_frame(command, config_.kinematics.get(), members_); error != ErrorId::none) return error;
    if (!command.path.valid()) return ErrorId::path_not_selected;
    const auto* state = paths_ != nullptr ? paths_->state(command.path) : nullptr;
    if (state == nullptr) return ErrorId::invalid_parameter;
    if (state->kind != PathState::Kind::ready || state->ticket != command.ticket) return ErrorId::path_not_selected;
    return refuse_target(command, here(), members_);
}

ErrorId AxisGroup::refuse(const GroupCommand& command, Owner owner) const noexcept {
    if (command.kind == GroupCommandKind::none || command.kind > GroupCommandKind::set_position_relative) return ErrorId::invalid_parameter;
    if (members_.owned_by_other(owner)) return ErrorId::owned_by_other;
    if (is_administrative(command.kind) && !is_setting(command.kind)) return ErrorId::none;  // set_position() says it
    if (is_setting(command.kind)) {
        if (const auto error = refuse_equipment(command); error != ErrorId::none) return error;
        if (const auto error = refuse_track(command); error != ErrorId::none) return error;
        if (command.execution == mcImmediately) return ErrorId::none;
        // No motion of the group ends there, so nothing would ever be behind it.
        if (state_ == GroupState::GroupStopping || state_ == GroupState::GroupHoming || is_driven()) return ErrorId::state_forbids;
        return queue_.full() ? ErrorId::queue_full : ErrorId::none;
    }
    if (const auto error = refuse_state(command); error != ErrorId::none) return error;
    if (const auto error = check_dynamics(command.dynamics); error != ErrorId::none) return error;
    if (command.buffer_mode > mcBlendingHigh) return ErrorId::buffer_mode_not_supported;
    if (command.kind == GroupCommandKind::wait && command.duration < Duration{}) return ErrorId::invalid_parameter;
    if (command.kind == GroupCommandKind::home) {
        if (command.buffer_mode > mcBuffered) return ErrorId::buffer_mode_not_supported;
        return command.frame == mcACS ? ErrorId::none : ErrorId::not_supported;
    }
    if (command.kind == GroupCommandKind::jog) {
        if (const auto track = refuse_track(command); track != ErrorId::none) return track;
        const auto error = refuse_frame(command, config_.kinematics.get(), members_);
        return error != ErrorId::none ? error : GroupJog::refuse(command, {command.frame, jogging_of(command), members_, equipment_.arm});
    }
    if (goes_a_way(command.kind))
        if (const auto error = refuse_track(command); error != ErrorId::none) return error;
    if (goes_a_way(command.kind))
        if (const auto error = refuse_way(command); error != ErrorId::none) return error;
    return has_place_in_queue(command.kind) && waits(command) && queue_.full() ? ErrorId::queue_full : ErrorId::none;
}

Submitted AxisGroup::submit(const GroupCommand& wanted, Owner owner) noexcept {
    const auto answer = take(wanted, owner);
    if (answer.error != ErrorId::none)
        refused({0, owner, wanted, {}},
                {.error = answer.error,
                 .at = hindrance_of(answer.error, wanted, place_of(wanted), here(), config_.kinematics.get(), members_)});
    return answer;
}

Submitted AxisGroup::take(const GroupCommand& wanted, Owner owner) noexcept {
    GroupCommand command = wanted;
    if (const auto error = in_units(command.dynamics, view_.reference_dynamics); error != ErrorId::none) return {0, error};
    if (const auto error = refuse(command, owner); error != ErrorId::none) return {0, error};
    Submitted answer;
    switch (command.kind) {
        case GroupCommandKind::stop: answer.id = take_stop(command, owner); break;
        case GroupCommandKind::interrupt: answer.id = take_interrupt(command); break;
        case GroupCommandKind::resume: answer = take_resume(command, owner); break;
        case GroupCommandKind::home: answer.id = take_home(command, owner); break;
        case GroupCommandKind::disable: answer.id = take_disable(); break;
        case GroupCommandKind::set_frame:
        case GroupCommandKind::write_tool:
        case GroupCommandKind::track_frame: answer = take_setting(command, owner); break;
        case GroupCommandKind::set_position:
        case GroupCommandKind::set_position_relative:
            answer.error = set_position(command, owner);
            if (answer.error == ErrorId::none) queue_.record(answer.id = queue_.next_id(), Outcome::done);
            break;
        default: answer = take_motion(command, owner); break;
    }
    publish();
    if (is_administrative(command.kind) && !is_setting(command.kind)) show_tool();  // who reads it in this scan sees what was set
    return answer;
}

Submitted AxisGroup::take_motion(const GroupCommand& command, Owner owner) noexcept {
    const auto place = place_of(command);
    if (waits(command)) {
        const auto id = queue_.next_id();
        queue_.push({id, owner, command, place});
        return {id, ErrorId::none};
    }
    if (waits_for_person(command)) {
        const bool stands = interrupted_;
        const auto brakes_for = std::exchange(interrupting_, CommandId{0});  // goes on doing so
        abort_all();
        interrupted_ = stands;
        interrupting_ = brakes_for;
        const auto id = queue_.next_id();
        if (command.kind != GroupCommandKind::halt) {
            queue_.push({id, owner, command, place});
        } else if (stands) {
            queue_.record(id, Outcome::done);
        } else {  // done where it rests
            interrupting_ = id;
            run_.stop(command.dynamics, factors());
        }
        return {id, ErrorId::none};
    }
    const bool stands = !members_.led();
    if (stands && command.kind == GroupCommandKind::halt) {
        abort_all();
        const auto id = queue_.next_id();
        queue_.record(id, Outcome::done);
        return {id, ErrorId::none};
    }
    if (stands)
        if (const auto error = members_.join(command.instance, owner); error != ErrorId::none) return {0, error};
    abort_all();
    if (stands) {
        run_.clear();
        hold_ = members_.set_positions();
    } else {
        const bool jog = command.kind == GroupCommandKind::jog;
        const auto jogging = jogging_of(command).path;
        run_.stop(jog ? PathDynamics{0, 0, jogging.deceleration, jogging.jerk} : command.dynamics, factors());
    }
    if (command.kind == GroupCommandKind::jog) jog_.press(command, jog_lease_of(members_), jogging_of(command));
    view_.jog_end = JogEnd::none;
    if (goes_a_way(command.kind)) view_.refusal = {.number = view_.refusal.number};
    const auto id = queue_.next_id();
    queue_.activate({id, owner, command, place});
    fire(GroupEvent::motion);
    return {id, ErrorId::none};
}

CommandId AxisGroup::take_stop(const GroupCommand& command, Owner owner) noexcept {
    abort_all();
    lock_ = queue_.next_id();
    queue_.activate({lock_, owner, command, {}});
    begun_ = true;
    fire(GroupEvent::stop);
    if (members_.led()) run_.stop(command.dynamics, Override{});
    tracking_.release();  // G-087: it ends in space
    return lock_;
}

CommandId AxisGroup::take_interrupt(const GroupCommand& command) noexcept {
    hand_.program_interrupts = true;
    if (!interrupted_) return interrupt(command.dynamics);
    const auto id = queue_.next_id();
    queue_.record(id, Outcome::done);  // a person has brought it to rest
    return id;
}

CommandId AxisGroup::interrupt(const PathDynamics& dynamics) noexcept {
    const auto id = queue_.next_id();
    if (interrupting_ != 0) queue_.record(interrupting_, Outcome::aborted);  // for another one that brakes on
    if (jogs()) {                                                            // nobody goes on with a jog but by pressing again
        queue_.finish_active(Outcome::aborted);
        begun_ = false;
    }
    if (members_.led()) {
        interrupting_ = id;
        run_.stop(dynamics, Override{});
    } else {
        interrupted_ = true;
        queue_.record(id, Outcome::done);
    }
    return id;
}

Submitted AxisGroup::take_resume(const GroupCommand& command, Owner owner) noexcept {
    const bool on_way = queue_.has_active() && begun_ && goes_a_way(queue_.active().command.kind);
    const bool follows = members_.led();  // it is interrupted on a frame that moves
    if (on_way && !follows)
        for (std::size_t i = 0; i < most_members; ++i) {
            if (!members_.has(i)) continue;
            const double place = run_.of(i).position;
            if (std::abs(members_.axis(i).view().set_position - place) > 1e-9 * std::max(1.0, std::abs(place)))
                return {0, ErrorId::not_at_interruption};
        }
    if (on_way && !run_.fits(members_)) return {0, ErrorId::path_not_planned};
    if (queue_.has_active() || queue_.waiting() > 0) {
        if (!follows)
            if (const auto error = members_.join(command.instance, owner); error != ErrorId::none) return {0, error};
        if (on_way) {
            run_.resume(factors());
        } else {
            run_.clear();
            hold_ = members_.set_positions();
        }
        fire(GroupEvent::motion);
    }
    interrupted_ = hand_.program_interrupts = false;
    const auto id = queue_.next_id();
    queue_.record(id, Outcome::done);
    return {id, ErrorId::none};
}

CommandId AxisGroup::take_home(const GroupCommand& command, Owner owner) noexcept {
    abort_all();
    run_.clear();
    const auto id = queue_.next_id();
    queue_.activate({id, owner, command});
    begun_ = true;
    elapsed_ = {};
    homing_.begin(command, owner);
    fire(GroupEvent::home);
    return id;
}

CommandId AxisGroup::take_disable() noexcept {
    hand_.holds = false;
    abort_all();
    lock_ = 0;
    const auto id = queue_.next_id();
    const bool searches = state_ == GroupState::GroupHoming && homing_.moves(members_);
    if (members_.led() || searches) {
        disabling_ = id;
        run_.stop({}, Override{});
        tracking_.release();
    } else {
        fire(GroupEvent::disable);
        queue_.record(id, Outcome::done);
    }
    return id;
}

ErrorId AxisGroup::hold() noexcept {
    const bool interrupts = !hand_.holds && hand_.program_interrupts;  // it stands for its program, or brakes for it
    if (!interrupts) {
        if (hand_.holds && (interrupted_ || interrupting_ != 0)) return ErrorId::state_forbids;
        if (const auto error = refuse_state({.kind = GroupCommandKind::interrupt}); error != ErrorId::none) return error;
        (void)interrupt({});
    } else if (interrupting_ != 0) {
        run_.stop({}, Override{});  // a program may come to rest as softly as it likes; who interrupts the machine does not wait for that
    }
    hand_.holds = true;
    publish();
    return ErrorId::none;
}

ErrorId AxisGroup::release_hold() noexcept {
    if (!hand_.holds) return ErrorId::nothing_interrupted;
    if (state_ == GroupState::GroupErrorStop) return ErrorId::in_error_stop;
    if (!hand_.program_interrupts) {
        if (interrupting_ != 0) return ErrorId::state_forbids;  // nobody would go on with it where it comes to rest
        const auto next = queue_.has_active() ? queue_.active() : queue_.waiting() > 0 ? queue_.waiting_at(0) : AcceptedGroupCommand{};
        if (interrupted_)
            if (const auto error = take_resume(next.command, next.owner).error; error != ErrorId::none) return error;
    }
    hand_.holds = false;
    publish();
    return ErrorId::none;
}

void AxisGroup::halt() noexcept {
    hand_.holds = false;
    ++view_.stops_by_hand;
    come_to_rest();
    publish();
}

void AxisGroup::come_to_rest() noexcept {
    if (interrupted_ && !members_.led() && state_ == GroupState::GroupStandby) {  // whoever stops it does not want it to go on
        abort_all();
        interrupted_ = hand_.holds;
        return publish();
    }
    if (!members_.led() || (state_ != GroupState::GroupMoving && state_ != GroupState::GroupStopping)) return;
    const auto owner = queue_.active().owner;
    if (interrupting_ != 0 || interrupted_) abort_all();  // it brakes already, or stands on a frame, and nobody goes on
    const bool stops =
        state_ == GroupState::GroupStopping || disabling_ != 0 || going_off_ != 0 || queue_.active().command.kind == GroupCommandKind::halt;
    // A program may stop as softly as it likes; who stops the machine does not wait for that.
    if (stops) return run_.stop({}, Override{});
    GroupCommand command;
    command.kind = GroupCommandKind::halt;
    (void)take_motion(command, owner);
    publish();
}

void AxisGroup::let_go() noexcept {
    lock_ = 0;
    if (members_.led()) {
        // What stops it already goes on doing so; what waits behind that, or for a continue, is nobody's any more.
        if (interrupting_ != 0) abort_all();
        come_to_rest();
        queue_.finish_waiting(Outcome::aborted);
        tracking_.release();
    } else {
        abort_all();
        if (state_ == GroupState::GroupStopping) fire(GroupEvent::stopped);
        if (state_ == GroupState::GroupHoming) fire(GroupEvent::done);
        interrupted_ = hand_.holds && state_ == GroupState::GroupStandby;
    }
    publish();
}

void AxisGroup::shut_down(AxisRef axis) noexcept {
    if (!members_.led()) return;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members_.refs()[i] == axis) going_off_ = static_cast<std::uint16_t>(going_off_ | 1u << i);
    if (state_ != GroupState::GroupErrorStop) {
        abort_all();
        lock_ = 0;
        run_.stop({}, Override{});
        tracking_.release();
    }
    publish();
}

void AxisGroup::release_stop(CommandId id) noexcept {
    if (id != 0 && id == lock_) lock_ = 0;
    view_.lock = lock_;
}

JoggingDynamics AxisGroup::jogging_of(const GroupCommand& command) const noexcept {
    return command.jog.hand == JogHand::person ? dynamics_by_hand(members_, setup_velocity_of(config_)) : view_.jogging_dynamics;
}

// --- jogging --------------------------------------------------------------------------------------------------------------------

bool AxisGroup::turn_jog() noexcept {
    if (jog_.released()) {
        run_.clear();
        hold_ = members_.set_positions();
        queue_.finish_active(jog_.expired() ? Outcome::aborted : Outcome::done);
        return false;
    }
    if (run_.exists() && !jog_.stops()) return true;  // the planner has it
    run_.clear();
    hold_ = members_.set_positions();
    auto next = queue_.active();
    jog_.turn(next.command.target, hold_);
    queue_.activate(next);
    return true;
}

void AxisGroup::tend_jog(Duration period) noexcept {
    if (!jogs()) return;
    jog_.pass(period);
    if (!run_.exists() || run_.stops()) return;
    const auto now = jog_.factors(factors());
    if (begun_ && jog_.stops()) run_.release(now);
    else run_.override_with(now);
}

ErrorId AxisGroup::set_jog(const GroupSetting& setting) noexcept {
    if (const auto* held = std::get_if<HoldJog>(&setting)) {
        if (!jogs() || held->id != queue_.active().id) return ErrorId::unknown_command;
        const auto error = GroupJog::refuse(*held, {queue_.active().command.frame, jog_.dynamics(), members_, equipment_.arm});
        // What cannot be gone is no reason to go on with what was held before.
        jog_.hold(error == ErrorId::none ? *held : HoldJog{.id = held->id});
        return error;
    }
    return write_jogging(std::get<WriteJoggingDynamics>(setting).dynamics, view_.jogging_dynamics);
}

ErrorId AxisGroup::set_limits(const WriteSoftwareLimits& limits, Owner owner) noexcept {
    // A way under way was looked at with the limits before.
    if (members_.led() || state_ == GroupState::GroupHoming || state_ == GroupState::GroupStopping) return ErrorId::state_forbids;
    return write_limits(limits, members_, owner);
}

// --- settings -------------------------------------------------------------------------------------------------------------------

ErrorId AxisGroup::change_members(const GroupSetting& setting) noexcept {
    if (const auto* added = std::get_if<AddMember>(&setting))
        return state_ == GroupState::GroupDisabled ? members_.add(added->axis, added->ident) : ErrorId::state_forbids;
    if (const auto* removed = std::get_if<RemoveMember>(&setting))
        return state_ == GroupState::GroupDisabled ? members_.remove(removed->ident) : ErrorId::state_forbids;
    if (members_.led() || state_ == GroupState::GroupStopping || state_ == GroupState::GroupHoming) return ErrorId::state_forbids;
    if (hand_.holds) return ErrorId::held_by_person;
    abort_all();
    run_.clear();
    members_.remove_all();
    view_.error = 0;
    view_.error_place = most_members;
    fire(GroupEvent::disable);
    return ErrorId::none;
}

ErrorId AxisGroup::enable() noexcept {
    if (members_.count() == 0) return ErrorId::no_members;
    if (state_ == GroupState::GroupErrorStop) return ErrorId::in_error_stop;
    const auto event = view_.error != 0 && state_ == GroupState::GroupDisabled ? GroupEvent::enable_failed : GroupEvent::enable;
    if (!next_state(state_, event)) return ErrorId::state_forbids;
    fire(event);
    return event == GroupEvent::enable ? ErrorId::none : ErrorId::in_error_stop;
}

ErrorId AxisGroup::set(const GroupSetting& setting, Owner owner) noexcept {
    if (members_.owned_by_other(owner)) return ErrorId::owned_by_other;
    auto error = ErrorId::none;
    if (std::holds_alternative<EnableGroup>(setting)) {
        error = enable();
    } else if (const auto* factors = std::get_if<Override>(&setting)) {
        if (!usable(*factors)) return ErrorId::invalid_override;
        view_.override_factors = *factors;
        run_.override_with(this->factors());
    } else if (const auto* written = std::get_if<WriteDynamics>(&setting)) {
        if (error = check_dynamics(written->dynamics); error != ErrorId::none) return error;
        auto& kept = written->which == WriteDynamics::Which::default_dynamics ? view_.default_dynamics : view_.reference_dynamics.of;
        const auto put = [](double& to, double value) {
            if (value > 0) to = value;
        };
        put(kept.velocity, written->dynamics.velocity);
        put(kept.acceleration, written->dynamics.acceleration);
        put(kept.deceleration, written->dynamics.deceleration);
        put(kept.jerk, written->dynamics.jerk);
    } else if (const auto* limits = std::get_if<WriteSoftwareLimits>(&setting)) {
        error = set_limits(*limits, owner);
    } else if (const auto* wanted = std::get_if<FollowPath>(&setting)) {
        error = state_ == GroupState::GroupDisabled ? ErrorId::group_disabled
                : driven_by(wanted->slave)          ? ErrorId::coupling_loop
                                                    : slaves_.take(*wanted, members_, owner);
    } else if (const auto* mode = std::get_if<SetDynamicsMode>(&setting)) {
        view_.reference_dynamics.percent = mode->percent;
    } else if (std::holds_alternative<HoldJog>(setting) || std::holds_alternative<WriteJoggingDynamics>(setting)) {
        error = set_jog(setting);
    } else if (setting.index() >= GroupSetting{SelectTool{}}.index()) {
        error = equip(setting);
    } else {
        error = change_members(setting);
    }
    publish();
    return error;
}

ErrorId AxisGroup::reset(Owner owner) noexcept {
    if (state_ != GroupState::GroupErrorStop) return ErrorId::none;
    view_.reset_error = ErrorId::none;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members_.has(i) || members_.axis(i).view().state != AxisState::ErrorStop) continue;
        if (const auto error = members_.axis(i).reset(owner); error != ErrorId::none) {
            view_.resetting = false;
            return view_.reset_error = error;
        }
    }
    view_.resetting = true;
    return ErrorId::none;
}

}  // namespace taktwerk::axes

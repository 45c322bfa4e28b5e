// The order of a cycle, and what leads from one state to the next. What others ask for: group_requests.cpp.

#include "axes/group/axis_group.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "axes/group/motion_target.hpp"
#include "axes/group/tool_view.hpp"

namespace taktwerk::axes {

namespace {

constexpr double unlimited_velocity = std::numeric_limits<double>::infinity();

PathDynamics resolved(const PathDynamics& wanted, const PathDynamics& fallback) noexcept {
    const auto pick = [](double value, double other) { return value > 0 ? value : other; };
    return {pick(wanted.velocity, fallback.velocity), pick(wanted.acceleration, fallback.acceleration),
            pick(wanted.deceleration, fallback.deceleration), pick(wanted.jerk, fallback.jerk)};
}

}  // namespace

std::string_view name(GroupState state) noexcept {
    constexpr std::array<std::string_view, group_state_count> names{"GroupDisabled", "GroupStandby",  "GroupHoming",
                                                                    "GroupMoving",   "GroupStopping", "GroupErrorStop"};
    return names[static_cast<std::size_t>(state)];
}

AxisGroup::AxisGroup(AxisGroupConfig config, std::span<Axis> axes, std::span<const AxisRef> members, Duration cycle, const PathShelf* paths)
    : config_(std::move(config)),
      paths_(paths),
      members_(axes),
      run_(axes, config_, cycle, paths),
      tracking_(axes, config_.kinematics, config_.workspace),
      slaves_(axes),
      deviation_(config_.following) {
    for (std::size_t i = 0; i < members.size(); ++i) (void)members_.add(members[i], static_cast<std::uint8_t>(i + 1));
    view_.default_dynamics = config_.default_dynamics;
    equipment_ = config_.equipment;
    equipment_.arm = facts_of(config_.kinematics.get());
    publish();
}

void AxisGroup::fire(GroupEvent event) noexcept {
    if (const auto to = next_state(state_, event)) state_ = *to;
    // Whatever has ended its commands: what a person holds nobody else lets go.
    if (hand_.holds && state_ == GroupState::GroupStandby) interrupted_ = true;
}

void AxisGroup::abort_all() noexcept {
    if (state_ == GroupState::GroupHoming) homing_.stop(members_);
    queue_.finish_active(Outcome::aborted);
    queue_.finish_waiting(Outcome::aborted);
    if (interrupting_ != 0) queue_.record(interrupting_, Outcome::aborted);
    if (interrupted_ && !members_.led()) run_.clear();  // nobody goes on with it
    forget_path();
    interrupting_ = 0;
    interrupted_ = hand_.program_interrupts = begun_ = false;
}

void AxisGroup::leave(GroupEvent event) noexcept {
    members_.leave();
    tracking_.clear();
    if (!interrupted_) run_.clear();
    fire(event);
}

void AxisGroup::fail(std::uint16_t error, std::uint8_t place) noexcept {
    if (!next_state(state_, GroupEvent::error) || state_ == GroupState::GroupErrorStop) return;
    view_.error = error;
    view_.error_place = place;
    view_.reset_error = ErrorId::none;
    if (state_ == GroupState::GroupHoming) homing_.stop(members_);
    fire(GroupEvent::error);
    queue_.finish_active(Outcome::error, static_cast<ErrorId>(error));
    queue_.finish_waiting(Outcome::error, ErrorId::aborted_by_axis_error);
    if (interrupting_ != 0) queue_.record(interrupting_, Outcome::error, ErrorId::aborted_by_axis_error);
    if (interrupted_ && !members_.led()) run_.clear();
    forget_path();
    interrupting_ = lock_ = 0;
    interrupted_ = hand_.program_interrupts = begun_ = false;
    run_.stop({}, Override{});
    tracking_.release();
}

// --- the cycle ------------------------------------------------------------------------------------------------------------------

void AxisGroup::update(Instant) noexcept {
    const auto loss = members_.lost();
    if (state_ != GroupState::GroupDisabled && state_ != GroupState::GroupErrorStop) {
        const auto failed = loss.error != 0 ? loss : members_.error_of_any();
        if (failed.error != 0) fail(failed.error, failed.place);
        else if (loss.any) fail(static_cast<std::uint16_t>(ErrorId::member_left), loss.place);
    }
    // All at once (an emergency stop, a lost bus): nobody is left whom it could bring to rest, and what it was about must not be there when they come back.
    if (loss.any && !members_.led()) {
        tracking_.clear();
        run_.clear();
    }
    if (view_.resetting) watch_reset();
    take_operators_override();
    publish();
}

Override AxisGroup::factors() const noexcept {
    auto factors = view_.override_factors;
    factors.velocity *= view_.operators_override;
    return factors;
}

/// Whoever slows one of its axes down slows the path down: else that axis would leave it, or nothing would happen at all.
void AxisGroup::take_operators_override() noexcept {
    double least = hand_.override_factor;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members_.has(i)) least = std::min(least, members_.axis(i).view().operators_override);
    if (least == view_.operators_override) return;
    view_.operators_override = least;
    run_.override_with(factors());
}

ErrorId AxisGroup::set_operators_override(double factor) noexcept {
    if (!(factor >= 0 && factor <= 1)) return ErrorId::invalid_override;
    hand_.override_factor = factor;
    take_operators_override();
    return ErrorId::none;
}

void AxisGroup::set_mode(OperatingMode mode) noexcept {
    const bool setup = mode == OperatingMode::setup;
    if (setup == hand_.setup) return;
    hand_.setup = setup;
    run_.keep_tool_below(setup && config_.kinematics ? setup_velocity_of(config_) : unlimited_velocity);
    if (setup) come_to_rest();
    publish();
}

void AxisGroup::watch_reset() noexcept {
    if (state_ != GroupState::GroupErrorStop) {
        view_.resetting = false;
        return;
    }
    if (members_.led()) return;
    auto failed = ErrorId::none;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members_.has(i)) continue;
        const auto& axis = members_.axis(i).view();
        if (axis.resetting) return;
        if (axis.state == AxisState::ErrorStop && failed == ErrorId::none)
            failed = axis.reset_error != ErrorId::none ? axis.reset_error : ErrorId::reset_failed;
    }
    view_.resetting = false;
    view_.reset_error = failed;
    if (failed != ErrorId::none) return;
    view_.error = 0;
    view_.error_place = most_members;
    fire(GroupEvent::reset);
}

void AxisGroup::plan(Instant now, Duration period) noexcept {
    tracking_.watch(equipment_.frames, now, period);
    run_.watch(now, period);
    if (state_ == GroupState::GroupHoming && disabling_ == 0) go_on_homing();
    const bool searched = state_ == GroupState::GroupStopping || state_ == GroupState::GroupHoming;
    const bool member_stops = searched && homing_.moves(members_);
    if (!member_stops && (members_.led() || state_ == GroupState::GroupStopping || disabling_ != 0 || going_off_ != 0)) {
        if ((run_.over() && (tracking_.rests() || tracking_.follows())) || !members_.led()) settle();
        if (members_.led()) {
            send_waiting();
            go_on(period);
        }
    }
    slaves_.step(run_.serial(), run_.along(), period);
    publish();
    show_tool();
    if (!deviation_.beyond(view_.path_deviation, period)) return;
    fail(static_cast<std::uint16_t>(ErrorId::path_following_error));
    publish();
}

void AxisGroup::show_tool() noexcept {
    const auto& tool = moves_with_tool() ? run_.carried().tool : equipment_.tool_pose();
    if (config_.kinematics) see_tool(view_, config_.kinematics.get(), tool);
    view_.path_deviation = members_.led() ? axes::path_deviation(view_, members_, config_.kinematics.get(), tool) : 0;
    see_tool_limit();
}

/// Who holds the path back: known once the tool's speed is.
void AxisGroup::see_tool_limit() noexcept {
    constexpr double in_use = 0.98;  // as of the axes' limits (path_run.cpp)
    const bool moves = view_.limiter == PathLimiter::command || view_.limiter == PathLimiter::axis;
    if (view_.tool_limit == 0 || !view_.tool_known || !moves) return;
    const auto& v = view_.tool_velocity;
    if (std::hypot(v[0], v[1], v[2]) >= in_use * view_.tool_limit) view_.limiter = PathLimiter::setup_velocity;
}

void AxisGroup::go_on_homing() noexcept {
    const auto answer = homing_.step(members_);
    if (!answer.over) return;
    queue_.finish_active(answer.outcome, answer.error);
    begun_ = false;
    fire(GroupEvent::done);
}

/// The group stands: what comes next.
void AxisGroup::settle() noexcept {
    if (disabling_ != 0) {
        leave(GroupEvent::disable);
        queue_.record(disabling_, Outcome::done);
        disabling_ = 0;
        return;
    }
    if (going_off_ != 0) {
        const auto off = std::exchange(going_off_, std::uint16_t{0});
        leave(state_ == GroupState::GroupStopping ? GroupEvent::stopped : GroupEvent::done);
        for (std::size_t i = 0; i < most_members; ++i)
            if ((off >> i & 1u) != 0 && members_.has(i)) members_.axis(i).shut_down();
        return;
    }
    if (state_ == GroupState::GroupErrorStop) return leave(GroupEvent::error);
    if (state_ == GroupState::GroupStopping) {
        queue_.finish_active(Outcome::done);
        if (lock_ == 0) leave(GroupEvent::stopped);
        return;
    }
    if (interrupting_ != 0) {
        queue_.record(interrupting_, Outcome::done);
        interrupting_ = 0;
        interrupted_ = true;
        return tracking_.engaged() ? void() : leave(GroupEvent::done);  // G-087
    }
    if (interrupted_) return;
    for (;;) {
        if (!queue_.has_active()) {
            if (queue_.waiting() == 0) return tracking_.engaged() ? void() : leave(GroupEvent::done);  // G-019
            queue_.activate_next();
            begun_ = false;
        }
        if (begun_ && jogs()) {  // at rest, and perhaps for another direction
            begun_ = false;
            jog_.went(run_.along().position);
            run_.clear();
        }
        if (begun_ || begin_active()) return;
    }
}

std::optional<ErrorId> AxisGroup::begin_way(const AcceptedGroupCommand& active) noexcept {
    const auto& command = active.command;
    if (!run_.exists()) {
        auto over_with = ErrorId::none;
        if (!change_frame(active.place.track, over_with)) return std::nullopt;
        if (over_with != ErrorId::none) return over_with;
        hold_ = members_.set_positions();
        const bool way = command.kind != GroupCommandKind::jog;
        if (way)
            if (const auto error = refuse_target(command, target_of(command, hold_, members_), members_); error != ErrorId::none) {
                refused(active,
                        {.error = error, .at = hindrance_of(error, command, active.place, hold_, config_.kinematics.get(), members_)});
                return error;
            }
        if (way && goes_nowhere(command, hold_, members_)) return ErrorId::none;
        const bool moving = tracking_.active();
        const auto caps = moving ? tracking_.path_caps(members_) : JoggingDynamics{};
        if (!(way ? run_.restart(members_, factors(), moving ? &caps : nullptr, moving ? &still_ : nullptr)
                  : run_.restart(members_, jog_.factors(factors()), &jog_.dynamics())))
            return std::nullopt;
        sent_ = 0;
    }
    send_waiting();
    if (const auto said = run_.verdict(active.id)) {
        if (goes_stored_path(command.kind) && said->line != 0) view_.path.place = *said;
        if (command.kind == GroupCommandKind::jog) {
            view_.jog_end = run_.jog_end(active.id);
            view_.jog_hindrance = said->at;
        }
        if (said->error != ErrorId::none) refused(active, *said);
        if (said->error != ErrorId::none || !tracking_.active()) return said->error;
        tracking_.engage();  // no way to go on the object, but one to it
        return tracking_.in_sync() ? std::optional(said->error) : std::nullopt;
    }
    if (command.kind == GroupCommandKind::path) {  // it may begin with something else than motion
        begun_ = sent_ >= active.id;
        if (begun_) forget_path();
        if (begun_) view_.path = {.path = command.path, .request_id = view_.path.request_id};
        return std::nullopt;
    }
    begun_ = run_.begin(active.id);
    if (begun_ && command.kind == GroupCommandKind::driven_path) view_.path = {.path = command.path, .request_id = view_.path.request_id};
    if (begun_) tracking_.engage();
    if (begun_) view_.commanded = run_.end();
    return std::nullopt;
}

/// What is active or waits goes to the planner in its order. A wait, or an interruption, is no place to be passed.
void AxisGroup::send_waiting() noexcept {
    if (!run_.exists() || run_.stops()) return;
    const auto send = [this](const AcceptedGroupCommand& accepted, const AcceptedGroupCommand* before) {
        const auto& command = accepted.command;
        if (is_setting(command.kind) || accepted.id <= sent_ || !goes_a_way(command.kind)) return true;
        if (accepted.place.track != (tracking_.active() ? tracking_.track() : FrameTrack{})) return false;  // another frame: from rest
        auto place = accepted.place;
        if (place.track.moves()) place.frame = tracking_.planned_frame();
        const bool stored = goes_stored_path(command.kind) || (before != nullptr && goes_stored_path(before->command.kind));
        const bool joins = before != nullptr && goes_a_way(before->command.kind) && command.buffer_mode >= mcBlendingLow && !stored;
        const bool sent = command.kind == GroupCommandKind::jog
                              ? run_.send(accepted.id, command, place, jog_.dynamics().path, false, &jog_.pressed_at(), jog_.way())
                              : run_.send(accepted.id, command, place, resolved(command.dynamics, view_.default_dynamics), joins);
        if (!sent) return false;
        sent_ = accepted.id;
        return true;
    };
    const auto* before = queue_.has_active() ? &queue_.active() : nullptr;
    if (before != nullptr && !send(*before, nullptr)) return;
    for (std::size_t i = 0; i < queue_.waiting(); ++i) {
        const auto& next = queue_.waiting_at(i);
        if (!send(next, before)) return;
        if (!is_setting(next.command.kind)) before = &next;  // nothing to stand still for
    }
}

/// A person has his answer. What falls in the same cycle behind another one falls with it: that one is told.
void AxisGroup::refused(const AcceptedGroupCommand& accepted, const PathPlace& why) noexcept {
    if (accepted.owner != Owner::program) return;
    const auto last = view_.status(view_.refusal.id);
    const bool falls_with_it =
        accepted.id != 0 && (last == CommandStatus::active || last == CommandStatus::queued);  // over, and not published yet
    if (falls_with_it) {
        ++view_.refusal.number;
        return;
    }
    const auto& command = accepted.command;
    view_.refusal = {view_.refusal.number + 1, command.kind, accepted.id, command.instance, why};
}

bool AxisGroup::begin_active() noexcept {
    const auto& active = queue_.active();
    if (!goes_a_way(active.command.kind)) {
        begun_ = true;
        elapsed_ = {};
        if (active.command.kind == GroupCommandKind::wait) return true;
        if (is_setting(active.command.kind)) return finish_setting(), false;
        queue_.finish_active(Outcome::done);
        return false;
    }
    const bool same = active.place.track == (tracking_.active() ? tracking_.track() : FrameTrack{});
    if (run_.stuck() != ErrorId::none || run_.stops() || !same) run_.clear();
    elapsed_ = {};
    if (jogs() && !turn_jog()) return false;
    const auto told = view_.refusal.number;
    const auto over_with = begin_way(active);
    if (!over_with) return true;
    if (*over_with != ErrorId::none && view_.refusal.number == told) refused(active, {.error = *over_with});
    // What was planned behind it begins where it would have ended.
    if (*over_with == ErrorId::path_not_planned) run_.clear();
    queue_.finish_active(*over_with == ErrorId::none ? Outcome::done : Outcome::error, *over_with);
    return false;
}

/// One period of the way, or of the wait.
void AxisGroup::go_on(Duration period) noexcept {
    run_.advance(period);
    if (!watch_driven()) return;
    tend_jog(period);
    if (tracking_.active()) go_with_frame(period);
    if (!members_.led()) return;
    const auto led = members_.lead([&](std::size_t place) { return state_of(place); });
    if (led.error != ErrorId::none || run_.fault() != ErrorId::none)
        return fail(static_cast<std::uint16_t>(led.error != ErrorId::none ? led.error : run_.fault()), led.place);
    if (!begun_ || !queue_.has_active()) return;
    if (queue_.active().command.kind == GroupCommandKind::path) return walk_path(period);
    // The set-point has gone over to the way of a later command (G-061).
    while (goes_a_way(queue_.active().command.kind) && run_.command() > queue_.active().id && queue_.waiting() > 0) {
        const auto passed = run_.verdict(queue_.active().id).value_or(PathPlace{});  // one that makes no way lies in no run
        if (passed.error != ErrorId::none) refused(queue_.active(), passed);
        queue_.finish_active(passed.error == ErrorId::none ? Outcome::done : Outcome::error, passed.error);
        queue_.activate_next();
        for (; is_setting(queue_.active().command.kind) && queue_.waiting() > 0; queue_.activate_next()) finish_setting();
        elapsed_ = {};
    }
    const auto& active = queue_.active();
    const bool way = goes_a_way(active.command.kind);
    if (way && run_.command() == active.id) view_.commanded = run_.end();
    const bool interrupts = interrupting_ != 0;
    if (!(interrupts && active.command.kind == GroupCommandKind::wait)) elapsed_ += period;
    if (way && run_.stuck() != ErrorId::none && run_.over() && !run_.arrived()) {
        refused(active, {.error = run_.stuck()});
        queue_.finish_active(Outcome::error, run_.stuck());
    }
    const bool done = active.command.kind == GroupCommandKind::wait
                          ? !interrupts && elapsed_ >= active.command.duration
                          : way && !jogs() && run_.arrived() && run_.command() == active.id && (!tracking_.active() || tracking_.in_sync());
    if (done) queue_.finish_active(Outcome::done);
}

JointVector AxisGroup::here() const noexcept {
    if (!members_.led()) return members_.set_positions();
    JointVector at = hold_;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members_.has(i)) at[i] = state_of(i).position;
    return at;
}

void AxisGroup::publish() noexcept {
    view_.state = state_;
    view_.interrupted = interrupted_;
    view_.held = hand_.holds;
    view_.program_interrupts = hand_.program_interrupts;
    view_.member_count = static_cast<std::uint8_t>(members_.count());
    view_.kinematics = has_all_joints(config_.kinematics.get(), members_);
    view_.members = members_.refs();
    const bool with_tool = moves_with_tool();
    equipment_.active_tool = with_tool ? run_.carried().tool_number : equipment_.selected_tool;
    equipment_.active_payload = with_tool ? run_.carried().payload_number : equipment_.selected_payload;
    view_.powered = view_.online = view_.in_position = view_.member_count > 0;
    const bool led = members_.led();
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members_.has(i)) {
            view_.set_position[i] = view_.set_velocity[i] = view_.set_acceleration[i] = view_.actual_position[i] =
                view_.actual_velocity[i] = view_.commanded[i] = 0;
            continue;
        }
        const auto& axis = members_.axis(i).view();
        const MotionState set = led ? state_of(i) : MotionState{axis.set_position, axis.set_velocity, axis.set_acceleration};
        view_.set_position[i] = set.position;
        view_.set_velocity[i] = set.velocity;
        view_.set_acceleration[i] = set.acceleration;
        view_.actual_position[i] = axis.actual_position;
        view_.actual_velocity[i] = axis.actual_velocity;
        view_.powered = view_.powered && axis.powered;
        view_.online = view_.online && axis.online;
        view_.in_position = view_.in_position && axis.in_position;
        if (!run_.exists() || tracking_.active()) view_.commanded[i] = set.position;
    }
    const auto& along = run_.along();
    view_.path_velocity = led ? along.velocity : 0;
    view_.path_acceleration = led ? along.acceleration : 0;
    view_.path_members = led ? run_.members_on_way() : std::uint16_t{0};
    view_.limiter = led ? run_.limiter() : PathLimiter::none;
    // The share of a jog's velocity is what was commanded; it reaches the path as an override does.
    if (view_.limiter == PathLimiter::override_factor && jogs() && factors().velocity >= 1) view_.limiter = PathLimiter::command;
    view_.limiting_place = run_.narrowest();
    view_.tool_limit = hand_.setup && config_.kinematics ? setup_velocity_of(config_) : 0;
    const bool on_way = begun_ && queue_.has_active() && goes_a_way(queue_.active().command.kind) && run_.exists();
    view_.elapsed = begun_ && queue_.has_active() ? elapsed_ : Duration{};
    view_.remaining_distance = on_way ? run_.remaining() : 0;
    view_.corner = on_way ? run_.corner() : CornerPassed::none;
    view_.remaining = on_way ? from_seconds(run_.remaining_time()) : Duration{};
    view_.progress = on_way && run_.length() > 0 ? 1 - run_.remaining() / run_.length() : 0;
    if (begun_ && queue_.active().command.kind == GroupCommandKind::wait) {
        const auto duration = queue_.active().command.duration;
        view_.remaining = std::max(Duration{}, duration - elapsed_);
        view_.progress = duration > Duration{} ? to_seconds(elapsed_) / to_seconds(duration) : 0;
    }
    view_.lock = lock_;
    view_.interrupting = interrupting_;
    view_.disabling = disabling_;
    see_selection();
    tracking_.publish(view_);
    view_.driver = run_.driver();
    members_.path_driven_by(driver());
    slaves_.publish(view_);
    queue_.publish(view_);
}

}  // namespace taktwerk::axes

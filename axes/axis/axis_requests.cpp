// What others ask of the axis: checked and answered in the same call.

#include <cmath>
#include <limits>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/plannable.hpp"

namespace taktwerk::axes {

namespace {

bool slow_line(const DriveCapabilities& drive) noexcept { return drive.setpoints == SetpointClass::low_dynamics; }

}  // namespace

bool AxisCore::may(Owner owner) noexcept {
    if (view_.owner == Owner::none) view_.owner = owner;  // nobody's axis goes to the first who asks
    return owner == view_.owner;
}

double AxisCore::velocity_cap() const noexcept {
    const auto& manual = config_.manual;
    const double slow = manual.slow > 0 ? manual.slow : 0.05 * config_.limits.velocity;
    const double fast = manual.fast > 0 ? manual.fast : 0.25 * config_.limits.velocity;
    switch (mode_) {
        case OperatingMode::automatic: return std::numeric_limits<double>::infinity();
        case OperatingMode::manual: return fast;
        case OperatingMode::setup: return manual.setup_velocity > 0 ? manual.setup_velocity : slow;
    }
    return slow;
}

bool AxisCore::permitted(double direction) const noexcept {
    if (direction > 0) return permit_positive_ && !positive_switch_;
    if (direction < 0) return permit_negative_ && !negative_switch_;
    return true;
}

/// MC_Power has been asked for it, and Status is still to come.
bool AxisCore::powers_up() const noexcept { return view_.state == AxisState::Disabled && power_wish_ && emergency_ == EmergencyStop::none; }

bool AxisCore::waits(const AxisCommand& command) const noexcept {
    if (command.buffer_mode == mcAborting) return false;
    return queue_.has_active() || queue_.waiting() > 0 || powers_up() || halts_alone() || view_.state == AxisState::Stopping;
}

/// What waits behind a homing is judged when its turn comes.
bool AxisCore::homes_before() const noexcept {
    if (view_.state == AxisState::Homing) return true;
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (const auto kind = queue_.waiting_at(i).command.kind; kind == CommandKind::home || kind == CommandKind::homing_step) return true;
    return false;
}

ErrorId AxisCore::refuse_state(const AxisCommand& command) const noexcept {
    if (view_.state == AxisState::Disabled && !(powers_up() && waits(command))) return ErrorId::not_powered;
    if (view_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (emergency_ != EmergencyStop::none) return ErrorId::interlocked;
    const bool stopping = view_.state == AxisState::Stopping;
    if (waits(command)) {
        const bool behind_stop = queue_.active().command.kind == CommandKind::stop || view_.lock != 0;
        if (stopping && (!behind_stop || off_when_stopped_)) return ErrorId::state_forbids;
        return queue_.waiting() < config_.queue_depth ? ErrorId::none : ErrorId::queue_full;
    }
    // A stop whose Execute has fallen may be followed by another; one that is held locks the axis.
    if (stopping && command.kind == CommandKind::stop)
        return view_.lock == 0 && !off_when_stopped_ ? ErrorId::none : ErrorId::state_forbids;
    if (uncouples(command.kind)) return ErrorId::none;  // has a word of its own (refuse_coupling)
    // MC_Home's own search is no step: only MC_Stop ends it early.
    if (command.kind == CommandKind::homing_step && view_.state == AxisState::Homing && !view_.homing_procedure)
        return ErrorId::state_forbids;
    return next_state(view_.state, event_of(command.kind)) ? ErrorId::none : ErrorId::state_forbids;
}

/// `program` as a target: inside the range of a modulo axis, inside the software limits.
ErrorId AxisCore::refuse_place(double program) const noexcept {
    if (config_.modulo > 0) return program >= 0 && program < config_.modulo ? ErrorId::none : ErrorId::invalid_position;
    const bool beyond = program > config_.limits.position_max || program < config_.limits.position_min;
    return software_limits_hold() && beyond ? ErrorId::beyond_software_limit : ErrorId::none;
}

ErrorId AxisCore::refuse_place(const AxisCommand& command) const noexcept {
    if (!std::holds_alternative<WholeTurns>(command.details)) return refuse_place(command.position);
    if (!(config_.modulo > 0)) return ErrorId::not_supported;
    return command.position >= 0 ? ErrorId::none : ErrorId::invalid_position;
}

ErrorId AxisCore::refuse_target(const AxisCommand& command, bool starts_now) const noexcept {
    // Coordinates of the total: what is superimposed is part of where the axis is.
    const auto& here = setpoint_.state();
    double way = 0;
    switch (command.kind) {
        case CommandKind::move_absolute:
        case CommandKind::move_continuous_absolute:
            if (config_.require_homed && !view_.homed && (starts_now || !homes_before())) return ErrorId::not_homed;
            if (const auto error = refuse_place(command); error != ErrorId::none) return error;
            way = repetition_of(command, here, heads_backwards()) - here.position;
            break;
        case CommandKind::move_relative:
        case CommandKind::move_continuous_relative:
        case CommandKind::move_additive: {
            if (!starts_now) return ErrorId::none;  // it is checked where it begins
            const bool adds = command.kind == CommandKind::move_additive && has_commanded_target_;
            const double from = adds ? commanded_target_ + setpoint_.superimposed().position : here.position;
            way = from + command.position - here.position;
            if (config_.modulo > 0) break;
            if (const auto error = refuse_place(units_.to_program(from) + command.position); error != ErrorId::none) return error;
            break;
        }
        case CommandKind::drive_move_absolute:
            if (config_.require_homed && !view_.homed && (starts_now || !homes_before())) return ErrorId::not_homed;
            if (const auto error = refuse_place(command.position); error != ErrorId::none) return error;
            [[fallthrough]];
        case CommandKind::drive_move_relative: {
            if (!starts_now) return ErrorId::none;
            DriveProfileRun::Way at{.from = actual_local()};
            at.target = drive_target(command, {at.from, here.velocity, 0});
            return refuse_drive_way(at);
        }
        case CommandKind::move_velocity:
        case CommandKind::drive_move_velocity:
        case CommandKind::jog: {
            if (!starts_now) return ErrorId::none;
            way = signed_velocity(command, heads_backwards());
            const double program = units_.to_program(here.position);
            const bool outward = (way > 0 && program >= config_.limits.position_max) || (way < 0 && program <= config_.limits.position_min);
            if (permitted(way) && software_limits_hold() && outward) return ErrorId::beyond_software_limit;
            break;
        }
        case CommandKind::home: return refuse_home();
        case CommandKind::homing_step: {
            const auto* step = std::get_if<HomingStepDetails>(&command.details);
            return step ? refuse_step(*step, starts_now) : ErrorId::invalid_parameter;
        }
        default: return ErrorId::none;
    }
    return !starts_now || permitted(way) ? ErrorId::none : ErrorId::interlocked;
}

ErrorId AxisCore::refuse(const AxisCommand& command) noexcept {
    if (config_.encoder) return ErrorId::not_supported;  // nothing there that moves
    if (made_by_drive(command.kind) && !drive_makes(command.kind)) return ErrorId::not_supported;
    if (const auto error = check_inputs(command, units_.counts_per_unit(), config_.limits); error != ErrorId::none) return error;
    if (const auto error = refuse_state(command); error != ErrorId::none) return error;
    if (waits(command) && waits_for_ever()) return ErrorId::buffer_mode_not_supported;
    if (const auto error = refuse_coupling(command); error != ErrorId::none) return error;
    if (const auto error = refuse_target(command, !waits(command)); error != ErrorId::none) return error;
    if (const auto error = refuse_mode(command, !waits(command)); error != ErrorId::none) return error;
    return refuse_given(command, !waits(command));
}

Submitted AxisCore::submit(const AxisCommand& command, Owner owner) noexcept {
    const auto slot = slot_of(command.kind);
    if (slot == kind_table::Slot::probe) return submit_probe(command);
    // A set-point for each cycle does not get through a slow line.
    if (slow_line(port_.capabilities()) && needs_each_cycle(command.kind))
        return {0, may(owner) ? ErrorId::not_supported : ErrorId::owned_by_other};
    if (slot == kind_table::Slot::phasing) return submit_phasing(command, owner);
    if (slot == kind_table::Slot::setting) return submit_setting(command, owner);
    if (beside(command)) return submit_passive(command, owner);
    if (!may(owner)) return {0, ErrorId::owned_by_other};
    if (slot == kind_table::Slot::superimposed) return submit_superimposed(command, owner);
    // Commands of one cycle are taken one after another (P1-016): this one adds to the target of the one before.
    if (begin_pending_ && command.kind == CommandKind::move_additive) begin_command();
    if (const auto error = refuse(command); error != ErrorId::none) return {0, error};

    const AcceptedCommand accepted{queue_.next_id(), owner, command};
    if (waits(command)) {
        queue_.push(accepted);
        // It may let the running move, or one behind it, pass its end without a stop.
        if (command.buffer_mode != mcBuffered && goal_.kind == Goal::Kind::position && !begin_pending_) goal_pending_ = true;
    } else {
        queue_.finish_active(Outcome::aborted);
        queue_.finish_waiting(Outcome::aborted);
        // P1-151: in any other mode what is superimposed goes on beside it.
        const bool aborts = command.buffer_mode == mcAborting;
        if (aborts && couples(command.kind)) abandon_superimposed();
        else if (aborts) end_superimposed(Outcome::aborted);
        abort_homing();
        queue_.activate(accepted);
        if (view_.state != AxisState::Stopping) fire(event_of(command.kind));
        if (command.kind == CommandKind::stop) view_.lock = accepted.id;
        begin_pending_ = true;
    }
    if (command.kind == CommandKind::jog) {
        jog_renewed_ = now_;
        jog_expired_ = false;
        alarms_.clear(AxisAlarm::jog_lease_expired);
    }
    publish();
    return {accepted.id, ErrorId::none};
}

ErrorId AxisCore::power(bool enable, bool positive, bool negative, Owner owner) noexcept {
    if (!may(owner)) return ErrorId::owned_by_other;
    if (++power_calls_ > 1) return ErrorId::power_conflict;
    if (enable && !driven_) return config_.encoder ? ErrorId::not_supported : ErrorId::drive_not_ready;
    permit_positive_ = positive;
    permit_negative_ = negative;
    if (!enable && power_wish_) {
        shut_down();
        return ErrorId::none;
    }
    power_wish_ = enable;
    return enable && emergency_ != EmergencyStop::none ? ErrorId::interlocked : ErrorId::none;
}

ErrorId AxisCore::reset(Owner) noexcept {
    acknowledge_alarms();
    if (view_.state != AxisState::ErrorStop) return ErrorId::none;
    if (emergency_ != EmergencyStop::none) return ErrorId::interlocked;
    if (!view_.resetting) reset_since_ = now_;
    view_.resetting = true;
    view_.reset_error = ErrorId::none;
    publish();
    return ErrorId::none;
}

ErrorId AxisCore::set(const AxisSetting& setting, Owner owner) noexcept {
    if (!may(owner)) return ErrorId::owned_by_other;
    const bool each_cycle = std::holds_alternative<SetpointFeed>(setting) || std::holds_alternative<SelectCam>(setting);
    if (each_cycle && slow_line(port_.capabilities())) return ErrorId::not_supported;
    if (const auto* position = std::get_if<SetPosition>(&setting)) return set_position(*position);
    if (const auto* parameter = std::get_if<WriteParameter>(&setting)) return write_parameter(*parameter);
    if (const auto* output = std::get_if<WriteOutput>(&setting)) return write_output(*output);
    if (const auto* fed = std::get_if<SetpointFeed>(&setting)) return feed(*fed);
    if (const auto* factors = std::get_if<Override>(&setting)) return set_override(*factors);
    if (const auto* cam = std::get_if<SelectCam>(&setting)) return select_cam(*cam);
    return ErrorId::not_supported;
}

ErrorId AxisCore::set_position(const SetPosition& wanted) noexcept {
    if (!std::isfinite(wanted.position)) return ErrorId::invalid_position;
    if (!online()) return ErrorId::drive_not_ready;
    if (view_.state == AxisState::Homing) return ErrorId::state_forbids;
    const double here = units_.to_program(actual_local());
    const double shift = wanted.relative ? wanted.position : wanted.position - here;
    if (!is_place(here + shift, units_.counts_per_unit())) return ErrorId::invalid_position;
    shift_coordinates(shift);
    publish();
    return ErrorId::none;
}

/// Program coordinates grow by `delta`; nothing moves, but the way to an absolute target becomes another.
void AxisCore::shift_coordinates(double delta) noexcept {
    if (config_.modulo > 0) delta = std::remainder(delta, config_.modulo);  // the same place whichever repetition: the nearest
    units_.shift_by(delta);
    // The number commanded stays and means the shifted coordinates (P1-200).
    const auto& active = queue_.active();
    const bool to_position = goal_.kind == Goal::Kind::position && goal_.limiter != VelocityLimiter::software_limit && !begin_pending_;
    if (to_position) goal_pending_ = true;  // limits and what waits behind have moved too
    if (to_position &&
        (active.command.kind == CommandKind::move_absolute || active.command.kind == CommandKind::move_continuous_absolute)) {
        goal_.value = config_.modulo > 0 ? goal_.value - delta : units_.to_local(active.command.position);
        commanded_target_ = goal_.value;
    }
}

void AxisCore::release_stop(CommandId id, Owner) noexcept {
    if (id == 0 || id != view_.lock) return;
    view_.lock = 0;
    if (!queue_.has_active()) view_.holder = nullptr;
    const bool stands = !moves() && !begin_pending_ && !goal_pending_;
    if (view_.state == AxisState::Stopping && stands) leave_stopping();
    publish();
}

ErrorId AxisCore::renew_jog(CommandId id, double velocity, Owner owner) noexcept {
    if (!may(owner)) return ErrorId::owned_by_other;
    auto& active = queue_.active();
    if (id == 0 || id != active.id || active.command.kind != CommandKind::jog || jog_expired_) return ErrorId::state_forbids;
    if (!std::isfinite(velocity) || as_good_as_none(velocity, config_.limits.velocity)) return ErrorId::invalid_velocity;
    if (!permitted(velocity)) return ErrorId::interlocked;
    jog_renewed_ = now_;
    if (velocity != active.command.velocity) {
        active.command.velocity = velocity;
        begin_pending_ = true;
    }
    return ErrorId::none;
}

void AxisCore::set_mode(OperatingMode mode) noexcept {
    if (mode == mode_) return;
    mode_ = mode;
    if (view_.state != AxisState::Disabled && view_.state != AxisState::ErrorStop && moves()) stop_on_own_account(false);
    release_control(view_.owner);
}

void AxisCore::take_control(Owner owner) noexcept {
    if (owner == view_.owner) return;
    view_.owner = owner;
    permit_positive_ = permit_negative_ = true;
    if (view_.state == AxisState::Disabled) queue_.finish_waiting(Outcome::aborted);  // for power that another party wanted
    const bool commanded = queue_.has_active() || queue_.waiting() > 0 || view_.lock != 0 || moves();
    if (commanded && view_.state != AxisState::Disabled && view_.state != AxisState::ErrorStop) stop_on_own_account(off_when_stopped_);
    publish();
}

void AxisCore::release_control(Owner owner) noexcept {
    if (owner != view_.owner) return;
    take_control(mode_ == OperatingMode::automatic ? Owner::program : Owner::operator_panel);
    publish();
}

}  // namespace taktwerk::axes

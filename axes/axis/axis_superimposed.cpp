// MC_MoveSuperimposed and MC_HaltSuperimposed: a motion of its own on top of the base, which keeps its command, its state and its times.
//
// The velocity is held down to what the axis' limit leaves beside the base; where the base uses all of it the superimposed motion waits.
// Where the base is to become faster than that, the superimposed motion slows down first: the sum never passes the limit. Ramps are on top
// of the base's (P1-155).

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/plannable.hpp"
#include "axes/axis/stop_ramp.hpp"

namespace taktwerk::axes {

namespace {

constexpr double least_speed = 1e-6;  // of the limit: as good as none
constexpr double room_grain = 1e-9;   // of the limit: rounding
constexpr double way_grain = 1e-9;    // of the way: rounding
constexpr double notably = 9.0 / 8;   // times the room of the present plan: worth another one

}  // namespace

ErrorId AxisCore::refuse_superimposed(const AxisCommand& command) const noexcept {
    if (const auto error = check_inputs(command, units_.counts_per_unit(), config_.limits); error != ErrorId::none) return error;
    if (view_.state == AxisState::Disabled) return ErrorId::not_powered;
    if (view_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (emergency_ != EmergencyStop::none) return ErrorId::interlocked;
    if (!next_state(view_.state, AxisEvent::superimposed)) return ErrorId::state_forbids;
    if (command.kind == CommandKind::halt_superimposed) return ErrorId::none;
    // Where the drive takes no set-point there is nothing to add to.
    const auto base = queue_.active().command.kind;
    if (base == CommandKind::torque || base == CommandKind::set_controller_mode || made_by_drive(base)) return ErrorId::state_forbids;
    if (!permitted(command.position)) return ErrorId::interlocked;
    // Where both are known to end. Everything else is stopped at the limit when it comes there.
    const bool ends = goal_.kind == Goal::Kind::rest || (goal_.kind == Goal::Kind::position && !goal_.goes_on);
    if (!ends || begin_pending_ || config_.modulo > 0) return ErrorId::none;
    const double base_end = goal_.kind == Goal::Kind::position ? goal_.value : setpoint_.base().position;
    return refuse_place(units_.to_program(base_end + setpoint_.superimposed().position + command.position));
}

Submitted AxisCore::submit_superimposed(const AxisCommand& command, Owner owner) noexcept {
    if (const auto error = refuse_superimposed(command); error != ErrorId::none) return {0, error};
    const AcceptedCommand accepted{queue_.next_id(), owner, command};
    const bool running = queue_.beside(SideSlot::superimposed) != 0;
    queue_.finish_beside(SideSlot::superimposed, Outcome::aborted);
    if (command.kind == CommandKind::halt_superimposed && !running) {
        queue_.record(accepted.id, Outcome::done, ErrorId::none);  // there is nothing to halt
    } else {
        queue_.occupy(SideSlot::superimposed, accepted.id);
        superimposed_ = {.accepted = accepted, .distance = command.position, .jerk = superimposed_.jerk, .pending = true};
        if (command.kind == CommandKind::move_superimposed) {
            view_.superimposed_covered = 0;
            if (view_.state == AxisState::Standstill) fire(AxisEvent::superimposed);  // P1-030
        }
    }
    publish();
    return {accepted.id, ErrorId::none};
}

/// Two layers in motion became one, and its ramps are or are going to be as hard as both together: a third on top would be one too many.
bool AxisCore::ramps_of_two() const noexcept {
    if (!summed_) return false;
    constexpr double rounding = 1 + 1e-9;
    const auto& limits = config_.limits;
    const auto ramps = setpoint_.base_ramps();
    return ramps.acceleration > std::max(limits.acceleration, limits.deceleration) * rounding || ramps.jerk > limits.jerk * rounding;
}

/// u/s that the axis' limit leaves in `sense` beside the base, as far as anybody knows, and beside what the base waits to become. For what has not
/// begun nothing while the base is faster than the limit (lowered since, or out of a mode of the drive): what slows it down on its way would make
/// it faster again at its end.
double AxisCore::room_beside_base(double sense) const noexcept {
    constexpr double beyond = 1 + room_grain;
    if (std::abs(setpoint_.base().velocity) > config_.limits.velocity * beyond && setpoint_.superimposed_finished()) return 0;
    return config_.limits.velocity - std::max({0.0, base_speed(sense), sense * wants_speed_});
}

/// u/s, were there room.
double AxisCore::superimposed_wish() const noexcept {
    const double commanded = superimposed_.accepted.command.velocity;
    const double speed = std::min(commanded > 0 ? commanded : config_.limits.velocity, velocity_cap());
    return view_.state == AxisState::SynchronizedMotion ? speed : speed * override_.velocity;
}

/// u/s in `sense` that the superimposed motion cannot help having from here on: what its acceleration still brings while it runs out.
double AxisCore::superimposed_reach(double sense) const noexcept {
    const auto part = setpoint_.superimposed();
    double reach = sense * part.velocity;
    const auto own = dynamics_of(superimposed_.accepted.command, config_.limits, config_.defaults);
    if (sense * part.acceleration > 0 && std::isfinite(own.jerk))
        reach += part.acceleration * part.acceleration / (2 * own.jerk * override_.jerk);
    return std::max(0.0, reach);
}

void AxisCore::run_superimposed() noexcept {
    auto& own = superimposed_;
    if (!own.begun && setpoint_.superimposed_finished() && ramps_of_two()) return;  // stays pending: a few cycles
    own.pending = false;
    own.covered = own.begun ? own.covered + setpoint_.superimposed_way() : 0;
    own.begun = true;
    own.waiting = false;
    const auto& command = own.accepted.command;
    const auto part = setpoint_.superimposed();
    auto limits = dynamics_of(command, config_.limits, config_.defaults);
    if (view_.state != AxisState::SynchronizedMotion) {
        limits.acceleration *= override_.acceleration;
        limits.deceleration *= override_.acceleration;
        limits.jerk *= override_.jerk;
    }
    // An acceleration built up with another jerk is taken away as fast as the sum needs to stay below the axis' limit.
    if (part.acceleration != 0) {
        const double sense = part.acceleration > 0 ? 1 : -1;
        const double room = room_beside_base(sense) - sense * part.velocity;
        const double needed = part.acceleration * part.acceleration / 2;
        if (needed > limits.jerk * room)
            limits.jerk = std::max(limits.jerk, room > 0 ? std::min(needed / room, config_.limits.jerk) : config_.limits.jerk);
    }
    const bool halts = command.kind == CommandKind::halt_superimposed;
    // As every stop: what speeds up loses its acceleration with the jerk it was built up with, and nothing turns round.
    if (halts && part.velocity * part.acceleration > 0) limits.jerk = std::max(limits.jerk, own.jerk);
    own.jerk = limits.jerk;
    const auto plan = halts ? plan_stop(part, never_reversing(part, limits, to_seconds(cycle_))) : plan_addition(part, limits);
    if (plan.error != PlanError::none) {
        fail(AxisAlarm::planner_refused, units_.to_program(setpoint_.state().position), part.velocity);
        if (goal_pending_) run_goal(0);
        return;
    }
    setpoint_.superimpose(plan.profile);
}

/// The rest of the way, with what there is room for in each sense: a way that became shorter is overshot, and the way back may be the base's own
/// sense. Where there is no room in the sense in which it has to go it comes to rest and waits.
Plan AxisCore::plan_addition(const MotionState& part, const MotionLimits& limits) noexcept {
    auto& own = superimposed_;
    const double limit = config_.limits.velocity;
    const double rest = own.distance - own.covered;
    const double behind_stop = rest - stopping_distance(part, limits);
    const double wish = superimposed_wish();
    const auto allowed = [&](double sense) noexcept { return std::min(wish, room_beside_base(sense)); };
    own.sense = behind_stop < 0 ? -1 : 1;
    own.room = allowed(own.sense);
    // The last digits of a way that is done are not worth waiting for.
    const bool there = std::abs(behind_stop) <= way_grain * std::max(std::abs(own.distance), std::abs(own.covered));
    own.waiting = !there && !(own.room > least_speed * limit);
    if (own.waiting) return plan_stop(part, limits);
    SignedLimits both{limits};
    both.positive.velocity = std::max(allowed(1), room_grain * limit);
    both.negative.velocity = std::max(allowed(-1), room_grain * limit);
    return plan_to_position(part, part.position + rest, both);
}

/// Worth a new plan: it may begin, or go notably faster on a way that it goes as fast as it may; or all there is, where the base changes no more.
/// Its room grows from plan to plan, which bounds their number.
bool AxisCore::room_has_grown() const noexcept {
    const auto& own = superimposed_;
    const double limit = config_.limits.velocity;
    const double room = std::min(superimposed_wish(), room_beside_base(own.sense));
    if (own.waiting) return room > least_speed * limit;
    const bool settled = setpoint_.finished() && setpoint_.base().acceleration == 0;
    if (!(room > own.room * notably || (settled && room > own.room + room_grain * limit))) return false;
    return setpoint_.superimposed_top(own.sense) >= own.room * (1 - room_grain);
}

/// `plan` of the base would add up to more than the limit with what still moves on top of it: as fast as there is room, for now.
void AxisCore::wait_for_room(const MotionState& from, MotionLimits limits, Plan& plan) noexcept {
    if (goal_.kind == Goal::Kind::stop || held_ || plan.error != PlanError::none) return;
    const double limit = config_.limits.velocity;
    double sense = 0, room = 0, wanted = 0;
    for (const double way : {1.0, -1.0}) {
        const double reach = superimposed_reach(way);
        if (reach == 0) continue;
        const double left = std::max({0.0, limit - reach, way * from.velocity});
        const double top = plan.profile.top_velocity(way);
        if (top <= left + room_grain * limit || top - left <= wanted - room) continue;
        sense = way;
        room = left;
        wanted = top;
    }
    if (sense == 0) return;
    wants_speed_ = sense * wanted;
    if (!(room > least_speed * limit)) {
        held_ = true;
        plan = plan_stop(from, limits);
    } else if (goal_.kind == Goal::Kind::velocity) {
        plan = plan_to_velocity(from, sense * std::min(sense * plan.profile.end().velocity, room), limits);
    } else {
        limits.velocity = std::min(limits.velocity, override_counts() ? room / override_.velocity : room);
        plan = plan_way(from, limits, room);
    }
}

void AxisCore::complete_superimposed() noexcept {
    auto& own = superimposed_;
    const double limit = config_.limits.velocity;
    if (wants_speed_ != 0) {
        const double left = std::max(0.0, limit - std::abs(wants_speed_));
        if (superimposed_reach(wants_speed_ < 0 ? -1 : 1) <= left + room_grain * limit) goal_pending_ = true;
    }
    if (!own.begun || queue_.beside(SideSlot::superimposed) == 0) return;
    if (own.accepted.command.kind == CommandKind::move_superimposed) {
        view_.superimposed_covered = own.covered + setpoint_.superimposed_way();
        if (!own.pending && room_has_grown()) own.pending = true;
    }
    if (own.pending || own.waiting || !setpoint_.superimposed_finished()) return;
    queue_.finish_beside(SideSlot::superimposed, Outcome::done);
    if (view_.state == AxisState::DiscreteMotion && !queue_.has_active() && !moves()) start_waiting(0);
}

/// Another command takes the axis, but the base goes on for now: a coupling may wait for its master. What moves on top of it comes to rest along
/// its own ramps, and its way so far stays (P1-281: the former motion goes on).
void AxisCore::abandon_superimposed() noexcept {
    queue_.finish_beside(SideSlot::superimposed, Outcome::aborted);
    superimposed_.accepted.command.kind = CommandKind::halt_superimposed;
    superimposed_.pending = !setpoint_.superimposed_finished();
    superimposed_.waiting = false;
    if (abandoned_addition_moves() && base_comes_to_rest()) goal_pending_ = true;
}

/// Nobody commands it any more, and it has not come to rest yet.
bool AxisCore::abandoned_addition_moves() const noexcept {
    return setpoint_.layered() && queue_.beside(SideSlot::superimposed) == 0 && !setpoint_.superimposed_finished();
}

/// The base stops and so does what was given up on top of it, each with its own ramp: between them they would turn the axis round. One motion does
/// not. It may go on later (an override): what was covered on top is part of where it goes.
void AxisCore::stop_as_one() noexcept {
    if (goal_.kind == Goal::Kind::stop) goal_.former_jerk += superimposed_.jerk;
    if (goal_.kind == Goal::Kind::position) goal_.value += setpoint_.superimposed().position;
    end_superimposed(Outcome::aborted);
}

/// From here on there is one motion again. A goal must follow where it moves.
void AxisCore::end_superimposed(Outcome outcome, ErrorId error) noexcept {
    queue_.finish_beside(SideSlot::superimposed, outcome, error);
    superimposed_.pending = superimposed_.waiting = false;
    if (!setpoint_.layered()) return;
    if (!setpoint_.superimposed_finished()) {
        summed_ = true;
        folded_jerk_ = superimposed_.jerk;
    }
    commanded_target_ += setpoint_.superimposed().position;
    setpoint_.fold();
}

}  // namespace taktwerk::axes

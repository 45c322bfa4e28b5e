#include "axes/axis/superimposed_motion.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/stop_ramp.hpp"

namespace taktwerk::axes {

namespace {

constexpr double way_grain = 1e-9;   // of the way: rounding
constexpr double notably = 9.0 / 8;  // times the room of the present plan: worth another one

}  // namespace

/// Two layers in motion became one, and its ramps are or are going to be as hard as both together: a third on top would be one too many.
bool SuperimposedMotion::ramps_of_two() const noexcept {
    if (!motion_.summed) return false;
    constexpr double rounding = 1 + 1e-9;
    const auto& limits = body_.config.limits;
    const auto ramps = motion_.setpoint.base_ramps();
    return ramps.acceleration > std::max(limits.acceleration, limits.deceleration) * rounding || ramps.jerk > limits.jerk * rounding;
}

/// u/s that the axis' limit leaves in `sense` beside the base, as far as anybody knows, and beside what the base waits to become. For what has not
/// begun nothing while the base is faster than the limit (lowered since, or out of a mode of the drive): what slows it down on its way would make
/// it faster again at its end.
double SuperimposedMotion::room_beside_base(double sense) const noexcept {
    constexpr double beyond = 1 + room_grain;
    const auto& limits = body_.config.limits;
    const double base = motion_.setpoint.base().velocity;
    if (std::abs(base) > limits.velocity_towards(base) * beyond && motion_.setpoint.superimposed_finished()) return 0;
    return limits.velocity_towards(sense) - std::max({0.0, given_.base_speed(sense), sense * motion_.wants_speed});
}

/// u/s, were there room.
double SuperimposedMotion::wanted() const noexcept {
    const double commanded = superimposed_.accepted.command.velocity;
    const double speed = std::min(commanded > 0 ? commanded : body_.config.limits.velocity, body_.velocity_cap());
    return body_.state == AxisState::SynchronizedMotion ? speed : speed * motion_.factors.velocity;
}

double SuperimposedMotion::reach(double sense) const noexcept {
    const auto part = motion_.setpoint.superimposed();
    double reach = sense * part.velocity;
    const auto own = dynamics_of(superimposed_.accepted.command, body_.config.limits, body_.config.defaults);
    if (sense * part.acceleration > 0 && std::isfinite(own.jerk))
        reach += part.acceleration * part.acceleration / (2 * own.jerk * motion_.factors.jerk);
    return std::max(0.0, reach);
}

/// Worth a new plan: it may begin, or go notably faster on a way that it goes as fast as it may; or all there is, where the base changes no more.
/// Its room grows from plan to plan, which bounds their number.
bool SuperimposedMotion::room_has_grown() const noexcept {
    const auto& own = superimposed_;
    const double limit = body_.config.limits.velocity;
    const double room = std::min(wanted(), room_beside_base(own.sense));
    if (own.waiting) return room > least_speed * limit;
    const bool settled = motion_.setpoint.finished() && motion_.setpoint.base().acceleration == 0;
    if (!(room > own.room * notably || (settled && room > own.room + room_grain * limit))) return false;
    return motion_.setpoint.superimposed_top(own.sense) >= own.room * (1 - room_grain);
}

/// The rest of the way, with what there is room for in each sense: a way that became shorter is overshot, and the way back may be the base's own
/// sense. Where there is no room in the sense in which it has to go it comes to rest and waits.
Plan SuperimposedMotion::plan_addition(const MotionState& part, const MotionLimits& limits) noexcept {
    auto& own = superimposed_;
    const double limit = body_.config.limits.velocity;
    const double rest = own.distance - own.covered;
    const double behind_stop = rest - stopping_distance(part, limits);
    const double wish = wanted();
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

bool SuperimposedMotion::run() noexcept {
    auto& own = superimposed_;
    if (!own.begun && motion_.setpoint.superimposed_finished() && ramps_of_two()) return true;  // stays pending: a few cycles
    own.pending = false;
    own.covered = own.begun ? own.covered + motion_.setpoint.superimposed_way() : 0;
    own.begun = true;
    own.waiting = false;
    const auto& command = own.accepted.command;
    const auto part = motion_.setpoint.superimposed();
    auto limits = gentlest(dynamics_of(command, body_.config.limits, body_.config.defaults), body_.config.limits);
    if (body_.state != AxisState::SynchronizedMotion) {
        limits.acceleration *= motion_.factors.acceleration;
        limits.deceleration *= motion_.factors.acceleration;
        limits.jerk *= motion_.factors.jerk;
    }
    // An acceleration built up with another jerk is taken away as fast as the sum needs to stay below the axis' limit.
    if (part.acceleration != 0) {
        const double sense = part.acceleration > 0 ? 1 : -1;
        const double room = room_beside_base(sense) - sense * part.velocity;
        const double needed = part.acceleration * part.acceleration / 2;
        if (needed > limits.jerk * room)
            limits.jerk = std::max(limits.jerk, room > 0 ? std::min(needed / room, body_.config.limits.jerk) : body_.config.limits.jerk);
    }
    const bool halts = command.kind == CommandKind::halt_superimposed;
    // As every stop: what speeds up loses its acceleration with the jerk it was built up with, and nothing turns round.
    if (halts && part.velocity * part.acceleration > 0) limits.jerk = std::max(limits.jerk, own.jerk);
    own.jerk = limits.jerk;
    const auto plan = halts ? plan_stop(part, never_reversing(part, limits, to_seconds(body_.cycle))) : plan_addition(part, limits);
    if (plan.error != PlanError::none) return false;
    motion_.setpoint.superimpose(plan.profile);
    return true;
}

bool SuperimposedMotion::complete() noexcept {
    auto& own = superimposed_;
    const double limit = body_.config.limits.velocity;
    if (motion_.wants_speed != 0) {
        const double left = std::max(0.0, body_.config.limits.velocity_towards(motion_.wants_speed) - std::abs(motion_.wants_speed));
        if (reach(motion_.wants_speed < 0 ? -1 : 1) <= left + room_grain * limit) motion_.goal_pending = true;
    }
    if (!own.begun || body_.queue.beside(SideSlot::superimposed) == 0) return false;
    if (own.accepted.command.kind == CommandKind::move_superimposed) {
        covered_ = own.covered + motion_.setpoint.superimposed_way();
        if (!own.pending && room_has_grown()) own.pending = true;
    }
    if (own.pending || own.waiting || !motion_.setpoint.superimposed_finished()) return false;
    body_.queue.finish_beside(SideSlot::superimposed, Outcome::done);
    return true;
}

void SuperimposedMotion::abandon() noexcept {
    body_.queue.finish_beside(SideSlot::superimposed, Outcome::aborted);
    superimposed_.accepted.command.kind = CommandKind::halt_superimposed;
    superimposed_.pending = !motion_.setpoint.superimposed_finished();
    superimposed_.waiting = false;
    if (abandoned_moves() && motion_.base_comes_to_rest()) motion_.goal_pending = true;
}

bool SuperimposedMotion::abandoned_moves() const noexcept {
    return motion_.setpoint.layered() && body_.queue.beside(SideSlot::superimposed) == 0 && !motion_.setpoint.superimposed_finished();
}

void SuperimposedMotion::end(Outcome outcome, ErrorId error) noexcept {
    body_.queue.finish_beside(SideSlot::superimposed, outcome, error);
    superimposed_.pending = superimposed_.waiting = false;
    if (!motion_.setpoint.layered()) return;
    if (!motion_.setpoint.superimposed_finished()) {
        motion_.summed = true;
        motion_.folded_jerk = superimposed_.jerk;
    }
    motion_.commanded_target += motion_.setpoint.superimposed().position;
    motion_.setpoint.fold();
}

void SuperimposedMotion::begin(const AcceptedCommand& accepted) noexcept {
    const auto& command = accepted.command;
    const bool running = body_.queue.beside(SideSlot::superimposed) != 0;
    body_.queue.finish_beside(SideSlot::superimposed, Outcome::aborted);
    if (command.kind == CommandKind::halt_superimposed && !running) {
        body_.queue.record(accepted.id, Outcome::done, ErrorId::none);  // there is nothing to halt
        return;
    }
    body_.queue.occupy(SideSlot::superimposed, accepted.id);
    superimposed_ = {.accepted = accepted, .distance = command.position, .jerk = superimposed_.jerk, .pending = true};
    if (command.kind == CommandKind::move_superimposed) covered_ = 0;
}

}  // namespace taktwerk::axes

#include "axes/axis/given_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/direction_limits.hpp"

namespace taktwerk::axes {

namespace {

constexpr double time_grain = 1e-9;  // s: a sum of times that ends with a cycle ends in it, whatever its last digits

}  // namespace

/// Into the spare curve: a running one is not touched by a command that is refused.
ErrorId GivenMotion::make_curve(const AxisCommand& command, Addition addition, double behind) noexcept {
    const auto& details = std::get<TimeProfileDetails>(command.details);
    const auto* table = body_.scene.tables ? body_.scene.tables->time_table(details.table) : nullptr;
    if (!table) return ErrorId::invalid_table;
    auto& curve = profile_.spare();
    const auto& from = motion_.setpoint.base();
    const CurveScale scale{details.time_scale, details.value_scale, details.offset, behind};
    ErrorId error = ErrorId::none;
    switch (command.kind) {
        case CommandKind::position_profile: {
            CurveScale local = scale;
            local.offset = body_.units.to_local(scale.offset);
            error = curve.make_position(from, table->rows(), local, body_.config.windows.in_position);
            break;
        }
        case CommandKind::velocity_profile:
            error = curve.make_velocity(from, table->rows(), scale, body_.config.windows.standstill_velocity);
            break;
        default: error = curve.make_acceleration(from, table->rows(), scale); break;
    }
    if (error != ErrorId::none) return error;

    const auto& axis = body_.config.limits;
    CurveLimits limits{gentlest(full_limits(axis), axis), -std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity()};
    limits.motion.velocity = std::min(limits.motion.velocity, body_.velocity_cap());
    limits.forward = std::min(axis.velocity_towards(1), body_.velocity_cap());
    limits.backward = std::min(axis.velocity_towards(-1), body_.velocity_cap());
    if (addition == Addition::stays) {
        // A table waits for nothing: it is taken where it leaves what moves on top of it its velocity.
        limits.forward = std::min(limits.forward, axis.velocity_towards(1) - motion_.setpoint.superimposed_top(1));
        limits.backward = std::min(limits.backward, axis.velocity_towards(-1) - motion_.setpoint.superimposed_top(-1));
    }
    if (body_.software_limits_hold()) {
        limits.position_min = body_.units.to_local(body_.config.limits.position_min);
        limits.position_max = body_.units.to_local(body_.config.limits.position_max);
    }
    if (const auto beyond = curve.check(limits); beyond != ErrorId::none) return beyond;
    // A velocity that stays must leave room to stop.
    const auto& end = curve.end();
    const double rest =
        end.velocity == 0 ? end.position : end.position + stopping_distance(end, in_each_direction(full_limits(axis), axis));
    const bool fits = end.velocity == 0 || (rest <= limits.position_max && rest >= limits.position_min);
    return fits ? ErrorId::none : ErrorId::beyond_software_limit;
}

ErrorId GivenMotion::refuse(const AxisCommand& command, bool starts_now) noexcept {
    // Nothing says when an axis that is fed would have finished.
    if (!starts_now && is_fed(body_.queue.active().command.kind)) return ErrorId::buffer_mode_not_supported;
    if (!follows_table(command.kind)) return ErrorId::none;
    if (starts_now) return make_curve(command, Addition::folded);
    const auto& details = std::get<TimeProfileDetails>(command.details);
    return body_.scene.tables && body_.scene.tables->time_table(details.table) ? ErrorId::none : ErrorId::invalid_table;
}

ErrorId GivenMotion::take(const AxisCommand& command) noexcept {
    if (follows_table(command.kind)) {
        if (const auto error = make_curve(command, Addition::stays); error != ErrorId::none) return error;
        profile_.take_spare();
        profile_.behind = 0;
    } else {
        feed_ = {};
    }
    return ErrorId::none;
}

ErrorId GivenMotion::update(const AxisCommand& command) noexcept {
    const double elapsed = profile_.late + to_seconds(profile_.elapsed);
    if (motion_.goal.kind != Goal::Kind::given || elapsed + time_grain >= profile_.running().duration())
        return ErrorId::update_not_possible;
    const double behind = profile_.behind + elapsed / std::get<TimeProfileDetails>(body_.queue.active().command.details).time_scale;
    if (const auto error = make_curve(command, Addition::stays, behind); error != ErrorId::none) return error;
    profile_.take_spare();
    profile_.behind = behind;
    profile_.elapsed = Duration{};
    profile_.late = 0;
    return ErrorId::none;
}

void GivenMotion::start(double late) noexcept {
    if (body_.queue.active().command.kind == CommandKind::torque) motion_.setpoint.run(Profile{motion_.setpoint.base()}, late);
    if (!follows_table(body_.queue.active().command.kind)) return;
    profile_.elapsed = Duration{};
    profile_.late = late;
    if (late > 0) follow_curve(late);  // else it is where the table begins, and nothing of it has happened yet
}

bool GivenMotion::step(Duration period) noexcept {
    if (body_.queue.active().command.kind == CommandKind::torque) {  // until the drive has taken its mode
        motion_.setpoint.advance(period);
        return true;
    }
    motion_.setpoint.advance_superimposed(period);
    if (follows_table(body_.queue.active().command.kind)) {
        profile_.elapsed += period;
        follow_curve(profile_.late + to_seconds(profile_.elapsed));
        return true;
    }
    return follow_feed(period);
}

void GivenMotion::follow_curve(double t) noexcept {
    auto& curve = profile_.running();
    if (t + time_grain < curve.duration()) {
        motion_.setpoint.set(curve.at(t), curve.jerk_at(t));
        return;
    }
    // The rest of this cycle, and what follows, belongs to the end: standing still, or the last velocity kept.
    const auto& end = curve.end();
    const bool position = body_.queue.active().command.kind == CommandKind::position_profile;
    motion_.goal = {position ? Goal::Kind::position : Goal::Kind::velocity, position ? end.position : end.velocity,
                    full_limits(body_.config.limits), VelocityLimiter::command};
    motion_.goal.kept = !position;
    motion_.setpoint.run(Profile{end}, std::max(0.0, t - curve.duration()));
    motion_.setpoint.sample();
}

double GivenMotion::base_speed(double sense) const noexcept {
    const bool by_table = motion_.goal.kind == Goal::Kind::given && follows_table(body_.queue.active().command.kind);
    return by_table ? profile_.running().top_velocity(sense) : motion_.setpoint.base_speed(sense);
}

double GivenMotion::jerk() const noexcept {
    const auto& command = body_.queue.active().command;
    return is_fed(command.kind) ? std::min(command.jerk, body_.config.limits.jerk) : 0;  // P1-037
}

ErrorId GivenMotion::check_feed(const MotionState& next) const noexcept {
    const auto& from = motion_.setpoint.base();
    const double period = to_seconds(body_.cycle);
    const auto& limits = body_.config.limits;
    const auto most = [&](double sense) { return std::min(limits.velocity_towards(sense), body_.velocity_cap()) * (1 + 1e-9); };
    const auto ramps = gentlest(full_limits(limits), limits);
    const double change = std::max(ramps.acceleration, ramps.deceleration) * period * (1 + 1e-9);
    const double mean = (next.position - from.position) / period;
    // The last digits of large positions are no motion.
    const double grain = 4 * std::numeric_limits<double>::epsilon() * std::abs(next.position) / period;
    if (std::abs(mean) > most(mean) + grain || std::abs(next.velocity) > most(next.velocity)) return ErrorId::invalid_velocity;
    // Nor may it with what is superimposed.
    const double sense = next.velocity < 0 ? -1 : 1;
    const double beside = std::max(0.0, motion_.setpoint.superimposed_top(sense));
    if (std::abs(next.velocity) + beside > limits.velocity_towards(sense) * (1 + 1e-9)) return ErrorId::invalid_velocity;
    if (std::abs(next.velocity - from.velocity) > change || std::abs(next.acceleration) * period > change) return ErrorId::invalid_dynamics;
    // A stop takes a declared jerk's time to release what speeds up: not beyond the limit.
    if (jerk() > 0 && next.velocity * next.acceleration > 0 &&
        std::abs(next.velocity) + next.acceleration * next.acceleration / (2 * jerk()) > most(next.velocity))
        return ErrorId::invalid_velocity;
    // Who has given its word gets a stop that takes the acceleration over: it must be one that was built up with that jerk.
    if (jerk() > 0 && std::abs(next.acceleration - from.acceleration) > jerk() * period * (1 + 1e-6) + change * 1e-9)
        return ErrorId::invalid_dynamics;
    // Position and velocity must tell of one motion: the axis would brake from the one with the other.
    if (std::abs(mean - (next.velocity + from.velocity) / 2) > change + grain) return ErrorId::invalid_dynamics;
    if (body_.software_limits_hold()) {
        const double end = body_.units.to_program(next.position + stopping_distance(next, in_each_direction(full_limits(limits), limits)));
        // A motion planned to end exactly there ends there but for the last digits.
        const double digits = 1e-12 * std::max(std::abs(end), std::abs(next.position));
        if (end > body_.config.limits.position_max + digits || end < body_.config.limits.position_min - digits)
            return ErrorId::beyond_software_limit;
    }
    return ErrorId::none;
}

ErrorId GivenMotion::feed(const SetpointFeed& fed) noexcept {
    ErrorId error = ErrorId::none;
    const MotionState next{body_.units.to_local(fed.position), fed.velocity, fed.acceleration};
    if (!std::isfinite(fed.position)) error = ErrorId::invalid_position;
    else if (!std::isfinite(fed.velocity)) error = ErrorId::invalid_velocity;
    else if (!std::isfinite(fed.acceleration)) error = ErrorId::invalid_dynamics;
    else error = check_feed(next);
    if (error != ErrorId::none) return error;
    feed_.next = next;
    feed_.fresh = true;
    return ErrorId::none;
}

/// False: set-points are missing for longer than the axis has patience.
bool GivenMotion::follow_feed(Duration period) noexcept {
    if (feed_.fresh) {
        motion_.setpoint.set(feed_.next);
        feed_.fresh = false;
        feed_.missing = 0;
        feed_.followed = true;
        return true;
    }
    feed_.followed = false;
    const auto now = motion_.setpoint.base();
    if (now.velocity == 0) {  // an axis that stands misses nothing
        motion_.setpoint.set({now.position, 0, 0});
        return true;
    }
    if (++feed_.missing > body_.config.patience.feed) return false;
    motion_.setpoint.set({now.position + now.velocity * to_seconds(period), now.velocity, 0});
    return true;
}

}  // namespace taktwerk::axes

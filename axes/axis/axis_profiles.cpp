// Set-points that no planner makes: tables over time, and set-points fed from outside. Both are checked before they are followed; neither
// takes an override, because their time is the program's (MC_PositionProfile has TimeScale).

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

constexpr double time_grain = 1e-9;  // s: a sum of times that ends with a cycle ends in it, whatever its last digits

}  // namespace

void AxisCore::GivenProfile::reserve(std::size_t rows) {
    for (auto& curve : curves) curve.reserve(rows);
}

/// Into the spare curve: a running one is not touched by a command that is refused.
ErrorId AxisCore::make_curve(const AxisCommand& command, Addition addition, double behind) noexcept {
    const auto& details = std::get<TimeProfileDetails>(command.details);
    const auto* table = scene_.tables ? scene_.tables->time_table(details.table) : nullptr;
    if (!table) return ErrorId::invalid_table;
    auto& curve = profile_.spare();
    const auto& from = setpoint_.base();
    const CurveScale scale{details.time_scale, details.value_scale, details.offset, behind};
    ErrorId error = ErrorId::none;
    switch (command.kind) {
        case CommandKind::position_profile: {
            CurveScale local = scale;
            local.offset = units_.to_local(scale.offset);
            error = curve.make_position(from, table->rows(), local, config_.windows.in_position);
            break;
        }
        case CommandKind::velocity_profile:
            error = curve.make_velocity(from, table->rows(), scale, config_.windows.standstill_velocity);
            break;
        default: error = curve.make_acceleration(from, table->rows(), scale); break;
    }
    if (error != ErrorId::none) return error;

    CurveLimits limits{full_limits(config_.limits), -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    limits.motion.velocity = limits.forward = limits.backward = std::min(limits.motion.velocity, velocity_cap());
    if (addition == Addition::stays) {
        // A table waits for nothing: it is taken where it leaves what moves on top of it its velocity.
        limits.forward = std::min(limits.forward, config_.limits.velocity - setpoint_.superimposed_top(1));
        limits.backward = std::min(limits.backward, config_.limits.velocity - setpoint_.superimposed_top(-1));
    }
    if (software_limits_hold()) {
        limits.position_min = units_.to_local(config_.limits.position_min);
        limits.position_max = units_.to_local(config_.limits.position_max);
    }
    if (const auto beyond = curve.check(limits); beyond != ErrorId::none) return beyond;
    // A velocity that stays must leave room to stop.
    const auto& end = curve.end();
    const double rest = end.velocity == 0 ? end.position : end.position + stopping_distance(end, full_limits(config_.limits));
    const bool fits = end.velocity == 0 || (rest <= limits.position_max && rest >= limits.position_min);
    return fits ? ErrorId::none : ErrorId::beyond_software_limit;
}

ErrorId AxisCore::refuse_given(const AxisCommand& command, bool starts_now) noexcept {
    // Nothing says when an axis that is fed would have finished.
    if (!starts_now && queue_.active().command.kind == CommandKind::external) return ErrorId::buffer_mode_not_supported;
    if (!follows_table(command.kind)) return ErrorId::none;
    if (starts_now) return make_curve(command, Addition::folded);
    const auto& details = std::get<TimeProfileDetails>(command.details);
    return scene_.tables && scene_.tables->time_table(details.table) ? ErrorId::none : ErrorId::invalid_table;
}

ErrorId AxisCore::set_goal_given(const AxisCommand& command) noexcept {
    if (follows_table(command.kind)) {
        if (const auto error = make_curve(command, Addition::stays); error != ErrorId::none) return error;
        profile_.take_spare();
        profile_.behind = 0;
    } else {
        feed_ = {};
    }
    aim(Goal::Kind::given, 0, full_limits(config_.limits), VelocityLimiter::command);
    return ErrorId::none;
}

/// ContinuousUpdate: the rest of the table, as it stands now, with the new scales, from where the axis is and as it moves.
ErrorId AxisCore::update_curve(const AxisCommand& command) noexcept {
    const double elapsed = profile_.late + to_seconds(profile_.elapsed);
    if (goal_.kind != Goal::Kind::given || elapsed + time_grain >= profile_.running().duration()) return ErrorId::update_not_possible;
    const double behind = profile_.behind + elapsed / std::get<TimeProfileDetails>(queue_.active().command.details).time_scale;
    if (const auto error = make_curve(command, Addition::stays, behind); error != ErrorId::none) return error;
    profile_.take_spare();
    profile_.behind = behind;
    profile_.elapsed = Duration{};
    profile_.late = 0;
    return ErrorId::none;
}

void AxisCore::start_given(double late) noexcept {
    if (queue_.active().command.kind == CommandKind::torque) setpoint_.run(Profile{setpoint_.base()}, late);
    if (!follows_table(queue_.active().command.kind)) return;
    profile_.elapsed = Duration{};
    profile_.late = late;
    if (late > 0) follow_curve(late);  // else it is where the table begins, and nothing of it has happened yet
}

void AxisCore::step_given(Duration period) noexcept {
    if (queue_.active().command.kind == CommandKind::torque) {  // until the drive has taken its mode
        setpoint_.advance(period);
        return;
    }
    setpoint_.advance_superimposed(period);
    if (follows_table(queue_.active().command.kind)) {
        profile_.elapsed += period;
        follow_curve(profile_.late + to_seconds(profile_.elapsed));
        return;
    }
    follow_feed(period);
}

void AxisCore::follow_curve(double t) noexcept {
    auto& curve = profile_.running();
    if (t + time_grain < curve.duration()) {
        setpoint_.set(curve.at(t), curve.jerk_at(t));
        return;
    }
    // The rest of this cycle, and what follows, belongs to the end: standing still, or the last velocity kept.
    const auto& end = curve.end();
    const bool position = queue_.active().command.kind == CommandKind::position_profile;
    goal_ = {position ? Goal::Kind::position : Goal::Kind::velocity, position ? end.position : end.velocity, full_limits(config_.limits),
             VelocityLimiter::command};
    goal_.kept = !position;
    setpoint_.run(Profile{end}, std::max(0.0, t - curve.duration()));
    setpoint_.sample();
}

/// Largest velocity that the base is going to have in the sense 1 or -1, u/s, as far as anybody knows.
double AxisCore::base_speed(double sense) const noexcept {
    const bool by_table = goal_.kind == Goal::Kind::given && follows_table(queue_.active().command.kind);
    return by_table ? profile_.running().top_velocity(sense) : setpoint_.base_speed(sense);
}

ErrorId AxisCore::check_feed(const MotionState& next) const noexcept {
    const auto& from = setpoint_.base();
    const double period = to_seconds(cycle_);
    const double velocity = std::min(config_.limits.velocity, velocity_cap()) * (1 + 1e-9);
    const double change = std::max(config_.limits.acceleration, config_.limits.deceleration) * period * (1 + 1e-9);
    const double mean = (next.position - from.position) / period;
    // The last digits of large positions are no motion.
    const double grain = 4 * std::numeric_limits<double>::epsilon() * std::abs(next.position) / period;
    if (std::abs(mean) > velocity + grain || std::abs(next.velocity) > velocity) return ErrorId::invalid_velocity;
    // Nor may it with what is superimposed.
    const double sense = next.velocity < 0 ? -1 : 1;
    const double beside = std::max(0.0, setpoint_.superimposed_top(sense));
    if (std::abs(next.velocity) + beside > config_.limits.velocity * (1 + 1e-9)) return ErrorId::invalid_velocity;
    if (std::abs(next.velocity - from.velocity) > change || std::abs(next.acceleration) * period > change) return ErrorId::invalid_dynamics;
    // Position and velocity must tell of one motion: the axis would brake from the one with the other.
    if (std::abs(mean - (next.velocity + from.velocity) / 2) > change + grain) return ErrorId::invalid_dynamics;
    if (software_limits_hold()) {
        const double end = units_.to_program(next.position + stopping_distance(next, full_limits(config_.limits)));
        if (end > config_.limits.position_max || end < config_.limits.position_min) return ErrorId::beyond_software_limit;
    }
    return ErrorId::none;
}

ErrorId AxisCore::feed(const SetpointFeed& fed) noexcept {
    if (queue_.active().command.kind != CommandKind::external) return ErrorId::state_forbids;
    ErrorId error = ErrorId::none;
    const MotionState next{units_.to_local(fed.position), fed.velocity, fed.acceleration};
    if (!std::isfinite(fed.position)) error = ErrorId::invalid_position;
    else if (!std::isfinite(fed.velocity)) error = ErrorId::invalid_velocity;
    else if (!std::isfinite(fed.acceleration)) error = ErrorId::invalid_dynamics;
    else error = check_feed(next);
    if (error != ErrorId::none) {
        end_feed(error);
        publish();
        return error;
    }
    feed_.next = next;
    feed_.fresh = true;
    return ErrorId::none;
}

void AxisCore::follow_feed(Duration period) noexcept {
    if (feed_.fresh) {
        setpoint_.set(feed_.next);
        feed_.fresh = false;
        feed_.missing = 0;
        feed_.followed = true;
        return;
    }
    feed_.followed = false;
    const auto now = setpoint_.base();
    if (now.velocity == 0) {  // an axis that stands misses nothing
        setpoint_.set({now.position, 0, 0});
        return;
    }
    if (++feed_.missing > config_.feed_patience) {
        end_feed(ErrorId::setpoint_missing);
        return;
    }
    setpoint_.set({now.position + now.velocity * to_seconds(period), now.velocity, 0});
}

void AxisCore::end_feed(ErrorId error) noexcept {
    queue_.finish_active(Outcome::error, error);
    halt_on_own_account();
}

}  // namespace taktwerk::axes

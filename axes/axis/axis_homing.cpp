// MC_Home: which sequence runs, and how its result becomes the axis' coordinates.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

ErrorId Axis::begin_homing(const AxisCommand& command) noexcept {
    const auto& homing = config_.homing;
    home_coordinate_ = std::isnan(command.position) ? homing.offset : command.position;
    homed_ = false;
    goal_ = {};
    goal_pending_ = false;
    switch (homing.kind) {
        case HomingKind::none: return ErrorId::not_supported;
        case HomingKind::set_here: end_homing(actual_counts_); break;
        case HomingKind::drive: drive_homing_.start(now_, homing.timeout, port_.capabilities().mode_change_delay, own_mode_); break;
        case HomingKind::home_switch:
            switch_homing_.start({.search_velocity = homing.search_velocity,
                                  .latch_velocity = homing.latch_velocity,
                                  .negative = homing.negative,
                                  .timeout = homing.timeout},
                                 now_);
            break;
    }
    return ErrorId::none;
}

void Axis::step_homing() noexcept {
    if (drive_homing_.busy()) {
        if (power_.follows_actual()) drive_homing_.cancel();
        switch (drive_homing_.step(feedback_, drive_stands(), now_)) {
            case DriveHoming::Result::attained: {
                // The drive's own zero is the reference. Its raw position may have wrapped on the way: zero is the nearest multiple.
                const double span = std::ldexp(1.0, port_.capabilities().position_bits);
                if (state_ == AxisState::Homing)
                    end_homing(static_cast<std::int64_t>(std::round(static_cast<double>(actual_counts_) / span) * span));
                break;
            }
            case DriveHoming::Result::failed:
                fail(AxisAlarm::homing_failed, static_cast<double>(DriveHoming::Phase::searching), feedback_.error_code);
                break;
            case DriveHoming::Result::timed_out: fail(AxisAlarm::homing_timeout, to_seconds(config_.homing.timeout)); break;
            case DriveHoming::Result::aborted:
            case DriveHoming::Result::none: break;
        }
        return;
    }
    if (!switch_homing_.busy()) return;
    switch_homing_.step({.fresh = feedback_.fresh,
                         .home_switch = feedback_.home_switch,
                         .negative_limit = negative_switch_,
                         .positive_limit = positive_switch_,
                         .position = feedback_.position,
                         .standing = setpoint_.at_rest() && !goal_pending_,
                         .now = now_});
    switch (switch_homing_.phase()) {
        case SwitchHoming::Phase::finished: end_homing(switch_homing_.reference()); return;
        case SwitchHoming::Phase::failed: fail(AxisAlarm::homing_failed, static_cast<double>(switch_homing_.failed_in()), 0); return;
        case SwitchHoming::Phase::timed_out: fail(AxisAlarm::homing_timeout, to_seconds(config_.homing.timeout)); return;
        default: break;
    }
    const bool on_course = goal_.kind == Goal::Kind::velocity && goal_.value == switch_homing_.velocity();
    if (on_course) return;
    auto dynamics = full_limits(config_.limits);
    dynamics.acceleration = choose(config_.homing.acceleration, 0, dynamics.acceleration);
    dynamics.deceleration = choose(config_.homing.acceleration, 0, dynamics.deceleration);
    // Homing has velocities of its own; only the axis' limit holds them down.
    const double speed = std::min(std::abs(switch_homing_.velocity()), config_.limits.velocity);
    aim(Goal::Kind::velocity, std::copysign(speed, switch_homing_.velocity()), dynamics, VelocityLimiter::command);
}

void Axis::end_homing(std::int64_t reference) noexcept {
    units_.set_program(reference, home_coordinate_ + compensation_.offset());
    homed_ = true;
    switch_homing_.cancel();
    goal_ = {};
    queue_.finish_active(Outcome::done);
    start_waiting(0);
}

void Axis::abort_homing() noexcept {
    switch_homing_.cancel();
    if (power_.follows_actual()) drive_homing_.cancel();
    else drive_homing_.abort(now_);
}

}  // namespace taktwerk::axes

#include "axes/axis/torque_bounds.hpp"

#include <cmath>

#include "axes/axis/command_check.hpp"

namespace taktwerk::axes {

TorqueBounds::TorqueBounds(AxisBody& body, ModeState& modes) noexcept
    : body_(body), modes_(modes), most_{body.config.limits.torque_towards(1), body.config.limits.torque_towards(-1)} {
    take(most_);
}

void TorqueBounds::take(const TorqueRange& range) noexcept {
    range_ = range;
    used_ = std::isfinite(range.positive) || std::isfinite(range.negative) || used_;
    modes_.torque.keep_within(range.positive, range.negative);
    told_ = false;
}

ErrorId TorqueBounds::refuse(const AxisCommand& command) const noexcept {
    const auto& drive = body_.port.capabilities();
    if (body_.config.encoder || !(drive.torque_limits || drive.torque_limits_written)) return ErrorId::no_torque_limit;
    if (const auto error = check_numbers(command); error != ErrorId::none) return error;
    const auto& wanted = std::get<TorqueLimitDetails>(command.details);
    return drive.torque_limit_per_direction || wanted.positive == wanted.negative ? ErrorId::none : ErrorId::invalid_torque_limit;
}

Submitted TorqueBounds::submit(const AxisCommand& command) noexcept {
    if (const auto error = refuse(command); error != ErrorId::none) return {0, error};
    const auto& wanted = std::get<TorqueLimitDetails>(command.details);
    if (id_ != 0) body_.queue.record(id_, Outcome::aborted, ErrorId::none);
    else former_ = range_;
    id_ = body_.queue.next_id();
    used_ = true;  // also to say that there is none
    const auto bounded = [](double value, double most) { return value > 0 ? std::min(value, most) : most; };
    take({bounded(wanted.positive, most_.positive), bounded(wanted.negative, most_.negative)});
    return {id_, ErrorId::none};
}

/// One that the drive refused leaves what was before.
bool TorqueBounds::end(bool refused) noexcept {
    if (refused) take(former_);
    body_.queue.record(id_, refused ? Outcome::error : Outcome::done, refused ? ErrorId::torque_limit_refused : ErrorId::none);
    id_ = 0;
    return true;
}

}  // namespace taktwerk::axes

#include "axes/axis/targets.hpp"

#include <cmath>

#include "axes/axis/direction_limits.hpp"

namespace taktwerk::axes {

ErrorId Targets::refuse_place(double program) const noexcept {
    if (body_.config.modulo > 0) return program >= 0 && program < body_.config.modulo ? ErrorId::none : ErrorId::invalid_position;
    const bool beyond = program > body_.config.limits.position_max || program < body_.config.limits.position_min;
    return body_.software_limits_hold() && beyond ? ErrorId::beyond_software_limit : ErrorId::none;
}

ErrorId Targets::refuse_place(const AxisCommand& command) const noexcept {
    if (!std::holds_alternative<WholeTurns>(command.details)) return refuse_place(command.position);
    if (!(body_.config.modulo > 0)) return ErrorId::not_supported;
    return command.position >= 0 ? ErrorId::none : ErrorId::invalid_position;
}

double Targets::signed_velocity(const AxisCommand& command, bool backwards) const noexcept {
    if (command.kind != CommandKind::move_velocity && command.kind != CommandKind::drive_move_velocity) return command.velocity;
    const bool negative = command.direction == mcNegativeDirection || (command.direction == mcCurrentDirection && backwards);
    return negative ? -command.velocity : command.velocity;
}

double Targets::target_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept {
    const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
    if (!absolute) return motion_.origin + command.position;
    return repetition_of(command, from, backwards);
}

double Targets::repetition_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept {
    const double modulo = body_.units.modulo();
    if (!(modulo > 0)) return body_.units.to_local(command.position);

    constexpr double same_place = 1e-10;  // moduli: rounding must not send the axis round once more
    const bool with_turns = std::holds_alternative<WholeTurns>(command.details);
    const double turns = with_turns ? std::floor(command.position / modulo + same_place) : 0;
    const double place = body_.units.to_local(command.position - turns * modulo);
    auto direction = command.direction;
    double ahead = std::fmod(place - from.position, modulo);
    if (ahead < 0) ahead += modulo;
    if (ahead < same_place * modulo || modulo - ahead < same_place * modulo) ahead = 0;
    if (direction == mcCurrentDirection) direction = backwards ? mcNegativeDirection : mcPositiveDirection;
    const bool back = direction == mcNegativeDirection || (direction == mcShortestWay && ahead > modulo / 2);
    double way = back && ahead > 0 ? ahead - modulo : ahead;
    if (direction != mcShortestWay && from.velocity * (back ? -1 : 1) > 0) {
        auto limits = motion_.with_override(dynamics_of(command, body_.config.limits, body_.config.defaults));
        limits.velocity = body_.config.limits.velocity;
        const double stop = std::abs(stopping_distance(from, in_each_direction(limits, body_.config.limits))) * (1 - 1e-9);
        const double missing = stop - std::abs(way);
        if (missing > 0) way += (back ? -modulo : modulo) * std::ceil(missing / modulo);
    }
    const double extra = direction == mcShortestWay ? 0 : back ? -turns : turns;
    return place + modulo * (std::round((from.position + way - place) / modulo) + extra);
}

double Targets::drive_target(const AxisCommand& command, const MotionState& from) const noexcept {
    if (command.kind == CommandKind::drive_move_relative) return from.position + command.position;
    return repetition_of(command, from, from.velocity != 0 ? from.velocity < 0 : motion_.backwards);
}

double Targets::torque_of(const AxisCommand& command) const noexcept {
    const double torque = std::get<TorqueDetails>(command.details).torque;
    switch (command.direction) {
        case mcNegativeDirection: return -torque;
        case mcCurrentDirection: return motion_.setpoint.state().velocity < 0 ? -torque : torque;
        case mcPositiveDirection:
        case mcShortestWay: break;
    }
    return torque;
}

ErrorId Targets::refuse_drive_way(const DriveProfileRun::Way& way) const noexcept {
    if (body_.config.modulo == 0) {
        if (const auto error = refuse_place(body_.units.to_program(way.target)); error != ErrorId::none) return error;
    }
    return measured_.permitted(way.target - way.from) ? ErrorId::none : ErrorId::interlocked;
}

}  // namespace taktwerk::axes

#include "axes/group/group_jog.hpp"

#include <algorithm>
#include <cmath>

#include "axes/group/group_equipment.hpp"
#include "axes/group/group_members.hpp"

namespace taktwerk::axes {
namespace {

double dot(const JointVector& a, const JointVector& b) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}
bool is_none(const JointVector& direction) noexcept { return dot(direction, direction) == 0; }

/// Turns of the tool are as fast as its slowest turning member is jogged: each of them has to have a velocity.
bool turns_are_said(const JogGround& ground) noexcept {
    for (std::size_t i = 0; i < ground.arm.joints; ++i)
        if (ground.arm.joint[i].rotary && !(ground.dynamics.velocity[i] > 0)) return false;
    return true;
}

ErrorId refuse_direction(const JointVector& direction, const JogGround& ground) noexcept {
    constexpr std::size_t pose_numbers = 6, first_turn = 3;
    bool turns = false;
    for (std::size_t i = 0; i < most_members; ++i) {
        const double part = direction[i];
        const bool slot = ground.frame == mcACS ? ground.members.has(i) : i < pose_numbers;
        if (!(std::abs(part) <= 1) || (part != 0 && !slot)) return ErrorId::invalid_parameter;
        if (ground.frame == mcACS && part != 0 && !(ground.dynamics.velocity[i] > 0)) return ErrorId::invalid_velocity;
        turns = turns || (i >= first_turn && part != 0);
    }
    if (ground.frame == mcACS || is_none(direction)) return ErrorId::none;
    const bool said = ground.dynamics.path.velocity > 0 && (!turns || turns_are_said(ground));
    return said ? ErrorId::none : ErrorId::invalid_velocity;
}

}  // namespace

ErrorId GroupJog::refuse(const GroupCommand& command, const JogGround& ground) noexcept {
    if (is_none(command.target)) return ErrorId::invalid_parameter;
    const HoldJog pressed{0, command.target, command.jog.velocity, command.jog.acceleration};
    if (const auto error = refuse(pressed, ground); error != ErrorId::none) return error;
    if (!(command.jog.linear >= 0) || !(command.jog.angular >= 0)) return ErrorId::invalid_parameter;
    return command.buffer_mode == mcAborting ? ErrorId::none : ErrorId::buffer_mode_not_supported;
}

ErrorId GroupJog::refuse(const HoldJog& held, const JogGround& ground) noexcept {
    if (const auto error = refuse_direction(held.direction, ground); error != ErrorId::none) return error;
    const bool usable = held.velocity >= 0 && held.velocity <= 1 && held.acceleration > 0 && held.acceleration <= 1;
    return usable ? ErrorId::none : ErrorId::invalid_override;
}

void GroupJog::press(const GroupCommand& command, Duration lease, const JoggingDynamics& dynamics) noexcept {
    *this = {};
    dynamics_ = dynamics;
    held_.direction = gone_ = command.target;
    held_.velocity = command.jog.velocity;
    held_.acceleration = command.jog.acceleration;
    lease_ = lease;
}

void GroupJog::hold(const HoldJog& held) noexcept {
    if (expired()) return;
    held_ = held;
    silent_ = {};
}

bool GroupJog::released() const noexcept { return expired() || is_none(held_.direction); }

bool GroupJog::same_way(const JointVector& a, const JointVector& b) noexcept {
    if (is_none(a) || is_none(b)) return is_none(a) && is_none(b);
    return dot(a, b) >= std::cos(steady) * std::sqrt(dot(a, a) * dot(b, b));
}

bool GroupJog::stops() const noexcept { return released() || !same_way(held_.direction, gone_); }

void GroupJog::turn(JointVector& direction, const JointVector& here) noexcept {
    if (!begun_ || stops()) {
        pressed_at_ = here;
        gone_ = held_.direction;
        way_ = 0;
    }
    begun_ = true;
    direction = gone_;
}

Override GroupJog::factors(const Override& of_group) const noexcept {
    return {of_group.velocity * held_.velocity, of_group.acceleration * held_.acceleration, of_group.jerk};
}

ErrorId write_jogging(const JoggingDynamics& wanted, JoggingDynamics& kept) noexcept {
    const auto finite = [](const auto&... values) { return (std::isfinite(values) && ...); };
    const auto all_finite = [](const JointVector& values) {
        return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    };
    if (!finite(wanted.path.velocity) || !all_finite(wanted.velocity)) return ErrorId::invalid_velocity;
    if (!finite(wanted.path.acceleration, wanted.path.deceleration, wanted.path.jerk) || !all_finite(wanted.acceleration) ||
        !all_finite(wanted.deceleration) || !all_finite(wanted.jerk))
        return ErrorId::invalid_dynamics;
    const auto put = [](double& to, double value) {
        if (value > 0) to = value;
    };
    put(kept.path.velocity, wanted.path.velocity);
    put(kept.path.acceleration, wanted.path.acceleration);
    put(kept.path.deceleration, wanted.path.deceleration);
    put(kept.path.jerk, wanted.path.jerk);
    for (std::size_t i = 0; i < most_members; ++i) {
        put(kept.velocity[i], wanted.velocity[i]);
        put(kept.acceleration[i], wanted.acceleration[i]);
        put(kept.deceleration[i], wanted.deceleration[i]);
        put(kept.jerk[i], wanted.jerk[i]);
    }
    return ErrorId::none;
}

JoggingDynamics dynamics_by_hand(const GroupMembers& members, double tool_velocity) noexcept {
    JoggingDynamics dynamics;
    dynamics.path.velocity = tool_velocity;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i)) dynamics.velocity[i] = std::min(members.axis(i).config().limits.velocity, members.axis(i).velocity_of_mode());
    return dynamics;
}

Duration jog_lease_of(const GroupMembers& members) noexcept {
    Duration least = Duration::max();
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i)) least = std::min(least, members.axis(i).config().patience.jog_lease);
    return least;
}

}  // namespace taktwerk::axes

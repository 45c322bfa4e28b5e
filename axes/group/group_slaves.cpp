#include "axes/group/group_slaves.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {
namespace {

/// A slave's own place: no new number for it (MC_SetPosition, homing) moves it.
MasterTrack::Reading reading_of(const Axis& axis) noexcept { return axis.as_master(mcSetValue); }

FollowerLimits limits_of(const Axis& axis, const FollowPath& wanted) noexcept {
    const auto& limits = axis.config().limits;
    const auto least = [](double said, double limit) { return said > 0 ? std::min(said, limit) : limit; };
    FollowerLimits all;
    const double acceleration = std::min(limits.acceleration_towards(1), limits.acceleration_towards(-1));
    const double deceleration = std::min(limits.deceleration_towards(1), limits.deceleration_towards(-1));
    all.axis = {limits.velocity, acceleration, deceleration, limits.jerk};
    all.approach = {limits.velocity, least(wanted.acceleration, acceleration), least(wanted.deceleration, deceleration),
                    least(wanted.jerk, limits.jerk)};
    all.forward = limits.velocity_towards(1);
    all.backward = limits.velocity_towards(-1);
    return all;
}

}  // namespace

ErrorId GroupSlaves::take(const FollowPath& wanted, const GroupMembers& members, Owner owner) noexcept {
    if (wanted.slave.index >= axes_.size() || members.contains(wanted.slave)) return ErrorId::invalid_axis;
    if (wanted.denominator == 0) return ErrorId::invalid_parameter;
    for (const double value : {wanted.acceleration, wanted.deceleration, wanted.jerk})
        if (!std::isfinite(value)) return ErrorId::invalid_dynamics;
    Axis& axis = axes_[wanted.slave.index];
    if (axis.config().modulo > 0 || axis.config().encoder) return ErrorId::not_supported;
    auto free = std::find_if(slaves_.begin(), slaves_.end(), [&](const One& one) { return one.axis == wanted.slave; });
    if (free == slaves_.end()) free = std::find_if(slaves_.begin(), slaves_.end(), [](const One& one) { return one.id == 0; });
    if (free == slaves_.end()) return ErrorId::not_supported;
    const auto given = axis.submit({.kind = CommandKind::external, .instance = wanted.instance}, owner);
    if (given.error != ErrorId::none) return given.error;
    const auto slave = reading_of(axis);
    *free = {wanted.slave, given.id, {}, slave.motion};
    GearLine line;
    (void)line.set({wanted.numerator, wanted.denominator}, 1, 1, gone_.place, slave.motion.place);
    free->follower.begin(line, RunDown::velocity, limits_of(axis, wanted));
    return ErrorId::none;
}

void GroupSlaves::step(std::uint64_t run, const MotionState& along, Duration period) noexcept {
    // A path that is forgotten has gone its way all the same. One that an axis drives may go back.
    gone_.place.local += run == run_ ? along.position - s_ : along.position;
    run_ = run;
    s_ = along.position;
    gone_.velocity = along.velocity;
    gone_.acceleration = along.acceleration;
    gone_.trend = along.velocity;
    for (auto& one : slaves_) {
        if (one.id == 0) continue;
        Axis& axis = axes_[one.axis.index];
        const auto& view = axis.view();
        const auto status = view.status(one.id);
        const bool goes = status == CommandStatus::active || status == CommandStatus::in_target || status == CommandStatus::queued;
        if (!goes) {
            one = {};
            continue;
        }
        const auto slave = reading_of(axis);
        if (view.active != one.id) {
            one.given = slave.motion;
            continue;
        }
        const SlaveFrame frame{slave.motion.place.feeds, slave.feed};
        const auto next =
            one.follower.step(gone_, {}, {frame.local(one.given.place), one.given.velocity, one.given.acceleration}, frame, period);
        one.given = {frame.place(next.position), next.velocity, next.acceleration};
        const double place = view.set_position + (next.position - slave.motion.place.local);
        (void)axis.set(SetpointFeed{place, next.velocity, next.acceleration}, view.owner);  // refused, it ends the command
    }
}

void GroupSlaves::publish(GroupView& view) const noexcept {
    view.path_gone = gone_.place.local;
    for (std::size_t i = 0; i < most; ++i) view.slaves[i] = {slaves_[i].axis, slaves_[i].id, slaves_[i].follower.in_sync()};
}

}  // namespace taktwerk::axes

#include "axes/axis/plain_cycle.hpp"

#include "axes/axis/axis_core.hpp"
#include "axes/axis/command_kinds.hpp"
#include "axes/axis/plain_cycle_steps.hpp"

namespace taktwerk::axes {

namespace {

/// What the drive, power and everything beside motion would need a look for.
bool nothing_unusual(const AxisCore& axis) noexcept {
    const auto& body = axis.body;
    if (body.brake.controlled() || body.config.gantry.on || body.config.load_encoder.on) return false;
    const bool commanded = body.power_wish && body.emergency == EmergencyStop::none && body.state != AxisState::Homing &&
                           body.queue.active().command.kind != CommandKind::jog;
    if (!commanded || body.slow_line || axis.modes.own != DriveMode::cyclic_position) return false;
    if (!FeedbackIntake::as_wanted(body, axis.measured, axis.runs, axis.modes)) return false;
    // A window that grows with the velocity, weight and friction fed forward, a torque limit on its way: each has something to do in each cycle.
    if (body.config.following.per_velocity > Duration::zero() || axis.output.feeds_load() || axis.bounds.id() != 0) return false;
    if (!body.alarms.active().empty()) return false;  // one that only warns is taken back by whoever raised it
    const bool probed = axis.probes.in_use() || axis.homing.passive.id() != 0 || axis.runs.latch.armed();
    return !probed && !axis.runs.search() && !axis.reset.resetting() && !axis.measured.negative_switch && !axis.measured.positive_switch &&
           axis.measured.stale == 0 && axis.measured.compensation.none();
}

/// At its velocity, shown as such, with nothing behind it.
bool cruises(const AxisBody& body, const AxisMotion& motion) noexcept {
    return motion.goal.kind == Goal::Kind::velocity && body.state == AxisState::ContinuousMotion && body.shown.active_in_target &&
           body.queue.waiting() == 0 && !made_by_drive(body.queue.active().command.kind);
}

/// Nothing waits for its turn, and the base is all there is.
bool base_alone(const AxisCore& axis) noexcept {
    const auto& body = axis.body;
    const auto& motion = axis.motion.now;
    const bool waits = body.begin_pending || motion.goal_pending || motion.held || motion.releases || motion.wants_speed != 0 ||
                       (body.shown.active_in_target && body.queue.waiting() > 0);
    return !waits && !motion.setpoint.layered() && !motion.summed && !axis.motion.addition.pending() &&
           body.queue.beside(SideSlot::superimposed) == 0;
}

/// The base has its profile, or rests.
bool along_its_profile(const AxisCore& axis) noexcept {
    const auto& body = axis.body;
    const auto& motion = axis.motion.now;
    if (axis.coupling.links.state.shown || couples(body.queue.active().command.kind)) return false;
    switch (motion.goal.kind) {
        case Goal::Kind::rest: return !body.queue.has_active();
        case Goal::Kind::position:
        case Goal::Kind::velocity:
        case Goal::Kind::stop: return !motion.setpoint.finished() || cruises(body, motion);
        case Goal::Kind::given:
        case Goal::Kind::coupled: break;
    }
    return false;
}

/// The active command's coupling runs, and nothing else has to do with it.
bool in_one_coupling(const AxisCore& axis) noexcept {
    const auto& body = axis.body;
    const auto& state = axis.coupling.links.state;
    return axis.motion.now.goal.kind == Goal::Kind::coupled && body.state == AxisState::SynchronizedMotion && body.queue.waiting() == 0 &&
           state.running.id != 0 && state.running.id == body.queue.active().id && state.next.id == 0 && state.phasing.id == 0 &&
           state.phasing_next.id == 0;
}

}  // namespace

void PlainCycle::look(const AxisCore& axis) noexcept {
    if (!nothing_unusual(axis)) return disturb();
    const auto& body = axis.body;
    const auto& motion = axis.motion.now;
    const auto& told = axis.output.command();
    const bool same_outputs =
        told.digital_outputs == body.shown.digital_outputs && told.digital_output_mask == axis.parameters.output_mask();
    straight_ = static_cast<std::uint8_t>((same_outputs ? straight_ & told_drive : 0) | with_drive);
    if (!base_alone(axis)) return;
    guarded_ = (motion.watch_limits && body.software_limits_hold()) || !body.permit_positive || !body.permit_negative;
    if (in_one_coupling(axis)) {
        straight_ |= in_coupling;
    } else if (along_its_profile(axis)) {
        straight_ |= along_profile;
        if (body.queue.waiting() == 0) straight_ |= without_master;
        drifts_ = body.endless && cruises(body, motion);
        ends_ = motion.goal.kind != Goal::Kind::rest && !motion.setpoint.finished();
        limiter_in_motion_ = motion.limiter();
    }
}

/// The following error has been too large for too long.
void PlainCycle::fall_behind(AxisCore& axis, double actual) noexcept {
    disturb();
    axis.conduct.fail(AxisAlarm::following_error, axis.following.error(), axis.following.window());
    axis.writer.states();
    axis.writer.feedback(actual);
}

PlainCycle::Planned PlainCycle::follow(AxisCore& axis, Duration period) noexcept {
    auto& motion = axis.motion.now;
    auto& slave = axis.coupling.slave;
    slave.follow(period);
    if (motion.goal.kind != Goal::Kind::coupled || motion.goal_pending) return Planned::masters;
    const MotionState before = motion.setpoint.state();
    slave.step_on(period);
    if (guarded_ && LimitGuard::may_meet_limit(axis.body, axis.measured, motion) && axis.guard.watch(before, period))
        return Planned::motion;
    const auto& follower = axis.coupling.links.state.follower;
    if (follower.in_sync() != view_.active_in_target) return Planned::motion;
    view_.sync_started = follower.approaching();
    view_.cam_ends = axis.coupling.links.state.cam_ends;
    view_.set_jerk = 0;
    view_.limiter = motion.setpoint.rests() ? VelocityLimiter::none : motion.goal.limiter;
    show_setpoint(axis);
    view_.target_position = view_.set_position;
    return Planned::all;
}

}  // namespace taktwerk::axes

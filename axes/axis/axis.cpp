// The order of a cycle, and what the machine wants. What others ask for: axis_requests.cpp.

#include "axes/axis/axis.hpp"

#include <utility>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/plain_cycle_steps.hpp"

namespace taktwerk::axes {

namespace {

/// In a mode of the drive. True: this cycle's set-point is made.
bool step_in_mode(AxisCore& axis, Duration period) noexcept {
    for (;;) {
        const auto step = axis.drive.switching.step(period);
        if (step == ModeStep::next || step == ModeStep::next_again) axis.succession.start_waiting(0);
        if (step == ModeStep::made) return true;
        if (step == ModeStep::free || step == ModeStep::next) return false;
    }
}

void step_homing(AxisCore& axis) noexcept {
    axis.homing.passive.watch();
    axis.homing.home.step();
    axis.writer.passive_homing();
    if (axis.homing.home.over() || axis.homing.steps.over()) axis.succession.start_waiting(0);
}

/// A drive that brakes by itself, in a quick stop or a fault, has power as long as it does: a holding brake is no brake for motion. One that is not
/// heard any more has none: its own watchdog has seen to that.
void step_brake(AxisCore& axis) noexcept {
    using Phase = PowerSequence::Phase;
    auto& body = axis.body;
    const auto phase = body.power.phase();
    const bool brakes = axis.measured.feedback.power == PowerState::fault_reaction && !axis.measured.stands();
    const bool online = axis.measured.online();
    const bool powered = online && (phase == Phase::settling || phase == Phase::on || body.power.quick_stops() || brakes);
    body.brake.step(powered, online && body.emergency == EmergencyStop::none, body.now);
    axis.writer.brake();
}

/// The base, what lies on top of it, and what it is coupled to: one period on.
void advance(AxisCore& axis, Duration period) noexcept {
    auto& motion = axis.motion.now;
    auto& addition = axis.motion.addition;
    if (motion.releases) axis.motion.base.end_release();
    if (motion.goal_pending) axis.conduct.run_goal(0);
    if (addition.pending() && !addition.run()) {
        axis.conduct.fail(AxisAlarm::planner_refused, axis.body.units.to_program(motion.setpoint.state().position),
                          motion.setpoint.superimposed().velocity);
        if (motion.goal_pending) axis.conduct.run_goal(0);
    }
    if (motion.goal.kind == Goal::Kind::given) {
        if (!axis.motion.given.step(period)) axis.conduct.end_with(ErrorId::setpoint_missing);
    } else if (motion.goal.kind == Goal::Kind::coupled) {
        motion.setpoint.advance_superimposed(period);
        axis.coupling.slave.step(period);
    } else motion.setpoint.advance(period);
    if (motion.goal_pending) {  // what was given has ended badly: the axis brakes from where it is
        axis.conduct.run_goal(0);
        motion.setpoint.advance(period);
    }
}

/// What the new set-point has brought to an end.
void complete(AxisCore& axis) noexcept {
    auto& body = axis.body;
    auto& motion = axis.motion.now;
    // A drive that was told to stop holds no place of ours: where it comes to rest is where the axis is.
    if (body.slow_line && motion.goal.kind == Goal::Kind::stop && !motion.goal_pending && motion.setpoint.finished() &&
        axis.measured.online() && axis.measured.stands() && axis.measured.feedback.commands_acknowledged) {
        motion.setpoint.place(axis.measured.local());
        axis.following.begin_anew();
    }
    if (Succession::may_complete(body, motion)) axis.succession.complete();
    // It has moved the axis itself.
    if (motion.goal.kind == Goal::Kind::given) motion.goal.former_jerk = axis.motion.given.jerk();
    else if (motion.goal.kind == Goal::Kind::coupled) motion.goal.former_jerk = 0;
    if (axis.coupling.links.state.shown) axis.coupling.phasing.complete();
    if (body.queue.beside(SideSlot::superimposed) != 0 || motion.wants_speed != 0) {
        const bool done = axis.motion.addition.complete();
        if (done && body.state == AxisState::DiscreteMotion && !body.queue.has_active() && !axis.conduct.moves())
            axis.succession.start_waiting(0);
    }
    if (const double velocity = motion.setpoint.state().velocity; velocity != 0) motion.backwards = velocity < 0;
    else if (motion.summed) motion.summed = !motion.setpoint.at_rest();
}

/// The end of a call: what it may have changed. A setting that was carried out in it is shown with all that it changes.
void show(AxisCore& axis) noexcept {
    if (axis.settings.changed()) axis.writer.publish();
    else axis.writer.states();
}

/// What the drive says of itself, and what it means for power.
void take_feedback(AxisCore& axis, const DriveFeedback& from_drive) noexcept {
    if (axis.intake.read(from_drive)) axis.writer.setpoint();
    if (FeedbackIntake::as_wanted(axis.body, axis.measured, axis.runs, axis.modes)) return;
    if (axis.body.driven) axis.intake.watch_drive();
    else if (axis.body.config.encoder) axis.intake.watch_encoder();
    if (!axis.supply.run()) return;
    axis.succession.start_waiting(0);
    axis.writer.setpoint();  // a homing may have begun, and be over
}

/// How far the motor is behind. `actual`: u, local.
void watch_following(AxisCore& axis, double actual) noexcept {
    if (axis.runs.motor_leads() || axis.modes.phase != ModePhase::steady) {
        axis.following.rest();  // in torque the set-point follows the motor
    } else if (axis.following.watch(axis.measured, axis.motion.now, actual, axis.runs.step.presses())) {
        if (axis.body.state != AxisState::ErrorStop)
            axis.conduct.fail(AxisAlarm::following_error, axis.following.error(), axis.following.window());
    } else if (!axis.body.alarms.active().empty() && axis.measured.feedback.fresh) {
        axis.conduct.warning_is_over(AxisAlarm::following_error);
    }
}

/// From the new set-point to what everybody sees of it. `coordinates`: those in which the cycle began.
void conclude(AxisCore& axis, bool may_be_homed, double coordinates) noexcept {
    complete(axis);
    show(axis);
    axis.writer.setpoint();
    if (may_be_homed || axis.body.units.shift() != coordinates) axis.writer.feedback(axis.measured.local());  // in other coordinates
    axis.plain.look(axis);
}

/// The set-point one period on, inside the limits, and what comes of it.
void make_setpoint(AxisCore& axis, Duration period, bool may_be_homed, double coordinates) noexcept {
    const MotionState before = axis.motion.now.setpoint.state();
    advance(axis, period);
    if (LimitGuard::may_meet_limit(axis.body, axis.measured, axis.motion.now)) axis.guard.watch(before, period);
    conclude(axis, may_be_homed, coordinates);
}

// The whole way apart from the straight one: a cycle that needs none of it does not save registers for it.

[[gnu::noinline]] void update_whole(AxisCore& axis, const DriveFeedback& from_drive) noexcept {
    take_feedback(axis, from_drive);
    if (axis.body.brake.controlled()) step_brake(axis);
    if (axis.body.config.load_encoder.on) {
        axis.load.watch();
        axis.writer.load();
    }
    if (axis.body.config.gantry.on) {
        axis.gantry.watch();
        axis.writer.skew();
    }
    const double actual = axis.measured.local();
    watch_following(axis, actual);
    if (axis.probes.watch()) axis.writer.probes();
    if (axis.bounds.watch(axis.measured.feedback)) axis.writer.publish();
    if (axis.reset.resetting()) {
        axis.reset.run();
        if (axis.body.slow_line && !axis.reset.resetting()) axis.following.begin_anew();
        axis.writer.resets();
    }
    show(axis);
    axis.writer.feedback(actual);
}

[[gnu::noinline]] void plan_whole(AxisCore& axis, Duration period) noexcept {
    auto& body = axis.body;
    if (axis.coupling.links.state.phasing_next.id != 0) axis.coupling.phasing.settle_waiting();
    if (axis.runs.motor_leads()) {
        axis.plain.disturb();
        axis.supply.follow_actual(period);
        axis.coupling.slave.settle();
        step_homing(axis);
        axis.writer.publish();
        return;
    }
    const bool may_be_homed = body.state == AxisState::Homing || axis.homing.passive.id() != 0;
    const double coordinates = body.units.shift();
    if (axis.homing.passive.id() != 0 || axis.runs.search() || axis.runs.latch.armed()) step_homing(axis);
    if (body.shown.active_in_target && body.queue.waiting() > 0) axis.settings.carry_out_due();
    if (body.shown.active_in_target && body.queue.waiting() > 0) axis.succession.hand_over();
    if (axis.modes.phase != ModePhase::steady && step_in_mode(axis, period)) {
        axis.plain.disturb();
        show(axis);
        axis.writer.setpoint();
        if (axis.modes.phase == ModePhase::profile && axis.modes.run.mode() == DriveMode::profile_position)
            axis.writer.target(axis.modes.run.front().target);
        if (body.units.shift() != coordinates) axis.writer.feedback(axis.measured.local());  // homed in passing
        return;
    }
    if (body.begin_pending) axis.succession.begin_command();
    if (body.endless) axis.motion.aim.keep_close_to_anchor();
    if (axis.coupling.links.state.shown) axis.coupling.slave.follow(period);
    make_setpoint(axis, period, may_be_homed, coordinates);
}

/// What the straight way leaves of a plan.
[[gnu::noinline]] void plan_rest(AxisCore& axis, PlainCycle::Planned planned, Duration period) noexcept {
    if (planned == PlainCycle::Planned::nothing) plan_whole(axis, period);
    else if (planned == PlainCycle::Planned::masters) make_setpoint(axis, period, false, axis.body.units.shift());
    else conclude(axis, false, axis.body.units.shift());
}

[[gnu::always_inline]] inline void plan_one(AxisCore& axis, Instant now, Duration period) noexcept {
    axis.body.now = now;
    const auto planned = axis.plain.plan(axis, period);
    if (planned != PlainCycle::Planned::all) plan_rest(axis, planned, period);
}

}  // namespace

Axis::Axis(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index, AxisView* view)
    : core_(std::make_unique<AxisCore>(std::move(config), port, cycle, index, view)), view_(&core_->body.shown) {}
Axis::Axis(Axis&&) noexcept = default;
Axis& Axis::operator=(Axis&&) noexcept = default;
Axis::~Axis() = default;

void Axis::bind(const MotionScene& scene) {
    core_->plain.disturb();
    core_->body.scene = scene;
    if (scene.tables) core_->motion.given.reserve(scene.tables->most_time_rows());
}
const AxisConfig& Axis::config() const noexcept { return core_->body.config; }
const DriveCommand& Axis::drive_command() const noexcept { return core_->output.command(); }

// --- the cycle ------------------------------------------------------------------------------------------------------------------

void Axis::update(Instant now) noexcept {
    auto& axis = *core_;
    axis.body.now = now;
    axis.supply.begin_cycle();
    const auto& from_drive = axis.body.port.decode(now);
    if (axis.plain.calm() && axis.plain.update(axis, from_drive)) return;
    update_whole(axis, from_drive);
}

void Axis::supervise(Instant now) noexcept {
    auto& axis = *core_;
    axis.body.now = now;
    if (axis.plain.calm()) return;
    const bool demanded = axis.body.emergency != EmergencyStop::none;
    if (!demanded && axis.body.queue.active().command.kind != CommandKind::jog) return;
    if (demanded) axis.conduct.obey_emergency();
    axis.jog.watch();
    axis.writer.publish();
}

void Axis::plan(Instant now, Duration period) noexcept { plan_one(*core_, now, period); }

bool Axis::plan_unless_following(Instant now, Duration period) noexcept {
    if (may_follow()) return false;
    plan_one(*core_, now, period);
    return true;
}

void Axis::encode(Instant now) noexcept {
    auto& axis = *core_;
    if (axis.plain.told()) return axis.output.encode_setpoint(now);
    axis.output.encode(now);
    axis.plain.tell();
}

// --- the machine's hand ---------------------------------------------------------------------------------------------------------

bool Axis::fetch_alarm(AlarmFact& fact) noexcept { return core_->body.alarms.fetch(fact); }
std::span<const AlarmFact> Axis::active_alarms() const noexcept { return core_->body.alarms.active(); }
void Axis::acknowledge_alarms() noexcept {
    core_->plain.disturb();
    for (const auto alarm : {AxisAlarm::jog_lease_expired, AxisAlarm::moved_while_off, AxisAlarm::retained_gearing_differs})
        core_->body.alarms.clear(alarm);
}

void Axis::stop_for_error(AlarmId reason, bool then_power_off) noexcept {
    core_->plain.disturb();
    if (core_->conduct.stop_for_error(reason, then_power_off)) core_->writer.publish();
}

void Axis::demand_emergency_stop(EmergencyStop level) noexcept {
    if (level == core_->body.emergency) return;
    core_->plain.disturb();
    core_->body.emergency = level;
}

bool Axis::connect(Presence presence, AlarmId reason) noexcept {
    auto& body = core_->body;
    if (presence == body.presence) return false;
    core_->plain.disturb();
    const bool leaves = connected(body.presence) && !connected(presence);
    body.presence = presence;
    const bool pulled = leaves && core_->supply.goes_with(reason);
    core_->writer.publish();
    return pulled;
}

void Axis::shut_down() noexcept {
    core_->plain.disturb();
    core_->conduct.shut_down();
    core_->writer.publish();
}

RetainedPosition Axis::retained() const noexcept { return core_->retained.now(!core_->conduct.moves()); }
void Axis::restore(const RetainedPosition& position, const Gearing& gearing) noexcept {
    core_->plain.disturb();
    core_->retained.restore(position, gearing);
    core_->writer.states();
}

// --- couplings ------------------------------------------------------------------------------------------------------------------

MasterTrack::Reading Axis::as_master(MC_Source source) const noexcept { return core_->coupling.as_master.reading(source); }
MasterList Axis::masters() const noexcept {
    const auto& side = core_->coupling.as_master;
    return core_->plain.coupled() ? side.running_masters() : side.masters();
}
bool Axis::may_follow() const noexcept { return !core_->plain.follows_nobody() && core_->coupling.as_master.may_follow(); }

}  // namespace taktwerk::axes

#pragma once
// What an Axis is inside.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "axes/axis/alarm_board.hpp"
#include "axes/axis/axis.hpp"
#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/axis/command.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/command_queue.hpp"
#include "axes/axis/compensation.hpp"
#include "axes/axis/coupling_state.hpp"
#include "axes/axis/drive_profile_run.hpp"
#include "axes/axis/following_error.hpp"
#include "axes/axis/parameters.hpp"
#include "axes/axis/power_sequence.hpp"
#include "axes/axis/probe_board.hpp"
#include "axes/axis/probe_window.hpp"
#include "axes/axis/retained_position.hpp"
#include "axes/axis/setpoint_generator.hpp"
#include "axes/axis/state_machine.hpp"
#include "axes/axis/time_curve.hpp"
#include "axes/axis/torque_control.hpp"
#include "axes/axis/units.hpp"
#include "axes/homing/drive_homing.hpp"
#include "axes/homing/drive_latch.hpp"
#include "axes/homing/step_run.hpp"
#include "axes/homing/switch_homing.hpp"
#include "axes/port/drive_port.hpp"
#include "axes/tables/motion_tables.hpp"

namespace taktwerk::axes {

class AxisCore {
public:
    /// `config` must have passed check(); `port` must live longer. `cycle` is the period of the axis' sync unit. Not real-time.
    /// `view`: where view() is kept, so that the views of many axes lie side by side; nullptr = with the axis.
    AxisCore(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index = 0, AxisView* view = nullptr);

    /// Before the first cycle; what it names must live as long, and the tables must have been declared (room for them is
    /// taken here). An axis without a scene follows no master and no table. Not real-time.
    void bind(const MotionScene& scene) {
        scene_ = scene;
        if (scene.tables) profile_.reserve(scene.tables->most_time_rows());
    }

    [[nodiscard]] const AxisConfig& config() const noexcept { return config_; }
    [[nodiscard]] const AxisView& view() const noexcept { return view_; }
    /// What the port was told last: for traces and tests.
    [[nodiscard]] const DriveCommand& drive_command() const noexcept { return command_; }

    // --- the cycle -----------------------------------------------------------------------------------------------------
    void update(Instant now) noexcept;
    void supervise(Instant now) noexcept;
    void plan(Instant now, Duration period) noexcept;
    void encode(Instant now) noexcept;

    // --- the machine's hand ----------------------------------------------------------------------------------------------
    /// Alarms since the last call, oldest first; false when there is none. For each, the machine carries out reactions that reach beyond
    /// this axis (stop_machine, power_off); the axis has carried out its own.
    [[nodiscard]] bool fetch_alarm(AlarmFact& fact) noexcept { return alarms_.fetch(fact); }
    /// Those that hold now.
    [[nodiscard]] std::span<const AlarmFact> active_alarms() const noexcept { return alarms_.active(); }
    /// Acknowledges what needs no reset.
    void acknowledge_alarms() noexcept {
        for (const auto alarm : {AxisAlarm::jog_lease_expired, AxisAlarm::moved_while_off, AxisAlarm::retained_gearing_differs})
            alarms_.clear(alarm);
    }
    /// Stops in ErrorStop because of something elsewhere; `reason` is the other alarm. With `then_power_off` power goes when it stands.
    /// An axis that is Disabled and stays so is left alone.
    void stop_for_error(AlarmId reason, bool then_power_off) noexcept;
    void demand_emergency_stop(EmergencyStop level) noexcept { emergency_ = level; }
    /// Stops without an error, for ending the run: commands are aborted, power goes off when the axis stands. power() ends it.
    void shut_down() noexcept;
    /// Changes owner and speed cap; stops the axis first when it moves.
    void set_mode(OperatingMode mode) noexcept;
    /// The new owner has the axis at once, but it stops before it takes motion. Returning it gives it to the mode's default owner.
    void take_control(Owner owner) noexcept;
    void release_control(Owner owner) noexcept;

    /// What must be kept for the next time power comes; `homed` is false where nothing can be.
    [[nodiscard]] RetainedPosition retained() const noexcept;
    /// Before the first cycle: what was kept, and the gearing that held then. With the first position the axis is homed again, unless the
    /// gearing has changed or the axis was moved without power (alarms say so). Nothing on an axis without an absolute encoder.
    void restore(const RetainedPosition& position, const Gearing& gearing) noexcept;

    // --- couplings ----------------------------------------------------------------------------------------------------------
    /// This axis as its slaves see it: the set-point of this cycle once plan() has run, or the newest measured position.
    [[nodiscard]] MasterTrack::Reading as_master(MC_Source source) const noexcept;
    [[nodiscard]] MasterList masters() const noexcept;
    /// False: masters() is empty. Cheap.
    [[nodiscard]] bool may_follow() const noexcept {
        return coupling_.shown || couples(queue_.active().command.kind) || queue_.waiting() > 0;
    }

    // --- requests (AxisRequests of motion_context.hpp, for one axis) -----------------------------------------------------
    Submitted submit(const AxisCommand& command, Owner owner) noexcept;
    ErrorId power(bool enable, bool positive, bool negative, Owner owner) noexcept;
    /// Any party may reset: it moves nothing. Outside ErrorStop it acknowledges. Takes as long as the drive needs: see AxisView::resetting.
    ErrorId reset(Owner owner) noexcept;
    ErrorId set(const AxisSetting& setting, Owner owner) noexcept;
    ErrorId update(CommandId id, const AxisCommand& command, Owner owner) noexcept;
    void release_stop(CommandId id, Owner owner) noexcept;
    ErrorId renew_jog(CommandId id, double velocity, Owner owner) noexcept;

private:
    /// What the base of the set-point is on its way to. `value`: local position u, or velocity u/s. `given`: no plan, something else says where
    /// it is in each cycle (a table over time, a fed set-point, the motor itself). Limits and velocities are those commanded and allowed; overrides
    /// enter where the profile is made.
    struct Goal {
        enum class Kind : std::uint8_t { rest, position, velocity, stop, given, coupled } kind = Kind::rest;
        double value = 0;
        MotionLimits limits;
        VelocityLimiter limiter = VelocityLimiter::none;
        bool goes_on = false;     ///< position: passes it with end_velocity and keeps that (MC_MoveContinuous...)
        double end_velocity = 0;  ///< u/s, signed
        double former_jerk = 0;   ///< u/s3, of the motion before: a stop's; a coupling's, table's or feed's until it has moved the axis
        bool kept = false;        ///< velocity: that of a motion that is over; an override counts from its next change on
    };
    /// What runs on top of the base.
    struct Superimposed {
        AcceptedCommand accepted;
        double distance = 0;   ///< u, since its start
        double covered = 0;    ///< u, before the present profile
        double jerk = 0;       ///< u/s3, which the present profile was planned with
        bool pending = false;  ///< has no profile yet, or one made for another base
        bool begun = false;
        bool waiting = false;  ///< the base uses the whole velocity limit in the sense that it needs
        double sense = 1;      ///< of the way that the present profile has to go, once it has braked
        double room = 0;       ///< u/s that the present profile may have in that sense
    };

    // axis.cpp
    void read_feedback() noexcept;
    [[nodiscard]] bool drive_as_wanted() const noexcept;
    void watch_drive() noexcept;
    void run_power() noexcept;
    [[nodiscard]] bool power_wanted() const noexcept;
    void watch_following_error(double actual) noexcept;
    // State, errors and the like live in the view itself. The rest is written to it in parts, since a cycle changes them at different points.
    // Who shifts coordinates publishes all.
    void publish() noexcept;
    void publish_commands() noexcept {
        if (coupling_.shown) publish_coupling();
        queue_.publish(view_);
    }
    void publish_feedback(double actual) noexcept;
    void publish_setpoint() noexcept;
    void show_power() noexcept { view_.powered = power_.on() && view_.state != AxisState::Disabled; }
    void show_side(SideSlot slot, CommandId id) noexcept { view_.side[static_cast<std::size_t>(slot)] = id; }
    [[nodiscard]] double compensated(double motor) const noexcept;
    [[nodiscard]] double actual_local() const noexcept {
        const double motor = units_.local(actual_counts_);
        return compensation_.none() ? motor : compensated(motor);
    }
    [[nodiscard]] bool online() const noexcept { return seeded_ && feedback_.online && stale_ <= stale_limit_; }
    [[nodiscard]] bool drive_faulted() const noexcept {
        return feedback_.fault || feedback_.power == PowerState::fault || feedback_.power == PowerState::fault_reaction;
    }
    /// The drive takes no set-point from here: it has no power, or homes by itself.
    [[nodiscard]] bool follows_motor() const noexcept { return power_.follows_actual() || drive_homing_.busy(); }
    [[nodiscard]] bool drive_stands() const noexcept;
    [[nodiscard]] bool moves() const noexcept {
        return !setpoint_.at_rest() || drive_homing_.busy() || queue_.beside(SideSlot::superimposed) != 0;
    }

    // axis_states.cpp
    bool fire(AxisEvent event) noexcept;
    void fail(AxisAlarm alarm, double a = 0, double b = 0) noexcept;
    void enter_error_stop(AlarmId reason, bool then_power_off) noexcept;
    void stop_on_own_account(bool then_power_off) noexcept;
    void halt_on_own_account() noexcept;
    /// The axis comes to rest after a command that ended with an error; nobody's command.
    [[nodiscard]] bool halts_alone() const noexcept {
        return view_.state == AxisState::DiscreteMotion && goal_.kind == Goal::Kind::stop && !queue_.has_active();
    }
    void switch_off() noexcept;
    void run_reset() noexcept;
    void end_reset(AxisEvent event) noexcept;
    void watch_jog_lease() noexcept;
    void leave_stopping() noexcept;

    // axis_requests.cpp
    ErrorId set_position(const SetPosition& wanted) noexcept;
    void shift_coordinates(double delta) noexcept;
    [[nodiscard]] bool may(Owner owner) noexcept;
    [[nodiscard]] ErrorId refuse(const AxisCommand& command) noexcept;
    [[nodiscard]] ErrorId refuse_state(const AxisCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_target(const AxisCommand& command, bool starts_now) const noexcept;
    [[nodiscard]] ErrorId refuse_place(double program) const noexcept;
    [[nodiscard]] ErrorId refuse_place(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool waits(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool homes_before() const noexcept;
    [[nodiscard]] bool powers_up() const noexcept;
    [[nodiscard]] bool permitted(double direction) const noexcept;
    [[nodiscard]] bool software_limits_hold() const noexcept { return view_.homed && config_.modulo == 0; }
    [[nodiscard]] double velocity_cap() const noexcept;

    // axis_motion.cpp: one cycle of the set-point
    /// Of the axis' velocity: a motor that turns faster without power is not held by switching it on.
    static constexpr double turning_by_itself = 0.1;
    [[nodiscard]] bool turns_by_itself() const noexcept;
    void follow_actual(Duration period) noexcept;
    void anchor_near_actual() noexcept;
    void reanchor() noexcept;
    void keep_close_to_anchor() noexcept;
    void end_release() noexcept;
    void run_goal(double late) noexcept;
    [[nodiscard]] bool base_comes_to_rest() const noexcept;
    [[nodiscard]] Plan plan_way(const MotionState& from, MotionLimits limits, double most) noexcept;

    // axis_goals.cpp: from a command to its goal
    void begin_command() noexcept;
    ErrorId set_goal(const AcceptedCommand& accepted) noexcept;
    void start_at_base() noexcept;
    void aim(Goal::Kind kind, double value, const MotionLimits& limits, VelocityLimiter limiter) noexcept;
    void aim_at_rest(const MotionLimits& limits) noexcept;
    [[nodiscard]] double jerk_of_motion() const noexcept;
    void aim_at_velocity(double velocity, const MotionLimits& dynamics) noexcept;
    void aim_at_target(const AxisCommand& command, double target) noexcept;
    void aim_at_stop(const AxisCommand& command) noexcept;
    [[nodiscard]] double signed_velocity(const AxisCommand& command, bool backwards) const noexcept;
    [[nodiscard]] double target_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept;
    [[nodiscard]] double repetition_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept;
    [[nodiscard]] bool heads_backwards() const noexcept;

    // axis_queue.cpp: what comes after what
    /// Cheap, for every cycle: false where complete() would find nothing.
    [[nodiscard]] bool may_complete() const noexcept {
        if (goal_.kind == Goal::Kind::rest) return queue_.has_active();
        return setpoint_.finished() || goal_.kind == Goal::Kind::given || goal_.kind == Goal::Kind::coupled ||
               view_.state == AxisState::ContinuousMotion;
    }
    void complete() noexcept;
    bool complete_active() noexcept;
    void start_waiting(double late) noexcept;
    void hand_over() noexcept;
    [[nodiscard]] double velocity_at_junction(const MotionState& from, const MotionLimits& limits) const noexcept;

    // axis_guards.cpp: limits that no set-point passes
    /// Cheap, for every cycle: false where guard() would find nothing.
    [[nodiscard]] bool may_meet_limit() const noexcept {
        const double velocity = setpoint_.state().velocity;
        const bool barred = velocity > 0 ? positive_switch_ || !permit_positive_ : negative_switch_ || !permit_negative_;
        return velocity != 0 && (barred || ((watch_limits_ || setpoint_.layered()) && software_limits_hold()));
    }
    void guard(const MotionState& before, Duration period) noexcept;
    bool guard_switches() noexcept;
    bool guard_limit_switches() noexcept;
    bool guard_permits() noexcept;
    [[nodiscard]] bool barred(double velocity) const noexcept {
        return velocity > 0 ? !permit_positive_ : velocity < 0 && !permit_negative_;
    }
    bool guard_software_limits(const MotionState& before) noexcept;
    [[nodiscard]] double layers_in_base() const noexcept;
    void brake_as_both_layers(const MotionState& from, double sense, double room, MotionLimits& limits) const noexcept;
    void brake_inside_limits(const MotionState& from, MotionLimits& limits) const noexcept;
    [[nodiscard]] bool release_below_limit(const MotionState& from, MotionLimits& limits) const noexcept;
    [[nodiscard]] bool leaves_limits(const Profile& profile) const noexcept;
    [[nodiscard]] bool sum_stays_inside() const noexcept;

    // axis_override.cpp
    ErrorId set_override(const Override& factors) noexcept;
    [[nodiscard]] bool override_counts() const noexcept;
    [[nodiscard]] MotionLimits with_override(const MotionLimits& limits) const noexcept;

    // axis_superimposed.cpp
    Submitted submit_superimposed(const AxisCommand& command, Owner owner) noexcept;
    [[nodiscard]] ErrorId refuse_superimposed(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool ramps_of_two() const noexcept;
    [[nodiscard]] double room_beside_base(double sense) const noexcept;
    [[nodiscard]] double superimposed_wish() const noexcept;
    [[nodiscard]] double superimposed_reach(double sense) const noexcept;
    [[nodiscard]] bool room_has_grown() const noexcept;
    [[nodiscard]] Plan plan_addition(const MotionState& part, const MotionLimits& limits) noexcept;
    void run_superimposed() noexcept;
    void wait_for_room(const MotionState& from, MotionLimits limits, Plan& plan) noexcept;
    void complete_superimposed() noexcept;
    void end_superimposed(Outcome outcome, ErrorId error = ErrorId::none) noexcept;
    void abandon_superimposed() noexcept;
    [[nodiscard]] bool abandoned_addition_moves() const noexcept;
    void stop_as_one() noexcept;

    // axis_update.cpp: ContinuousUpdate
    ErrorId update_active(const AxisCommand& command) noexcept;
    ErrorId update_waiting(AcceptedCommand& waiting, const AxisCommand& command) noexcept;
    ErrorId update_target(const AxisCommand& command) noexcept;
    ErrorId update_superimposed(const AxisCommand& command) noexcept;

    // axis_probes.cpp
    [[nodiscard]] ProbeBoard::Signals probe_signals() const noexcept;
    [[nodiscard]] double program_position(const FinePosition& place) const noexcept;
    Submitted submit_probe(const AxisCommand& command) noexcept;
    Submitted arm_probe(const ProbeDetails& probe) noexcept;
    Submitted abort_trigger(const TriggerRef& trigger) noexcept;
    void end_probe(CommandId id, Outcome outcome, ErrorId error) noexcept;
    void watch_probes() noexcept;
    void observe_probes() noexcept;
    void publish_probes() noexcept;

    // axis_settings.cpp
    Submitted submit_setting(const AxisCommand& command, Owner owner) noexcept;
    void carry_out(const AcceptedCommand& setting) noexcept;
    void carry_out_due_settings() noexcept;
    ErrorId write_parameter(const WriteParameter& wanted) noexcept;
    [[nodiscard]] ErrorId refuse_now(const WriteParameter& wanted) const noexcept;
    [[nodiscard]] bool beyond_reach(double edge, bool positive) const noexcept;
    void store_parameters() noexcept;
    void use_parameters() noexcept;
    ErrorId write_output(const WriteOutput& wanted) noexcept;
    // axis_modes.cpp
    /// The last three: the drive makes the profile (axis_drive_profile.cpp).
    enum class ModePhase : std::uint8_t { steady, entering, torque, leaving, changing, profile_entering, profile, profile_halting };
    [[nodiscard]] DriveMode wanted_mode() const noexcept {
        return mode_phase_ == ModePhase::steady && !drive_homing_.busy() ? own_mode_ : mode_on_the_way();
    }
    [[nodiscard]] DriveMode mode_on_the_way() const noexcept;
    [[nodiscard]] bool mode_changes() const noexcept {
        return mode_phase_ == ModePhase::entering || mode_phase_ == ModePhase::leaving || mode_phase_ == ModePhase::changing ||
               mode_phase_ == ModePhase::profile_entering;
    }
    [[nodiscard]] bool torque_wanted() const noexcept;
    [[nodiscard]] ErrorId refuse_mode(const AxisCommand& command, bool starts_now) const noexcept;
    [[nodiscard]] double torque_of(const AxisCommand& command) const noexcept;
    void begin_torque(const AxisCommand& command) noexcept;
    void begin_mode_change(const AxisCommand& command) noexcept;
    void go_mode(ModePhase phase) noexcept;
    [[nodiscard]] bool mode_confirmed() noexcept;
    bool step_mode(Duration period) noexcept;
    bool enter_torque(bool confirmed, bool late, Duration period) noexcept;
    bool run_torque(Duration period) noexcept;
    void guard_torque() noexcept { guard_motor(stop_limits(config_.limits)); }
    void guard_motor(const MotionLimits& braking) noexcept;
    bool leave_mode(bool confirmed, bool late, Duration period) noexcept;
    bool change_mode(bool confirmed, bool late) noexcept;
    void stop_or_stand() noexcept;
    [[nodiscard]] double motor_velocity() const noexcept;
    void follow_motor() noexcept;
    void fill_targets() noexcept;
    void fill_torque() noexcept;

    // axis_drive_profile.cpp: the drive makes the profile
    [[nodiscard]] bool in_drive_profile() const noexcept { return mode_phase_ >= ModePhase::profile_entering; }
    [[nodiscard]] bool drive_makes(CommandKind kind) const noexcept;
    [[nodiscard]] ErrorId refuse_drive_profile(const AxisCommand& command, bool starts_now) const noexcept;
    void begin_drive_profile(const AxisCommand& command) noexcept;
    void ask_for_drive_mode() noexcept;
    [[nodiscard]] bool drive_profile_goes_on() const noexcept;
    bool step_drive_profile(bool confirmed, bool late, Duration period) noexcept;
    bool enter_drive_profile(bool confirmed, bool late, Duration period) noexcept;
    bool run_drive_profile(Duration period) noexcept;
    bool halt_drive_profile(Duration period) noexcept;
    bool leave_drive_profile(Duration period) noexcept;
    [[nodiscard]] Duration longest_ramp(double deceleration) const noexcept;
    [[nodiscard]] double drive_target(const AxisCommand& command, const MotionState& from) const noexcept;
    [[nodiscard]] ErrorId refuse_drive_way(const DriveProfileRun::Way& way) const noexcept;
    [[nodiscard]] DriveProfileRun::Setpoint drive_setpoint(const AxisCommand& command, DriveProfileRun::Way& way) const noexcept;
    ErrorId hand_to_drive(const AxisCommand& command) noexcept;
    void hand_ahead() noexcept;
    /// The drive moves the axis by itself: faster than the limit is an error, and true.
    bool guard_drive_speed(double velocity) noexcept;
    void guard_drive_profile() noexcept;
    void judge_drive_profile() noexcept;
    void judge_drive_move() noexcept;
    void fill_drive_profile() noexcept;
    /// The drive is in the axis' own mode, or has no power.
    void end_drive_profile() noexcept {
        mode_phase_ = ModePhase::steady;
        drive_halt_ = false;
        drive_run_.end();
    }

    // axis_profiles.cpp
    [[nodiscard]] ErrorId refuse_given(const AxisCommand& command, bool starts_now) noexcept;
    /// What is superimposed when the curve begins: part of its start, or beside it all the time.
    enum class Addition : std::uint8_t { folded, stays };
    [[nodiscard]] ErrorId make_curve(const AxisCommand& command, Addition addition, double behind = 0) noexcept;
    [[nodiscard]] double base_speed(double sense) const noexcept;
    [[nodiscard]] ErrorId update_curve(const AxisCommand& command) noexcept;
    ErrorId set_goal_given(const AxisCommand& command) noexcept;
    void start_given(double late) noexcept;
    void step_given(Duration period) noexcept;
    void follow_curve(double t) noexcept;
    [[nodiscard]] ErrorId check_feed(const MotionState& next) const noexcept;
    ErrorId feed(const SetpointFeed& fed) noexcept;
    void follow_feed(Duration period) noexcept;
    void end_feed(ErrorId error) noexcept;

    // axis_coupling.cpp
    [[nodiscard]] const AxisCore* axis_at(AxisRef ref) const noexcept {
        const Axis* axis = scene_.axis(ref);
        return axis ? axis->core_.get() : nullptr;
    }
    [[nodiscard]] ErrorId refuse_coupling(const AxisCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_master(AxisRef ref, MC_Source source) const noexcept;
    [[nodiscard]] bool follows_me(const AxisCore& master) const noexcept;
    [[nodiscard]] bool never_ends(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool waits_for_ever() const noexcept;
    ErrorId select_cam(const SelectCam& wanted) noexcept;
    ErrorId join(const AcceptedCommand& accepted) noexcept;
    void plan_link(CommandId id, const AxisCommand& command, const Link* updated = nullptr) noexcept;
    void drop(Link& link) noexcept;
    ErrorId update_coupling(const AxisCommand& command) noexcept;
    [[nodiscard]] bool read_masters(Link& link, Duration period) noexcept;
    [[nodiscard]] EndlessMotion seen(const Link& link, std::size_t master) const noexcept;
    void settle_couplings() noexcept;
    void follow_masters(Duration period) noexcept;
    void step_coupled(Duration period) noexcept;
    void complete_coupled() noexcept;
    void publish_coupling() noexcept;
    [[nodiscard]] SlaveFrame slave_frame() const noexcept { return {units_.anchor(), units_.feed()}; }

    // axis_coupling_start.cpp
    void find_start(Link& link) noexcept;
    [[nodiscard]] EndlessPlace cam_origin(const CamDetails& cam, const PreparedCam& table, const AxisCore& master,
                                          const EndlessPlace& entry) const noexcept;
    [[nodiscard]] bool starts_now(Link& link) const noexcept;
    [[nodiscard]] FollowerLimits follower_limits(const AxisCommand& command) const noexcept;
    ErrorId engage(Duration period) noexcept;
    ErrorId begin_gear(const Link& link) noexcept;
    ErrorId begin_sum(const Link& link) noexcept;
    ErrorId begin_gear_in_pos(const Link& link, const EndlessMotion& first) noexcept;
    ErrorId begin_cam(Link& link, const EndlessMotion& first) noexcept;
    ErrorId approach_to(const Link& link, const EndlessMotion& master, double master_feed, const CurvePoint& end,
                        SyncApproach& approach) const noexcept;

    // axis_phasing.cpp
    Submitted submit_phasing(const AxisCommand& command, Owner owner) noexcept;
    [[nodiscard]] ErrorId refuse_phasing(const AxisCommand& command) const noexcept;
    [[nodiscard]] const AcceptedCommand& coupling_before_phasing(const AxisCommand& command) const noexcept;
    [[nodiscard]] bool lets_phasing_begin() const noexcept;
    void settle_waiting_phasing() noexcept;
    void begin_phasing(const AcceptedCommand& accepted) noexcept;
    void complete_phasing() noexcept;
    void end_phasing(Outcome outcome) noexcept;
    void clear_phase() noexcept;

    // axis_homing.cpp
    [[nodiscard]] ErrorId refuse_home() const noexcept;
    ErrorId begin_homing(const AxisCommand& command) noexcept;
    /// Some kind of homing is under way, apart from that by the drive.
    [[nodiscard]] bool homes() const noexcept {
        return passive_.id != 0 || step_run_.busy() || switch_homing_.busy() || queue_.active().command.kind == CommandKind::homing_step;
    }
    void step_homing() noexcept;
    void set_coordinate(std::int64_t at, double coordinate) noexcept;
    void end_homing(std::int64_t reference) noexcept;
    void abort_homing() noexcept;
    [[nodiscard]] DriveHomingSetup drive_homing_setup() const noexcept;
    void lose_reference() noexcept;
    void search_home_switch() noexcept;
    void run_home_search() noexcept;
    [[nodiscard]] MotionLimits homing_dynamics() const noexcept;
    [[nodiscard]] StepSettings home_search() const noexcept;
    [[nodiscard]] bool absolute_encoder() const noexcept { return config_.memory.absolute || port_.capabilities().absolute_encoder; }
    [[nodiscard]] std::int64_t encoder_range() const noexcept;
    [[nodiscard]] std::int64_t encoder_zero() const noexcept;

    // axis_retained.cpp
    void apply_retained() noexcept;

    // axis_homing_steps.cpp
    [[nodiscard]] ErrorId refuse_reference(const TriggerRef& reference) const noexcept;
    [[nodiscard]] ErrorId refuse_step(const HomingStepDetails& step, bool starts_now) const noexcept;
    [[nodiscard]] bool reference_level(const TriggerRef& reference) const noexcept;
    void arm_latch(const TriggerRef& reference, bool continuous) noexcept;
    ErrorId begin_homing_step(const AxisCommand& command) noexcept;
    [[nodiscard]] SearchInput search_input(const TriggerRef& reference) noexcept;
    void drive_step(const TriggerRef& reference, const MotionLimits& dynamics) noexcept;
    void follow_homing_step() noexcept;
    void guard_finish() noexcept;
    void end_homing_step(ErrorId error) noexcept;
    bool complete_homing_step() noexcept;

    // axis_passive_homing.cpp
    Submitted submit_passive(const AxisCommand& command, Owner owner) noexcept;
    [[nodiscard]] ErrorId refuse_passive(const AxisCommand& command) const noexcept;
    void watch_passive_homing() noexcept;
    void end_passive_homing(Outcome outcome, ErrorId error = ErrorId::none) noexcept;

    AxisConfig config_;  // its limits, windows and speeds as they hold now: parameters change them, never above what was configured
    DrivePort& port_;
    MotionScene scene_;
    Duration cycle_;
    std::uint32_t stale_limit_;
    bool driven_;  // has a drive that may be enabled
    bool endless_;
    Instant now_{};

    // from below
    DriveFeedback feedback_;
    bool seeded_ = false;      // an actual position has arrived
    std::uint32_t stale_ = 0;  // cycles since the last one
    std::int64_t actual_counts_ = 0;
    std::uint16_t position_epoch_ = 0, reference_epoch_ = 0;
    bool negative_switch_ = false, positive_switch_ = false;

    // motion
    AxisUnits units_;
    SetpointGenerator setpoint_;
    Goal goal_;
    bool begin_pending_ = false;  // the active command has not been turned into a goal yet
    bool goal_pending_ = false;   // the goal has no profile yet
    bool held_ = false;           // override 0: the axis waits on its way to a position
    bool releases_ = false;       // the plan has another jerk than the command, until the acceleration it found is gone
    bool summed_ = false;         // two layers in motion became one: until it rests, its ramps may be as hard as both together were
    double folded_jerk_ = 0;      // u/s3 of an addition that ended in motion, until the goal after it has its profile
    double wants_speed_ = 0;      // u/s, signed, that the base will have once what is superimposed has made room; 0: it waits for nothing
    bool watch_limits_ = true;    // the base might pass a software limit
    bool backwards_ = false;      // sense of the last motion
    Override override_;
    Superimposed superimposed_;
    // The running command's start, for its relative inputs; and the last target of a motion to a position, for MC_MoveAdditive.
    double origin_ = 0;               // local
    bool started_backwards_ = false;  // sense of motion there
    double commanded_target_ = 0;     // local
    bool has_commanded_target_ = false;
    bool aligned_ = false;
    SetpointHistory history_;
    FollowingErrorTimer following_timer_;
    Instant in_window_since_{};
    bool in_window_ = false;

    // set-points that no planner makes
    struct GivenProfile {
        std::array<TimeCurve, 2> curves;  // the running one, and one to check the next command with
        std::size_t current = 0;
        Duration elapsed{};
        double late = 0;    // s: it began this long before the cycle in which it was started
        double behind = 0;  // s of the table that the running curve leaves out

        void reserve(std::size_t rows);
        [[nodiscard]] TimeCurve& running() noexcept { return curves[current]; }
        [[nodiscard]] const TimeCurve& running() const noexcept { return curves[current]; }
        [[nodiscard]] TimeCurve& spare() noexcept { return curves[1 - current]; }
        void take_spare() noexcept { current = 1 - current; }
    };
    struct Feed {
        MotionState next;
        bool fresh = false;     // given since the last plan()
        bool followed = false;  // the newest set-point was a fed one
        std::uint32_t missing = 0;
    };
    GivenProfile profile_;
    Feed feed_;
    CouplingState coupling_;
    std::uint16_t index_;
    mutable std::uint32_t walks_ = 0;  // of follows_me
    mutable std::uint64_t walk_ = 0;   // the last one that came by here
    mutable const AxisCore* walk_back_ = nullptr;

    // mode of the drive
    DriveMode own_mode_;     // position or velocity
    DriveMode former_mode_;  // before set_controller_mode
    ModePhase mode_phase_ = ModePhase::steady;
    Instant mode_since_{}, mode_seen_at_{};
    bool mode_waits_ = false;   // for standstill of the motor, before it is asked for
    bool mode_seen_ = false;    // the drive shows the wanted mode
    bool motor_leads_ = false;  // since the last steady cycle the drive was in a mode that takes no set-point
    bool torque_idle_ = false;  // set_controller_mode has chosen torque: without a command it is 0
    bool drive_halt_ = false;   // bit 8, until the drive is back in the axis' own mode
    DriveProfileRun drive_run_;
    double torque_velocity_ = 0;      // u/s, limit of the torque command
    double torque_per_acceleration_;  // fraction of rated torque for 1 u/s2, fed forward
    TorqueControl torque_;
    Compensation compensation_;

    // states and commands
    CommandQueue queue_;
    PowerSequence power_;
    AlarmBoard alarms_;
    bool power_wish_ = false, permit_positive_ = true, permit_negative_ = true;
    std::uint8_t power_calls_ = 0;   // in this cycle
    bool off_when_stopped_ = false;  // Stopping on the way to Disabled
    bool power_dropping_ = false;    // Disabled, but the drive has not let go yet
    bool off_after_error_ = false;   // ErrorStop whose reaction is power off
    Instant reset_since_{};
    EmergencyStop emergency_ = EmergencyStop::none;

    // authority
    OperatingMode mode_ = OperatingMode::automatic;

    // probes
    ProbeBoard probes_;
    PositionTrack track_;
    std::uint16_t track_epoch_ = 0;
    Duration feedback_age_{};

    // outputs of the drive
    std::uint32_t digital_output_mask_ = 0;

    // jog
    Instant jog_renewed_{};
    bool jog_expired_ = false;

    // homing
    DriveHoming drive_homing_;
    SwitchHoming switch_homing_;
    double home_coordinate_ = 0;  // u, of the reference
    RetainedPosition retained_;   // waits for the first position; `homed` false: nothing to restore
    StepRun step_run_;
    DriveLatch latch_;
    bool step_succeeded_ = false;  // the last one; without it the procedure cannot be finished
    double block_torque_ = 0;      // fraction of rated torque while pressing against a block
    bool lag_forgiven_ = false;    // the set-point was ahead of an axis that could not follow

    struct PassiveHoming {
        CommandId id = 0;
        HomingStepDetails step;
        EdgeWatch edge{};
        Instant since{};
        std::int64_t from = 0;  // counts
    } passive_;

    std::unique_ptr<AxisView> own_view_;
    AxisView& view_;
    DriveCommand command_;
};

}  // namespace taktwerk::axes

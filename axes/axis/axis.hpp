#pragma once
// Axis: what a program moves. One drive port below, one view and one set of requests above; in between units, limits, the state
// machine of PLCopen, the command queue, power, homing, following error and control authority.
//
// One cycle, on the cycle thread, everything real-time safe (no allocation, no lock, no exception):
//     axis.update(now)          step 4: feedback, drive's state, following error
//     axis.supervise(now)       step 5: emergency stop, leases; then fetch_alarm() until it says no
//     axis.submit(...), ...     step 6: requests, validated and answered at once
//     axis.plan(now, period)    step 7: next set-point, one period of motion time on (plan_axes: masters before their slaves)
//     axis.encode(now)          step 8: command to the port
// view() is up to date after each of them.
//
// Decisions the standard leaves open (see README.md for all): dynamics above the limits are clamped; power off in motion ramps down
// first (state Stopping), then Disabled; a second MC_Stop while the first is held is refused; MC_Home only from Standstill; a jog is a
// discrete motion; a move into a direction that is not permitted is refused.

#include <cstdint>
#include <memory>
#include <span>

#include "axes/axis/alarms.hpp"
#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/axis/command.hpp"
#include "axes/axis/motion_scene.hpp"
#include "axes/axis/operating_mode.hpp"
#include "axes/axis/retained_position.hpp"
#include "axes/coupling/master_track.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

class Axis;
class AxisCore;

/// For plan_axes (plan_order.hpp): where it is on its way through the axes.
struct PlanMark {
    bool begun = false, planned = false;
    Axis* slave = nullptr;
};

class Axis {
public:
    /// `config` must have passed check(); `port` must live longer. `cycle` is the period of the axis' sync unit. Not real-time.
    /// `view`: where view() is kept, so that the views of many axes lie side by side; nullptr = with the axis.
    Axis(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index = 0, AxisView* view = nullptr);
    Axis(Axis&&) noexcept;
    Axis& operator=(Axis&&) noexcept;
    ~Axis();

    /// Before the first cycle; what it names must live as long, and the tables must have been declared (room for them is
    /// taken here). An axis without a scene follows no master and no table. Not real-time.
    void bind(const MotionScene& scene);

    [[nodiscard]] const AxisConfig& config() const noexcept;
    [[nodiscard]] const AxisView& view() const noexcept { return *view_; }
    /// What the port was told last: for traces and tests.
    [[nodiscard]] const DriveCommand& drive_command() const noexcept;

    // --- the cycle -----------------------------------------------------------------------------------------------------
    void update(Instant now) noexcept;
    void supervise(Instant now) noexcept;
    void plan(Instant now, Duration period) noexcept;
    void encode(Instant now) noexcept;

    // --- the machine's hand ----------------------------------------------------------------------------------------------
    /// Alarms since the last call, oldest first; false when there is none. For each, the machine carries out reactions that reach beyond
    /// this axis (stop_machine, power_off); the axis has carried out its own.
    [[nodiscard]] bool fetch_alarm(AlarmFact& fact) noexcept;
    /// Those that hold now.
    [[nodiscard]] std::span<const AlarmFact> active_alarms() const noexcept;
    /// Acknowledges what needs no reset.
    void acknowledge_alarms() noexcept;
    /// Stops in ErrorStop because of something elsewhere; `reason` is the other alarm. With `then_power_off` power goes when it stands.
    /// An axis that is Disabled and stays so is left alone.
    void stop_for_error(AlarmId reason, bool then_power_off) noexcept;
    void demand_emergency_stop(EmergencyStop level) noexcept;
    /// Whether its drive is there. While it is away or comes up the axis is not powered, and refuses with not_connected. True: it goes away, and
    /// had power or was getting it; then it stops in ErrorStop because of `reason`.
    bool connect(Presence presence, AlarmId reason) noexcept;
    /// Stops without an error, for ending the run: commands are aborted, power goes off when the axis stands. power() ends it.
    void shut_down() noexcept;
    /// Changes owner and speed cap; stops the axis first when it moves.
    void set_mode(OperatingMode mode) noexcept;
    /// u/s: what that mode leaves of every velocity; infinite in automatic.
    [[nodiscard]] double velocity_of_mode() const noexcept;
    /// The new owner has the axis at once, but it stops before it takes motion. Returning it gives it to the mode's default owner.
    void take_control(Owner owner) noexcept;
    void release_control(Owner owner) noexcept;
    /// The operator's factor on the velocity, 0 to 1 [invalid_override], whoever owns the axis. It stays until it is changed, and multiplies what
    /// MC_SetOverride says; it counts where that counts (README.md). 0 halts the axis in its motion, which goes on with more.
    ErrorId set_operators_override(double factor) noexcept;

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
    [[nodiscard]] bool may_follow() const noexcept;
    /// plan() where masters() is empty. False: it may not be, and nothing has been done.
    [[nodiscard]] bool plan_unless_following(Instant now, Duration period) noexcept;
    [[nodiscard]] PlanMark& plan_mark() noexcept { return plan_mark_; }

    // --- requests (AxisRequests of motion_context.hpp, for one axis) -----------------------------------------------------
    Submitted submit(const AxisCommand& command, Owner owner) noexcept;
    ErrorId power(bool enable, bool positive, bool negative, Owner owner) noexcept;
    /// Any party may reset: it moves nothing. Outside ErrorStop it acknowledges. Takes as long as the drive needs: see AxisView::resetting.
    ErrorId reset(Owner owner) noexcept;
    ErrorId set(const AxisSetting& setting, Owner owner) noexcept;
    ErrorId update(CommandId id, const AxisCommand& command, Owner owner) noexcept;
    void release_stop(CommandId id, Owner owner) noexcept;
    ErrorId renew_jog(CommandId id, double velocity, Owner owner) noexcept;

    // --- a group's hand (axes/group/) -------------------------------------------------------------------------------------
    /// Why it cannot follow a group that `owner` commands: not powered, not at Standstill, with commands of its own [member_moves], ... Nothing is
    /// changed.
    [[nodiscard]] ErrorId refuses_group(Owner owner) noexcept;
    /// From now on, SynchronizedMotion: its set-points are what lead() gives in each cycle before plan(), also the one of this cycle. Everybody
    /// else's motion is refused with axis_grouped; errors, emergency stop, power and another party's hand end it at once. `instance`: the block
    /// for whom, to be named to people.
    Submitted join_group(const void* instance, Owner owner) noexcept;
    /// u, u/s, u/s2. What it cannot follow (a limit, a step) ends the group's motion of this axis with that error; it comes to rest by itself.
    /// member_left: it has ended before.
    ErrorId lead(const SetpointFeed& next) noexcept;
    /// It stands, or comes to rest by itself.
    void leave_group() noexcept;
    /// The length of its group's path follows that axis from now on, and so this axis does; invalid: nobody's.
    void path_driven_by(AxisRef driver) noexcept;
    /// Over couplings that run or wait, and over paths that axes drive.
    [[nodiscard]] bool is_followed_by(const Axis& other) const noexcept;

private:
    friend class AxisCore;

    std::unique_ptr<AxisCore> core_;
    const AxisView* view_;
    PlanMark plan_mark_;
};

inline const Axis* MotionScene::axis(AxisRef ref) const noexcept { return ref.index < count ? first + ref.index : nullptr; }

}  // namespace taktwerk::axes

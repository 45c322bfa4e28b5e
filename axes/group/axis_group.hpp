#pragma once
// AxisGroup: axes that move together. A state machine with a queue that joins a path to its axes: PLCopen Part 4.
//
// One cycle, on the cycle thread, everything real-time safe (no allocation, no lock, no exception):
//     axes: update, supervise
//     group.update(now)          step 5: what became of its members
//     group.submit(...), ...     step 6: requests, validated and answered at once
//     group.plan(now, period)    step 7, before the axes plan: the next set-point of each member
// view() is up to date after each of them.
//
// While the group moves its members follow it and nobody else (axis_grouped). One that fails, loses power or is taken by another party has left it;
// the group is in GroupErrorStop then, and the others come to rest on the path.

#include <cstdint>
#include <optional>
#include <span>

#include "axes/group/group_config.hpp"
#include "axes/group/group_equipment.hpp"
#include "axes/group/group_homing.hpp"
#include "axes/group/group_jog.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_queue.hpp"
#include "axes/group/group_slaves.hpp"
#include "axes/group/group_state.hpp"
#include "axes/group/group_tracking.hpp"
#include "axes/group/path_deviation.hpp"
#include "axes/group/path_run.hpp"

namespace taktwerk::axes {

class AxisGroup {
public:
    /// `config` must have passed check(); `axes` are all axes of the machine and must live longer. `members`: of config.members, by place.
    /// `paths`: the machine's stored ones; nullptr: it has none.
    AxisGroup(AxisGroupConfig config, std::span<Axis> axes, std::span<const AxisRef> members, Duration cycle,
              const PathShelf* paths = nullptr);

    [[nodiscard]] const AxisGroupConfig& config() const noexcept { return config_; }
    [[nodiscard]] const GroupView& view() const noexcept { return view_; }
    [[nodiscard]] const GroupEquipment& equipment() const noexcept { return equipment_; }
    [[nodiscard]] bool contains(AxisRef axis) const noexcept { return members_.contains(axis); }
    /// Its axes follow it now.
    [[nodiscard]] bool leads() const noexcept { return members_.led(); }

    void update(Instant now) noexcept;
    void plan(Instant now, Duration period) noexcept;
    /// The planner's step: service side, beside the cycle; not real-time.
    void service() { run_.service(); }

    // --- the machine's hand ----------------------------------------------------------------------------------------------
    /// A person stops it: as MC_GroupHalt, whoever commands it. What is interrupted ends likewise, and what he holds.
    void halt() noexcept;
    /// The machine stops it (another mode, a key that is let go): likewise, but what a person holds stays held.
    void come_to_rest() noexcept;
    /// A person interrupts it: as MC_GroupInterrupt, whoever commands it. What its program has interrupted is held as it is. While it is held no MC_GroupContinue goes on
    /// (held_by_person), and what would begin at once waits. Nothing that a program or the machine does ends that but MC_GroupDisable: not a stop, an error, the end of a program,
    /// another mode. Errors: as of MC_GroupInterrupt, and nothing has changed.
    ErrorId hold() noexcept;
    /// He lets it go: what he has interrupted goes on, or what has taken its place meanwhile. What its program has interrupted it keeps so. Errors, and it is held on:
    /// nothing_interrupted, in_error_stop, state_forbids (it still brakes for him), why it cannot go on.
    ErrorId release_hold() noexcept;
    /// Whoever commanded it is gone: comes to rest, forgets what was interrupted or waits, gives up the lock of a stop.
    void let_go() noexcept;
    /// For a member that it leads: halts on the path, and shuts that axis down when it stands (Axis::shut_down).
    void shut_down(AxisRef axis) noexcept;
    /// Of the machine. In set-up mode the tool's point goes no faster than the configured set-up velocity, whoever moves it, from the next path on that
    /// begins at rest; what is on the way when that mode is entered comes to rest first, as by halt().
    void set_mode(OperatingMode mode) noexcept;
    /// A person's factor on the velocity along the path, 0 to 1, beside MC_GroupSetOverride; stays until it is changed. Errors: invalid_override.
    ErrorId set_operators_override(double factor) noexcept;

    // --- requests (GroupAccess, for one group) ----------------------------------------------------------------------------
    Submitted submit(const GroupCommand& command, Owner owner) noexcept;
    ErrorId set(const GroupSetting& setting, Owner owner) noexcept;
    ErrorId reset(Owner owner) noexcept;
    void release_stop(CommandId id) noexcept;
    /// Of a stored path: the request of this number is done. Errors: unknown_command.
    ErrorId acknowledge(std::uint32_t request, Owner owner) noexcept;
    /// MC_PathSelect for this group.
    void selected(PathRef path) noexcept;
    /// It goes this path, or it is the next to be gone.
    [[nodiscard]] bool uses(PathRef path) const noexcept;

private:
    [[nodiscard]] bool waits(const GroupCommand& command) const noexcept;
    [[nodiscard]] bool waits_for_person(const GroupCommand& command) const noexcept;
    /// What it takes with it if it is accepted now.
    [[nodiscard]] CommandPlace place_of(const GroupCommand& command) const noexcept;
    Submitted take_setting(const GroupCommand& command, Owner owner) noexcept;
    ErrorId equip(const GroupSetting& setting) noexcept;
    ErrorId set_position(const GroupCommand& command, Owner owner) noexcept;
    [[nodiscard]] JointVector here() const noexcept;
    [[nodiscard]] Override factors() const noexcept;
    [[nodiscard]] JoggingDynamics jogging_of(const GroupCommand& command) const noexcept;
    void see_tool_limit() noexcept;
    void take_operators_override() noexcept;
    [[nodiscard]] ErrorId refuse(const GroupCommand& command, Owner owner) const noexcept;
    [[nodiscard]] ErrorId refuse_state(const GroupCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_way(const GroupCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_stored(const GroupCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_driven(const GroupCommand& command) const noexcept;
    Submitted take_motion(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_stop(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_interrupt(const GroupCommand& command) noexcept;
    CommandId interrupt(const PathDynamics& dynamics) noexcept;
    Submitted take_resume(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_home(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_disable() noexcept;
    ErrorId change_members(const GroupSetting& setting) noexcept;
    ErrorId enable() noexcept;

    void fire(GroupEvent event) noexcept;
    void fail(std::uint16_t error, std::uint8_t place = most_members) noexcept;
    void abort_all() noexcept;
    /// Where a member is to be now.
    [[nodiscard]] MotionState state_of(std::size_t place) const noexcept;
    // Of frames that move: group_following.cpp.
    [[nodiscard]] ErrorId refuse_track(const GroupCommand& command) const noexcept;
    [[nodiscard]] bool uses_track(MC_CoordSystem frame) const noexcept;
    /// False: not yet, it still leaves another frame. Else what it is over with, if it cannot begin.
    [[nodiscard]] bool change_frame(const FrameTrack& track, ErrorId& error) noexcept;
    void go_with_frame(Duration period) noexcept;
    void leave(GroupEvent event) noexcept;
    void settle() noexcept;
    /// False: it is over already.
    [[nodiscard]] bool begin_active() noexcept;
    /// None: it can be gone, or not yet. Something: what it is over with.
    [[nodiscard]] std::optional<ErrorId> begin_way(const AcceptedGroupCommand& active) noexcept;
    /// The view says it, of a program's command.
    void refused(const AcceptedGroupCommand& accepted, const PathPlace& why) noexcept;
    Submitted take(const GroupCommand& command, Owner owner) noexcept;
    void send_waiting() noexcept;
    [[nodiscard]] bool jogs() const noexcept { return queue_.active().command.kind == GroupCommandKind::jog; }
    /// False: nobody wants it any more, and it is over.
    [[nodiscard]] bool turn_jog() noexcept;
    void go_on_homing() noexcept;
    ErrorId set_limits(const WriteSoftwareLimits& limits, Owner owner) noexcept;
    void tend_jog(Duration period) noexcept;
    ErrorId set_jog(const GroupSetting& setting) noexcept;
    void go_on(Duration period) noexcept;
    void walk_path(Duration period) noexcept;
    [[nodiscard]] bool serve(const PathNote& note, Duration period) noexcept;
    // Of a path that an axis drives.
    [[nodiscard]] bool driven_by(AxisRef axis) const noexcept;
    [[nodiscard]] bool is_driven() const noexcept { return driver().valid(); }
    /// Of the path that is gone, or waits.
    [[nodiscard]] AxisRef driver() const noexcept;
    /// False: the members do not follow it any more.
    [[nodiscard]] bool watch_driven() noexcept;
    void forget_path() noexcept;
    void see_selection() noexcept;
    void watch_reset() noexcept;
    /// The active one, where it is a setting: done.
    void finish_setting() noexcept;
    /// A command is gone with what it took; else what is selected counts.
    [[nodiscard]] bool moves_with_tool() const noexcept { return (members_.led() || interrupted_) && run_.exists() && run_.command() != 0; }
    void publish() noexcept;
    /// Through the arm: once a cycle, and where coordinates have changed.
    void show_tool() noexcept;

    AxisGroupConfig config_;
    const PathShelf* paths_;
    GroupMembers members_;
    GroupQueue queue_;
    PathRun run_;
    GroupTracking tracking_;
    GroupSlaves slaves_;
    JointVector still_{};  // where the members were, had the frame that they follow not moved
    GroupJog jog_;         // while jogs()
    GroupHoming homing_;
    PathDeviationWatch deviation_;
    GroupView view_;  // and its settings: override, dynamics, error, reset
    GroupEquipment equipment_;
    JointVector hold_{};  // where the members stand without a run
    GroupState state_ = GroupState::GroupDisabled;
    bool begun_ = false;           // the active command has begun
    bool interrupted_ = false;     // it stands, and what was under way may go on
    std::uint16_t going_off_ = 0;  // places that are shut down when it stands
    struct {
        double override_factor = 1;
        bool setup = false;               // the machine's mode
        bool holds = false;               // GroupView::held
        bool program_interrupts = false;  // GroupView::program_interrupts: what is left when the hand lets go
    } hand_;
    CommandId lock_ = 0, interrupting_ = 0, disabling_ = 0;
    CommandId sent_ = 0;  // the last one that the planner has
    Duration elapsed_{};  // of the active command
    struct {
        Duration dwelt{};       // of its pause
        bool answered = false;  // its request
    } path_;
};

}  // namespace taktwerk::axes

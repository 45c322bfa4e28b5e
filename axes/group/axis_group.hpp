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
#include "axes/group/group_homing.hpp"
#include "axes/group/group_jog.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_queue.hpp"
#include "axes/group/group_state.hpp"
#include "axes/group/path_run.hpp"

namespace taktwerk::axes {

class AxisGroup {
public:
    /// `config` must have passed check(); `axes` are all axes of the machine and must live longer. `members`: of config.members, by place.
    AxisGroup(AxisGroupConfig config, std::span<Axis> axes, std::span<const AxisRef> members, Duration cycle);

    [[nodiscard]] const AxisGroupConfig& config() const noexcept { return config_; }
    [[nodiscard]] const GroupView& view() const noexcept { return view_; }
    [[nodiscard]] bool contains(AxisRef axis) const noexcept { return members_.contains(axis); }
    /// Its axes follow it now.
    [[nodiscard]] bool leads() const noexcept { return members_.led(); }

    void update(Instant now) noexcept;
    void plan(Instant now, Duration period) noexcept;
    /// The planner's step: service side, beside the cycle; not real-time.
    void service() { run_.service(); }

    // --- the machine's hand ----------------------------------------------------------------------------------------------
    /// As MC_GroupHalt, whoever commands it.
    void halt() noexcept;
    /// Whoever commanded it is gone: halts, forgets what was interrupted or waits, gives up the lock of a stop.
    void let_go() noexcept;
    /// For a member that it leads: halts on the path, and shuts that axis down when it stands (Axis::shut_down).
    void shut_down(AxisRef axis) noexcept;

    // --- requests (GroupAccess, for one group) ----------------------------------------------------------------------------
    Submitted submit(const GroupCommand& command, Owner owner) noexcept;
    ErrorId set(const GroupSetting& setting, Owner owner) noexcept;
    ErrorId reset(Owner owner) noexcept;
    void release_stop(CommandId id) noexcept;

private:
    [[nodiscard]] bool waits(const GroupCommand& command) const noexcept;
    [[nodiscard]] JointVector here() const noexcept;
    [[nodiscard]] ErrorId refuse(const GroupCommand& command, Owner owner) const noexcept;
    [[nodiscard]] ErrorId refuse_state(const GroupCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_way(const GroupCommand& command) const noexcept;
    Submitted take_motion(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_stop(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_interrupt(const GroupCommand& command) noexcept;
    Submitted take_resume(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_home(const GroupCommand& command, Owner owner) noexcept;
    CommandId take_disable() noexcept;
    ErrorId change_members(const GroupSetting& setting) noexcept;
    ErrorId enable() noexcept;

    void fire(GroupEvent event) noexcept;
    void fail(std::uint16_t error) noexcept;
    void abort_all() noexcept;
    void leave(GroupEvent event) noexcept;
    void settle() noexcept;
    /// False: it is over already.
    [[nodiscard]] bool begin_active() noexcept;
    /// None: it can be gone, or not yet. Something: what it is over with.
    [[nodiscard]] std::optional<ErrorId> begin_way(const AcceptedGroupCommand& active) noexcept;
    void send_waiting() noexcept;
    [[nodiscard]] bool jogs() const noexcept { return queue_.active().command.kind == GroupCommandKind::jog; }
    /// False: nobody wants it any more, and it is over.
    [[nodiscard]] bool turn_jog() noexcept;
    void go_on_homing() noexcept;
    ErrorId set_limits(const WriteSoftwareLimits& limits, Owner owner) noexcept;
    void tend_jog(Duration period) noexcept;
    ErrorId set_jog(const GroupSetting& setting) noexcept;
    void go_on(Duration period) noexcept;
    void watch_reset() noexcept;
    void publish() noexcept;

    AxisGroupConfig config_;
    GroupMembers members_;
    GroupQueue queue_;
    PathRun run_;
    GroupJog jog_;  // while jogs()
    GroupHoming homing_;
    GroupView view_;      // and its settings: override, dynamics, error, reset
    JointVector hold_{};  // where the members stand without a run
    GroupState state_ = GroupState::GroupDisabled;
    bool begun_ = false;           // the active command has begun
    bool interrupted_ = false;     // it stands, and what was under way may go on
    std::uint16_t going_off_ = 0;  // places that are shut down when it stands
    CommandId lock_ = 0, interrupting_ = 0, disabling_ = 0;
    CommandId sent_ = 0;  // the last one that the planner has
    Duration elapsed_{};  // of the active command
};

}  // namespace taktwerk::axes

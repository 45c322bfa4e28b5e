#pragma once
// A group on a frame that moves: it joins the frame from rest, follows it, and lets it go again. Real-time safe.
//
// A path in such a frame is planned as if the frame stood where it was when the group joined it: the path stays a path, and its time one number (path_run).
// The frame's way is a second number; what it lacks of its master's runs down beside it. Each cycle puts both together.
// Whatever a member may do is parted in halves: one for the path, one for the frame. Where the arm bends what was planned that may not be enough,
// so each set-point is looked at before it is given; one that would be outside a limit, or beyond a place from which the member could still stop, is
// not: the members brake, each on its own ramp.

#include <array>
#include <memory>
#include <span>

#include "axes/coupling/difference.hpp"
#include "axes/coupling/master_track.hpp"
#include "axes/group/frame_track.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class Kinematics;
struct GroupFrames;
struct ToolMotion;
struct Workspace;

class GroupTracking {
public:
    /// Of what a member can do, what a path in a moving frame may take; the rest is the frame's.
    static constexpr double path_share = 0.5;

    GroupTracking(std::span<Axis> axes, std::shared_ptr<const Kinematics> arm, std::shared_ptr<const Workspace> workspace);
    GroupTracking(GroupTracking&&) noexcept;
    ~GroupTracking();

    /// invalid_axis, no_kinematics, frame_lost, not_supported (a table whose axis has no turn: no modulo; one that turns about what the arm cannot);
    /// else it fills reference and number.
    [[nodiscard]] ErrorId take(FrameTrack& track, const GroupFrames& frames, const GroupMembers& members) noexcept;
    /// Each cycle: where the masters will be when the next set-points act; writes it into the products' frames.
    void watch(GroupFrames& frames, Instant now, Duration period) noexcept;

    /// The group stands at `at` and will go in this frame: its way begins here. False: its master is not there.
    [[nodiscard]] ErrorId prepare(const FrameTrack& track, const GroupMembers& members) noexcept;
    /// Engaged, with no path under way: the next one is planned where the frame is now.
    void plan_anew(const GroupMembers& members) noexcept;
    /// Joins it.
    void engage() noexcept;
    /// Lets it go: the frame's way comes to rest.
    void release() noexcept;
    void clear() noexcept;

    [[nodiscard]] bool active() const noexcept { return phase_ != Phase::off; }
    [[nodiscard]] bool is(const FrameTrack& track) const noexcept { return active() && track == track_; }
    [[nodiscard]] const FrameTrack& track() const noexcept { return track_; }
    /// It will go on with the frame.
    [[nodiscard]] bool follows() const noexcept { return phase_ == Phase::prepared || phase_ == Phase::following; }
    /// It goes with the frame, or comes up to it.
    [[nodiscard]] bool engaged() const noexcept { return phase_ == Phase::following; }
    [[nodiscard]] bool rests() const noexcept { return phase_ == Phase::off || phase_ == Phase::resting; }
    [[nodiscard]] bool in_sync() const noexcept { return phase_ == Phase::following && !fresh_ && difference_.finished(); }
    /// Seen from the machine, as paths in it are planned.
    [[nodiscard]] Pose planned_frame() const noexcept { return planned_; }
    /// What is left to a path: caps of a run.
    [[nodiscard]] JoggingDynamics path_caps(const GroupMembers& members) const noexcept;

    /// One cycle. `still`: the tool's point as it moves on the frame where the path was planned; nullptr: it stands where it stood.
    /// none: of() is the next set-point of each. Else frame_limit: it must not be given, all members have to brake by themselves.
    [[nodiscard]] ErrorId step(const ToolMotion* still, const GroupMembers& members, Duration period) noexcept;
    [[nodiscard]] MotionState of(std::size_t place) const noexcept { return states_[place]; }
    /// The frame cannot be followed any more, and it is let go: frame_lost, frame_too_fast.
    [[nodiscard]] ErrorId fault() const noexcept { return fault_; }
    void publish(GroupView& view) const noexcept;

private:
    enum class Phase : std::uint8_t {
        off,
        prepared,   ///< at rest, where the path is planned
        following,  ///< joins, or is in sync
        leaving,
        resting  ///< at rest, but somewhere else than where the path was planned
    };
    struct Inside;
    [[nodiscard]] bool read(MasterTrack& track, AxisRef master, Instant now, Duration period) const noexcept;
    void follow(double period, Duration cycle) noexcept;
    [[nodiscard]] MotionState come_nearer(const MotionState& goal, Duration cycle) noexcept;
    [[nodiscard]] bool jumps(const MotionState& next, double period) const noexcept;
    void see_room(const GroupMembers& members) noexcept;
    [[nodiscard]] bool in_workspace(const std::array<MotionState, most_members>& next, const GroupMembers& members, double period) noexcept;

    std::span<Axis> axes_;
    std::unique_ptr<Inside> inside_;
    std::array<MotionState, most_members> states_{};
    FrameTrack track_{};
    Pose planned_{};
    Difference difference_;  // of the frame's way from its master's, while it joins
    MasterTrack master_;
    MotionLimits rest_{};  // of the frame's way: half of each member
    Plan leaving_{};
    MotionState way_{};    // of the frame, since the reference
    double begun_at_ = 0;  // of it: where the path is planned
    double feed_ = 1;      // u of the master
    Duration left_{};      // since it was let go
    Phase phase_ = Phase::off;
    ErrorId fault_ = ErrorId::none;
    bool fresh_ = false;
    std::uint32_t serials_ = 0;
};

}  // namespace taktwerk::axes

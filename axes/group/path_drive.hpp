#pragma once
// The length of a path while an axis drives it: one number a cycle, without the path. Real-time safe.
//
// From rest it comes up to the master's velocity, as a gear does: what is lost until then stays lost. From then on it is locked by place: it stops and
// reverses with the master. Where the path ends it stands, exactly, as long as the master is beyond; back inside, it comes to the same place again. Of
// a periodic path the length goes on counting.

#include <optional>
#include <span>

#include "axes/coupling/follower.hpp"
#include "axes/coupling/master_track.hpp"
#include "axes/group/group_command.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/path_driver.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

/// How fast it may be `left` in front of a place that may be passed at `then`, for a ramp of this deceleration and jerk: u/s without acceleration. Beside
/// braking at once a ramp loses v a/2j of way, so that v^2 + v a^2/j = then^2 + 2 a left; at `then` it needs none.
[[nodiscard]] double fastest_in_front_of(double then, double left, const MotionLimits& ramp) noexcept;

/// What the cycle has to know of a path that an axis drives, beside its sections.
struct DrivenPath {
    bool driven = false;
    PathDriver driver{};
    std::uint32_t sections = 0;
    double length = 0;    ///< u
    MotionLimits room{};  ///< what ramps along it may take, wherever they are; the velocity is that of making up
    PathDynamics said{};  ///< what its command says of them; 0: nothing
};

class PathDrive {
public:
    explicit PathDrive(std::span<Axis> axes) noexcept : axes_(axes) {}

    /// Errors: invalid_master (none, a member, one without a position), coupling_loop, invalid_ratio, invalid_parameter (the mode).
    [[nodiscard]] ErrorId refuse(const PathDriver& driver, const GroupMembers& members) const noexcept;

    /// At rest where the path begins.
    void begin(const DrivenPath& path) noexcept;
    void end() noexcept;
    /// Each cycle: where the master will be when the next set-points act.
    void watch(Instant now, Duration period) noexcept;
    void step(Duration period) noexcept;

    /// Comes to rest, at an end of the path at the latest. Deceleration and jerk; 0: what the path leaves.
    void stand(const PathDynamics& ramp) noexcept;
    /// After that: comes up to the master's velocity again.
    void go() noexcept;
    /// The step that was made is taken back, and a ramp to rest made in its place, as hard as the path leaves. False: it was that already.
    /// `why`: where it follows; a ramp that was asked for gets harder without a fault.
    [[nodiscard]] bool brake_instead(ErrorId why, Duration period) noexcept;
    /// It does not brake as hard as the path leaves already.
    [[nodiscard]] bool may_brake() const noexcept { return follows() || (phase_ == Phase::braking && soft_); }

    [[nodiscard]] bool on() const noexcept { return phase_ != Phase::off; }
    [[nodiscard]] bool follows() const noexcept {
        return phase_ == Phase::waiting || phase_ == Phase::following || phase_ == Phase::ending;
    }
    /// At rest after stand().
    [[nodiscard]] bool rests() const noexcept { return phase_ == Phase::resting; }
    /// The length since the path's beginning; laps of a periodic path count.
    [[nodiscard]] const MotionState& state() const noexcept { return state_; }
    /// Of its path, from 0 to its length.
    [[nodiscard]] double place() const noexcept;
    /// The master comes from set-points: its jerk means something.
    [[nodiscard]] bool planned() const noexcept { return planned_; }
    /// Why it has begun to brake by itself: master_lost, path_limit.
    [[nodiscard]] ErrorId fault() const noexcept { return fault_; }
    [[nodiscard]] PathDriverView view() const noexcept { return {on() ? path_.driver.master : AxisRef{}, follows() && in_sync_}; }
    [[nodiscard]] const DrivenPath& path() const noexcept { return path_; }

private:
    enum class Phase : std::uint8_t {
        off,
        waiting,    ///< at rest at an end, or where it stood: until the master leads into the path
        following,  ///< comes up to it, or is locked
        ending,     ///< comes to rest at an end of the path
        braking,    ///< stand()
        resting
    };
    [[nodiscard]] EndlessMotion demand() const noexcept;
    [[nodiscard]] FollowerLimits limits(double demanded) const noexcept;
    [[nodiscard]] MotionState next_of(Follower& follower, Duration period) const noexcept;
    /// The end that could not be stood at any more.
    [[nodiscard]] std::optional<double> end_passed(const MotionState& at) const noexcept;
    void wait(Duration period) noexcept;
    void follow(Duration period) noexcept;
    void run_plan(Duration period) noexcept;
    void plan_to_end(double end, const MotionLimits& ramp) noexcept;

    std::span<Axis> axes_;
    DrivenPath path_{};
    MasterTrack track_;
    std::optional<EndlessMotion> master_;
    std::optional<EndlessPlace> from_;  // of the master; its way counts from there
    double feed_ = 1, fastest_ = 0;     // of the master, u and u/s
    Follower follower_;
    Plan plan_{};
    Duration since_{};
    double offset_ = 0;  // of the length from the master's way, once they are locked
    double period_ = 1;  // s
    MotionState state_{}, before_{};
    Phase phase_ = Phase::off;
    ErrorId fault_ = ErrorId::none;
    bool planned_ = true, in_sync_ = false, locked_ = false;
    bool soft_ = false;     // the ramp of stand() is softer than the path would leave
    bool watched_ = false;  // its master, since it began
};

}  // namespace taktwerk::axes

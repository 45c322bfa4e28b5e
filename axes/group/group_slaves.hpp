#pragma once
// Axes that follow the length of a group's path: MC_SyncAxisToGroup. Real-time safe.
//
//     slave = where it was + numerator / denominator * length gone since
//
// The length is that of all paths together, counted forwards. It is a master as an axis is, and what brings a slave up to it and holds it there is the follower of couplings: it catches up
// with the velocity, and is locked by place from then on. The slave takes the set-points as fed ones: any command of its own ends it.

#include <array>
#include <span>

#include "axes/coupling/follower.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class GroupSlaves {
public:
    static constexpr std::size_t most = GroupView::most_slaves;
    explicit GroupSlaves(std::span<Axis> axes) noexcept : axes_(axes) {}

    /// Errors: invalid_axis (none, or a member), not_supported (a modulo axis, one without set-points, a fifth), invalid_parameter (a ratio of no number),
    /// invalid_dynamics, and what the axis refuses.
    ErrorId take(const FollowPath& wanted, const GroupMembers& members, Owner owner) noexcept;
    /// Once a cycle. `run`: a number of each path; `along`: its s.
    void step(std::uint64_t run, const MotionState& along, Duration period) noexcept;
    void publish(GroupView& view) const noexcept;

private:
    struct One {
        AxisRef axis{};
        CommandId id = 0;
        Follower follower;
        EndlessMotion given{};  // its last set-point; what is superimposed comes on top
    };
    std::span<Axis> axes_;
    std::array<One, most> slaves_{};
    EndlessMotion gone_{};
    std::uint64_t run_ = 0;
    double s_ = 0;
};

}  // namespace taktwerk::axes

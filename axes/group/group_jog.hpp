#pragma once
// Who holds a group's jog, and which way: what the group asks in each cycle while one is active. The jog itself is a straight path (jog_shape.hpp), its
// end a halt on that path; another direction is another path, from where the first one has come to rest. Real-time safe.

#include <optional>

#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class GroupMembers;
struct ArmFacts;

/// Of what a direction is asked.
struct JogGround {
    MC_CoordSystem frame = mcACS;
    const JoggingDynamics& dynamics;
    const GroupMembers& members;
    const ArmFacts& arm;
};

class GroupJog {
public:
    /// A direction that is away from the one that is gone by no more than this (rad) does not stop it: a hand on a stick is not still.
    static constexpr double steady = 0.05;

    /// Within that.
    [[nodiscard]] static bool same_way(const JointVector& a, const JointVector& b) noexcept;

    /// Errors: invalid_parameter (a direction that is none, beyond -1..1, of a slot without a member; a negative reach; ACS of a vector), invalid_velocity
    /// (there are no jogging dynamics for it: nothing moves faster than somebody has said), invalid_override.
    [[nodiscard]] static ErrorId refuse(const GroupCommand& command, const JogGround& ground) noexcept;
    /// Of another direction the same is asked as of the first one; 0 lets go, and is never refused.
    [[nodiscard]] static ErrorId refuse(const HoldJog& held, const JogGround& ground) noexcept;

    /// It is pressed: `lease` from now on, and by these dynamics until it is over.
    void press(const GroupCommand& command, Duration lease, const JoggingDynamics& dynamics) noexcept;
    void hold(const HoldJog& held) noexcept;
    void pass(Duration period) noexcept { silent_ += period; }

    /// Nobody holds it any more.
    [[nodiscard]] bool expired() const noexcept { return silent_ > lease_; }
    /// It is to stop, for good or for another direction.
    [[nodiscard]] bool stops() const noexcept;
    /// It is to stop for good.
    [[nodiscard]] bool released() const noexcept;
    /// What is on the way, once at rest, to be gone next; `here`: where the members stand. `direction` becomes the one to be gone.
    void turn(JointVector& direction, const JointVector& here) noexcept;
    /// So much of its path is behind it: at rest, before it is asked to go on.
    void went(double way) noexcept { way_ += way; }
    /// Since it was pressed in this direction.
    [[nodiscard]] double way() const noexcept { return way_; }
    [[nodiscard]] const JointVector& pressed_at() const noexcept { return pressed_at_; }
    [[nodiscard]] const JoggingDynamics& dynamics() const noexcept { return dynamics_; }

    /// With the group's own.
    [[nodiscard]] Override factors(const Override& of_group) const noexcept;

private:
    HoldJog held_{};
    JoggingDynamics dynamics_{};
    JointVector gone_{};        // the direction that is on the way
    JointVector pressed_at_{};  // where the members were when that began first
    double way_ = 0;
    bool begun_ = false;
    Duration silent_{}, lease_{};
};

/// Above 0 is written, the others stay. Errors, with nothing written: invalid_velocity, invalid_dynamics (not finite).
[[nodiscard]] ErrorId write_jogging(const JoggingDynamics& wanted, JoggingDynamics& kept) noexcept;

/// A person's: each member as fast as the mode of the machine lets it, the tool's point at `tool_velocity` [u/s]; accelerations are left to the limits.
[[nodiscard]] JoggingDynamics dynamics_by_hand(const GroupMembers& members, double tool_velocity) noexcept;

/// The shortest patience of the members with a jog that nobody renews.
[[nodiscard]] Duration jog_lease_of(const GroupMembers& members) noexcept;

}  // namespace taktwerk::axes

#pragma once
// MC_GroupHome: the members are homed one after the other, in the order of their identifiers, each by its own MC_Home. Real-time safe.

#include <cstdint>

#include "axes/group/group_command.hpp"
#include "axes/group/group_members.hpp"

namespace taktwerk::axes {

class GroupHoming {
public:
    /// `coordinates`: by place, of each reference. Nothing has moved yet.
    void begin(const GroupCommand& command, Owner owner) noexcept;

    struct Answer {
        bool over = false;
        Outcome outcome = Outcome::done;
        ErrorId error = ErrorId::none;
    };
    /// Once a cycle: starts the next member, or looks at the one that is under way.
    [[nodiscard]] Answer step(GroupMembers& members) noexcept;
    /// The member under way stops by its own ramp; those behind it are not homed.
    void stop(GroupMembers& members) noexcept;
    /// The member that is homed, or stopped, has not come to rest.
    [[nodiscard]] bool moves(const GroupMembers& members) const noexcept;

private:
    JointVector coordinates_{};
    const void* instance_ = nullptr;
    Owner owner_ = Owner::none;
    std::size_t place_ = most_members;  // whose turn it is
    CommandId id_ = 0;                  // of that axis; 0: not begun
};

}  // namespace taktwerk::axes

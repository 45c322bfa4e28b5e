#pragma once
// Positions and velocities of a group in any frame, asked for by who moves nothing. Pure, real-time safe; without Eigen.

#include "axes/group/group_equipment.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class Kinematics;

/// A position of the group: of its axes, or of its tool's point with the way in which the arm reaches it.
struct GroupPlace {
    JointVector axes{};           ///< by place
    SixNumbers six{};             ///< in the frame asked about
    Configuration configuration;  ///< as found; of what is asked for: as wanted
};

struct PlaceQuestion {
    MC_CoordSystem from = mcACS, to = mcACS;
    GroupPlace place;
};

struct PlaceAnswer {
    ErrorId error = ErrorId::none;
    GroupPlace place;
    bool singular = false;  ///< nearer to a singularity than a path may come
};

/// With frames and tool of a command that were given now; TCS is the selected tool at the set positions. Where the place does not say how the arm stands:
/// as near to the set positions as can be. Errors: no_kinematics, not_supported (FCS), invalid_parameter (no such frame), invalid_position,
/// out_of_reach, beyond_software_limit (of the joint).
[[nodiscard]] PlaceAnswer transformed(const PlaceQuestion& question, const GroupView& view, const GroupEquipment& equipment,
                                      const Kinematics* arm) noexcept;

/// Of the active tool's point, seen from where `frame` is now; in ACS of the members. Errors: as above; not_supported of a position in TCS, which is
/// always 0.
[[nodiscard]] PlaceAnswer position_in(MC_CoordSystem frame, MC_Source source, const GroupView& view, const GroupEquipment& equipment,
                                      const Kinematics* arm) noexcept;

struct SixAnswer {
    ErrorId error = ErrorId::none;
    SixNumbers six{};
};
/// Likewise, in the directions of the frame: u/s, and rad/s about them. mcCommandedValue: not_supported.
[[nodiscard]] SixAnswer velocity_in(MC_CoordSystem frame, MC_Source source, const GroupView& view,
                                    const GroupEquipment& equipment) noexcept;

/// Where the members are to be said to be, by place. Errors as of transformed().
[[nodiscard]] PlaceAnswer members_for(const SetGroupPosition& wanted, const GroupView& view, const GroupEquipment& equipment,
                                      const Kinematics* arm) noexcept;

}  // namespace taktwerk::axes

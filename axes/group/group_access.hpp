#pragma once
// How programs and blocks reach groups: MotionContext::groups. Every function answers at once and is real-time safe.

#include "axes/group/group_equipment.hpp"
#include "axes/group/group_places.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class GroupAccess {
public:
    /// nullptr for an invalid handle: blocks answer with ErrorId::invalid_group.
    [[nodiscard]] virtual const GroupView* view(GroupRef group) const noexcept = 0;
    virtual Submitted submit(GroupRef group, const GroupCommand& command, Owner owner) noexcept = 0;
    virtual ErrorId set(GroupRef group, const GroupSetting& setting, Owner owner) noexcept = 0;
    /// Outside GroupErrorStop: none, and nothing happens. In it: see GroupView::resetting.
    virtual ErrorId reset(GroupRef group, Owner owner) noexcept = 0;
    /// MC_GroupStop's Execute fell.
    virtual void release_stop(GroupRef group, CommandId id, Owner owner) noexcept = 0;
    /// Frames, tools, loads, arm; nullptr as view().
    [[nodiscard]] virtual const GroupEquipment* equipment(GroupRef group) const noexcept = 0;
    /// group_places.hpp; invalid_group.
    [[nodiscard]] virtual PlaceAnswer transformed(GroupRef group, const PlaceQuestion& question) const noexcept = 0;
    [[nodiscard]] virtual PlaceAnswer position_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept = 0;
    [[nodiscard]] virtual SixAnswer velocity_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept = 0;
    /// Of which group the axis is a member; invalid: of none.
    [[nodiscard]] virtual GroupRef group_of(AxisRef axis) const noexcept = 0;
    /// Prepares a stored path for this group, MC_PathSelect: path() says what became of the ticket. Errors: invalid_parameter, path_in_use, no_kinematics,
    /// queue_full.
    virtual Submitted select(GroupRef group, PathRef path, const PathOptions& options) noexcept = 0;
    /// nullptr: the machine has no such path.
    [[nodiscard]] virtual const PathState* path(PathRef path) const noexcept = 0;
    /// Of the path that the group is on: the request of this number (PathView) is done.
    virtual ErrorId acknowledge(GroupRef group, std::uint32_t request, Owner owner) noexcept = 0;

protected:
    ~GroupAccess() = default;
};

}  // namespace taktwerk::axes

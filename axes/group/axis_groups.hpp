#pragma once
// All groups of a machine: their part of a cycle, and the way of the base task's programs to them.

#include <memory>
#include <span>
#include <vector>

#include "axes/group/axis_group.hpp"
#include "axes/group/group_access.hpp"
#include "axes/group/path_shelf.hpp"

namespace taktwerk::axes {

class AxisGroups final : public GroupAccess {
public:
    AxisGroups() = default;
    /// Not real-time; `axes` are all axes of the machine and must live longer.
    void build(const std::vector<AxisGroupConfig>& configs, std::span<Axis> axes, Duration cycle,
               std::vector<std::unique_ptr<PathMaker>> paths = {});

    /// After the axes' update() and supervise().
    void update(Instant now) noexcept {
        if (paths_) paths_->take_answers();
        for (auto& group : groups_) group.update(now);
    }
    /// Before the axes' plan().
    void plan(Instant now, Duration period) noexcept {
        for (auto& group : groups_) group.plan(now, period);
    }
    /// The planners' steps: service side, one thread beside the cycle; not real-time.
    void service() {
        if (paths_) paths_->service();
        for (auto& group : groups_) group.service();
    }
    [[nodiscard]] std::size_t size() const noexcept { return groups_.size(); }
    [[nodiscard]] AxisGroup& operator[](std::size_t i) noexcept { return groups_[i]; }
    [[nodiscard]] const AxisGroup& operator[](std::size_t i) const noexcept { return groups_[i]; }
    /// The group that moves this axis now; nullptr: none does.
    [[nodiscard]] AxisGroup* leader_of(AxisRef axis) noexcept;

    [[nodiscard]] const GroupView* view(GroupRef group) const noexcept override;
    Submitted submit(GroupRef group, const GroupCommand& command, Owner owner) noexcept override;
    ErrorId set(GroupRef group, const GroupSetting& setting, Owner owner) noexcept override;
    ErrorId reset(GroupRef group, Owner owner) noexcept override;
    void release_stop(GroupRef group, CommandId id, Owner owner) noexcept override;
    [[nodiscard]] const GroupEquipment* equipment(GroupRef group) const noexcept override;
    [[nodiscard]] PlaceAnswer transformed(GroupRef group, const PlaceQuestion& question) const noexcept override;
    [[nodiscard]] PlaceAnswer position_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept override;
    [[nodiscard]] SixAnswer velocity_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept override;
    [[nodiscard]] GroupRef group_of(AxisRef axis) const noexcept override;
    Submitted select(GroupRef group, PathRef path, const PathOptions& options) noexcept override;
    [[nodiscard]] const PathState* path(PathRef path) const noexcept override { return paths_ ? paths_->state(path) : nullptr; }
    ErrorId acknowledge(GroupRef group, std::uint32_t request, Owner owner) noexcept override;

private:
    [[nodiscard]] AxisGroup* find(GroupRef group) noexcept { return group.index < groups_.size() ? &groups_[group.index] : nullptr; }
    std::unique_ptr<PathShelf> paths_;  // nullptr: none are stored
    std::vector<AxisGroup> groups_;
};

}  // namespace taktwerk::axes

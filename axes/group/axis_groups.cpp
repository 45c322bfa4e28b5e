#include "axes/group/axis_groups.hpp"

namespace taktwerk::axes {

void AxisGroups::build(const std::vector<AxisGroupConfig>& configs, std::span<Axis> axes, Duration cycle) {
    groups_.reserve(configs.size());
    for (const auto& config : configs) {
        std::vector<AxisRef> members;
        for (const auto& name : config.members)
            for (std::size_t i = 0; i < axes.size(); ++i)
                if (axes[i].config().name == name) members.push_back({static_cast<std::uint16_t>(i)});
        groups_.emplace_back(config, axes, members, cycle);
    }
}

AxisGroup* AxisGroups::leader_of(AxisRef axis) noexcept {
    for (auto& group : groups_)
        if (group.leads() && group.contains(axis)) return &group;
    return nullptr;
}

const GroupView* AxisGroups::view(GroupRef group) const noexcept {
    return group.index < groups_.size() ? &groups_[group.index].view() : nullptr;
}

Submitted AxisGroups::submit(GroupRef group, const GroupCommand& command, Owner owner) noexcept {
    auto* found = find(group);
    return found ? found->submit(command, owner) : Submitted{0, ErrorId::invalid_group};
}

ErrorId AxisGroups::set(GroupRef group, const GroupSetting& setting, Owner owner) noexcept {
    auto* found = find(group);
    if (!found) return ErrorId::invalid_group;
    if (const auto* added = std::get_if<AddMember>(&setting))
        if (const auto other = group_of(added->axis); other.valid() && other != group) return ErrorId::invalid_member;
    return found->set(setting, owner);
}

ErrorId AxisGroups::reset(GroupRef group, Owner owner) noexcept {
    auto* found = find(group);
    return found ? found->reset(owner) : ErrorId::invalid_group;
}

void AxisGroups::release_stop(GroupRef group, CommandId id, Owner) noexcept {
    if (auto* found = find(group)) found->release_stop(id);
}

const GroupEquipment* AxisGroups::equipment(GroupRef group) const noexcept {
    return group.index < groups_.size() ? &groups_[group.index].equipment() : nullptr;
}

PlaceAnswer AxisGroups::transformed(GroupRef group, const PlaceQuestion& question) const noexcept {
    if (group.index >= groups_.size()) return {ErrorId::invalid_group, {}, false};
    const auto& found = groups_[group.index];
    return axes::transformed(question, found.view(), found.equipment(), found.config().kinematics.get());
}

PlaceAnswer AxisGroups::position_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept {
    if (group.index >= groups_.size()) return {ErrorId::invalid_group, {}, false};
    const auto& found = groups_[group.index];
    return axes::position_in(frame, source, found.view(), found.equipment(), found.config().kinematics.get());
}

SixAnswer AxisGroups::velocity_in(GroupRef group, MC_CoordSystem frame, MC_Source source) const noexcept {
    if (group.index >= groups_.size()) return {ErrorId::invalid_group, {}};
    return axes::velocity_in(frame, source, groups_[group.index].view(), groups_[group.index].equipment());
}

GroupRef AxisGroups::group_of(AxisRef axis) const noexcept {
    for (std::size_t i = 0; i < groups_.size(); ++i)
        if (groups_[i].contains(axis)) return {static_cast<std::uint16_t>(i)};
    return {};
}

}  // namespace taktwerk::axes

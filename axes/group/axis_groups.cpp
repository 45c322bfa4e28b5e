#include "axes/group/axis_groups.hpp"

namespace taktwerk::axes {

void AxisGroups::build(const std::vector<AxisGroupConfig>& configs, std::span<Axis> axes, Duration cycle,
                       std::vector<std::unique_ptr<PathMaker>> paths) {
    if (!paths.empty()) paths_ = std::make_unique<PathShelf>();
    for (auto& maker : paths) paths_->add(std::move(maker));
    groups_.reserve(configs.size());
    for (const auto& config : configs) {
        std::vector<AxisRef> members;
        for (const auto& name : config.members)
            for (std::size_t i = 0; i < axes.size(); ++i)
                if (axes[i].config().name == name) members.push_back({static_cast<std::uint16_t>(i)});
        groups_.emplace_back(config, axes, members, cycle, paths_.get());
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
    if (const auto* follow = std::get_if<FollowPath>(&setting))
        if (const auto* of = view(group_of(follow->slave)); of != nullptr && of->held) return ErrorId::held_by_person;
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

Submitted AxisGroups::select(GroupRef group, PathRef path, const PathOptions& options) noexcept {
    auto* found = find(group);
    if (!found) return {0, ErrorId::invalid_group};
    if (!paths_ || paths_->state(path) == nullptr || options.start_line == 0) return {0, ErrorId::invalid_parameter};
    for (const auto& other : groups_)
        if (other.uses(path)) return {0, ErrorId::path_in_use};
    const auto& view = found->view();
    const auto& tool = view.tool_set;
    if (!view.tool_known) return {0, ErrorId::no_kinematics};
    const auto ticket = paths_->select(path, options, {tool[0], tool[1], tool[2]}, found->config().millimetre);
    if (ticket != 0) found->selected(path);
    return {ticket, ticket != 0 ? ErrorId::none : ErrorId::queue_full};
}

ErrorId AxisGroups::acknowledge(GroupRef group, std::uint32_t request, Owner owner) noexcept {
    auto* found = find(group);
    return found ? found->acknowledge(request, owner) : ErrorId::invalid_group;
}

GroupRef AxisGroups::group_of(AxisRef axis) const noexcept {
    for (std::size_t i = 0; i < groups_.size(); ++i)
        if (groups_[i].contains(axis)) return {static_cast<std::uint16_t>(i)};
    return {};
}

}  // namespace taktwerk::axes

#pragma once
// Groups of axes as one program's base tasks see them: what it moves is noted of the members, so that a program that ends takes the motion of
// its groups with it. Real-time safe.

#include <cstdint>
#include <span>
#include <variant>

#include "runtime/tasks/program_requests.hpp"
#include "runtime/tasks/watched_groups.hpp"

namespace taktwerk::runtime {

class ProgramGroups final : public axes::GroupAccess {
public:
    ProgramGroups(WatchedGroups& watched, std::span<AxisClaims> claims, std::uint16_t program) noexcept
        : watched_(watched), groups_(watched.groups()), claims_(claims), program_(program) {}

    [[nodiscard]] const axes::GroupView* view(axes::GroupRef group) const noexcept override { return groups_.view(group); }
    axes::Submitted submit(axes::GroupRef group, const axes::GroupCommand& command, axes::Owner owner) noexcept override {
        const auto answer = watched_.submit(group, command, owner, program_);
        if (answer.error == axes::ErrorId::none && !axes::is_administrative(command.kind))
            for (const auto axis : groups_.view(group)->members)
                if (axis.valid()) claims_[axis.index].motion = program_;
        return answer;
    }
    axes::ErrorId set(axes::GroupRef group, const axes::GroupSetting& setting, axes::Owner owner) noexcept override {
        const auto error = groups_.set(group, setting, owner);
        const auto* follow = std::get_if<axes::FollowPath>(&setting);  // who couples an axis moves it
        if (error == axes::ErrorId::none && follow != nullptr) claims_[follow->slave.index].motion = program_;
        return error;
    }
    axes::ErrorId reset(axes::GroupRef group, axes::Owner owner) noexcept override { return groups_.reset(group, owner); }
    void release_stop(axes::GroupRef group, axes::CommandId id, axes::Owner owner) noexcept override {
        groups_.release_stop(group, id, owner);
    }
    [[nodiscard]] const axes::GroupEquipment* equipment(axes::GroupRef group) const noexcept override { return groups_.equipment(group); }
    [[nodiscard]] axes::PlaceAnswer transformed(axes::GroupRef group, const axes::PlaceQuestion& question) const noexcept override {
        return groups_.transformed(group, question);
    }
    [[nodiscard]] axes::PlaceAnswer position_in(axes::GroupRef group, axes::MC_CoordSystem frame,
                                                axes::MC_Source source) const noexcept override {
        return groups_.position_in(group, frame, source);
    }
    [[nodiscard]] axes::SixAnswer velocity_in(axes::GroupRef group, axes::MC_CoordSystem frame,
                                              axes::MC_Source source) const noexcept override {
        return groups_.velocity_in(group, frame, source);
    }
    axes::Submitted select(axes::GroupRef group, axes::PathRef path, const axes::PathOptions& options) noexcept override {
        return groups_.select(group, path, options);
    }
    [[nodiscard]] const axes::PathState* path(axes::PathRef path) const noexcept override { return groups_.path(path); }
    axes::ErrorId acknowledge(axes::GroupRef group, std::uint32_t request, axes::Owner owner) noexcept override {
        return groups_.acknowledge(group, request, owner);
    }
    [[nodiscard]] axes::GroupRef group_of(axes::AxisRef axis) const noexcept override { return groups_.group_of(axis); }

private:
    WatchedGroups& watched_;
    axes::AxisGroups& groups_;
    std::span<AxisClaims> claims_;
    std::uint16_t program_;
};

}  // namespace taktwerk::runtime

#include "axes/group/group_members.hpp"

#include <algorithm>

namespace taktwerk::axes {

ErrorId GroupMembers::add(AxisRef axis, std::uint8_t ident) noexcept {
    if (axis.index >= axes_.size()) return ErrorId::invalid_axis;
    if (ident < 1 || ident > most_members || has(ident - 1u) || contains(axis)) return ErrorId::invalid_member;
    const auto& config = axes_[axis.index].config();
    if (config.encoder || config.modulo > 0 || count() == most_moved_members) return ErrorId::not_supported;
    members_[ident - 1u] = axis;
    return ErrorId::none;
}

ErrorId GroupMembers::remove(std::uint8_t ident) noexcept {
    if (ident < 1 || ident > most_members || !has(ident - 1u)) return ErrorId::invalid_member;
    members_[ident - 1u] = {};
    return ErrorId::none;
}

std::size_t GroupMembers::count() const noexcept {
    return static_cast<std::size_t>(std::count_if(members_.begin(), members_.end(), [](AxisRef axis) { return axis.valid(); }));
}

bool GroupMembers::contains(AxisRef axis) const noexcept {
    return axis.valid() && std::find(members_.begin(), members_.end(), axis) != members_.end();
}

ErrorId GroupMembers::refuse(Owner owner) noexcept {
    for (std::size_t i = 0; i < most_members; ++i)
        if (has(i))
            if (const auto error = axis(i).refuses_group(owner); error != ErrorId::none) return error;
    return ErrorId::none;
}

bool GroupMembers::owned_by_other(Owner owner) const noexcept {
    for (std::size_t i = 0; i < most_members; ++i)
        if (has(i) && axis(i).view().owner != Owner::none && axis(i).view().owner != owner) return true;
    return false;
}

ErrorId GroupMembers::join(const void* instance, Owner owner) noexcept {
    if (const auto error = refuse(owner); error != ErrorId::none) return error;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!has(i)) continue;
        const auto taken = axis(i).join_group(instance, owner);
        if (taken.error != ErrorId::none) {
            leave();
            return taken.error;
        }
        joined_[i] = taken.id;
    }
    return ErrorId::none;
}

void GroupMembers::leave() noexcept {
    for (std::size_t i = 0; i < most_members; ++i)
        if (joined_[i] != 0) axis(i).leave_group();
    joined_ = {};
}

void GroupMembers::path_driven_by(AxisRef driver) noexcept {
    if (driver == driver_) return;
    driver_ = driver;
    for (std::size_t i = 0; i < most_members; ++i)
        if (has(i)) axis(i).path_driven_by(driver);
}

bool GroupMembers::led() const noexcept {
    return std::any_of(joined_.begin(), joined_.end(), [](CommandId id) { return id != 0; });
}

GroupMembers::Loss GroupMembers::lost() noexcept {
    Loss loss;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (joined_[i] == 0) continue;
        const auto& view = axis(i).view();
        if (view.active == joined_[i]) continue;
        joined_[i] = 0;
        const Loss own{true, view.state == AxisState::ErrorStop ? view.error : std::uint16_t{0}, static_cast<std::uint8_t>(i)};
        if (!loss.any) loss = own;
        else if (own.error == loss.error) loss.place = most_members;  // what stops several at once (an emergency stop) is none of theirs
    }
    return loss;
}

GroupMembers::Loss GroupMembers::error_of_any() const noexcept {
    Loss first;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!has(i) || axis(i).view().state != AxisState::ErrorStop) continue;
        const auto error = std::max(axis(i).view().error, std::uint16_t{1});
        if (first.error == 0) first = {false, error, static_cast<std::uint8_t>(i)};
        else if (error == first.error) first.place = most_members;
    }
    return first;
}

JointVector GroupMembers::set_positions() const noexcept {
    JointVector positions{};
    for (std::size_t i = 0; i < most_members; ++i)
        if (has(i)) positions[i] = axis(i).view().set_position;
    return positions;
}

}  // namespace taktwerk::axes

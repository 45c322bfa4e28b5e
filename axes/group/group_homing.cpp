#include "axes/group/group_homing.hpp"

namespace taktwerk::axes {

void GroupHoming::begin(const GroupCommand& command, Owner owner) noexcept {
    coordinates_ = command.target;
    instance_ = command.instance;
    owner_ = owner;
    place_ = 0;
    id_ = 0;
}

GroupHoming::Answer GroupHoming::step(GroupMembers& members) noexcept {
    if (id_ != 0) {
        ErrorId error = ErrorId::none;
        switch (members.axis(place_).view().status(id_, &error)) {
            case CommandStatus::queued:
            case CommandStatus::active:
            case CommandStatus::in_target: return {};
            case CommandStatus::done: break;
            case CommandStatus::error: return {true, Outcome::error, error != ErrorId::none ? error : ErrorId::homing_failed};
            case CommandStatus::aborted:
            case CommandStatus::unknown: return {true, Outcome::aborted, ErrorId::none};
        }
        id_ = 0;
        ++place_;
    }
    while (place_ < most_members && !members.has(place_)) ++place_;
    if (place_ >= most_members) return {true, Outcome::done, ErrorId::none};
    const auto answer =
        members.axis(place_).submit({.kind = CommandKind::home, .position = coordinates_[place_], .instance = instance_}, owner_);
    id_ = answer.id;
    return answer.error != ErrorId::none ? Answer{true, Outcome::error, answer.error} : Answer{};
}

void GroupHoming::stop(GroupMembers& members) noexcept {
    if (id_ == 0 || !members.has(place_)) return;
    auto& axis = members.axis(place_);
    if (axis.view().status(id_) != CommandStatus::active) return;
    // Held for no longer than it takes: the axis leaves Stopping by itself once it stands.
    const auto answer = axis.submit({.kind = CommandKind::stop, .instance = instance_}, owner_);
    if (answer.error == ErrorId::none) axis.release_stop(answer.id, owner_);
}

bool GroupHoming::moves(const GroupMembers& members) const noexcept {
    if (place_ >= most_members || !members.has(place_)) return false;
    const auto state = members.axis(place_).view().state;
    return state == AxisState::Homing || state == AxisState::Stopping;
}

}  // namespace taktwerk::axes

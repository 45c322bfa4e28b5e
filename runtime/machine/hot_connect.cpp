#include "runtime/machine/hot_connect.hpp"

#include "runtime/group_presence.hpp"

namespace taktwerk::runtime {

namespace {

/// The bus needs so long at most to tell a group that was taken away from frames that are lost.
constexpr Duration until_known = std::chrono::milliseconds{500};

}  // namespace

HotConnect::HotConnect(MachineBody& body, const MachineDrives& drives)
    : body_(body), names_(group_names(body.bus_config)), pulled_(names_.size()) {
    for (std::size_t axis = 0; axis < body.config.axes.size(); ++axis)
        if (drives.on_bus(axis))
            if (const int group = group_index(body.bus, body.bus.slave(drives.slave_of(axis)).hot_connect); group >= 0)
                members_.push_back({axis, group});
    for (const auto& member : members_) (void)body.axes[member.axis].connect(axes::Presence::absent, 0);
}

void HotConnect::step() noexcept {
    for (auto& member : members_) {
        auto& axis = body_.axes[member.axis];
        if (axis.view().online) member.online = body_.now;
        if (!axis.connect(presence_of(body_.bus, member.group), id(MachineAlarm::group_pulled))) continue;
        auto& pulled = pulled_[static_cast<std::size_t>(member.group)];
        if (pulled.axes++ == 0) pulled.axis = static_cast<std::uint16_t>(member.axis);
    }
}

void HotConnect::watch() noexcept {
    for (std::size_t group = 0; group < pulled_.size(); ++group) {
        auto& pulled = pulled_[group];
        if (pulled.axes > 0)
            body_.raise(MachineAlarm::group_pulled, AlarmSource::axis, pulled.axis, static_cast<double>(group), pulled.axes);
        pulled = {};
    }
}

const HotConnect::Member* HotConnect::find(std::size_t axis) const noexcept {
    for (const auto& member : members_)
        if (member.axis == axis) return &member;
    return nullptr;
}

bool HotConnect::speaks_for(std::size_t axis) const noexcept {
    const auto* member = find(axis);
    return member != nullptr && (!connected(body_.views[axis].presence) || body_.now - member->online < until_known);
}

std::string_view HotConnect::group_of(std::size_t axis) const noexcept {
    const auto* member = find(axis);
    return member != nullptr ? std::string_view(names_[static_cast<std::size_t>(member->group)]) : std::string_view{};
}

}  // namespace taktwerk::runtime

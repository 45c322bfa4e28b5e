#include "runtime/group_presence.hpp"

namespace taktwerk::runtime {

std::vector<std::string> group_names(const ecat::BusConfig& bus) {
    std::vector<std::string> names;
    for (const auto& group : ecat::hot_connect_groups(bus)) names.push_back(group.name);
    return names;
}

int group_index(const ecat::Master& bus, std::string_view name) noexcept {
    const auto groups = bus.groups();
    for (std::size_t i = 0; i < groups.size(); ++i)
        if (groups[i].name == name) return static_cast<int>(i);
    return -1;
}

axes::Presence presence_of(const ecat::Master& bus, int group) noexcept {
    if (group < 0) return axes::Presence::always;
    switch (bus.group_presence(static_cast<std::size_t>(group))) {
        case ecat::GroupPresence::absent: break;
        case ecat::GroupPresence::joining: return axes::Presence::joining;
        case ecat::GroupPresence::present: return axes::Presence::present;
    }
    return axes::Presence::absent;
}

}  // namespace taktwerk::runtime

#include "ecat/bringup/guests.hpp"

#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::ecat {

bool is_head(const SlaveConfig& head, const FoundSlave& found) noexcept {
    if (found.error) return false;
    return head.alias ? found.alias == *head.alias : head.device_id && found.device_id == head.device_id;
}

std::vector<std::optional<std::size_t>> guests_among(const BusConfig& config, const std::vector<FoundSlave>& found) {
    std::vector<std::optional<std::size_t>> guest(found.size());
    for (const auto& group : hot_connect_groups(config))
        for (std::size_t at = 0; at < found.size(); ++at) {
            if (!is_head(config.slaves[group.slaves.front()], found[at])) continue;
            guest[at] = group.slaves.front();
            for (std::size_t n = 1; n < group.slaves.size() && at + n < found.size(); ++n) {
                if (found[at + n].error || !check_identity({}, config.slaves[group.slaves[n]], found[at + n].identity)) break;
                guest[at + n] = group.slaves[n];
            }
        }
    return guest;
}

WithoutGuests without_guests(const BusConfig& config, const std::vector<FoundSlave>& found) {
    WithoutGuests rest;
    rest.config = config;
    std::erase_if(rest.config.slaves, [](const SlaveConfig& slave) { return slave.guest(); });
    const auto guest = guests_among(config, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (guest[i]) continue;
        rest.place.push_back(found[i].position);
        rest.found.push_back(found[i]);
        rest.found.back().position = static_cast<std::uint16_t>(rest.found.size() - 1);
    }
    return rest;
}

}  // namespace taktwerk::ecat

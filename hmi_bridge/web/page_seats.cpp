#include "hmi_bridge/web/page_seats.hpp"

#include <map>

namespace taktwerk::hmi::web {

std::optional<std::size_t> who_gives_way(std::span<const Seat> seats, const std::string& user, Role role) {
    std::map<std::string, std::size_t> pages;
    for (const auto& seat : seats) ++pages[seat.user];
    const auto own = pages[user];
    std::size_t most = own + 1;  // that many may stay
    for (const auto& one : pages)
        if (one.second > most) most = one.second;
    std::optional<std::size_t> found;
    const auto look = [&](auto may_go) {
        for (std::size_t i = 0; i < seats.size(); ++i)
            if (may_go(seats[i]) && (!found || seats[i].used < seats[*found].used)) found = i;
    };
    if (most > own + 1) look([&](const Seat& seat) { return pages[seat.user] == most; });
    else look([&](const Seat& seat) { return static_cast<int>(seat.role) < static_cast<int>(role); });
    return found;
}

}  // namespace taktwerk::hmi::web

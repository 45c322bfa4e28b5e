#pragma once
// Who gives his place up when all pages are open and one more comes: nobody keeps everybody else out. A rule without connections. Not real-time.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "core/time.hpp"
#include "hmi_bridge/web/roles.hpp"

namespace taktwerk::hmi::web {

struct Seat {
    std::string user;
    Role role = Role::viewer;
    Instant used{};  ///< when the page last commanded something, or came
};

/// The index of the seat that is given to `user`: of who has the most pages, if those are at least two more than the user's own; else of somebody who may
/// less. In either case the one unused the longest. Nothing: nobody's. A page that is put out and comes again puts nobody out.
[[nodiscard]] std::optional<std::size_t> who_gives_way(std::span<const Seat> seats, const std::string& user, Role role);

}  // namespace taktwerk::hmi::web

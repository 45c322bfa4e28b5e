#pragma once
// What a page is told first, and again when something of it has changed (../README.md). Included by web_server.cpp alone.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/server/site.hpp"

namespace taktwerk::hmi::web {

/// `feed`: the machine that the page watches, null: none. `role`: nothing, where people log in and nobody has.
inline std::string hello_text(const Site& site, const Feed* feed, std::optional<Role> role, const std::string& user) {
    auto may_give = Json::array();
    for (const auto& rule : command_rules)
        if (role && may(*role, rule)) may_give.push_back(rule.command);
    const Json known{{"type", "hello"},
                     {"protocol", 1},
                     {"version", site.options.version},
                     {"role", role ? word(*role) : std::string_view{}},
                     {"user", user},
                     {"login", site.accounts.needed()},
                     {"may", std::move(may_give)},
                     {"machines", role ? site.feeds.list() : Json::array()},
                     {"machine", feed != nullptr ? feed->name() : std::string{}},
                     {"source", feed != nullptr ? feed->source() : std::string_view{}},
                     {"why_not_lcm", feed != nullptr ? feed->why_not_lcm() : std::string{}}};
    auto text = text_of(known);
    text.pop_back();
    return text + ",\"layout\":" + (feed != nullptr ? feed->layout() : std::string("null")) + "}";
}

/// Instead of values, while there are no new ones.
inline std::string stale_text(const Feed& feed, Instant at) {
    return text_of(Json{{"type", "stale"},
                        {"machine", feed.name()},
                        {"age_ms", feed.fresh() == Instant{} ? Json{} : Json((at - feed.fresh()) / 1ms)},
                        {"why", feed.why()}});
}

/// A message that could not be read, or none that may be said; `id` where one stood in it.
inline std::string error_text(std::optional<std::int64_t> id, const Error& error) {
    return text_of(Json{{"type", "error"}, {"id", id ? Json(*id) : Json{}}, {"error", error_json(error)}});
}

inline Error log_in_first() { return Error{"web.login", "", "nobody has logged in at this page", "Log in."}; }

}  // namespace taktwerk::hmi::web

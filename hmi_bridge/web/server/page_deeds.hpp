#pragma once
// What a page has commanded, for the audit. Included by web_server.cpp alone.

#include <optional>
#include <string>

#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/machine_answer.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/server/site.hpp"

namespace taktwerk::hmi::web {

struct Author {
    std::optional<Role> role;  ///< nothing: nobody has logged in
    std::string user, from, machine;
};

/// Who only looks is not written down, unless it was refused; and what never reached a machine (not `handed_on`) is not written down without end.
inline void write_down(Site& site, const Author& author, const PageMessage& message, const MachineAnswer& answer, bool handed_on) {
    const bool looks = !message.rule->moves && message.rule->command != "stop";
    if (answer.ok && looks) return;
    if (!answer.ok && (looks || !handed_on) && !site.refused.take(author.role ? "user " + author.user : "stranger", now())) return;
    Json line{{"utime", wall_utime()},
              {"user", author.user},
              {"role", author.role ? word(*author.role) : std::string_view{}},
              {"from", author.from},
              {"machine", author.machine}};
    line["request"] = bounded(message.request);
    line["ok"] = answer.ok;
    if (!answer.ok) {
        const auto json = Json::parse("{" + answer.keys + "}", nullptr, false);
        if (json.is_object() && json.contains("error")) line["error"] = bounded(json["error"]);
    }
    site.audit(line);
}

}  // namespace taktwerk::hmi::web

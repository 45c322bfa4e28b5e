#pragma once
// What all connections of the server share. Included by web_server.cpp alone.

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/account/accounts.hpp"
#include "hmi_bridge/web/audit_line.hpp"
#include "hmi_bridge/web/page_origin.hpp"
#include "hmi_bridge/web/server/feeds.hpp"
#include "hmi_bridge/web/server/web_server.hpp"
#include "hmi_bridge/web/site_files.hpp"

namespace taktwerk::hmi::web {

class PageSession;
class HttpConnection;

/// From where somebody comes, told apart from what he says of it.
struct Visitor {
    std::string from;     ///< address and port, for people
    std::string address;  ///< for the login gate
    std::string arrived;  ///< the address of this host that he used
    bool secure = false;  ///< a trusted proxy says that he came over TLS
};

struct Site {
    asio::io_context& io;
    const ServerOptions& options;
    const SiteFiles& files;
    Feeds& feeds;
    Accounts& accounts;
    PageOrigin origin;
    std::string cookie;  ///< its name: cookies know no ports, and a host may serve several
    std::set<std::shared_ptr<PageSession>> pages{};
    std::uint64_t pages_ever = 0;
    std::list<std::weak_ptr<HttpConnection>> connections{};  ///< HTTP, the one heard of last at the end

    RefusalBudget refused{};  ///< by user; strangers are one, and so are logins that failed

    void audit(const Json& line) const {
        if (options.audit) options.audit(audit_text(line));
    }
    /// The counts of what was refused too often to stand there one by one; `all`: at the end.
    void tell_unwritten(Instant at, bool all = false) {
        while (const auto more = refused.next_unwritten(at, all))
            audit(Json{{"utime", wall_utime()}, {"event", "refused"}, {"who", more->who}, {"times", more->times}});
    }
};

}  // namespace taktwerk::hmi::web

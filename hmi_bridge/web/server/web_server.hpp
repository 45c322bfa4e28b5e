#pragma once
// The page's server: HTTP for its files, a WebSocket for each page, a local connection to each machine and one more for each page that commands
// (README.md has the protocol). One thread, the caller's, and one for passwords; a process of its own: never in a runtime.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/web/lcm_offer.hpp"
#include "hmi_bridge/web/roles.hpp"
#include "hmi_bridge/web/site_files.hpp"

namespace taktwerk::hmi::web {

struct ServerOptions {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;          ///< 0: any free one
    std::vector<std::string> machines;  ///< names or paths of sockets; empty: all that are found on this host, also later
    std::string users;                  ///< file (account/users.hpp); empty: nobody logs in, and only loopback is served
    Role role = Role::engineer;         ///< of every page, where nobody logs in
    std::vector<std::string> names;    ///< more names of this server, as browsers write them into `Host`: "hmi.example", "hmi.example:8443"
    std::vector<std::string> proxies;  ///< addresses whose X-Forwarded-For and X-Forwarded-Proto are believed
    ValueSource source = ValueSource::automatic;
    std::string version;
    int rate = 20;                                    ///< values a second to each page, 1 to 200
    bool end_with_input = false;                      ///< ends when standard input does
    std::function<void(const std::string&)> audit{};  ///< one JSON object a line: who, from where, what, the answer
    std::function<void(const Error&)> say{};          ///< what whoever runs the server should know; the server goes on
};

class WebServer {
public:
    static constexpr std::size_t most_pages =
        16;  ///< of people who may see something. One that commands takes one of the 8 places at its machine
    static constexpr std::size_t most_strangers = 16;    ///< pages in front of which nobody has logged in; the oldest gives way
    static constexpr std::size_t most_connections = 64;  ///< of HTTP; the one that was silent the longest gives way

    /// Listens when it returns. Errors: web.no_users (an address beyond loopback, or a file without one), web.users, web.in_use (the port), web.listen.
    static Result<std::unique_ptr<WebServer>> open(ServerOptions options, SiteFiles site);
    ~WebServer();

    [[nodiscard]] std::uint16_t port() const;
    /// Connections and pages that are in memory, also those that have ended and are still held. Any thread.
    [[nodiscard]] std::size_t alive() const;
    /// What they all share: gone when the server and all of them are.
    [[nodiscard]] std::weak_ptr<const void> memory() const;
    /// Until stop(), or a signal of SIGINT, SIGTERM.
    void run();
    /// Any thread.
    void stop();

private:
    struct Impl;
    explicit WebServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::hmi::web

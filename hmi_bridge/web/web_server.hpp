#pragma once
// The page's server: HTTP for its files, a WebSocket for each page, a local connection to each machine and one more for each page that commands
// (README.md has the protocol). One thread, the caller's; a process of its own: never in a runtime.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/web/roles.hpp"
#include "hmi_bridge/web/site_files.hpp"

namespace taktwerk::hmi::web {

struct ServerOptions {
    std::string address = "127.0.0.1";
    std::uint16_t port = 8080;          ///< 0: any free one
    std::vector<std::string> machines;  ///< names or paths of sockets; empty: all that are found on this host, also later
    Role role = Role::engineer;         ///< of every page: on loopback nobody logs in
    std::string version;
    bool end_with_input = false;                    ///< ends when standard input does
    std::function<void(const std::string&)> audit;  ///< one JSON object a line: who, from where, what, the answer
};

class WebServer {
public:
    static constexpr std::size_t most_pages = 6;  ///< the machine's socket takes 8: one is the server's, one stays for the command line
    static constexpr std::size_t most_connections = 64;  ///< HTTP included

    /// Listens when it returns. Errors: web.no_users (an address beyond loopback), web.in_use (the port), web.listen.
    static Result<std::unique_ptr<WebServer>> open(ServerOptions options, SiteFiles site);
    ~WebServer();

    [[nodiscard]] std::uint16_t port() const;
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

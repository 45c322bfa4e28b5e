// taktwerk hmi: serves the page of the machines of this host. A process of its own, without privileges.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/hmi/drop_privileges.hpp"
#include "apps/hmi/users.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "hmi_bridge/web/audit_log.hpp"
#include "hmi_bridge/web/page_origin.hpp"
#include "hmi_bridge/web/server/web_server.hpp"
#include "programs/api/abi.hpp"

namespace taktwerk::apps {
namespace {

struct HmiOptions {
    int rate = 20;
    std::string listen, page, audit, users, role = "engineer", source = "auto";
    std::vector<std::string> machines, names, proxies;
    bool end_with_input = false;
};

/// "127.0.0.1:8080", "[::1]:8080".
Result<std::pair<std::string, std::uint16_t>> listen_address(const std::string& text) {
    const auto wrong = Error{"usage.listen", text, "this is no address and port", "Write it like 127.0.0.1:8080 or [::1]:8080."};
    const auto colon = text.rfind(':');
    if (colon == std::string::npos) return wrong;
    auto address = text.substr(0, colon);
    const auto port = text.substr(colon + 1);
    if (port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos || std::stoi(port) > 65535)
        return wrong;
    if (address.size() > 2 && address.front() == '[' && address.back() == ']') address = address.substr(1, address.size() - 2);
    else if (address.find(':') != std::string::npos) return wrong;
    if (address == "localhost") address = "127.0.0.1";
    return std::pair{address, static_cast<std::uint16_t>(std::stoi(port))};
}

/// Beside the command in a build tree, in share/taktwerk where it is installed.
std::string page_folder() {
    std::error_code ignored;
    const auto here = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const auto& folder : {here / "hmi_page" / "page", here.parent_path() / "share" / "taktwerk" / "hmi"})
        if (std::filesystem::exists(folder / "index.html", ignored)) return folder.string();
    return (here.parent_path() / "share" / "taktwerk" / "hmi").string();
}

Result<std::shared_ptr<hmi::web::AuditLog>> open_audit(const std::string& wanted) {
    const auto path = wanted.empty() ? hmi::web::default_audit_path() : Result<std::string>(wanted);
    if (!path) return path.error();
    auto file = hmi::web::AuditFile::open(*path);
    if (!file) return std::move(file).error();
    return std::make_shared<hmi::web::AuditLog>(std::move(*file), [](const Error& error) { print_error(error); });
}

constexpr std::uint16_t first_port = 8080, last_port = 8099;

/// Where nobody said which port: the first that is free.
Result<std::unique_ptr<hmi::web::WebServer>> open_server(const hmi::web::ServerOptions& options, const hmi::web::SiteFiles& site,
                                                         bool any_port) {
    auto tried = options;
    for (;; ++tried.port) {
        auto server = hmi::web::WebServer::open(tried, site);
        if (server || !any_port || server.error().code != "web.in_use" || tried.port >= last_port) return server;
    }
}

int serve(const HmiOptions& options) {
    if (const auto dropped = drop_privileges(); !dropped) print_warning(dropped.error());
    const auto listen = listen_address(options.listen.empty() ? fmt::format("127.0.0.1:{}", first_port) : options.listen);
    if (!listen) {
        print_error(listen.error());
        return exit_usage;
    }
    auto site = hmi::web::SiteFiles::load(options.page.empty() ? page_folder() : options.page);
    if (!site) {
        print_error(site.error());
        return exit_bad_file;
    }
    const auto audit = open_audit(options.audit);
    if (!audit) {
        print_error(audit.error());
        return exit_bad_file;
    }
    hmi::web::ServerOptions server_options;
    server_options.address = listen->first;
    server_options.port = listen->second;
    server_options.machines = options.machines;
    server_options.role = hmi::web::role_of(options.role).value_or(hmi::web::Role::viewer);
    server_options.version = sdk_version;
    server_options.end_with_input = options.end_with_input;
    server_options.rate = options.rate;
    if (options.source != "auto")
        server_options.source = options.source == "lcm" ? hmi::web::ValueSource::lcm : hmi::web::ValueSource::socket;
    server_options.users = options.users;
    server_options.names = options.names;
    server_options.proxies = options.proxies;
    server_options.audit = [audit = *audit](const std::string& line) { audit->put(line); };
    server_options.say = [](const Error& error) { print_error(error); };
    auto server = open_server(server_options, *site, options.listen.empty());
    if (!server) {
        print_error(server.error());
        return server.error().code == "web.no_users" ? exit_usage : exit_bad_file;
    }
    if (!hmi::web::is_loopback(listen->first) && options.proxies.empty())
        print_warning(Error{"web.no_tls", options.listen, "passwords and sessions cross the network as they are",
                            "Put a proxy with TLS before it (docs/hmi-security.md)."});
    fmt::print("the page: http://{}:{}/  (Ctrl-C ends)\n",
               listen->first.find(':') == std::string::npos ? listen->first : "[" + listen->first + "]", (*server)->port());
    std::fflush(stdout);
    (*server)->run();
    return exit_ok;
}

}  // namespace

void add_hmi(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("hmi", "serve the page of the machines of this host, for a browser");
    auto options = std::make_shared<HmiOptions>();
    sub->add_option(
        "--listen", options->listen,
        "ADDRESS:PORT, an address of this host's loopback; port 0: any free one; default: 127.0.0.1 and port 8080 or the next free one");
    sub->add_option("-s,--socket,--machine", options->machines, "a machine's name or its socket, several times; default: all that run");
    sub->add_option("--role", options->role, "what the page may where nobody logs in: viewer, operator, engineer, admin")
        ->check(CLI::IsMember({"viewer", "operator", "engineer", "admin"}))
        ->capture_default_str();
    sub->add_option("--rate", options->rate, "values a second to each page")->check(CLI::Range(1, 200))->capture_default_str();
    sub->add_option("--source", options->source, "from where the values come: lcm, socket; auto: LCM where it works, else the socket")
        ->check(CLI::IsMember({"auto", "lcm", "socket"}))
        ->capture_default_str();
    sub->add_option("--page", options->page, "the folder of the page's files");
    sub->add_option(
        "--audit", options->audit,
        "each command is written to the end of this file; default: hmi-audit.jsonl in /var/log/taktwerk or ~/.local/state/taktwerk");
    sub->add_option("--users", options->users, "the file of who may log in (`taktwerk hmi user`); default: nobody has to");
    sub->add_option("--name", options->names,
                    "another name of this server, as browsers write it: hmi.example, hmi.example:8443; several times");
    sub->add_option("--proxy", options->proxies,
                    "the address of a proxy whose X-Forwarded-For and X-Forwarded-Proto are believed; several times");
    add_hmi_users(*sub, action);
    sub->add_flag("--end-with-input", options->end_with_input, "end when standard input ends: whoever started it is gone then");
    sub->callback([&action, options, sub] {
        if (sub->get_subcommands().empty()) action = [options] { return serve(*options); };
    });
}

}  // namespace taktwerk::apps

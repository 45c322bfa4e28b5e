#include "hmi_bridge/web/server/web_server.hpp"

#include <unistd.h>

#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/web/server/http_connection.hpp"

namespace taktwerk::hmi::web {

struct WebServer::Impl {
    Impl(ServerOptions given, SiteFiles its_files, std::unique_ptr<Accounts> its_accounts)
        : options(std::move(given)),
          files(std::move(its_files)),
          accounts(std::move(its_accounts)),
          feeds(io, options.machines, options.source, [this](Feed& feed) { hand_out(feed); }) {}
    /// Who waits for an answer holds what the answer is for: nobody waits any more. And the list of pages, which each of them holds, holds them.
    ~Impl() {
        if (!site) return;
        for (const auto& page : std::exchange(site->pages, {})) page->end();
        feeds.close();
        site->tell_unwritten(now(), true);
    }

    void accept() {
        acceptor.async_accept([this](error_code failure, tcp::socket socket) {
            if (!acceptor.is_open()) return;
            if (!failure) {
                make_room();
                std::make_shared<HttpConnection>(std::move(socket), site)->read();
            }
            accept();
        });
    }
    /// Who says nothing gives his place to who comes: idle connections keep nobody out.
    void make_room() {
        auto& list = site->connections;
        list.remove_if([](const std::weak_ptr<HttpConnection>& one) { return one.expired(); });
        while (list.size() >= most_connections) {
            if (const auto oldest = list.front().lock()) oldest->give_way();
            list.pop_front();
        }
    }
    void beat() {
        ticker.expires_after(Duration{1s} / options.rate);  // of values, and of everything that has a time-out
        ticker.async_wait([this](error_code failure) {
            if (failure) return;
            step(now());
            beat();
        });
    }
    void wait_for_end_of_input() {
        if (!input.is_open()) {
            error_code failure;
            input.assign(::dup(STDIN_FILENO), failure);
            if (failure) return io.stop();
        }
        input.async_read_some(asio::buffer(unread), [this](error_code failure, std::size_t) {
            if (failure) return io.stop();
            wait_for_end_of_input();
        });
    }
    void step(Instant at) {
        accounts->step(at);
        std::set<Feed*> watched;
        for (auto page = site->pages.begin(); page != site->pages.end();) {
            (*page)->step(at);
            if ((*page)->feed()) watched.insert((*page)->feed().get());
            page = (*page)->ended() ? site->pages.erase(page) : std::next(page);
        }
        feeds.step(at, watched);
        site->tell_unwritten(at);
    }
    void hand_out(Feed& feed) {
        for (const auto& page : site->pages)
            if (page->feed().get() == &feed) page->give_values();
    }

    ServerOptions options;
    SiteFiles files;
    asio::io_context io{1};
    std::unique_ptr<Accounts> accounts;  // behind io: its desk may still hand over what it has computed
    tcp::acceptor acceptor{io};
    asio::steady_timer ticker{io};
    asio::posix::stream_descriptor input{io};
    std::array<char, 64> unread{};
    Feeds feeds;
    std::shared_ptr<Site> site;
};

Result<std::unique_ptr<WebServer>> WebServer::open(ServerOptions options, SiteFiles site) {
    const auto where = fmt::format("{}:{}", options.address, options.port);
    if (options.users.empty() && !is_loopback(options.address))
        return Error{"web.no_users", where, "an address that others reach needs users who log in",
                     "Name their file with --users (docs/hmi-security.md), or listen on 127.0.0.1."};
    auto accounts = Accounts::open(
        options.users, options.role, options.say ? options.say : [](const Error&) {});
    if (!accounts) return std::move(accounts).error();
    auto impl = std::make_unique<Impl>(std::move(options), std::move(site), std::move(*accounts));
    error_code failure;
    const tcp::endpoint endpoint(asio::ip::make_address(impl->options.address, failure), impl->options.port);
    if (!failure) impl->acceptor.open(endpoint.protocol(), failure);
    if (!failure) impl->acceptor.set_option(asio::socket_base::reuse_address(true), failure);
    if (!failure) impl->acceptor.bind(endpoint, failure);
    if (!failure) impl->acceptor.listen(16, failure);
    if (failure)
        return Error{failure == asio::error::address_in_use ? "web.in_use" : "web.listen", where, "cannot listen: " + failure.message(),
                     "Choose another port: `taktwerk hmi --listen 127.0.0.1:8081`."};
    const auto port = impl->acceptor.local_endpoint().port();
    impl->site =
        std::make_shared<Site>(Site{impl->io, impl->options, impl->files, impl->feeds, *impl->accounts,
                                    PageOrigin(impl->options.address, port, impl->options.names), fmt::format("taktwerk_{}", port)});
    return std::unique_ptr<WebServer>(new WebServer(std::move(impl)));
}

WebServer::WebServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }

std::size_t WebServer::alive() const { return static_cast<std::size_t>(impl_->site.use_count() - 1); }

std::weak_ptr<const void> WebServer::memory() const { return std::shared_ptr<const void>(impl_->site); }

void WebServer::run() {
    asio::signal_set signals(impl_->io, SIGINT, SIGTERM);
    signals.async_wait([this](error_code failure, int) {
        if (!failure) impl_->io.stop();
    });
    if (impl_->options.end_with_input) impl_->wait_for_end_of_input();
    impl_->accept();
    impl_->beat();
    impl_->io.run();
}

void WebServer::stop() { impl_->io.stop(); }

}  // namespace taktwerk::hmi::web

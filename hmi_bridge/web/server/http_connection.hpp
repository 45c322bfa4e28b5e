#pragma once
// One HTTP connection, until it becomes a page or ends: the page's files, login and logout. Included by web_server.cpp alone.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/account/login_request.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/server/page_session.hpp"
#include "hmi_bridge/web/server/site.hpp"

namespace taktwerk::hmi::web {

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(tcp::socket&& socket, std::shared_ptr<Site> site) : stream_(std::move(socket)), site_(std::move(site)) {
        error_code ignored;
        const auto peer = stream_.socket().remote_endpoint(ignored);
        peer_ = plain(peer.address());
        peer_port_ = peer.port();
        visitor_.arrived = plain(stream_.socket().local_endpoint(ignored).address());
    }
    void read() {
        site_->connections.remove_if(
            [this](const std::weak_ptr<HttpConnection>& one) { return one.expired() || one.lock().get() == this; });
        site_->connections.push_back(weak_from_this());
        parser_.emplace();
        parser_->header_limit(8 * 1024);
        parser_->body_limit(LoginRequest::longest);
        stream_.expires_after(10s);
        http::async_read(stream_, in_, *parser_, [self = shared_from_this()](error_code failure, std::size_t) { self->answer(failure); });
    }
    /// For somebody new, when all places are taken.
    void give_way() { stream_.close(); }

private:
    static std::string plain(const asio::ip::address& address) {
        if (address.is_v6() && address.to_v6().is_v4_mapped())
            return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
        return address.to_string();
    }
    [[nodiscard]] std::string header(http::field name) const { return std::string(parser_->get()[name]); }

    /// Of several lines the last: a proxy may put its own behind those that came to it.
    [[nodiscard]] std::string last_header(const char* name) const {
        std::string value;
        const auto lines = parser_->get().equal_range(name);
        for (auto line = lines.first; line != lines.second; ++line) value = std::string(line->value());
        return value;
    }

    /// What a proxy says of whom it brings counts only from one that was named, and for this request alone: the next may bring another.
    void look_at_proxy() {
        visitor_.address = peer_;
        visitor_.from = fmt::format("{}:{}", peer_, peer_port_);
        visitor_.secure = false;
        const auto& proxies = site_->options.proxies;
        if (std::find(proxies.begin(), proxies.end(), peer_) == proxies.end()) return;
        visitor_.secure = last_header("X-Forwarded-Proto") == "https";
        const auto chain = last_header("X-Forwarded-For");
        const auto begin = chain.find_last_of(", ");
        const auto client = begin == std::string::npos ? chain : chain.substr(begin + 1);
        error_code failure;
        const auto address = asio::ip::make_address(client, failure);
        if (failure) return;
        visitor_.address = plain(address);
        visitor_.from = visitor_.address + " by " + peer_;
    }

    void answer(error_code failure) {
        if (failure == http::error::header_limit) return say(http::status::request_header_fields_too_large, "too large");
        if (failure == http::error::body_limit) return say(http::status::payload_too_large, "too large");
        if (failure) return;  // the destructor closes
        look_at_proxy();
        const auto& request = parser_->get();
        if (request.count(http::field::host) > 1 || request.count(http::field::origin) > 1)  // RFC 9112 section 3.2
            return say(http::status::bad_request, "Host or Origin stands twice");
        const std::string host = header(http::field::host), origin = header(http::field::origin), target(request.target());
        if (!site_->origin.knows_host(host, visitor_.arrived)) return say(http::status::forbidden, "this server has another name");
        if (target == "/ws" && websocket::is_upgrade(request)) {
            if (!site_->origin.is_own(origin, host, visitor_.arrived)) return say(http::status::forbidden, "a page of another origin");
            return become_page();
        }
        if (request.method() == http::verb::post && (target == "/api/login" || target == "/api/logout")) {
            if (!site_->origin.is_own(origin, host, visitor_.arrived)) return say(http::status::forbidden, "a page of another origin");
            if (!is_json_type(header(http::field::content_type)))
                return say(http::status::unsupported_media_type, "application/json alone");
            return target == "/api/login" ? log_in() : log_out();
        }
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return say(http::status::method_not_allowed, "GET and HEAD alone");
        if (!request.body().empty()) return say(http::status::payload_too_large, "no body");
        const auto* file = site_->files.find(target);
        if (file == nullptr) return say(http::status::not_found, "no such file");
        send(http::status::ok, file->type, file->content, request.keep_alive(), request.method() == http::verb::head);
    }

    void become_page() {
        auto session = site_->accounts.sessions.find(token(), now());
        auto& pages = site_->pages;
        if (!session && site_->accounts.needed()) make_room_among_strangers();
        if ((session || !site_->accounts.needed()) && !make_room_among_users(session.get()))
            return say(http::status::service_unavailable, "too many pages are open");
        const auto page = std::make_shared<PageSession>(std::move(stream_), site_, std::move(session), visitor_);
        pages.insert(page);
        page->accept(parser_->get());
    }
    /// False: no place, and nobody has to give his.
    bool make_room_among_users(const Session* session) {
        std::vector<std::shared_ptr<PageSession>> pages;
        for (const auto& page : site_->pages)
            if (!page->is_stranger() && !page->ended()) pages.push_back(page);
        if (pages.size() < WebServer::most_pages) return true;
        std::vector<Seat> seats;
        for (const auto& page : pages) seats.push_back(page->seat());
        const auto who = session == nullptr ? std::nullopt : who_gives_way(seats, session->user, session->role);
        if (who) pages[*who]->end();
        return who.has_value();
    }
    void make_room_among_strangers() {
        std::shared_ptr<PageSession> oldest;
        std::size_t count = 0;
        for (const auto& page : site_->pages) {
            if (!page->is_stranger() || page->ended()) continue;
            ++count;
            if (!oldest || page->stranger_since() < oldest->stranger_since()) oldest = page;
        }
        if (count >= WebServer::most_strangers) oldest->end();
    }

    [[nodiscard]] std::string token() const { return std::string(cookie_value(header(http::field::cookie), site_->cookie)); }

    void log_in() {
        const auto request = read_login(parser_->get().body());
        if (!request) return refuse(http::status::bad_request, request.error());
        auto& accounts = site_->accounts;
        if (!accounts.needed())
            return refuse(http::status::not_found, {"web.no_users", "", "nobody logs in at this server", "Reload the page."});
        if (const auto wait = accounts.gate.ask(request->user, visitor_.address, now()); wait > Duration{}) {
            retry_after_ = wait / 1s + 1;
            note_login(request->user, false, "too often");
            return refuse(http::status::too_many_requests,
                          {"web.too_often", "", fmt::format("too many tries: again in {} s", retry_after_), "Wait, then try again."});
        }
        const auto* user = accounts.users.find(request->user);
        const auto hash = user == nullptr ? std::string{} : user->password;
        const bool taken = accounts.desk().ask(
            hash, request->password,
            accounts.gate.knows(request->user, visitor_.address) ? PasswordDesk::Turn::before_strangers : PasswordDesk::Turn::last,
            [self = shared_from_this(), name = request->user, hash, executor = site_->io.get_executor()](bool matches) {
                asio::post(executor, [self, name, hash, matches] { self->logged_in(name, hash, matches); });
            });
        stream_.expires_after(30s);
        if (taken) return;
        retry_after_ = 1;
        refuse(http::status::service_unavailable, {"web.busy", "", "too many people log in at this moment", "Try again in a second."});
    }
    void logged_in(const std::string& name, const std::string& hash, bool matches) {
        auto& accounts = site_->accounts;
        const auto* user = accounts.users.find(name);
        if (!matches || user == nullptr || user->password != hash) {
            accounts.gate.failed(name, visitor_.address);
            note_login(name, false, "wrong");
            return refuse(http::status::unauthorized, {"web.wrong_login", "", "user and password do not belong together", "Try again."});
        }
        accounts.gate.succeeded(name, visitor_.address, now());
        accounts.sessions.close(token());
        cookie_ = fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}", site_->cookie, accounts.sessions.open(*user, now()),
                              visitor_.secure ? "; Secure" : "");
        note_login(name, true, "");
        send(http::status::ok, json_type, text_of(Json{{"ok", true}, {"user", name}, {"role", word(user->role)}}), false, false);
    }
    void log_out() {
        if (const auto session = site_->accounts.sessions.find(token(), now()))
            site_->audit(Json{{"utime", wall_utime()}, {"user", session->user}, {"from", visitor_.from}, {"event", "logout"}});
        site_->accounts.sessions.close(token());
        cookie_ = fmt::format("{}=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0{}", site_->cookie, visitor_.secure ? "; Secure" : "");
        send(http::status::ok, json_type, R"({"ok":true})", false, false);
    }
    void note_login(const std::string& name, bool ok, const char* why) {
        if (!ok && !site_->refused.take("login", now())) return;
        Json line{{"utime", wall_utime()}, {"user", name}, {"from", visitor_.from}, {"event", "login"}, {"ok", ok}};
        if (!ok) line["why"] = why;
        site_->audit(std::move(line));
    }

    void refuse(http::status status, const Error& error) {
        send(status, json_type, text_of(Json{{"ok", false}, {"error", error_json(error)}}), false, false);
    }
    void say(http::status status, std::string_view text) {
        send(status, "text/plain; charset=utf-8", std::string(text) + "\n", false, false);
    }
    void send(http::status status, std::string_view type, const std::string& content, bool keep, bool head) {
        reply_ = {};
        reply_.result(status);
        reply_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
        reply_.set(
            "Content-Security-Policy",
            "default-src 'self'; img-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'self'; object-src 'none'");
        reply_.set("X-Content-Type-Options", "nosniff");
        reply_.set("X-Frame-Options", "DENY");
        reply_.set("Referrer-Policy", "no-referrer");
        reply_.set("Cross-Origin-Resource-Policy", "same-origin");
        reply_.set(http::field::cache_control, type == json_type ? "no-store" : "no-cache");
        if (!cookie_.empty()) reply_.set(http::field::set_cookie, std::exchange(cookie_, {}));
        if (retry_after_ > 0) reply_.set(http::field::retry_after, std::to_string(std::exchange(retry_after_, 0)));
        reply_.keep_alive(keep);
        reply_.body() = head ? std::string{} : content;
        reply_.content_length(content.size());
        stream_.expires_after(10s);
        const auto sent = [self = shared_from_this(), keep](error_code failure, std::size_t) {
            if (!failure && keep) return self->read();
            error_code ignored;
            self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        };
        if (!head) return http::async_write(stream_, reply_, sent);
        serializer_.emplace(reply_);
        http::async_write_header(stream_, *serializer_, sent);
    }

    static constexpr std::string_view json_type = "application/json";

    beast::tcp_stream stream_;
    std::shared_ptr<Site> site_;
    Visitor visitor_;
    std::string peer_, cookie_;
    unsigned peer_port_ = 0;
    long retry_after_ = 0;  ///< s, of the next answer
    beast::flat_buffer in_{16 * 1024};
    std::optional<http::request_parser<http::string_body>> parser_;
    http::response<http::string_body> reply_;
    std::optional<http::response_serializer<http::string_body>> serializer_;
};

}  // namespace taktwerk::hmi::web

#include "hmi_bridge/web/web_server.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "core/clock.hpp"
#include "hmi_bridge/socket/socket_path.hpp"
#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/message_age.hpp"
#include "hmi_bridge/web/outbox.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/page_origin.hpp"

namespace taktwerk::hmi::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using local = asio::local::stream_protocol;
using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

constexpr Duration tick = 50ms;  // of values, and of everything that has a time-out
constexpr Duration looks_for_machines = 1s;
constexpr Duration stale_after = 500ms;
constexpr Duration page_patience = 2s;    // a page that takes nothing for so long is dropped
constexpr Duration answer_patience = 3s;  // longer than the gateway waits for the cycle
constexpr Duration drive_patience = 12s;  // a drive's EEPROM
constexpr std::size_t most_waiting = 32;  // commands of one page without an answer
constexpr int most_messages_a_second = 200;
constexpr std::size_t longest_answer = 4 * 1024 * 1024;
constexpr int send_buffer = 64 * 1024;  // the kernel must not hide for long that a page takes nothing

Instant now() { return SystemClock{}.now(); }

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json failed(Error error) { return Json{{"ok", false}, {"error", error_json(error)}}; }

/// One connection to a machine's local socket: requests as they are, answers by their id.
class MachineLine : public std::enable_shared_from_this<MachineLine> {
public:
    using Answer = std::function<void(Json)>;

    MachineLine(asio::io_context& io, std::string path) : socket_(io), in_(longest_answer), path_(std::move(path)) {}

    void open() {
        socket_.async_connect(local::endpoint(path_), [self = shared_from_this()](error_code failure) {
            if (failure) return self->close("cannot connect: " + failure.message());
            self->connected_ = true;
            self->read();
            self->write();
        });
    }
    /// Everybody who waits is answered.
    void close(const std::string& why) {
        if (closed_) return;
        closed_ = true;
        error_code ignored;
        socket_.close(ignored);
        for (auto& one : std::exchange(waiting_, {}))
            one.second.answer(failed(Error{"socket.closed", path_, why, "See that the machine runs, then give the command again."}));
    }
    void ask(Json request, Duration patience, Answer answer) {
        if (closed_)
            return answer(
                failed(Error{"web.no_machine", path_, "there is no connection to the machine", "Start it with `taktwerk run FILE`."}));
        const auto id = next_id_++;
        request["id"] = id;
        waiting_[id] = Waiting{std::move(answer), now() + patience};
        out_.push_back(text_of(request) + "\n");
        if (connected_ && out_.size() == 1) write();
    }
    /// Answers what nobody answered in time.
    void expire(Instant at) {
        for (auto one = waiting_.begin(); one != waiting_.end();) {
            if (one->second.until > at) {
                ++one;
                continue;
            }
            const auto answer = std::move(one->second.answer);
            one = waiting_.erase(one);
            answer(failed(Error{"socket.timeout", path_, "the runtime did not answer in time", "Look at the runtime's output."}));
            if (closed_) return;
        }
    }
    [[nodiscard]] bool closed() const { return closed_; }
    [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

private:
    struct Waiting {
        Answer answer;
        Instant until;
    };

    void write() {
        if (out_.empty() || closed_) return;
        asio::async_write(socket_, asio::buffer(out_.front()), [self = shared_from_this()](error_code failure, std::size_t) {
            if (failure) return self->close("the machine has closed the connection");
            self->out_.pop_front();
            self->write();
        });
    }
    void read() {
        asio::async_read_until(socket_, in_, '\n', [self = shared_from_this()](error_code failure, std::size_t bytes) {
            if (failure || self->closed_) return self->close("the machine has closed the connection");
            const auto* begin = static_cast<const char*>(self->in_.data().data());
            auto answer = Json::parse(begin, begin + bytes, nullptr, false);
            self->in_.consume(bytes);
            self->take(std::move(answer));
            if (!self->closed_) self->read();
        });
    }
    void take(Json answer) {
        if (!answer.is_object() || !answer.contains("id") || !answer.contains("ok")) return;
        if (answer["id"].is_null()) return close(answer.contains("error") ? text_of(answer["error"]) : "the machine takes no more clients");
        if (!answer["id"].is_number_integer()) return;
        const auto found = waiting_.find(answer["id"].get<std::int64_t>());
        if (found == waiting_.end()) return;
        const auto done = std::move(found->second.answer);
        waiting_.erase(found);
        answer.erase("id");
        done(std::move(answer));
    }

    local::socket socket_;
    asio::streambuf in_;
    std::string path_;
    std::deque<std::string> out_;
    std::map<std::int64_t, Waiting> waiting_;
    std::int64_t next_id_ = 1;
    bool connected_ = false, closed_ = false;
};

/// What the server knows of one machine.
struct Feed {
    std::string path, name, why = "not asked yet";  ///< why: of being offline or stale
    std::shared_ptr<MachineLine> line;
    Json layout;
    Outbox::Text values;
    std::int64_t cycle = -1;
    Instant fresh{}, asked{};  ///< fresh: when the cycle was last seen to advance
    bool asking = false;
    std::uint64_t version = 0;  ///< counts what a hello tells
    bool told_online = false;

    [[nodiscard]] bool online() const { return line && !line->closed() && !name.empty(); }
};

using Feeds = std::map<std::string, std::shared_ptr<Feed>>;  // by path

struct Site {
    asio::io_context& io;
    const ServerOptions& options;
    const SiteFiles& files;
    Feeds& feeds;
    std::unique_ptr<PageOrigin> origin;
    std::uint64_t version = 0;  ///< of the list of machines
    std::size_t connections = 0;
};

/// A page: what it says is judged here, what it gets waits here.
class Page : public std::enable_shared_from_this<Page> {
public:
    Page(beast::tcp_stream&& stream, std::shared_ptr<Site> site) : ws_(std::move(stream)), site_(std::move(site)) {}
    ~Page() { --site_->connections; }

    void accept(const http::request<http::empty_body>& request, std::string from) {
        from_ = std::move(from);
        beast::get_lowest_layer(ws_).expires_never();
        error_code ignored;
        beast::get_lowest_layer(ws_).socket().set_option(asio::socket_base::send_buffer_size(send_buffer), ignored);
        beast::get_lowest_layer(ws_).socket().set_option(tcp::no_delay(true), ignored);
        auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.idle_timeout = 20s;
        timeout.keep_alive_pings = true;
        ws_.set_option(timeout);
        ws_.read_message_max(PageMessage::longest);
        ws_.text(true);
        ws_.async_accept(request, [self = shared_from_this()](error_code failure) {
            if (failure) return self->end();
            self->open_ = true;
            self->watch_first();
            self->hello();
            self->read();
        });
    }
    void end() {
        if (ended_) return;
        ended_ = true;
        open_ = false;
        beast::get_lowest_layer(ws_).close();
        if (line_) line_->close("the page is gone");  // the machine lets go what this connection held
    }
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] const std::shared_ptr<Feed>& feed() const { return feed_; }

    /// What a tick brings: time-outs, and word of a machine that came, went or is silent.
    void step(Instant at) {
        if (!open_) return;
        if (writing_ && at - write_began_ > page_patience) return end();
        if (line_) line_->expire(at);
        if (!feed_) watch_first();
        if (told_ != (feed_ ? feed_->version : 0) || told_site_ != site_->version) hello();
        const bool stale = feed_ && at - std::max(feed_->fresh, watched_since_) > stale_after;
        if (stale && at - stale_told_ >= stale_after) {
            stale_told_ = at;
            out_.drop_state();
            put(text_of(Json{{"type", "stale"},
                             {"machine", feed_->name},
                             {"age_ms", feed_->fresh == Instant{} ? Json{} : Json((at - feed_->fresh) / 1ms)},
                             {"why", feed_->why}}));
        }
    }
    void give_values(Instant got) {
        if (!open_) return;
        out_.put_state(feed_->values, got);
        write();
    }

private:
    void put(std::string message) {
        out_.put(std::move(message));
        write();
    }
    void write() {
        if (writing_ || !open_) return;
        sending_ = out_.next(now());
        if (!sending_) return;
        writing_ = true;
        write_began_ = now();
        ws_.async_write(asio::buffer(*sending_), [self = shared_from_this()](error_code failure, std::size_t) {
            self->writing_ = false;
            if (failure) return self->end();
            self->write();
        });
    }
    void read() {
        ws_.async_read(in_, [self = shared_from_this()](error_code failure, std::size_t) {
            if (failure || !self->ws_.got_text() || self->too_many()) return self->end();
            const auto text = beast::buffers_to_string(self->in_.data());
            self->in_.consume(self->in_.size());
            self->take(text);
            if (!self->ended_) self->read();
        });
    }
    bool too_many() {
        const auto at = now();
        if (at - second_began_ >= 1s) {
            second_began_ = at;
            messages_ = 0;
        }
        return ++messages_ > most_messages_a_second;
    }

    void watch_first() {
        for (const auto& known : site_->feeds)
            if (known.second->online() && (!feed_ || known.second->name < feed_->name)) watch(known.second);
    }
    void watch(std::shared_ptr<Feed> feed) {
        if (feed == feed_) return;
        if (line_) line_->close("another machine is watched");
        line_.reset();
        jogged_.clear();
        feed_ = std::move(feed);
        watched_since_ = now();
        out_.drop_state();
    }
    void hello() {
        told_ = feed_ ? feed_->version : 0;
        told_site_ = site_->version;
        auto may_give = Json::array(), machines = Json::array();
        for (const auto& rule : command_rules)
            if (may(role(), rule)) may_give.push_back(rule.command);
        for (const auto& known : site_->feeds)
            machines.push_back(Json{{"machine", known.second->name.empty() ? known.first : known.second->name},
                                    {"online", known.second->online()},
                                    {"why", known.second->online() ? std::string{} : known.second->why}});
        put(text_of(Json{{"type", "hello"},
                         {"protocol", 1},
                         {"version", site_->options.version},
                         {"role", word(role())},
                         {"user", ""},
                         {"may", std::move(may_give)},
                         {"machines", std::move(machines)},
                         {"machine", feed_ ? feed_->name : std::string{}},
                         {"layout", feed_ ? feed_->layout : Json{}},
                         {"source", "socket"}}));
    }
    [[nodiscard]] Role role() const { return site_->options.role; }

    void take(const std::string& text) {
        auto read = read_page_message(text);
        if (const auto* unread = std::get_if<UnreadMessage>(&read)) {
            put(text_of(Json{{"type", "error"}, {"id", unread->id ? Json(*unread->id) : Json{}}, {"error", error_json(unread->error)}}));
            return;
        }
        auto& message = std::get<PageMessage>(read);
        auto named = message.machine.empty() ? feed_ : feed_named(message.machine);
        if (message.kind == PageMessage::Kind::watch) {
            if (!named) put(text_of(Json{{"type", "error"}, {"id", nullptr}, {"error", error_json(unknown(message.machine))}}));
            else watch(named);
            return hello();
        }
        if (auto refused = judge(message, named)) {
            audit(message, Json{{"ok", false}, {"error", error_json(*refused)}});
            return put(refusal(message.id, *refused));
        }
        forward(std::move(message), named);
    }
    [[nodiscard]] std::shared_ptr<Feed> feed_named(const std::string& name) const {
        for (const auto& known : site_->feeds)
            if (known.second->name == name) return known.second;
        return nullptr;
    }
    static Error unknown(const std::string& name) {
        return Error{"web.unknown_machine", name, "there is no such machine on this host", "Choose one of the list."};
    }

    std::optional<Error> judge(const PageMessage& message, const std::shared_ptr<Feed>& named) {
        const std::string command(message.rule->command);
        waited_ = message.sent_ms ? age_.of(*message.sent_ms, now()) : Duration{};
        if (!named)
            return message.machine.empty() ? Error{"web.no_machine", "", "no machine runs", "Start one with `taktwerk run FILE`."}
                                           : unknown(message.machine);
        if (command == "stop") return std::nullopt;
        if (!may(role(), *message.rule))
            return Error{"web.role", command,
                         fmt::format("{} needs the role {}, this is {}", command, word(message.rule->least), word(role())),
                         "Log in as somebody who may."};
        if (named != feed_)
            return Error{"web.other_machine", message.machine, "the page shows another machine",
                         "Look at the machine first, then command it."};
        if (message.may_move() && !message.sent_ms)
            return Error{"web.no_time", command, "a command that can move something says when it was given",
                         "Add sent_ms; reload the page."};
        if (message.may_move() && waited_ > (message.is_jog() ? MessageAge::longest_of_jog : MessageAge::longest)) {
            if (message.is_jog()) let_go();
            return Error{"web.too_old", command,
                         fmt::format("it took {} ms to arrive: nobody knows whether it is still wanted", waited_ / 1ms),
                         "Give it again; if this stays, reload the page and look at the network."};
        }
        if (line_ && line_->waiting() >= most_waiting && message.may_move())
            return Error{"web.busy", command, "too many commands of this page wait for the machine", "Wait for their answers."};
        return std::nullopt;
    }

    void forward(PageMessage message, const std::shared_ptr<Feed>& named) {
        message.request["utime"] = wall_utime() - waited_ / 1us;
        const bool of_drive = message.rule->command.starts_with("drive_");
        const auto patience = of_drive ? drive_patience : answer_patience;
        const bool renewal = message.is_jog() && message.may_move() && !message.request.contains("press");
        if (message.is_jog() && message.request.contains("axis")) jogged_ = message.may_move() ? message.request["axis"] : Json{};
        auto request = message.request;
        auto answered = [self = shared_from_this(), message = std::move(message), renewal](Json answer) {
            if (!renewal || answer["ok"] != true) self->audit(message, answer);
            Json out{{"type", "answer"}, {"id", message.id}};
            out.update(answer);
            self->put(text_of(out));
        };
        if (named != feed_) return named->line->ask(std::move(request), patience, std::move(answered));  // a stop
        own_line()->ask(std::move(request), patience, std::move(answered));
    }
    /// A page that only looks takes no place at the machine.
    const std::shared_ptr<MachineLine>& own_line() {
        if (!line_ || line_->closed()) {
            line_ = std::make_shared<MachineLine>(site_->io, feed_->path);
            line_->open();
        }
        return line_;
    }
    void let_go() {
        if (!line_ || !jogged_.is_string()) return;
        line_->ask(Json{{"cmd", "jog"}, {"axis", jogged_}, {"velocity", 0}, {"utime", wall_utime()}}, answer_patience, [](const Json&) {});
        jogged_ = Json{};
    }

    void audit(const PageMessage& message, const Json& answer) {
        if (!site_->options.audit || (!message.rule->moves && message.rule->command != "stop")) return;
        Json line{{"utime", wall_utime()}, {"user", ""}, {"role", word(role())}, {"from", from_}, {"machine", feed_ ? feed_->name : ""}};
        line["request"] = message.request;
        line["ok"] = answer.value("ok", false);
        if (answer.contains("error")) line["error"] = answer["error"];
        site_->options.audit(text_of(line));
    }

    websocket::stream<beast::tcp_stream> ws_;
    std::shared_ptr<Site> site_;
    std::string from_;
    beast::flat_buffer in_;
    Outbox out_;
    Outbox::Text sending_;
    std::shared_ptr<Feed> feed_;
    std::shared_ptr<MachineLine> line_;
    MessageAge age_;
    Duration waited_{};  ///< of the message that is being judged
    Json jogged_;        ///< the axis that this page holds; null: none
    Instant write_began_{}, second_began_{}, stale_told_{}, watched_since_{};
    std::uint64_t told_ = 0, told_site_ = 0;
    int messages_ = 0;
    bool open_ = false, ended_ = false, writing_ = false;
};

using Pages = std::set<std::shared_ptr<Page>>;

/// One HTTP connection, until it becomes a page or ends.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(tcp::socket&& socket, std::shared_ptr<Site> site, Pages& pages)
        : stream_(std::move(socket)), site_(std::move(site)), pages_(pages) {
        ++site_->connections;
        error_code ignored;
        const auto from = stream_.socket().remote_endpoint(ignored);
        from_ = fmt::format("{}:{}", from.address().to_string(), from.port());
    }
    ~Connection() {
        if (!became_page_) --site_->connections;
    }
    void read() {
        parser_.emplace();
        parser_->header_limit(8 * 1024);
        parser_->body_limit(0);
        stream_.expires_after(10s);
        http::async_read(stream_, in_, *parser_, [self = shared_from_this()](error_code failure, std::size_t) { self->answer(failure); });
    }

private:
    void answer(error_code failure) {
        if (failure == http::error::header_limit) return say(http::status::request_header_fields_too_large, "too large");
        if (failure == http::error::body_limit || failure == http::error::unexpected_body)
            return say(http::status::payload_too_large, "no body");
        if (failure) return;  // the destructor closes
        const auto& request = parser_->get();
        const std::string host(request[http::field::host]), origin(request[http::field::origin]), target(request.target());
        if (!site_->origin->knows_host(host)) return say(http::status::forbidden, "this server has another name");
        if (target == "/ws" && websocket::is_upgrade(request)) {
            if (!site_->origin->is_own(origin, host)) return say(http::status::forbidden, "a page of another origin");
            if (pages_.size() >= WebServer::most_pages) return say(http::status::service_unavailable, "too many pages are open");
            became_page_ = true;
            const auto page = std::make_shared<Page>(std::move(stream_), site_);
            pages_.insert(page);
            return page->accept(request, from_);
        }
        if (request.method() != http::verb::get && request.method() != http::verb::head)
            return say(http::status::method_not_allowed, "GET and HEAD alone");
        const auto* file = site_->files.find(target);
        if (file == nullptr) return say(http::status::not_found, "no such file");
        send(http::status::ok, file->type, file->content, request.keep_alive(), request.method() == http::verb::head);
    }
    void say(http::status status, std::string_view text) {
        send(status, "text/plain; charset=utf-8", std::string(text) + "\n", false, false);
    }
    void send(http::status status, std::string_view type, const std::string& content, bool keep, bool head) {
        reply_ = {};
        reply_.result(status);
        reply_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
        reply_.set("Content-Security-Policy",
                   "default-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'self'; object-src 'none'");
        reply_.set("X-Content-Type-Options", "nosniff");
        reply_.set("X-Frame-Options", "DENY");
        reply_.set("Referrer-Policy", "no-referrer");
        reply_.set("Cross-Origin-Resource-Policy", "same-origin");
        reply_.set(http::field::cache_control, "no-cache");
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

    beast::tcp_stream stream_;
    std::shared_ptr<Site> site_;
    Pages& pages_;
    std::string from_;
    beast::flat_buffer in_{16 * 1024};
    std::optional<http::request_parser<http::empty_body>> parser_;
    http::response<http::string_body> reply_;
    std::optional<http::response_serializer<http::string_body>> serializer_;
    bool became_page_ = false;
};

}  // namespace

struct WebServer::Impl {
    Impl(ServerOptions given, SiteFiles its_files) : options(std::move(given)), files(std::move(its_files)) {}
    /// Who waits for an answer holds what the answer is for: nobody waits any more.
    ~Impl() {
        for (const auto& page : pages) page->end();
        for (const auto& known : feeds)
            if (known.second->line) known.second->line->close("the server ends");
    }

    void accept() {
        acceptor.async_accept([this](error_code failure, tcp::socket socket) {
            if (!acceptor.is_open()) return;
            if (!failure && site->connections < most_connections) std::make_shared<Connection>(std::move(socket), site, pages)->read();
            accept();
        });
    }
    void beat() {
        ticker.expires_after(tick);
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
        if (at - looked >= looks_for_machines) {
            looked = at;
            look_for_machines();
        }
        std::set<Feed*> watched;
        for (auto page = pages.begin(); page != pages.end();) {
            (*page)->step(at);
            if ((*page)->feed()) watched.insert((*page)->feed().get());
            page = (*page)->ended() ? pages.erase(page) : std::next(page);
        }
        for (const auto& known : feeds) {
            const auto& feed = known.second;
            if (feed->line) feed->line->expire(at);
            if (feed->online() != std::exchange(feed->told_online, feed->online())) changed(*feed);
            if (feed->online() && !feed->asking && watched.count(feed.get()) != 0) ask_values(feed);
        }
    }

    void look_for_machines() {
        std::vector<std::string> paths;
        for (const auto& machine : options.machines)
            if (const auto path = find_socket(machine)) paths.push_back(*path);
        if (options.machines.empty())
            for (const auto& folder : socket_folders()) {
                std::error_code failure;
                for (std::filesystem::directory_iterator entry(folder, failure), last; !failure && entry != last; entry.increment(failure))
                    if (entry->path().extension() == ".sock") paths.push_back(entry->path().string());
            }
        for (const auto& path : paths) {
            auto& feed = feeds[path];
            if (!feed) {
                feed = std::make_shared<Feed>();
                feed->path = path;
            }
            if (!feed->line || feed->line->closed()) connect(feed);
        }
    }
    void connect(const std::shared_ptr<Feed>& feed) {
        feed->asking = false;
        feed->line = std::make_shared<MachineLine>(io, feed->path);
        feed->line->open();
        feed->line->ask(Json{{"cmd", "hello"}}, answer_patience, [this, feed](const Json& answer) {
            if (!answer.contains("hello") || !answer["hello"].is_object()) {
                if (answer.contains("error") && answer["error"].is_object()) feed->why = answer["error"].value("what", std::string{});
                return feed->line->close("no hello");
            }
            feed->name = answer["hello"].value("machine", feed->path);
            feed->line->ask(Json{{"cmd", "layout"}}, answer_patience, [this, feed](const Json& layout) {
                if (layout.contains("layout")) feed->layout = layout["layout"];
                changed(*feed);
            });
        });
    }
    void changed(Feed& feed) {
        ++feed.version;
        ++site->version;
    }
    void ask_values(const std::shared_ptr<Feed>& feed) {
        feed->asking = true;
        feed->asked = now();
        feed->line->ask(Json{{"cmd", "state"}}, answer_patience, [this, feed](const Json& answer) {
            feed->asking = false;
            if (!answer.contains("state") || !answer["state"].is_object()) {
                if (answer.contains("error") && answer["error"].is_object()) feed->why = answer["error"].value("what", std::string{});
                return;
            }
            const auto& state = answer["state"];
            const auto cycle = state.value("cycle", std::int64_t{-1});
            if (cycle == feed->cycle) {
                feed->why = "the machine's cycle does not advance";
                return;  // old values are not sent as new ones
            }
            feed->cycle = cycle;
            feed->fresh = now();
            feed->why = "the machine does not answer";
            feed->values =
                std::make_shared<const std::string>("\"machine\":" + text_of(Json(feed->name)) + ",\"state\":" + text_of(state) + "}");
            for (const auto& page : pages)
                if (page->feed() == feed) page->give_values(feed->fresh);
        });
    }

    ServerOptions options;
    SiteFiles files;
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    asio::steady_timer ticker{io};
    asio::posix::stream_descriptor input{io};
    std::array<char, 64> unread{};
    Feeds feeds;
    Pages pages;
    std::shared_ptr<Site> site;
    Instant looked{};
};

Result<std::unique_ptr<WebServer>> WebServer::open(ServerOptions options, SiteFiles site) {
    const auto where = fmt::format("{}:{}", options.address, options.port);
    if (!is_loopback(options.address))
        return Error{"web.no_users", where, "an address that others reach needs users who log in, and this version has none",
                     "Listen on 127.0.0.1, and reach it from elsewhere through `ssh -L`."};
    auto impl = std::make_unique<Impl>(std::move(options), std::move(site));
    error_code failure;
    const tcp::endpoint endpoint(asio::ip::make_address(impl->options.address, failure), impl->options.port);
    if (!failure) impl->acceptor.open(endpoint.protocol(), failure);
    if (!failure) impl->acceptor.set_option(asio::socket_base::reuse_address(true), failure);
    if (!failure) impl->acceptor.bind(endpoint, failure);
    if (!failure) impl->acceptor.listen(16, failure);
    if (failure)
        return Error{failure == asio::error::address_in_use ? "web.in_use" : "web.listen", where, "cannot listen: " + failure.message(),
                     "Choose another port: `taktwerk hmi --listen 127.0.0.1:8081`."};
    impl->site = std::make_shared<Site>(Site{impl->io, impl->options, impl->files, impl->feeds, nullptr});
    impl->site->origin = std::make_unique<PageOrigin>(impl->options.address, impl->acceptor.local_endpoint().port());
    return std::unique_ptr<WebServer>(new WebServer(std::move(impl)));
}

WebServer::WebServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }

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

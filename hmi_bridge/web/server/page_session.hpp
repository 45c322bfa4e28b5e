#pragma once
// A page: what it says is judged and handed to its machine, what happens there is told. Included by web_server.cpp alone.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/message_age.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/server/hello.hpp"
#include "hmi_bridge/web/server/page_socket.hpp"
#include "hmi_bridge/web/server/site.hpp"

namespace taktwerk::hmi::web {

class PageSession : public PageSocket {
public:
    PageSession(beast::tcp_stream&& stream, std::shared_ptr<Site> site, std::shared_ptr<Session> session, Visitor visitor)
        : PageSocket(std::move(stream)), site_(std::move(site)), session_(std::move(session)), visitor_(std::move(visitor)) {}

    [[nodiscard]] const std::shared_ptr<Feed>& feed() const { return feed_; }
    /// Of nobody who has logged in, where people do.
    [[nodiscard]] bool is_stranger() const { return !role(); }
    [[nodiscard]] Instant stranger_since() const { return stranger_since_; }

    /// What a tick brings: time-outs, another role, and word of a machine that came, went or is silent.
    void step(Instant at) {
        expire(at);
        if (!is_open()) return;
        look_at_session(at);
        if (is_stranger()) {
            if (at - stranger_since_ > stranger_patience) return end();
            return;
        }
        if (line_) line_->expire(at);
        if (!feed_) watch_first();
        if (told_ != (feed_ ? feed_->version() : 0) || told_site_ != site_->feeds.version() || told_role_ != role()) hello();
        const bool stale = feed_ && at - std::max(feed_->fresh(), watched_since_) > stale_after;
        if (stale && at - stale_told_ >= stale_after) {
            stale_told_ = at;
            drop_state();
            put(text_of(Json{{"type", "stale"},
                             {"machine", feed_->name()},
                             {"age_ms", feed_->fresh() == Instant{} ? Json{} : Json((at - feed_->fresh()) / 1ms)},
                             {"why", feed_->why()}}));
        }
    }
    void give_values() {
        if (feed_) put_state(feed_->values(), feed_->fresh());
    }

private:
    static constexpr Duration stale_after = 500ms;
    static constexpr Duration stranger_patience = 60s;  ///< a page in front of which nobody logs in comes again if it likes
    static constexpr std::size_t most_pressed = 16;
    static constexpr std::size_t most_waiting = 32;  ///< commands of one page without an answer

    void on_open() override {
        stranger_since_ = now();
        watch_first();
        hello();
    }
    void on_end() override {
        if (line_) line_->close("the page is gone");  // the machine lets go what this connection held
    }

    [[nodiscard]] std::optional<Role> role() const {
        return session_ ? std::optional<Role>{session_->role} : site_->accounts.role_of_nobody();
    }
    [[nodiscard]] std::string role_word() const { return role() ? std::string(word(*role())) : std::string{}; }
    [[nodiscard]] std::string user() const { return session_ ? session_->user : std::string{}; }

    void look_at_session(Instant at) {
        if (!session_) return;
        if (!session_->ended) {
            session_->used = at;
            const auto before = std::exchange(role_before_, session_->role);
            if (static_cast<int>(session_->role) < static_cast<int>(before)) let_go_all("another role");
            return;
        }
        session_.reset();
        stranger_since_ = at;
        watch(nullptr);  // what it held is let go, and it sees nothing more
        hello();
    }

    /// Jogs, buttons, points, outputs, control: the machine ends with the connection what came over it.
    void let_go_all(const char* why) {
        if (line_) line_->close(why);
        line_.reset();
        jogged_ = Json{};
        pressed_.clear();
    }
    void watch_first() {
        if (is_stranger()) return;
        const auto first = site_->feeds.first();
        if (first && (!feed_ || first->name() < feed_->name())) watch(first);
    }
    void watch(std::shared_ptr<Feed> feed) {
        if (feed == feed_) return;
        let_go_all("another machine is watched");
        feed_ = std::move(feed);
        watched_since_ = now();
        drop_state();
    }
    void hello() {
        told_ = feed_ ? feed_->version() : 0;
        told_site_ = site_->feeds.version();
        told_role_ = role();
        put(hello_text(*site_, feed_.get(), role(), user()));
    }

    void on_text(const std::string& text) override {
        look_at_session(now());
        auto read = read_page_message(text);
        if (const auto* unread = std::get_if<UnreadMessage>(&read)) {
            put(text_of(Json{{"type", "error"}, {"id", unread->id ? Json(*unread->id) : Json{}}, {"error", error_json(unread->error)}}));
            return;
        }
        auto& message = std::get<PageMessage>(read);
        const auto named = message.machine.empty() ? feed_ : site_->feeds.named(message.machine);
        if (message.kind == PageMessage::Kind::watch) {
            const auto refused = is_stranger() ? std::optional<Error>{log_in_first()}
                                 : named       ? std::nullopt
                                               : std::optional<Error>{unknown(message.machine)};
            if (refused) put(text_of(Json{{"type", "error"}, {"id", nullptr}, {"error", error_json(*refused)}}));
            else watch(named);
            return hello();
        }
        if (const auto refused = judge(message, named)) {
            audit(message, failed_answer(*refused), false);
            return put(refusal(message.id, *refused));
        }
        forward(std::move(message), named);
    }
    static Error unknown(const std::string& name) {
        return Error{"web.unknown_machine", name, "there is no such machine on this host", "Choose one of the list."};
    }
    static Error log_in_first() { return Error{"web.login", "", "nobody has logged in at this page", "Log in."}; }

    std::optional<Error> judge(const PageMessage& message, const std::shared_ptr<Feed>& named) {
        const std::string command(message.rule->command);
        waited_ = message.sent_ms ? age_.of(*message.sent_ms, now()) : Duration{};
        if (is_stranger()) return log_in_first();
        if (!named)
            return message.machine.empty() ? Error{"web.no_machine", "", "no machine runs", "Start one with `taktwerk run FILE`."}
                                           : unknown(message.machine);
        if (command == "stop") return std::nullopt;
        if (!may(*role(), *message.rule))
            return Error{"web.role", command,
                         fmt::format("{} needs the role {}, this is {}", command, word(message.rule->least), role_word()),
                         "Log in as somebody who may."};
        if (named != feed_)
            return Error{"web.other_machine", message.machine, "the page shows another machine",
                         "Look at the machine first, then command it."};
        if (message.may_move() && !message.sent_ms)
            return Error{"web.no_time", command, "a command that can move something says when it was given",
                         "Add sent_ms; reload the page."};
        if (message.may_move() && waited_ > (message.is_held() ? MessageAge::longest_of_jog : MessageAge::longest)) {
            if (message.is_jog()) let_go();
            return Error{"web.too_old", command,
                         fmt::format("it took {} ms to arrive: nobody knows whether it is still wanted", waited_ / 1ms),
                         "Give it again; if this stays, reload the page and look at the network."};
        }
        const bool lets_go = message.rule->moves && !message.may_move();
        if (waiting() >= most_waiting && !lets_go)
            return Error{"web.busy", command, "too many commands of this page wait for the machine", "Wait for their answers."};
        return std::nullopt;
    }
    [[nodiscard]] std::size_t waiting() const { return asked_long_ + (line_ ? line_->waiting() : 0); }

    void forward(PageMessage message, const std::shared_ptr<Feed>& named) {
        message.request["utime"] = wall_utime() - waited_ / 1us;
        const auto command = message.rule->command;
        const auto patience = command.starts_with("drive_") ? drive_patience : answer_patience;
        const bool renewal = is_renewal(message);
        if (message.is_jog() && message.request.contains("axis")) jogged_ = message.may_move() ? message.request["axis"] : Json{};
        const bool is_long = answers_long(command);
        if (is_long) ++asked_long_;
        auto request = message.request;
        auto answered = [self = self_as_page(), message = std::move(message), renewal, is_long](const MachineAnswer& answer) {
            if (is_long) --self->asked_long_;
            if (answer.ok) self->note_press(message);
            if (!renewal || !answer.ok) self->audit(message, answer, true);
            self->put_answer(fmt::format(R"({{"type":"answer","id":{},{}}})", message.id, answer.keys));
        };
        if (is_long) return named->long_line().ask(std::move(request), patience, std::move(answered));
        // A stop takes the way that stands already: it waits for no place at the machine.
        const bool by_server = command == "stop" && (named != feed_ || !line_ || line_->closed());
        (by_server ? named->line() : own_line()).ask(std::move(request), patience, std::move(answered));
    }
    /// Of a jog or a measurement the machine knows whether it is one. A value that says so is one of a button that this page holds, or it is written.
    [[nodiscard]] bool is_renewal(const PageMessage& message) const {
        return message.is_renewal() &&
               (message.is_jog() || std::find(pressed_.begin(), pressed_.end(), message.variable()) != pressed_.end());
    }
    void note_press(const PageMessage& message) {
        if (message.rule->command != "set_value" || message.is_renewal()) return;
        std::erase(pressed_, message.variable());
        if (!message.is_held() || !message.may_move()) return;
        if (pressed_.size() >= most_pressed) pressed_.erase(pressed_.begin());
        pressed_.push_back(message.variable());
    }
    std::shared_ptr<PageSession> self_as_page() { return std::static_pointer_cast<PageSession>(shared_from_this()); }
    /// A page that only looks takes no place at the machine.
    MachineLine& own_line() {
        if (!line_ || line_->closed()) {
            line_ = std::make_shared<MachineLine>(site_->io, feed_->path());
            line_->open();
        }
        return *line_;
    }
    void let_go() {
        if (!line_ || !jogged_.is_string()) return;
        line_->ask(Json{{"cmd", "jog"}, {"axis", jogged_}, {"velocity", 0}, {"utime", wall_utime()}}, answer_patience,
                   [](const MachineAnswer&) {});
        jogged_ = Json{};
    }

    /// Who only looks is not written down, unless it was refused; and what nobody carried out is not written down without end.
    void audit(const PageMessage& message, const MachineAnswer& answer, bool handed_on) {
        const bool looks = !message.rule->moves && message.rule->command != "stop";
        if (answer.ok && looks) return;
        if (!answer.ok && (looks || !handed_on) && !site_->refused.take(is_stranger() ? "stranger" : "user " + user(), now())) return;
        Json line{{"utime", wall_utime()},
                  {"user", user()},
                  {"role", role_word()},
                  {"from", visitor_.from},
                  {"machine", feed_ ? feed_->name() : ""}};
        line["request"] = bounded(message.request);
        line["ok"] = answer.ok;
        if (!answer.ok) {
            const auto json = Json::parse("{" + answer.keys + "}", nullptr, false);
            if (json.is_object() && json.contains("error")) line["error"] = bounded(json["error"]);
        }
        site_->audit(line);
    }

    std::shared_ptr<Site> site_;
    std::shared_ptr<Session> session_;
    Visitor visitor_;
    std::shared_ptr<Feed> feed_;
    std::shared_ptr<MachineLine> line_;
    std::size_t asked_long_ = 0;
    MessageAge age_;
    Duration waited_{};                 ///< of the message that is being judged
    std::vector<std::string> pressed_;  ///< buttons that the machine has taken as pressed by this page
    Json jogged_;                       ///< the axis that this page holds; null: none
    Instant stale_told_{}, watched_since_{}, stranger_since_{};
    std::uint64_t told_ = 0, told_site_ = 0;
    std::optional<Role> told_role_;
    Role role_before_ = Role::viewer;  ///< of the session when it was last looked at
};

}  // namespace taktwerk::hmi::web

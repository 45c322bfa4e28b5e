#pragma once
// A page: what it says is judged and handed to its machine, what happens there is told. Included by web_server.cpp alone.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/wall_clock.hpp"
#include "hmi_bridge/web/held_buttons.hpp"
#include "hmi_bridge/web/message_age.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/page_seats.hpp"
#include "hmi_bridge/web/server/hello.hpp"
#include "hmi_bridge/web/server/page_deeds.hpp"
#include "hmi_bridge/web/server/page_socket.hpp"
#include "hmi_bridge/web/server/site.hpp"

namespace taktwerk::hmi::web {

class PageSession : public PageSocket {
public:
    PageSession(beast::tcp_stream&& stream, std::shared_ptr<Site> site, std::shared_ptr<Session> session, Visitor visitor)
        : PageSocket(std::move(stream)),
          site_(std::move(site)),
          session_(std::move(session)),
          visitor_(std::move(visitor)),
          number_(++site_->pages_ever),
          used_(now()) {}

    [[nodiscard]] const std::shared_ptr<Feed>& feed() const { return feed_; }
    /// Nobody has logged in here, and people do.
    [[nodiscard]] bool is_stranger() const { return !role(); }
    [[nodiscard]] Instant stranger_since() const { return stranger_since_; }
    /// As who gives way is judged.
    [[nodiscard]] Seat seat() const { return {user(), role().value_or(Role::viewer), used_}; }

    /// What a tick brings: time-outs, another role, and word of a machine that came, went or is silent.
    void step(Instant at) {
        expire(at);
        if (!is_open()) return;
        look_at_session(at);
        if (is_stranger()) {
            if (at - stranger_since_ > stranger_patience) return end();
            return;
        }
        if (const auto line = line_) line->expire(at);
        if (!feed_) watch_first();
        if (told_ != (feed_ ? feed_->version() : 0) || told_site_ != site_->feeds.version() || told_role_ != role()) hello();
        const bool stale = feed_ && at - std::max(feed_->fresh(), watched_since_) > stale_after;
        if (stale && at - stale_told_ >= stale_after) {
            stale_told_ = at;
            drop_state();
            put(stale_text(*feed_, at));
        }
    }
    void give_values() {
        if (feed_) put_state(feed_->values(), feed_->fresh());
    }

private:
    static constexpr Duration stale_after = 500ms;
    static constexpr Duration stranger_patience = 60s;    ///< a page in front of which nobody logs in comes again if it likes
    static constexpr std::size_t most_viewers_lines = 2;  ///< at one machine, of its 8
    static constexpr std::size_t most_waiting = 32;       ///< commands of one page without an answer

    void on_open() override {
        stranger_since_ = now();
        watch_first();
        hello();
    }
    void on_end() override { let_go_all("the page is gone"); }

    [[nodiscard]] std::optional<Role> role() const {
        return session_ ? std::optional<Role>{session_->role} : site_->accounts.role_of_nobody();
    }
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

    /// Jogs, buttons, points, outputs, control: the machine ends with the connection what came over it. Nor are questions asked any more.
    void let_go_all(const char* why) {
        if (line_) line_->close(why);
        if (feed_) feed_->questions().forget(number_);
        line_.reset();
        jogged_ = Json{};
        buttons_.clear();
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
        if (const auto* unread = std::get_if<UnreadMessage>(&read)) return put(error_text(unread->id, unread->error));
        auto& message = std::get<PageMessage>(read);
        if (message.kind == PageMessage::Kind::clock) return void(age_.of(*message.sent_ms, now()));
        const bool own = message.machine.empty() || (feed_ && feed_->name() == message.machine);
        const auto named = own ? feed_ : site_->feeds.named(message.machine);
        if (message.kind == PageMessage::Kind::watch) {
            const auto refused = is_stranger() ? std::optional<Error>{log_in_first()}
                                 : named       ? std::nullopt
                                               : std::optional<Error>{unknown_machine(message.machine)};
            if (refused) put(error_text(std::nullopt, *refused));
            else watch(named);
            return hello();
        }
        if (const auto refused = judge(message, named)) {
            audit(message, failed_answer(*refused), false);
            return put(refusal(message.id, *refused));
        }
        forward(std::move(message), named);
    }

    std::optional<Error> judge(const PageMessage& message, const std::shared_ptr<Feed>& named) {
        const std::string command(message.rule->command);
        waited_ = message.sent_ms ? age_.of(*message.sent_ms, now()) : Duration{};
        if (is_stranger()) return log_in_first();
        if (!named)
            return message.machine.empty() ? Error{"web.no_machine", "", "no machine runs", "Start one with `taktwerk run FILE`."}
                                           : unknown_machine(message.machine);
        if (command == "stop") return std::nullopt;
        if (!may(*role(), *message.rule))
            return Error{"web.role", command,
                         fmt::format("{} needs the role {}, this is {}", command, word(message.rule->least), word(*role())),
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
                         fmt::format("it may have taken {} ms to arrive: nobody knows whether it is still wanted", waited_ / 1ms),
                         "Give it again; if this stays, reload the page and look at the network."};
        }
        const bool lets_go = message.rule->moves && !message.may_move();
        if (waiting() >= most_waiting && !lets_go)
            return Error{"web.busy", command, "too many commands of this page wait for the machine", "Wait for their answers."};
        if (role() == Role::viewer && !has_line() && !only_asks(*message.rule) && viewers_lines() >= most_viewers_lines)
            return Error{"web.busy", command, "too many pages that only look have a connection of their own to the machine",
                         "Wait until another one is closed."};
        return std::nullopt;
    }
    [[nodiscard]] std::size_t waiting() const { return asked_ + (line_ ? line_->waiting() : 0); }

    void forward(PageMessage message, const std::shared_ptr<Feed>& named) {
        if (message.rule->moves) used_ = now();
        message.request["utime"] = wall_utime() - waited_ / 1us;
        const auto command = message.rule->command;
        const auto patience = command.starts_with("drive_") ? drive_patience : answer_patience;
        const bool renewal = buttons_.is_renewal(message);
        if (message.is_jog()) jogged_ = message.may_move() ? message.release() : Json{};
        const bool asks = only_asks(*message.rule);
        if (asks) ++asked_;
        auto request = message.request;
        auto answered = [self = self_as_page(), message = std::move(message), renewal, asks](const MachineAnswer& answer) {
            if (asks) --self->asked_;
            if (answer.ok) self->buttons_.taken(message);
            if (!renewal || !answer.ok) self->audit(message, answer, true);
            if (self->is_stranger()) return;  // logged out meanwhile
            self->put_answer(fmt::format(R"({{"type":"answer","id":{},{}}})", message.id, answer.keys));
        };
        if (asks) return named->questions().ask(number_, std::move(request), patience, std::move(answered));
        if (command != "stop") return own_line().ask(std::move(request), patience, std::move(answered));
        // A stop takes the way that stands already: it waits for no place at the machine. Where the page's own is not yet known to stand it takes both, for
        // behind what was given before it it has to be, too.
        const bool own = named == feed_ && line_ && !line_->closed();
        if (own && line_->proven()) return line_->ask(std::move(request), patience, std::move(answered));
        if (own) line_->ask(request, patience, [](const MachineAnswer&) {});
        named->line().ask(std::move(request), patience, std::move(answered));
    }
    [[nodiscard]] bool has_line() const { return line_ && !line_->closed(); }
    /// The places at the machine are for who commands: viewers have a few, for what belongs to a connection (a trigger).
    [[nodiscard]] std::size_t viewers_lines() const {
        return static_cast<std::size_t>(std::count_if(site_->pages.begin(), site_->pages.end(), [this](const auto& page) {
            return page->feed_ == feed_ && page->role() == Role::viewer && page->has_line();
        }));
    }
    std::shared_ptr<PageSession> self_as_page() { return std::static_pointer_cast<PageSession>(shared_from_this()); }
    MachineLine& own_line() {
        if (!line_ || line_->closed()) {
            line_ = std::make_shared<MachineLine>(site_->io, feed_->path());
            line_->open();
        }
        return *line_;
    }
    void let_go() {
        if (!line_ || jogged_.is_null()) return;
        jogged_["utime"] = wall_utime();
        line_->ask(std::exchange(jogged_, Json{}), answer_patience, [](const MachineAnswer&) {});
    }

    void audit(const PageMessage& message, const MachineAnswer& answer, bool handed_on) {
        write_down(*site_, {role(), user(), visitor_.from, feed_ ? feed_->name() : ""}, message, answer, handed_on);
    }

    std::shared_ptr<Site> site_;
    std::shared_ptr<Session> session_;
    Visitor visitor_;
    std::shared_ptr<Feed> feed_;
    std::shared_ptr<MachineLine> line_;
    std::uint64_t number_;  ///< of this page, counted from the server's start
    std::size_t asked_ = 0;
    MessageAge age_;
    Duration waited_{};  ///< of the message that is being judged
    HeldButtons buttons_;
    Json jogged_;  ///< what lets go of the axis or group that this page holds; null: it holds none
    Instant stale_told_{}, watched_since_{}, stranger_since_{}, used_;
    std::uint64_t told_ = 0, told_site_ = 0;
    std::optional<Role> told_role_;
    Role role_before_ = Role::viewer;  ///< of the session when it was last looked at
};

}  // namespace taktwerk::hmi::web

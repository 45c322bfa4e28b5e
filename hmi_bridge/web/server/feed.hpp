#pragma once
// What the server knows of one machine, and how it learns it: hello and layout when it comes, its state while somebody looks. Included by web_server.cpp alone.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/socket/json_state.hpp"
#include "hmi_bridge/web/outbox.hpp"
#include "hmi_bridge/web/server/lcm_values.hpp"
#include "hmi_bridge/web/server/machine_line.hpp"
#include "hmi_bridge/web/server/question_desk.hpp"

namespace taktwerk::hmi::web {

class Feed : public std::enable_shared_from_this<Feed> {
public:
    using Told = std::function<void(Feed&)>;
    /// `changed`: what a hello tells is another. `fresh`: there are new values.
    Feed(asio::io_context& io, std::string path, ValueSource wanted, Told changed, Told fresh)
        : io_(io),
          path_(std::move(path)),
          wanted_(wanted),
          changed_(std::move(changed)),
          fresh_told_(std::move(fresh)),
          questions_(std::make_shared<QuestionDesk>(io, path_)) {}

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const std::string& name() const { return name_; }      ///< empty before its first hello
    [[nodiscard]] const std::string& why() const { return why_; }        ///< of being offline or stale
    [[nodiscard]] const std::string& layout() const { return layout_; }  ///< JSON; "null": not there
    [[nodiscard]] std::string_view source() const { return source_; }    ///< "lcm", "socket"; empty: neither yet
    [[nodiscard]] const std::string& why_not_lcm() const { return why_not_lcm_; }
    [[nodiscard]] const Outbox::Text& values() const { return values_; }
    [[nodiscard]] Instant fresh() const { return fresh_; }            ///< when the cycle was last seen to advance
    [[nodiscard]] std::uint64_t version() const { return version_; }  ///< counts what a hello tells
    [[nodiscard]] bool connected() const { return line_ && !line_->closed(); }
    [[nodiscard]] bool online() const { return connected() && !name_.empty(); }
    [[nodiscard]] MachineLine& line() { return *line_; }

    [[nodiscard]] QuestionDesk& questions() { return *questions_; }

    void connect() {
        asking_ = false;
        cycle_ = -1;
        line_ = std::make_shared<MachineLine>(io_, path_);
        line_->open();
        line_->ask(Json{{"cmd", "hello"}}, answer_patience, [self = shared_from_this()](const MachineAnswer& answer) {
            const auto hello = Json::parse(answer.value_of("hello"), nullptr, false);
            if (!hello.is_object()) {
                self->note_error(answer);
                return self->line_->close("no hello");
            }
            self->name_ = text_in(hello, "machine");
            if (self->name_.empty()) self->name_ = self->path_;
            self->listen(read_lcm_offer(hello));
            self->line_->ask(Json{{"cmd", "layout"}}, answer_patience, [self](const MachineAnswer& layout) {
                if (const auto text = layout.value_of("layout"); !text.empty()) self->layout_ = text;
                self->change();
            });
        });
    }
    void close(const std::string& why) {
        if (line_) line_->close(why);
        questions_->close(why);
        if (lcm_) lcm_->close();
    }
    /// `watched`: somebody looks.
    void step(Instant at, bool watched) {
        if (line_) line_->expire(at);
        questions_->step(at);
        if (online() != std::exchange(told_online_, online())) change();
        if (lcm_) lcm_->step(at, watched && online());
        if (online() && watched) take_values(at);
    }

private:
    void listen(LcmOffer offer) {
        if (lcm_) lcm_->close();
        if (wanted_ == ValueSource::socket) offer.why_not = "the page's server was started with --source socket";
        lcm_ = std::make_shared<LcmValues>(io_, std::move(offer), name_);
    }
    void take_values(Instant at) {
        if (lcm_ && lcm_->delivers(at)) {
            tell_source("lcm", {});
            if (const auto state = lcm_->take()) take(state_json(*state), state->cycle_count, lcm_->came());
            return;
        }
        if (lcm_ && lcm_->may_come(at)) return;
        const auto why_not = lcm_ ? lcm_->why_not() : std::string{};
        tell_source(wanted_ == ValueSource::lcm ? "lcm" : "socket", why_not);
        if (wanted_ == ValueSource::lcm) why_ = why_not;
        else if (!asking_) ask_values();
    }
    void tell_source(std::string_view source, const std::string& why_not_lcm) {
        if (source == source_ && why_not_lcm == why_not_lcm_) return;
        source_ = source;
        why_not_lcm_ = why_not_lcm;
        change();
    }
    void change() {
        ++version_;
        changed_(*this);
    }
    void note_error(const MachineAnswer& answer) {
        const auto json = Json::parse("{" + answer.keys + "}", nullptr, false);
        if (json.is_object() && json.contains("error")) why_ = text_in(json["error"], "what");
    }
    void ask_values() {
        asking_ = true;
        line_->ask(Json{{"cmd", "state"}}, answer_patience, [self = shared_from_this()](const MachineAnswer& answer) {
            self->asking_ = false;
            const auto state = answer.value_of("state");
            if (state.empty()) return self->note_error(answer);
            self->take(state, cycle_of(state), now());
        });
    }
    void take(std::string_view state, std::int64_t cycle, Instant came) {
        if (cycle <= cycle_) {
            why_ = "the machine's cycle does not advance";
            return;  // old values are not sent as new ones
        }
        cycle_ = cycle;
        fresh_ = came;
        why_ = "the machine does not answer";
        auto text = "\"machine\":" + text_of(Json(name_));
        if (source_ == "lcm") text += fmt::format(R"(,"lost":{},"refused":{})", lcm_->lost(), lcm_->refused());
        text += ",\"state\":";
        text.append(state).push_back('}');
        values_ = std::make_shared<const std::string>(std::move(text));
        fresh_told_(*this);
    }

    asio::io_context& io_;
    std::string path_;
    ValueSource wanted_;
    std::string name_, why_ = "not asked yet", layout_ = "null";
    Told changed_, fresh_told_;
    std::shared_ptr<MachineLine> line_;
    std::shared_ptr<QuestionDesk> questions_;
    std::shared_ptr<LcmValues> lcm_;
    std::string_view source_;
    std::string why_not_lcm_;
    Outbox::Text values_;
    std::int64_t cycle_ = -1;
    Instant fresh_{};
    bool asking_ = false, told_online_ = false;
    std::uint64_t version_ = 0;
};

}  // namespace taktwerk::hmi::web

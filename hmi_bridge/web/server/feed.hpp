#pragma once
// What the server knows of one machine, and how it learns it: hello and layout when it comes, its state while somebody looks. Included by web_server.cpp alone.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "hmi_bridge/web/outbox.hpp"
#include "hmi_bridge/web/server/machine_line.hpp"
#include "hmi_bridge/web/server/question_desk.hpp"

namespace taktwerk::hmi::web {

class Feed : public std::enable_shared_from_this<Feed> {
public:
    using Told = std::function<void(Feed&)>;
    /// `changed`: what a hello tells is another. `fresh`: there are new values.
    Feed(asio::io_context& io, std::string path, Told changed, Told fresh)
        : io_(io),
          path_(std::move(path)),
          changed_(std::move(changed)),
          fresh_told_(std::move(fresh)),
          questions_(std::make_shared<QuestionDesk>(io, path_)) {}

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const std::string& name() const { return name_; }      ///< empty before its first hello
    [[nodiscard]] const std::string& why() const { return why_; }        ///< of being offline or stale
    [[nodiscard]] const std::string& layout() const { return layout_; }  ///< JSON; "null": not there
    [[nodiscard]] const Outbox::Text& values() const { return values_; }
    [[nodiscard]] Instant fresh() const { return fresh_; }            ///< when the cycle was last seen to advance
    [[nodiscard]] std::uint64_t version() const { return version_; }  ///< counts what a hello tells
    [[nodiscard]] bool connected() const { return line_ && !line_->closed(); }
    [[nodiscard]] bool online() const { return connected() && !name_.empty(); }
    [[nodiscard]] MachineLine& line() { return *line_; }

    [[nodiscard]] QuestionDesk& questions() { return *questions_; }

    void connect() {
        asking_ = false;
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
            self->line_->ask(Json{{"cmd", "layout"}}, answer_patience, [self](const MachineAnswer& layout) {
                if (const auto text = layout.value_of("layout"); !text.empty()) self->layout_ = text;
                self->change();
            });
        });
    }
    void close(const std::string& why) {
        if (line_) line_->close(why);
        questions_->close(why);
    }
    /// `watched`: somebody looks.
    void step(Instant at, bool watched) {
        if (line_) line_->expire(at);
        questions_->step(at);
        if (online() != std::exchange(told_online_, online())) change();
        if (online() && !asking_ && watched) ask_values();
    }

private:
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
            self->take(state, cycle_of(state));
        });
    }
    void take(std::string_view state, std::int64_t cycle) {
        if (cycle == cycle_) {
            why_ = "the machine's cycle does not advance";
            return;  // old values are not sent as new ones
        }
        cycle_ = cycle;
        fresh_ = now();
        why_ = "the machine does not answer";
        auto text = "\"machine\":" + text_of(Json(name_)) + ",\"state\":";
        text.append(state).push_back('}');
        values_ = std::make_shared<const std::string>(std::move(text));
        fresh_told_(*this);
    }

    asio::io_context& io_;
    std::string path_, name_, why_ = "not asked yet", layout_ = "null";
    Told changed_, fresh_told_;
    std::shared_ptr<MachineLine> line_;
    std::shared_ptr<QuestionDesk> questions_;
    Outbox::Text values_;
    std::int64_t cycle_ = -1;
    Instant fresh_{};
    bool asking_ = false, told_online_ = false;
    std::uint64_t version_ = 0;
};

}  // namespace taktwerk::hmi::web

#pragma once
// What pages only ask of a machine: over one connection for all of them, in turn, so that it delays neither values nor a stop, and takes no place at the
// machine from who commands. Included by web_server.cpp alone.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "hmi_bridge/web/question_turns.hpp"
#include "hmi_bridge/web/server/machine_line.hpp"

namespace taktwerk::hmi::web {

class QuestionDesk : public std::enable_shared_from_this<QuestionDesk> {
public:
    using Asker = std::uint64_t;
    QuestionDesk(asio::io_context& io, std::string path) : io_(io), path_(std::move(path)) {}

    void ask(Asker asker, Json request, Duration patience, MachineLine::Answer answer) {
        turns_.put(asker, {std::move(request), now() + patience, std::move(answer)});
        hand_on();
    }
    /// A page that is gone: what it has not yet asked is not asked any more.
    void forget(Asker asker) {
        turns_.remove([asker](Asker one, const Question&) { return one == asker; }, closed_answer("the page is gone"));
    }
    void step(Instant at) {
        if (const auto line = line_) line->expire(at);  // an answer may bring another line in its place
        turns_.remove([at](Asker, const Question& one) { return one.until <= at; },
                      [this](Question& one) {
                          one.answer(failed_answer(
                              {"socket.timeout", path_, "the machine's answers to other pages took all the time", "Ask again."}));
                      });
    }
    void close(const std::string& why) {
        closed_ = true;
        if (const auto line = line_) line->close(why);
        turns_.remove([](Asker, const Question&) { return true; }, closed_answer(why));
    }

private:
    struct Question {
        Json request;
        Instant until;
        MachineLine::Answer answer;
    };

    [[nodiscard]] std::function<void(Question&)> closed_answer(const std::string& why) const {
        return [path = path_, why](Question& one) { one.answer(failed_answer({"socket.closed", path, why, "Ask again."})); };
    }
    void hand_on() {
        // Answers may come at once, from within ask(): then the loop that is under way goes on.
        if (std::exchange(handing_on_, true)) return;
        while (auto next = closed_ ? std::nullopt : turns_.next()) {
            if (!line_ || line_->closed()) {
                line_ = std::make_shared<MachineLine>(io_, path_);
                line_->open();
            }
            line_->ask(
                std::move(next->second.request), next->second.until - now(),
                [self = shared_from_this(), asker = next->first, answer = std::move(next->second.answer)](const MachineAnswer& given) {
                    self->turns_.answered(asker);
                    answer(given);
                    self->hand_on();
                });
        }
        handing_on_ = false;
    }

    asio::io_context& io_;
    std::string path_;
    std::shared_ptr<MachineLine> line_;
    QuestionTurns<Question> turns_;
    bool handing_on_ = false, closed_ = false;
};

}  // namespace taktwerk::hmi::web

#include "hmi_bridge/web/outbox.hpp"

#include <utility>

namespace taktwerk::hmi::web {

bool Outbox::put(std::string message) {
    // After a gap nothing is queued until the page has been told of it: the gap stands where it happened.
    if (missed_ > 0 || queue_.size() >= most_messages || bytes_ + message.size() > most_bytes) {
        ++missed_;
        return false;
    }
    bytes_ += message.size();
    queue_.push_back(std::move(message));
    return true;
}

bool Outbox::put_answer(std::string message) {
    if (message.size() < long_from || missed_ > 0 || long_bytes_ + message.size() > most_long_bytes) return put(std::move(message));
    long_bytes_ += message.size();
    long_.push_back(std::move(message));
    return true;
}

void Outbox::put_state(Text rest, Instant got) {
    state_ = std::move(rest);
    got_ = got;
}

Outbox::Text Outbox::next(Instant now) {
    if (!queue_.empty()) {
        auto message = std::make_shared<const std::string>(std::move(queue_.front()));
        queue_.pop_front();
        bytes_ -= message->size();
        return message;
    }
    if (missed_ > 0)
        return std::make_shared<const std::string>(R"({"type":"gap","missed":)" + std::to_string(std::exchange(missed_, 0)) + "}");
    if (turn_of_long_ || !state_)
        if (auto message = next_long()) return message;
    return next_state(now);
}

Outbox::Text Outbox::next_long() {
    if (long_.empty()) return nullptr;
    turn_of_long_ = false;
    auto message = std::make_shared<const std::string>(std::move(long_.front()));
    long_.pop_front();
    long_bytes_ -= message->size();
    return message;
}

Outbox::Text Outbox::next_state(Instant now) {
    const auto rest = std::exchange(state_, nullptr);
    if (!rest) return nullptr;
    turn_of_long_ = true;
    const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(now - got_).count();
    return std::make_shared<const std::string>(R"({"type":"state","age_ms":)" + std::to_string(age) + "," + *rest);
}

}  // namespace taktwerk::hmi::web

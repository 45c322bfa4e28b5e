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
    const auto rest = std::exchange(state_, nullptr);
    if (!rest) return nullptr;
    const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(now - got_).count();
    return std::make_shared<const std::string>(R"({"type":"state","age_ms":)" + std::to_string(age) + "," + *rest);
}

}  // namespace taktwerk::hmi::web

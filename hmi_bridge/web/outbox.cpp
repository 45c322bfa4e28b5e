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

Outbox::Text Outbox::next() {
    if (!queue_.empty()) {
        auto message = std::make_shared<const std::string>(std::move(queue_.front()));
        queue_.pop_front();
        bytes_ -= message->size();
        return message;
    }
    if (missed_ > 0)
        return std::make_shared<const std::string>(R"({"type":"gap","missed":)" + std::to_string(std::exchange(missed_, 0)) + "}");
    return std::exchange(state_, nullptr);
}

}  // namespace taktwerk::hmi::web

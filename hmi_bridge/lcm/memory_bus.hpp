#pragma once
// A message bus inside one process: deterministic, for tests and for machines without LCM on the way.

#include <algorithm>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hmi_bridge/lcm/message_bus.hpp"

namespace taktwerk::hmi {

class MemoryBus final : public MessageBus {
public:
    struct Message {
        std::string channel;
        std::vector<std::byte> bytes;
    };

    bool publish(std::string_view channel, std::span<const std::byte> message) override {
        if (refuse) return false;
        Message copy{std::string(channel), {message.begin(), message.end()}};
        if (handlers_.count(copy.channel) != 0) waiting_.push_back(copy);
        published.push_back(std::move(copy));
        return true;
    }
    void subscribe(std::string_view channel, Handler handler) override { handlers_[std::string(channel)] = std::move(handler); }
    int poll(int most) override {
        int done = 0;
        for (; done < most && !waiting_.empty(); ++done) {
            const auto message = std::move(waiting_.front());
            waiting_.pop_front();
            handlers_[message.channel](message.bytes);
        }
        return done;
    }

    std::vector<Message> published;  ///< everything so far, for whoever looks
    bool refuse = false;             ///< publishing fails

private:
    std::map<std::string, Handler> handlers_;
    std::deque<Message> waiting_;
};

}  // namespace taktwerk::hmi

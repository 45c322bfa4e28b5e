#pragma once
// An input of a target that reads lines is several messages. How many there were altogether is said at the end, for who wants a number of messages.

#include <cstdint>
#include <cstdio>

namespace taktwerk::fuzz {

class MessageCount {
public:
    MessageCount() = default;
    ~MessageCount() { std::fprintf(stderr, "messages: %llu\n", static_cast<unsigned long long>(count_)); }
    MessageCount(const MessageCount&) = delete;
    MessageCount& operator=(const MessageCount&) = delete;
    void one() noexcept { ++count_; }

private:
    std::uint64_t count_ = 0;
};

}  // namespace taktwerk::fuzz

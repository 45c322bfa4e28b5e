#pragma once
// What waits for one page. Of values only the newest waits; everything else in order, bounded, with the number of what had to be dropped. Not thread-safe.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

namespace taktwerk::hmi::web {

class Outbox {
public:
    static constexpr std::size_t most_messages = 64;
    static constexpr std::size_t most_bytes = 512 * 1024;

    using Text = std::shared_ptr<const std::string>;  ///< several pages get the same state

    /// False: dropped and counted; `gap` comes next.
    bool put(std::string message);
    /// Takes the place of one that has not gone out yet.
    void put_state(Text state) { state_ = std::move(state); }
    /// What to send next, null when nothing waits: messages in order, where some are missing their number, then the state.
    [[nodiscard]] Text next();
    [[nodiscard]] bool empty() const { return queue_.empty() && !state_ && missed_ == 0; }

private:
    std::deque<std::string> queue_;
    std::size_t bytes_ = 0;
    std::uint64_t missed_ = 0;
    Text state_;
};

}  // namespace taktwerk::hmi::web

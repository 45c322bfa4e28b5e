#pragma once
// What waits for one page. Of values only the newest waits; everything else in order, bounded, with the number of what had to be dropped. Not thread-safe.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "core/time.hpp"

namespace taktwerk::hmi::web {

class Outbox {
public:
    static constexpr std::size_t most_messages = 64;
    static constexpr std::size_t most_bytes = 512 * 1024;

    using Text = std::shared_ptr<const std::string>;  ///< several pages get the same state

    /// False: dropped and counted; `gap` comes next.
    bool put(std::string message);
    /// Takes the place of one that has not gone out yet. `rest`: the keys behind `age_ms`, with the closing brace; `got`: when it came from the machine.
    void put_state(Text rest, Instant got);
    /// Nothing of before is sent any more: another machine is watched, or its values are stale.
    void drop_state() { state_ = nullptr; }
    /// What to send next, null when nothing waits: messages in order, where some are missing their number, then the state.
    [[nodiscard]] Text next(Instant now);
    [[nodiscard]] bool empty() const { return queue_.empty() && !state_ && missed_ == 0; }

private:
    std::deque<std::string> queue_;
    std::size_t bytes_ = 0;
    std::uint64_t missed_ = 0;
    Text state_;
    Instant got_{};
};

}  // namespace taktwerk::hmi::web

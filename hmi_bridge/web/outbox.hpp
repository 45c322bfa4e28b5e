#pragma once
// What waits for one page. Of values only the newest waits; everything else in order, bounded, with the number of what had to be dropped. A long answer
// goes behind what is short, so that it delays no other; it and the values take turns. Not thread-safe.

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
    static constexpr std::size_t long_from = 32 * 1024;              ///< bytes of a message
    static constexpr std::size_t most_long_bytes = 8 * 1024 * 1024;  ///< two of the longest answers

    using Text = std::shared_ptr<const std::string>;  ///< several pages get the same state

    /// False: dropped and counted; `gap` comes next.
    bool put(std::string message);
    /// The same, but a long one waits apart and goes behind what is short. Only what stands for itself: it may be overtaken.
    bool put_answer(std::string message);
    /// Takes the place of one that has not gone out yet. `rest`: the keys behind `age_ms`, with the closing brace; `got`: when it came from the machine.
    void put_state(Text rest, Instant got);
    /// Nothing of before is sent any more: another machine is watched, or its values are stale.
    void drop_state() { state_ = nullptr; }
    /// What to send next, null when nothing waits: messages in order, where some are missing their number, then the state.
    [[nodiscard]] Text next(Instant now);
    [[nodiscard]] bool empty() const { return queue_.empty() && long_.empty() && !state_ && missed_ == 0; }

private:
    Text next_state(Instant now);
    Text next_long();

    std::deque<std::string> queue_, long_;
    std::size_t bytes_ = 0, long_bytes_ = 0;
    bool turn_of_long_ = false;
    std::uint64_t missed_ = 0;
    Text state_;
    Instant got_{};
};

}  // namespace taktwerk::hmi::web

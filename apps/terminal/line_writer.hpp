#pragma once
// Lines onto a terminal, a pipe or a file that may not take them: Ctrl-S, a pager, a reader that is gone, a full disk. A thread of its own
// writes; whoever has something to say never waits. What does not fit is dropped and counted, and the count is said once there is room.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "core/time.hpp"

namespace taktwerk::apps {

class LineWriter {
public:
    static constexpr std::size_t most_bytes = 1024 * 1024;  ///< waiting

    /// `missing`: the text that says how many were dropped. Blocks all signals in its thread: they are for others.
    LineWriter(int descriptor, std::function<std::string(std::uint64_t)> missing);
    /// finish() with a second of patience.
    ~LineWriter();
    LineWriter(const LineWriter&) = delete;
    LineWriter& operator=(const LineWriter&) = delete;

    /// Any thread. One or several whole lines.
    void put(std::string lines);
    [[nodiscard]] std::uint64_t dropped() const;
    /// What waits goes out, as far as it does within `patience`; nothing is taken any more. A thread that hangs in the kernel is left behind.
    void finish(Duration patience);

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
    std::thread thread_;
};

}  // namespace taktwerk::apps

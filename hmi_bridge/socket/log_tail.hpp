#pragma once
// The last lines of the runtime's log, for who asks over the socket: bounded, any thread writes and reads. Not real-time.

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::hmi {

class LogTail {
public:
    static constexpr std::size_t most_lines = 2000;
    static constexpr std::size_t longest = 2000;  ///< bytes of a line; the rest is cut off

    struct Line {
        std::uint64_t number = 0;  ///< counts from 1
        std::string text;
    };

    /// Any text: what has several lines becomes several.
    void add(std::string_view lines);
    /// Those behind `after`, oldest first; of more than `most` the newest.
    [[nodiscard]] std::vector<Line> after(std::uint64_t number, std::size_t most) const;
    /// Number of the newest line; 0: none.
    [[nodiscard]] std::uint64_t last() const;

private:
    mutable std::mutex mutex_;
    std::deque<Line> lines_;
    std::uint64_t last_ = 0;
};

}  // namespace taktwerk::hmi

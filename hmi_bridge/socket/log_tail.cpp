#include "hmi_bridge/socket/log_tail.hpp"

#include <algorithm>

namespace taktwerk::hmi {

void LogTail::add(std::string_view lines) {
    const std::lock_guard lock{mutex_};
    while (!lines.empty()) {
        const auto end = std::min(lines.find('\n'), lines.size());
        if (end > 0) lines_.push_back({++last_, std::string(lines.substr(0, std::min(end, longest)))});
        if (lines_.size() > most_lines) lines_.pop_front();
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

std::vector<LogTail::Line> LogTail::after(std::uint64_t number, std::size_t most) const {
    const std::lock_guard lock{mutex_};
    const auto first =
        std::upper_bound(lines_.begin(), lines_.end(), number, [](std::uint64_t n, const Line& line) { return n < line.number; });
    const auto there = static_cast<std::size_t>(lines_.end() - first);
    return {lines_.end() - static_cast<std::ptrdiff_t>(std::min(there, most)), lines_.end()};
}

std::uint64_t LogTail::last() const {
    const std::lock_guard lock{mutex_};
    return last_;
}

}  // namespace taktwerk::hmi

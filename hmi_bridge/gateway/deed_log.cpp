#include "hmi_bridge/gateway/deed_log.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::hmi {

void DeedLog::say(const std::string& who, std::string_view what, Instant now) {
    if (!log_) return;
    if (allowances_.size() >= remembered && allowances_.count(who) == 0)
        allowances_.erase(std::min_element(allowances_.begin(), allowances_.end(),
                                           [](const auto& a, const auto& b) { return a.second.since < b.second.since; }));
    auto [found, is_new] = allowances_.try_emplace(who);
    auto& mine = found->second;
    if (!is_new) mine.lines = std::min(burst, mine.lines + each_second * to_seconds(now - mine.since));
    mine.since = now;
    if (mine.lines < 1) {
        ++mine.left_out;
        return;
    }
    mine.lines -= 1;
    log_(mine.left_out == 0 ? fmt::format("{}: {}", who, what)
                            : fmt::format("{}: {} ({} things it did before are not listed: too many)", who, what, mine.left_out));
    mine.left_out = 0;
}

}  // namespace taktwerk::hmi

#include "apps/machine/status_line.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "hmi_bridge/words/words.hpp"

namespace taktwerk::apps {

bool StatusLine::due(Instant now) noexcept {
    if (now < next_) return false;
    next_ = now + std::chrono::seconds{1};
    return true;
}

std::string StatusLine::text(const runtime::Snapshot& s) {
    const auto powered = std::count_if(s.axes.begin(), s.axes.end(), [](const auto& axis) { return axis.powered; });
    const auto stopping = std::count_if(s.alarms.begin(), s.alarms.begin() + static_cast<std::ptrdiff_t>(s.alarm_count),
                                        [](const auto& alarm) { return alarm.reaction > Reaction::warn; });
    return fmt::format("{}, {} mode, {} of {} axes powered, {}{}{}", hmi::word(s.phase), hmi::word(s.mode), powered, s.axes.size(),
                       stopping == 0   ? std::string("no alarm")
                       : stopping == 1 ? std::string("1 alarm")
                                       : fmt::format("{} alarms", stopping),
                       s.emergency_stop ? ", EMERGENCY STOP" : "", s.simulated ? ", SIMULATED bus" : "");
}

}  // namespace taktwerk::apps

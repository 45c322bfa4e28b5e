#include "apps/lcm/player.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "hmi_bridge/lcm_types/message_reader.hpp"

namespace taktwerk::apps {

std::optional<std::regex> name_pattern(const std::string& text) {
    try {
        return std::regex(text.empty() ? ".*" : text);
    } catch (const std::regex_error&) {
        return std::nullopt;
    }
}

bool is_command(const LoggedMessage& message, const hmi::TypeCatalog& catalog) {
    if (std::string_view(message.channel).ends_with("COMMAND")) return true;
    const auto fingerprint = hmi::fingerprint_of(message.data);
    const auto* type = fingerprint ? catalog.find(*fingerprint) : nullptr;
    return type != nullptr && type->full_name() == "taktwerk_lcm.command_v1_t";
}

LogContent look_through(LogReader& log, const std::regex& channels, Commands commands, const hmi::TypeCatalog& catalog) {
    LogContent out;
    bool any = false;
    while (const auto message = log.next()) {
        if (!std::regex_match(message->channel, channels)) continue;
        if (commands == Commands::left_out && is_command(*message, catalog)) {
            ++out.commands;
            continue;
        }
        ++out.chosen[message->channel];
        if (!any) out.first_utime = message->utime;
        out.last_utime = std::max(any ? out.last_utime : message->utime, message->utime);
        any = true;
    }
    return out;
}

std::optional<Error> play_hazard(const LogContent& content, const hmi::LcmUrl& url, const std::set<std::string>& heard) {
    if (url.leaves_host())
        return Error{"lcm.play_leaves_host", url.text,
                     fmt::format("with ttl={} every HMI of the network would show the past as the present", url.ttl),
                     "Play with ttl=0 on this computer, or say --force."};
    for (const auto& [channel, count] : content.chosen)
        if (heard.count(channel) != 0)
            return Error{"lcm.play_over_live", channel,
                         "somebody publishes on this channel now: a live HMI would show the past between the present",
                         "End that machine, play on another port (--url 'udpm://239.255.76.67:7668?ttl=0'), or say --force."};
    return std::nullopt;
}

Instant PlayClock::due(std::int64_t utime) const {
    if (speed_ <= 0 || utime <= first_) return start_;
    constexpr double longest = 1e9;  // s: a stamp may be anything, and a clock has an end
    return start_ + from_seconds(std::min(longest, (static_cast<double>(utime) - static_cast<double>(first_)) / 1e6 / speed_));
}

}  // namespace taktwerk::apps

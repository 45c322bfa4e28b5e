#pragma once
// What of a log may be played, and when each message of it is due. Logic alone.

#include <cstdint>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "apps/lcm/log_file.hpp"
#include "core/time.hpp"
#include "hmi_bridge/lcm/lcm_url.hpp"
#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::apps {

/// Of channels, whole names. Nothing: no regular expression. Empty: every channel.
[[nodiscard]] std::optional<std::regex> name_pattern(const std::string& text);

/// A command, by its channel or by its type: whoever plays one moves a machine.
[[nodiscard]] bool is_command(const LoggedMessage& message, const hmi::TypeCatalog& catalog);

/// What is in a log.
struct LogContent {
    std::map<std::string, std::uint64_t> chosen;  ///< messages that will be played, by channel
    std::uint64_t commands = 0;                   ///< left out
    std::int64_t first_utime = 0, last_utime = 0;
};
enum class Commands : std::uint8_t { left_out, played };
[[nodiscard]] LogContent look_through(LogReader& log, const std::regex& channels, Commands commands, const hmi::TypeCatalog& catalog);

/// Played state may not look like a machine's. `heard`: channels on which somebody publishes now. Errors: lcm.play_leaves_host, lcm.play_over_live.
[[nodiscard]] std::optional<Error> play_hazard(const LogContent& content, const hmi::LcmUrl& url, const std::set<std::string>& heard);

/// When messages are due: by their stamps from the first, never from one to the next, so that nothing adds up. Stamps that go back are due at once.
class PlayClock {
public:
    /// `speed`: above 0; 0: without waiting.
    PlayClock(Instant start, std::int64_t first_utime, double speed) : start_(start), first_(first_utime), speed_(speed) {}
    [[nodiscard]] Instant due(std::int64_t utime) const;

private:
    Instant start_;
    std::int64_t first_;
    double speed_;
};

}  // namespace taktwerk::apps

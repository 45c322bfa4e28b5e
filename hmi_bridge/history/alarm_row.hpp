#pragma once
// One alarm as the history keeps it, and what one may ask for. Plain data.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm.hpp"

namespace taktwerk::hmi {

enum class AlarmState : std::uint8_t {
    stands,   ///< its condition holds
    waits,    ///< the condition is gone; somebody has to acknowledge or reset it
    gone,     ///< it has left the list
    unknown,  ///< the runtime ended while it was listed: nobody saw how it went on
};
[[nodiscard]] constexpr std::string_view word(AlarmState state) noexcept {
    constexpr std::string_view words[]{"stands", "waits", "gone", "unknown"};
    return words[static_cast<std::size_t>(state)];
}

struct AlarmRow {
    std::int64_t id = 0;                  ///< of the file: increasing, never used again
    std::int64_t utime = 0;               ///< us since 1970: it was raised
    std::int64_t cleared_utime = 0;       ///< its condition was gone for the last time; 0: holds, or unknown
    std::int64_t acknowledged_utime = 0;  ///< somebody acknowledged or reset it; 0: nobody has
    AlarmState state = AlarmState::stands;
    AlarmId alarm = 0;
    std::uint32_t count = 1;  ///< times raised while it was listed
    Reaction reaction = Reaction::none;
    std::string name, source;  ///< "following_error", "axis x"
    std::string english, chinese, cause, remedy;
    std::string manual;     ///< section of the drive's manual; may be empty
    std::string recording;  ///< what was recorded around it; may be empty
};

struct HistoryQuery {
    std::int64_t before = INT64_MAX;                        ///< ids below this one; pages go on with the last id of the page before
    std::int64_t since_utime = 0, until_utime = INT64_MAX;  ///< raised in this time, both ends included
    std::string text;    ///< stands somewhere in name, source, a text, cause or remedy; capitals of ASCII do not matter; empty: any
    std::string source;  ///< exactly; empty: any
    int limit = 100;     ///< 1..most_rows
};

inline constexpr int most_rows = 500;  ///< of one answer

struct HistoryPage {
    std::vector<AlarmRow> rows;  ///< newest first
    bool more = false;           ///< there are older ones
};

}  // namespace taktwerk::hmi

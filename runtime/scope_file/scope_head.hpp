#pragma once
// What a recording says of itself: whose rows they are, which signals, around which alarms. As JSON in the file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/recording/recorded_signal.hpp"

namespace taktwerk::runtime {

struct ScopeHead {
    struct Alarm {
        std::uint16_t id = 0;
        std::string name, source, english, chinese;  ///< "following_error", "axis x", words
        std::uint64_t cycle = 0;                     ///< in which it was raised
        friend bool operator==(const Alarm&, const Alarm&) = default;
    };
    std::string machine;
    Duration cycle{};       ///< from row to row, > 0
    std::size_t words = 0;  ///< of a row, 1 to 65535
    std::vector<RecordedSignal> signals;
    std::uint64_t first_cycle = 1;  ///< of the first row
    std::int64_t utime = 0;         ///< calendar time of the first alarm, us since 1970
    bool cut = false;               ///< the machine ended, or rows were overwritten, before all was there that belongs into it
    std::vector<Alarm> alarms;      ///< those that it was kept for; the first gave it its name
    friend bool operator==(const ScopeHead&, const ScopeHead&) = default;
};

[[nodiscard]] std::string head_json(const ScopeHead& head);
/// Errors: recording.damaged, with what is wrong. What it returns can be used without looking: every cell lies in its row.
[[nodiscard]] Result<ScopeHead> parse_head(std::string_view json, const std::string& subject);

}  // namespace taktwerk::runtime

#pragma once
// What of a command stands in its line of the audit: bounded, for what is refused may be anybody's text; and one line wherever it is shown. Nothing throws.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/time.hpp"

namespace taktwerk::hmi::web {

/// Bytes of a request or an error as text that are written down; of a longer one its beginning and its size.
constexpr std::size_t longest_in_audit = 1024;

/// The object itself, or {"begins": its first bytes, "bytes": its size}.
[[nodiscard]] nlohmann::ordered_json bounded(const nlohmann::ordered_json& object);
/// As JSON in which no character moves a terminal's cursor, ends a line or turns the direction of text: C0, C1, DEL, U+2028, U+202E and kin stand as \uXXXX.
[[nodiscard]] std::string audit_text(const nlohmann::ordered_json& line);

/// How many refusals are written down one by one: so many that nobody can push what others did out of the file. The rest is counted. Not thread-safe.
class RefusalBudget {
public:
    static constexpr double at_once = 40;                          ///< of one who
    static constexpr Duration one_more = std::chrono::seconds{2};  ///< then one each
    static constexpr Duration told_after = std::chrono::seconds{10};

    struct Unwritten {
        std::string who;
        std::uint64_t times = 0;
    };

    /// Whether this refusal of `who` is written. False: it is counted.
    bool take(std::string_view who, Instant now);
    /// One whose count is due: written as one line; nothing: none. `all`: due or not.
    std::optional<Unwritten> next_unwritten(Instant now, bool all = false);

private:
    struct Bucket {
        double used = 0;
        Instant at{}, since{};
        std::uint64_t times = 0;
    };
    std::map<std::string, Bucket, std::less<>> buckets_;  ///< only of who has been refused of late
};

}  // namespace taktwerk::hmi::web

#pragma once
// How old a request may be when its turn comes. What was given, and has waited since (for a runtime that stood still, behind a connection that hung), is not what
// the hand wants now. Not real-time.

#include <optional>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::hmi {

struct RequestAge {
    static constexpr Duration longest_validity = std::chrono::seconds{10};
    static constexpr Duration clock_tolerance = std::chrono::seconds{1};  ///< between the client's clock and the runtime's

    Duration valid_for = std::chrono::seconds{1};
    Duration age{};     ///< since the client gave it, by the common wall clock; negative: the clocks disagree
    Instant arrived{};  ///< when it had reached the process; the epoch: just now

    /// Since it was given, as far as anybody knows: by the client's clock, and by how long it has waited here, whichever is longer.
    [[nodiscard]] Duration at(Instant now) const noexcept;
    /// Errors: command.bad_value (valid for less than 1 ms or more than `longest`).
    [[nodiscard]] std::optional<Error> refuse_validity(Duration longest = longest_validity) const;
    /// Errors: command.stale (too old, or from a clock that is ahead).
    [[nodiscard]] std::optional<Error> refuse_age(Instant now) const;
};

}  // namespace taktwerk::hmi

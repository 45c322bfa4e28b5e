#pragma once
// Time as the whole runtime uses it: integer nanoseconds on one monotonic axis. No file above core/ names another clock.

#include <chrono>
#include <cstdint>

namespace taktwerk {

using Duration = std::chrono::nanoseconds;

/// The time axis of one running machine. It has no `now()` on purpose: control code is handed the time (core/clock.hpp).
struct MachineTime {
    using duration = Duration;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<MachineTime, duration>;
    static constexpr bool is_steady = true;
};

using Instant = MachineTime::time_point;

/// Seconds as a double, for planners and physics. Exact below 2^53 ns (104 days).
[[nodiscard]] constexpr double to_seconds(Duration d) noexcept { return std::chrono::duration<double>(d).count(); }

/// Nearest nanosecond.
[[nodiscard]] constexpr Duration from_seconds(double s) noexcept {
    const double ns = s * 1e9;
    return Duration{static_cast<std::int64_t>(ns < 0 ? ns - 0.5 : ns + 0.5)};
}

}  // namespace taktwerk

#include "apps/doctor/clock_watch.hpp"

#include <ctime>

#include "core/calendar_distance.hpp"

namespace taktwerk::apps {
namespace {

/// NTP steers by 500 ppm at most: 0.05 ms between two looks. What is more was set.
constexpr Duration step = std::chrono::milliseconds{1};

std::int64_t nanoseconds(clockid_t clock) {
    timespec t{};
    ::clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

bool is_step(Duration before, Duration after) noexcept { return after - before > step || before - after > step; }

ClockWatch::ClockWatch()
    : calendar_(calendar_minus_machine_time()),
      monotonic_(nanoseconds(CLOCK_MONOTONIC)),
      raw_(nanoseconds(CLOCK_MONOTONIC_RAW)),
      last_monotonic_(monotonic_),
      last_raw_(raw_) {}

void ClockWatch::look() {
    const auto now = calendar_minus_machine_time();
    if (is_step(calendar_, now)) {
        ++seen_.steps;
        const auto by = now - calendar_;
        if (by > seen_.largest_step || -by > seen_.largest_step) seen_.largest_step = by;
    }
    calendar_ = now;
    last_monotonic_ = nanoseconds(CLOCK_MONOTONIC);
    last_raw_ = nanoseconds(CLOCK_MONOTONIC_RAW);
}

ClockFacts ClockWatch::facts() const {
    auto facts = seen_;
    const auto raw = static_cast<double>(last_raw_ - raw_);
    if (raw > 0) facts.steered_ppm = (static_cast<double>(last_monotonic_ - monotonic_) / raw - 1) * 1e6;
    return facts;
}

}  // namespace taktwerk::apps

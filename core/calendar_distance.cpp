#include "core/calendar_distance.hpp"

#include <cstdint>
#include <ctime>

namespace taktwerk {

namespace {

std::int64_t clock_ns(clockid_t clock) noexcept {
    timespec t{};
    ::clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

Duration calendar_minus_machine_time() noexcept {
    std::int64_t tightest = INT64_MAX, distance = 0;
    for (int i = 0; i < 5; ++i) {  // the attempt that was disturbed least
        const std::int64_t before = clock_ns(CLOCK_MONOTONIC), calendar = clock_ns(CLOCK_REALTIME), after = clock_ns(CLOCK_MONOTONIC);
        if (after - before >= tightest) continue;
        tightest = after - before;
        distance = calendar - before - tightest / 2;
    }
    return Duration{distance};
}

}  // namespace taktwerk

#include "core/clock.hpp"

#include <cerrno>
#include <ctime>

namespace taktwerk {

Instant SystemClock::now() const noexcept {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return Instant{std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec}};
}

void SystemClock::sleep_until(Instant deadline) noexcept {
    const auto ns = deadline.time_since_epoch().count();
    if (ns <= 0) return;  // before boot: long past, and the kernel refuses negative times
    const timespec t{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {  // a signal came: keep waiting
    }
}

}  // namespace taktwerk

#pragma once
// What happens to this computer's clocks meanwhile: whether somebody sets the calendar, and how fast the machine's clock is made to run. Not real-time.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::apps {

struct ClockFacts {
    int steps = 0;            ///< the calendar clock was set: so often ...
    Duration largest_step{};  ///< ... by so much at most, signed
    double steered_ppm = 0;   ///< CLOCK_MONOTONIC against CLOCK_MONOTONIC_RAW: somebody (NTP, PTP) makes it run faster by so much
};

/// look() some ten times a second, from one thread.
class ClockWatch {
public:
    ClockWatch();
    void look();
    [[nodiscard]] ClockFacts facts() const;

private:
    Duration calendar_{};  // minus CLOCK_MONOTONIC, when it was looked at last
    std::int64_t monotonic_ = 0, raw_ = 0, last_monotonic_ = 0, last_raw_ = 0;
    ClockFacts seen_;
};

/// Of two distances between calendar and machine time, one look apart.
[[nodiscard]] bool is_step(Duration before, Duration after) noexcept;

}  // namespace taktwerk::apps

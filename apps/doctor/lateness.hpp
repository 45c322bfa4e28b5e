#pragma once
// How late a thread wakes, measured as cyclictest measures it: an absolute grid of instants on CLOCK_MONOTONIC, clock_nanosleep to each, and the
// distance from the instant to the moment at which the thread runs. The thread is prepared as that of a machine's cycle.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/realtime.hpp"
#include "core/time.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::apps {

/// Durations counted by whole us, like cyclictest's histogram.
class MicrosecondHistogram {
public:
    static constexpr std::size_t bins = 10'000;  ///< the last one holds all that is longer

    void record(Duration duration) noexcept;
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] double max_us() const noexcept { return to_seconds(max_) * 1e6; }
    /// What `percent` of the samples do not exceed, us (whole ones, rounded down as cyclictest does); 0 while empty.
    [[nodiscard]] double percentile_us(double percent) const noexcept;
    /// Samples of at least this.
    [[nodiscard]] std::uint64_t at_least(Duration limit) const noexcept;
    [[nodiscard]] const std::vector<std::uint32_t>& all() const noexcept { return counts_; }

private:
    std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(bins + 1);
    std::uint64_t count_ = 0;
    Duration max_{};
};

struct LatenessPlan {
    Duration interval = std::chrono::milliseconds{1};
    Duration lasts = std::chrono::seconds{5};
    int cpu = -1;       ///< -1: any
    int priority = 80;  ///< as `realtime.priority` of a machine has it
};

struct Lateness {
    MicrosecondHistogram woken;
    RealtimeReport granted;  ///< of the thread, and of the process
};

/// What goes over a bus beside it: each interval one frame with a BRD of register 0000h, which changes nothing in any slave.
struct RoundTrips {
    MicrosecondHistogram took;  ///< from the time given to send() to the kernel's receive stamp
    std::uint64_t sent = 0, answered = 0;
    unsigned slaves = 0;  ///< that the answers met
};

/// Takes `plan.lasts` on a thread of its own. `bus`: nullptr: none.
[[nodiscard]] Lateness measure_lateness(const LatenessPlan& plan, ecat::Transport* bus = nullptr, RoundTrips* trips = nullptr);

}  // namespace taktwerk::apps

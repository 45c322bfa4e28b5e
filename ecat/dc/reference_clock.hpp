#pragma once
// What the cycle knows about the reference clock: one sample a cycle, the time the reference put into a frame against the
// machine time at which that frame left. Yields the offset between the two clocks and how fast it changes, and so the system time
// at any instant, also while samples are missing. Integer arithmetic, deterministic, real-time safe; one thread.
//
// A filter of second order (alpha-beta): a steady drift leaves no error. It begins as the least-squares line through all samples
// so far and ends with a memory of some `memory` samples.

#include <cstdint>
#include <optional>

#include "core/time.hpp"

namespace taktwerk::ecat {

class ReferenceClock {
public:
    /// A sample further than this from where the offset was expected is an outlier: it is not believed ...
    static constexpr Duration outlier_limit = std::chrono::microseconds{100};
    /// ... unless this many in a row say so and agree with each other: then the reference was set anew, and its time is taken as
    /// it is. A clock that stands never agrees with itself.
    static constexpr std::uint32_t outliers_until_new_start = 20;
    /// Samples after which the estimate is as good as it gets.
    static constexpr std::uint32_t memory = 256;
    /// Two quartzes are not further apart than this, parts per billion: what looks faster is noise.
    static constexpr std::int64_t largest_drift_ppb = 500'000;

    /// The reference itself put `system_time` (ns) into the frame that left at `sent`. False: an outlier, counted as rejected.
    bool take(Instant sent, std::int64_t system_time) noexcept;
    /// No sample came, or one that the reference did not put in.
    void miss() noexcept {
        ++rejected_;
        ++rejected_in_a_row_;
    }

    /// There has been a sample.
    [[nodiscard]] bool known() const noexcept { return known_; }
    /// Reference clock minus machine time, ns, at the last sample; smoothed. Nothing before the first sample.
    [[nodiscard]] std::optional<std::int64_t> offset() const noexcept;
    /// The same at `t`, at most a minute after the last sample; 0 before the first.
    [[nodiscard]] std::int64_t offset_at(Instant t) const noexcept;
    /// How fast the offset changes, ns per s: positive when the reference runs faster than the machine.
    [[nodiscard]] std::int64_t drift_ppb() const noexcept { return rate_ / rate_one; }
    /// ns / 65536 in `period`, without the rounding of drift_ppb().
    [[nodiscard]] std::int64_t drift_in(Duration period) const noexcept;
    /// The offset is more than a first impression; its drift may not be.
    [[nodiscard]] bool measured() const noexcept { return samples_ >= memory / 16; }
    /// Enough samples since the last new start to act on.
    [[nodiscard]] bool settled() const noexcept { return in_a_row_ >= memory / 4; }
    [[nodiscard]] Instant last_sample() const noexcept { return at_; }
    [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }  ///< missing and outliers
    [[nodiscard]] std::uint32_t rejected_in_a_row() const noexcept { return rejected_in_a_row_; }
    [[nodiscard]] std::uint32_t samples() const noexcept { return samples_; }  ///< that were believed; wraps

    static constexpr std::int64_t fine = 65536;  ///< parts of a ns

private:
    static constexpr std::int64_t rate_one = 256;  // parts of a ppb
    void start(Instant sent, std::int64_t offset) noexcept;

    bool known_ = false;
    Instant at_{};
    std::int64_t offset_ = 0;  // ns, at at_
    std::int64_t part_ = 0;    // and ns / fine
    std::int64_t rate_ = 0;    // ppb / rate_one
    std::uint32_t in_a_row_ = 0;
    std::uint32_t outliers_ = 0;  // in a row, near each other
    std::int64_t outlier_offset_ = 0, last_ = 0;
    std::uint64_t rejected_ = 0;
    std::uint32_t rejected_in_a_row_ = 0;
    std::uint32_t samples_ = 0;
};

}  // namespace taktwerk::ecat

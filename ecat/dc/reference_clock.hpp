#pragma once
// What the cycle knows about the reference clock: one sample a cycle, the time the reference put into a frame against the
// machine time at which that frame left. Yields the offset between the two clocks and how fast it changes. Integer arithmetic,
// deterministic, real-time safe; one thread.

#include <cstdint>
#include <optional>

#include "core/time.hpp"

namespace taktwerk::ecat {

class ReferenceClock {
public:
    /// A sample further than this from where the offset was expected is an outlier: it is not believed ...
    static constexpr Duration outlier_limit = std::chrono::microseconds{100};
    /// ... unless this many in a row say so: then the reference was set anew, and its time is taken as it is.
    static constexpr std::uint32_t outliers_until_new_start = 20;

    /// The reference itself put `system_time` (ns) into the frame that left at `sent`. False: an outlier, counted as rejected.
    bool take(Instant sent, std::int64_t system_time) noexcept;
    /// No sample came, or one that the reference did not put in.
    void miss() noexcept { ++rejected_; }

    /// Reference clock minus machine time, ns, at sending; smoothed. Nothing before the first sample.
    [[nodiscard]] std::optional<std::int64_t> offset() const noexcept { return offset_; }
    /// How fast offset() changes, ns per s; over the last full second. 0 before.
    [[nodiscard]] std::int64_t drift_ppb() const noexcept { return drift_ppb_; }
    [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }  ///< missing and outliers
    [[nodiscard]] std::uint32_t samples() const noexcept { return samples_; }    ///< that were believed; wraps

private:
    void start(Instant sent, std::int64_t offset) noexcept;

    std::optional<std::int64_t> offset_;
    std::uint32_t outliers_ = 0;  // in a row
    std::int64_t drift_from_ = 0;
    Instant drift_since_{};
    std::int64_t drift_ppb_ = 0;
    std::uint64_t rejected_ = 0;
    std::uint32_t samples_ = 0;
};

}  // namespace taktwerk::ecat

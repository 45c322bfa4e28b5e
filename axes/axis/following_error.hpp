#pragma once
// Following error with dead time taken into account: the actual value is compared with the set-point that was in effect in the drive
// when the actual value was taken, not with the newest one.

#include <algorithm>
#include <array>
#include <cstdint>

#include "axes/axis/axis_config.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// The set-points of the last cycles with the instant from which each is in effect. Real-time safe.
class SetpointHistory {
public:
    static constexpr std::size_t depth = 32;  ///< cycles of dead time that can be matched

    void clear() noexcept {
        count_ = 0;
        newest_at_ = Instant::max();
    }

    /// Instants must not fall; one that is not later replaces the newest.
    void record(Instant effective, std::int64_t counts) noexcept {
        if (count_ == 0 || effective > newest_at_) {
            newest_ = (newest_ + 1) % depth;
            if (count_ < depth) ++count_;
            entries_[newest_].effective = newest_at_ = effective;
        }
        entries_[newest_].counts = newest_counts_ = counts;
    }

    /// Set-point in effect at `latched`, interpolated, minus `actual`. counts. 0 while nothing is known.
    [[nodiscard]] double error_at(Instant latched, std::int64_t actual) const noexcept {
        if (newest_at_ <= latched) return static_cast<double>(newest_counts_ - actual);
        if (count_ == 0) return 0;
        std::size_t later = 1;  // how many are
        while (later < count_ && back(later).effective > latched) ++later;
        if (later == count_) return static_cast<double>(back(count_ - 1).counts - actual);
        const auto& before = back(later);
        const auto& after = back(later - 1);
        const double part =
            static_cast<double>((latched - before.effective).count()) / static_cast<double>((after.effective - before.effective).count());
        return static_cast<double>(before.counts - actual) + part * static_cast<double>(after.counts - before.counts);
    }

    /// How fast the set-point moves that is in effect at `latched`, counts/s. 0 while that is not known.
    [[nodiscard]] double velocity_at(Instant latched) const noexcept {
        if (count_ < 2) return 0;
        const std::size_t later = std::clamp<std::size_t>(later_than(latched), 1, count_ - 1);
        const auto &before = back(later), &after = back(later - 1);
        return static_cast<double>(after.counts - before.counts) / to_seconds(after.effective - before.effective);
    }

private:
    struct Entry {
        Instant effective{};
        std::int64_t counts = 0;
    };
    /// How many take effect after `latched`.
    [[nodiscard]] std::size_t later_than(Instant latched) const noexcept {
        std::size_t later = 0;
        while (later < count_ && back(later).effective > latched) ++later;
        return later;
    }
    /// `i` before the newest.
    [[nodiscard]] const Entry& back(std::size_t i) const noexcept { return entries_[(newest_ - i) % depth]; }

    Instant newest_at_ = Instant::max();  // until there is one
    std::int64_t newest_counts_ = 0;
    std::size_t newest_ = 0, count_ = 0;
    std::array<Entry, depth> entries_{};
};

/// Beyond the window for longer than the configured time.
class FollowingErrorTimer {
public:
    void clear() noexcept { beyond_ = false; }
    /// Beyond it at `latched`: for `time` or longer?
    [[nodiscard]] bool lasts(Instant latched, Duration time) noexcept {
        if (!beyond_) since_ = latched;
        beyond_ = true;
        return latched - since_ >= time;
    }

private:
    bool beyond_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes

#pragma once
// Following error with dead time taken into account: the actual value is compared with the set-point that was in effect in the drive
// when the actual value was taken, not with the newest one.

#include <array>
#include <cstdint>

#include "axes/axis/axis_config.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// The set-points of the last cycles with the instant from which each is in effect. Real-time safe.
class SetpointHistory {
public:
    static constexpr std::size_t depth = 32;  ///< cycles of dead time that can be matched

    void clear() noexcept { count_ = 0; }

    /// Instants must not fall; one that is not later replaces the newest.
    void record(Instant effective, std::int64_t counts) noexcept {
        if (count_ > 0 && effective <= at(count_ - 1).effective) {
            at(count_ - 1).counts = counts;
            return;
        }
        if (count_ == depth) {
            first_ = (first_ + 1) % depth;
            --count_;
        }
        at(count_++) = {effective, counts};
    }

    /// Set-point in effect at `latched`, interpolated, minus `actual`. counts. 0 while nothing is known.
    [[nodiscard]] double error_at(Instant latched, std::int64_t actual) const noexcept {
        if (count_ == 0) return 0;
        std::size_t i = count_;
        while (i > 0 && at(i - 1).effective > latched) --i;
        if (i == 0) return static_cast<double>(at(0).counts - actual);
        const auto& before = at(i - 1);
        if (i == count_) return static_cast<double>(before.counts - actual);
        const auto& after = at(i);
        const double part =
            static_cast<double>((latched - before.effective).count()) / static_cast<double>((after.effective - before.effective).count());
        return static_cast<double>(before.counts - actual) + part * static_cast<double>(after.counts - before.counts);
    }

private:
    struct Entry {
        Instant effective{};
        std::int64_t counts = 0;
    };
    [[nodiscard]] Entry& at(std::size_t i) noexcept { return entries_[(first_ + i) % depth]; }
    [[nodiscard]] const Entry& at(std::size_t i) const noexcept { return entries_[(first_ + i) % depth]; }

    std::array<Entry, depth> entries_{};
    std::size_t first_ = 0, count_ = 0;
};

/// Beyond the window for longer than the configured time.
class FollowingErrorTimer {
public:
    void clear() noexcept { beyond_ = false; }
    [[nodiscard]] bool exceeded(double error, Instant latched, const FollowingErrorWatch& watch) noexcept {
        if (!(error > watch.window || error < -watch.window)) {
            beyond_ = false;
            return false;
        }
        if (!beyond_) since_ = latched;
        beyond_ = true;
        return latched - since_ >= watch.time;
    }

private:
    bool beyond_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes

#pragma once
// Where the axis was at an instant between two cycles: the straight line through its newest two actual values. Real-time safe.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes {

/// A place between two counts.
struct FinePosition {
    std::int64_t counts = 0;
    double rest = 0;  ///< counts beyond it
};

class PositionTrack {
public:
    /// A fresh actual value and when it was taken. Values of one instant: the newer one holds.
    void add(Instant latched, std::int64_t counts) noexcept {
        if (values_ == 0 || latched > newest_) {
            before_ = newest_;
            counts_before_ = counts_;
            if (values_ < 2) ++values_;
        }
        newest_ = latched;
        counts_ = counts;
    }
    /// After a break in the counting.
    void clear() noexcept { values_ = 0; }

    [[nodiscard]] Instant newest() const noexcept { return newest_; }
    /// Half way between the newest two values; the newest when there is only one.
    [[nodiscard]] Instant between() const noexcept { return values_ < 2 ? newest_ : before_ + (newest_ - before_) / 2; }
    /// Before the first value: nothing useful. With one value only: that.
    [[nodiscard]] FinePosition at(Instant t) const noexcept {
        if (values_ < 2) return {counts_, 0};
        const double part = to_seconds(t - newest_) / to_seconds(newest_ - before_);
        return {counts_, part * static_cast<double>(counts_ - counts_before_)};
    }

private:
    int values_ = 0;
    Instant newest_{}, before_{};
    std::int64_t counts_ = 0, counts_before_ = 0;
};

}  // namespace taktwerk::axes

#pragma once
// How regularly SYNC0 comes: a signal that is missing, or that comes more than a deviation earlier or later after the one before than the
// cycle says, is lost. Pure logic, real-time safe. Source: SV33-E 7.2 (P0A.31, P0A.32), 5.4 (E.D32).

#include <algorithm>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::sim {

class SyncWatch {
public:
    /// From the next signal on one is due each `cycle`.
    void restart(Duration cycle) noexcept {
        cycle_ = cycle;
        lost_ = 0;
        first_ = true;
    }
    void signal(Instant now, Duration deviation) noexcept {
        const auto away = now - last_ - cycle_;
        const bool in_place = first_ || (away <= deviation && -away <= deviation);
        lost_ = in_place ? 0 : lost_ + std::max<std::int64_t>(1, overdue(now, deviation));
        last_ = now;
        first_ = false;
    }
    /// Signals lost in a row, those that are overdue now among them.
    [[nodiscard]] std::int64_t lost(Instant now, Duration deviation) const noexcept { return lost_ + overdue(now, deviation); }

private:
    [[nodiscard]] std::int64_t overdue(Instant now, Duration deviation) const noexcept {
        if (first_ || cycle_ <= Duration::zero()) return 0;
        return std::max<std::int64_t>(0, (now - last_ - deviation) / cycle_);
    }

    Instant last_{};
    Duration cycle_{};
    std::int64_t lost_ = 0;
    bool first_ = true;  ///< nothing to compare it with
};

}  // namespace taktwerk::axes::sim

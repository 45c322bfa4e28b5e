#pragma once
// A reader that wants every row once, in order (a trace). What it missed because it came too late is counted and told to the ring.

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/recording/signal_ring.hpp"

namespace taktwerk::runtime {

/// One thread, beside the cycle. `ring` outlives it.
class RowCursor {
public:
    /// Begins at the cycle after the newest one. Allocates here.
    explicit RowCursor(SignalRing& ring) : ring_(ring), next_(ring.span().last + 1), row_(ring.words()) {}

    /// The next row; empty when the cycle has not written it yet. Until the next call.
    [[nodiscard]] std::span<const std::uint64_t> next() noexcept {
        while (true) {
            const auto there = ring_.span();
            if (there.empty() || next_ > there.last) return {};
            if (next_ < there.first) {
                ring_.tell_lost(there.first - next_);
                next_ = there.first;
            }
            if (ring_.read_row(next_, row_)) {
                ++next_;
                return row_;
            }
        }
    }

private:
    SignalRing& ring_;
    std::uint64_t next_;
    std::vector<std::uint64_t> row_;
};

}  // namespace taktwerk::runtime

#pragma once
// Which cycle was it at that moment? By the times that stand in the rows: a machine that missed ticks has fewer cycles than periods.

#include <array>
#include <cstdint>

#include "core/time.hpp"
#include "runtime/recording/signal_rows.hpp"

namespace taktwerk::runtime {

/// The first cycle whose time is `moment` or later, among those that can be read; the one behind the newest when all are earlier.
[[nodiscard]] inline std::uint64_t cycle_at(const SignalRows& rows, Instant moment) noexcept {
    const auto there = rows.span();
    const auto* time = rows.find(time_signal);
    if (there.empty() || time == nullptr) return there.first;
    const std::array<std::uint16_t, 1> word{time->cell.word};
    auto low = there.first, high = there.last + 1;
    while (low < high) {
        const auto middle = low + (high - low) / 2;
        std::array<std::uint64_t, 1> ns{};
        const bool gone = rows.read(middle, middle + 1, word, ns) != middle;
        if (gone || Instant{Duration{static_cast<std::int64_t>(ns[0])}} < moment) low = middle + 1;
        else high = middle;
    }
    return low;
}

}  // namespace taktwerk::runtime

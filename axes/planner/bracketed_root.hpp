#pragma once
// The root of a monotone function inside a bracket: Newton's method, halving where it does not help. Internal to the planner.

#include <cmath>

#include "axes/planner/plan_limits.hpp"
#include "axes/planner/precision.hpp"

namespace taktwerk::axes {

/// Value of a function (its root is wanted), its slope, and the size of the value's rounding errors.
struct RootSample {
    double value = 0;
    double slope = 0;
    double rounding = 0;
};

/// Where `f` is 0 between low and high, 0 <= low <= high; f rises or falls monotonically from one sign at low to the other at high.
/// At most max_root_steps evaluations. Returns the point with the smallest |value| seen.
template <typename F>
[[nodiscard]] double bracketed_root(F&& f, double low, double high, double guess, bool rising) noexcept {
    double x = guess > low && guess < high ? guess : low + (high - low) / 2;
    double best = x;
    double best_miss = infinity;
    double last_miss = best_miss;
    for (int i = 0; i < max_root_steps; ++i) {
        const RootSample y = f(x);
        const double miss = std::abs(y.value);
        if (miss < best_miss) {
            best = x;
            best_miss = miss;
        }
        if (miss <= y.rounding) break;
        ((y.value < 0) == rising ? low : high) = x;
        const double step = y.value / y.slope;
        const bool tiny = step != 0 && std::abs(step) <= 8 * epsilon * x;  // misses are rounding errors here
        double next = x - step;
        if (!(next > low && next < high) || (miss > last_miss / 2 && !tiny)) {
            if (tiny) break;
            next = low > 0 && high > 8 * low ? std::sqrt(low * high) : low + (high - low) / 2;
            if (!(next > low)) next = low + (high - low) / 2;
        }
        last_miss = miss;
        if (!(next > low && next < high)) break;  // no number left between them
        x = next;
    }
    return best;
}

}  // namespace taktwerk::axes

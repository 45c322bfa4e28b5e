#pragma once
// The target of cyclic synchronous position mode in a simulated drive: interpolated over the cycle, and watched for leaps. Counts, plant
// coordinates. Source: SV33-E 5.4, E.424.

#include <cmath>
#include <cstdint>

#include "axes/sim/servo_loop.hpp"

namespace taktwerk::axes::sim {

class CyclicTarget {
public:
    /// The demand stays at `position`.
    void rest(double position) noexcept {
        target_ = position;
        steps_left_ = 0;
    }
    /// The motor got its power.
    void enabled() noexcept { strikes_ = 0; }

    /// How far a target leads from the one before.
    [[nodiscard]] double increment_to(double wanted) const noexcept { return std::abs(wanted - target_); }
    /// A target `increment` away is obeyed for `seconds`; true: it leaps, too often in a row. `fastest` counts/s, 0: no check.
    bool leaps(double increment, double fastest, double seconds) noexcept;
    /// From `from` to `wanted` in `seconds`.
    void go(const Demand& from, double wanted, double seconds) noexcept;
    /// One inner step of `dt` seconds.
    void step(Demand& demand, double dt) noexcept;

    /// Largest step between two exchanges that was obeyed.
    [[nodiscard]] double largest_increment() const noexcept { return largest_increment_; }
    void rescale(double factor) noexcept { step_ *= factor, target_ *= factor; }

private:
    double target_ = 0;
    double step_ = 0;              ///< counts per second towards it
    std::int64_t steps_left_ = 0;  ///< inner steps until it is reached
    std::uint32_t strikes_ = 0;
    double largest_increment_ = 0;
};

}  // namespace taktwerk::axes::sim

#pragma once
// Steps of one size counted in steps of another, exactly: the reason why couplings do not drift (exact_positions.md). Real-time safe.

#include <cstdint>

namespace taktwerk::axes {

class StepRatio {
public:
    StepRatio() noexcept = default;  ///< counts nothing

    /// One step is `from` * numerator / denominator [u], counted in steps of `to` [u]. Finite; from, to > 0; denominator not 0.
    /// False when the two cannot be compared exactly in 128 bits: nothing must be counted then.
    [[nodiscard]] bool set(double from, std::int64_t numerator, std::int64_t denominator, double to) noexcept;

    /// So many steps further. The work grows with the size only beyond what 126 bits hold at once (2^16 steps or more).
    void advance(std::int64_t steps) noexcept;

    /// Whole steps of size `to` so far, towards minus infinity.
    [[nodiscard]] std::int64_t whole() const noexcept { return whole_; }
    /// What is left, 0 <= rest < to. u.
    [[nodiscard]] double rest() const noexcept { return to_ * (static_cast<double>(rest_) / static_cast<double>(step_)); }

private:
    __extension__ using Wide = __int128;

    Wide grow_ = 0;  // each step adds this many parts
    Wide step_ = 1;  // parts of a step of size `to`
    Wide rest_ = 0;  // parts, 0 <= rest < step
    std::int64_t whole_ = 0;
    std::int64_t chunk_ = 1;  // steps that can be added at once
    double to_ = 0;
};

}  // namespace taktwerk::axes

#pragma once
// What the mechanics add between the axis and its motor: backlash, and errors of the pitch. The set-point that programs see stays clean; the
// motor gets it with an offset, and what the motor says is read with the same offset taken away. u, u/s. Real-time safe.

#include <span>

#include "axes/axis/axis_config.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// Correction to add at a position: linear between the points, constant beyond them. 0 without points.
[[nodiscard]] double pitch_correction(std::span<const PitchPoint> points, double position) noexcept;
/// The position that with its correction is `corrected`. The points must be monotonic (check()). Logarithmic in their number.
[[nodiscard]] double pitch_inverse(std::span<const PitchPoint> points, double corrected) noexcept;

class Compensation {
public:
    explicit Compensation(const CompensationConfig& config) noexcept
        : config_(config), none_(config.backlash == 0 && config.pitch.empty()) {}

    [[nodiscard]] bool none() const noexcept { return none_; }

    /// One cycle: `position` and `velocity` of the set-point, in machine coordinates; `referenced`: the pitch table's positions mean
    /// something. The offset changes by at most `velocity` of the configuration beyond what the table asks for along the way.
    void step(double position, double velocity, bool referenced, Duration period) noexcept;

    /// To add to the set-point on its way to the motor.
    [[nodiscard]] double offset() const noexcept { return backlash_ + pitch_; }
    /// Machine coordinate of the axis for a motor at `motor`.
    [[nodiscard]] double load(double motor) const noexcept;

private:
    CompensationConfig config_;
    bool none_;
    double backlash_ = 0;  ///< 0 on the flank for positive motion, -distance on the other one
    double pitch_ = 0;     ///< what is added now
    double missing_ = 0;   ///< of the pitch correction: faded out after homing
    double wanted_ = 0;
    bool referenced_ = false;
};

}  // namespace taktwerk::axes

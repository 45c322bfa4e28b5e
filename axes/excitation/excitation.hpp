#pragma once
// The set-points of a measurement, one a cycle: continuous in position, velocity and acceleration, inside the bounds of its plan.
// Real-time safe, allocates nothing; the same plan gives the same bits.

#include <cstddef>
#include <cstdint>

#include "axes/excitation/excitation_plan.hpp"
#include "axes/planner/motion.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

class Excitation {
public:
    Excitation() = default;
    /// `plan` is not refused.
    explicit Excitation(const ExcitationPlan& plan) noexcept;

    /// One cycle on. False: it is over, and `next` is where the axis stands.
    bool step(MotionState& next) noexcept;

    [[nodiscard]] const ExcitationPlan& plan() const noexcept { return plan_; }
    /// Of the newest set-point.
    [[nodiscard]] std::size_t leg() const noexcept { return begun_ ? leg_ : leg_ - (leg_ > 0 ? 1 : 0); }
    /// Of it: the move is over and the axis rests; the tone has its full amplitude.
    [[nodiscard]] bool holds() const noexcept { return holds_; }
    /// s
    [[nodiscard]] double elapsed() const noexcept { return elapsed_; }

private:
    void begin_leg() noexcept;
    [[nodiscard]] MotionState on_tone(double t) const noexcept;

    ExcitationPlan plan_;
    std::size_t leg_ = 0;
    std::uint64_t cycles_ = 0;  // of this leg
    double elapsed_ = 0, length_ = 0;
    double at_ = 0;  // u: where the leg begins
    bool begun_ = false, holds_ = false;
    ExcitationTone tone_;
    Profile profile_;
    int piece_ = 0;
};

}  // namespace taktwerk::axes

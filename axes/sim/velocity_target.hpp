#pragma once
// The velocity that a simulated drive is told to run at, and what it demands of its loop on the way there. counts/s.

namespace taktwerk::axes::sim {

class VelocityTarget {
public:
    /// Nothing is told; a ramp will begin at `speed`.
    void forget(double speed) noexcept {
        target_ = 0;
        demand_ = speed;
    }
    /// Where the ramp leads to.
    void aim(double velocity) noexcept { target_ = velocity; }
    /// From here on, whatever came before.
    void demand(double velocity) noexcept { demand_ = velocity; }
    /// `dt` seconds with these [counts/s2]: `acceleration` away from standstill, `deceleration` towards it; one of 0 moves nothing (SV33-E
    /// 8.5.5).
    void ramp(double acceleration, double deceleration, double dt) noexcept;

    [[nodiscard]] double target() const noexcept { return target_; }
    [[nodiscard]] double demanded() const noexcept { return demand_; }

private:
    double target_ = 0, demand_ = 0;
};

}  // namespace taktwerk::axes::sim

#pragma once
// What a gear asks of its slave, and how unsteady that is from cycle to cycle. Real-time safe.

namespace taktwerk::axes {

/// What a gear asks of its slave in a cycle. u/s, u/s2.
struct GearDemand {
    double velocity = 0, acceleration = 0;
    double trend = 0;  ///< EndlessMotion
};

/// Whatever the demand does on the whole. A corner of its motion is over with its cycle; what comes again and again is unrest.
class DemandUnrest {
public:
    void forget() noexcept { *this = DemandUnrest{}; }
    void look(const GearDemand& now) noexcept;
    [[nodiscard]] double noise() const noexcept { return noise_; }    ///< u/s: up and down, of a filtered master
    [[nodiscard]] double change() const noexcept { return change_; }  ///< u/s2: of the acceleration in a cycle, as it goes on
    [[nodiscard]] double turn() const noexcept { return turn_; }      ///< u/s2, signed: of the acceleration in this cycle
    [[nodiscard]] double step() const noexcept { return step_; }      ///< u/s, signed: of the velocity in this cycle

private:
    GearDemand last_;
    int known_ = 0;  // cycles
    double step_ = 0, bend_ = 0, turn_ = 0, change_ = 0, noise_ = 0;
    double once_ = 0;  // u/s: up and down, but it may have been a corner
};

}  // namespace taktwerk::axes

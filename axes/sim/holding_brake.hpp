#pragma once
// The holding brake as a simulated drive works it: when it is told to close, and when it holds. At standstill the drive says so before it lets
// go of the motor, as long as the machine's brake needs (TSVM PA47, SV33-E P05.14); a brake that is never late closes as the motor lets go. In
// motion it waits until the motor is slow (TSVM PA48, PA49).

#include <optional>

#include "axes/port/drive_profile.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

/// What the brake depends on at one inner step.
struct BrakeView {
    bool energised = false, enabled = false;
    bool winding_down = false;  ///< power is to go, but the motor still stops or holds for the brake
    bool stands = false;
    double speed = 0;  ///< counts/s, without sign
};

class HoldingBrake {
public:
    /// `closing`: from the drive's word until it holds.
    HoldingBrake(const DriveBrake& drive, double counts_per_revolution, Duration closing) noexcept;

    /// The drive works a brake at all.
    [[nodiscard]] bool present() const noexcept { return drive_.hold > Duration::zero() || drive_.moving_wait > Duration::zero(); }
    void power_on(Instant now) noexcept;
    /// The motor got its power: the brake opens a while later.
    void enabled(Instant now) noexcept { opens_ = now + drive_.release; }
    /// The master works it; until it says so the drive does.
    void by_bus(bool open) noexcept { opened_by_bus_ = open; }
    /// One inner step; says whether it holds.
    bool step(const BrakeView& view, Instant now) noexcept;
    [[nodiscard]] bool closed() const noexcept { return closed_; }
    /// How long the motor holds at standstill before its power goes.
    [[nodiscard]] Duration hold() const noexcept { return drive_.hold; }
    void rescale(double factor) noexcept { moving_speed_ *= factor; }

private:
    [[nodiscard]] bool told_to_close(const BrakeView& view, Instant now) const noexcept;

    DriveBrake drive_;
    double moving_speed_;  ///< counts/s
    Duration closing_time_;
    Instant opens_{}, power_went_{};  ///< last time that the motor had power
    Duration closing_{};              ///< since it was told to
    bool closed_ = false;
    std::optional<bool> opened_by_bus_;
};

}  // namespace taktwerk::axes::sim

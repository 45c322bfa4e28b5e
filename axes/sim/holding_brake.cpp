#include "axes/sim/holding_brake.hpp"

#include "axes/sim/inner_step.hpp"

namespace taktwerk::axes::sim {

HoldingBrake::HoldingBrake(const DriveBrake& drive, double counts_per_revolution, Duration closing) noexcept
    : drive_(drive), moving_speed_(drive.moving_speed / 60.0 * counts_per_revolution), closing_time_(closing) {}

void HoldingBrake::power_on(Instant now) noexcept {
    closed_ = present();
    closing_ = closing_time_;
    power_went_ = now;
}

bool HoldingBrake::step(const BrakeView& view, Instant now) noexcept {
    if (view.energised) power_went_ = now;
    const bool told = told_to_close(view, now);
    closing_ = told ? closing_ + inner_period : Duration{};
    closed_ = told && closing_ >= closing_time_;
    return closed_;
}

bool HoldingBrake::told_to_close(const BrakeView& view, Instant now) const noexcept {
    if (opened_by_bus_) return !*opened_by_bus_;
    if (!present()) return false;
    const bool told_before = closing_ > Duration::zero();
    if (view.enabled) return now < opens_ && (view.stands || told_before);
    if (view.winding_down) return view.stands && closing_time_ > Duration::zero();
    if (view.energised) return false;
    const bool slow = view.speed < moving_speed_;
    const bool waited = drive_.moving_wait > Duration::zero() && now - power_went_ >= drive_.moving_wait;
    return view.stands || slow || waited || told_before;
}

}  // namespace taktwerk::axes::sim

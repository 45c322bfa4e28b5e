#include "axes/axis/motor_lead.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr double braking_grace = 2;  // times the ramp that the drive was given
constexpr Duration longest_braking = 60s;

}  // namespace

void MotorLead::follow() noexcept {
    const bool takes_setpoints = measured_.feedback.mode == modes_.own || measured_.feedback.mode == modes_.former;
    const bool confirmed = modes_.phase == ModePhase::torque || modes_.phase == ModePhase::profile;
    modes_.motor_leads = modes_.motor_leads || confirmed || (measured_.feedback.fresh && !takes_setpoints);
    if (!modes_.motor_leads) return;
    // A drive that shows its own mode again may take what it is told before it has to. What is measured then is the echo of this set-point a
    // few cycles ago, whose rounding would grow with every turn: it is led on as fast as it was.
    const bool echoes = modes_.phase == ModePhase::leaving && modes_.seen && !measured_.stands();
    const double velocity = echoes ? motion_.setpoint.state().velocity : measured_.motor_velocity();
    const double ahead = velocity * to_seconds(body_.port.setpoint_effective(body_.now) - measured_.feedback.latched);
    motion_.setpoint.set({measured_.local() + ahead, velocity, 0});
}

Duration MotorLead::longest_ramp(double deceleration) const noexcept {
    const double seconds = deceleration > 0 ? braking_grace * std::abs(measured_.motor_velocity()) / deceleration : 0;
    return std::min<Duration>(from_seconds(std::min(seconds, to_seconds(longest_braking))) + 500ms, longest_braking);
}

}  // namespace taktwerk::axes

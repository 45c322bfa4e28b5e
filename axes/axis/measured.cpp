#include "axes/axis/measured.hpp"

#include <algorithm>

namespace taktwerk::axes {

namespace {

std::uint32_t stale_cycles(const AxisConfig& config, const DriveCapabilities& drive, Duration cycle) {
    const auto polls = cycle > Duration::zero() ? std::max<std::int64_t>(1, drive.feedback_period / cycle) : 1;
    return static_cast<std::uint32_t>(config.patience.feedback * polls);
}

}  // namespace

Measured::Measured(const AxisBody& of_axis)
    : body(of_axis), stale_limit(stale_cycles(body.config, body.port.capabilities(), body.cycle)), compensation(body.config.compensation) {}

/// What the motor's position means for the load.
double Measured::compensated(double motor) const noexcept {
    const double machine = body.units.machine(motor);
    return motor + (compensation.load(machine) - machine);
}

bool Measured::permitted(double direction) const noexcept {
    if (direction > 0) return body.permit_positive && !positive_switch;
    if (direction < 0) return body.permit_negative && !negative_switch;
    return true;
}

std::int64_t Measured::encoder_range() const noexcept {
    if (body.config.memory.range > 0) return body.config.memory.range;
    const auto bits = std::min<unsigned>(body.port.capabilities().position_bits, 62);
    return std::int64_t{1} << bits;
}

std::int64_t Measured::encoder_zero() const noexcept {
    const auto range = static_cast<double>(encoder_range());
    return static_cast<std::int64_t>(std::round(static_cast<double>(counts) / range) * range);
}

}  // namespace taktwerk::axes

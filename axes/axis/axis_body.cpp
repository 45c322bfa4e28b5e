#include "axes/axis/axis_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace taktwerk::axes {

AxisBody::AxisBody(AxisConfig as_configured, DrivePort& drive, Duration period, std::uint16_t place, const AxisView& view)
    : config(std::move(as_configured)),
      alarms(place),
      brake(config.brake),
      port(drive),
      shown(view),
      cycle(period),
      units(config.gearing, config.modulo),
      power(std::max(drive.capabilities().enable_delay, config.brake.release), config.patience.enable, config.brake.engage),
      index(place),
      driven(!config.disabled && !config.encoder),
      endless(std::isinf(config.limits.position_min) && std::isinf(config.limits.position_max)),
      slow_line(drive.capabilities().setpoints == SetpointClass::low_dynamics) {}

double AxisBody::velocity_cap() const noexcept {
    const auto& manual = config.manual;
    const double slow = manual.slow > 0 ? manual.slow : 0.05 * config.limits.velocity;
    const double fast = manual.fast > 0 ? manual.fast : 0.25 * config.limits.velocity;
    switch (mode) {
        case OperatingMode::automatic: return std::numeric_limits<double>::infinity();
        case OperatingMode::manual: return fast;
        case OperatingMode::setup: return manual.setup_velocity > 0 ? manual.setup_velocity : slow;
    }
    return slow;
}

}  // namespace taktwerk::axes

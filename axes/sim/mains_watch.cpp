#include "axes/sim/mains_watch.hpp"

namespace taktwerk::axes::sim {

/// What "1: fault and warning" means is not stated; here it warns until the motor gets its power.
void MainsWatch::watch(Cia402Axis& axis) noexcept {
    if (!detection_.present()) return;
    const auto detection = missing_ ? detection_.get() : 2;
    const bool fault = detection == 0 || (detection == 1 && (fault_ || axis.powered()));
    const bool warning = detection == 1 && !fault;
    if (fault != fault_) axis.cause(DriveAlarmKind::phase_lost, fault_ = fault);
    if (warning != warned_) axis.cause(DriveAlarmKind::phase_warning, warned_ = warning);
}

}  // namespace taktwerk::axes::sim

// Alarms that belong to all axes of a drive at once (TSVM 7.1).

#include "axes/sim/cia402_device.hpp"

namespace taktwerk::axes::sim {

void Cia402Device::raise_in_all(const AlarmCode& alarm) noexcept {
    if (alarm.code == 0) return;
    for (auto& axis : axes_) {
        axis.model->raise_common(alarm);
        axis.common = alarm.code;
    }
}

void Cia402Device::raise(std::size_t axis, std::uint16_t code) noexcept {
    const auto alarm = alarms_.alarm(code);
    if (alarm.whole_drive) raise_in_all(alarm);
    else axes_[axis].model->raise(alarm);
}

void Cia402Device::link_changed(Instant) { raise_in_all(link_alarm_); }

/// An axis that found an alarm of the whole drive by itself, such as the main power gone, tells the others once. Each leaves Fault by a
/// reset of its own.
void Cia402Device::share_common_alarm() noexcept {
    for (auto& axis : axes_) {
        const auto alarm = alarms_.alarm(axis.model->error_code());
        if (!alarm.whole_drive) {
            axis.common = 0;
        } else if (axis.common != alarm.code) {
            raise_in_all(alarm);
            return;
        }
    }
}

}  // namespace taktwerk::axes::sim

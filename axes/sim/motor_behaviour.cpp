#include "axes/sim/motor_behaviour.hpp"

#include <algorithm>
#include <optional>

namespace taktwerk::axes::sim {

void MotorBehaviour::power_on(ecat::sim::ObjectDictionary& dictionary, Cia402Axis& axis) {
    const auto& b = profile_.behaviour;
    type_.power_on(dictionary, profile_, b.motor.type);
    standby_.power_on(dictionary, profile_, b.motor.standby_current);
    polarity_.power_on(dictionary, profile_, b.inputs.polarity);
    least_.power_on(dictionary, profile_, b.least_voltage);
    greatest_.power_on(dictionary, profile_, b.greatest_voltage);

    const auto& open_loop = b.motor.open_loop;
    if (type_.present() && std::find(open_loop.begin(), open_loop.end(), type_.get()) != open_loop.end())
        axis.open_loop(standby_.present() ? static_cast<double>(standby_.get()) / 100.0 : 1.0);
    else axis.open_loop(std::nullopt);
    axis.wire_inputs(b.inputs, polarity_.get());
}

void MotorBehaviour::supply(double volts, Cia402Axis& axis) const noexcept {
    if (least_.present()) axis.cause(DriveAlarmKind::undervoltage, volts < static_cast<double>(least_.get()));
    if (greatest_.present()) axis.cause(DriveAlarmKind::overvoltage, volts > static_cast<double>(greatest_.get()));
}

}  // namespace taktwerk::axes::sim

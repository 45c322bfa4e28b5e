#include "axes/sim/motor_behaviour.hpp"

#include <algorithm>
#include <optional>

namespace taktwerk::axes::sim {

MotorBehaviour::MotorBehaviour(const DriveProfile& profile)
    : open_loop_(profile.behaviour.motor.open_loop),
      inputs_(profile.behaviour.inputs),
      type_(profile, profile.behaviour.motor.type),
      standby_(profile, profile.behaviour.motor.standby_current),
      polarity_(profile, profile.behaviour.inputs.polarity),
      least_(profile, profile.behaviour.least_voltage),
      greatest_(profile, profile.behaviour.greatest_voltage) {}

void MotorBehaviour::power_on(ecat::sim::ObjectDictionary& dictionary, Cia402Axis& axis) {
    for (auto* value : {&type_, &standby_, &polarity_, &least_, &greatest_}) value->power_on(dictionary);
    if (type_.present() && std::find(open_loop_.begin(), open_loop_.end(), type_.get()) != open_loop_.end())
        axis.open_loop(standby_.present() ? static_cast<double>(standby_.get()) / 100.0 : 1.0);
    else axis.open_loop(std::nullopt);
    axis.wire_inputs(inputs_, polarity_.get());
}

void MotorBehaviour::supply(double volts, Cia402Axis& axis) const noexcept {
    if (least_.present()) axis.cause(DriveAlarmKind::undervoltage, volts < static_cast<double>(least_.get()));
    if (greatest_.present()) axis.cause(DriveAlarmKind::overvoltage, volts > static_cast<double>(greatest_.get()));
}

}  // namespace taktwerk::axes::sim

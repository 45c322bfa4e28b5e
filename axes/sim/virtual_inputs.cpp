#include "axes/sim/virtual_inputs.hpp"

namespace taktwerk::axes::sim {

VirtualInputs::VirtualInputs(const DriveProfile& profile)
    : servo_enable_(profile.behaviour.virtual_inputs.servo_enable),
      count_(profile, profile.behaviour.virtual_inputs.enable),
      levels_(profile, profile.behaviour.virtual_inputs.levels) {
    for (const auto& function : profile.behaviour.virtual_inputs.functions) functions_.emplace_back(profile, function);
}

void VirtualInputs::power_on(ecat::sim::ObjectDictionary& dictionary) {
    count_.power_on(dictionary);
    levels_.power_on(dictionary);
    for (auto& function : functions_) function.power_on(dictionary);
}

void VirtualInputs::watch(const AxisInputs& in, Cia402Axis& axis) noexcept {
    constexpr unsigned enable_operation = 0x0F;
    const bool twice = enable() && (in.control & enable_operation) == enable_operation;
    if (twice != enabled_twice_) axis.cause(DriveAlarmKind::enabled_twice, enabled_twice_ = twice);
}

bool VirtualInputs::enable() const noexcept {
    if (count_.get() != 1) return false;
    for (std::size_t i = 0; i < functions_.size(); ++i)
        if (functions_[i].get() == servo_enable_ && (levels_.get() >> i & 1) != 0) return true;
    return false;
}

}  // namespace taktwerk::axes::sim

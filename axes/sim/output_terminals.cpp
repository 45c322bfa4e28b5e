#include "axes/sim/output_terminals.hpp"

namespace taktwerk::axes::sim {

void OutputTerminals::power_on(ecat::sim::ObjectDictionary& dictionary) {
    control_.power_on(dictionary);
    outputs_ = dictionary.find(0x60FE, 1);
    mask_ = dictionary.find(0x60FE, 2);
}

/// CiA 402-2, 60FEh bit 0; SV-DA200 4.7, where P4.28 = 1 lets it.
void OutputTerminals::obey(Cia402Axis& axis) noexcept {
    constexpr std::int64_t brake = 1;
    if (brake_ == BrakeObject::none || (control_.present() && control_.get() != 1)) return;
    const bool masked = mask_ != nullptr && (mask_->get() & brake) != 0;
    if (brake_ == BrakeObject::mask_opens) axis.brake_by_bus(masked);
    else if (outputs_ != nullptr && (mask_ == nullptr || masked)) axis.brake_by_bus((outputs_->get() & brake) == 0);
}

std::uint32_t OutputTerminals::driven() const noexcept {
    const bool by_bus = control_.present() && control_.get() == 1;
    return by_bus && outputs_ ? static_cast<std::uint32_t>(outputs_->get() >> 16) & 0xFu : 0;
}

}  // namespace taktwerk::axes::sim

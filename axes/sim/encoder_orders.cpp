#include "axes/sim/encoder_orders.hpp"

namespace taktwerk::axes::sim {

void EncoderOrders::power_on(ecat::sim::ObjectDictionary& dictionary, unsigned offset) {
    const auto own = [&](ParameterAddress a) {
        return a.index ? dictionary.find(static_cast<std::uint16_t>(a.index + offset), a.sub) : nullptr;
    };
    turns_entry_ = own(turns_);
    reset_entry_ = own(reset_);
}

void EncoderOrders::serve(Cia402Axis& axis, std::uint16_t control) {
    const bool asked = (control & turns_control_) != 0;
    if (asked && !asked_) axis.clear_turns();
    asked_ = asked;
    // PA80 stays as it was written until power goes: it is never stored (TSVM 7.2.1).
    if (reset_entry_ && (reset_entry_->get() & 1) != 0) axis.order_encoder_reset();
    if (!turns_entry_ || turns_entry_->get() == 0) return;
    if (turns_entry_->get() == turns_value_) axis.clear_turns();
    else axis.reset_encoder();
    turns_entry_->set(0);
}

}  // namespace taktwerk::axes::sim

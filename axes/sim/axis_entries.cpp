#include "axes/sim/axis_entries.hpp"

#include <span>

#include "axes/sim/object_table.hpp"
#include "axes/sim/set_if_there.hpp"

namespace taktwerk::axes::sim {

namespace {

void take_each(std::span<const InputObject> table, const std::vector<ecat::sim::Entry*>& entries, AxisInputs& in) {
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (entries[i]) table[i].take(in, entries[i]->get());
}

}  // namespace

AxisEntries::AxisEntries(const DriveProfile& profile)
    : homing_timeout_address_(profile.homing_timeout),
      emergency_torque_address_(profile.stops.emergency_torque),
      homing_timeout_unit_(to_seconds(profile.homing_timeout_unit)) {
    for (const auto& stop : profile.stops.options) stop_addresses_.push_back(stop.object);
}

void AxisEntries::power_on(ecat::sim::ObjectDictionary& dictionary, unsigned offset) {
    const auto at = [&](unsigned index, std::uint8_t sub) { return dictionary.find(static_cast<std::uint16_t>(index + offset), sub); };
    const auto find = [&](auto table) {
        std::vector<Entry*> found;
        for (const auto& object : table) found.push_back(at(object.index, object.sub));
        return found;
    };
    const auto own = [&](ParameterAddress a) { return a.index ? at(a.index, a.sub) : nullptr; };
    commands_ = find(command_objects());
    settings_ = find(setting_objects());
    answers_ = find(answer_objects());
    homing_timeout_ = own(homing_timeout_address_);
    emergency_torque_ = own(emergency_torque_address_);
    stop_values_.clear();
    for (const auto& address : stop_addresses_) stop_values_.push_back(own(address));
}

void AxisEntries::take(AxisInputs& in, bool operational) const noexcept {
    if (operational) take_each(command_objects(), commands_, in);
    take_each(setting_objects(), settings_, in);
    if (homing_timeout_) in.homing.time_limit = static_cast<double>(homing_timeout_->get()) * homing_timeout_unit_;
    for (std::size_t i = 0; i < stop_values_.size() && i < most_stop_options; ++i)
        if (stop_values_[i]) in.stop_values[i] = stop_values_[i]->get();
    if (emergency_torque_) in.emergency_torque = emergency_torque_->get();
}

void AxisEntries::show(const AxisOutputs& out) const noexcept {
    for (std::size_t i = 0; i < answers_.size(); ++i) set_if_there(answers_[i], answer_objects()[i].value(out));
}

}  // namespace taktwerk::axes::sim

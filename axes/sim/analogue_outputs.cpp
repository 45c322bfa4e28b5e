#include "axes/sim/analogue_outputs.hpp"

#include <cmath>

namespace taktwerk::axes::sim {

AnalogueOutputs::AnalogueOutputs(const DriveProfile& profile) {
    for (const auto& output : profile.behaviour.analogue_outputs)
        outputs_.push_back({{profile, output.value}, {profile, output.selection}, {profile, output.gain}, output.monitor});
}

void AnalogueOutputs::power_on(ecat::sim::ObjectDictionary& dictionary) {
    for (auto& o : outputs_) {
        for (auto* value : {&o.value, &o.selection, &o.gain}) value->power_on(dictionary);
        o.monitor = o.monitor_object.index ? dictionary.find(o.monitor_object.index, o.monitor_object.sub) : nullptr;
    }
}

void AnalogueOutputs::show() noexcept {
    for (auto& o : outputs_) {
        if (!o.monitor) continue;
        const auto gain = o.gain.get();
        const double volts = o.selection.get() == 0 && gain != 0 ? static_cast<double>(o.value.get()) / static_cast<double>(gain) : 0;
        o.monitor->set(std::llround(volts * 1000));
    }
}

}  // namespace taktwerk::axes::sim

#pragma once
// Analogue outputs of a drive whose volts are objects. Source: SV-DA200 4.6.

#include <vector>

#include "axes/sim/behaviour_value.hpp"

namespace taktwerk::axes::sim {

class AnalogueOutputs {
public:
    explicit AnalogueOutputs(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// Shows what stands at the terminals, in mV.
    void show() noexcept;

private:
    struct Output {
        BehaviourValue value, selection, gain;
        ParameterAddress monitor_object;
        ecat::sim::Entry* monitor = nullptr;
    };
    std::vector<Output> outputs_;
};

}  // namespace taktwerk::axes::sim

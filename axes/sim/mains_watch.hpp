#pragma once
// A phase of the mains that is missing, as far as the drive's setting has it looked for. Source: SV33-E 5.4 E.217, 5.5 A.222, P08.00.

#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

class MainsWatch {
public:
    explicit MainsWatch(const DriveProfile& profile) : detection_(profile, profile.behaviour.phase_detection) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary) { detection_.power_on(dictionary); }
    /// The mains have all of their phases.
    void complete(bool is) noexcept { missing_ = !is; }
    void watch(Cia402Axis& axis) noexcept;

private:
    BehaviourValue detection_;
    bool missing_ = false;
    bool fault_ = false, warned_ = false;  ///< as the axis was told
};

}  // namespace taktwerk::axes::sim

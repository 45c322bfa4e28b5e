#pragma once
// Objects of a drive that say which motor, which supply and which switches it has: between the dictionary and the axis. Which objects they
// are comes from DriveProfile::behaviour; those that take effect after a restart are those of power-on. Source: SE-808X 2.3, 4.4.

#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class MotorBehaviour {
public:
    explicit MotorBehaviour(const DriveProfile& profile);

    /// Before the axis gets its power.
    void power_on(ecat::sim::ObjectDictionary& dictionary, Cia402Axis& axis);
    /// Volts of the supply, until another value is given. Beyond the drive's limits there is an alarm as long as that lasts.
    void supply(double volts, Cia402Axis& axis) const noexcept;

private:
    std::vector<std::int64_t> open_loop_;  ///< kinds of motor without an encoder
    InputObjects inputs_;
    BehaviourValue type_, standby_, polarity_, least_, greatest_;
};

}  // namespace taktwerk::axes::sim

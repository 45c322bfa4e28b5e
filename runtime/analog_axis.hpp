#pragma once
// An axis whose motor is driven over +-10 V: which points of the machine are its wires, and how its amplifier is played. Plain data.

#include <chrono>
#include <string>

#include "axes/port/analog_drive.hpp"

namespace taktwerk::runtime {

/// Names of points; empty: not wired.
struct AnalogAxis {
    axes::AnalogDrive drive;
    std::string setpoint, enable, reset;                      ///< outputs; the first in V
    std::string ready, fault;                                 ///< inputs
    std::string negative_limit, positive_limit, home_switch;  ///< inputs

    [[nodiscard]] bool has_switches() const noexcept { return !(negative_limit.empty() && positive_limit.empty() && home_switch.empty()); }
};

/// The amplifier that is played: its velocity loop, and what is wrong with it.
struct AnalogSimulation {
    Duration time_constant = std::chrono::milliseconds{10};  ///< of its velocity loop
    double drift = 0;                                        ///< V: it turns as if so much more were given
    bool reversed = false;                                   ///< the encoder is wired the other way round
};

}  // namespace taktwerk::runtime

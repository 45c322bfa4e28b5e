#pragma once
// An amplifier that is told its velocity in volts, and whose encoder somebody else reads. Plain data, filled from a machine file by config/.

#include <chrono>

#include "core/time.hpp"

namespace taktwerk::axes {

struct AnalogDrive {
    double velocity_at_10v = 0;  ///< u/s, not 0; negative: a positive voltage moves the axis in its negative sense
    double offset = 0;           ///< V added while it is enabled: against the drift that it has
    double voltage_limit = 10;   ///< V, the most that it is given
    double polarity_distance =
        0;  ///< u that it may run against its set-point after enabling; 0 = as far as its velocity limit goes in 10 ms
    Duration enable_delay = std::chrono::milliseconds{20};  ///< from its enable until it follows
    Duration stop_time = std::chrono::milliseconds{200};    ///< enabled at 0 V, to brake, when the position loop cannot be closed any more

    [[nodiscard]] double runaway(double velocity_limit) const noexcept {
        return polarity_distance > 0 ? polarity_distance : 0.01 * velocity_limit;
    }
};

/// What its wires say in this cycle.
struct AnalogWiresIn {
    bool reachable = false;  ///< all terminals of its wires are in operation
    bool ready = true, fault = false;
    bool has_switches = false, negative_limit = false, positive_limit = false, home_switch = false;
};

/// What its wires are given.
struct AnalogWiresOut {
    double volts = 0;
    bool enable = false, reset = false;
};

}  // namespace taktwerk::axes

#pragma once
// What no profile says of a simulated axis, because it depends on the motor or a hand sets it. Plain data.

#include <cstdint>

namespace taktwerk::axes::sim {

struct SimulatedMotor {
    std::int64_t counts_per_revolution = 10000;
    bool absolute_encoder = false;     ///< keeps its coordinate over a power cycle
    double following_error_limit = 0;  ///< counts, where no object says it; 0 = no check
    double maximum_velocity = 0;       ///< counts/s; CSP increments beyond 3 times that are counted; 0 = no check
    double overspeed = 0;              ///< counts/s beyond which the measured speed is an alarm; 0 = no check
    double start_speed = 0;            ///< counts/s; enabling a faster motor is an alarm (SV33-E E.417); 0 = no check
    double overload_seconds = 0;       ///< at twice the rated torque until the overload alarm, by I2t; 0 = no check
};

}  // namespace taktwerk::axes::sim

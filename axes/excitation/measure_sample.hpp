#pragma once
// What is kept of each cycle of a measurement.

#include <cstdint>
#include <type_traits>

namespace taktwerk::axes {

/// u, u/s, u/s2, rated torques. The set-point is the newest one; it takes effect later, and the actual values were taken earlier:
/// `actual_position + following_error` is the set-point that was in effect when they were.
struct MeasureSample {
    std::uint64_t cycle = 0;  ///< of the machine: a gap is a lost sample
    std::uint32_t run = 0;    ///< number of the measurement
    std::uint16_t leg = 0;    ///< move or tone of the plan, from 0
    bool holds = false;       ///< the move is over and the axis rests; a tone has its full amplitude
    bool fresh = false;       ///< the drive has answered in this cycle
    double set_position = 0, set_velocity = 0, set_acceleration = 0;
    double actual_position = 0, actual_velocity = 0, following_error = 0, torque = 0;
};
static_assert(std::is_trivially_copyable_v<MeasureSample>);

}  // namespace taktwerk::axes

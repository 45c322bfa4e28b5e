#pragma once
// How a simulated drive brings its motor to rest, by what makes it stop. The ways are the drive's own (DriveStops::options, CiA 402-2 605Ah to
// 605Eh); where its manual documents none, an undocumented one is taken.

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"

namespace taktwerk::axes::sim {

/// `ramp` counts/s2; at_once: the demanded speed is 0 from the start.
struct StopOrder {
    StopBy by = StopBy::zero_speed;
    StopThen then = StopThen::free;
    double ramp = 0;
    bool at_once = true;
};

/// In the mode `in_mode` (6060h), with the objects as of the last exchange.
[[nodiscard]] StopOrder stop_order(const DriveProfile& profile, StopCause cause, std::int64_t in_mode, const AxisInputs& settings) noexcept;
/// counts/s2; 0 where this way has no ramp.
[[nodiscard]] double stop_ramp(const DriveProfile& profile, StopBy by, std::int64_t in_mode, const AxisInputs& settings) noexcept;

}  // namespace taktwerk::axes::sim

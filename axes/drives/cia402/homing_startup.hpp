#pragma once
// The SDOs that a drive's own homing needs before OP: method, speeds, acceleration, offset. Defaults of the drives are
// useless (SV33-E: 100 counts/s), so they are always written.

#include <cstdint>
#include <string_view>
#include <vector>

#include "axes/axis/axis_config.hpp"
#include "axes/port/drive_profile.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::axes::cia402 {

/// Empty unless `axis.homing.kind` is drive. Speeds become counts/s, the acceleration counts/s2. Homing offset 607Ch is
/// written 0: the axis itself gives the reference its coordinate.
[[nodiscard]] std::vector<ecat::StartupSdo> homing_startup(const AxisConfig& axis, const DriveProfile& profile, std::uint8_t drive_axis);

}  // namespace taktwerk::axes::cia402

#pragma once
// What is asked of a drive that nobody described, what it is given for it, and which modes it then has. Sources: IEC 61800-7-201 (1000h, 6060h,
// 6502h, 60C2h).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/axis/axis_config.hpp"
#include "axes/port/drive_profile.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::axes::cia402 {

/// The mode in which this axis is moved; none: it only measures.
[[nodiscard]] DriveMode own_mode(const AxisConfig& axis) noexcept;

/// Bits (1 << DriveMode) of what 6502h says.
[[nodiscard]] std::uint16_t modes_of_6502h(std::uint32_t supported) noexcept;
/// "csp, hm", as files name them.
[[nodiscard]] std::string mode_list(std::uint16_t modes);

/// 1000h, 6502h and 6060h. Empty where the profile states its modes.
[[nodiscard]] std::vector<ecat::AskedObject> asked_of(const DriveProfile& profile);
/// 6060h and the interpolation time, each only if the drive has it. Empty where the profile states its modes.
[[nodiscard]] std::vector<ecat::StartupSdo> given_to(const AxisConfig& axis, const DriveProfile& profile, Duration cycle);

/// The drive's device type (1000h) is that of CiA 402. Nothing: it may be; otherwise what it is.
[[nodiscard]] std::optional<std::string> other_device_type(std::uint32_t device_type);

}  // namespace taktwerk::axes::cia402

#pragma once
// The words of an axis: states, directions, buffer modes, command ids, owners. PLCopen spellings where the standard has them.

#include <cstdint>
#include <string_view>

namespace taktwerk::axes {

/// A program's handle on an axis: an index, resolved through the context. Trivially copyable; invalid by default.
struct AxisRef {
    std::uint16_t index = 0xFFFF;
    [[nodiscard]] constexpr bool valid() const noexcept { return index != 0xFFFF; }
    friend constexpr bool operator==(AxisRef, AxisRef) = default;
};

/// PLCopen Part 1 v2.0, figure 2.
enum class AxisState : std::uint8_t {
    Disabled,
    Standstill,
    Homing,
    DiscreteMotion,
    ContinuousMotion,
    SynchronizedMotion,
    Stopping,
    ErrorStop,
};
inline constexpr std::size_t axis_state_count = 8;
[[nodiscard]] std::string_view name(AxisState state) noexcept;

enum MC_Direction : std::uint8_t { mcPositiveDirection, mcShortestWay, mcNegativeDirection, mcCurrentDirection };
enum MC_BufferMode : std::uint8_t { mcAborting, mcBuffered, mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh };

/// Names one accepted command for ever; 0 = none. Per axis, increasing.
using CommandId = std::uint32_t;

/// Who commands an axis. At any time one party owns it; the others are refused with the owner's name.
enum class Owner : std::uint8_t { none, program, operator_panel, commissioning };
[[nodiscard]] std::string_view name(Owner owner) noexcept;

/// Stable error numbers of blocks and axes (docs/errors.md); texts in axes/axis/error_table.hpp.
/// 0x0001..: command errors (the axis is untouched). 0x3xxx: axis errors (the alarm ids of axes/axis/alarms.hpp).
enum class ErrorId : std::uint16_t {
    none = 0,
    invalid_axis = 0x0001,
    not_powered = 0x0002,  ///< the axis is Disabled
    in_error_stop = 0x0003,
    state_forbids = 0x0004,     ///< the state diagram has no arrow for this command here (Stopping, Homing, ...)
    invalid_velocity = 0x0005,  ///< 0 or not finite for a move to a position
    invalid_dynamics = 0x0006,  ///< negative or not finite acceleration, deceleration or jerk
    invalid_position = 0x0007,  ///< not finite
    beyond_software_limit = 0x0008,
    queue_full = 0x0009,
    owned_by_other = 0x000A,  ///< another party has control; see AxisView::owner
    not_supported = 0x000B,   ///< the drive or this version cannot do it
    not_homed = 0x000C,       ///< an absolute move needs a homed axis (axis option)
    buffer_mode_not_supported = 0x000D,
    invalid_direction = 0x000E,
    mode_forbids = 0x000F,     ///< the machine mode does not allow it
    drive_not_ready = 0x0010,  ///< no bus, or the drive refused to enable in time
    reset_failed = 0x0011,
    homing_failed = 0x0012,
    interlocked = 0x0013,  ///< emergency stop or a limit switch forbids this direction
    aborted_by_axis_error = 0x0014,
    power_conflict = 0x0015,  ///< a second MC_Power on the same axis
    invalid_parameter = 0x0016,
    // Objects of a device (EC_SdoRead, EC_SdoWrite).
    invalid_device = 0x0017,
    object_refused = 0x0018,
    object_no_answer = 0x0019,
    object_too_long = 0x001A,
    object_requests_full = 0x001B,
};

}  // namespace taktwerk::axes

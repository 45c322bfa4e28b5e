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

/// A program's handle on a group of axes that move together (axes/group/), likewise.
struct GroupRef {
    std::uint16_t index = 0xFFFF;
    [[nodiscard]] constexpr bool valid() const noexcept { return index != 0xFFFF; }
    friend constexpr bool operator==(GroupRef, GroupRef) = default;
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

/// Which value of an axis: what its command asks for, the newest output of its profile generator, the newest feedback (P1-051).
enum MC_Source : std::uint8_t { mcCommandedValue, mcSetValue, mcActualValue };
/// How MC_CamIn begins: the cam's own coordinates, from where the slave is, or approaching the cam with a ramp.
enum MC_StartMode : std::uint8_t { mcAbsolute, mcRelative, mcRampIn };
/// Which way MC_GearInPos gets to its sync point on a modulo slave: the nearest repetition, ahead, or waiting for the next.
enum MC_SyncMode : std::uint8_t { mcShortest, mcCatchUp, mcSlowDown };
enum MC_CombineMode : std::uint8_t { mcAddAxes, mcSubAxes };
/// At once; after all commands that wait; of groups (Part 4) also after the running one.
enum MC_ExecutionMode : std::uint8_t { mcImmediately, mcQueued, mcDelayed };

/// PLCopen Part 5: the way a search begins. The last two go by the switch: off, as named; on, the other way.
enum class MC_HomeDirection : std::uint8_t { mcPositiveDirection, mcNegativeDirection, mcSwitchPositive, mcSwitchNegative };
/// What ends a search for a switch: its level; its edge in the direction of the search; or, whichever way the axis moves, the edge at the
/// switch's negative end (mcEdgeSwitchPositive: it rises there in positive direction) or at its positive end (mcEdgeSwitchNegative).
enum class MC_SwitchMode : std::uint8_t { mcOn, mcOff, mcRisingEdge, mcFallingEdge, mcEdgeSwitchPositive, mcEdgeSwitchNegative };

/// Names one accepted command for ever; 0 = none. Per axis, increasing.
using CommandId = std::uint32_t;

/// Who commands an axis. At any time one party owns it; the others are refused with the owner's name.
enum class Owner : std::uint8_t { none, program, operator_panel, commissioning };
[[nodiscard]] std::string_view name(Owner owner) noexcept;

/// Whether what moves the axis is there, where it may be taken away while the rest runs (a group of hot connect).
enum class Presence : std::uint8_t { always, absent, joining, present };
[[nodiscard]] std::string_view name(Presence presence) noexcept;
[[nodiscard]] constexpr bool connected(Presence presence) noexcept { return presence == Presence::always || presence == Presence::present; }

/// The holding brake, as far as anybody knows: by the time since it was told.
enum class BrakeState : std::uint8_t { not_controlled, closed, opening, open, closing };

/// Stable error numbers of blocks and axes (docs/reference/errors.md); texts in axes/axis/error_texts.hpp.
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
    // Parameters, outputs, override.
    unknown_parameter = 0x001C,
    read_only_parameter = 0x001D,
    invalid_output = 0x001E,    ///< no such input or output, or number
    invalid_override = 0x001F,  ///< a factor below 0, above 1 or not finite; 0 for acceleration or jerk
    // Couplings.
    invalid_master = 0x0020,   ///< the master is the slave itself, or no axis, or gives no position
    coupling_loop = 0x0021,    ///< the master depends on this axis
    invalid_ratio = 0x0022,    ///< a ratio's denominator is 0
    not_coupled = 0x0023,      ///< the axis is no slave (GearOut, CamOut, Phasing)
    sync_impossible = 0x0024,  ///< the sync point cannot be reached: already passed, or not with these dynamics
    master_lost = 0x0025,      ///< the master has no valid position any more
    // Tables.
    invalid_table = 0x0026,  ///< no such table, or its points cannot be used
    no_table_room = 0x0027,  ///< all places for prepared cam tables are taken
    // Probes.
    no_such_probe = 0x0028,
    probe_busy = 0x0029,  ///< another block has armed this probe
    probe_idle = 0x002A,  ///< AbortTrigger found nothing armed
    // Homing steps.
    homing_limit_time = 0x002B,      ///< TimeLimit is over
    homing_limit_distance = 0x002C,  ///< DistanceLimit is used up
    homing_limit_torque = 0x002D,    ///< TorqueLimit was reached where it must not be
    // Modes of the drive.
    drive_mode_refused = 0x002E,   ///< the drive did not take the mode in time
    not_at_standstill = 0x002F,    ///< the drive changes its mode at standstill only
    update_not_possible = 0x0030,  ///< ContinuousUpdate gave values that this command cannot take
    // Blocks without CommandAborted.
    aborted_by_command = 0x0031,  ///< another command, or power off, ended it before it was done
    // Set-points from outside.
    setpoint_missing = 0x0032,        ///< an axis that is fed from outside moved, and no set-point came any more
    drive_setpoint_refused = 0x0033,  ///< the drive did not take a set-point of its own profile in time
    // Torque limits.
    no_torque_limit = 0x0034,       ///< the drive takes none
    invalid_torque_limit = 0x0035,  ///< negative, not finite, less than 0.001; or two limits for a drive that has one for both directions
    torque_limit_refused = 0x0036,  ///< the drive did not take it
    // The holding brake.
    brake_not_controlled = 0x0037,  ///< the drive works its brake by itself, or the axis has none
    brake_closed = 0x0038,          ///< MC_SetBrake has closed it under power
    // Groups that join and leave.
    not_connected = 0x0039,  ///< the group of its drive is away; see AxisView::presence
    // Groups of axes (PLCopen Part 4).
    axis_grouped = 0x003A,         ///< a group moves this axis; the group goes on
    invalid_group = 0x003B,        ///< no such group
    group_disabled = 0x003C,       ///< MC_GroupEnable first
    no_members = 0x003D,           ///< a group without axes
    invalid_member = 0x003E,       ///< IdentInGroup outside 1..16, taken or unknown; an axis of this or another group already
    member_moves = 0x003F,         ///< a member moves by itself, or has commands
    member_left = 0x0040,          ///< somebody took a member out of the group's motion
    no_kinematics = 0x0041,        ///< a frame other than ACS, and the group has no kinematics for it
    unknown_command = 0x0042,      ///< no command of this group that waits or runs has this CommandID
    nothing_interrupted = 0x0043,  ///< MC_GroupContinue, and no MC_GroupInterrupt before it
    not_at_interruption = 0x0044,  ///< a member is not where the path was interrupted
    out_of_reach = 0x0045,         ///< the arm does not get to a place of the path, or not without leaving its way of standing
    singular_path = 0x0046,        ///< a place of the path is too near to a singularity of the arm
    invalid_arc = 0x0047,          ///< the points of an arc make none
    half_turn = 0x0048,            ///< the tool shall turn by half a turn, and nothing says which way round
    path_not_planned = 0x0049,     ///< no motion along the path was found within all limits
    invalid_tool = 0x004A,         ///< no tool or payload of this number is defined; 0 cannot be written
    // Stored paths.
    path_not_selected = 0x004B,  ///< MC_PathSelect has not prepared it, or another selection has since
    path_in_use = 0x004C,        ///< a group goes it, or it waits to be gone
    path_program = 0x004D,       ///< its text has a fault
    // Frames that move.
    frame_in_use = 0x004E,    ///< a command of the group is in that frame, or waits
    frame_lost = 0x004F,      ///< the axis that moves the frame has no position any more, or an error
    frame_too_fast = 0x0050,  ///< the frame moves faster than the members can follow it
    frame_limit = 0x0051,     ///< following it a member would cross a limit, or the arm would be out of reach
    // Paths that an axis drives.
    path_stands = 0x0052,      ///< a place of it can only be passed at rest: a corner, a dwell, an M word
    path_not_closed = 0x0053,  ///< periodic, and it does not go on from its end to its beginning
    path_too_long = 0x0054,    ///< it has more sections than a group keeps
    path_limit = 0x0055,       ///< the axis leads a member beyond a limit
    // What a group watches of its tool's point.
    outside_workspace = 0x0056,     ///< a place of the path is outside the group's workspace, or in a room that is kept free
    path_following_error = 0x0057,  ///< the tool's point was further from where it should be than the group's window
    held_by_person = 0x0058,        ///< a person has interrupted the group: no program goes on, homes, jogs or drives it
};
inline constexpr std::size_t error_id_count = 0x0059;

}  // namespace taktwerk::axes

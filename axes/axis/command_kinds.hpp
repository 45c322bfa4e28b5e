#pragma once
// The kinds of commands, one row each: all that is asked of a kind without knowing the axis. A new kind is a row here, its details
// (command_details.hpp), the check of its numbers (command_check.hpp) and the part that carries it out (README.md, Rooms).

#include <array>
#include <cstdint>
#include <string_view>

#include "axes/axis/command.hpp"
#include "axes/axis/state_machine.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

namespace kind_table {

/// Where a command has its place: the axis' queue, or beside it.
enum class Slot : std::uint8_t { queue, superimposed, phasing, probe, passive_homing, setting, torque_limit };

using Traits = std::uint16_t;
inline constexpr Traits ends_there = 1 << 0;  ///< a motion to a position that ends there
inline constexpr Traits passes = 1 << 1;      ///< ... that goes on at a velocity of its own
inline constexpr Traits buffered = 1 << 2;    ///< may wait behind others: PLCopen table 4, second column
inline constexpr Traits hands_over = 1 << 3;  ///< has no Done, gives way by its Inxxx: table 4, last column
inline constexpr Traits each_cycle = 1 << 4;  ///< lives by a set-point in each cycle, or belongs to what does: not through a slow line
inline constexpr Traits updated = 1 << 5;     ///< ContinuousUpdate
inline constexpr Traits couples = 1 << 6;     ///< makes a slave
inline constexpr Traits uncouples = 1 << 7;   ///< releases it
inline constexpr Traits over_time = 1 << 8;   ///< follows a table over time
inline constexpr Traits slave = couples | buffered | hands_over | each_cycle;

struct Row {
    CommandKind kind;
    std::string_view name;  ///< of the block that gives it, for people
    AxisEvent event;
    Traits traits = 0;
    Slot slot = Slot::queue;
    DriveMode drive_mode = DriveMode::none;  ///< in which the drive makes the profile
};

using enum CommandKind;
using AxisEvent::continuous, AxisEvent::decoupled, AxisEvent::discrete, AxisEvent::synchronized;

// clang-format off
inline constexpr std::array rows{
    Row{none,                     "",                           discrete,     buffered},
    Row{move_absolute,            "MC_MoveAbsolute",            discrete,     ends_there | buffered | updated},
    Row{move_relative,            "MC_MoveRelative",            discrete,     ends_there | buffered | updated},
    Row{move_additive,            "MC_MoveAdditive",            discrete,     ends_there | buffered | updated},
    Row{halt,                     "MC_Halt",                    discrete,     buffered},
    Row{move_velocity,            "MC_MoveVelocity",            continuous,   buffered | hands_over | updated},
    Row{move_continuous_absolute, "MC_MoveContinuousAbsolute",  continuous,   passes | buffered | hands_over | updated},
    Row{move_continuous_relative, "MC_MoveContinuousRelative",  continuous,   passes | buffered | hands_over | updated},
    Row{move_superimposed,        "MC_MoveSuperimposed",        AxisEvent::superimposed, each_cycle | updated, Slot::superimposed},
    Row{halt_superimposed,        "MC_HaltSuperimposed",        discrete,     each_cycle | updated, Slot::superimposed},
    Row{stop,                     "MC_Stop",                    AxisEvent::stop},
    Row{home,                     "MC_Home",                    AxisEvent::home, buffered},
    Row{jog,                      "MC_Jog",                     discrete},  // ends by itself in Standstill, like a Halt; lives by its lease
    Row{gear_in,                  "MC_GearIn",                  synchronized, slave | updated},
    Row{gear_in_pos,              "MC_GearInPos",               synchronized, slave},
    Row{cam_in,                   "MC_CamIn",                   synchronized, couples | buffered | each_cycle | updated},  // hands over at its end
    Row{combine,                  "MC_CombineAxes",             synchronized, slave | updated},
    Row{gear_out,                 "MC_GearOut",                 decoupled,    uncouples | each_cycle},
    Row{cam_out,                  "MC_CamOut",                  decoupled,    uncouples | each_cycle},
    Row{phasing_absolute,         "MC_PhasingAbsolute",         discrete,     buffered | each_cycle, Slot::phasing},
    Row{phasing_relative,         "MC_PhasingRelative",         discrete,     buffered | each_cycle, Slot::phasing},
    Row{halt_phasing,             "MC_HaltPhasing",             discrete,     each_cycle, Slot::phasing},
    Row{position_profile,         "MC_PositionProfile",         discrete,     over_time | buffered | each_cycle | updated},
    Row{velocity_profile,         "MC_VelocityProfile",         continuous,   over_time | buffered | hands_over | each_cycle | updated},
    Row{acceleration_profile,     "MC_AccelerationProfile",     continuous,   over_time | buffered | hands_over | each_cycle | updated},
    Row{torque,                   "MC_TorqueControl",           continuous,   buffered | hands_over | updated},
    Row{external,                 "MC_ExtSetPointGenEnable",    continuous,   buffered | each_cycle},
    Row{homing_step,              "a homing step",              AxisEvent::homing_step, buffered},
    Row{abort_passive_homing,     "MC_AbortPassiveHoming",      discrete,     buffered, Slot::passive_homing},
    Row{touch_probe,              "MC_TouchProbe",              discrete,     buffered, Slot::probe},
    Row{abort_trigger,            "MC_AbortTrigger",            discrete,     buffered, Slot::probe},
    Row{setting,                  "a queued setting",           discrete,     buffered, Slot::setting},
    Row{set_controller_mode,      "MC_SetControllerMode",       discrete,     buffered},
    Row{drive_move_absolute,      "Drive_MoveAbsolute",         discrete,     buffered, Slot::queue, DriveMode::profile_position},
    Row{drive_move_relative,      "Drive_MoveRelative",         discrete,     buffered, Slot::queue, DriveMode::profile_position},
    Row{drive_move_velocity,      "Drive_MoveVelocity",         continuous,   buffered | hands_over, Slot::queue, DriveMode::profile_velocity},
    Row{drive_torque,             "Drive_Torque",               continuous,   buffered | hands_over, Slot::queue, DriveMode::profile_torque},
    Row{set_torque_limit,         "MC_SetTorqueLimit",          discrete,     0, Slot::torque_limit},
    Row{group_motion,             "its axis group",             synchronized, each_cycle},
};
// clang-format on

consteval bool sound() {
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (static_cast<std::size_t>(rows[i].kind) != i) return false;
    return rows.size() == static_cast<std::size_t>(group_motion) + 1;
}
static_assert(sound(), "each kind has its row, in the order of CommandKind");

[[nodiscard]] constexpr const Row& of(CommandKind kind) noexcept { return rows[static_cast<std::size_t>(kind)]; }
[[nodiscard]] constexpr bool has(CommandKind kind, Traits trait) noexcept { return (of(kind).traits & trait) != 0; }

}  // namespace kind_table

[[nodiscard]] constexpr std::string_view name(CommandKind kind) noexcept { return kind_table::of(kind).name; }
[[nodiscard]] constexpr AxisEvent event_of(CommandKind kind) noexcept { return kind_table::of(kind).event; }
[[nodiscard]] constexpr kind_table::Slot slot_of(CommandKind kind) noexcept { return kind_table::of(kind).slot; }

/// A motion to a position that ends there.
[[nodiscard]] constexpr bool ends_at_position(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::ends_there); }
[[nodiscard]] constexpr bool moves_continuously(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::passes); }
[[nodiscard]] constexpr bool can_be_buffered(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::buffered); }
/// Without Done: hands over to a waiting one by an Inxxx output. It is shown for a cycle first.
[[nodiscard]] constexpr bool hands_over_in_target(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::hands_over); }
[[nodiscard]] constexpr bool needs_each_cycle(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::each_cycle); }
[[nodiscard]] constexpr bool can_be_updated(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::updated); }
[[nodiscard]] constexpr bool follows_table(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::over_time); }

/// Its set-points are given from outside, in each cycle: by a program, or by a group.
[[nodiscard]] constexpr bool is_fed(CommandKind kind) noexcept {
    return kind == CommandKind::external || kind == CommandKind::group_motion;
}

/// Kinds of a slave: SynchronizedMotion.
[[nodiscard]] constexpr bool couples(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::couples); }
[[nodiscard]] constexpr bool uncouples(CommandKind kind) noexcept { return kind_table::has(kind, kind_table::uncouples); }
[[nodiscard]] constexpr bool shifts_phase(CommandKind kind) noexcept { return slot_of(kind) == kind_table::Slot::phasing; }

/// The mode in which the drive makes the profile of such a command; none: the profile is made here.
[[nodiscard]] constexpr DriveMode profile_mode_of(CommandKind kind) noexcept { return kind_table::of(kind).drive_mode; }
[[nodiscard]] constexpr bool made_by_drive(CommandKind kind) noexcept { return profile_mode_of(kind) != DriveMode::none; }

}  // namespace taktwerk::axes

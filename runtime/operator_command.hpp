#pragma once
// Commands from people: fixed size, validated by the gateway, carried by one recorded inbox into the cycle, answered from it.

#include <cstdint>
#include <type_traits>

#include "axes/excitation/measure_order.hpp"
#include "axes/group/group_types.hpp"
#include "axes/group/path_types.hpp"
#include "axes/words/types.hpp"
#include "core/fixed_text.hpp"
#include "core/time.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// What each may do, and when. Refusals in brackets; beyond them: unknown_name (no such index, a disabled axis), stale (expired),
/// not_possible_now (the run is ending). `axis` 0xFFFF means all where it says so: every axis is asked, the first refusal is the answer.
///
/// Commands to an axis come from the operator or from commissioning [no_control for anybody else, and from the other one while
/// one of them owns the axis]; an emergency stop, a mode change and a stopped program take nothing back but stop the axis.
enum class OperatorAction : std::uint8_t {
    none,
    take_control,     ///< axis or all: the axis stops, then obeys the new owner; it keeps its power [wrong_mode in automatic]
    release_control,  ///< axis or all: back to the operator [no_control for who has none]
    set_mode,         ///< mode: axes stop; leaving automatic stops the programs, entering it takes the operator's power back; outputs set
                      ///< by hand go to their safe values [not_possible_now into automatic while the emergency stop holds]
    power,            ///< axis or all; flag = on. Off: ramps down first. On: holds until off, an emergency stop, or an error that takes
                      ///< power away: a reset alone never switches on [interlocked while the emergency stop holds, in_error_stop,
                      ///< drive_not_ready while its drive is offline, not_connected while its group is away]
    home,             ///< axis
    jog,              ///< axis; value = velocity u/s, signed; 0 stops. flag = the key was pressed: starts. Without it: a heartbeat, each
                      ///< 50 ms, renews the lease [stale when there is nothing to renew]
    move_absolute,    ///< axis; value = position u, value2 = velocity u/s (manual move to a position)
    stop,             ///< axis or all: stop along the ramp, whoever owns it; always allowed, never stale. A program goes on: its
                      ///< block shows CommandAborted; program_stop ends it. People's stops come as levels (stop_levels.hpp)
    reset,            ///< axis, or all: then also the machine's alarms and programs in fault
    program_start,    ///< index = program. One that runs and waits after an emergency stop goes on [wrong_mode outside automatic;
                      ///< not_possible_now in fault, while its stop() is to come, while the emergency stop holds (interlocked) or is not
                      ///< reset yet (in_error_stop)]. A stop of one of its axes before it has begun withdraws it
    program_stop,     ///< index = program; axes that it powers ramp down, then power goes off; others that it moves stop; outputs that no
                      ///< other running program has declared go to their safe values
    program_reset,    ///< index = program
    set_parameter,    ///< index = parameter; value within its range, whole where it takes nothing else [bad_value]
    set_output,       ///< index = output point; value, whole and within its bits. Holds until the client goes, the mode changes or the
                      ///< emergency stop is pressed; then it is safe again [bad_value; wrong_mode in automatic; not_possible_now
                      ///< while a program runs or the emergency stop holds]
    acknowledge_alarms,
    shutdown,         ///< stop axes, power off, end
    release_outputs,  ///< those that this client has set go to their safe values: it is gone
    force,            ///< index = point, flag = an output; value, as set_output. In every mode, also while programs run. Holds until it is
                      ///< released, the client goes, the run ends; of an output also until the emergency stop is pressed [bad_value;
                      ///< not_possible_now (interlocked): an output while the emergency stop holds; not_possible_now (not_supported): the
                      ///< point is kept (kept_points.hpp); not_possible_now (queue_full): max_forces are in force]
    unforce,          ///< index = point, flag = an output; whoever forced it
    release_forces,   ///< all; flag: those of this client alone, it is gone
    override_velocity,  ///< axis or all; value = 0 to 1, whoever owns it; stays until it is changed [bad_value]
    reset_peaks,        ///< axis or all: the peaks of its following error begin anew
    reset_statistics,   ///< of the cycle and the tasks: maxima and histograms begin anew
    measure,    ///< axis; flag = the button was pressed: begins what `measure` says. Without it: a heartbeat, as of a jog. One axis of the
                ///< machine at a time [wrong_mode in automatic; not_possible_now while another is measured; bad_value for an order
                ///< that gives no path; not_homed where it has software limits, not_at_standstill, beyond_software_limit for the whole
                ///< path and a stop from it; stale when there is nothing to renew]
    set_value,  ///< index = variable of the layout that people may write; value within its range, whole where it takes nothing else
                ///< [unknown_name for any other; bad_value]. A button: value 1 with flag = pressed, without: a heartbeat, each 50 ms,
                ///< renews the lease [stale when there is nothing to renew]; 0 = let go, by whomever, always. A press [no_control
                ///< while another client holds it; not_possible_now while its program does not run]. A press and a switch put on
                ///< [interlocked while the emergency stop holds]; a press given before a stop of one of its program's axes is stale
    release_values,  ///< buttons that this client holds: it is gone
    // --- groups of axes: index = group
    group_halt,  ///< each member as `stop`: while the group moves, along its path; always allowed. People's come as levels of the members
    group_interrupt,  ///< comes to rest on the path and keeps its commands, whoever moves it [refused_by_axis: group_disabled, in_error_stop,
                      ///< state_forbids while it is interrupted already]
    group_continue,  ///< goes on behind a group_interrupt; not behind what a program has interrupted (nothing_interrupted). Of both the program's is left
    ///< [not_possible_now (interlocked) while the emergency stop holds; not_at_interruption; stale when given before a stop of
    ///< a member]
    group_override,  ///< value = 0 to 1, whoever moves it; stays until it is changed. The smallest of it and its members' acts [bad_value]
    group_reset,     ///< members in ErrorStop are reset, then the group leaves GroupErrorStop
    group_enable,    ///< GroupDisabled -> GroupStandby [no_control while another party has a member]
    group_disable,   ///< comes to rest on the path first [no_control likewise]
    group_jog,  ///< value = part of the jogging velocities, 0 to 1; 0 stops. `group_jog` says which way; value2 = distance, 0: as far as it
                ///< can. flag = the key was pressed: starts. Without it: a heartbeat, each 50 ms, renews the lease, and may say another way
                ///< in the same frame [bad_value; no_control; refused_by_axis: group_disabled, invalid_parameter, no_kinematics,
                ///< not_powered, ..., state_forbids while it comes to rest for another mode; of a heartbeat what ended the jog, else stale]
};

[[nodiscard]] constexpr bool is_of_a_group(OperatorAction action) noexcept {
    return action >= OperatorAction::group_halt && action <= OperatorAction::group_jog;
}

/// Which way a person jogs a group: a slot is a member by its place in ACS, else X Y Z RX RY RZ of the frame.
struct GroupJogOrder {
    axes::MC_CoordSystem frame = axes::mcACS;
    std::uint16_t plus = 0, minus = 0;  ///< bit i: slot i; both: that slot stands
    friend bool operator==(const GroupJogOrder&, const GroupJogOrder&) = default;
};

/// One command. Trivially copyable: goes through a ring.
struct OperatorCommand {
    OperatorAction action = OperatorAction::none;
    axes::Owner owner = axes::Owner::operator_panel;
    Mode mode = Mode::manual;
    bool flag = false;
    std::uint16_t axis = 0xFFFF;
    std::uint16_t index = 0xFFFF;
    double value = 0, value2 = 0;
    axes::MeasureOrder measure;               ///< of a measure
    GroupJogOrder group_jog;                  ///< of a group_jog
    std::uint32_t client = 0;                 ///< who; answers go there
    std::uint64_t sequence = 0;               ///< of the client; a repeated one is answered again, not executed again
    Instant expires{};                        ///< older than this at drain: refused as stale
    std::uint64_t after = ~std::uint64_t{0};  ///< stop levels raised when it reached the process (stop_levels.hpp): what starts a motion
                                              ///< and was given before a stop of its axis is stale, however late it comes
};
static_assert(std::is_trivially_copyable_v<OperatorCommand>);

/// Stable answers (exit codes and LCM acknowledgements derive from them).
enum class Answer : std::uint8_t {
    accepted,
    unknown_name,
    bad_value,
    stale,
    no_control,
    wrong_mode,
    refused_by_axis,
    not_possible_now,
    queue_full,
    duplicate,
};

struct CommandAnswer {
    std::uint32_t client = 0;
    std::uint64_t sequence = 0;
    Answer answer = Answer::accepted;
    axes::ErrorId error = axes::ErrorId::none;  ///< refused_by_axis: why
    axes::Owner owner = axes::Owner::none;      ///< no_control: who has it
    const void* holder = nullptr;               ///< the block that moves or locks the axis (MachineLayout::block_at)
    double limited_to = 0;                      ///< u/s, > 0: accepted, but the axis goes no faster than this now ...
    Mode limited_in = Mode::automatic;          ///< ... by the speed of this mode; automatic: by the limit of the axis itself
    // Of a group's jog that goes no further:
    axes::JogEnd jog_end = axes::JogEnd::none;
    axes::AxisRef limiting{};                       ///< whose limit it is; invalid: no axis'
    std::uint8_t room = axes::PathHindrance::none;  ///< of the workspace: which (MachineLayout::GroupInfo::rooms)
    bool waits_for_program = false;                 ///< group_continue, accepted: its program has interrupted it, too, and moves it or not
};
static_assert(std::is_trivially_copyable_v<CommandAnswer>);

}  // namespace taktwerk::runtime

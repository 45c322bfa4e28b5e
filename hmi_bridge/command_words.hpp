#pragma once
// Every command a person can give, once: its word on the socket, its number over LCM (command_v1_t KIND_...), what it acts on
// and what it needs. README.md and the LCM constants repeat this table; a test compares them.

#include <array>
#include <cstdint>
#include <string_view>

#include "runtime/operator_command.hpp"

namespace taktwerk::hmi {

inline constexpr std::int32_t protocol_version = 1;

enum class CommandKind : std::int32_t {
    none = 0,
    take_control,
    release_control,
    mode,
    enable,
    disable,
    home,
    jog,
    move,
    stop,
    reset,
    program_start,
    program_stop,
    program_reset,
    set_parameter,
    set_output,
    acknowledge,
    shutdown,
    force,
    unforce,
    release_forces,
    override_velocity,
    reset_peaks,
    reset_statistics,
    measure,
    set_value,
    group_halt,
    group_interrupt,
    group_continue,
    group_override,
    group_reset,
    group_enable,
    group_disable,
    group_jog,
};

/// What a command acts on. `_or_all`: also "all". point: an input or an output, as its request says. variable: of a
/// program, one that people may write. group: of axes.
enum class TargetKind : std::uint8_t { none, axis, axis_or_all, program, parameter, output, input, point, variable, group };

struct CommandWord {
    CommandKind kind;
    std::string_view word;
    runtime::OperatorAction action;
    TargetKind target;
    std::string_view value, value2;  ///< keys of the numbers on the socket; empty: none
    std::string_view doc;
};

inline constexpr std::array<CommandWord, 33> command_words{{
    {CommandKind::take_control, "take_control", runtime::OperatorAction::take_control, TargetKind::axis_or_all, "", "",
     "become the owner; an axis that moves for another stops first"},
    {CommandKind::release_control, "release_control", runtime::OperatorAction::release_control, TargetKind::axis_or_all, "", "",
     "give the axis back"},
    {CommandKind::mode, "mode", runtime::OperatorAction::set_mode, TargetKind::none, "", "", "manual, setup or automatic"},
    {CommandKind::enable, "enable", runtime::OperatorAction::power, TargetKind::axis_or_all, "", "", "power on"},
    {CommandKind::disable, "disable", runtime::OperatorAction::power, TargetKind::axis_or_all, "", "", "stop, then power off"},
    {CommandKind::home, "home", runtime::OperatorAction::home, TargetKind::axis, "", "", "find the zero position"},
    {CommandKind::jog, "jog", runtime::OperatorAction::jog, TargetKind::axis, "velocity", "",
     "move while held: press once, renew each 50 ms, velocity 0 stops"},
    {CommandKind::move, "move", runtime::OperatorAction::move_absolute, TargetKind::axis, "position", "velocity", "move to a position"},
    {CommandKind::stop, "stop", runtime::OperatorAction::stop, TargetKind::axis_or_all, "", "", "stop along the ramp; anybody may"},
    {CommandKind::reset, "reset", runtime::OperatorAction::reset, TargetKind::axis_or_all, "", "",
     "leave ErrorStop; all: the machine's alarms too"},
    {CommandKind::program_start, "program_start", runtime::OperatorAction::program_start, TargetKind::program, "", "", "in automatic mode"},
    {CommandKind::program_stop, "program_stop", runtime::OperatorAction::program_stop, TargetKind::program, "", "", "its axes ramp down"},
    {CommandKind::program_reset, "program_reset", runtime::OperatorAction::program_reset, TargetKind::program, "", "", "after a fault"},
    {CommandKind::set_parameter, "set_parameter", runtime::OperatorAction::set_parameter, TargetKind::parameter, "value", "",
     "within its range"},
    {CommandKind::set_output, "set_output", runtime::OperatorAction::set_output, TargetKind::output, "value", "",
     "only while no program runs, not in automatic mode"},
    {CommandKind::acknowledge, "acknowledge", runtime::OperatorAction::acknowledge_alarms, TargetKind::none, "", "", "all alarms"},
    {CommandKind::shutdown, "shutdown", runtime::OperatorAction::shutdown, TargetKind::none, "", "", "stop the axes, power off, end"},
    {CommandKind::force, "force", runtime::OperatorAction::force, TargetKind::point, "value", "",
     "put a value in place of an input's or an output's, until it is released or the client goes"},
    {CommandKind::unforce, "unforce", runtime::OperatorAction::unforce, TargetKind::point, "", "", "that one shows its own value again"},
    {CommandKind::release_forces, "release_forces", runtime::OperatorAction::release_forces, TargetKind::none, "", "",
     "all of them, whoever forced them"},
    {CommandKind::override_velocity, "override", runtime::OperatorAction::override_velocity, TargetKind::axis_or_all, "value", "",
     "0 to 1, the operator's factor on every commanded velocity; 0 halts"},
    {CommandKind::reset_peaks, "reset_peaks", runtime::OperatorAction::reset_peaks, TargetKind::axis_or_all, "", "",
     "the peaks of the following error begin anew"},
    {CommandKind::reset_statistics, "reset_statistics", runtime::OperatorAction::reset_statistics, TargetKind::none, "", "",
     "maxima and histograms of cycle and tasks begin anew"},
    {CommandKind::measure, "measure", runtime::OperatorAction::measure, TargetKind::axis, "", "",
     "measure while held: press once with what, renew each 50 ms; stop lets go"},
    {CommandKind::set_value, "set_value", runtime::OperatorAction::set_value, TargetKind::variable, "value", "",
     "of a program that declares it for people; a button: press once, renew each 50 ms, value 0 lets go"},
    {CommandKind::group_halt, "group_halt", runtime::OperatorAction::group_halt, TargetKind::group, "", "",
     "stop its axes, on the path while it moves; anybody may"},
    {CommandKind::group_interrupt, "group_interrupt", runtime::OperatorAction::group_interrupt, TargetKind::group, "", "",
     "come to rest on the path and keep the commands"},
    {CommandKind::group_continue, "group_continue", runtime::OperatorAction::group_continue, TargetKind::group, "", "",
     "go on where group_interrupt has brought it to rest"},
    {CommandKind::group_override, "group_override", runtime::OperatorAction::group_override, TargetKind::group, "value", "",
     "0 to 1, the operator's factor on the velocity along the path; 0 halts"},
    {CommandKind::group_reset, "group_reset", runtime::OperatorAction::group_reset, TargetKind::group, "", "",
     "its axes leave ErrorStop, then it leaves GroupErrorStop"},
    {CommandKind::group_enable, "group_enable", runtime::OperatorAction::group_enable, TargetKind::group, "", "",
     "it takes commands; its axes need power"},
    {CommandKind::group_disable, "group_disable", runtime::OperatorAction::group_disable, TargetKind::group, "", "",
     "stop on the path, then take no commands"},
    {CommandKind::group_jog, "group_jog", runtime::OperatorAction::group_jog, TargetKind::group, "velocity", "",
     "move while held, in a frame: press once, renew each 50 ms, velocity 0 stops"},
}};

namespace command_word_check {
/// Entry i has number i + 1: found by index.
consteval bool sound() {
    for (std::size_t i = 0; i < command_words.size(); ++i)
        if (static_cast<std::size_t>(command_words[i].kind) != i + 1 || command_words[i].word.empty()) return false;
    return static_cast<std::size_t>(CommandKind::group_jog) == command_words.size();
}
static_assert(sound());
}  // namespace command_word_check

/// nullptr for numbers that are no command.
[[nodiscard]] constexpr const CommandWord* find_command(CommandKind kind) noexcept {
    const auto number = static_cast<std::int64_t>(kind);
    if (number < 1 || number > static_cast<std::int64_t>(command_words.size())) return nullptr;
    return &command_words[static_cast<std::size_t>(number - 1)];
}
[[nodiscard]] constexpr const CommandWord* find_command(std::string_view word) noexcept {
    for (const auto& entry : command_words)
        if (entry.word == word) return &entry;
    return nullptr;
}

}  // namespace taktwerk::hmi

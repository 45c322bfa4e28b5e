#pragma once
// Who may give which command from a page: one table, tested cell by cell. What a command then does is the machine's to judge. Not real-time.

#include <array>
#include <optional>
#include <string_view>

namespace taktwerk::hmi::web {

/// Each may all that those before it may.
enum class Role { viewer, operates, engineer, admin };

[[nodiscard]] std::string_view word(Role role);  ///< "viewer", "operator", "engineer", "admin"
[[nodiscard]] std::optional<Role> role_of(std::string_view word);

struct CommandRule {
    std::string_view command;  ///< `cmd` of the local socket
    Role least;                ///< the first role that may
    bool moves;                ///< may begin something: an old one is refused (message_age.hpp)
};

/// Every command of the local socket; what does not stand here comes from no page.
inline constexpr std::array command_rules{
    CommandRule{"hello", Role::viewer, false},
    CommandRule{"layout", Role::viewer, false},
    CommandRule{"state", Role::viewer, false},
    CommandRule{"alarms", Role::viewer, false},
    CommandRule{"views", Role::viewer, false},
    CommandRule{"view_image", Role::viewer, false},
    CommandRule{"set_value", Role::operates, true},
    CommandRule{"alarm_history", Role::viewer, false},
    CommandRule{"measure", Role::engineer, true},
    CommandRule{"measure_plan", Role::viewer, false},
    CommandRule{"measure_result", Role::viewer, false},
    CommandRule{"drive_read", Role::viewer, false},
    CommandRule{"stop", Role::viewer, false},  // anybody may, always
    CommandRule{"take_control", Role::operates, true},
    CommandRule{"release_control", Role::operates, true},
    CommandRule{"mode", Role::operates, true},
    CommandRule{"enable", Role::operates, true},
    CommandRule{"disable", Role::operates, true},
    CommandRule{"home", Role::operates, true},
    CommandRule{"jog", Role::operates, true},
    CommandRule{"move", Role::operates, true},
    CommandRule{"reset", Role::operates, true},
    CommandRule{"program_start", Role::operates, true},
    CommandRule{"program_stop", Role::operates, true},
    CommandRule{"program_reset", Role::operates, true},
    CommandRule{"acknowledge", Role::operates, true},
    CommandRule{"set_parameter", Role::engineer, true},
    CommandRule{"set_output", Role::engineer, true},
    CommandRule{"simulate", Role::engineer, true},
    CommandRule{"drive_write", Role::engineer, true},
    CommandRule{"drive_store", Role::engineer, true},
    CommandRule{"override", Role::operates, true},
    CommandRule{"group_halt", Role::viewer, false},  // anybody may, always
    CommandRule{"group_interrupt", Role::operates, true},
    CommandRule{"group_continue", Role::operates, true},
    CommandRule{"group_override", Role::operates, true},
    CommandRule{"group_reset", Role::operates, true},
    CommandRule{"group_enable", Role::operates, true},
    CommandRule{"group_disable", Role::operates, true},
    CommandRule{"group_jog", Role::operates, true},
    CommandRule{"reset_peaks", Role::operates, true},
    CommandRule{"force", Role::engineer, true},
    CommandRule{"unforce", Role::engineer, true},
    CommandRule{"release_forces", Role::engineer, true},
    CommandRule{"reset_statistics", Role::engineer, true},
    CommandRule{"histograms", Role::viewer, false},
    CommandRule{"bus", Role::viewer, false},
    CommandRule{"drive_parameters", Role::viewer, false},
    CommandRule{"log", Role::operates, false},
    CommandRule{"shutdown", Role::admin, true},
    CommandRule{"scope_signals", Role::viewer, false},
    CommandRule{"scope_read", Role::viewer, false},
    CommandRule{"scope_arm", Role::viewer, false},
    CommandRule{"scope_state", Role::viewer, false},
    CommandRule{"scope_disarm", Role::viewer, false},
    CommandRule{"recordings", Role::viewer, false},
    CommandRule{"recording_signals", Role::viewer, false},
    CommandRule{"recording_read", Role::viewer, false},
    CommandRule{"recording_part", Role::operates, false},  // the file itself leaves the machine
    CommandRule{"replay_keep", Role::operates, false},
    CommandRule{"replay_state", Role::viewer, false},
};

/// What moves nothing and belongs to no connection: all pages ask it over one connection in turn (question_turns.hpp), so that it delays neither a stop nor
/// the renewal of a jog, and takes no place at the machine from who commands. Not so a stop, nor a trigger, which ends with its connection.
[[nodiscard]] bool only_asks(const CommandRule& rule);

/// Null: no such command.
[[nodiscard]] const CommandRule* find_rule(std::string_view command);
[[nodiscard]] bool may(Role role, const CommandRule& rule);

}  // namespace taktwerk::hmi::web

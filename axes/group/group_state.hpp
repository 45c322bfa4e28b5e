#pragma once
// The states of a group and what leads from one to the next: PLCopen Part 4's diagram as one table (G-010, G-011, G-018). Every state has an
// answer to every event; `no` means that there is no arrow, and whoever asked is refused.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "axes/group/group_types.hpp"

namespace taktwerk::axes {

enum class GroupEvent : std::uint8_t {
    enable,         ///< MC_GroupEnable of a group without a kept error
    enable_failed,  ///< ... of one whose error nobody has reset
    disable,        ///< MC_GroupDisable, MC_UngroupAllAxes, once the group stands
    error,          ///< of a member or of the path; never of a block instance
    reset,          ///< MC_GroupReset has succeeded
    motion,         ///< a command that moves, or waits
    home,           ///< MC_GroupHome
    done,           ///< nothing is left to do
    stop,           ///< MC_GroupStop
    stopped,        ///< MC_GroupStop is Done and its Execute FALSE
};
inline constexpr std::size_t group_event_count = 10;

namespace group_table {

using enum GroupState;
inline constexpr GroupState no = static_cast<GroupState>(0xFF);
// As wide as a column of the table. NOLINTBEGIN(readability-identifier-naming)
inline constexpr GroupState Off = GroupDisabled, Ready = GroupStandby, Home = GroupHoming, Move = GroupMoving, Stop = GroupStopping,
                            Error = GroupErrorStop;
// NOLINTEND(readability-identifier-naming)

// clang-format off
inline constexpr std::array<std::array<GroupState, group_event_count>, group_state_count> rows{{
    // enable failed disbl error  reset  motion home  done   stop  stopped
    {Ready, Error, Off,  no,    no,    no,    no,   no,    no,   no},     // GroupDisabled
    {Ready, no,    Off,  Error, no,    Move,  Home, no,    Stop, no},     // GroupStandby
    {Home,  no,    Off,  Error, no,    no,    no,   Ready, Stop, no},     // GroupHoming
    {Move,  no,    Off,  Error, no,    Move,  no,   Ready, Stop, no},     // GroupMoving
    {no,    no,    Off,  Error, no,    no,    no,   no,    no,   Ready},  // GroupStopping
    {no,    no,    Off,  Error, Ready, no,    no,   no,    no,   no},     // GroupErrorStop
}};
// clang-format on

/// Every entry is a state or `no`; whatever is enabled can fail and be disabled, only MC_GroupStop stops, only a reset leads out of an error.
consteval bool sound() {
    for (std::size_t from = 0; from < group_state_count; ++from) {
        const auto& row = rows[from];
        for (std::size_t event = 0; event < group_event_count; ++event) {
            const auto to = row[event];
            if (to != no && static_cast<std::size_t>(to) >= group_state_count) return false;
            const bool stays = to != no && static_cast<std::size_t>(to) == from;
            if (to == GroupStopping && event != static_cast<std::size_t>(GroupEvent::stop)) return false;
            const bool leaves_error = from == static_cast<std::size_t>(GroupErrorStop) && to != no && !stays;
            if (leaves_error && event != static_cast<std::size_t>(GroupEvent::reset) &&
                event != static_cast<std::size_t>(GroupEvent::disable))
                return false;
        }
        if (row[static_cast<std::size_t>(GroupEvent::disable)] != GroupDisabled) return false;
        const bool enabled = from != static_cast<std::size_t>(GroupDisabled);
        if (enabled && row[static_cast<std::size_t>(GroupEvent::error)] != GroupErrorStop) return false;
    }
    return true;
}
static_assert(sound());
static_assert(static_cast<std::size_t>(GroupEvent::stopped) + 1 == group_event_count);
static_assert(static_cast<std::size_t>(GroupErrorStop) + 1 == group_state_count);

}  // namespace group_table

/// Where `event` leads from `state`; nothing where the diagram has no arrow. Real-time safe.
[[nodiscard]] constexpr std::optional<GroupState> next_state(GroupState state, GroupEvent event) noexcept {
    const auto to = group_table::rows[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
    if (to == group_table::no) return std::nullopt;
    return to;
}

}  // namespace taktwerk::axes

#pragma once
// How an axis itself answers its alarms, and how far a machine file may choose otherwise: always something harder, something milder only where
// the table of bounds says so. What stands in `alarms.hpp` holds where nothing is chosen.

#include <array>
#include <cstdint>
#include <string_view>

#include "axes/axis/alarms.hpp"

namespace taktwerk::axes {

/// From mild to hard; stop categories of IEC 60204-1, 9.2.2.
enum class ErrorReaction : std::uint8_t {
    by_table,       ///< nothing is chosen
    warn,           ///< shown; the axis goes on
    ramp_stop,      ///< along its stop deceleration to ErrorStop; power stays (category 2)
    stop_machine,   ///< the same, and every other axis with it
    ramp_then_off,  ///< along its stop deceleration, then its power goes (category 1)
    quick_stop,     ///< the drive stops by itself (605Ah), then its power goes (category 1)
    power_off,      ///< its power goes at once: the motor coasts, or its brake holds it (category 0)
};

struct ReactionWord {
    ErrorReaction reaction;
    std::string_view name;  ///< in the machine file
    std::string_view text;  ///< for people, behind an alarm
};
inline constexpr std::array reaction_words{
    ReactionWord{ErrorReaction::warn, "warn", "warning"},
    ReactionWord{ErrorReaction::ramp_stop, "ramp_stop", "the axis stops"},
    ReactionWord{ErrorReaction::stop_machine, "stop_machine", "all axes stop"},
    ReactionWord{ErrorReaction::ramp_then_off, "ramp_then_off", "the axis stops, then its power goes off"},
    ReactionWord{ErrorReaction::quick_stop, "quick_stop", "the drive stops the axis by its quick stop, then its power goes off"},
    ReactionWord{ErrorReaction::power_off, "power_off", "the power of the axis goes off at once"},
};
[[nodiscard]] constexpr const ReactionWord& word_of(ErrorReaction reaction) noexcept {
    for (const auto& word : reaction_words)
        if (word.reaction == reaction) return word;
    return reaction_words.back();
}

/// An alarm whose reaction may be chosen. Those of a drive that has fallen, of a bus or feedback that is lost, and of limits have no milder one.
struct ReactionBound {
    AxisAlarm alarm;
    ErrorReaction mildest;
    std::string_view because;  ///< nothing milder is taken
};
namespace reaction_bounds {
using enum AxisAlarm;
using enum ErrorReaction;
inline constexpr std::array rows{
    ReactionBound{following_error, warn, ""},
    ReactionBound{drive_fault, ramp_stop, "the drive has stopped by its fault reaction: the axis cannot go on"},
    ReactionBound{drive_power_lost, ramp_stop, "the drive has no power: the axis cannot go on"},
    ReactionBound{axis_feedback_lost, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{enable_timeout, ramp_stop, "the drive has no power: the axis cannot go on"},
    ReactionBound{software_limit_reached, ramp_stop, "the axis would pass its limit"},
    ReactionBound{negative_limit_switch, ramp_stop, "the axis would run into its end"},
    ReactionBound{positive_limit_switch, ramp_stop, "the axis would run into its end"},
    ReactionBound{homing_failed, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{homing_timeout, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{jog_lease_expired, warn, ""},
    ReactionBound{drive_unknown_state, ramp_then_off, "nobody knows what the drive does"},
    ReactionBound{drive_mode_mismatch, ramp_then_off, "the drive does not do what it is told"},
    ReactionBound{drive_warning, warn, ""},
    ReactionBound{planner_refused, ramp_then_off, "no motion could be planned"},
    ReactionBound{master_lost, ramp_stop, "there is nothing to follow any more"},
    ReactionBound{drive_homing_failed, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{drive_homing_timeout, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{drive_homing_refused, ramp_stop, "homing was not started"},
    ReactionBound{reference_lost, warn, ""},
    ReactionBound{drive_setup_refused, ramp_stop, "the drive is not enabled"},
    ReactionBound{drive_too_fast, ramp_stop, "the axis is beyond its limit"},
    ReactionBound{both_limit_switches, warn, ""},
    ReactionBound{gantry_skew_warning, warn, ""},
    ReactionBound{gantry_skew, ramp_stop, "the portal would be racked further"},
    ReactionBound{gantry_side_lost, ramp_stop, "one side has no power: the axis cannot go on"},
    ReactionBound{load_deviation, warn, ""},
    ReactionBound{motor_turns, ramp_stop, "the drive has no power: the axis cannot go on"},
    ReactionBound{drive_polarity, ramp_stop, "the drive has no power: the axis cannot go on"},
    ReactionBound{encoder_lost, ramp_stop, "nobody knows where the axis is"},
    ReactionBound{amplifier_fault, ramp_stop, "the drive has no power: the axis cannot go on"},
    ReactionBound{drive_not_ready, ramp_stop, "the drive has no power: the axis cannot go on"},
};
}  // namespace reaction_bounds

/// nullptr: it is not chosen (those of the whole machine, and those that appear before the axis does anything).
[[nodiscard]] constexpr const ReactionBound* bound_of(AxisAlarm alarm) noexcept {
    for (const auto& row : reaction_bounds::rows)
        if (row.alarm == alarm) return &row;
    return nullptr;
}

/// What the alarm's table means for the axis itself.
[[nodiscard]] constexpr ErrorReaction reaction_by_table(AxisAlarm alarm) noexcept {
    switch (reaction(alarm)) {
        case Reaction::none:
        case Reaction::warn: return ErrorReaction::warn;
        case Reaction::stop_axis: return ErrorReaction::ramp_stop;
        case Reaction::stop_machine: return ErrorReaction::stop_machine;
        case Reaction::power_off: return ErrorReaction::ramp_then_off;
    }
    return ErrorReaction::ramp_then_off;
}

namespace reaction_bounds {
consteval bool sound() {
    for (const auto& row : rows) {
        const auto usual = reaction_by_table(row.alarm);
        if (row.mildest > usual) return false;
        // A milder one than the table's is for supervision that somebody may as well leave out.
        if (row.mildest < usual && row.alarm != following_error && row.alarm != load_deviation) return false;
        if ((row.mildest > warn) == row.because.empty()) return false;
    }
    return axis_alarms.back().id - axis_alarms.front().id + 1u == axis_alarm_count;  // places are numbers without gaps
}
static_assert(sound());
}  // namespace reaction_bounds

/// The choices of one axis. Trivially small; real-time safe.
class ErrorReactions {
public:
    void choose(AxisAlarm alarm, ErrorReaction reaction) noexcept { chosen_[place(alarm)] = reaction; }
    [[nodiscard]] ErrorReaction chosen(AxisAlarm alarm) const noexcept { return chosen_[place(alarm)]; }
    /// What the axis does.
    [[nodiscard]] ErrorReaction of(AxisAlarm alarm) const noexcept {
        const auto own = chosen(alarm);
        return own == ErrorReaction::by_table ? reaction_by_table(alarm) : own;
    }
    /// What the machine does: never less than the table's where that reaches beyond the axis.
    [[nodiscard]] Reaction of_machine(AxisAlarm alarm) const noexcept {
        const auto usual = reaction(alarm);
        const auto own = chosen(alarm);
        if (own == ErrorReaction::by_table || usual >= Reaction::stop_machine) return usual;
        if (own == ErrorReaction::warn) return Reaction::warn;
        return own == ErrorReaction::stop_machine ? Reaction::stop_machine : Reaction::stop_axis;
    }

private:
    [[nodiscard]] static constexpr std::size_t place(AxisAlarm alarm) noexcept {
        return static_cast<std::size_t>(id(alarm) - id(AxisAlarm::following_error));
    }
    std::array<ErrorReaction, axis_alarm_count> chosen_{};
};

}  // namespace taktwerk::axes

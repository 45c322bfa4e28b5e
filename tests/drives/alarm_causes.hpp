#pragma once
// Which alarms of the five drives the simulated ones find out by computing, and why the others only come when somebody says so
// (Cia402Axis::provoke, Servo::raise). Data: alarm_causes_unit.cpp makes each cause happen and holds both lists up against the drives' files,
// so that an alarm cannot join the second list unnoticed.

#include <ostream>
#include <string_view>
#include <vector>

namespace taktwerk::test {

/// What happens to the drive.
enum class Cause {
    main_power_gone,
    phase_missing,          ///< of the mains, while the motor has power
    phase_missing_at_rest,  ///< while it has none
    supply_too_high,
    enabled_by_input_too,  ///< besides the bus
    faster_than_allowed,
    enabled_while_turning,
    overloaded,         ///< more than rated torque until the motor's I2t is used up
    torque_above_user,  ///< more than the user's own torque limit for longer than he allows
    stalled,            ///< at the torque limit without turning
    jammed,             ///< it lags behind its set-point
    setpoint_leaps,
    encoder_fails,
    encoder_turns_full,
    battery_low,
    battery_empty,  ///< and the control supply was off
    bus_leaves_op,
    outputs_missing,   ///< SYNC0 goes on, no frames
    outputs_watchdog,  ///< the slave controller's own watchdog
    sync_missing,      ///< frames go on, no SYNC0
    link_changes,
    positive_limit,
    negative_limit,
    emergency_stop_ordered,
    limits_crossed,
    home_outside_limits,
    homing_too_long,
    homing_into_limit,
    homing_method_unknown,
    mode_not_set,
    restart_awaited,
    stored_too_often,
    both_limits_open,
    off_while_saving,
};

struct Found {
    std::string_view drive, panel;
    Cause cause;
    const char* section;
    friend void PrintTo(const Found& found, std::ostream* out) {
        *out << found.drive << ' ' << found.panel << " [" << found.section << ']';
    }
};

inline const std::vector<Found>& found_by_computing() {
    static const std::vector<Found> list{
        {"sv33-e", "E.217", Cause::phase_missing, "5.4, 7.2 P08.00"},
        {"sv33-e", "E.218", Cause::emergency_stop_ordered, "5.4, 7.2 P20.02"},
        {"sv33-e", "E.414", Cause::main_power_gone, "5.4"},
        {"sv33-e", "E.416", Cause::faster_than_allowed, "5.4"},
        {"sv33-e", "E.417", Cause::enabled_while_turning, "5.4"},
        {"sv33-e", "E.418", Cause::enabled_by_input_too, "5.4, 8.1"},
        {"sv33-e", "E.419", Cause::overloaded, "5.4"},
        {"sv33-e", "E.423", Cause::jammed, "5.4, 7.3 6065h"},
        {"sv33-e", "E.424", Cause::setpoint_leaps, "5.4"},
        {"sv33-e", "E.911", Cause::encoder_fails, "5.4"},
        {"sv33-e", "E.917", Cause::battery_empty, "5.4"},
        {"sv33-e", "E.919", Cause::encoder_turns_full, "5.4, 3.1.4"},
        {"sv33-e", "E.B11", Cause::stalled, "5.4, 7.2 P08.18"},
        {"sv33-e", "E.D15", Cause::limits_crossed, "5.4"},
        {"sv33-e", "E.D16", Cause::home_outside_limits, "5.4"},
        {"sv33-e", "E.D26", Cause::bus_leaves_op, "5.4"},
        {"sv33-e", "E.D32", Cause::sync_missing, "5.4, 7.2 P0A.31"},
        {"sv33-e", "A.220", Cause::positive_limit, "5.5"},
        {"sv33-e", "A.221", Cause::negative_limit, "5.5"},
        {"sv33-e", "A.222", Cause::phase_missing_at_rest, "5.5, 7.2 P08.00"},
        {"sv33-e", "A.425", Cause::homing_too_long, "5.5, 7.2 P13.49"},
        {"sv33-e", "A.426", Cause::restart_awaited, "5.5"},
        {"sv33-e", "A.427", Cause::stored_too_often, "5.5, 7.2 P05.10"},
        {"sv33-e", "A.921", Cause::battery_low, "5.5"},
        {"sv33-e", "A.D35", Cause::homing_method_unknown, "5.5"},

        {"sv-da200", "Er24-a", Cause::sync_missing, "5.2"},
        {"sv-da200", "Er24-c", Cause::outputs_missing, "5.2, P4.09"},
        {"sv-da200", "Er02-0", Cause::encoder_fails, "5.3"},
        {"sv-da200", "Er02-7", Cause::battery_empty, "5.3"},
        {"sv-da200", "Er02-8", Cause::battery_low, "5.3"},
        {"sv-da200", "Er05-4", Cause::homing_method_unknown, "5.3"},
        {"sv-da200", "Er13-1", Cause::main_power_gone, "5.3"},
        {"sv-da200", "Er17-0", Cause::overloaded, "5.3"},
        {"sv-da200", "Er19-0", Cause::faster_than_allowed, "5.3"},
        {"sv-da200", "Er21-0", Cause::positive_limit, "5.3"},
        {"sv-da200", "Er21-1", Cause::negative_limit, "5.3"},
        {"sv-da200", "Er22-0", Cause::jammed, "5.3, P4.33"},
        {"sv-da200", "Er22-2", Cause::setpoint_leaps, "5.3"},
        {"sv-da200", "Er25-6", Cause::homing_into_limit, "5.3"},

        {"tsvm-d6", "3", Cause::main_power_gone, "7.1"},
        {"tsvm-d6", "21", Cause::outputs_missing, "7.1.1"},
        {"tsvm-d6", "22", Cause::link_changes, "7.1.1"},
        {"tsvm-d6", "101", Cause::faster_than_allowed, "7.2, PA23"},
        {"tsvm-d6", "104", Cause::jammed, "7.2, PA17"},
        {"tsvm-d6", "105", Cause::overloaded, "7.2"},
        {"tsvm-d6", "115", Cause::encoder_fails, "7.2"},
        {"tsvm-d6", "119", Cause::battery_empty, "7.2"},
        {"tsvm-d6", "127", Cause::battery_low, "7.2"},
        {"tsvm-d6", "129", Cause::torque_above_user, "7.2, PA30, PA31"},
        {"tsvm-d6", "143", Cause::mode_not_set, "7.2"},
        {"tsvm-d6", "144", Cause::bus_leaves_op, "7.2"},

        {"se-808x", "ALM quick 4", Cause::main_power_gone, "5.1"},
        {"se-808x", "ALM quick 5", Cause::supply_too_high, "5.1, 4.4 2000h:15"},
        {"se-808x", "ALM slow 2", Cause::jammed, "5.1"},
        {"se-808x", "ALM slow 3", Cause::overloaded, "5.1"},
        {"se-808x", "ALM slow 4", Cause::outputs_watchdog, "5.1, 5.2"},
        {"se-808x", "ALM slow 5", Cause::encoder_fails, "5.1"},

        {"xp200", "E 1", Cause::faster_than_allowed, "6.1, Pr075"},
        {"xp200", "E 4", Cause::jammed, "6.1, Pr080"},
        {"xp200", "E 6", Cause::stalled, "6.1"},
        {"xp200", "E 7", Cause::both_limits_open, "6.1, Pr097"},
        {"xp200", "E 9", Cause::encoder_fails, "6.1"},
        {"xp200", "E13", Cause::overloaded, "6.1"},
        {"xp200", "E20", Cause::off_while_saving, "6.1"},
        {"xp200", "E29", Cause::torque_above_user, "6.1, Pr070, Pr072"},
    };
    return list;
}

struct ToldOnly {
    std::string_view drive, reason;
    std::vector<std::string_view> panels;
};

inline const std::vector<ToldOnly>& told_only() {
    constexpr std::string_view power_stage = "the model has no currents, phases and bus voltage",
                               board = "a defect of boards, memory or firmware that the model does not have",
                               heat = "the model has no temperatures",
                               wired = "somebody works an input or a supply that the model does not have",
                               encoder = "the model's encoder works or fails as a whole", tuning = "the model does not identify or tune",
                               data = "the model does not check this setting",
                               same = "another row of this drive has the same cause, and the manual does not say which of them shows";
    static const std::vector<ToldOnly> list{
        {"sv33-e", board, {"E.010", "E.011", "E.012", "E.013", "E.014", "E.016", "E.017", "E.018", "E.D23", "E.D29", "E.D30"}},
        {"sv33-e", power_stage, {"E.015", "E.210", "E.211", "E.212", "E.213", "E.227", "E.228", "E.413", "E.415", "A.224", "A.225"}},
        {"sv33-e", wired, {"E.214", "E.216"}},
        {"sv33-e", heat, {"E.219", "E.922", "E.B15"}},
        {"sv33-e", data, {"E.019", "E.411", "E.412", "E.420", "E.421", "E.422", "E.430", "E.D27", "E.D28", "E.D31", "A.226", "A.428"}},
        {"sv33-e", same, {"E.710", "E.918", "E.B10", "E.D20", "E.D21", "E.D22", "E.D24", "E.D25"}},
        {"sv33-e", tuning, {"E.711", "E.712", "E.715", "E.716", "E.B13", "E.B14"}},
        {"sv33-e", encoder, {"E.910", "E.912", "E.913", "E.914", "E.916", "A.920"}},

        {"sv-da200",
         board,
         {"Er24-8", "Er24-9", "Er03-0", "Er03-1", "Er03-2", "Er04-0", "Er09-0", "Er09-1", "Er10-0", "Er10-1", "Er10-5", "Er11-0", "Er11-1",
          "Er11-2"}},
        {"sv-da200", power_stage, {"Er01-0", "Er01-1", "Er07-0", "Er10-2", "Er13-0", "Er19-4", "Er20-0"}},
        {"sv-da200", wired, {"Er08-0", "Er08-1", "Er08-2", "Er10-3", "Er10-4", "Er12-2", "Er14-0"}},
        {"sv-da200", heat, {"Er02-a", "Er18-1", "Er23-0"}},
        {"sv-da200", encoder, {"Er02-1", "Er02-2", "Er02-3", "Er02-4", "Er02-5", "Er02-6", "Er02-b", "Er02-c", "Er02-d"}},
        {"sv-da200", same, {"Er24-b", "Er02-9", "Er18-0", "Er19-1", "Er19-2", "Er22-1"}},
        {"sv-da200",
         data,
         {"Er05-1", "Er05-2", "Er05-3", "Er05-5", "Er12-0", "Er12-1", "Er19-3", "Er24-0", "Er24-1", "Er24-2", "Er24-3", "Er24-4"}},
        {"sv-da200", tuning, {"Er25-4", "Er25-5", "Er25-7"}},

        {"tsvm-d6", board, {"1", "6", "12", "102", "120", "121", "123", "134", "146"}},
        {"tsvm-d6", power_stage, {"2", "11", "13", "16", "111", "112"}},
        {"tsvm-d6", wired, {"25"}},
        {"tsvm-d6", heat, {"20"}},
        {"tsvm-d6", data, {"17", "26", "110", "122", "133", "135", "145", "147"}},
        {"tsvm-d6", same, {"5", "106", "113", "114", "118", "128"}},
        {"tsvm-d6", encoder, {"124"}},
        {"tsvm-d6", tuning, {"103"}},

        {"se-808x", board, {"ALM quick 2", "ALM quick 6"}},
        {"se-808x", power_stage, {"ALM quick 3"}},

        {"xp200", power_stage, {"E 2", "E11", "E12", "E14"}},
        {"xp200", "mains and control supply are one: without it the drive is off [4.1]", {"E 3"}},
        {"xp200", "the model takes pulses at any frequency", {"E 5"}},
        {"xp200", board, {"E21", "E23", "E24"}},
        {"xp200", encoder, {"E10", "E30", "E31", "E32", "E33"}},
    };
    return list;
}

}  // namespace taktwerk::test

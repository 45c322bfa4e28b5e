#include "tests/whole_machine/causes.hpp"

#include <array>

namespace taktwerk::whole {

namespace {

using enum Where;
using C = Consequence;

template <std::size_t... lengths>
consteval auto all_of(const std::array<Consequence, lengths>&... lists) {
    std::array<Consequence, (lengths + ... + 0)> out;
    std::size_t at = 0;
    const auto take = [&](const auto& list) {
        for (const auto& one : list) out[at++] = one;
    };
    (take(lists), ...);
    return out;
}

/// Where an axis stops that a program moves: it says so, and it may have the machine stopped.
constexpr std::array stopped{C{"program_alarm_"}, C{"stopped_by_machine"}, C{"start_withdrawn"}};

/// What is not exchanged any more: its drives stop by their own watchdogs, an emergency stop that cannot be read counts as pressed.
constexpr std::array not_exchanged{C{"frames_lost"},    C{"drive_fault"},          C{"axis_feedback_lost"}, C{"emergency_stop"},
                                   C{"program_waits"},  C{"slave_left_op"},        C{"slave_emergency"},    C{"dc_not_locked"},
                                   C{"dc_out_of_sync"}, C{"reference_clock_lost"}, C{"gantry_skew"},        C{"gantry_skew_warning"}};
constexpr auto bus_lost = all_of(not_exchanged, stopped);

/// A part of the bus is away; what stands behind it as well.
constexpr auto slaves_lost =
    all_of(bus_lost, std::array{C{"slave_lost"}, C{"cable_broken"}, C{"slaves_missing"}, C{"station_address_lost"}, C{"drive_power_lost"},
                                C{"cut_off_from_reference"}, C{"working_counter_wrong"}, C{"reference_lost"}, C{"cable_loses_link"},
                                C{"foreign_command"}});  // one that is back before it was missed is in INIT: nobody knows who put it there
constexpr auto port_lost = all_of(slaves_lost, std::array{C{"link_down"}});
constexpr auto counters = all_of(bus_lost, std::array{C{"working_counter_wrong"}});
constexpr auto other_state = all_of(
    std::array{C{"foreign_command"}, C{"slave_left_op"}, C{"slave_emergency", here}, C{"drive_fault", here}, C{"axis_feedback_lost", here},
               C{"emergency_stop"}, C{"program_waits"}, C{"gantry_skew", here}, C{"gantry_skew_warning", here}},
    stopped);
/// Of what is asked over the mailbox nothing is known, and nothing can be set up.
constexpr std::array mailbox{C{"mailbox_silent", here}, C{"drive_setup_refused", here}, C{"drive_homing_refused", here}};
constexpr std::array reference{C{"reference_clock_lost"}, C{"dc_not_locked"}, C{"dc_out_of_sync"}};

constexpr auto drive = all_of(std::array{C{"drive_fault", here}, C{"slave_emergency", here}, C{"drive_power_lost", here},
                                         C{"enable_timeout", here}, C{"drive_homing_failed", here}, C{"homing_failed", here},
                                         C{"reference_lost", here}, C{"gantry_skew", here}, C{"gantry_skew_warning", here}},
                              stopped);
/// Let go in a motion of its own, a drive makes up what it was held behind as fast as it can.
constexpr auto held = all_of(std::array{C{"drive_too_fast", here}, C{"following_error", here}, C{"drive_fault", here},
                                        C{"slave_emergency", here}, C{"drive_homing_failed", here}, C{"homing_failed", here},
                                        C{"drive_homing_timeout", here}, C{"gantry_skew", here}, C{"gantry_skew_warning", here}},
                             stopped);
constexpr auto line = all_of(std::array{C{"drive_silent"}, C{"drive_not_ready_on_line"}, C{"axis_feedback_lost", here},
                                        C{"drive_fault", here}, C{"following_error", here}},
                             stopped);
constexpr auto thrown = all_of(std::array{C{"program_fault", here}}, stopped);
constexpr std::array no_number{C{"output_no_number"}, C{"axis_of_two_programs"}};
constexpr auto quarrel =
    all_of(std::array{C{"axis_of_two_programs", here}, C{"following_error", here}, C{"software_limit_reached", here}}, stopped);
constexpr auto pressed = all_of(std::array{C{"emergency_stop"}, C{"program_waits"}, C{"drive_homing_failed"}}, stopped);
constexpr auto forced = all_of(std::array{C{"points_forced"}, C{"input_out_of_limits"}}, stopped);
/// What a task took is measured by a true clock in virtual time, too: on a computer that is busy one may have taken its cycle just before one comes late.
constexpr std::array late{C{"late_wakeups"}, C{"dc_not_locked"}, C{"dc_out_of_sync"}, C{"base_task_overrun"}};
/// The computer sends nothing for a while: the slaves do what they are there for.
constexpr auto starved = all_of(bus_lost, late,
                                std::array{C{"cycle_overrun"}, C{"starved_slave_left_op"}, C{"jog_lease_expired"}, C{"drive_silent"},
                                           C{"task_overrun"}, C{"drive_not_ready_on_line"}, C{"working_counter_wrong"}, C{"slave_lost"}});
constexpr std::array disk{C{"retain_not_written"}, C{"positions_outdated"}, C{"stopped_by_machine"}};

/// An axis may be led anywhere by hand: to its limits, against a stop.
constexpr auto by_hand = all_of(std::array{C{"jog_lease_expired", here}, C{"software_limit_reached", here},
                                           C{"negative_limit_switch", here}, C{"positive_limit_switch", here}, C{"following_error", here},
                                           C{"drive_fault", here}, C{"slave_emergency", here}, C{"drive_warning", here}},
                                stopped);
constexpr auto homed = all_of(by_hand, std::array{C{"homing_failed", here}, C{"homing_timeout", here}, C{"drive_homing_failed", here},
                                                  C{"drive_homing_timeout", here}, C{"drive_homing_refused", here}});
/// Power is asked for while the motor still runs out.
constexpr std::array coasting{C{"motor_turns", here}};
constexpr std::array ends{C{"stopped_by_signal"}, C{"bus_not_operational"}, C{"program_alarm_"}, C{"stopped_by_machine"}};
constexpr std::array comes_up{C{"program_alarm_"}};

}  // namespace

std::span<const Consequence> consequences(Trouble trouble) noexcept {
    using enum Trouble;
    switch (trouble) {
        case frames_lost: return {};  // that is nothing
        case frames_lost_long:
        case answers_late: return bus_lost;
        case counter_wrong: return counters;
        case slave_off:
        case cable_pulled: return slaves_lost;
        case link_down: return port_lost;
        case state_changed: return other_state;
        case mailbox_stuck: return mailbox;
        case reference_frozen: return reference;
        case drive_fault:
        case mains_lost: return drive;
        case jammed: return held;
        case line_cut:
        case serial_answers_lost:
        case serial_answers_damaged:
        case serial_drive_fault: return line;
        case throws_in_scan:
        case throws_in_stop: return thrown;
        case no_numbers: return no_number;
        case wrong_commands: return {};  // each is refused to the block that gave it
        case takes_others_axis: return quarrel;
        case emergency_stop: return pressed;
        case commands_at_random:
        case mode_to_and_fro:
        case stops_in_a_row: return {};  // what comes of the single deeds
        case points_forced: return forced;
        case late_by_half: return late;
        case stall_5ms:
        case stall_20ms:
        case stall_200ms:
        case stall_2s: return starved;
        case disk_full:
        case disk_read_only:
        case folder_gone: return disk;
        case bits_flipped: return {};  // the next writing makes it whole
    }
    return {};
}

std::span<const Consequence> consequences(Deed deed) noexcept {
    using enum Deed;
    switch (deed) {
        case jog:
        case move: return by_hand;
        case home: return homed;
        case power_on: return coasting;
        case power_off:
        case stop:
        case reset:
        case change_mode:
        case start_program:
        case stop_program: return stopped;
        case force: return forced;
        case restart: return comes_up;
        case end: return ends;
    }
    return {};
}

}  // namespace taktwerk::whole

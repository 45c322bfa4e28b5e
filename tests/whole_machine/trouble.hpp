#pragma once
// What can happen to a whole machine, from its seven sources, and what its operator does to it.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace taktwerk::whole {

enum class Source : std::uint8_t { bus, drives, serial, programs, operators, host, files };
inline constexpr std::array<std::string_view, 7> source_names{"bus",       "drives", "serial line", "programs",
                                                              "operators", "host",   "file system"};

enum class Trouble : std::uint8_t {
    // bus
    frames_lost,       ///< one or two frames
    frames_lost_long,  ///< all for 5 to 40 ms
    answers_late,      ///< each for 8 to 30 ms by 1.2 to 5 ms
    counter_wrong,     ///< the working counters of process data, for 5 to 20 ms
    slave_off,         ///< a slave is without power for 5 to 800 ms
    cable_pulled,      ///< for 20 to 800 ms, in front of any slave
    link_down,         ///< at the master's port, for 20 to 500 ms
    state_changed,     ///< somebody else sends a slave to INIT, PREOP or SAFEOP
    mailbox_stuck,     ///< of a slave, for 0.5 to 3 s
    reference_frozen,  ///< the reference clock stands for 0.3 to 1 s
    // drives
    drive_fault,  ///< of one axis: over-current
    mains_lost,   ///< of one drive, for 50 to 1000 ms
    jammed,       ///< a motor is held for 50 to 600 ms
    // serial line
    line_cut,  ///< for 0.3 to 2 s
    serial_answers_lost,
    serial_answers_damaged,
    serial_drive_fault,
    // programs
    throws_in_scan,
    throws_in_stop,
    no_numbers,         ///< NaN and infinity to axes and outputs
    wrong_commands,     ///< what no axis takes: names of nobody, values out of every range, all in one scan
    takes_others_axis,  ///< commands what belongs to another program
    // operators
    emergency_stop,      ///< pressed for 50 to 2000 ms
    commands_at_random,  ///< twenty a second for a while
    mode_to_and_fro,
    stops_in_a_row,
    points_forced,
    // host
    late_by_half,  ///< each cycle half a cycle late for 50 cycles
    stall_5ms,
    stall_20ms,
    stall_200ms,
    stall_2s,
    // file system: of all that the machine keeps
    disk_full,  ///< for 0.5 to 3 s
    disk_read_only,
    folder_gone,
    bits_flipped,  ///< in both kept files
};
inline constexpr std::array<std::string_view, 36> trouble_names{
    "frames_lost",     "frames_lost_long", "answers_late",        "counter_wrong",          "slave_off",          "cable_pulled",
    "link_down",       "state_changed",    "mailbox_stuck",       "reference_frozen",       "drive_fault",        "mains_lost",
    "jammed",          "line_cut",         "serial_answers_lost", "serial_answers_damaged", "serial_drive_fault", "throws_in_scan",
    "throws_in_stop",  "no_numbers",       "wrong_commands",      "takes_others_axis",      "emergency_stop",     "commands_at_random",
    "mode_to_and_fro", "stops_in_a_row",   "points_forced",       "late_by_half",           "stall_5ms",          "stall_20ms",
    "stall_200ms",     "stall_2s",         "disk_full",           "disk_read_only",         "folder_gone",        "bits_flipped"};
static_assert(static_cast<std::size_t>(Trouble::bits_flipped) + 1 == trouble_names.size());

[[nodiscard]] constexpr std::string_view name(Trouble trouble) noexcept { return trouble_names[static_cast<std::size_t>(trouble)]; }
[[nodiscard]] constexpr Source source_of(Trouble trouble) noexcept {
    if (trouble <= Trouble::reference_frozen) return Source::bus;
    if (trouble <= Trouble::jammed) return Source::drives;
    if (trouble <= Trouble::serial_drive_fault) return Source::serial;
    if (trouble <= Trouble::takes_others_axis) return Source::programs;
    if (trouble <= Trouble::points_forced) return Source::operators;
    if (trouble <= Trouble::stall_2s) return Source::host;
    return Source::files;
}

/// What a hand does that may raise an alarm by itself.
enum class Deed : std::uint8_t {
    jog,
    home,
    move,
    power_on,
    power_off,
    stop,
    reset,
    change_mode,
    start_program,
    stop_program,
    force,
    restart,  ///< the machine comes up
    end,      ///< it is told to
};
inline constexpr std::array<std::string_view, 13> deed_names{"jog",   "home",    "move",        "power_on",      "power_off",
                                                             "stop",  "reset",   "change_mode", "start_program", "stop_program",
                                                             "force", "restart", "end"};
[[nodiscard]] constexpr std::string_view name(Deed deed) noexcept { return deed_names[static_cast<std::size_t>(deed)]; }

}  // namespace taktwerk::whole

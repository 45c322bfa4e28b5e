#pragma once
// The numbers of what the machine itself announces, and of what it tells with them. Their words and reactions: alarms.hpp.

#include "core/alarm.hpp"

namespace taktwerk::runtime {

enum class MachineAlarm : AlarmId {
    emergency_stop = 0x6001,
    cycle_overrun = 0x6002,
    task_overrun = 0x6003,
    program_fault = 0x6004,
    stopped_by_signal = 0x6005,
    alarm_log_full = 0x6006,
    late_wakeups = 0x6007,
    positions_lost = 0x6008,
    retain_not_written = 0x6009,
    program_waits = 0x600A,
    positions_outdated = 0x600B,
    values_lost = 0x600C,
    base_task_overrun = 0x6010,
    axis_of_two_programs = 0x6011,
    undeclared_use = 0x6012,
    start_withdrawn = 0x6013,
    drive_silent = 0x6014,
    drive_not_ready_on_line = 0x6015,
    input_faulty = 0x6016,
    input_out_of_limits = 0x6017,
    output_no_number = 0x6018,
    group_pulled = 0x6019,
    points_forced = 0x601A,
    task_watchdog = 0x601B,
    task_late = 0x601C,
    bundle_fell_back = 0x601F,
    page_faults = 0x6020,
};
/// First number of input_faulty: what its terminal says.
inline constexpr double input_error = 0, input_underrange = 1, input_overrange = 2, input_no_number = 3;
/// First number of emergency_stop: nobody pressed it, the slave with its input is not exchanged.
inline constexpr double emergency_stop_unread = 1;

[[nodiscard]] constexpr AlarmId id(MachineAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

}  // namespace taktwerk::runtime

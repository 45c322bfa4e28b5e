#pragma once
// What the machine itself announces. One table decides reactions (docs/architecture.md); axes, bus and programs have their own.

#include <array>

#include "core/alarm.hpp"
#include "core/alarm_table.hpp"

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
    positions_not_kept = 0x6009,
    program_waits = 0x600A,
    positions_outdated = 0x600B,
};
/// First number of emergency_stop: nobody pressed it, the slave with its input is not exchanged.
inline constexpr double emergency_stop_unread = 1;

[[nodiscard]] constexpr AlarmId id(MachineAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

inline constexpr std::array<AlarmInfo, 11> machine_alarms{{
    {id(MachineAlarm::emergency_stop), "emergency_stop", "Emergency stop: the axes stop along their ramps, then power goes off",
     "急停:各轴沿减速斜坡停止,随后断开动力", "The emergency stop button is pressed, or its circuit is open",
     "Release the button, acknowledge, then enable again", ResetRule::acknowledge, Reaction::power_off,
     "The safety circuit acts on the drives by hardware (STO); this software is not part of it"},
    {id(MachineAlarm::cycle_overrun), "cycle_overrun", "{a} cycles in a row came too late (limit {b})", "连续 {a} 个周期超时(上限 {b})",
     "The computer does not keep up: another process, power saving, or too short a cycle",
     "Look at the cycle statistics, use a real-time kernel and isolated CPUs, or lengthen `cycle`", ResetRule::reset,
     Reaction::stop_machine, "Missed frames run into the slaves' watchdogs; each drive stops by its own reaction"},
    {id(MachineAlarm::task_overrun),
     "task_overrun",
     "A task was not finished at its next release, {a} times in a row (allowed {b})",
     "任务在下次释放时尚未完成,连续 {a} 次(允许 {b} 次)",
     "The task computes too long for its divisor, or a higher priority starves it",
     "Shorten the task, raise its divisor, or give it another CPU; then reset",
     ResetRule::reset,
     Reaction::stop_machine,
     {}},
    {id(MachineAlarm::program_fault), "program_fault", "The program threw an exception in a scan and was stopped",
     "程序在扫描中抛出异常,已被停止", "A defect in the program",
     "See the message in the log, mend the program, then reset and start it again", ResetRule::reset, Reaction::stop_machine,
     "The slaves' watchdogs stop the drives when the process ends"},
    {id(MachineAlarm::stopped_by_signal),
     "stopped_by_signal",
     "The runtime was told to end; the axes stop and power goes off",
     "运行时收到结束请求;各轴停止并断开动力",
     "Ctrl-C, SIGTERM, or the shutdown command",
     "Nothing to do; start the runtime again when wanted",
     ResetRule::self_clearing,
     Reaction::power_off,
     {}},
    {id(MachineAlarm::alarm_log_full),
     "alarm_log_full",
     "The alarm list is full; {a} further alarms were only counted",
     "报警列表已满;另有 {a} 条报警仅计数",
     "Too many conditions at once",
     "Acknowledge and reset what is listed",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
    {id(MachineAlarm::late_wakeups),
     "late_wakeups",
     "The cycle woke {a} us late (warning at {b} us)",
     "周期唤醒延迟 {a} 微秒(警告阈值 {b} 微秒)",
     "The host has no real-time kernel, or the thread no real-time priority",
     "See `taktwerk run` messages about real time; the machine runs on",
     ResetRule::self_clearing,
     Reaction::none,
     {}},
    {id(MachineAlarm::positions_lost),
     "positions_lost",
     "The kept positions of the axes cannot be read: axes with absolute encoders are not homed",
     "无法读取保存的轴位置:带绝对值编码器的轴未回零",
     "Both files in the directory of `retain` are torn or altered, as by a failing disk",
     "Home the axes; check the disk",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
    {id(MachineAlarm::positions_not_kept),
     "positions_not_kept",
     "The positions of the axes cannot be written: after the next power-off they are not homed",
     "无法写入轴位置:下次断电后各轴将未回零",
     "The directory of `retain` cannot be written, or its disk is full",
     "Make room, or give `retain` a directory that the runtime may write",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
    {id(MachineAlarm::program_waits),
     "program_waits",
     "After the emergency stop the program waits: its axes get no power",
     "急停之后程序处于等待状态:其轴不通电",
     "An emergency stop was pressed while it ran, and a release alone switches nothing on",
     "When nobody is in danger: `taktwerk reset`, then `taktwerk start`, or the button of `emergency_stop.restart`",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
    {id(MachineAlarm::positions_outdated), "positions_outdated",
     "The disk still holds an older reference of an axis, and it cannot be taken back: the axes stop",
     "磁盘上仍保存着某轴的旧参考点且无法撤销:各轴停止",
     "An axis was homed or its position set while the directory of `retain` cannot be written: after a restart it would be homed wrongly",
     "Make the directory writable, or delete positions.0 and positions.1 in it; then reset", ResetRule::reset, Reaction::stop_machine,
     "The axes would be homed at the old reference after the next start"},
}};
static_assert(alarm_table_is_sound(machine_alarms));

}  // namespace taktwerk::runtime

#pragma once
// Every condition an axis announces: its words, how it goes away, and what the machine does about it. The one place that decides
// reactions of axes. The drive's own alarm texts come from its profile; `drive_fault` carries their number.

#include <array>
#include <string_view>

#include "core/alarm.hpp"

namespace taktwerk::axes {

enum class AxisAlarm : AlarmId {
    following_error = 0x3001,
    drive_fault = 0x3002,
    drive_power_lost = 0x3003,
    axis_feedback_lost = 0x3004,
    enable_timeout = 0x3005,
    software_limit_reached = 0x3006,
    negative_limit_switch = 0x3007,
    positive_limit_switch = 0x3008,
    homing_failed = 0x3009,
    homing_timeout = 0x300A,
    jog_lease_expired = 0x300B,
    drive_unknown_state = 0x300C,
    drive_mode_mismatch = 0x300D,
    drive_warning = 0x300E,
    emergency_stop = 0x300F,
    stopped_by_machine = 0x3010,
    planner_refused = 0x3011,
    master_lost = 0x3012,
    moved_while_off = 0x3013,
    retained_gearing_differs = 0x3014,
    drive_homing_failed = 0x3015,
    drive_homing_timeout = 0x3016,
    drive_homing_refused = 0x3017,
    reference_lost = 0x3018,
    drive_setup_refused = 0x3019,
    drive_too_fast = 0x301A,
    coupling_start_passed = 0x301B,
    both_limit_switches = 0x301C,
    motor_turns = 0x301D,
};
inline constexpr std::size_t axis_alarm_count = 29;

[[nodiscard]] constexpr AlarmId id(AxisAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

// clang-format off
inline constexpr std::array<AlarmInfo, axis_alarm_count> axis_alarms{{
    {id(AxisAlarm::following_error), "following_error",
     "Following error {a} u is beyond the window of {b} u", "跟随误差 {a} u 超出允许窗口 {b} u",
     "The axis is blocked or overloaded, the acceleration is too high for the drive, or the drive's loops are badly tuned",
     "Free the axis, check load and brake, lower acceleration and jerk or tune the drive; then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's own following error monitor (6065h) decides"},
    {id(AxisAlarm::drive_fault), "drive_fault",
     "The drive reports fault {a:x4}h (detail {b:x4}h)", "驱动器报告故障 {a:x4}h(详细代码 {b:x4}h)",
     "See the drive's alarm list for this number",
     "Remove the cause named by the drive's alarm text, then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive has stopped by its fault reaction (605Eh)"},
    {id(AxisAlarm::drive_power_lost), "drive_power_lost",
     "The drive left 'operation enabled' by itself (state {a})", "驱动器自行退出“运行使能”状态(状态 {a})",
     "Main power or the safety input (STO) went off, or somebody disabled the drive from its panel",
     "Restore main power and the safety circuit, then reset and enable again",
     ResetRule::reset, Reaction::stop_axis, "The drive has cut its power stage; the axis coasts or the brake holds"},
    {id(AxisAlarm::axis_feedback_lost), "axis_feedback_lost",
     "No fresh actual values for {a} cycles (limit {b})", "已有 {a} 个周期未收到新的实际值(上限 {b})",
     "The slave left the bus, frames are lost, or its working counter is wrong",
     "Check cable, supply and state of the slave; when it is back in operation, reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog and its reaction (605Ah, 6007h) stop it"},
    {id(AxisAlarm::enable_timeout), "enable_timeout",
     "The drive did not enable within {a} s (drive state {b})", "驱动器在 {a} 秒内未能使能(驱动器状态 {b})",
     "Main power is missing, the safety input (STO) is open, or the drive waits for something else",
     "Check main power, safety circuit and the drive's panel; then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive stays without power"},
    {id(AxisAlarm::software_limit_reached), "software_limit_reached",
     "Motion at velocity ends at the software limit {b} u (now at {a} u)", "速度运动将在软件限位 {b} u 处停止(当前位置 {a} u)",
     "A velocity command ran until the end of the permitted range",
     "Reset, then move away from the limit; end velocity motions earlier",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it; software limits are in the master only"},
    {id(AxisAlarm::negative_limit_switch), "negative_limit_switch",
     "The negative limit switch was reached at {a} u", "在 {a} u 处触发负向限位开关",
     "The axis moved past its permitted range, or the switch or its wiring is defective",
     "Reset, then move in positive direction; check homing and software limits",
     ResetRule::reset, Reaction::stop_axis, "The drive's own limit switch function stops it where it is wired to the drive"},
    {id(AxisAlarm::positive_limit_switch), "positive_limit_switch",
     "The positive limit switch was reached at {a} u", "在 {a} u 处触发正向限位开关",
     "The axis moved past its permitted range, or the switch or its wiring is defective",
     "Reset, then move in negative direction; check homing and software limits",
     ResetRule::reset, Reaction::stop_axis, "The drive's own limit switch function stops it where it is wired to the drive"},
    {id(AxisAlarm::homing_failed), "homing_failed",
     "Homing failed at step {a} (drive error {b:x4}h)", "回零失败,步骤 {a}(驱动器错误 {b:x4}h)",
     "The home switch was not found between the limits, or the drive refused its homing method",
     "Check switches, homing method and direction; then reset and home again",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::homing_timeout), "homing_timeout",
     "Homing took longer than {a} s", "回零时间超过 {a} 秒",
     "The switch is farther away than expected, or the homing velocity or the timeout is too low",
     "Check switch and velocities or raise homing.timeout; then reset and home again",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::jog_lease_expired), "jog_lease_expired",
     "Jogging stopped: no renewal for {a} s", "点动已停止:{a} 秒内未收到续期",
     "The client that jogs has gone, hangs, or its connection is too slow",
     "Jog again; if it repeats, check the connection or raise jog_lease",
     ResetRule::acknowledge, Reaction::warn, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::drive_unknown_state), "drive_unknown_state",
     "The status word {a:x4}h fits no power state", "状态字 {a:x4}h 不对应任何功率状态",
     "The drive profile does not match the drive, or the process data are mapped wrongly",
     "Check profile, mapping and firmware; then reset",
     ResetRule::reset, Reaction::power_off, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::drive_mode_mismatch), "drive_mode_mismatch",
     "The drive is in mode {a} instead of {b}", "驱动器处于模式 {a},而不是 {b}",
     "Mode of operation was changed at the drive, by a parameter or by another master",
     "Check start-up list and panel settings; then reset",
     ResetRule::reset, Reaction::power_off, "The drive goes on in its own mode until its communication watchdog stops it"},
    {id(AxisAlarm::drive_warning), "drive_warning",
     "The drive warns: {a:x4}h", "驱动器警告:{a:x4}h",
     "See the drive's alarm list for this number",
     "Follow the drive's alarm text before the warning becomes a fault",
     ResetRule::self_clearing, Reaction::warn, ""},
    {id(AxisAlarm::emergency_stop), "emergency_stop",
     "Stopped by the emergency stop input", "由急停输入停止",
     "The emergency stop was pressed or its circuit is open",
     "Remove the danger, release the emergency stop, then reset",
     ResetRule::reset, Reaction::stop_axis, "The safety circuit in hardware cuts the power"},
    {id(AxisAlarm::stopped_by_machine), "stopped_by_machine",
     "Stopped because of another part of the machine (alarm {a:x4}h)", "因机器其他部分而停止(报警 {a:x4}h)",
     "The alarm named stops the whole machine",
     "Remove the cause of that alarm, then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::planner_refused), "planner_refused",
     "No motion could be planned from {a} u at {b} u/s", "无法从 {a} u、速度 {b} u/s 处规划运动",
     "A number in limits or command is beyond what can be calculated with",
     "Check the limits of the axis; report this, it should not happen",
     ResetRule::reset, Reaction::power_off, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::master_lost), "master_lost",
     "The master (axis {a}) has no valid position any more", "主轴(轴 {a})不再有有效位置",
     "The master's drive or encoder left the bus, or its position jumped: it was homed, or moves faster than its velocity limit",
     "Check the master's drive and bus; reset, then couple again",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::moved_while_off), "moved_while_off",
     "The axis moved {a} u without power (permitted {b} u): it is not homed", "断电期间轴移动了 {a} u(允许 {b} u):轴未回零",
     "It was pushed or sank, motor or encoder were changed, or the encoder lost its turns",
     "Home the axis; when such a way is normal, raise position_memory.moved_while_off",
     ResetRule::acknowledge, Reaction::warn, ""},
    {id(AxisAlarm::retained_gearing_differs), "retained_gearing_differs",
     "The retained position belongs to another gearing: the axis is not homed", "保存的位置属于另一套传动比:轴未回零",
     "The gearing of the axis was changed in the machine file since it was homed last",
     "Home the axis",
     ResetRule::acknowledge, Reaction::warn, ""},
    {id(AxisAlarm::drive_homing_failed), "drive_homing_failed",
     "The drive ended its homing method {a} with an error (drive code {b:x4}h)", "驱动器回零方式 {a} 出错结束(驱动器代码 {b:x4}h)",
     "It met a limit switch before its home switch, does not know the method, or one of its homing speeds is zero",
     "Check that the search starts towards the switch, the wiring and polarity of the switches at the drive, and homing.method; then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::drive_homing_timeout), "drive_homing_timeout",
     "The drive did not end its homing method {a} within {b} s", "驱动器回零方式 {a} 在 {b} 秒内未完成",
     "Switch or index pulse do not come, the homing speeds are too low, or the drive never took the start",
     "Watch the drive's inputs while it searches; raise homing.search_velocity or homing.timeout; then reset and home again",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::drive_homing_refused), "drive_homing_refused",
     "The drive did not take homing method {a} or its speeds: homing was not started", "驱动器不接受回零方式 {a} 或其速度:未启动回零",
     "It refused 6098h, 6099h or 609Ah by SDO, or reads them back otherwise",
     "Choose a method that the drive's manual lists, and speeds within its range; then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::reference_lost), "reference_lost",
     "The drive lost its reference (drive code {a:x4}h): the axis is not homed", "驱动器丢失参考点(驱动器代码 {a:x4}h):轴未回零",
     "Its encoder lost or exceeded its turns, its battery was empty, or the turns were cleared on request",
     "Remove the cause named by the drive's alarm text; home the axis",
     ResetRule::acknowledge, Reaction::warn, ""},
    {id(AxisAlarm::drive_setup_refused), "drive_setup_refused",
     "The drive is not enabled: its own parameters do not fit this machine", "驱动器未使能:其自身参数与本机配置不符",
     "A parameter of the drive that decides how it takes commands has another value than this machine needs",
     "The log names the parameter, its value and what to set; set it, restart the drive where it says so, then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive stays without power"},
    {id(AxisAlarm::drive_too_fast), "drive_too_fast",
     "In a motion of the drive's own the axis ran at {a} u/s; its limit is {b} u/s", "驱动器自行运动时，轴速度达到 {a} u/s，超过限值 {b} u/s",
     "The drive does not keep the speed it was given: its speed limit (607Fh) is not set or not used, its homing speeds (6099h) are others than the machine's, or its loop overshoots",
     "Check 607Fh, 6099h and the drive's own speed limit, tune its loop, or lower the speed; then reset",
     ResetRule::reset, Reaction::stop_axis, "The drive's communication watchdog stops it"},
    {id(AxisAlarm::coupling_start_passed), "coupling_start_passed",
     "The coupling waits: its master stands at {b} u, past the start at {a} u", "耦合在等待：主轴位于 {b} u，已越过起点 {a} u",
     "A slave with MasterStartDistance begins when its master crosses the start in the sense of that distance; on a linear axis the master has to come back first",
     "Give the command before the master is there, bring the master back, or end the coupling (MC_GearOut, MC_CamOut, MC_Halt)",
     ResetRule::self_clearing, Reaction::warn, ""},
    {id(AxisAlarm::both_limit_switches), "both_limit_switches",
     "Both limit switches are on at once: the axis cannot move either way", "两个限位开关同时处于触发状态：轴无法向任何方向运动",
     "An axis is never at both its ends: the polarity of the inputs is inverted (contacts that open, configured as contacts that close), the switches have no supply, or their cable is off",
     "Check supply and cable of the switches, then the polarity of the limit inputs in the drive's own parameters",
     ResetRule::self_clearing, Reaction::warn, ""},
    {id(AxisAlarm::motor_turns), "motor_turns",
     "Power was not switched on: the motor turns by itself, at {a} u/s", "未接通动力：电机自行转动，速度 {a} u/s",
     "It still coasts, or a load, a master or a hand turns it, faster than a tenth of the axis' velocity ({b} u/s): power would hold it with a jolt",
     "Let it come to rest, or hold its load (brake, counterweight); then reset and enable again",
     ResetRule::reset, Reaction::stop_axis, "The drive stays without power"},
}};
// clang-format on

namespace alarm_check {
consteval bool sound() {
    AlarmId last = 0;
    for (const auto& alarm : axis_alarms) {
        if (alarm.id <= last || alarm.id < 0x3000 || alarm.id > 0x3FFF) return false;  // rising: no id twice
        if (alarm.name.empty() || alarm.english.empty() || alarm.chinese.empty() || alarm.cause.empty() || alarm.remedy.empty())
            return false;
        if (alarm.reaction >= Reaction::stop_axis && (alarm.reset != ResetRule::reset || alarm.master_gone.empty())) return false;
        last = alarm.id;
    }
    return true;
}
static_assert(sound());
}  // namespace alarm_check

[[nodiscard]] constexpr Reaction reaction(AxisAlarm alarm) noexcept {
    const auto* info = find_alarm(axis_alarms, id(alarm));
    return info ? info->reaction : Reaction::power_off;
}

}  // namespace taktwerk::axes

#pragma once
// The words of every ErrorId: what a block's ErrorID means and what to do. Axis errors (0x3xxx) are in alarms.hpp.

#include <array>
#include <string_view>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

struct ErrorText {
    ErrorId id;
    std::string_view name;  ///< stable, as the enumerator is spelled
    std::string_view english, chinese, remedy;
};

// clang-format off
inline constexpr std::array<ErrorText, error_id_count> error_texts{{
    {ErrorId::none, "none", "No error", "无错误", "Nothing to do"},
    {ErrorId::invalid_axis, "invalid_axis", "The axis reference names no axis", "轴引用无效", "Connect the Axis pin to an axis of the machine"},
    {ErrorId::not_powered, "not_powered", "The axis is disabled", "轴未使能", "Enable it with MC_Power and wait for Status"},
    {ErrorId::in_error_stop, "in_error_stop", "The axis is in ErrorStop", "轴处于 ErrorStop 状态",
     "Read the axis error, remove its cause, then MC_Reset"},
    {ErrorId::state_forbids, "state_forbids", "The command is not allowed in the present state of the axis", "轴的当前状态不允许该命令",
     "Wait until the axis stands (MC_ReadStatus); while stopping or homing only MC_Stop is taken"},
    {ErrorId::invalid_velocity, "invalid_velocity", "The velocity is zero, negative or not a number", "速度为零、为负或不是有效数字",
     "Give a velocity above zero; direction comes from position or distance"},
    {ErrorId::invalid_dynamics, "invalid_dynamics", "Acceleration, deceleration or jerk is negative or not a number",
     "加速度、减速度或加加速度为负或不是有效数字", "Give values above zero, or 0 for the default of the axis"},
    {ErrorId::invalid_position, "invalid_position", "The position or distance is not a finite number", "位置或距离不是有限数字",
     "Check the calculation that gives the position"},
    {ErrorId::beyond_software_limit, "beyond_software_limit", "The target is beyond a software limit", "目标位置超出软件限位",
     "Give a target inside the limits of the axis, or correct the limits"},
    {ErrorId::queue_full, "queue_full", "No room for another buffered command", "缓冲命令队列已满",
     "Wait until a buffered command has become active, or raise queue_depth"},
    {ErrorId::owned_by_other, "owned_by_other", "Another party has control of the axis", "轴的控制权属于另一方",
     "Take control first (machine mode), or wait until it is released"},
    {ErrorId::not_supported, "not_supported", "The drive or this version cannot do this", "驱动器或当前版本不支持该功能",
     "Use another command, or another drive"},
    {ErrorId::not_homed, "not_homed", "An absolute move needs a homed axis", "绝对定位要求轴已回零", "Home the axis (MC_Home), or set require_homed: false"},
    {ErrorId::buffer_mode_not_supported, "buffer_mode_not_supported", "This buffer mode is not available here", "此处不支持该缓冲模式",
     "Use mcAborting or mcBuffered"},
    {ErrorId::invalid_direction, "invalid_direction", "The direction does not fit this command", "方向不适用于该命令",
     "Use mcPositiveDirection, mcNegativeDirection or mcCurrentDirection"},
    {ErrorId::mode_forbids, "mode_forbids", "The mode of the machine does not allow it", "机器的当前模式不允许", "Change the mode of the machine"},
    {ErrorId::drive_not_ready, "drive_not_ready", "The drive is not reachable or not ready", "驱动器不可达或未就绪",
     "Check bus, main power and the drive's panel"},
    {ErrorId::reset_failed, "reset_failed", "The error could not be reset", "错误无法复位", "Its cause is still there: see the alarms of the axis"},
    {ErrorId::homing_failed, "homing_failed", "Homing failed", "回零失败", "Check switches and the homing settings"},
    {ErrorId::interlocked, "interlocked", "Emergency stop, a limit switch or MC_Power forbids motion in this direction",
     "急停、限位开关或 MC_Power 禁止该方向的运动", "Release the emergency stop, or move in the other direction"},
    {ErrorId::aborted_by_axis_error, "aborted_by_axis_error", "The command ended because of an error of the axis", "命令因轴错误而终止",
     "Read the axis error, remove its cause, then MC_Reset"},
    {ErrorId::power_conflict, "power_conflict", "A second MC_Power acts on the same axis", "同一轴上存在第二个 MC_Power", "Keep one MC_Power per axis"},
    {ErrorId::invalid_parameter, "invalid_parameter", "A parameter is outside its range", "参数超出范围", "Check the inputs of the block"},
    {ErrorId::invalid_device, "invalid_device", "The device reference names no device of the bus", "设备引用无效",
     "Connect the Device pin to a device that the program declared; a machine without a bus has none"},
    {ErrorId::object_refused, "object_refused", "The device refused the access to its object", "设备拒绝访问该对象",
     "Read AbortCode: it says why; check index, sub-index and size against the device's manual"},
    {ErrorId::object_no_answer, "object_no_answer", "The device did not answer the access to its object", "设备未应答对象访问",
     "Check that the device is on the bus and not switched off; then try again"},
    {ErrorId::object_too_long, "object_too_long", "The object is longer than the block can hold", "对象长度超出功能块容量",
     "Read it with an ObjectFuture, or from the command line"},
    {ErrorId::object_requests_full, "object_requests_full", "Too many object requests of this program are under way",
     "该程序的对象请求过多", "Wait until others are answered, or ask one after the other"},
    {ErrorId::unknown_parameter, "unknown_parameter", "The axis has no parameter of this number", "该轴没有此编号的参数",
     "Give a number of the parameter list (1 to 17, 1000 and above)"},
    {ErrorId::read_only_parameter, "read_only_parameter", "The parameter cannot be written", "该参数为只读", "Change it in the machine file"},
    {ErrorId::invalid_output, "invalid_output", "There is no such digital input or output", "数字输入或输出不存在",
     "Connect the reference to a declared point or axis and give a number that it has"},
    {ErrorId::invalid_override, "invalid_override", "An override factor is outside its range", "倍率超出范围",
     "VelFactor 0 to 1; AccFactor and JerkFactor above 0, up to 1"},
    {ErrorId::invalid_master, "invalid_master", "The master axis cannot be used", "主轴无效",
     "Give another axis than the slave, one that exists and reports a position"},
    {ErrorId::coupling_loop, "coupling_loop", "The master depends on this axis", "主轴依赖于本轴(耦合成环)", "Take one coupling of the ring away"},
    {ErrorId::invalid_ratio, "invalid_ratio", "The denominator of a gear ratio is zero", "齿轮比分母为零", "Give a denominator that is not zero"},
    {ErrorId::not_coupled, "not_coupled", "The axis is not coupled to a master", "该轴未与主轴耦合", "Couple it first (MC_GearIn, MC_CamIn)"},
    {ErrorId::sync_impossible, "sync_impossible", "The sync point cannot be reached", "无法到达同步点",
     "Command earlier, give a longer MasterStartDistance, or more velocity and acceleration"},
    {ErrorId::master_lost, "master_lost", "The master has no valid position any more", "主轴位置不再有效",
     "Check the master's drive and bus; reset, then couple again"},
    {ErrorId::invalid_table, "invalid_table", "The table does not exist or cannot be used", "表不存在或无法使用",
     "Master or time values must rise strictly, all numbers be finite, and there must be two points or more"},
    {ErrorId::no_table_room, "no_table_room", "No room for another prepared cam table", "没有空间存放新的凸轮表",
     "Select fewer tables at a time; a table that no slave uses is given back by selecting it again"},
    {ErrorId::no_such_probe, "no_such_probe", "The drive has no such probe", "驱动器没有该探针", "Use another trigger, or a program input"},
    {ErrorId::probe_busy, "probe_busy", "Another block has armed this probe", "该探针已被其他功能块占用", "Wait for it, or use MC_AbortTrigger"},
    {ErrorId::probe_idle, "probe_idle", "No probe is armed on this trigger", "该触发器没有已激活的探针", "Nothing to do"},
    {ErrorId::homing_limit_time, "homing_limit_time", "The step of homing did not end in TimeLimit", "回零步骤超过时间限制",
     "Check the signal searched for and its wiring, or raise TimeLimit"},
    {ErrorId::homing_limit_distance, "homing_limit_distance", "The step of homing did not end within DistanceLimit", "回零步骤超过距离限制",
     "Check the signal searched for and its wiring, or raise DistanceLimit"},
    {ErrorId::homing_limit_torque, "homing_limit_torque", "TorqueLimit was reached during homing", "回零过程中达到转矩限制",
     "The axis is blocked, or TorqueLimit is too low"},
    {ErrorId::drive_mode_refused, "drive_mode_refused", "The drive did not take the mode in time", "驱动器未在规定时间内切换模式",
     "Check that the drive has this mode and that 6060h is mapped"},
    {ErrorId::not_at_standstill, "not_at_standstill", "The drive changes its mode at standstill only", "驱动器仅允许在静止时切换模式",
     "Stop the axis first (MC_Halt)"},
    {ErrorId::update_not_possible, "update_not_possible", "ContinuousUpdate gave values that the running command cannot take",
     "ContinuousUpdate 的新值无法用于当前命令", "Check the inputs; the command goes on with the last good values"},
    {ErrorId::aborted_by_command, "aborted_by_command", "Another command, or power off, ended this one before it was done",
     "该命令在完成前被其他命令或断电终止", "Give it again when the axis is free"},
    {ErrorId::setpoint_missing, "setpoint_missing", "No set-point came from outside while the axis moved", "轴运动时未收到外部设定值",
     "Feed a set-point in each cycle until the axis stands, or raise feed_patience"},
}};
// clang-format on

namespace error_check {
/// Entry i belongs to id i, and nothing is left empty.
consteval bool sound() {
    for (std::size_t i = 0; i < error_texts.size(); ++i) {
        const auto& text = error_texts[i];
        if (static_cast<std::size_t>(text.id) != i) return false;
        if (text.name.empty() || text.english.empty() || text.chinese.empty() || text.remedy.empty()) return false;
    }
    return true;
}
static_assert(sound());
}  // namespace error_check

/// nullptr for axis errors (see alarms.hpp) and unknown numbers.
[[nodiscard]] constexpr const ErrorText* find_error(ErrorId id) noexcept {
    const auto i = static_cast<std::size_t>(id);
    return i < error_texts.size() ? &error_texts[i] : nullptr;
}

}  // namespace taktwerk::axes

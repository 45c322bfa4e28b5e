#pragma once
// The words of every ErrorId: what a block's ErrorID means and what to do. Axis errors (0x3xxx) are in alarms.hpp.

#include <array>
#include <string_view>

#include "axes/axis/types.hpp"

namespace taktwerk::axes {

struct ErrorText {
    ErrorId id;
    std::string_view name;  ///< stable, as the enumerator is spelled
    std::string_view english, chinese, remedy;
};

// clang-format off
inline constexpr std::array<ErrorText, 28> error_texts{{
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
    return error_texts.size() == static_cast<std::size_t>(ErrorId::object_requests_full) + 1;
}
static_assert(sound());
}  // namespace error_check

/// nullptr for axis errors (see alarms.hpp) and unknown numbers.
[[nodiscard]] constexpr const ErrorText* find_error(ErrorId id) noexcept {
    const auto i = static_cast<std::size_t>(id);
    return i < error_texts.size() ? &error_texts[i] : nullptr;
}

}  // namespace taktwerk::axes

#include "axes/sim/object_table.hpp"

namespace taktwerk::axes::sim {

namespace {

using In = AxisInputs;
using Out = AxisOutputs;
using Value = std::int64_t;

constexpr InputObject commands[] = {
    {0x6040, 0, [](In& in, Value v) { in.control = static_cast<std::uint16_t>(v); }},
    {0x6060, 0, [](In& in, Value v) { in.mode = v; }},
    {0x607A, 0, [](In& in, Value v) { in.target_position = v; }},
    {0x60FF, 0, [](In& in, Value v) { in.target_velocity = v; }},
    {0x6071, 0, [](In& in, Value v) { in.target_torque = v; }},
    {0x60B1, 0, [](In& in, Value v) { in.velocity_offset = v; }},
    {0x60B2, 0, [](In& in, Value v) { in.torque_offset = v; }},
    {0x607F, 0, [](In& in, Value v) { in.maximum_velocity = v == 0 ? zero_speed_limit : v; }},
    {0x60B8, 0, [](In& in, Value v) { in.probe_function = static_cast<std::uint16_t>(v); }},
};

constexpr InputObject settings[] = {
    {0x6072, 0, [](In& in, Value v) { in.torque_limit = v; }},
    {0x60E0, 0, [](In& in, Value v) { in.torque_limit_positive = v; }},
    {0x60E1, 0, [](In& in, Value v) { in.torque_limit_negative = v; }},
    {0x6098, 0, [](In& in, Value v) { in.homing.method = v; }},
    {0x6099, 1, [](In& in, Value v) { in.homing.fast = static_cast<double>(v); }},
    {0x6099, 2, [](In& in, Value v) { in.homing.slow = static_cast<double>(v); }},
    {0x609A, 0, [](In& in, Value v) { in.homing.acceleration = static_cast<double>(v); }},
    {0x607C, 0, [](In& in, Value v) { in.home_offset = v; }},
    {0x60E6, 0, [](In& in, Value v) { in.home_position_method = v; }},
    {0x6080, 0, [](In& in, Value v) { in.maximum_motor_speed = v; }},
    {0x6081, 0, [](In& in, Value v) { in.profile_velocity = v; }},
    {0x6083, 0, [](In& in, Value v) { in.profile_acceleration = v; }},
    {0x6084, 0, [](In& in, Value v) { in.profile_deceleration = v; }},
    {0x6085, 0, [](In& in, Value v) { in.quick_stop_deceleration = v; }},
    {0x6087, 0, [](In& in, Value v) { in.torque_slope = v; }},
    {0x6067, 0, [](In& in, Value v) { in.position_window = v; }},
    {0x6068, 0, [](In& in, Value v) { in.position_window_time = v; }},
    {0x606D, 0, [](In& in, Value v) { in.velocity_window = v; }},
    {0x606E, 0, [](In& in, Value v) { in.velocity_window_time = v; }},
    {0x6065, 0, [](In& in, Value v) { in.following_error_window = v; }},
    {0x607D, 1, [](In& in, Value v) { in.software_minimum = v; }},
    {0x607D, 2, [](In& in, Value v) { in.software_maximum = v; }},
};

constexpr OutputObject answers[] = {
    {0x6041, 0, [](const Out& out) -> Value { return out.status; }},
    {0x6061, 0, [](const Out& out) -> Value { return out.mode; }},
    {0x6064, 0, [](const Out& out) -> Value { return out.position; }},
    {0x606C, 0, [](const Out& out) -> Value { return out.velocity; }},
    {0x6077, 0, [](const Out& out) -> Value { return out.torque; }},
    {0x60F4, 0, [](const Out& out) -> Value { return out.following_error; }},
    {0x6062, 0, [](const Out& out) -> Value { return out.demand; }},
    {0x603F, 0, [](const Out& out) -> Value { return out.error_code; }},
    {0x60FD, 0, [](const Out& out) -> Value { return out.digital_inputs; }},
    {0x60B9, 0, [](const Out& out) -> Value { return out.probe_status; }},
    {0x60BA, 0, [](const Out& out) -> Value { return out.probe_rising[0]; }},
    {0x60BB, 0, [](const Out& out) -> Value { return out.probe_falling[0]; }},
    {0x60BC, 0, [](const Out& out) -> Value { return out.probe_rising[1]; }},
    {0x60BD, 0, [](const Out& out) -> Value { return out.probe_falling[1]; }},
};

}  // namespace

std::span<const InputObject> command_objects() noexcept { return commands; }
std::span<const InputObject> setting_objects() noexcept { return settings; }
std::span<const OutputObject> answer_objects() noexcept { return answers; }

}  // namespace taktwerk::axes::sim

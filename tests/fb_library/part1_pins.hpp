#pragma once
// The pins of the PLCopen blocks that exist, transcribed from the tables of "Function blocks for motion control", Part 1 v2.0 (2011),
// sections 3.1 to 3.31: names, order, direction, type, and B (basic: mandatory) or E (extended). Never taken from our own pin tables.

#include <array>
#include <string_view>

namespace taktwerk::fb::part1 {

enum Kind : char { VAR_IN_OUT, VAR_INPUT, VAR_OUTPUT };

struct StandardPin {
    std::string_view block, name;
    Kind kind;
    std::string_view type;
    char obligation;
};

// clang-format off
inline constexpr std::array pins{
    // 3.1
    StandardPin{"MC_Power", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_Power", "Enable", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_Power", "EnablePositive", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_Power", "EnableNegative", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_Power", "Status", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Power", "Valid", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Power", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Power", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.2
    StandardPin{"MC_Home", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_Home", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_Home", "Position", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_Home", "BufferMode", VAR_INPUT, "MC_BUFFER_MODE", 'E'},  // table: MC_BufferMode; diagram as here
    StandardPin{"MC_Home", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Home", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Home", "Active", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Home", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Home", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Home", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.3
    StandardPin{"MC_Stop", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_Stop", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_Stop", "Deceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_Stop", "Jerk", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_Stop", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Stop", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Stop", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Stop", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Stop", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.4
    StandardPin{"MC_Halt", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_Halt", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_Halt", "Deceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_Halt", "Jerk", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_Halt", "BufferMode", VAR_INPUT, "MC_BUFFER_MODE", 'E'},
    StandardPin{"MC_Halt", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Halt", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Halt", "Active", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Halt", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Halt", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Halt", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.5
    StandardPin{"MC_MoveAbsolute", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_MoveAbsolute", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveAbsolute", "ContinuousUpdate", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Position", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_MoveAbsolute", "Velocity", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_MoveAbsolute", "Acceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Deceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Jerk", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Direction", VAR_INPUT, "MC_DIRECTION", 'B'},
    StandardPin{"MC_MoveAbsolute", "BufferMode", VAR_INPUT, "MC_BUFFER_MODE", 'E'},
    StandardPin{"MC_MoveAbsolute", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveAbsolute", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Active", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveAbsolute", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveAbsolute", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveAbsolute", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.6
    StandardPin{"MC_MoveRelative", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_MoveRelative", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveRelative", "ContinuousUpdate", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveRelative", "Distance", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_MoveRelative", "Velocity", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveRelative", "Acceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveRelative", "Deceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveRelative", "Jerk", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveRelative", "BufferMode", VAR_INPUT, "MC_BUFFER_MODE", 'E'},
    StandardPin{"MC_MoveRelative", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveRelative", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveRelative", "Active", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveRelative", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveRelative", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveRelative", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.10
    StandardPin{"MC_MoveVelocity", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_MoveVelocity", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveVelocity", "ContinuousUpdate", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveVelocity", "Velocity", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_MoveVelocity", "Acceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveVelocity", "Deceleration", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveVelocity", "Jerk", VAR_INPUT, "REAL", 'E'},
    StandardPin{"MC_MoveVelocity", "Direction", VAR_INPUT, "MC_DIRECTION", 'E'},
    StandardPin{"MC_MoveVelocity", "BufferMode", VAR_INPUT, "MC_BUFFER_MODE", 'E'},
    StandardPin{"MC_MoveVelocity", "InVelocity", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveVelocity", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveVelocity", "Active", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveVelocity", "CommandAborted", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_MoveVelocity", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_MoveVelocity", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.17
    StandardPin{"MC_SetPosition", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_SetPosition", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_SetPosition", "Position", VAR_INPUT, "REAL", 'B'},
    StandardPin{"MC_SetPosition", "Relative", VAR_INPUT, "BOOL", 'E'},
    StandardPin{"MC_SetPosition", "ExecutionMode", VAR_INPUT, "MC_EXECUTION_MODE", 'E'},
    StandardPin{"MC_SetPosition", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_SetPosition", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_SetPosition", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_SetPosition", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.24
    StandardPin{"MC_ReadActualPosition", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_ReadActualPosition", "Enable", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadActualPosition", "Valid", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadActualPosition", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadActualPosition", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadActualPosition", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    StandardPin{"MC_ReadActualPosition", "Position", VAR_OUTPUT, "REAL", 'B'},
    // 3.27
    StandardPin{"MC_ReadStatus", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_ReadStatus", "Enable", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "Valid", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadStatus", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
    StandardPin{"MC_ReadStatus", "ErrorStop", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "Disabled", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "Stopping", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "Homing", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadStatus", "Standstill", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadStatus", "DiscreteMotion", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadStatus", "ContinuousMotion", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadStatus", "SynchronizedMotion", VAR_OUTPUT, "BOOL", 'E'},
    // 3.30
    StandardPin{"MC_ReadAxisError", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_ReadAxisError", "Enable", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadAxisError", "Valid", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadAxisError", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_ReadAxisError", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_ReadAxisError", "ErrorID", VAR_OUTPUT, "WORD", 'B'},
    StandardPin{"MC_ReadAxisError", "AxisErrorID", VAR_OUTPUT, "WORD", 'E'},
    // 3.31
    StandardPin{"MC_Reset", "Axis", VAR_IN_OUT, "AXIS_REF", 'B'},
    StandardPin{"MC_Reset", "Execute", VAR_INPUT, "BOOL", 'B'},
    StandardPin{"MC_Reset", "Done", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Reset", "Busy", VAR_OUTPUT, "BOOL", 'E'},
    StandardPin{"MC_Reset", "Error", VAR_OUTPUT, "BOOL", 'B'},
    StandardPin{"MC_Reset", "ErrorID", VAR_OUTPUT, "WORD", 'E'},
};
// clang-format on

}  // namespace taktwerk::fb::part1

#pragma once
// Every block there is: the one list that monitor, documentation, typed tests and compiler iterate. A new block is added here.

#include <array>

#include "fb_library/block_type.hpp"
#include "fb_library/fieldbus/sdo.hpp"
#include "fb_library/groups/group_administration.hpp"
#include "fb_library/groups/group_arm_blocks.hpp"
#include "fb_library/groups/group_bodies.hpp"
#include "fb_library/groups/group_frames.hpp"
#include "fb_library/groups/group_homing_block.hpp"
#include "fb_library/groups/group_jogging.hpp"
#include "fb_library/groups/group_limits.hpp"
#include "fb_library/groups/group_moves.hpp"
#include "fb_library/groups/group_parameters.hpp"
#include "fb_library/groups/group_paths.hpp"
#include "fb_library/groups/group_refusal_block.hpp"
#include "fb_library/groups/group_state_blocks.hpp"
#include "fb_library/groups/group_stops.hpp"
#include "fb_library/groups/group_sync_blocks.hpp"
#include "fb_library/groups/group_tools.hpp"
#include "fb_library/groups/group_tracking_blocks.hpp"
#include "fb_library/groups/group_values.hpp"
#include "fb_library/iec/bistables.hpp"
#include "fb_library/iec/counters.hpp"
#include "fb_library/iec/edges.hpp"
#include "fb_library/iec/timers.hpp"
#include "fb_library/motion/administration.hpp"
#include "fb_library/motion/axis_condition.hpp"
#include "fb_library/motion/axis_values.hpp"
#include "fb_library/motion/brake.hpp"
#include "fb_library/motion/camming.hpp"
#include "fb_library/motion/combine_axes.hpp"
#include "fb_library/motion/controller_mode.hpp"
#include "fb_library/motion/digital_cam_switch.hpp"
#include "fb_library/motion/digital_io.hpp"
#include "fb_library/motion/drive_profiles.hpp"
#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/external_setpoints.hpp"
#include "fb_library/motion/gearing.hpp"
#include "fb_library/motion/home.hpp"
#include "fb_library/motion/homing_ends.hpp"
#include "fb_library/motion/homing_passive.hpp"
#include "fb_library/motion/homing_steps.hpp"
#include "fb_library/motion/jog.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/override.hpp"
#include "fb_library/motion/parameter_blocks.hpp"
#include "fb_library/motion/phasing.hpp"
#include "fb_library/motion/power.hpp"
#include "fb_library/motion/probes.hpp"
#include "fb_library/motion/reading.hpp"
#include "fb_library/motion/stops.hpp"
#include "fb_library/motion/superimposed.hpp"
#include "fb_library/motion/time_profiles.hpp"
#include "fb_library/motion/torque_control.hpp"
#include "fb_library/motion/torque_limit.hpp"

namespace taktwerk::fb {

template <class... Blocks>
struct BlockList {
    /// E.g. `IecBlocks::as<testing::Types>` for a typed test.
    template <template <class...> class Other>
    using as = Other<Blocks...>;
};

namespace detail {
template <class... A, class... B>
BlockList<A..., B...> joined(BlockList<A...>, BlockList<B...>);
}  // namespace detail

using IecBlocks = BlockList<SR, RS, R_TRIG, F_TRIG, CTU, CTU_DINT, CTU_LINT, CTU_UDINT, CTU_ULINT, CTD, CTD_DINT, CTD_LINT, CTD_UDINT,
                            CTD_ULINT, CTUD, CTUD_DINT, CTUD_LINT, CTUD_UDINT, CTUD_ULINT, TP, TON, TOF>;

/// Part 1, sections 3.1 to 3.18.
using AxisBlocks = BlockList<MC_Power, MC_Home, MC_Stop, MC_Halt, MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, MC_MoveSuperimposed,
                             MC_HaltSuperimposed, MC_MoveVelocity, MC_MoveContinuousAbsolute, MC_MoveContinuousRelative, MC_TorqueControl,
                             MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile, MC_SetPosition, MC_SetOverride>;
/// 3.19 to 3.34.
using AdministrativeBlocks =
    BlockList<MC_ReadParameter, MC_ReadBoolParameter, MC_WriteParameter, MC_WriteBoolParameter, MC_ReadDigitalInput, MC_ReadDigitalOutput,
              MC_WriteDigitalOutput, MC_ReadActualPosition, MC_ReadActualVelocity, MC_ReadActualTorque, MC_ReadStatus, MC_ReadMotionState,
              MC_ReadAxisInfo, MC_ReadAxisError, MC_Reset, MC_DigitalCamSwitch, MC_TouchProbe, MC_AbortTrigger>;
/// 4.2 to 4.10.
using CouplingBlocks = BlockList<MC_CamTableSelect, MC_CamIn, MC_CamOut, MC_GearIn, MC_GearOut, MC_GearInPos, MC_PhasingAbsolute,
                                 MC_PhasingRelative, MC_CombineAxes>;
/// Of vendors, under their names.
using VendorBlocks = BlockList<MC_Jog, MC_MoveModulo, MC_HaltPhasing, MC_ReadCommandPosition, MC_ReadCommandVelocity,
                               MC_ReadCommandAcceleration, MC_SetControllerMode, MC_SetTorqueLimit, MC_SetBrake, MC_ExtSetPointGenEnable,
                               MC_ExtSetPointGenFeed, MC_ExtSetPointGenDisable>;
/// Profiles that the drive makes by itself.
using DriveBlocks = BlockList<Drive_MoveAbsolute, Drive_MoveRelative, Drive_MoveVelocity, Drive_Torque>;

/// PLCopen Part 5: homing step by step.
using HomingBlocks =
    BlockList<MC_StepAbsoluteSwitch, MC_StepLimitSwitch, MC_StepBlock, MC_StepReferencePulse, MC_StepDistanceCoded, MC_HomeDirect,
              MC_HomeAbsolute, MC_FinishHoming, MC_StepReferenceFlyingSwitch, MC_StepReferenceFlyingRefPulse, MC_AbortPassiveHoming>;

/// PLCopen Part 4: axes that move together. Those of the standard that are not there: fb_library/groups/part4.hpp.
using GroupBlocks =
    BlockList<MC_AddAxisToGroup, MC_RemoveAxisFromGroup, MC_UngroupAllAxes, MC_GroupReadConfiguration, MC_ReadAxisGroupInfo, MC_GroupEnable,
              MC_GroupDisable, MC_GroupPower, MC_GroupReadPosition, MC_GroupReadActualPosition, MC_GroupReadVelocity,
              MC_GroupReadActualVelocity, MC_GroupReadAcceleration, MC_GroupReadMotionState, MC_GroupReadCommandInfo,
              MC_GroupWriteDefaultDynamics, MC_GroupReadDefaultDynamics, MC_GroupStop, MC_GroupHalt, MC_GroupInterrupt, MC_GroupContinue,
              MC_GroupReadStatus, MC_GroupReadError, MC_GroupReset, MC_GroupReadSWLimits, MC_MoveLinearAbsolute, MC_MoveLinearRelative,
              MC_MoveCircularAbsolute, MC_MoveCircularRelative, MC_MoveDirectAbsolute, MC_MoveDirectRelative, MC_GroupWaitTime,
              MC_GroupSetOverride, MC_SetCartesianTransform, MC_SetCoordinateTransform, MC_ReadCartesianTransform,
              MC_ReadCoordinateTransform, MC_ReadKinTransform, MC_ReadDHParameters, MC_ReadJointInfo, MC_GroupTransformPosition,
              MC_GroupSetPosition, MC_GroupWriteToolData, MC_GroupReadToolData, MC_GroupSelectTool, MC_GroupReadTool,
              MC_GroupWritePayloadData, MC_GroupReadPayloadData, MC_GroupSelectPayload, MC_GroupReadPayload, MC_GroupWriteRigidBodyDynamic,
              MC_GroupReadRigidBodyDynamic, MC_GroupJog, MC_GroupJogVector, MC_GroupWriteJoggingDynamics, MC_GroupReadJoggingDynamics,
              MC_PathSelect, MC_MovePath, MC_GroupHome, MC_GroupWriteSWLimits, MC_GroupReadParameter, MC_GroupWriteParameter,
              MC_GroupWriteReferenceDynamics, MC_GroupReadReferenceDynamics, MC_TrackConveyorBelt, MC_TrackRotaryTable, MC_SyncAxisToGroup,
              MC_SyncGroupToAxis>;
/// Of groups, beside the standard's blocks: stored paths, refusals.
using PathBlocks = BlockList<Path_Handshake, Group_ReadRefusal>;

using FieldbusBlocks = BlockList<EC_SdoRead, EC_SdoWrite>;

using MotionBlocks = decltype(detail::joined(
    detail::joined(detail::joined(AxisBlocks{}, AdministrativeBlocks{}), detail::joined(CouplingBlocks{}, VendorBlocks{})), DriveBlocks{}));
using AllBlocks = decltype(detail::joined(detail::joined(detail::joined(detail::joined(IecBlocks{}, MotionBlocks{}), HomingBlocks{}),
                                                         detail::joined(GroupBlocks{}, PathBlocks{})),
                                          FieldbusBlocks{}));

/// The blocks of a list as bytes and pins, e.g. types_of<IecBlocks>. It costs the compiler seconds: name it where it is needed and not in a header.
template <class List>
inline constexpr int types_of = 0;
template <class... Blocks>
inline constexpr std::array types_of<BlockList<Blocks...>>{block_type<Blocks>()...};

}  // namespace taktwerk::fb

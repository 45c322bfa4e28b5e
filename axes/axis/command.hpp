#pragma once
// What is submitted to an axis. A value: the latch of a block's inputs. Trivially copyable.

#include <type_traits>

#include "axes/axis/command_details.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

enum class CommandKind : std::uint8_t {
    none,
    // to a position: DiscreteMotion
    move_absolute,  ///< position; WholeTurns or no details
    move_relative,  ///< position = distance, from the set position at activation
    move_additive,  ///< position = distance, from the last commanded target (P1-147, P1-148)
    halt,
    // endless: ContinuousMotion
    move_velocity,             ///< velocity signed, times direction
    move_continuous_absolute,  ///< position, then end_velocity (signed)
    move_continuous_relative,  ///< position = distance, then end_velocity
    // beside the axis' own motion: a slot each, no queue
    move_superimposed,  ///< position = distance, velocity = VelocityDiff
    halt_superimposed,
    // MC_Stop, MC_Home, jog
    stop,  ///< locks the axis while the stop is held (release_stop)
    home,  ///< position = coordinate of the reference
    jog,   ///< velocity signed; lives by lease
    // following something else
    gear_in,      ///< GearDetails
    gear_in_pos,  ///< GearInPosDetails
    cam_in,       ///< CamDetails
    combine,      ///< CombineDetails
    gear_out,
    cam_out,
    phasing_absolute,  ///< position = shift of the master's position; a slot of its own
    phasing_relative,
    halt_phasing,          ///< ends it where it is; the shift so far stays
    position_profile,      ///< TimeProfileDetails
    velocity_profile,      ///< TimeProfileDetails
    acceleration_profile,  ///< TimeProfileDetails
    torque,                ///< TorqueDetails
    external,              ///< set-points by SetpointFeed until another command takes over; jerk = what they keep, 0 = nobody says
    // homing step by step: HomingStepDetails
    homing_step,
    abort_passive_homing,
    // probes: ProbeDetails; slots of their own
    touch_probe,
    abort_trigger,
    // the rest
    setting,              ///< AxisSetting, in the queue (mcQueued): done when its turn comes
    set_controller_mode,  ///< position = number of the DriveMode
    // the drive makes the profile, in a mode of its own; no blending
    drive_move_absolute,  ///< position
    drive_move_relative,  ///< position = distance, from the actual position at the start; behind another of them from its target
    drive_move_velocity,  ///< velocity signed, times direction
    drive_torque,         ///< TorqueDetails; velocity = the drive's speed limit, 0 = the axis' limit
    // beside whatever the axis does, in any state
    set_torque_limit,  ///< TorqueLimitDetails
    // only by Axis::join_group
    group_motion,  ///< set-points of the axis' group, in each cycle; everybody else's motion is refused; jerk = what they keep, 0 = nobody says
};

/// Units: u, u/s, u/s2, u/s3. Acceleration, deceleration, jerk 0 = the axis' default.
struct AxisCommand {
    CommandKind kind = CommandKind::none;
    MC_BufferMode buffer_mode = mcAborting;
    MC_Direction direction = mcPositiveDirection;
    double position = 0;
    double velocity = 0;
    double acceleration = 0, deceleration = 0, jerk = 0;
    double end_velocity = 0;
    CommandDetails details{};
    const void* instance = nullptr;  ///< the block that gave it, to be named to people; never followed
    friend bool operator==(const AxisCommand&, const AxisCommand&) = default;
};
static_assert(std::is_trivially_copyable_v<AxisCommand>);

/// The answer to submit: at once, in the same call.
struct Submitted {
    CommandId id = 0;  ///< 0 when refused
    ErrorId error = ErrorId::none;
};

enum class Outcome : std::uint8_t { done, aborted, error };

/// What an accepted command has come to.
enum class CommandStatus : std::uint8_t {
    unknown,  ///< never heard of, or so long finished that the ledger forgot: treat as aborted
    queued,
    active,
    in_target,  ///< in_target: active and the set value is the commanded one (InVelocity)
    done,
    aborted,
    error,
};

/// Commands that run beside the axis' own motion, one of each at a time.
enum class SideSlot : std::uint8_t { superimposed, phasing, probe1, probe2, passive_homing, torque_limit };
inline constexpr std::size_t side_slot_count = 6;

}  // namespace taktwerk::axes

#pragma once
// What is submitted to an axis. A value: the latch of a block's inputs. Trivially copyable.

#include "axes/axis/types.hpp"

namespace taktwerk::axes {

enum class CommandKind : std::uint8_t {
    none,
    move_absolute,  ///< position
    move_relative,  ///< position = distance, from the set position at activation
    move_velocity,  ///< velocity signed, times direction
    halt,
    stop,  ///< locks the axis while the stop is held (release_stop)
    home,  ///< position = coordinate of the reference
    jog,   ///< velocity signed; lives by lease
};

/// Units: u, u/s, u/s2, u/s3. Acceleration, deceleration, jerk 0 = the axis' default.
struct AxisCommand {
    CommandKind kind = CommandKind::none;
    MC_BufferMode buffer_mode = mcAborting;
    MC_Direction direction = mcPositiveDirection;
    double position = 0;
    double velocity = 0;
    double acceleration = 0, deceleration = 0, jerk = 0;
};

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

}  // namespace taktwerk::axes

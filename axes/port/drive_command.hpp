#pragma once
// What an axis wants of its drive in a cycle. Units: axes/port/drive_port.hpp.

#include <array>
#include <cstdint>
#include <limits>

#include "axes/port/drive_states.hpp"

namespace taktwerk::axes {

enum class PowerRequest : std::uint8_t {
    off,         ///< voltage off; the axis has stopped before it asks (a drive may coast)
    on,          ///< reach `enabled`, with the target aligned to the actual position
    quick_stop,  ///< the drive stops by itself (605Ah)
};

/// What a holding brake is told that the controller works through the drive.
enum class BrakeRequest : std::uint8_t { none, close, open };

/// How one side of a portal is led to where it is square.
struct SquaringPace {
    double velocity = 0;      ///< counts/s, > 0
    double acceleration = 0;  ///< counts/s2, > 0
};

enum class ProbeEdge : std::uint8_t { rising, falling };

struct ProbeCommand {
    bool armed = false;
    bool continuous = false;
    bool index_pulse = false;  ///< latch on the encoder index instead of the input
    ProbeEdge edge = ProbeEdge::rising;
};

/// One homing run other than the configured one; `method` 0: as configured. Ports that can only write it acyclically hold the
/// start back until it is written.
struct DriveHomingSetup {
    std::int8_t method = 0;                          ///< 6098h
    double search_velocity = 0, latch_velocity = 0;  ///< counts/s
    double acceleration = 0;                         ///< counts/s2
};

/// A set-point for a drive that makes its own profile (PP, PV, PT). A changed `sequence` announces a new one; the port brings speed and
/// ramps to the drive first, does the handshake of PP (6040h bit 4 against 6041h bit 12) and answers with DriveFeedback::profile_accepted.
/// Target, speed and ramps are the command's position, velocity, torque, acceleration, deceleration and torque_slope; they must not
/// change while the sequence does not, but for the deceleration of a halt, which reaches the drive where it is mapped. One that is never
/// accepted was refused.
struct ProfileSetpoint {
    std::uint32_t sequence = 0;  ///< 0: none
    bool relative = false;
    bool immediately = false;  ///< abandon the present one (bit 5; SE-808X means "blend after it", sheet 4.1)
};

/// What the axis wants in this cycle. Filled anew every cycle; a port needs no memory of earlier ones.
struct DriveCommand {
    PowerRequest power = PowerRequest::off;
    bool reset_fault = false;  ///< level; the port makes the edge and takes it back (bit 7 must return to 0)
    DriveMode mode = DriveMode::cyclic_position;
    std::int64_t position = 0;                  ///< counts
    double velocity = 0;                        ///< counts/s: set-point in velocity modes, feed-forward in position mode
    double torque = 0;                          ///< set-point in torque modes, feed-forward otherwise
    double acceleration = 0, deceleration = 0;  ///< counts/s2 for drives that ramp by themselves; 0 = leave
    double torque_limit_positive = std::numeric_limits<double>::infinity();
    double torque_limit_negative = std::numeric_limits<double>::infinity();
    bool start_homing = false;  ///< level, while mode is homing: hold until attained or failed; false aborts
    bool halt = false;          ///< controlword bit 8
    std::array<ProbeCommand, 2> probes{};
    std::uint32_t digital_outputs = 0, digital_output_mask = 0;
    double velocity_limit = std::numeric_limits<double>::infinity();  ///< counts/s, torque modes; infinity = as at start-up
    double torque_slope = 0;                                          ///< rated torques/s in profile torque mode; 0 = leave
    DriveHomingSetup homing{};
    ProfileSetpoint profile{};
    BrakeRequest brake = BrakeRequest::none;
};

}  // namespace taktwerk::axes

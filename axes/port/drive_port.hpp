#pragma once
// DrivePort: everything an axis may ask of a drive, and nothing of how the drive is reached. One port per axis: a slave with
// six axes gives six ports, at their own object and PDO offsets; a drive on a serial line gives one that ages between polls.
//
// FROZEN SHAPE. Implementations: axes/drives/cia402 (CiA 402 over EtherCAT), later axes/drives/xp200 (Modbus RTU).
// Rich enough for SV33-E, SV-DA200, TSVM-D6, SE-808X, XP200 (see docs/drives.md). Extend additively.
//
// Positions are counts of the drive's own position unit, unwrapped to 64 bit. Velocities are counts/s, accelerations
// counts/s2, torques fractions of rated torque (1.0 = rated). User units exist only above, in the axis.

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::axes {

/// CiA 402 6060h by meaning; a drive without a status word (XP200) maps its own modes to these.
enum class DriveMode : std::uint8_t {
    none, profile_position, profile_velocity, profile_torque, homing, cyclic_position, cyclic_velocity, cyclic_torque,
};
[[nodiscard]] std::string_view name(DriveMode mode) noexcept;

/// CiA 402 power state by meaning. `unknown`: a status word that fits no state; treated like a fault (never "keep the last").
enum class PowerState : std::uint8_t {
    unknown, not_ready, disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault,
};
[[nodiscard]] std::string_view name(PowerState state) noexcept;

/// How set-points get through.
enum class SetpointClass : std::uint8_t {
    cyclic,        ///< a new set-point each bus cycle (CSP, CSV, CST)
    low_dynamics,  ///< speed steps at the pace of a poll schedule; no interpolation, no coupling (XP200)
};

struct DriveCapabilities {
    std::uint16_t modes = 0;                 ///< bit per DriveMode
    SetpointClass setpoints = SetpointClass::cyclic;
    bool velocity_feed_forward = false;      ///< 60B1h mapped
    bool torque_feed_forward = false;        ///< 60B2h mapped
    bool torque_limits = false;              ///< 6072h or 60E0h/60E1h mapped
    bool digital_inputs = false;             ///< limits and home are reported (60FDh)
    bool digital_outputs = false;            ///< 60FEh mapped
    std::uint8_t probes = 0;                 ///< touch probes with hardware latch
    bool drive_homing = false;
    bool motor_has_encoder = true;           ///< false: "actual" is the command (open-loop stepper)
    bool absolute_encoder = false;
    std::uint8_t position_bits = 32;         ///< width of the raw position before unwrapping
    double rated_velocity = std::numeric_limits<double>::infinity();  ///< counts/s the drive can follow; infinity = not stated
    Duration minimum_cycle{};
    Duration enable_delay{};                 ///< motion must wait this long after `enabled` (brake, servo-on dwell)
    Duration mode_change_delay{};            ///< set-points must wait this long after the mode is confirmed
    bool mode_change_at_standstill = false;
    Duration feedback_period{};              ///< 0 = every bus cycle; else the poll period

    [[nodiscard]] constexpr bool has(DriveMode mode) const noexcept { return (modes >> static_cast<unsigned>(mode)) & 1u; }
};

enum class PowerRequest : std::uint8_t {
    off,         ///< voltage off; the axis has stopped before it asks (a drive may coast)
    on,          ///< reach `enabled`, with the target aligned to the actual position
    quick_stop,  ///< the drive stops by itself (605Ah)
};

enum class ProbeEdge : std::uint8_t { rising, falling };

struct ProbeCommand {
    bool armed = false;
    bool continuous = false;
    bool index_pulse = false;  ///< latch on the encoder index instead of the input
    ProbeEdge edge = ProbeEdge::rising;
};

/// What the axis wants in this cycle. Filled anew every cycle; a port needs no memory of earlier ones.
struct DriveCommand {
    PowerRequest power = PowerRequest::off;
    bool reset_fault = false;           ///< level; the port makes the edge and takes it back (bit 7 must return to 0)
    DriveMode mode = DriveMode::cyclic_position;
    std::int64_t position = 0;          ///< counts
    double velocity = 0;                ///< counts/s: set-point in velocity modes, feed-forward in position mode
    double torque = 0;                  ///< set-point in torque modes, feed-forward otherwise
    double acceleration = 0, deceleration = 0;  ///< counts/s2 for drives that ramp by themselves; 0 = leave
    double torque_limit_positive = std::numeric_limits<double>::infinity();
    double torque_limit_negative = std::numeric_limits<double>::infinity();
    bool start_homing = false;          ///< level, while mode is homing: hold until attained or failed; false aborts
    bool halt = false;                  ///< controlword bit 8
    std::array<ProbeCommand, 2> probes{};
    std::uint32_t digital_outputs = 0, digital_output_mask = 0;
};

struct ProbeFeedback {
    bool latched = false;
    std::uint16_t count = 0;            ///< latches since armed
    std::int64_t position = 0;          ///< counts at the edge
};

/// What the drive says. All of one latch instant.
struct DriveFeedback {
    bool fresh = false;                 ///< new in this cycle
    bool online = false;                ///< exchanged at all (bus in OP, line answering); false: everything below is old
    std::uint32_t age = 0;              ///< bus cycles since it was fresh
    Instant latched{};                  ///< when the actual values were taken

    PowerState power = PowerState::unknown;
    DriveMode mode = DriveMode::none;   ///< active mode (6061h), or the commanded one where the drive cannot say
    bool fault = false, warning = false;
    bool main_power = true;             ///< statusword bit 4 where it means that
    bool target_reached = false, internal_limit = false;
    std::uint16_t status_word = 0;      ///< raw, for people
    std::uint16_t error_code = 0;       ///< 603Fh or the vendor's number; 0 = none

    std::int64_t position = 0;          ///< counts, unwrapped
    double velocity = 0;                ///< counts/s; from the drive, else differentiated
    double torque = 0;                  ///< fraction of rated
    bool homing_attained = false, homing_error = false;

    bool has_inputs = false;
    bool negative_limit = false, positive_limit = false, home_switch = false;
    std::uint32_t digital_inputs = 0;   ///< raw
    std::array<ProbeFeedback, 2> probes{};
};

/// A drive alarm with what the profile knows about it; texts are looked up outside the cycle by `entry`.
struct DriveAlarm {
    std::uint16_t code = 0;             ///< 603Fh or the vendor's number; 0 = none
    std::uint32_t detail = 0;           ///< further object (4000h, P21.08), 0 = not read or none
    bool detail_known = false;
    std::int32_t entry = -1;            ///< index into the profile's alarm table; -1 = unknown code
    bool resettable = true;
    bool whole_drive = false;           ///< common to all axes of the drive
};

class DrivePort {
public:
    virtual ~DrivePort() = default;
    [[nodiscard]] virtual const DriveCapabilities& capabilities() const noexcept = 0;

    // --- in the cycle; real-time safe ---------------------------------------------------------------------------------
    /// Raw fields -> feedback. Once per cycle, after the bus received (step 3).
    virtual const DriveFeedback& decode(Instant now) noexcept = 0;
    /// Command -> raw fields. Once per cycle, before the bus sends (step 8).
    virtual void encode(const DriveCommand& command, Instant now) noexcept = 0;
    /// When the command encoded now takes effect in the drive, if sent at `send_time`.
    [[nodiscard]] virtual Instant setpoint_effective(Instant send_time) const noexcept = 0;
    [[nodiscard]] virtual DriveAlarm alarm() const noexcept = 0;

    // --- service side; not real-time ------------------------------------------------------------------------------------
    /// Acyclic work of this drive: reading the detail of an alarm, parameters. Resumable, called often.
    virtual void step(Instant now) { (void)now; }
};

}  // namespace taktwerk::axes

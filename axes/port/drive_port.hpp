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
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axes/port/drive_alarm_kind.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// CiA 402 6060h by meaning; a drive without a status word (XP200) maps its own modes to these.
enum class DriveMode : std::uint8_t {
    none,
    profile_position,
    profile_velocity,
    profile_torque,
    homing,
    cyclic_position,
    cyclic_velocity,
    cyclic_torque,
};
[[nodiscard]] std::string_view name(DriveMode mode) noexcept;

/// CiA 402 power state by meaning. `unknown`: a status word that fits no state; treated like a fault (never "keep the last").
enum class PowerState : std::uint8_t {
    unknown,
    not_ready,
    disabled,
    ready,
    switched_on,
    enabled,
    quick_stop,
    fault_reaction,
    fault,
};
[[nodiscard]] std::string_view name(PowerState state) noexcept;

/// How set-points get through.
enum class SetpointClass : std::uint8_t {
    cyclic,        ///< a new set-point each bus cycle (CSP, CSV, CST)
    low_dynamics,  ///< speed steps at the pace of a poll schedule; no interpolation, no coupling (XP200)
};

/// Rare, guarded actions of a drive that no cycle asks for by itself.
enum class DriveService : std::uint8_t {
    clear_multi_turn,    ///< the encoder forgets its turns: the axis is unreferenced afterwards (TSVM bit 12, SV33-E P20.05, XP200: none)
    save_parameters,     ///< into the EEPROM (SE-808X 1010h, XP200 FC41H); the drive may be silent for seconds
    restore_parameters,  ///< to factory values
    restart,             ///< the drive's own soft restart, where it has one
};

struct DriveCapabilities {
    std::uint16_t modes = 0;  ///< bit per DriveMode
    SetpointClass setpoints = SetpointClass::cyclic;
    bool velocity_feed_forward = false;  ///< 60B1h mapped
    bool torque_feed_forward = false;    ///< 60B2h mapped
    bool torque_limits = false;          ///< 6072h or 60E0h/60E1h mapped: they hold from the next exchange on
    bool digital_inputs = false;         ///< limits and home are reported (60FDh)
    bool digital_outputs = false;        ///< 60FEh mapped
    std::uint8_t probes = 0;             ///< touch probes with hardware latch
    std::uint8_t probe_edges = 0b1111;   ///< whose latched position is exchanged: bit 2 * probe rising, bit 2 * probe + 1 falling
    bool drive_homing = false;
    bool motor_has_encoder = true;  ///< false: "actual" is the command (open-loop stepper)
    bool absolute_encoder = false;
    std::uint8_t position_bits = 32;                                  ///< width of the raw position before unwrapping
    double rated_velocity = std::numeric_limits<double>::infinity();  ///< counts/s the drive can follow; infinity = not stated
    Duration minimum_cycle{};
    Duration enable_delay{};       ///< motion must wait this long after `enabled` (brake, servo-on dwell)
    Duration mode_change_delay{};  ///< set-points must wait this long after the mode is confirmed
    bool mode_change_at_standstill = false;
    Duration feedback_period{};  ///< 0 = every bus cycle; else the poll period
    // What the later drives need beyond it; a port that says nothing has none of it.
    bool velocity_limit = false;     ///< 607Fh mapped (or Pr078): speed limit in torque modes
    bool reports_following = false;  ///< DriveFeedback::follows_target means something
    bool homing_per_run = false;     ///< DriveCommand::homing is obeyed; else the start-up values hold
    std::uint8_t profile_buffer =
        0;                         ///< set-points the drive takes ahead in profile position mode (SV33-E 1, SV-DA200 8); 0: mode not served
    bool profile_replaces = true;  ///< ProfileSetpoint::immediately abandons the running set-point (SE-808X goes on after it, sheet 4.1)
    std::uint8_t services = 0;     ///< bit per DriveService
    bool torque_limits_written = false;       ///< they are not mapped, but the drive has them: DriveFeedback says when it has taken them
    bool torque_limit_per_direction = false;  ///< 60E0h and 60E1h; false: 6072h alone, one limit for both directions
    bool brake = false;                       ///< its holding brake is worked by DriveCommand::brake (60FEh)
    double velocity_step = 0;    ///< counts/s between two velocity set-points the drive can tell apart (XP200: 1 r/min); 0 = none
    Duration command_latency{};  ///< worst time from encode() to effect beyond setpoint_effective() (a slow line); 0 = none

    [[nodiscard]] constexpr bool has(DriveMode mode) const noexcept { return (modes >> static_cast<unsigned>(mode)) & 1u; }
    [[nodiscard]] constexpr bool has(DriveService service) const noexcept { return (services >> static_cast<unsigned>(service)) & 1u; }
};

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

struct ProbeFeedback {
    bool armed = false;  ///< the drive confirms that it waits for edges (false while a re-arming is under way)
    bool latched = false;
    std::uint16_t count = 0;    ///< latches since armed
    std::int64_t position = 0;  ///< counts at the edge
};

/// What became of torque limits that are not mapped.
enum class TorqueLimitAnswer : std::uint8_t { taken, pending, refused };

/// What the drive says. All of one latch instant.
struct DriveFeedback {
    // What is new in every cycle of a motor that turns: first, and side by side.
    Instant latched{};          ///< when the actual values were taken
    std::int64_t position = 0;  ///< counts, unwrapped
    double velocity = 0;        ///< counts/s; from the drive, else differentiated
    double torque = 0;          ///< fraction of rated

    // How it is with the drive: mostly as in the cycle before.
    std::uint32_t age = 0;               ///< bus cycles since it was fresh
    std::uint32_t digital_inputs = 0;    ///< raw
    std::uint32_t profile_accepted = 0;  ///< sequence of the last profile set-point the drive has taken
    std::uint16_t status_word = 0;       ///< raw, for people
    std::uint16_t error_code = 0;        ///< 603Fh or the vendor's number; 0 = none
    /// Counts each time the position's zero may have become another: the drive was away and came back, homed, or lost its turns.
    std::uint16_t position_epoch = 0;
    /// Counts each time the drive lost what homing gave it: its turns were cleared, or an alarm says so. The axis is unreferenced then.
    std::uint16_t reference_epoch = 0;
    bool fresh = false;   ///< new in this cycle
    bool online = false;  ///< exchanged at all (bus in OP, line answering); false: everything else is old
    PowerState power = PowerState::unknown;
    DriveMode mode = DriveMode::none;  ///< active mode (6061h), or the commanded one where the drive cannot say
    bool fault = false, warning = false;
    bool main_power = true;  ///< statusword bit 4 where it means that
    bool target_reached = false, internal_limit = false;
    bool homing_attained = false, homing_error = false;
    bool follows_target = true;         ///< statusword bit 12 in cyclic modes, where it means that
    bool homing_setup_refused = false;  ///< DriveCommand::homing could not be written: no start is sent until it is taken back
    /// The drive has acknowledged all that encode() asked that changes its state; false: still under way (polled drives).
    bool commands_acknowledged = true;
    TorqueLimitAnswer torque_limits = TorqueLimitAnswer::taken;  ///< to those of the last command, where they are written acyclically
    bool setup_refused = false;                                  ///< the drive's settings forbid enabling it; setup_problems() says which
    bool has_inputs = false;
    bool negative_limit = false, positive_limit = false, home_switch = false;
    std::array<ProbeFeedback, 2> probes{};

    /// `other` says the same of the drive: at most the actual values and their time are others. (Or it does and this is not seen, by padding.)
    [[nodiscard]] bool differs_in_motion_only(const DriveFeedback& other) const noexcept;
    void take_motion(const DriveFeedback& from) noexcept {
        latched = from.latched;
        position = from.position;
        velocity = from.velocity;
        torque = from.torque;
    }
};

inline bool DriveFeedback::differs_in_motion_only(const DriveFeedback& other) const noexcept {
    using TwoWords [[gnu::vector_size(16)]] = std::uint64_t;
    constexpr std::size_t first = offsetof(DriveFeedback, age), last = sizeof(DriveFeedback) - sizeof(TwoWords);
    static_assert(first == offsetof(DriveFeedback, torque) + sizeof(torque), "the actual values come first");
    static_assert(last - first == 56, "compared below, the last two words with an overlap");
    const auto difference = [&](std::size_t at) noexcept {
        TwoWords mine, others;
        std::memcpy(&mine, reinterpret_cast<const std::byte*>(this) + at, sizeof mine);
        std::memcpy(&others, reinterpret_cast<const std::byte*>(&other) + at, sizeof others);
        return mine ^ others;
    };
    const auto any = difference(first) | difference(first + 16) | difference(first + 32) | difference(first + 48) | difference(last);
    return (any[0] | any[1]) == 0;
}

/// A drive alarm with what the profile knows about it; texts are looked up outside the cycle by `entry`.
struct DriveAlarm {
    std::uint16_t code = 0;    ///< 603Fh or the vendor's number; 0 = none
    std::uint32_t detail = 0;  ///< further object (4000h, P21.08), 0 = not read or none
    bool detail_known = false;
    std::int32_t entry = -1;  ///< index into the profile's alarm table; -1 = unknown code
    bool resettable = true;
    bool whole_drive = false;  ///< common to all axes of the drive
    bool warning = false;      ///< announced while the drive goes on
    DriveAlarmKind kind = DriveAlarmKind::other;
};

/// A parameter by its number: object index and sub-index, or a register (sub 0). Objects are named as for the first axis of a
/// drive; the port adds the offset of its own. Names (P05.10, PA17, Pr098) are the profile's.
struct ParameterAddress {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    friend bool operator==(const ParameterAddress&, const ParameterAddress&) = default;
};
/// A service request in flight; 0: refused at once (not supported, or not now).
using ServiceTicket = std::uint32_t;
/// Little-endian bytes of the value read; empty for everything else.
using ServiceAnswer = std::vector<std::byte>;

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

    // Of two drives on one portal (axes/drives/gantry). Real-time safe.
    /// Counts that the follower is ahead of the leader: of where it was when both got their power, or of square once that is known.
    [[nodiscard]] virtual double skew() const noexcept { return 0; }
    /// One of the two has lost its power; DriveFeedback::power is the other's.
    [[nodiscard]] virtual bool side_lost() const noexcept { return false; }
    /// The follower's home switch; the leader's is DriveFeedback::home_switch.
    [[nodiscard]] virtual bool follower_home_switch() const noexcept { return false; }
    /// The portal is square when the follower is `further` counts on from where it is beside the leader now: skew() counts from there, and
    /// the follower is led there while both have power.
    virtual void square(std::int64_t further, const SquaringPace& pace) noexcept { (void)further, (void)pace; }
    /// It brakes and stays where it is then.
    virtual void stop_squaring() noexcept {}
    [[nodiscard]] virtual bool squaring() const noexcept { return false; }

    // --- service side; not real-time ------------------------------------------------------------------------------------
    /// Acyclic work of this drive: reading the detail of an alarm, parameters. Resumable, called often.
    virtual void step(Instant now) { (void)now; }

    /// Reads a parameter. The answer comes through service_answer() in a later step().
    [[nodiscard]] virtual ServiceTicket read_parameter(ParameterAddress address) {
        (void)address;
        return 0;
    }
    /// Writes a parameter as little-endian bytes, in the width the drive expects. Never an object that is mapped cyclically.
    [[nodiscard]] virtual ServiceTicket write_parameter(ParameterAddress address, std::vector<std::byte> value) {
        (void)address, (void)value;
        return 0;
    }
    /// Starts a guarded service; refused (0) unless the drive is disabled and the capability is there. The caller has asked the
    /// operator and logs it.
    [[nodiscard]] virtual ServiceTicket start_service(DriveService service) {
        (void)service;
        return 0;
    }
    /// Nothing while it is in flight; afterwards the result, once.
    [[nodiscard]] virtual std::optional<Result<ServiceAnswer>> service_answer(ServiceTicket ticket) {
        (void)ticket;
        return std::nullopt;
    }
    /// Settings of the drive with which it must not be enabled (SV-DA200 P0.03, P0.37; XP200 Pr097), in words.
    [[nodiscard]] virtual std::vector<std::string> setup_problems() const { return {}; }
};

}  // namespace taktwerk::axes

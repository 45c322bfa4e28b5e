#pragma once
// DrivePort: everything an axis may ask of a drive, and nothing of how the drive is reached. One port per axis: a slave with
// six axes gives six ports, at their own object and PDO offsets; a drive on a serial line gives one that ages between polls.
//
// FROZEN SHAPE. Implementations: axes/drives/cia402 (CiA 402 over EtherCAT), later axes/drives/xp200 (Modbus RTU).
// Rich enough for SV33-E, SV-DA200, TSVM-D6, SE-808X, XP200 (see docs/drives.md). Extend additively.
//
// Positions are counts of the drive's own position unit, unwrapped to 64 bit. Velocities are counts/s, accelerations
// counts/s2, torques fractions of rated torque (1.0 = rated). User units exist only above, in the axis.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/port/drive_alarm_kind.hpp"
#include "axes/port/drive_capabilities.hpp"
#include "axes/port/drive_command.hpp"
#include "axes/port/drive_feedback.hpp"
#include "axes/port/drive_states.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// What a port finds by itself, of a drive that has no numbers for it.
enum class PortFault : std::uint8_t {
    none,
    encoder,    ///< its position does not hold: the position loop cannot be closed
    polarity,   ///< the motor ran against its set-point; DriveAlarm::detail: so many counts
    amplifier,  ///< it says so by a wire
    not_ready,  ///< it is to be enabled and does not say that it can be; no fault yet
};

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
    PortFault found = PortFault::none;
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

#pragma once
// What everyone else sees of an axis: one value per axis and cycle. Blocks read it by command id; snapshot and HMI copy it.
// Trivially copyable, so a slower task can latch it.

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "axes/axis/command.hpp"
#include "axes/port/drive_port.hpp"
#include "axes/words/types.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// Which limit held the velocity down in this cycle: the answer to "why is it so slow".
enum class VelocityLimiter : std::uint8_t { none, command, axis_limit, manual_speed, override_factor, software_limit, stopping };

struct AxisView {
    AxisState state = AxisState::Disabled;
    Owner owner = Owner::none;
    bool powered = false;                                 ///< operation enabled and the dwell after it has passed: motion is accepted
    bool enable = false;                                  ///< power is wanted ...
    bool enable_positive = true, enable_negative = true;  ///< ... and whoever wants it permits these ways
    bool homed = false;
    bool simulated = false;
    bool online = false;                   ///< feedback is fresh enough
    bool answered = false;                 ///< in this cycle; else the actual values are older
    Presence presence = Presence::always;  ///< of the group that its drive is in
    bool in_position = false;              ///< actual inside the in-position window of the set-point, standstill
    bool warning = false;
    BrakeState brake = BrakeState::not_controlled;
    std::uint16_t error = 0;              ///< alarm id while in ErrorStop (or ErrorId of the last error); 0 = none
    std::uint16_t drive_error = 0;        ///< drive's own number (603Fh); 0 = none
    bool resetting = false;               ///< a reset waits for the drive or for standstill
    ErrorId reset_error = ErrorId::none;  ///< what the last reset came to, once it is over

    CommandKind active_kind = CommandKind::none;
    bool active_in_target = false;
    VelocityLimiter limiter = VelocityLimiter::none;
    CommandId active = 0;  ///< the command that controls the axis; those beside and behind it: below

    // u, u/s, u/s2, u/s3, fraction of rated torque
    double set_position = 0, set_velocity = 0, set_acceleration = 0, set_jerk = 0;
    double actual_position = 0, actual_velocity = 0, actual_torque = 0;
    double following_error = 0;   ///< set-point in effect at the latch, minus actual
    double following_window = 0;  ///< u: what it may be, at the set velocity of the same instant; infinity = not watched
    double torque_limit_positive = std::numeric_limits<double>::infinity();  ///< fraction of rated torque; infinity = what the drive has
    double torque_limit_negative = std::numeric_limits<double>::infinity();
    double skew = 0;             ///< of a gantry: the follower is ahead by it
    double load_difference = 0;  ///< of a load encoder: the load is ahead of the motor by it
    double target_position = 0;
    double manual_slow = 0, manual_fast = 0;  ///< u/s, > 0: the jogging speeds (ManualSpeeds, resolved; parameters 1020, 1021)

    PowerState drive_state = PowerState::unknown;
    DriveMode drive_mode = DriveMode::none;
    std::uint16_t status_word = 0;
    bool negative_limit_switch = false, positive_limit_switch = false, home_switch = false;

    // modulo axes: positions above are in [0, modulo)
    double modulo = 0;       ///< u; 0 = linear
    std::int64_t turns = 0;  ///< whole moduli of the set position since zero

    Override override_factors;      ///< of MC_SetOverride
    double operators_override = 1;  ///< 0..1, beside it: the velocity is multiplied by both
    /// The parameters that are stored: 2..9 and 12..17 by number, then those of the vendor (axes/axis/parameters.hpp reads them and all
    /// others from this view).
    std::array<double, 36> parameters{};
    std::uint32_t digital_inputs = 0;   ///< of the drive, raw (60FDh)
    std::uint32_t digital_outputs = 0;  ///< of the drive, as written (60FEh); bits never written are 0

    // beside the axis' own motion
    double superimposed_covered = 0;            ///< u since its start
    double phase_shift = 0, phase_covered = 0;  ///< u of the master: in effect now; since the start of the last phasing
    AxisRef master;                             ///< while coupled
    CamId selected_cam;                         ///< of the last SelectCam that was done
    SelectCam selected_as;                      ///< that SelectCam
    bool sync_started = false;                  ///< MC_GearInPos runs towards its sync point (StartSync)
    std::uint32_t cam_ends = 0;                 ///< counts ends of the cam's profile (EndOfProfile), also in reverse
    std::array<double, 2> probe_position{};     ///< u, of the last latch of each probe slot ...
    std::array<CommandId, 2> probe_latched{};   ///< ... and the command it ended; 0 = none so far
    bool homing_procedure = false;              ///< between the first step of Part 5 and MC_FinishHoming

    // commands
    const void* holder = nullptr;                   ///< the block that moves or locks the axis, to be named to people; never followed
    CommandId lock = 0;                             ///< the MC_Stop that holds the axis in Stopping; 0 = none
    std::array<CommandId, side_slot_count> side{};  ///< running beside the active one, by SideSlot
    CommandId phasing_queued = 0;                   ///< waits for the signal of its coupling, apart from `queued`
    std::uint8_t queued_count = 0;
    std::array<CommandId, 8> queued{};
    struct Finished {
        CommandId id = 0;
        Outcome outcome = Outcome::done;
        ErrorId error = ErrorId::none;
    };
    std::array<Finished, 16> ledger{};  ///< ring; newest at (ledger_next - 1)
    std::uint8_t ledger_next = 0;
    CommandId last_id = 0;  ///< highest id given out

    /// Bounded (a few dozen compares).
    [[nodiscard]] constexpr CommandStatus status(CommandId id, ErrorId* error_out = nullptr) const noexcept {
        if (id == 0) return CommandStatus::unknown;
        if (id == active) return active_in_target ? CommandStatus::in_target : CommandStatus::active;
        for (const CommandId running : side)
            if (running == id) return CommandStatus::active;
        if (id == phasing_queued) return CommandStatus::queued;
        for (std::uint8_t i = 0; i < queued_count; ++i)
            if (queued[i] == id) return CommandStatus::queued;
        for (const auto& entry : ledger) {
            if (entry.id != id) continue;
            if (error_out) *error_out = entry.error;
            switch (entry.outcome) {
                case Outcome::done: return CommandStatus::done;
                case Outcome::aborted: return CommandStatus::aborted;
                case Outcome::error: return CommandStatus::error;
            }
        }
        return CommandStatus::unknown;
    }
};
static_assert(std::is_trivially_copyable_v<AxisView>);

}  // namespace taktwerk::axes

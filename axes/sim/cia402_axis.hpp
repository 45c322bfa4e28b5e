#pragma once
// One axis of a simulated CiA 402 drive: power state machine, CSP, CSV, CST and homing, alarms, in front of a servo loop and a
// plant. It answers because it computes. Knows no bus: axes/sim/cia402_device.hpp copies objects in and out.
// Sources: CiA 402-2; what differs per drive is in Personality, with the manual's section in the drive sheets.

#include <array>
#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/homing_run.hpp"
#include "axes/sim/plant.hpp"
#include "axes/sim/servo_loop.hpp"
#include "axes/sim/touch_probe.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

/// How a drive takes power from a motor that may still move; SE-808X 605Eh = 0 coasts, SV33-E P04.12 = 2 ramps.
using FaultStop = DriveStop;

/// Alarms that the drive finds out by itself.
struct AlarmCode {
    std::uint16_t code = 0;
    bool resettable = true;
    std::uint32_t detail = 0;  ///< what the detail object shows (P21.08)
};

/// A way in which a drive fails at once, whatever it is doing. How it shows and whether it clears is the personality's.
enum class Failure : std::uint8_t { overspeed, following_error, undervoltage, overload, encoder, communication };

/// How this drive type behaves where CiA 402 leaves room.
struct Personality {
    std::int64_t counts_per_revolution = 10000;
    double velocity_counts_per_unit = 1.0;  ///< raw 606Ch/60FFh = counts/s * this
    double torque_rated_raw = 1000.0;
    bool absolute_encoder = false;  ///< keeps its coordinate over a power cycle
    bool fault_pattern_f = false;   ///< Fault shows as x0xx1111
    bool remote_bit = true;         ///< bit 9 set in OP
    bool internal_limit_bit = true;
    bool csp_following_bits = true;  ///< bits 12 and 13 in CSP
    bool home_found_bit_15 = false;
    bool reset_needs_disable = false;    ///< fault reset only with enable dropped
    bool limit_stop_is_warning = false;  ///< overtravel: stop with position lock, warning, still enabled
    bool quick_stop_leaves = true;       ///< after the quick stop: Switch On Disabled by itself
    FaultStop fault_stop = FaultStop::ramp;
    FaultStop off_stop = FaultStop::coast;  ///< power taken away by command while it moves
    /// The holding brake opens this long after enabling; set-points and homing starts before are lost (SV33-E 3.1.2, P05.13).
    Duration brake_release{};
    /// After power is taken at standstill the motor holds this long until the brake does (SV33-E P05.14). 0: no brake.
    Duration brake_hold{};
    double quick_stop_deceleration = 0;  ///< counts/s2; 0 = torque limit
    double following_error_limit = 0;    ///< counts; 0 = no check
    double maximum_velocity = 0;         ///< counts/s; CSP increments beyond 3 times that are counted; 0 = no check
    double overspeed = 0;                ///< counts/s beyond which the measured speed is an alarm; 0 = no check
    AlarmCode following_error_alarm{0x8611};
    AlarmCode increment_alarm{0x0424};
    AlarmCode undervoltage_alarm{0x3220};
    AlarmCode communication_alarm{0x7500};
    AlarmCode overspeed_alarm{0x8400};
    AlarmCode overload_alarm{0x3230};
    AlarmCode encoder_alarm{0x7305, false};
    std::uint16_t negative_limit_code = 0x5444, positive_limit_code = 0x5443;
};

/// Objects that the master writes.
struct AxisInputs {
    std::uint16_t control = 0;
    std::int64_t mode = 0;
    std::int64_t target_position = 0, target_velocity = 0, target_torque = 0;
    std::int64_t velocity_offset = 0, torque_offset = 0;
    std::int64_t maximum_velocity = 0;  ///< 607Fh: bounds the speed in the torque modes; 0 = no limit
    HomingSettings homing;
    std::int64_t home_offset = 0;
    std::uint16_t probe_function = 0;
};

/// Objects that the drive answers.
struct AxisOutputs {
    std::uint16_t status = 0;
    std::int64_t mode = 0;
    std::int64_t position = 0, velocity = 0, torque = 0, following_error = 0, demand = 0;
    std::uint16_t error_code = 0;
    std::uint32_t error_detail = 0;
    std::uint32_t digital_inputs = 0;
    std::uint16_t probe_status = 0;
    std::int64_t probe_rising[2] = {}, probe_falling[2] = {};
};

class Cia402Axis {
public:
    enum class State : std::uint8_t { not_ready, disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

    Cia402Axis(const PlantConfig& plant, const Personality& personality);

    void power_on(Instant now) noexcept;
    /// Control supply gone: the motor is free, the state machine gone.
    void power_off() noexcept {
        operational_ = false;
        enter(State::not_ready);
    }
    /// Physics up to `now`.
    void advance(Instant now) noexcept;
    /// Newest outputs in, answers out; `cycle` is the time until the next exchange (SYNC0 cycle).
    void exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept;
    /// The bus left OP or fell silent.
    void communication_lost() noexcept;
    void operational(bool op) noexcept { operational_ = op; }

    // --- the outside world -----------------------------------------------------------------------------------------------
    /// An alarm of the drive; `resettable` false needs a power cycle. It stays until it is reset.
    void raise(std::uint16_t code, bool resettable = true, std::uint32_t detail = 0) noexcept;
    void raise(const AlarmCode& alarm) noexcept { raise(alarm.code, alarm.resettable, alarm.detail); }
    /// One of the failures every drive knows, with this drive's own alarm. An encoder that failed shows the same position for
    /// ever after, until power_on().
    void fail(Failure failure) noexcept;
    void main_power(bool on) noexcept;
    void jam(bool jammed) noexcept { plant_.jam(jammed); }
    /// Nothing in front of the sensors at the probes, such as a web without print.
    void blank(bool blank) noexcept { blank_ = blank; }

    [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
    [[nodiscard]] State state() const noexcept { return state_; }
    /// Largest CSP target step between two exchanges while enabled, counts. What a jump of the master would show in.
    [[nodiscard]] double largest_increment() const noexcept { return largest_increment_; }
    /// Set-points and homing starts that came before the brake was open and were lost. A careful master causes none.
    [[nodiscard]] std::uint32_t early_commands() const noexcept { return early_commands_; }
    [[nodiscard]] bool brake_closed() const noexcept { return brake_closed_; }

private:
    void command(const AxisInputs& in) noexcept;
    void enter(State state) noexcept;
    void select_mode(const AxisInputs& in) noexcept;
    void take_targets(const AxisInputs& in, Duration cycle) noexcept;
    void take_position_target(const AxisInputs& in, double seconds) noexcept;
    void inner_step() noexcept;
    void stop_step(double dt, double deceleration) noexcept;
    void homing_finished() noexcept;
    [[nodiscard]] double actual() const noexcept { return plant_.position() - zero_; }
    [[nodiscard]] double quantised() const noexcept;
    [[nodiscard]] SwitchStates switches() const noexcept;
    [[nodiscard]] double torque_limit() const noexcept { return plant_.config().rated_torque * plant_.config().maximum_torque; }
    [[nodiscard]] bool energised() const noexcept {
        return state_ == State::enabled || state_ == State::quick_stop || winding_down_ ||
               (state_ == State::fault_reaction && personality_.fault_stop == FaultStop::ramp);
    }
    [[nodiscard]] bool has_brake() const noexcept { return personality_.brake_hold > Duration::zero(); }
    [[nodiscard]] bool too_early() noexcept;
    [[nodiscard]] bool stands() const noexcept;
    void wind_down() noexcept;
    void step_brake() noexcept;
    void step_probes(double before) noexcept;
    void fill(AxisOutputs& out) const noexcept;
    [[nodiscard]] std::uint16_t status_word() const noexcept;

    Personality personality_;
    Plant plant_;
    ServoLoop loop_;
    HomingRun homing_;
    std::array<TouchProbe, 2> probes_;
    bool blank_ = false;
    State state_ = State::not_ready;
    Instant now_{};
    double zero_ = 0;  ///< plant position at which the drive counts 0
    std::int64_t mode_ = 0;
    Demand demand_;
    double demand_step_ = 0;       ///< counts per second towards the newest target
    double target_ = 0;            ///< newest CSP target, plant coordinates
    std::int64_t steps_left_ = 0;  ///< inner steps until the target is reached
    double torque_ = 0, torque_demand_ = 0, torque_offset_ = 0, velocity_demand_ = 0;
    double fastest_ = 0;  ///< counts/s, torque modes; 0 = no limit
    std::uint16_t last_control_ = 0, error_code_ = 0;
    std::uint32_t error_detail_ = 0;
    bool error_resettable_ = true, main_power_ = true, operational_ = false, homed_ = false, warning_ = false;
    bool homing_attained_ = false, homing_error_ = false;
    std::int64_t home_offset_ = 0;
    std::uint32_t strikes_ = 0;
    double largest_increment_ = 0;
    Instant commands_from_{};    ///< the brake is open from here on
    bool winding_down_ = false;  ///< power is to go, but the motor still stops or holds for the brake
    Instant winding_down_until_{};
    bool brake_closed_ = false, encoder_failed_ = false;
    std::int64_t frozen_position_ = 0;
    std::uint32_t early_commands_ = 0;
};

}  // namespace taktwerk::axes::sim

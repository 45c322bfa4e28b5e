#pragma once
// One axis of a simulated CiA 402 drive: power state machine, modes of operation, ways of stopping, alarms, in front of a servo loop and a
// plant. It answers because it computes. Knows no bus: axes/sim/cia402_device.hpp copies objects in and out.
// Sources: CiA 402-2; what differs per drive is in its DriveProfile, with the manual's section in the drive sheets.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "axes/sim/absolute_encoder.hpp"
#include "axes/sim/alarm_history.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/drive_alarm_codes.hpp"
#include "axes/sim/homing_run.hpp"
#include "axes/sim/mode_codes.hpp"
#include "axes/sim/open_loop_motor.hpp"
#include "axes/sim/plant.hpp"
#include "axes/sim/profile_position.hpp"
#include "axes/sim/servo_loop.hpp"
#include "axes/sim/simulated_motor.hpp"
#include "axes/sim/switch_inputs.hpp"
#include "axes/sim/touch_probe.hpp"
#include "axes/sim/warning_list.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class Cia402Axis {
public:
    enum class State : std::uint8_t { not_ready, disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

    Cia402Axis(const PlantConfig& plant, std::shared_ptr<const DriveProfile> profile, const SimulatedMotor& motor);

    void power_on(Instant now) noexcept;
    /// Control supply gone: the motor is free, the state machine gone.
    void power_off() noexcept {
        operational_ = reachable_ = false;
        self_test_ends_.reset();
        enter(State::not_ready);
    }
    /// Physics up to `now`.
    void advance(Instant now) noexcept;
    /// Newest outputs in, answers out; `cycle` is the time until the next exchange (SYNC0 cycle).
    void exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept;
    /// The bus left OP or fell silent.
    void communication_lost() noexcept;
    void operational(bool op) noexcept { operational_ = op; }
    /// PREOP or above: the control word can be reached.
    void reachable(bool is) noexcept { reachable_ = is; }
    /// The master took the bus out of OP (TSVM 7.2, alarm 44), where the drive tells that from silence.
    void left_operational() noexcept;
    /// An alarm of the whole drive. It goes before the axis' own, which shows again once the other is reset (TSVM 7.1).
    void raise_common(const AlarmCode& alarm) noexcept;

    // --- the outside world -----------------------------------------------------------------------------------------------
    /// An alarm of the drive; `resettable` false needs a power cycle. It stays until it is reset.
    void raise(std::uint16_t code, bool resettable = true, std::uint32_t detail = 0) noexcept;
    void raise(const AlarmCode& alarm) noexcept { raise(alarm.code, alarm.resettable, alarm.detail); }
    /// One of the failures every drive knows, with this drive's own alarm. An encoder that failed shows the same position for
    /// ever after, until power_on().
    void fail(Failure failure) noexcept;
    /// The cause of an alarm of the profile is there until it is released: `panel` is what the drive's display shows, E.216. False:
    /// the profile has no such alarm. A fault can be reset only without its cause, a warning goes with it.
    bool provoke(std::string_view panel) noexcept;
    void release(std::string_view panel) noexcept;
    /// The same by kind, with the profile's first alarm of that kind; nothing where it has none.
    void cause(DriveAlarmKind kind, bool present) noexcept;
    /// As control word bit 7 does, from another side (a parameter, a digital input).
    void reset_alarm() noexcept;
    void main_power(bool on) noexcept;
    void jam(bool jammed) noexcept { plant_.jam(jammed); }
    /// Nothing in front of the sensors at the probes, such as a web without print.
    void blank(bool blank) noexcept { blank_ = blank; }

    /// Objects by which the drive changes while it runs: its unit of velocity (raw = counts/s times this) and what following error is an
    /// alarm [counts; 0 = none].
    void velocity_unit(double counts_per_unit) noexcept { velocity_unit_ = counts_per_unit; }
    void following_limit(double counts) noexcept { motor_.following_error_limit = counts; }

    /// How many of its counts are a turn of the motor: its electronic gear (SE-808X 2000h:02, SV33-E 6091h). The mechanics stay where they are,
    /// all counts are others from now on. Not while the motor has power.
    void scale(double counts_per_revolution) noexcept;

    /// A motor without an encoder: what the drive takes for its position is its own command. `standby`: share of its torque that holds it at
    /// standstill; nothing: it has an encoder. Before power_on().
    void open_loop(std::optional<double> standby) noexcept;
    /// Terminals between the switches of the plant and 60FDh. Before power_on().
    void wire_inputs(const InputObjects& inputs, std::int64_t polarity) noexcept { inputs_.wire(inputs, polarity); }

    /// Of an absolute encoder; what an empty one has lost shows at the next power_on().
    void battery(Battery state) noexcept { battery_ = state; }
    /// The same by the battery's voltage, where the profile has the thresholds (TSVM 7.2: 3.1 V and 2.5 V).
    void battery_voltage(double volts) noexcept;
    /// The encoder's own service, refused while the motor has power: what it complains of is forgotten, and its turns if asked for (SV33-E
    /// P20.05 = 1, 2; TSVM control word bit 12 does the second).
    void reset_encoder() noexcept;
    void clear_turns() noexcept;
    /// The same for a drive that sees it at its next power_on() only (TSVM 7.2.1: PA80).
    void order_encoder_reset() noexcept;

    [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] std::uint16_t error_code() const noexcept { return error_code_; }
    /// Largest CSP target step between two exchanges while enabled, counts. What a jump of the master would show in.
    [[nodiscard]] double largest_increment() const noexcept { return largest_increment_; }
    /// Set-points and homing starts that came before the brake was open and were lost. A careful master causes none.
    [[nodiscard]] std::uint32_t early_commands() const noexcept { return early_commands_; }
    [[nodiscard]] bool brake_closed() const noexcept { return brake_closed_; }
    /// The master works the brake, through an object or past the drive; until it says so the drive does.
    void brake_by_bus(bool open) noexcept { bus_opens_brake_ = open; }
    [[nodiscard]] bool stands() const noexcept;
    /// What the drive's input for this probe sees, and whether the encoder stands on its index pulse.
    [[nodiscard]] bool probe_input(std::size_t probe) const noexcept;
    [[nodiscard]] bool at_index_pulse() const noexcept;
    /// The motor is powered: parameters that change at standstill only are refused.
    [[nodiscard]] bool powered() const noexcept { return energised(); }
    [[nodiscard]] const AlarmHistory& history() const noexcept { return history_; }
    [[nodiscard]] bool alarm_stands() const noexcept { return error_code_ != 0 || warnings_.any(); }
    [[nodiscard]] double counts_per_revolution() const noexcept { return static_cast<double>(motor_.counts_per_revolution); }

private:
    /// How the motor comes to rest now. `ramp` counts/s2; at_once: the demanded speed is 0 from the start.
    struct StopOrder {
        StopBy by = StopBy::zero_speed;
        StopThen then = StopThen::free;
        double ramp = 0;
        bool at_once = true;
    };
    static constexpr Duration inner_period = std::chrono::microseconds{125};
    static constexpr double inner_seconds = 125e-6;

    // cia402_axis.cpp
    void inner_step() noexcept;
    void step_probes(double before) noexcept;
    void take_torque_limits(const AxisInputs& in) noexcept;
    [[nodiscard]] ProbeSignal probe_signal(std::size_t probe) const noexcept;
    /// What the drive takes for the place and the speed of its motor, in the plant's coordinates.
    [[nodiscard]] double seen_position() const noexcept { return stepper_ ? demand_.position : plant_.position(); }
    [[nodiscard]] double seen_velocity() const noexcept { return stepper_ ? demand_.velocity : plant_.velocity(); }
    [[nodiscard]] double actual() const noexcept { return seen_position() - zero_; }
    [[nodiscard]] double quantised() const noexcept;
    [[nodiscard]] IndexPulses index_pulses() const noexcept;
    void read_switches(Duration dt) noexcept;
    [[nodiscard]] const SwitchStates& switches() const noexcept { return inputs_.states(); }
    [[nodiscard]] double torque_limit() const noexcept { return plant_.config().rated_torque * plant_.config().maximum_torque; }
    // cia402_power.cpp
    void command(const AxisInputs& in) noexcept;
    void end_self_test() noexcept;
    void enter(State state) noexcept;
    // cia402_modes.cpp
    void select_mode(const AxisInputs& in) noexcept;
    void take_targets(const AxisInputs& in, Duration cycle) noexcept;
    [[nodiscard]] bool may_change_mode() noexcept;
    void forget_targets() noexcept;
    [[nodiscard]] bool stops_before_mode_change() noexcept;
    [[nodiscard]] double enabled_torque(double dt) noexcept;
    [[nodiscard]] double position_torque(double dt) noexcept;
    [[nodiscard]] double velocity_torque(double velocity, double acceleration, double limit, double dt) noexcept;
    // cia402_cyclic.cpp
    void take_position_target(const AxisInputs& in, double seconds) noexcept;
    void take_velocity_target(const AxisInputs& in) noexcept;
    void take_torque_target(const AxisInputs& in) noexcept;
    void take_torque_offset(const AxisInputs& in) noexcept;
    void interpolate(double dt) noexcept;
    [[nodiscard]] double with_offset(double torque) const noexcept;
    [[nodiscard]] double torque_of(std::int64_t raw) const noexcept;
    // cia402_travel.cpp
    [[nodiscard]] double within_software_limits(double wanted, const AxisInputs& in) noexcept;
    [[nodiscard]] bool limits_count(const AxisInputs& in) const noexcept;
    [[nodiscard]] int past_switch() const noexcept;
    [[nodiscard]] int past_software_limit(const AxisInputs& in) const noexcept;
    [[nodiscard]] double pushes(const AxisInputs& in) const noexcept;
    void watch_travel(const AxisInputs& in) noexcept;
    // cia402_homing.cpp
    void take_homing_start(const AxisInputs& in) noexcept;
    void homing_step(double dt) noexcept;
    void homing_failed() noexcept;
    void homing_attained() noexcept;
    [[nodiscard]] HomingView homing_view() const noexcept;
    // cia402_encoder.cpp
    void wake_encoder() noexcept;
    void watch_encoder() noexcept;
    void read_encoder() noexcept;
    [[nodiscard]] bool battery_low() const noexcept;
    [[nodiscard]] bool battery_warns() const noexcept;
    // cia402_profile.cpp
    void take_profile_position(const AxisInputs& in) noexcept;
    void take_profile_velocity(const AxisInputs& in) noexcept;
    void take_profile_torque(const AxisInputs& in) noexcept;
    void ramp_velocity(double dt) noexcept;
    void ramp_torque(double dt) noexcept;
    [[nodiscard]] bool ramps_velocity() const noexcept;
    [[nodiscard]] double speed_limit(const AxisInputs& in) const noexcept;
    [[nodiscard]] bool profile_reached() const noexcept;
    void watch_target() noexcept;
    // cia402_stopping.cpp
    [[nodiscard]] StopOrder stop_for(StopCause cause) const noexcept;
    [[nodiscard]] StopOrder undocumented_stop(StopCause cause) const noexcept;
    [[nodiscard]] double ramp_of(StopBy by) const noexcept;
    void begin_stop(const StopOrder& order) noexcept;
    void take_halt(const AxisInputs& in) noexcept;
    [[nodiscard]] double stopping_torque(double dt) noexcept;
    [[nodiscard]] double slowing_torque(double dt) noexcept;
    [[nodiscard]] double brake_torque() const noexcept;
    void end_stop() noexcept;
    [[nodiscard]] bool energised() const noexcept;
    [[nodiscard]] bool has_brake() const noexcept {
        return profile_->brake.hold > Duration::zero() || profile_->brake.moving_wait > Duration::zero();
    }
    [[nodiscard]] bool brake_told_to_close() const noexcept;
    [[nodiscard]] bool too_early() const noexcept { return now_ < commands_from_; }
    void wind_down(StopCause cause) noexcept;
    [[nodiscard]] bool starts_too_fast() const noexcept {
        return motor_.start_speed > 0 && std::abs(plant_.velocity()) > motor_.start_speed;
    }
    void step_brake() noexcept;
    // cia402_supervision.cpp
    void raise_or_warn(const AlarmCode& alarm) noexcept;
    void end_warning() noexcept;
    void supervise() noexcept;
    void watch_torque() noexcept;
    void supervise_torque() noexcept;
    // cia402_whole_drive.cpp
    [[nodiscard]] bool uncover_alarm() noexcept;
    // cia402_causes.cpp
    void begin_cause(std::size_t row) noexcept;
    void end_cause(std::size_t row) noexcept;
    void show_cause(const DriveAlarmText& row) noexcept;
    void show_causes() noexcept;
    [[nodiscard]] bool cause_lasts() const noexcept;
    [[nodiscard]] bool shows(const AlarmCode& alarm) const noexcept;
    void remember(const AlarmCode& alarm) noexcept;
    void clear_fault() noexcept;
    // cia402_status.cpp
    void fill(AxisOutputs& out) const noexcept;
    [[nodiscard]] std::uint16_t status_word() const noexcept;
    [[nodiscard]] std::uint16_t profile_bits() const noexcept;

    [[nodiscard]] bool has(Quirk quirk) const noexcept { return profile_->has(quirk); }
    [[nodiscard]] bool has_mode(DriveMode mode) const noexcept;

    std::shared_ptr<const DriveProfile> profile_;
    SimulatedMotor motor_;
    DriveAlarmCodes codes_;
    double velocity_unit_;       ///< raw 606Ch/60FFh = counts/s * this
    double brake_moving_speed_;  ///< counts/s
    double turn_ = 10000;        ///< counts per revolution; a gear may make it no whole number
    Plant plant_;
    ServoLoop loop_;
    std::optional<OpenLoopMotor> stepper_;  ///< the motor has no encoder
    SwitchInputs inputs_;
    HomingRun homing_;
    std::array<TouchProbe, 2> probes_;
    bool blank_ = false;
    State state_ = State::not_ready;
    Instant now_{};
    double zero_ = 0;  ///< plant position at which the drive counts 0
    std::int64_t mode_ = 0;
    Demand demand_;
    double demand_step_ = 0;  ///< counts per second towards the newest target
    double target_ = 0;       ///< newest CSP target, plant coordinates
    AxisInputs settings_;     ///< as of the last exchange
    StopOrder stop_;
    bool stop_done_ = false, halted_ = false, ramps_out_ = false, phases_shorted_ = false;
    ProfilePosition profile_position_;
    double velocity_target_ = 0, torque_target_ = 0;  ///< of the profile modes: what the ramps lead to
    bool limited_ = false;                            ///< bit 11: a target was clipped, or the motor is past a software limit
    int travel_stop_ = 0;                             ///< -1, 1: stopped behind the negative or positive end of the travel
    bool target_reached_ = false, reached_told_ = false;
    Instant in_window_since_{};
    std::optional<Instant> mode_changed_at_;
    std::int64_t steps_left_ = 0;  ///< inner steps until the target is reached
    double torque_ = 0, torque_demand_ = 0, torque_offset_ = 0, velocity_demand_ = 0;
    double torque_most_ = 0, torque_least_ = 0;  ///< N m, what the limits leave of it
    double fastest_ = 0;                         ///< counts/s, torque modes; 0 = no limit
    std::uint16_t last_control_ = 0, error_code_ = 0;
    std::uint32_t error_detail_ = 0;
    bool error_resettable_ = true, main_power_ = true, operational_ = false, homed_ = false, warning_ = false;
    bool homing_attained_ = false, homing_error_ = false, homing_bit_ = false;
    std::int64_t home_offset_ = 0, home_position_method_ = 0;
    AbsoluteEncoder encoder_;
    Battery battery_;
    std::optional<double> battery_volts_;
    bool encoder_fault_kept_ = false, encoder_reset_ordered_ = false;  ///< in the encoder, over power cycles (TSVM 7.2.1)
    double stored_shift_ = 0;                                          ///< EEPROM: what an absolute encoder reads where the drive counts 0
    AlarmCode encoder_complaint_;                                      ///< stands until reset_encoder(); code 0: none
    std::uint32_t strikes_ = 0;
    double largest_increment_ = 0;
    Instant commands_from_{};  ///< set-points are obeyed from here on
    Instant brake_opens_{};
    std::optional<Instant> self_test_ends_;
    bool reachable_ = false;
    bool common_alarm_ = false;  ///< the alarm shown is the whole drive's
    AlarmCode hidden_alarm_;     ///< the axis' own behind it; code 0: none
    Duration overload_lasts_{};  ///< above DriveProfile::torque_overload
    bool winding_down_ = false;  ///< power is to go, but the motor still stops or holds for the brake
    Instant winding_down_until_{};
    Instant power_went_{};      ///< last time that the motor had power
    Duration brake_closing_{};  ///< since the brake was told to
    bool brake_closed_ = false, encoder_failed_ = false;
    std::optional<bool> bus_opens_brake_;
    std::int64_t frozen_position_ = 0;
    std::uint32_t early_commands_ = 0;
    std::vector<bool> causes_;  ///< of each alarm of the profile
    WarningList warnings_;
    AlarmHistory history_;
    Instant powered_at_{};
    double following_limit_ = 0;  ///< counts; 0 = no check
    double heat_ = 0;             ///< I2t above the rated torque, in (rated torques)2 seconds
    Duration stalled_{};
};

}  // namespace taktwerk::axes::sim

#pragma once
// One axis of a simulated CiA 402 drive: power state machine, modes of operation, ways of stopping, alarms, in front of a servo loop and a
// plant. It answers because it computes. Knows no bus: axes/sim/cia402_device.hpp copies objects in and out. It joins its parts, each of which
// knows nothing of it; what happens to several of them at once stands here.
// Sources: CiA 402-2; what differs per drive is in its DriveProfile, with the manual's section in the drive sheets.

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "axes/sim/alarm_display.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/command_gate.hpp"
#include "axes/sim/count_origin.hpp"
#include "axes/sim/cyclic_target.hpp"
#include "axes/sim/drive_alarm_codes.hpp"
#include "axes/sim/drive_homing.hpp"
#include "axes/sim/drive_terminals.hpp"
#include "axes/sim/holding_brake.hpp"
#include "axes/sim/load_watch.hpp"
#include "axes/sim/mode_codes.hpp"
#include "axes/sim/motor_control.hpp"
#include "axes/sim/profile_position.hpp"
#include "axes/sim/stop_run.hpp"
#include "axes/sim/target_window.hpp"
#include "axes/sim/torque_target.hpp"
#include "axes/sim/travel_ends.hpp"
#include "axes/sim/velocity_target.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class Cia402Axis {
public:
    enum class State : std::uint8_t { not_ready, disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

    Cia402Axis(const PlantConfig& plant, std::shared_ptr<const DriveProfile> profile, const SimulatedMotor& motor);

    void power_on(Instant now) noexcept;
    /// Control supply gone: the motor is free, the state machine gone.
    void power_off() noexcept {
        supply_.operational = supply_.reachable = false;
        gate_.power_off();
        enter(State::not_ready);
    }
    /// Physics up to `now`.
    void advance(Instant now) noexcept;
    /// Newest outputs in, answers out; `cycle` is the time until the next exchange (SYNC0 cycle).
    void exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept;
    /// The bus left OP or fell silent.
    void communication_lost() noexcept;
    void operational(bool op) noexcept { supply_.operational = op; }
    /// PREOP or above: the control word can be reached.
    void reachable(bool is) noexcept { supply_.reachable = is; }
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
    void jam(bool jammed) noexcept { motor_.jam(jammed); }
    /// Nothing in front of the sensors at the probes, such as a web without print.
    void blank(bool blank) noexcept { terminals_.blank(blank); }

    /// Objects by which the drive changes while it runs: its unit of velocity (raw = counts/s times this) and what following error is an
    /// alarm [counts; 0 = none].
    void velocity_unit(double counts_per_unit) noexcept { motor_.velocity_unit(counts_per_unit); }
    void following_limit(double counts) noexcept { motor_.following_limit(counts); }

    /// How many of its counts are a turn of the motor: its electronic gear (SE-808X 2000h:02, SV33-E 6091h). The mechanics stay where they are,
    /// all counts are others from now on. Not while the motor has power.
    void scale(double counts_per_revolution) noexcept;

    /// A motor without an encoder: what the drive takes for its position is its own command. `standby`: share of its torque that holds it at
    /// standstill; nothing: it has an encoder. Before power_on().
    void open_loop(std::optional<double> standby) noexcept { motor_.open_loop(standby); }
    /// Terminals between the switches of the plant and 60FDh. Before power_on().
    void wire_inputs(const InputObjects& inputs, std::int64_t polarity) noexcept { terminals_.wire(inputs, polarity); }

    /// Of an absolute encoder; what an empty one has lost shows at the next power_on().
    void battery(Battery state) noexcept { origin_.battery(state); }
    /// The same by the battery's voltage, where the profile has the thresholds (TSVM 7.2: 3.1 V and 2.5 V).
    void battery_voltage(double volts) noexcept { origin_.battery_voltage(volts); }
    /// The encoder's own service, refused while the motor has power: what it complains of is forgotten, and its turns if asked for (SV33-E
    /// P20.05 = 1, 2; TSVM control word bit 12 does the second).
    void reset_encoder() noexcept;
    void clear_turns() noexcept;
    /// The same for a drive that sees it at its next power_on() only (TSVM 7.2.1: PA80).
    void order_encoder_reset() noexcept;

    [[nodiscard]] const Plant& plant() const noexcept { return motor_.plant(); }
    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] std::uint16_t error_code() const noexcept { return alarms_.code(); }
    /// Largest CSP target step between two exchanges while enabled, counts. What a jump of the master would show in.
    [[nodiscard]] double largest_increment() const noexcept { return cyclic_.largest_increment(); }
    /// Set-points and homing starts that came before the brake was open and were lost. A careful master causes none.
    [[nodiscard]] std::uint32_t early_commands() const noexcept { return gate_.lost(); }
    [[nodiscard]] bool brake_closed() const noexcept { return brake_.closed(); }
    /// The master works the brake, through an object or past the drive; until it says so the drive does.
    void brake_by_bus(bool open) noexcept { brake_.by_bus(open); }
    [[nodiscard]] bool stands() const noexcept { return motor_.stands(); }
    /// What the drive's input for this probe sees, and whether the encoder stands on its index pulse.
    [[nodiscard]] bool probe_input(std::size_t probe) const noexcept { return terminals_.probe_input(plant(), probe); }
    [[nodiscard]] bool at_index_pulse() const noexcept;
    /// The motor is powered: parameters that change at standstill only are refused.
    [[nodiscard]] bool powered() const noexcept { return energised(); }
    [[nodiscard]] const AlarmHistory& history() const noexcept { return alarms_.history(); }
    [[nodiscard]] bool alarm_stands() const noexcept { return alarms_.stands(); }
    [[nodiscard]] double counts_per_revolution() const noexcept { return static_cast<double>(motor_.motor().counts_per_revolution); }

private:
    // cia402_axis.cpp
    void inner_step() noexcept;
    [[nodiscard]] double actual() const noexcept { return motor_.position() - origin_.zero(); }
    [[nodiscard]] std::int64_t counted() const noexcept { return static_cast<std::int64_t>(std::floor(actual())); }
    // cia402_power.cpp
    void command(const AxisInputs& in) noexcept;
    void end_self_test() noexcept;
    void enter(State state) noexcept;
    [[nodiscard]] bool energised() const noexcept;
    // cia402_modes.cpp
    void select_mode(const AxisInputs& in) noexcept;
    void take_targets(const AxisInputs& in, Duration cycle) noexcept;
    [[nodiscard]] bool may_change_mode() noexcept;
    void forget_targets() noexcept;
    [[nodiscard]] bool stops_before_mode_change() noexcept;
    [[nodiscard]] double enabled_torque(double dt) noexcept;
    [[nodiscard]] bool has_mode(DriveMode mode) const noexcept;
    // cia402_cyclic.cpp
    void take_position_target(const AxisInputs& in, double seconds) noexcept;
    void take_velocity_target(const AxisInputs& in) noexcept;
    void take_torque_target(const AxisInputs& in) noexcept;
    void take_torque_offset(const AxisInputs& in) noexcept;
    [[nodiscard]] bool at_limit_switch(double wanted) noexcept;
    void interpolate(double dt) noexcept;
    // cia402_travel.cpp
    [[nodiscard]] double pushes(const AxisInputs& in) const noexcept;
    void watch_travel(const AxisInputs& in) noexcept;
    void warn_at_switch(int end) noexcept;
    // cia402_homing.cpp
    void take_homing_start(const AxisInputs& in) noexcept;
    void homing_step(double dt) noexcept;
    void homing_failed() noexcept;
    [[nodiscard]] HomingView homing_view() const noexcept;
    // cia402_profile.cpp
    void take_profile_position(const AxisInputs& in) noexcept;
    void take_profile_velocity(const AxisInputs& in) noexcept;
    void take_profile_torque(const AxisInputs& in) noexcept;
    void ramp_velocity(double dt) noexcept;
    [[nodiscard]] bool ramps_velocity() const noexcept;
    [[nodiscard]] bool profile_reached() const noexcept;
    void watch_target() noexcept;
    // cia402_stopping.cpp
    [[nodiscard]] StopOrder stop_for(StopCause cause) const noexcept;
    void begin_stop(const StopOrder& order) noexcept;
    void take_halt(const AxisInputs& in) noexcept;
    [[nodiscard]] double stopping_torque(double dt) noexcept;
    void end_stop() noexcept;
    void wind_down(StopCause cause) noexcept;
    void step_brake() noexcept;
    // cia402_supervision.cpp
    void raise_or_warn(const AlarmCode& alarm) noexcept;
    void raise_if_known(DriveAlarmKind kind) noexcept;
    void supervise() noexcept;
    void supervise_load() noexcept;
    void supervise_encoder() noexcept;
    [[nodiscard]] double following_limit() const noexcept;
    // cia402_causes.cpp
    void begin_cause(std::size_t row) noexcept;
    void end_cause(std::size_t row) noexcept;
    void show_cause(const DriveAlarmText& row) noexcept;
    void show_causes() noexcept;
    [[nodiscard]] bool cause_lasts() const noexcept;
    void clear_fault() noexcept;
    // cia402_status.cpp
    void fill(AxisOutputs& out) const noexcept;
    [[nodiscard]] std::uint16_t status_word() const noexcept;
    [[nodiscard]] std::uint16_t mode_bits() const noexcept;
    [[nodiscard]] std::uint16_t profile_bits() const noexcept;

    [[nodiscard]] bool has(Quirk quirk) const noexcept { return profile_->has(quirk); }

    /// What comes to the drive from outside, beside set-points; it shows in its status.
    struct Supply {
        bool main_power = true;
        bool operational = false, reachable = false;  ///< as the bus says
    };

    std::shared_ptr<const DriveProfile> profile_;
    DriveAlarmCodes codes_;
    MotorControl motor_;
    CountOrigin origin_;
    HoldingBrake brake_;
    DriveTerminals terminals_;
    Supply supply_;
    State state_ = State::not_ready;
    Instant now_{};
    AxisInputs settings_;  ///< as of the last exchange
    std::uint16_t last_control_ = 0;
    CommandGate gate_;
    std::int64_t mode_ = 0;
    std::optional<Instant> mode_changed_at_;
    // What the modes lead to.
    CyclicTarget cyclic_;
    ProfilePosition profile_position_;
    VelocityTarget velocity_;
    TorqueTarget torque_;
    TargetWindow window_;
    DriveHoming homing_;
    // What stops it.
    StopRun stop_;
    TravelEnds travel_;
    LoadWatch load_;
    AlarmDisplay alarms_;
    std::vector<bool> causes_;  ///< of each alarm of the profile
};

}  // namespace taktwerk::axes::sim

#pragma once
// A simulated XP200 without its port: power, enabling, speed, torque and position mode, ramps, limits, brake, alarms, outputs, status
// registers; in front of the plant. It answers because it computes. Sections are those of the user manual V1.0.
//
//   off --mains--> starting (1.5 s) --> ready <--> enabled --> stopping --> ready        alarm: from anywhere, until cleared or switched off

#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/plant.hpp"
#include "axes/sim/servo_loop.hpp"
#include "axes/sim/xp200/alarm_state.hpp"
#include "axes/sim/xp200/brake_output.hpp"
#include "axes/sim/xp200/counting_encoder.hpp"
#include "axes/sim/xp200/inputs.hpp"
#include "axes/sim/xp200/motor_load.hpp"
#include "axes/sim/xp200/options.hpp"
#include "axes/sim/xp200/parameters.hpp"
#include "axes/sim/xp200/pulse_command.hpp"
#include "axes/sim/xp200/saving_run.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

using axes::xp200::Output;

class Servo {
public:
    enum class State : std::uint8_t {
        off,
        starting,
        ready,     ///< SRDY, no current
        enabled,   ///< current on
        stopping,  ///< decelerates by Pr063 or holds for the brake, then current off
        alarm,
    };
    enum class Mode : std::uint8_t { position, speed, torque };

    /// The profile's rows and alarms; `plant` of the motor behind it.
    Servo(const DriveProfile& profile, const PlantConfig& plant, const Options& options);

    void power_on(Instant now) noexcept;
    /// Mains and control supply are one (4.1): memory, position and current are gone. While it saves: alarm 20 at the next power on (6.1).
    void power_off() noexcept;
    /// Physics and logic up to `now`.
    void advance(Instant now) noexcept;

    // --- what the port asks ------------------------------------------------------------------------------------------------
    [[nodiscard]] Parameters& parameters() noexcept { return parameters_; }
    [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }
    void enable_by_port(bool on) noexcept { port_enable_ = on; }             ///< 9.6.7
    void clear_alarm() noexcept;                                             ///< 9.6.8, and ACLR's edge
    void begin_saving() noexcept { saving_.begin(now_ + options_.saving); }  ///< 9.6.6
    [[nodiscard]] bool saving() const noexcept { return saving_.busy(now_); }
    [[nodiscard]] std::uint16_t status(std::uint16_t index) const noexcept;

    // --- the world around it -----------------------------------------------------------------------------------------------
    [[nodiscard]] Inputs& inputs() noexcept { return inputs_; }
    [[nodiscard]] bool output(int terminal) const noexcept;  ///< DO1 (0) to DO4 (3) conducts
    void raise(std::uint16_t alarm) noexcept;
    /// The cause of an alarm is there until it is released: cleared or switched off and on before, the alarm comes again at once.
    void provoke(std::uint16_t alarm) noexcept {
        alarms_.cause(alarm);
        raise(alarm);
    }
    void release() noexcept { alarms_.cause(0); }
    void undervoltage() noexcept { raise(3); }
    /// The encoder shows the same position for ever after, until power_on().
    void break_encoder() noexcept;
    void jam(bool jammed) noexcept { plant_.jam(jammed); }
    /// Command pulses for position mode, before the gear (4.2).
    void pulses(std::int64_t count) noexcept { pulses_.add(count); }

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] Mode mode() const noexcept;
    [[nodiscard]] std::uint16_t alarm() const noexcept { return alarms_.code(); }
    [[nodiscard]] bool energised() const noexcept { return current_on_; }
    [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
    [[nodiscard]] double speed() const noexcept;                             ///< r/min
    [[nodiscard]] double speed_command() const noexcept { return ramped_; }  ///< r/min, behind the ramp
    /// Enabled while the motor turned (5.5 forbids it). A careful host causes none.
    [[nodiscard]] std::uint32_t enabled_in_motion() const noexcept { return enabled_in_motion_; }
    [[nodiscard]] const Options& options() const noexcept { return options_; }

private:
    [[nodiscard]] std::int64_t p(std::uint16_t number) const noexcept { return parameters_[number]; }
    [[nodiscard]] double counts_per_turn() const noexcept { return 4.0 * static_cast<double>(p(axes::xp200::pr::encoder_lines)); }
    [[nodiscard]] std::int64_t position() const noexcept { return encoder_.position(plant_.position()); }
    [[nodiscard]] bool on(Output function) const noexcept;
    [[nodiscard]] bool limit_used(bool ccw) const noexcept;
    [[nodiscard]] bool allowed(bool ccw) const noexcept;
    [[nodiscard]] double wanted_speed() const noexcept;
    [[nodiscard]] double wanted_torque() const noexcept;
    [[nodiscard]] double limited_by_speed(double torque) const noexcept;
    [[nodiscard]] double most_torque(bool ccw) const noexcept;
    void step() noexcept;
    void run_state() noexcept;
    void leave_enabled() noexcept;
    void switch_current(bool on) noexcept;
    void run_brake() noexcept;
    void ramp(double target, double up_ms, double down_ms) noexcept;
    [[nodiscard]] double drive_torque() noexcept;
    [[nodiscard]] double position_torque() noexcept;
    void take_pulses() noexcept;
    void watch() noexcept;

    Options options_;
    AlarmState alarms_;
    Parameters parameters_;
    SavingRun saving_;
    Inputs inputs_;
    Plant plant_;
    ServoLoop loop_;
    State state_ = State::off;
    Instant now_{}, ready_at_{};
    bool port_enable_ = false, current_on_ = false, clear_was_on_ = false;
    std::uint32_t enabled_in_motion_ = 0;

    CountingEncoder encoder_;
    PulseCommand pulses_;
    double ramped_ = 0;  // r/min
    double torque_ = 0;  // N m at the shaft
    bool clamped_ = false;
    double clamp_at_ = 0;  // plant position

    BrakeOutput brake_;
    bool holds_for_brake_ = false;
    Instant stop_until_{};
    MotorLoad load_;
};

}  // namespace taktwerk::axes::sim::xp200

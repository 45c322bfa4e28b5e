#pragma once
// The motor of a simulated drive with the loops in front of it: what is demanded of it, which torque it gets, what the drive takes for its
// place and speed, and what its raw numbers mean in counts/s and N m. Positions are counts in the plant's coordinates.

#include <cmath>
#include <cstdint>
#include <optional>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/index_pulse.hpp"
#include "axes/sim/open_loop_motor.hpp"
#include "axes/sim/plant.hpp"
#include "axes/sim/servo_loop.hpp"
#include "axes/sim/simulated_motor.hpp"

namespace taktwerk::axes::sim {

class MotorControl {
public:
    MotorControl(const PlantConfig& plant, const SimulatedMotor& motor, const DriveProfile& profile) noexcept;

    [[nodiscard]] const Plant& plant() const noexcept { return plant_; }
    [[nodiscard]] const SimulatedMotor& motor() const noexcept { return motor_; }
    void jam(bool jammed) noexcept { plant_.jam(jammed); }
    void hold(bool held) noexcept { plant_.hold(held); }
    /// Counts, where no object says it; 0 = no check.
    void following_limit(double counts) noexcept { motor_.following_error_limit = counts; }
    /// Others count a turn from now on; says by which factor.
    double rescale(double counts_per_revolution) noexcept;
    /// The motor has no encoder: the drive takes its own command for the position. `standby`: share of the torque at standstill.
    void open_loop(std::optional<double> standby) noexcept;
    [[nodiscard]] bool without_encoder() const noexcept { return stepper_.has_value(); }

    // --- what the drive takes for the place and the speed of its motor ------------------------------------------------------
    [[nodiscard]] double position() const noexcept { return stepper_ ? demand_.position : plant_.position(); }
    [[nodiscard]] double velocity() const noexcept { return stepper_ ? demand_.velocity : plant_.velocity(); }
    [[nodiscard]] bool stands() const noexcept;
    [[nodiscard]] bool too_fast_to_start() const noexcept;
    [[nodiscard]] IndexPulses index_pulses() const noexcept { return {plant_.config().index_pulse, turn_}; }

    // --- raw numbers of the bus ---------------------------------------------------------------------------------------------
    /// raw 606Ch, 60FFh = counts/s times this.
    void velocity_unit(double counts_per_unit) noexcept { velocity_unit_ = counts_per_unit; }
    [[nodiscard]] double velocity_of(std::int64_t raw) const noexcept { return static_cast<double>(raw) / velocity_unit_; }
    [[nodiscard]] double torque_of(std::int64_t raw) const noexcept;
    [[nodiscard]] std::int64_t raw_velocity() const noexcept { return std::llround(velocity() * velocity_unit_); }
    /// What 6077h shows: the mean since the exchange before. A drive measures its current far more often than the bus asks, and what a velocity
    /// feed-forward in steps of the bus cycle makes of the torque is gone from the mean alone (assumed: no manual says how it is filtered).
    void tell_torque() noexcept;
    /// Without an encoder nothing tells the drive what the load takes: 0.
    [[nodiscard]] std::int64_t raw_torque() const noexcept;
    /// counts/s that 607Fh and 6080h leave; infinity: no limit.
    [[nodiscard]] double speed_limit(const AxisInputs& in) const noexcept;

    // --- the demand of the loops --------------------------------------------------------------------------------------------
    [[nodiscard]] const Demand& demand() const noexcept { return demand_; }
    void demand(const Demand& wanted) noexcept { demand_ = wanted; }
    /// From where the motor is, at rest or with the speed that it has.
    void demand_rest() noexcept { demand_ = {position(), 0, 0}; }
    void demand_motion() noexcept { demand_ = {position(), velocity(), 0}; }
    /// How far the motor is from the demand, without sign.
    [[nodiscard]] double deviation() const noexcept { return std::abs(demand_.position - position()); }

    // --- torque, N m --------------------------------------------------------------------------------------------------------
    /// What the motor can give at most.
    [[nodiscard]] double torque_limit() const noexcept { return plant_.config().rated_torque * plant_.config().maximum_torque; }
    /// What 6072h, 60E0h, 60E1h leave of it, in every mode (SV-DA200 2.1 note 9).
    void limit_torque(const AxisInputs& in) noexcept;
    /// The last step's.
    [[nodiscard]] double torque() const noexcept { return torque_; }
    /// The same in rated torques.
    [[nodiscard]] double load() const noexcept { return torque_ / plant_.config().rated_torque; }

    /// Of the position loop towards the demand; the encoder's counts begin at `zero`.
    [[nodiscard]] double position_torque(double zero, double dt) noexcept;
    /// Of a motor without an encoder the field turns with that velocity, whatever the rotor does.
    [[nodiscard]] double velocity_torque(double velocity, double acceleration, double limit, double dt) noexcept;
    /// Shorted phases.
    [[nodiscard]] double brake_torque() const noexcept;
    /// The integral of the loop is of no use any more; or it goes on from the torque that there is.
    void forget_integral() noexcept { loop_.reset(); }
    void keep_torque() noexcept { loop_.take_over(torque_); }

    /// Takes `torque`, as far as the limits leave it.
    void give(double torque) noexcept;
    /// The power stage gives none: the field of a motor without an encoder is off.
    void release_field() noexcept;
    /// Physics of one inner step.
    void turn(double dt) noexcept {
        plant_.step(dt, torque_);
        impulse_ += torque_ * dt;
        since_told_ += dt;
    }

private:
    SimulatedMotor motor_;
    double velocity_unit_;     ///< raw = counts/s * this
    double torque_rated_raw_;  ///< raw value of the rated torque
    double turn_;              ///< counts per revolution; a gear may make it no whole number
    Plant plant_;
    ServoLoop loop_;
    std::optional<OpenLoopMotor> stepper_;
    Demand demand_;
    double torque_ = 0, torque_most_ = 0, torque_least_ = 0;
    double told_torque_ = 0, impulse_ = 0, since_told_ = 0;  // N m; N m s, s since the exchange before
};

}  // namespace taktwerk::axes::sim

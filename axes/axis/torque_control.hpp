#pragma once
// The torque of MC_TorqueControl: a ramp towards the commanded torque, between two bounds that keep the velocity and its changes inside
// their limits. Pure and real-time safe; torques are fractions of rated torque, positive in the axis' positive sense.
//
// Each bound is the torque of a velocity controller whose reference follows the motor, but never changes faster than acceleration or
// deceleration allow and ends at the velocity limit. As long as the commanded torque lies between the bounds it is the torque; where it
// would drive the motor away faster than the reference, the controller takes over (P1-180). Load and friction are known to both from an
// observer: the torque that the motor's acceleration does not account for.

#include <limits>

#include "core/time.hpp"

namespace taktwerk::axes {

struct TorqueLimits {
    double velocity = 0;                        ///< u/s, > 0
    double acceleration = 0, deceleration = 0;  ///< u/s2, while torque and velocity have the same sign; the opposite one (P1-183)
};

/// Which velocities the torque may cause.
enum class TorqueSense : std::uint8_t {
    both,           ///< up to the limit in both senses
    only_positive,  ///< a brake for positive velocities: never below 0 (P1-187)
    only_negative,
};

class TorqueControl {
public:
    /// `inertia`: rated torques per u/s2, > 0 makes the velocity limits hold here; 0: ramp only, the drive limits the velocity.
    /// `bandwidth` of the velocity controllers, 1/s: a tenth of the cycle rate leaves room for a few cycles of dead time, and for an
    /// inertia that is wrong by a factor of two.
    TorqueControl(double inertia, double bandwidth) noexcept : inertia_(inertia), bandwidth_(bandwidth) {}

    /// From the torque, velocity and acceleration of this moment: what the acceleration does not account for is load, so that a web's
    /// pull or a hanging weight is held from the first cycle on.
    void start(double torque_now, double velocity_now, double acceleration_now = 0) noexcept;
    void command(double torque, double ramp, const TorqueLimits& limits, TorqueSense sense) noexcept;
    /// Ends the motion with the deceleration instead: both bounds close in on standstill. Without an inertia: torque 0.
    void brake(double deceleration) noexcept;

    /// Whatever is commanded, no more than this in each direction: magnitudes, infinity = no bound.
    void keep_within(double positive, double negative) noexcept {
        most_ = positive;
        least_ = -negative;
    }

    /// One period with the velocity as measured; the torque to set.
    [[nodiscard]] double step(double velocity, Duration period) noexcept;

    [[nodiscard]] double torque() const noexcept { return torque_; }
    /// The set torque is the commanded one (InTorque, P1-179).
    [[nodiscard]] bool in_torque() const noexcept { return in_torque_; }
    /// The velocity, or a torque limit, holds it back.
    [[nodiscard]] bool limited() const noexcept { return limited_; }

private:
    [[nodiscard]] double bound(double& reference, double velocity, double top, double dt) const noexcept;
    void observe(double velocity, double dt) noexcept;

    double inertia_, bandwidth_;
    double ramped_ = 0;  // the command on its ramp
    double torque_ = 0;
    double wanted_ = 0, ramp_ = 0;
    double most_ = std::numeric_limits<double>::infinity(), least_ = -std::numeric_limits<double>::infinity();
    TorqueLimits limits_;
    TorqueSense sense_ = TorqueSense::both;
    bool braking_ = false;
    bool in_torque_ = false, limited_ = false;
    double high_ = 0, low_ = 0;                         // references, u/s; the low one with its sign turned
    double observed_velocity_ = 0, observed_load_ = 0;  // u/s, rated torques
};

}  // namespace taktwerk::axes

#pragma once
// What goes to the drive, at the end of a cycle.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/following_watch.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/load_feed_forward.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"
#include "axes/axis/position_integral.hpp"

namespace taktwerk::axes {

class AxisHoming;
class AxisParameters;
class AxisProbes;
class AxisReset;
class TorqueBounds;

class DriveOutput {
public:
    DriveOutput(const AxisBody& body, Measured& measured, const AxisMotion& motion, ModeState& modes, const HomingRuns& runs,
                const AxisHoming& homing, const AxisReset& reset, AxisProbes& probes, const AxisParameters& parameters,
                TorqueBounds& bounds, FollowingWatch& following) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          modes_(modes),
          runs_(runs),
          homing_(homing),
          reset_(reset),
          probes_(probes),
          parameters_(parameters),
          bounds_(bounds),
          following_(following) {}

    void encode(Instant now) noexcept;
    /// The same for a position, where nothing but the set-point can have changed since encode().
    void encode_setpoint(Instant now) noexcept;

    /// Weight or friction are fed forward: the torque is another one than the acceleration's.
    [[nodiscard]] bool feeds_load() const noexcept { return load_.used(); }
    /// The newest one.
    [[nodiscard]] const DriveCommand& command() const noexcept { return command_; }

private:
    void fill_targets() noexcept;
    [[nodiscard]] double integral_part(double given, double most, bool closed) noexcept;
    void fill_torque() noexcept;
    void fill_drive_profile() noexcept;
    void fill_torque_limits() noexcept;

    DriveCommand command_;
    const AxisBody& body_;
    double torque_per_acceleration_ =  // fraction of rated torque for 1 u/s2, fed forward
        (body_.config.gearing.inverted ? -1.0 : 1.0) * body_.config.control.torque_feed_forward * body_.config.control.inertia();
    Measured& measured_;
    const AxisMotion& motion_;
    ModeState& modes_;
    const HomingRuns& runs_;
    const AxisHoming& homing_;
    const AxisReset& reset_;
    AxisProbes& probes_;
    const AxisParameters& parameters_;
    TorqueBounds& bounds_;
    FollowingWatch& following_;
    IntegralPart integral_{body_.config.control.integral, body_.config.control.kv, body_.config.limits.velocity};
    LoadFeedForward load_{body_.config.control.load, body_.config.limits.velocity};
};

}  // namespace taktwerk::axes

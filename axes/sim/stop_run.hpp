#pragma once
// A motor that is brought to rest instead of following: by quick stop, halt, fault, the end of its travel, before another mode, or because its
// power is to go. How it slows down is a StopOrder; then something holds it, or nothing does.

#include "axes/sim/axis_objects.hpp"
#include "axes/sim/motor_control.hpp"
#include "axes/sim/stop_order.hpp"
#include "axes/sim/torque_target.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

/// What a stop depends on beside the motor.
struct StopView {
    const AxisInputs& settings;  ///< as of the last exchange
    bool enabled = false;        ///< Operation enabled
    double zero = 0;             ///< where the drive counts 0
};

class StopRun {
public:
    void power_on() noexcept { winding_down_ = phases_shorted_ = false; }
    void begin(const StopOrder& order) noexcept {
        order_ = order;
        done_ = false;
    }
    [[nodiscard]] const StopOrder& order() const noexcept { return order_; }
    /// The motor has come to rest.
    [[nodiscard]] bool done() const noexcept { return done_; }
    /// Torque of one inner step.
    double torque(MotorControl& motor, TorqueTarget& target, const StopView& view, double dt) noexcept;
    /// Nothing is left to wait for: it runs out, or has stopped.
    [[nodiscard]] bool over() const noexcept { return order_.by == StopBy::coast || done_; }

    /// Bit 8 of the control word.
    void halt(bool on) noexcept { halted_ = on; }
    [[nodiscard]] bool halted() const noexcept { return halted_; }
    /// A ramp before another mode.
    void ramp_out(bool on) noexcept { ramps_out_ = on; }
    [[nodiscard]] bool ramps_out() const noexcept { return ramps_out_; }
    [[nodiscard]] bool holds_up() const noexcept { return halted_ || ramps_out_; }
    void follow_again() noexcept { halted_ = ramps_out_ = false; }

    /// Power is to go by this order, when the motor stands at the earliest at `until`; false: at once.
    bool wind_down(const StopOrder& order, bool holds, Instant until) noexcept;
    /// Power is there to stay, or gone.
    void wind_no_longer() noexcept { winding_down_ = false; }
    /// One inner step; `hold`: from standstill until power goes.
    void step(bool stands, Instant now, Duration hold) noexcept;
    [[nodiscard]] bool winding_down() const noexcept { return winding_down_; }

    /// Without power the motor's phases are shorted, as the order says, or free.
    void short_phases() noexcept { phases_shorted_ = order_.then == StopThen::dynamic_brake; }
    void free_phases() noexcept { phases_shorted_ = false; }
    [[nodiscard]] bool phases_shorted() const noexcept { return phases_shorted_; }

private:
    [[nodiscard]] double slowing_torque(MotorControl& motor, TorqueTarget& target, const AxisInputs& settings, double dt) const noexcept;

    StopOrder order_;
    bool done_ = false, halted_ = false, ramps_out_ = false, phases_shorted_ = false;
    bool winding_down_ = false;  ///< power is to go, but the motor still stops or holds for the brake
    Instant winding_down_until_{};
};

}  // namespace taktwerk::axes::sim

#pragma once
// A motor at an amplifier over +-10 V: its velocity follows the voltage like a first-order lag, drift and all; without its enable it coasts. Pure
// logic, exact between two looks; real-time safe.

#include <limits>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class AnalogMotor {
public:
    explicit AnalogMotor(const AxisBinding& binding) noexcept;

    /// `time` goes by at this voltage.
    void run(double volts, bool enabled, bool brake_holds, Duration time) noexcept;

    [[nodiscard]] double position() const noexcept { return position_; }  ///< u, machine coordinates
    [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< u/s
    /// u that its encoder is turned: where it is wired the other way round, against the motor.
    [[nodiscard]] double shown() const noexcept { return simulation_.analog.reversed ? 2 * simulation_.start - position_ : position_; }
    [[nodiscard]] bool negative_limit() const noexcept { return simulation_.negative_limit && position_ <= *simulation_.negative_limit; }
    [[nodiscard]] bool positive_limit() const noexcept { return simulation_.positive_limit && position_ >= *simulation_.positive_limit; }
    [[nodiscard]] bool home_switch() const noexcept {
        return simulation_.home_from && simulation_.home_to && position_ >= *simulation_.home_from && position_ <= *simulation_.home_to;
    }
    [[nodiscard]] bool ready() const noexcept { return main_power_ && !fault_; }
    [[nodiscard]] bool fault() const noexcept { return fault_; }

    void raise(bool fault) noexcept { fault_ = fault; }
    void main_power(bool on) noexcept { main_power_ = on; }
    void jam(bool jammed) noexcept { jammed_ = jammed; }

private:
    void lag(double towards, double time_constant, double seconds) noexcept;

    AnalogAxis analog_;
    AxisSimulation simulation_;
    double position_, velocity_ = 0;
    bool main_power_ = true, fault_ = false, jammed_ = false;
};

}  // namespace taktwerk::runtime

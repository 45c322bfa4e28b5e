#pragma once
// The terminals of a simulated drive: switches of the travel, and the two touch probes with what stands in front of them.

#include <array>
#include <cstddef>
#include <cstdint>

#include "axes/sim/axis_objects.hpp"
#include "axes/sim/motor_control.hpp"
#include "axes/sim/switch_inputs.hpp"
#include "axes/sim/touch_probe.hpp"

namespace taktwerk::axes::sim {

class DriveTerminals {
public:
    explicit DriveTerminals(ProbeToggle toggle) noexcept : probes_{TouchProbe(toggle), TouchProbe(toggle)} {}

    /// Terminals between the switches of the plant and 60FDh. Before power_on().
    void wire(const InputObjects& inputs, std::int64_t polarity) noexcept { inputs_.wire(inputs, polarity); }
    void power_on(const Plant& plant) noexcept;
    /// Nothing in front of the sensors at the probes.
    void blank(bool blank) noexcept { blank_ = blank; }

    /// One inner step, in which the motor came from `before`; the drive counts 0 at `zero`.
    void step(const MotorControl& motor, double before, double zero) noexcept;
    /// 60B8h.
    void command(std::uint16_t function) noexcept;

    [[nodiscard]] const SwitchStates& switches() const noexcept { return inputs_.states(); }
    /// What the input of this probe sees.
    [[nodiscard]] bool probe_input(const Plant& plant, std::size_t probe) const noexcept;
    /// 60B9h, 60BAh to 60BDh, 60FDh.
    void fill(AxisOutputs& out) const noexcept;

private:
    void read_switches(const Plant& plant, Duration dt) noexcept;
    [[nodiscard]] ProbeSignal signal(const Plant& plant, std::size_t probe) const noexcept;

    SwitchInputs inputs_;
    std::array<TouchProbe, 2> probes_;
    bool blank_ = false;
};

}  // namespace taktwerk::axes::sim

#include "axes/sim/drive_terminals.hpp"

#include "axes/sim/inner_step.hpp"

namespace taktwerk::axes::sim {

void DriveTerminals::power_on(const Plant& plant) noexcept {
    read_switches(plant, {});
    for (auto& probe : probes_) probe.command(0);
}

void DriveTerminals::read_switches(const Plant& plant, Duration dt) noexcept {
    inputs_.step({plant.negative_limit(), plant.positive_limit(), plant.home_switch()}, dt);
}

/// Probes see the drive's counts, as the latched position is.
void DriveTerminals::step(const MotorControl& motor, double before, double zero) noexcept {
    const auto& plant = motor.plant();
    read_switches(plant, inner_period);
    auto pulses = motor.index_pulses();
    pulses.at -= zero;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const auto seen = signal(plant, i);
        probes_[i].motion(before - zero, plant.position() - zero, {seen.from - zero, seen.to - zero}, pulses);
    }
}

void DriveTerminals::command(std::uint16_t function) noexcept {
    for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].command(static_cast<std::uint8_t>(function >> (8 * i)));
}

ProbeSignal DriveTerminals::signal(const Plant& plant, std::size_t probe) const noexcept {
    const auto& seen = plant.config().probe[probe];
    return blank_ ? ProbeSignal{} : nearest({seen.from, seen.to}, seen.every, plant.position());
}

bool DriveTerminals::probe_input(const Plant& plant, std::size_t probe) const noexcept {
    const auto seen = signal(plant, probe);
    return seen.from <= plant.position() && plant.position() <= seen.to;
}

void DriveTerminals::fill(AxisOutputs& out) const noexcept {
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        out.probe_status = static_cast<std::uint16_t>(out.probe_status | probes_[i].status() << (8 * i));
        out.probe_rising[i] = probes_[i].rising();
        out.probe_falling[i] = probes_[i].falling();
    }
    const auto& seen = switches();
    out.digital_inputs = (seen.negative_limit ? 1u : 0u) | (seen.positive_limit ? 2u : 0u) | (seen.home ? 4u : 0u);
}

}  // namespace taktwerk::axes::sim

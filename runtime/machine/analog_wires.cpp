#include "runtime/machine/analog_wires.hpp"

#include <algorithm>
#include <utility>

#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

int AnalogWires::point(IoDirection direction, const std::string& name, std::vector<std::size_t>& slaves) const {
    const int found = name.empty() ? -1 : body_.io.find(direction, name);
    if (found < 0) return found;
    const auto& slave = body_.io.point(direction, static_cast<std::size_t>(found)).slave;
    for (std::size_t s = 0; s < body_.bus.slave_count(); ++s)
        if (body_.bus.slave(s).name == slave && std::find(slaves.begin(), slaves.end(), s) == slaves.end()) slaves.push_back(s);
    return found;
}

std::unique_ptr<axes::DrivePort> AnalogWires::add(const AxisBinding& binding, std::unique_ptr<axes::DrivePort> encoder) {
    using enum IoDirection;
    const auto& analog = *binding.analog;
    const auto& axis = binding.axis;
    auto port = std::make_unique<axes::analog::AnalogPort>(std::move(encoder), analog.drive, axis.gearing.counts_per_unit(),
                                                           analog.drive.runaway(axis.limits.velocity), analog.has_switches());
    Wires wires{};
    wires.port = port.get();
    wires.has_switches = analog.has_switches();
    wires.setpoint = point(output, analog.setpoint, wires.slaves);
    wires.enable = point(output, analog.enable, wires.slaves);
    wires.reset = point(output, analog.reset, wires.slaves);
    wires.ready = point(input, analog.ready, wires.slaves);
    wires.fault = point(input, analog.fault, wires.slaves);
    wires.negative_limit = point(input, analog.negative_limit, wires.slaves);
    wires.positive_limit = point(input, analog.positive_limit, wires.slaves);
    wires.home_switch = point(input, analog.home_switch, wires.slaves);
    wires.patience = supervised_limit(body_.config, axis.patience.feedback);
    wires_.push_back(std::move(wires));
    return port;
}

void AnalogWires::join_capabilities() noexcept {
    for (const auto& wires : wires_) wires.port->join_capabilities();
}

bool AnalogWires::reachable(const Wires& wires) const noexcept {
    return std::all_of(wires.slaves.begin(), wires.slaves.end(), [&](std::size_t slave) {
        const auto& health = body_.bus.health(slave);
        return health.al_state == ecat::AlState::op && !health.al_error && health.age <= wires.patience;
    });
}

void AnalogWires::read() noexcept {
    for (const auto& wires : wires_) {
        const auto is = [&](int input) { return input >= 0 && on(input); };
        wires.port->wires({.reachable = reachable(wires),
                           .ready = wires.ready < 0 || on(wires.ready),
                           .fault = is(wires.fault),
                           .has_switches = wires.has_switches,
                           .negative_limit = is(wires.negative_limit),
                           .positive_limit = is(wires.positive_limit),
                           .home_switch = is(wires.home_switch)});
    }
}

void AnalogWires::write() noexcept {
    auto& io = body_.io;
    for (const auto& wires : wires_) {
        const auto& given = std::as_const(*wires.port).wires();
        io.set_output(static_cast<std::size_t>(wires.setpoint), given.volts);
        io.outputs()[static_cast<std::size_t>(wires.enable)] = given.enable ? 1 : 0;
        if (wires.reset >= 0) io.outputs()[static_cast<std::size_t>(wires.reset)] = given.reset ? 1 : 0;
    }
}

}  // namespace taktwerk::runtime

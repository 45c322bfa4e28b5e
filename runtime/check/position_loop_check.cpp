#include "runtime/check/position_loop_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/check/mapped_objects.hpp"

namespace taktwerk::runtime {

namespace {

// Of kv times the time between two exchanges. An actual value is acted on one exchange later at the earliest: a loop of one integrator with a delay of one
// sample is unstable from 1 on (its poles: z^2 - z + k = 0), and damped well below about a tenth, with the lag of a drive in it.
constexpr double unstable = 1, well_damped = 0.1;

constexpr Duration usual_watchdog = std::chrono::milliseconds{100};

std::string slave_of_output(const MachineConfig& config, const std::string& name) {
    for (const auto& point : config.io)
        if (point.direction == IoDirection::output && point.name == name && !point.beside) return point.slave;
    return {};
}

/// The slower of what reads the position and what is told the velocity.
Duration loop_period(const MachineConfig& config, const AxisBinding& binding) {
    auto period = exchange_period_of(config, binding.slave);
    if (binding.analog) period = std::max(period, exchange_period_of(config, slave_of_output(config, binding.analog->setpoint)));
    return period;
}

bool closed_here(const AxisBinding& binding) noexcept {
    const auto& axis = binding.axis;
    return axis.control.mode == axes::ControlMode::velocity && !axis.encoder && !binding.slave.empty();
}

}  // namespace

void check_position_loop(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, Problems& problems) {
    if (!closed_here(binding)) return;
    const double period = to_seconds(loop_period(config, binding)), kv = binding.axis.control.kv;
    if (kv * period >= unstable)
        problems.add("axis.position_loop", subject + ".control.kv",
                     fmt::format("{:g}/s with a position and a set-point each {:g} ms: this loop cannot be stable", kv, period * 1e3),
                     fmt::format("give at most {:g}, a tenth of the rate; begin with 20", well_damped / period));
}

WatchedOutput watchdog_of_output(const MachineConfig& config, const std::string& output) {
    auto timed = config;
    timed.bus.cycle = config.cycle;
    const auto name = slave_of_output(config, output);
    for (const auto& slave : timed.bus.slaves)
        if (slave.name == name && !name.empty()) return {name, sm_watchdog(timed, slave)};
    return {};
}

std::vector<Error> position_loop_remarks(const MachineConfig& config, const AxisBinding& binding, const std::string& subject) {
    std::vector<Error> found;
    if (!closed_here(binding)) return found;
    const double period = to_seconds(loop_period(config, binding)), kv = binding.axis.control.kv;
    if (kv * period > well_damped)
        found.push_back({"remark.position_loop", subject + ".control.kv",
                         fmt::format("{:g}/s with a position and a set-point each {:g} ms swings, or soon will", kv, period * 1e3),
                         fmt::format("give at most {:g}, a tenth of the rate", well_damped / period)});
    if (!binding.analog || config.simulation.supervision == Supervision::relaxed) return found;
    for (const auto& [key, name] : {std::pair{"setpoint", &binding.analog->setpoint}, std::pair{"enable", &binding.analog->enable}}) {
        const auto [slave, watchdog] = watchdog_of_output(config, *name);
        if (watchdog <= usual_watchdog) continue;
        found.push_back(
            {"remark.analog_watchdog", fmt::format("{}.analog.{}", subject, key),
             fmt::format("when the master is gone, '{}' keeps it for {:g} ms: at full velocity {:g} {} without anybody at the wheel", slave,
                         to_seconds(watchdog) * 1e3, binding.axis.limits.velocity * to_seconds(watchdog), binding.axis.unit),
             "leave `sm_watchdog` of the terminal out, and exchange it each cycle (its `sync_unit`)"});
    }
    return found;
}

}  // namespace taktwerk::runtime

#include "runtime/run/virtual_runner.hpp"

#include <fmt/format.h>

#include "runtime/run/bring_up_patience.hpp"

namespace taktwerk::runtime {

VirtualRunner::VirtualRunner(Machine& machine, World& world, VirtualClock& clock)
    : machine_(machine), world_(world), clock_(clock), period_(machine.config().cycle) {}

void VirtualRunner::one_cycle() {
    clock_.advance(period_ + machine_.bus().period_correction());
    const auto now = clock_.now();
    world_.apply_events(now);
    machine_.cycle({now, now, 0});
    machine_.run_slow_tasks();
    machine_.service(now);
    if (drain) drain();
    if (after_cycle) after_cycle(now);
}

Result<void> VirtualRunner::bring_up(Duration patience) {
    machine_.start_bus();
    patience += patience_with(machine_.bus().slave_count(), period_);
    const auto until = clock_.now() + patience;
    while (!machine_.bus_operational()) {
        one_cycle();
        if (auto failure = machine_.bus_failure()) return *failure;
        if (clock_.now() > until)
            return Error{"bus.timeout", "bus",
                         fmt::format("not operational after {:.0f} s; last: {}", to_seconds(patience), machine_.bus_progress()),
                         "look at the slave that this line names"};
    }
    return machine_.arm();
}

void VirtualRunner::run_for(Duration duration) {
    const auto until = clock_.now() + duration;
    while (clock_.now() < until && machine_.phase() != MachinePhase::stopped) one_cycle();
}

bool VirtualRunner::run_until(const std::function<bool()>& condition, Duration patience) {
    const auto until = clock_.now() + patience;
    while (clock_.now() < until) {
        one_cycle();
        if (condition()) return true;
    }
    return false;
}

void VirtualRunner::shut_down() {
    machine_.request_shutdown();
    run_until([&] { return machine_.phase() == MachinePhase::stopped; }, std::chrono::seconds{10});
    machine_.stop_bus();
    run_until([&] { return machine_.bus().phase() == ecat::Master::Phase::stopped; }, std::chrono::seconds{5});
    for (std::size_t i = 0; i < machine_.modbus_count(); ++i)
        while (machine_.end_modbus(i, clock_.now())) {}
}

}  // namespace taktwerk::runtime

// Step 10: the one copy of the machine's state for everybody else, and the row of the trace. Copying allocates nothing.

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/machine/machine_impl.hpp"

namespace taktwerk::runtime {

void Machine::Impl::take_variables() noexcept {
    const auto& variables = host->variables();
    for (std::size_t i = 0; i < variables.size(); ++i) {
        const auto program = variables[i].program;
        if (has_base_task[program] && program_states[program] == ProgramState::running)
            variable_values[i] = ProgramHost::read(variables[i]);
    }
    for (const auto& task : slow_tasks) {  // a program without a base task: as its last applied run left them
        const auto values = task->variables();
        if (task->applied() == 0) continue;
        std::size_t next = 0;
        for (std::size_t i = 0; i < variables.size() && next < values.size(); ++i)
            if (variables[i].program == task->program()) variable_values[i] = values[next++];
    }
}

void Machine::Impl::take_snapshot() noexcept {
    auto& s = snapshots.back();
    s.cycle = cycles;
    s.at = now;
    s.phase = phase.load(std::memory_order_relaxed);
    s.mode = mode;
    s.emergency_stop = emergency;
    s.simulated = config.bus.interface.empty();
    s.bus_phase = bus.phase();
    s.bus = bus.statistics();
    s.statistics = statistics;
    for (std::size_t i = 0; i < s.slaves.size(); ++i) s.slaves[i] = bus.health(i);
    for (std::size_t i = 0; i < axes.size(); ++i) s.axes[i] = axes[i].view();
    std::copy(io.inputs().begin(), io.inputs().end(), s.inputs.begin());
    std::copy(io.outputs().begin(), io.outputs().end(), s.outputs.begin());
    std::copy(host->parameters().begin(), host->parameters().end(), s.parameters.begin());
    take_variables();
    std::copy(variable_values.begin(), variable_values.end(), s.variables.begin());
    std::copy(program_states.begin(), program_states.end(), s.programs.begin());
    std::copy(task_statistics.begin(), task_statistics.end(), s.tasks.begin());
    const auto alarms = log.alarms();
    s.alarm_count = alarms.size();
    std::copy(alarms.begin(), alarms.end(), s.alarms.begin());
    if (s.passed_alarms.noted() != log.passed().noted()) s.passed_alarms = log.passed();
    const auto& events = requests.events();
    if (s.event_revision != events.revision()) {
        s.event_revision = events.revision();
        s.events_dropped = events.dropped();
        s.event_count = events.events().size();
        std::copy(events.events().begin(), events.events().end(), s.events.begin());
    }
    snapshots.publish();
}

std::vector<std::string> Machine::Impl::trace_columns() const {
    std::vector<std::string> columns{"time_s", "emergency_stop", "alarms"};
    for (const auto& axis : layout.axes)
        for (const char* what : {"state", "set_position", "set_velocity", "set_acceleration", "set_jerk", "actual_position",
                                 "actual_velocity", "actual_torque", "following_error", "target_position", "active", "drive_state", "homed",
                                 "error", "owner", "velocity_limiter", "held_by_stop", "command"})
            columns.push_back(axis.name + "." + what);
    for (const auto& input : layout.inputs) columns.push_back("in." + input);
    for (const auto& output : layout.outputs) columns.push_back("out." + output);
    for (const auto& variable : layout.variables) columns.push_back(variable.program + "." + variable.name);
    return columns;
}

void Machine::Impl::take_trace() noexcept {
    auto row = trace->begin();
    if (row.empty()) {
        ++statistics.snapshots_dropped;
        return;
    }
    std::size_t n = 0;
    const auto put = [&](double value) { row[n++] = value; };
    put(to_seconds(now.time_since_epoch()));
    put(emergency ? 1 : 0);
    put(static_cast<double>(log.alarms().size()));
    for (const auto& axis : axes) {
        const auto& v = axis.view();
        put(static_cast<double>(v.state));
        put(v.set_position);
        put(v.set_velocity);
        put(v.set_acceleration);
        put(v.set_jerk);
        put(v.actual_position);
        put(v.actual_velocity);
        put(v.actual_torque);
        put(v.following_error);
        put(v.target_position);
        put(v.active);
        put(static_cast<double>(v.drive_state));
        put(v.homed ? 1 : 0);
        put(v.error);
        put(static_cast<double>(v.owner));
        put(static_cast<double>(v.limiter));
        put(v.lock != 0 ? 1 : 0);
        put(static_cast<double>(v.active_kind));
    }
    for (const auto value : io.inputs()) put(static_cast<double>(value));
    for (const auto value : io.outputs()) put(static_cast<double>(value));
    for (const auto value : variable_values) put(value);
    trace->commit();
}

}  // namespace taktwerk::runtime

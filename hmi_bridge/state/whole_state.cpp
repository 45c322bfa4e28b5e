#include "hmi_bridge/state/whole_state.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "ecat/wire/al_status.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/state/lcm_text.hpp"
#include "hmi_bridge/words/words.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

/// As many as there are: what is beyond the names, or the other way round, nobody sees.
template <class Part>
std::size_t make_room(std::vector<Part>& parts, std::int32_t& counted, std::size_t there, std::size_t named) {
    const auto n = std::min({there, named, static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())});
    parts.resize(n);
    counted = static_cast<std::int32_t>(n);
    return n;
}

void fill_statistics(taktwerk_lcm::whole_statistics_v2_t& out, const runtime::CycleStatistics& cycle) {
    out.cycles = count(cycle.cycles);
    out.overruns = count(cycle.overruns);
    out.missed_ticks = count(cycle.missed_ticks);
    out.lateness_ns = count(cycle.lateness);
    out.lateness_max_ns = count(cycle.lateness_max);
    out.compute_ns = count(cycle.compute);
    out.compute_max_ns = count(cycle.compute_max);
    out.snapshots_dropped = count(cycle.snapshots_dropped);
    out.commands_refused = count(cycle.commands_refused);
    out.page_faults = count(cycle.page_faults);
    out.disk_page_faults = count(cycle.disk_page_faults);
}

/// Nobody pressed it: the slave with its input is not exchanged.
bool emergency_stop_is_unread(const runtime::Snapshot& s) {
    for (std::size_t i = 0; i < s.alarm_count && i < s.alarms.size(); ++i) {
        const auto& alarm = s.alarms[i];
        if (alarm.standing && alarm.fact.id == id(runtime::MachineAlarm::emergency_stop))
            return alarm.fact.a == runtime::emergency_stop_unread;
    }
    return false;
}

void fill_slaves(whole_state_v5_t& out, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    const auto n = make_room(out.slaves, out.slave_count, s.slaves.size(), layout.slaves.size());
    for (std::size_t i = 0; i < n; ++i) {
        auto& slave = out.slaves[i];
        put_text(slave.name, layout.slaves[i]);
        put_text(slave.state, ecat::name(s.slaves[i].al_state));
        slave.al_status_code = s.slaves[i].al_status_code;
        slave.fresh = s.slaves[i].fresh;
        slave.age = s.slaves[i].age;
    }
}

void fill_programs(whole_state_v5_t& out, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    const auto programs = make_room(out.programs, out.program_count, s.programs.size(), layout.programs.size());
    for (std::size_t i = 0; i < programs; ++i) {
        put_text(out.programs[i].name, layout.programs[i]);
        put_text(out.programs[i].state, word(s.programs[i]));
    }
    const auto tasks = make_room(out.tasks, out.task_count, s.tasks.size(), layout.tasks.size());
    for (std::size_t i = 0; i < tasks; ++i) {
        auto& task = out.tasks[i];
        put_text(task.name, layout.tasks[i]);
        task.releases = count(s.tasks[i].releases);
        task.overruns = count(s.tasks[i].overruns);
        task.run_ns = count(s.tasks[i].run);
        task.run_max_ns = count(s.tasks[i].run_max);
    }
}

void fill_points(whole_state_v5_t& out, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    const auto inputs = make_room(out.inputs, out.input_count, s.inputs.size(), layout.inputs.size());
    for (std::size_t i = 0; i < inputs; ++i) {
        auto& point = out.inputs[i];
        put_text(point.name, layout.inputs[i]);
        put_text(point.unit, i < layout.input_units.size() ? std::string_view(layout.input_units[i]) : std::string_view{});
        point.raw = s.inputs[i];
        point.value = i < s.input_values.size() ? s.input_values[i].value : 0;
        point.good = i >= s.input_values.size() || s.input_values[i].good;
    }
    const auto outputs = make_room(out.outputs, out.output_count, s.outputs.size(), layout.outputs.size());
    for (std::size_t i = 0; i < outputs; ++i) {
        auto& point = out.outputs[i];
        put_text(point.name, layout.outputs[i]);
        put_text(point.unit, i < layout.output_units.size() ? std::string_view(layout.output_units[i]) : std::string_view{});
        point.raw = s.outputs[i];
        point.value = i < s.output_values.size() ? s.output_values[i] : 0;
        point.good = true;
    }
}

void fill_forces(whole_state_v5_t& out, const runtime::Snapshot& s, const runtime::MachineLayout& layout, const NameOfClient& who) {
    const auto n = make_room(out.forced, out.force_count, s.force_count, s.forces.size());
    for (std::size_t i = 0; i < n; ++i) {
        const auto& force = s.forces[i];
        const bool output = force.direction == runtime::IoDirection::output;
        const auto& names = output ? layout.outputs : layout.inputs;
        put_text(out.forced[i].point, force.index < names.size() ? std::string_view(names[force.index]) : std::string_view{});
        put_text(out.forced[i].direction, output ? "output" : "input");
        out.forced[i].value = force.value;
        put_text(out.forced[i].by, who(force.client));
    }
}

/// `named`: of the layout, in the order of `values`.
template <class Named>
void fill_values(std::vector<taktwerk_lcm::whole_value_v1_t>& out, std::int32_t& counted, const Named& named,
                 const std::vector<double>& values) {
    const auto n = make_room(out, counted, values.size(), named.size());
    for (std::size_t i = 0; i < n; ++i) {
        put_text(out[i].program, named[i].program);
        put_text(out[i].name, named[i].name);
        put_text(out[i].unit, named[i].unit);
        out[i].value = values[i];
    }
}

void fill_measurement(taktwerk_lcm::whole_measure_v1_t& out, const runtime::MeasureState& m, const runtime::MachineLayout& layout) {
    if (m.run == 0 || m.axis >= layout.axes.size()) {
        out = {};
        return;
    }
    out.run = m.run;
    put_text(out.axis, layout.axes[m.axis].name);
    put_text(out.kind, name(m.plan.order().kind));
    out.running = m.running;
    put_text(out.end, name(m.end));
    out.elapsed_s = m.elapsed;
    out.duration_s = m.plan.duration();
}

}  // namespace

void fill(whole_bus_v1_t& out, const runtime::Snapshot& s) {
    put_text(out.phase, word(s.bus_phase));
    out.frames_sent = count(s.bus.frames_sent);
    out.frames_received = count(s.bus.frames_received);
    out.frames_lost = count(s.bus.frames_lost);
    out.frames_late = count(s.bus.frames_late);
    out.frames_rejected = count(s.bus.frames_rejected);
    out.working_counter_errors = count(s.bus.working_counter_errors);
    out.send_errors = count(s.bus.send_errors);
    out.dc_difference_ns = s.bus.dc_difference_ns;
    out.round_trip_ns = count(s.bus.round_trip);
    put_text(out.dc_lock, ecat::name(s.bus.dc_lock));
    out.dc_phase_error_ns = s.bus.dc_phase_error_ns;
    out.dc_offset_ns = s.bus.dc_offset_ns;
    out.dc_drift_ppb = s.bus.dc_drift_ppb;
    out.dc_rejected = count(s.bus.dc_rejected);
    put_text(out.ring, ecat::name(s.bus.ring.shape));
    out.ring_before_break = s.bus.ring.before_break;
    out.ring_behind_break = s.bus.ring.behind_break;
    out.ring_opened = count(s.bus.ring.opened);
    out.sync0_margin_ns = s.bus.sync0_margin_ns;
    out.sync0_margin_least_ns = s.bus.sync0_margin_least_ns;
}

void fill(whole_state_v5_t& out, const runtime::Snapshot& s, const MachineLink& machine, const NameOfClient& who) {
    const auto& layout = machine.layout();
    out.cycle_time_ns = count(s.at);
    out.cycle_count = count(s.cycle);
    put_text(out.machine, layout.machine);
    put_text(out.phase, word(s.phase));
    put_text(out.mode, word(s.mode));
    out.emergency_stop = s.emergency_stop;
    out.emergency_stop_unread = emergency_stop_is_unread(s);
    out.simulated = s.simulated;
    fill_statistics(out.statistics, s.statistics);
    fill(out.bus, s);
    fill_slaves(out, s, layout);
    const auto axes = make_room(out.axes, out.axis_count, s.axes.size(), layout.axes.size());
    for (std::size_t i = 0; i < axes; ++i) fill(out.axes[i], s, layout, i);
    const auto groups = make_room(out.groups, out.group_count, s.groups.size(), layout.groups.size());
    for (std::size_t i = 0; i < groups; ++i) fill(out.groups[i], s, layout, i);
    fill_programs(out, s, layout);
    fill_points(out, s, layout);
    fill_forces(out, s, layout, who);
    fill_values(out.variables, out.variable_count, layout.variables, s.variables);
    fill_values(out.parameters, out.parameter_count, layout.parameters, s.parameters);
    fill_measurement(out.measure, s.measure, layout);
    const auto alarms = make_room(out.alarms, out.alarm_count, s.alarm_count, s.alarms.size());
    for (std::size_t i = 0; i < alarms; ++i) fill(out.alarms[i], s.alarms[i], machine);
    const auto events = make_room(out.events, out.event_count, s.event_count, s.events.size());
    for (std::size_t i = 0; i < events; ++i) fill(out.events[i], s.events[i], layout);
    out.events_dropped = count(s.events_dropped);
}

}  // namespace taktwerk::hmi

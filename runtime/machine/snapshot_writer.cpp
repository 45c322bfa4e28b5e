#include "runtime/machine/snapshot_writer.hpp"

#include <algorithm>

namespace taktwerk::runtime {

namespace {

using axes::AxisView;

/// What a trace shows of each axis, in the order of its columns.
struct AxisColumn {
    const char* name;
    double (*value)(const AxisView& view);
};
constexpr AxisColumn axis_columns[] = {
    {"state", [](const AxisView& v) { return static_cast<double>(v.state); }},
    {"set_position", [](const AxisView& v) { return v.set_position; }},
    {"set_velocity", [](const AxisView& v) { return v.set_velocity; }},
    {"set_acceleration", [](const AxisView& v) { return v.set_acceleration; }},
    {"set_jerk", [](const AxisView& v) { return v.set_jerk; }},
    {"actual_position", [](const AxisView& v) { return v.actual_position; }},
    {"actual_velocity", [](const AxisView& v) { return v.actual_velocity; }},
    {"actual_torque", [](const AxisView& v) { return v.actual_torque; }},
    {"following_error", [](const AxisView& v) { return v.following_error; }},
    {"target_position", [](const AxisView& v) { return v.target_position; }},
    {"active", [](const AxisView& v) { return static_cast<double>(v.active); }},
    {"drive_state", [](const AxisView& v) { return static_cast<double>(v.drive_state); }},
    {"homed", [](const AxisView& v) { return v.homed ? 1.0 : 0.0; }},
    {"error", [](const AxisView& v) { return static_cast<double>(v.error); }},
    {"owner", [](const AxisView& v) { return static_cast<double>(v.owner); }},
    {"velocity_limiter", [](const AxisView& v) { return static_cast<double>(v.limiter); }},
    {"held_by_stop", [](const AxisView& v) { return v.lock != 0 ? 1.0 : 0.0; }},
    {"command", [](const AxisView& v) { return static_cast<double>(v.active_kind); }},
};

std::vector<std::string> trace_columns(const MachineLayout& layout) {
    std::vector<std::string> columns{"time_s", "emergency_stop", "alarms"};
    for (const auto& axis : layout.axes)
        for (const auto& column : axis_columns) columns.push_back(axis.name + "." + column.name);
    for (const auto& input : layout.inputs) columns.push_back("in." + input);
    for (const auto& output : layout.outputs) columns.push_back("out." + output);
    for (const auto& variable : layout.variables) columns.push_back(variable.program + "." + variable.name);
    return columns;
}

}  // namespace

void SnapshotWriter::prepare() {
    Snapshot prototype;
    prototype.slaves.resize(body_.bus.slave_count());
    prototype.axes.resize(body_.axes.size());
    prototype.inputs.resize(body_.io.inputs().size());
    prototype.outputs.resize(body_.io.outputs().size());
    prototype.input_values.resize(prototype.inputs.size());
    prototype.output_values.resize(prototype.outputs.size());
    prototype.parameters.resize(programs_.host().parameters().size());
    prototype.variables.resize(programs_.variables().size());
    prototype.programs.resize(programs_.programs().size());
    prototype.tasks.resize(programs_.task_statistics().size());
    prototype.alarms.resize(AlarmLog::capacity);
    prototype.simulated = body_.config.bus.interface.empty();
    for (int i = 0; i < 3; ++i) {  // each of the three buffers gets its full size once
        snapshots_.back() = prototype;
        snapshots_.publish();
        (void)snapshots_.read();
    }
}

TraceRing& SnapshotWriter::enable_trace(std::size_t rows, const MachineLayout& layout) {
    trace_ = std::make_unique<TraceRing>(trace_columns(layout), rows);
    return *trace_;
}

const Snapshot* SnapshotWriter::latest() noexcept {
    const auto reading = snapshots_.read();
    return reading.value->cycle > 0 ? reading.value : nullptr;
}

void SnapshotWriter::step() noexcept {
    take_snapshot();
    if (trace_) take_row();
}

void SnapshotWriter::take_snapshot() noexcept {
    auto& s = snapshots_.back();
    s.cycle = body_.cycles;
    s.at = body_.now;
    s.phase = body_.phase.load(std::memory_order_relaxed);
    s.mode = body_.mode;
    s.emergency_stop = body_.emergency;
    s.simulated = body_.config.bus.interface.empty();
    s.bus_phase = body_.bus.phase();
    s.bus = body_.bus.statistics();
    s.statistics = body_.statistics;
    for (std::size_t i = 0; i < s.slaves.size(); ++i) s.slaves[i] = body_.bus.health(i);
    for (std::size_t i = 0; i < s.axes.size(); ++i) s.axes[i] = body_.axes[i].view();
    std::ranges::copy(body_.io.inputs(), s.inputs.begin());
    std::ranges::copy(body_.io.outputs(), s.outputs.begin());
    std::ranges::copy(body_.io.input_values(), s.input_values.begin());
    for (std::size_t i = 0; i < s.output_values.size(); ++i) s.output_values[i] = body_.io.output_value(i);
    std::ranges::copy(programs_.host().parameters(), s.parameters.begin());
    std::ranges::copy(programs_.variables(), s.variables.begin());
    std::ranges::transform(programs_.programs(), s.programs.begin(), &ProgramRecord::state);
    std::ranges::copy(programs_.task_statistics(), s.tasks.begin());
    const auto alarms = body_.log.alarms();
    s.alarm_count = alarms.size();
    std::ranges::copy(alarms, s.alarms.begin());
    if (const auto& passed = body_.log.passed(); s.passed_alarms.noted() != passed.noted()) s.passed_alarms = passed;
    const auto& events = body_.requests.events();
    if (s.event_revision != events.revision()) {
        s.event_revision = events.revision();
        s.events_dropped = events.dropped();
        s.event_count = events.events().size();
        std::ranges::copy(events.events(), s.events.begin());
    }
    snapshots_.publish();
}

void SnapshotWriter::take_row() noexcept {
    auto row = trace_->begin();
    if (row.empty()) {
        ++body_.statistics.snapshots_dropped;
        return;
    }
    std::size_t n = 0;
    const auto put = [&](double value) { row[n++] = value; };
    put(to_seconds(body_.now.time_since_epoch()));
    put(body_.emergency ? 1 : 0);
    put(static_cast<double>(body_.log.alarms().size()));
    for (const auto& axis : body_.axes)
        for (const auto& column : axis_columns) put(column.value(axis.view()));
    for (const auto& input : body_.io.input_values()) put(input.value);
    for (std::size_t i = 0; i < body_.io.outputs().size(); ++i) put(body_.io.output_value(i));
    for (const auto value : programs_.variables()) put(value);
    trace_->commit();
}

}  // namespace taktwerk::runtime

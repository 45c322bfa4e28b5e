#include "runtime/machine/snapshot_writer.hpp"

#include <algorithm>

namespace taktwerk::runtime {

void SnapshotWriter::prepare() {
    Snapshot prototype;
    prototype.slaves.resize(body_.bus.slave_count());
    prototype.axes.resize(body_.axes.size());
    prototype.following_peaks.resize(body_.following_peaks.size());
    prototype.groups.resize(groups_.seen().size());
    prototype.inputs.resize(body_.io.inputs().size());
    prototype.outputs.resize(body_.io.outputs().size());
    prototype.input_values.resize(prototype.inputs.size());
    prototype.output_values.resize(prototype.outputs.size());
    prototype.parameters.resize(programs_.host().parameters().size());
    prototype.variables.resize(programs_.variables().size());
    prototype.programs.resize(programs_.programs().size());
    prototype.tasks.resize(programs_.times().statistics().size());
    prototype.alarms.resize(AlarmLog::capacity);
    prototype.simulated = body_.config.bus.interface.empty();
    for (int i = 0; i < 3; ++i) {  // each of the three buffers gets its full size once
        snapshots_.back() = prototype;
        snapshots_.publish();
        (void)snapshots_.read();
    }
}

const Snapshot* SnapshotWriter::latest() noexcept {
    const auto reading = snapshots_.read();
    return reading.value->cycle > 0 ? reading.value : nullptr;
}

void SnapshotWriter::step() noexcept {
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
    std::ranges::copy(body_.following_peaks, s.following_peaks.begin());
    std::ranges::copy(groups_.seen(), s.groups.begin());
    std::ranges::copy(body_.io.inputs(), s.inputs.begin());
    for (std::size_t i = 0; i < s.outputs.size(); ++i) s.outputs[i] = body_.io.output_word(i);
    std::ranges::copy(body_.io.input_values(), s.input_values.begin());
    for (std::size_t i = 0; i < s.output_values.size(); ++i) s.output_values[i] = body_.io.output_value(i);
    const auto forces = body_.io.forces();
    s.force_count = forces.size();
    std::ranges::copy(forces, s.forces.begin());
    std::ranges::copy(programs_.host().parameters(), s.parameters.begin());
    std::ranges::copy(programs_.variables(), s.variables.begin());
    std::ranges::transform(programs_.programs(), s.programs.begin(), &ProgramRecord::state);
    std::ranges::copy(programs_.times().statistics(), s.tasks.begin());
    s.measure = measuring_.state();
    const auto alarms = body_.log.alarms();
    s.alarm_count = alarms.size();
    std::ranges::copy(alarms, s.alarms.begin());
    s.passed_alarms.follow(body_.log.passed());
    const auto& events = body_.requests.events();
    if (s.event_revision != events.revision()) {
        s.event_revision = events.revision();
        s.events_dropped = events.dropped();
        s.event_count = events.events().size();
        std::ranges::copy(events.events(), s.events.begin());
    }
    snapshots_.publish();
}

}  // namespace taktwerk::runtime

// How the rooms of a machine are built, and the twelve steps of its cycle (docs/architecture.md).

#include <algorithm>
#include <array>

#include "axes/axis/plan_order.hpp"
#include "runtime/machine/machine_impl.hpp"
#include "runtime/machine/machine_layout.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {

std::array<std::string_view, step_count - 1> measured_steps() {
    std::array<std::string_view, step_count - 1> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = name(static_cast<Step>(i));
    return names;
}

std::unique_ptr<RetainKeeper> kept(MachineBody& body, std::vector<Error>& errors) {
    if (body.config.retain.empty()) return nullptr;
    auto keeper = std::make_unique<RetainKeeper>(body.config.retain, body.config.axes, errors);
    keeper->restore(body.axes);
    return keeper;
}

}  // namespace

Machine::Impl::Impl(MachineConfig machine, ecat::Transport& transport, const std::vector<modbus::SerialLine*>& lines,
                    const std::vector<modbus::tcp::Exchange*>& exchanges, std::vector<Error>& errors)
    : body(std::move(machine), transport),
      drives(body, lines, errors),
      asked(body, drives),
      look(body),
      groups(body, drives),
      modbus(body, exchanges, errors),
      retain(kept(body, errors)),
      hands(body),
      measuring(body, hands),
      axis_groups(body, hands),
      programs(body, hands, errors),
      desk(body, hands, measuring, axis_groups, programs),
      supervisor(body, drives, groups, modbus, programs, desk, retain.get()),
      outcome(body, drives),
      replayed(body, programs, desk, drives.serial(), modbus, supervisor, asked, look),
      snapshots(body, measuring, axis_groups, programs),
      layout(layout_of(body, drives, programs.host())),
      rows(body, axis_groups, programs, layout),
      words(body, drives, groups, modbus, programs, supervisor, layout),
      steps(measured_steps()) {
    restore_values();
    // Now the programs have declared their tables.
    for (auto& axis : body.axes) axis.bind({body.axes.data(), body.axes.size(), &body.tables, body.io.inputs()});
}

void Machine::Impl::restore_values() {
    if (!retain) return;
    auto& host = programs.host();
    std::vector<RetainBound> bounds;
    for (const auto& value : host.operator_values()) bounds.push_back({value.address, &host.variable(value.variable)});
    retain->restore(host.retained(), layout.parameters, host.parameters(), bounds);
    programs.restored(retain->warm_blocks());
    if (!body.config.retain.power_fail.empty()) power_fail = body.io.find(IoDirection::input, body.config.retain.power_fail);
}

Result<void> Machine::Impl::arm() {
    if (auto ok = drives.resolve(); !ok) return ok;
    if (!outputs_laid_out.load(std::memory_order_relaxed))
        if (auto ok = body.io.resolve(body.bus); !ok) return ok;
    programs.learn_outputs();
    snapshots.prepare();
    desk.begin();
    body.phase.store(MachinePhase::running, std::memory_order_release);
    body.armed.store(true, std::memory_order_release);
    return {};
}

void Machine::Impl::service_bus(Instant now) {
    asked.note(now);
    body.bus.step(now);
    lay_out_outputs();
    drives.step(now);
    asked.collect();
    look.step(now);
    programs.carry_requests();
}

void Machine::Impl::lay_out_outputs() {
    using Phase = ecat::Master::Phase;
    const auto at = body.bus.phase();
    const bool planned = at == Phase::configuring || at == Phase::safeop || at == Phase::operational;
    if (!planned || body.armed.load(std::memory_order_relaxed) || outputs_laid_out.load(std::memory_order_relaxed)) return;
    // What cannot be resolved is told by arm().
    if (body.io.resolve(body.bus)) outputs_laid_out.store(true, std::memory_order_release);
}

void Machine::Impl::cycle(const CycleTick& tick) noexcept {
    const Stopwatch whole;
    const bool runs = body.armed.load(std::memory_order_acquire);
    if (body.recorder) record_tick(*body.recorder, tick);
    if (runs) body.now = tick.scheduled;
    const bool at_tick = body.config.send == SendMode::at_tick;
    steps.begin();

    body.bus.receive(tick.scheduled);
    if (at_tick) body.bus.send(tick.scheduled);  // what the cycle before has computed, always at the same instant
    done(Step::receive);

    if (runs) compute(tick);
    else wait_for_bus(tick);
    if (body.recorder != nullptr) outcome.record(tick.scheduled, runs);

    if (!at_tick) body.bus.send(tick.scheduled);
    done(Step::send);

    if (runs) tell(tick);
    done(Step::snapshot);
    steps.end();
    auto& statistics = body.statistics;
    statistics.compute = Stopwatch{whole}.lap();
    statistics.compute_max = std::max(statistics.compute_max, statistics.compute);
    if (runs) times.record(statistics, steps);
    if (desk.statistics_reset()) reset_statistics();
    pulse_cycles.fetch_add(1, std::memory_order_relaxed);
}

void Machine::Impl::reset_statistics() noexcept {
    body.statistics.lateness_max = body.statistics.compute_max = {};
    times.reset();
    programs.times().reset();
}

void Machine::Impl::wait_for_bus(const CycleTick& tick) noexcept {
    desk.take_levels(tick.scheduled);
    if (desk.shutdown_taken()) body.phase.store(MachinePhase::stopped, std::memory_order_release);
    if (outputs_laid_out.load(std::memory_order_acquire)) body.io.write(body.bus.outputs());
}

void Machine::Impl::compute(const CycleTick& tick) noexcept {
    const auto now = body.now;
    programs.take_answers();
    body.requests.speak_for(no_program, now);  // a stop is a person's, not the last program's
    desk.take_levels(now);
    desk.drain_inbox(now);
    done(Step::inbox);

    modbus.read();
    body.io.read(body.bus.inputs(), body.bus);
    drives.read_wires();
    groups.step();
    done(Step::decode);

    for (auto& axis : body.axes) axis.update(now);
    if (body.recorder) drives.serial().record();
    done(Step::update);

    supervisor.step(tick);
    body.axis_groups.update(now);
    done(Step::supervise);

    body.requests.speak_for(no_program, now);
    desk.renew_power();
    measuring.step();
    programs.run_tasks(tick.missed);
    drives.serial().hold_watchdog_outputs();
    drives.hold_brake_outputs();
    done(Step::tasks);

    body.axis_groups.plan(now, body.config.cycle);
    axes::plan_axes(body.axes, now, body.config.cycle);
    body.requests.end_of_cycle(now, body.emergency || body.shutting_down, programs.programs());
    programs.look_at_groups();
    done(Step::plan);

    const Instant send_time = body.config.send == SendMode::at_tick ? now + body.config.cycle : now;
    for (auto& axis : body.axes) axis.encode(send_time);
    drives.write_wires();
    body.io.write(body.bus.outputs());
    modbus.write();
    done(Step::encode);
}

void Machine::Impl::tell(const CycleTick& tick) noexcept {
    auto& statistics = body.statistics;
    statistics.cycles = ++body.cycles;
    statistics.missed_ticks += tick.missed;
    if (tick.missed > 0) ++statistics.overruns;
    statistics.lateness = tick.woken - tick.scheduled;
    statistics.lateness_max = std::max(statistics.lateness_max, statistics.lateness);
    for (std::size_t i = 0; i < body.following_peaks.size(); ++i) {
        auto& peak = body.following_peaks[i];
        const double error = body.views[i].following_error;
        peak = {std::min(peak.minimum, error), std::max(peak.maximum, error)};
    }
    programs.read_variables();
    statistics.snapshots_dropped = rows.ring().lost();
    measuring.keep();
    axis_groups.look();
    snapshots.step();
    rows.step();
    if (!retain) return;
    programs.read_retained();
    auto& image = programs.retained();
    const bool fails = power_fail >= 0 && body.io.inputs()[static_cast<std::size_t>(power_fail)] != 0;
    retain->watch(body.axes, {image.bytes(), image.take_changed(), programs.parameters()}, body.now, body.shutting_down, fails);
}

}  // namespace taktwerk::runtime

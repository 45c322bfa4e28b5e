// Step 5: what holds is raised, the log decides what remains, the strongest reaction is carried out. Real-time safe.

#include <array>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "runtime/machine_impl.hpp"

namespace taktwerk::runtime {

namespace {

constexpr Duration shutdown_patience = std::chrono::seconds{5};

}  // namespace

void Machine::Impl::raise_fact(const AlarmFact& fact, std::span<const AlarmInfo> table) noexcept {
    const auto* info = find_alarm(table, fact.id);
    if (info) log.raise(fact, info->reaction, info->reset, now);
}

void Machine::Impl::raise(MachineAlarm alarm, AlarmSource source, std::uint16_t index, double a, double b) noexcept {
    raise_fact({id(alarm), source, index, a, b}, machine_alarms);
}

void Machine::Impl::supervise(Instant, const CycleTick& tick) noexcept {
    log.begin_cycle();

    emergency = estop_input >= 0 && io.inputs()[static_cast<std::size_t>(estop_input)] == 0;
    if (emergency) raise(MachineAlarm::emergency_stop, AlarmSource::machine, 0, 0, 0);
    if (shutdown_wanted.load(std::memory_order_relaxed)) raise(MachineAlarm::stopped_by_signal, AlarmSource::machine, 0, 0, 0);

    overruns_in_a_row = tick.missed > 0 ? overruns_in_a_row + tick.missed : 0;
    if (overruns_in_a_row > limit(config.watch.overruns_allowed))
        raise(MachineAlarm::cycle_overrun, AlarmSource::machine, 0, overruns_in_a_row, limit(config.watch.overruns_allowed));
    const auto warning = config.watch.lateness_warning > Duration{} ? config.watch.lateness_warning : config.cycle / 4;
    if (tick.woken - tick.scheduled > warning)
        raise(MachineAlarm::late_wakeups, AlarmSource::machine, 0, to_seconds(tick.woken - tick.scheduled) * 1e6, to_seconds(warning) * 1e6);

    for (std::size_t i = 0; i < slow_tasks.size(); ++i) {
        const auto& task = slow_tasks[i]->config();
        if (task.overrun == OverrunReaction::stop_machine && task_overruns[i] > task.overruns_allowed)
            raise(MachineAlarm::task_overrun, AlarmSource::task, static_cast<std::uint16_t>(i), task_overruns[i], task.overruns_allowed);
    }
    for (std::size_t p = 0; p < program_states.size(); ++p) {
        const auto& program = host->programs()[p];
        if (program_states[p] == ProgramState::fault) raise(MachineAlarm::program_fault, AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0);
        for (std::uint8_t n = 0; program.alarms >> n; ++n) {
            if (!((program.alarms >> n) & 1u)) continue;
            const auto& text = program.alarm_texts[n];
            const AlarmFact fact{static_cast<AlarmId>(0x5000 + n), AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0};
            if (text.declared) log.raise(fact, text.reaction, ResetRule::self_clearing, now);
            if (n == 63) break;
        }
    }
    raise_bus_alarms();

    for (auto& axis : axes) {
        axis.demand_emergency_stop(emergency ? axes::EmergencyStop::stop_and_power_off : axes::EmergencyStop::none);
        axis.supervise(now);
        // An axis keeps its alarms until they are reset there: what it does not show any more is gone.
        for (const auto& fact : axis.active_alarms())
            if (const auto* info = find_alarm(axes::axis_alarms, fact.id)) log.raise(fact, info->reaction, ResetRule::self_clearing, now);
        AlarmFact fetched;
        while (axis.fetch_alarm(fetched)) {}
    }
    if (log.dropped() > 0) raise(MachineAlarm::alarm_log_full, AlarmSource::machine, 0, log.dropped(), 0);
    log.end_cycle();

    react();
    run_shutdown(now);
}

void Machine::Impl::raise_bus_alarms() noexcept {
    std::array<AlarmFact, AlarmLog::capacity> facts;
    const auto count = bus.active_faults(facts);
    for (std::size_t i = 0; i < count; ++i) raise_fact(facts[i], ecat::bus_alarms);
}

void Machine::Impl::react() noexcept {
    const auto strongest = log.strongest();
    if (strongest < Reaction::stop_machine || emergency) return;  // the emergency stop is the axes' own business (level above)
    for (const auto& alarm : log.alarms()) {
        if (alarm.reaction != strongest) continue;
        if (alarm.fact.id == id(MachineAlarm::stopped_by_signal) || alarm.fact.id == id(MachineAlarm::emergency_stop)) continue;
        for (auto& axis : axes) axis.stop_for_error(alarm.fact.id, strongest == Reaction::power_off);
        return;
    }
}

void Machine::Impl::run_shutdown(Instant at) noexcept {
    if (!shutdown_wanted.load(std::memory_order_relaxed)) return;
    if (!shutting_down) {
        shutting_down = true;
        shutdown_since = at;
        phase.store(MachinePhase::stopping, std::memory_order_release);
        for (std::size_t p = 0; p < program_states.size(); ++p)
            if (program_states[p] == ProgramState::running) stop_program(p, ProgramState::stopped);
        for (auto& power : operator_power) power.held = false;
        io.make_safe();
        for (auto& axis : axes) axis.shut_down();
    }
    bool off = true;
    for (const auto& axis : axes) {
        const auto& view = axis.view();
        off = off && (view.drive_state != axes::PowerState::enabled && view.drive_state != axes::PowerState::quick_stop);
    }
    if (off || at - shutdown_since > shutdown_patience) phase.store(MachinePhase::stopped, std::memory_order_release);
}

}  // namespace taktwerk::runtime

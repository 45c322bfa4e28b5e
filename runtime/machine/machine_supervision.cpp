// Step 5: what holds is raised, the log decides what remains, the strongest reaction is carried out. Real-time safe.

#include <algorithm>
#include <array>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "runtime/machine/machine_impl.hpp"

namespace taktwerk::runtime {

namespace {

/// How long a late wake-up stays listed: many in a row are one alarm.
constexpr Duration late_wakeups_shown = std::chrono::seconds{1};
/// The same for a base task that computes too long: one in a hundred cycles is one alarm, too.
constexpr Duration long_task_shown = std::chrono::seconds{5};
/// After a press that resets: its contact may bounce, and nobody means a start so soon after it.
constexpr Duration button_bounce = std::chrono::milliseconds{500};

/// A drive that sent an emergency shows it in its status word within this time, or it is no fault of the drive.
constexpr Duration drive_speaks_within = std::chrono::milliseconds{100};
/// An emergency that was over before an axis told it is an alarm for so long: nobody sees one of a cycle.
constexpr Duration missed_emergency_shown = std::chrono::seconds{1};
/// A drive takes so long at most to clear its fault, and its axis with it, after the reset that cleared the alarm of the cause.
constexpr Duration reset_takes = std::chrono::seconds{1};

}  // namespace

void Machine::Impl::raise_fact(const AlarmFact& fact, std::span<const AlarmInfo> table) noexcept {
    const auto* info = find_alarm(table, fact.id);
    if (info) log.raise(fact, info->reaction, info->reset, now);
}

void Machine::Impl::raise(MachineAlarm alarm, AlarmSource source, std::uint16_t index, double a, double b) noexcept {
    raise_fact({id(alarm), source, index, a, b}, machine_alarms);
}

// The input is normally closed: what cannot be read counts as pressed.
void Machine::Impl::watch_emergency_stop() noexcept {
    if (estop_input < 0) return;
    // The axes are off and the bus goes down: a button that falls silent by that was not pressed.
    if (phase.load(std::memory_order_relaxed) == MachinePhase::stopped) return;
    const bool unread = estop_slave < bus.slave_count() && bus.health(estop_slave).age > limit(config.bus.lost_frames_limit);
    const bool pressed = unread || io.inputs()[static_cast<std::size_t>(estop_input)] == 0;
    if (pressed && !emergency) emergency_since = now;
    emergency = pressed;
    if (emergency) {
        raise(MachineAlarm::emergency_stop, AlarmSource::machine, 0, unread ? emergency_stop_unread : 0, 0);
        release_outputs();
        for (auto& program : program_requests) program.hold();
    }
    watch_restart();
}

bool Machine::Impl::stopped_by_emergency(std::size_t axis) const noexcept {
    if (axes[axis].view().state != axes::AxisState::ErrorStop) return false;
    for (const auto& fact : axes[axis].active_alarms())
        if (fact.id == axes::id(axes::AxisAlarm::emergency_stop)) return true;
    return false;
}

bool Machine::Impl::axes_to_reset() const noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (stopped_by_emergency(i)) return true;
    return false;
}

// After the release a person lets programs go on: by a start of each, or by this input, which wants a new edge. Where an axis is still to be
// reset a press resets and starts nothing (IEC 60204-1, 9.2.5.4.2: the reset only permits a restart); the start is another press.
void Machine::Impl::watch_restart() noexcept {
    const bool pressed = restart_input >= 0 && io.inputs()[static_cast<std::size_t>(restart_input)] != 0;
    const bool wanted = pressed && !restart_pressed && !emergency && now >= restart_deaf_until;
    // Contacts bounce when they are let go, too, however long they were held.
    if (restart_pressed && !pressed) restart_deaf_until = std::max(restart_deaf_until, now + button_bounce);
    restart_pressed = pressed;
    const bool resets = wanted && axes_to_reset();
    if (resets) reset_after_emergency();
    if (wanted) log.acknowledge(id(MachineAlarm::emergency_stop));
    for (std::size_t p = 0; p < program_requests.size(); ++p) {
        if (wanted && !resets) program_requests[p].go_on();
        if (!emergency && program_requests[p].held() && program_states[p] == ProgramState::running)
            raise(MachineAlarm::program_waits, AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0);
    }
}

void Machine::Impl::reset_after_emergency() noexcept {
    restart_deaf_until = now + button_bounce;
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (stopped_by_emergency(i)) (void)requests.reset(axes::AxisRef{static_cast<std::uint16_t>(i)}, axes::Owner::operator_panel);
}

// A cycle that comes late behind one that went past its own end, with a base task taking most of that time, is late by that task and
// not by its wake-up. In virtual time nothing is ever late, so a measured time changes nothing there.
void Machine::Impl::blame_base_task(const CycleTick& tick) noexcept {
    const bool late = tick.missed > 0 || tick.woken > tick.scheduled;
    const auto lateness_before = statistics.lateness;
    late_by_a_task = late && cycles > 0 && statistics.compute > lateness_before && statistics.compute + lateness_before > config.cycle &&
                     longest_base_task.run > statistics.compute / 2;
    if (late_by_a_task) {
        if (now >= blamed_until || longest_base_task.run > blamed.run || longest_base_task.place != blamed.place)
            blamed = longest_base_task;
        blamed_until = now + long_task_shown;
    }
    if (now < blamed_until)
        raise(MachineAlarm::base_task_overrun, AlarmSource::task, static_cast<std::uint16_t>(blamed.place), to_seconds(blamed.run) * 1e3,
              to_seconds(config.cycle) * 1e3);
}

void Machine::Impl::watch_cycle(const CycleTick& tick) noexcept {
    blame_base_task(tick);
    overruns_in_a_row = tick.missed > 0 ? overruns_in_a_row + tick.missed : 0;
    if (overruns_in_a_row > limit(config.watch.overruns_allowed)) {
        raise(MachineAlarm::cycle_overrun, late_by_a_task ? AlarmSource::task : AlarmSource::machine,
              static_cast<std::uint16_t>(late_by_a_task ? blamed.place : 0), overruns_in_a_row, limit(config.watch.overruns_allowed));
    }
    const auto warning = config.watch.lateness_warning > Duration{} ? config.watch.lateness_warning : config.cycle / 4;
    const auto late = tick.woken - tick.scheduled;
    if (now >= late_until) late_worst = Duration{};
    if (late > warning && !late_by_a_task) {
        late_until = now + late_wakeups_shown;
        late_worst = std::max(late_worst, late);
    }
    if (now < late_until)
        raise(MachineAlarm::late_wakeups, AlarmSource::machine, 0, to_seconds(late_worst) * 1e6, to_seconds(warning) * 1e6);
}

void Machine::Impl::watch_programs() noexcept {
    for (std::size_t i = 0; i < slow_tasks.size(); ++i) {
        const auto& task = slow_tasks[i]->config();
        if (task.overrun == OverrunReaction::stop_machine && task_overruns[i] > task.overruns_allowed)
            raise(MachineAlarm::task_overrun, AlarmSource::task, static_cast<std::uint16_t>(slow_task_places[i]), task_overruns[i],
                  task.overruns_allowed);
    }
    for (std::size_t p = 0; p < program_states.size(); ++p) {
        const auto& program = host->programs()[p];
        if (program_states[p] == ProgramState::fault)
            raise(MachineAlarm::program_fault, AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0);
        using Undeclared = TaskContext::Undeclared;
        auto undeclared = program_undeclared[p];
        for (std::size_t n = 0; n < program.alarm_texts.size(); ++n) {
            const auto& text = program.alarm_texts[n];
            if (!((program.alarms >> n) & 1u)) continue;
            if (!text.declared) {
                undeclared = {Undeclared::What::alarm, static_cast<std::uint8_t>(n)};
                continue;
            }
            log.raise({static_cast<AlarmId>(0x5000 + n), AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0}, text.reaction,
                      ResetRule::self_clearing, now);
        }
        if (undeclared.what != Undeclared::What::nothing && program_states[p] == ProgramState::running)
            raise(MachineAlarm::undeclared_use, AlarmSource::program, static_cast<std::uint16_t>(p), undeclared.number,
                  undeclared.what == Undeclared::What::alarm ? 1 : 0);
    }
}

void Machine::Impl::supervise(Instant, const CycleTick& tick) noexcept {
    log.begin_cycle();

    watch_emergency_stop();
    if (shutdown_taken) raise(MachineAlarm::stopped_by_signal, AlarmSource::machine, 0, 0, 0);
    watch_cycle(tick);
    watch_programs();
    raise_bus_alarms();
    watch_serial_drives();
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (const auto& rivals = requests.rivals(i); now < rivals.until)
            raise(MachineAlarm::axis_of_two_programs, AlarmSource::axis, static_cast<std::uint16_t>(i), rivals.winner, rivals.loser);
    if (positions && positions->lost()) raise(MachineAlarm::positions_lost, AlarmSource::machine, 0, 0, 0);
    if (positions && positions->outdated()) raise(MachineAlarm::positions_outdated, AlarmSource::machine, 0, 0, 0);
    else if (positions && (positions->failing() || positions->hangs(now)))
        raise(MachineAlarm::positions_not_kept, AlarmSource::machine, 0, 0, 0);

    auto level = axes::EmergencyStop::none;
    if (emergency)
        level = now - emergency_since >= config.emergency_stop.power_off_after ? axes::EmergencyStop::power_off_now
                                                                               : axes::EmergencyStop::stop_and_power_off;
    for (auto& axis : axes) {
        axis.demand_emergency_stop(level);
        axis.supervise(now);
        if (emergency) axis.shut_down();  // no wish for power outlives it; an axis in ErrorStop ramps down as before
        // An axis keeps its alarms until they are reset there: what it does not show any more is gone.
        for (const auto& fact : axis.active_alarms())
            if (const auto* info = find_alarm(axes::axis_alarms, fact.id); info != nullptr && !follows_from_another(fact))
                log.raise(fact, info->reaction, ResetRule::self_clearing, now);
        note_what_preceded_fault(static_cast<std::size_t>(&axis - axes.data()));
        AlarmFact fetched;
        while (axis.fetch_alarm(fetched)) {}
    }
    stop_axes_of_faulted_drives();
    log.end_cycle(now);

    react();
    run_shutdown(now);
}

// A drive supervises the frames; what it says right after this computer sent none, or after some were lost, is no fault of the drive
// (docs/faults.md).
void Machine::Impl::note_what_preceded_fault(std::size_t axis) noexcept {
    const auto facts = axes[axis].active_alarms();
    const bool faulted = std::any_of(facts.begin(), facts.end(), [](const AlarmFact& fact) {
        return fact.id == axes::id(axes::AxisAlarm::drive_fault) || fact.id == axes::id(axes::AxisAlarm::following_error);
    });
    auto& stall = stall_before_fault[axis];
    if (!faulted) stall.store(-1, std::memory_order_relaxed);
    if (!faulted || stall.load(std::memory_order_relaxed) >= 0) return;
    const bool on_the_bus = axis_slave[axis] < bus.slave_count();
    const auto& link = bus.bus().link;
    gap_before_fault[axis].store(on_the_bus ? ecat::recent_gap(link, now) : 0, std::memory_order_relaxed);
    stall.store(ecat::recent_stall(link, now).count(), std::memory_order_relaxed);
}

// TSVM 7.1: some alarms have no axis. Whichever axis shows one, the others behind the same slave must not go on; those that show it too
// stop by themselves.
void Machine::Impl::stop_axes_of_faulted_drives() noexcept {
    for (const auto& drive : shared_drives)
        for (const auto faulted : drive) {
            const auto alarm = ports[faulted]->alarm();
            if (!alarm.whole_drive || alarm.warning) continue;
            for (const auto other : drive)
                if (other != faulted && ports[other]->alarm().code == 0)
                    axes[other].stop_for_error(axes::id(axes::AxisAlarm::drive_fault), true);
        }
}

void Machine::Impl::raise_bus_alarms() noexcept {
    std::array<AlarmFact, AlarmLog::capacity> facts;
    const auto count = bus.active_faults(facts);
    for (auto& emergency_of_slave : drive_emergencies) emergency_of_slave.seen = false;
    for (std::size_t i = 0; i < count; ++i)
        if (facts[i].id != ecat::id(ecat::BusAlarm::slave_emergency) || !told_by_an_axis(facts[i])) raise_fact(facts[i], ecat::bus_alarms);
    raise_missed_emergencies();
}

// What is over may still be told for a moment: the status word is behind.
void Machine::Impl::raise_missed_emergencies() noexcept {
    for (auto& last : drive_emergencies) {
        const bool over = !last.seen && last.fact.a != 0;
        if (over) (void)axis_tells(last);
        if (over && (last.told || last.raised || now - last.since >= drive_speaks_within)) miss(last);
        if (now < last.shown_until) raise_fact(last.missed, ecat::bus_alarms);
    }
}

void Machine::Impl::miss(DriveEmergency& last) noexcept {
    if (last.fact.a != 0 && !last.told && !last.raised) {
        last.missed = last.fact;
        last.shown_until = now + missed_emergency_shown;
    }
    last.fact = {};
}

bool Machine::Impl::axis_tells(DriveEmergency& last) noexcept {
    bool has_axis = false;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        if (axis_slave[axis] != last.fact.index) continue;
        has_axis = true;
        last.told = last.told || ports[axis]->alarm().code == static_cast<std::uint16_t>(last.fact.a);
    }
    return has_axis;
}

// A drive's emergency repeats by its number what its axis says in the words of the drive's manual. The two do not come and go at the same
// moment: the status word may be some milliseconds behind, and the message that the error is gone comes that much after a reset.
bool Machine::Impl::told_by_an_axis(const AlarmFact& fact) noexcept {
    auto& last = drive_emergencies[fact.index];
    if (last.fact.a != fact.a) {
        miss(last);
        last.since = now;
        last.told = last.raised = false;
    }
    last.fact = fact;
    last.seen = true;
    const bool has_axis = axis_tells(last);
    if (last.told || (has_axis && now - last.since < drive_speaks_within)) return true;
    last.raised = true;
    return false;
}

// The axes behind a bus that is gone, and those that stopped by an alarm that is listed, say nothing new: one cause is one alarm. What stays
// when the cause has been acknowledged and is no longer listed is said then, but not while both are just being reset.
bool Machine::Impl::follows_from_another(const AlarmFact& fact) noexcept {
    const bool by_emergency = fact.id == axes::id(axes::AxisAlarm::emergency_stop);
    const bool stopped = by_emergency || fact.id == axes::id(axes::AxisAlarm::stopped_by_machine);
    if (!stopped && fact.id != axes::id(axes::AxisAlarm::axis_feedback_lost)) return false;
    const auto cause = by_emergency ? id(MachineAlarm::emergency_stop) : static_cast<AlarmId>(fact.a);
    bool explained = stopped && log.find(cause) != nullptr;
    const bool of_the_bus = axis_slave[fact.index] < bus.slave_count();
    for (const auto& alarm : log.alarms()) {
        const bool bus_alarm = alarm.fact.id >= 0x1000 && alarm.fact.id < 0x2000 && alarm.reaction >= Reaction::stop_machine;
        const bool same_slave = alarm.fact.source != AlarmSource::slave || alarm.fact.id == ecat::id(ecat::BusAlarm::cable_broken) ||
                                alarm.fact.index == axis_slave[fact.index];
        explained = explained || (!stopped && of_the_bus && bus_alarm && same_slave);
    }
    if (explained) explained_until[fact.index] = now + reset_takes;
    return now < explained_until[fact.index];
}

void Machine::Impl::react() noexcept {
    if (emergency) return;  // the axes' own business: a level that each of them holds
    const ActiveAlarm* cause = nullptr;
    for (const auto& alarm : log.alarms()) {
        // An emergency stop that waits for its acknowledgement has stopped the axes already; the end of the run stops them otherwise.
        if (alarm.fact.id == id(MachineAlarm::stopped_by_signal) || alarm.fact.id == id(MachineAlarm::emergency_stop)) continue;
        if (alarm.reaction >= Reaction::stop_machine && (!cause || alarm.reaction > cause->reaction)) cause = &alarm;
    }
    if (!cause) return;
    for (auto& axis : axes) axis.stop_for_error(cause->fact.id, cause->reaction == Reaction::power_off);
}

void Machine::Impl::run_shutdown(Instant at) noexcept {
    if (!shutdown_taken) return;
    if (!shutting_down) {
        shutting_down = true;
        shutdown_since = at;
        phase.store(MachinePhase::stopping, std::memory_order_release);
        stop_programs();
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

#include "runtime/machine/supervisor.hpp"

#include <algorithm>
#include <array>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "runtime/machine/alarm_ranges.hpp"

namespace taktwerk::runtime {

namespace {

/// A drive takes so long at most to clear its fault, and its axis with it, after the reset that cleared the alarm of the cause.
constexpr Duration reset_takes = std::chrono::seconds{1};

}  // namespace

Supervisor::Supervisor(MachineBody& body, MachineDrives& drives, HotConnect& groups, ModbusDevices& modbus, ProgramRunner& programs,
                       OperatorDesk& desk, const RetainKeeper* retain)
    : body_(body),
      drives_(drives),
      groups_(groups),
      modbus_(modbus),
      programs_(programs),
      desk_(desk),
      retain_(retain),
      emergency_inputs_(body, programs, desk),
      late_cycles_(body, programs),
      page_faults_(body),
      drive_emergencies_(body, drives),
      before_fault_(body, drives),
      shutdown_(body, programs, desk),
      explained_until_(body.config.axes.size()) {}

void Supervisor::step(const CycleTick& tick) noexcept {
    body_.log.begin_cycle();

    emergency_inputs_.watch();
    if (desk_.shutdown_taken()) body_.raise(MachineAlarm::stopped_by_signal, AlarmSource::machine, 0);
    late_cycles_.watch(tick);
    page_faults_.watch();
    programs_.raise_alarms();
    raise_bus_alarms();
    drives_.serial().watch();
    groups_.watch();
    modbus_.watch();
    raise_rivals();
    raise_retain();
    if (body_.config.fell_back && body_.cycles == 0) body_.raise(MachineAlarm::bundle_fell_back, AlarmSource::machine, 0);
    raise_inputs();
    raise_forces();
    desk_.raise_alarms();

    const auto level = emergency_inputs_.level();
    for (std::size_t i = 0; i < body_.axes.size(); ++i) supervise(i, level);
    drives_.stop_axes_of_faulted_drives();
    body_.log.end_cycle(body_.now);

    react();
    shutdown_.step();
}

void Supervisor::raise_bus_alarms() noexcept {
    std::array<AlarmFact, AlarmLog::capacity> facts;
    const auto count = body_.bus.active_faults(facts);
    drive_emergencies_.begin_cycle();
    for (std::size_t i = 0; i < count; ++i)
        if (facts[i].id != ecat::id(ecat::BusAlarm::slave_emergency) || !drive_emergencies_.told_by_an_axis(facts[i]))
            body_.raise(facts[i], ecat::bus_alarms);
    for (std::size_t i = 0; i < count; ++i)
        if (const auto before = ecat::said_before(facts[i].id)) body_.log.withdraw(ecat::id(*before), facts[i]);
    drive_emergencies_.end_cycle();
}

void Supervisor::raise_rivals() noexcept {
    for (std::size_t i = 0; i < body_.axes.size(); ++i)
        if (const auto& rivals = body_.requests.rivals(i); body_.now < rivals.until)
            body_.raise(MachineAlarm::axis_of_two_programs, AlarmSource::axis, static_cast<std::uint16_t>(i), rivals.winner, rivals.loser);
}

void Supervisor::raise_retain() noexcept {
    if (!retain_) return;
    if (retain_->positions_lost()) body_.raise(MachineAlarm::positions_lost, AlarmSource::machine, 0);
    if (retain_->values_lost() && body_.cycles == 0) body_.raise(MachineAlarm::values_lost, AlarmSource::machine, 0);
    const auto disk = replayed_disk_.value_or(DiskSays{retain_->outdated(), retain_->failing() || retain_->hangs(body_.now)});
    if (body_.recorder != nullptr && disk != recorded_disk_) record_disk(*body_.recorder, body_.now, recorded_disk_ = disk);
    if (disk.outdated) body_.raise(MachineAlarm::positions_outdated, AlarmSource::machine, 0);
    else if (disk.failing) body_.raise(MachineAlarm::retain_not_written, AlarmSource::machine, 0);
}

void Supervisor::raise_inputs() noexcept {
    using Trouble = IoImage::Trouble;
    const auto& io = body_.io;
    for (std::size_t i = 0; i < io.input_values().size(); ++i) {
        const auto trouble = io.trouble(i);
        if (trouble == Trouble::none) continue;
        const auto index = static_cast<std::uint16_t>(i);
        if (trouble == Trouble::below_limit || trouble == Trouble::above_limit) {
            const auto& limits = *io.point(IoDirection::input, i).limits;
            body_.raise(MachineAlarm::input_out_of_limits, AlarmSource::io, index, io.measured(i).value,
                        trouble == Trouble::below_limit ? limits.low : limits.high);
        } else {
            body_.raise(MachineAlarm::input_faulty, AlarmSource::io, index,
                        trouble == Trouble::underrange  ? input_underrange
                        : trouble == Trouble::overrange ? input_overrange
                        : trouble == Trouble::no_number ? input_no_number
                                                        : input_error);
        }
    }
}

void Supervisor::raise_forces() noexcept {
    const auto forces = body_.io.forces();
    if (forces.empty()) return;
    const auto outputs = std::ranges::count(forces, IoDirection::output, &ForcedPoint::direction);
    body_.raise(MachineAlarm::points_forced, AlarmSource::machine, 0, static_cast<double>(forces.size()) - static_cast<double>(outputs),
                static_cast<double>(outputs));
}

void Supervisor::supervise(std::size_t index, axes::EmergencyStop level) noexcept {
    auto& axis = body_.axes[index];
    axis.demand_emergency_stop(level);
    axis.supervise(body_.now);
    if (body_.emergency) axis.shut_down();  // no wish for power outlives it; an axis in ErrorStop ramps down as before
    // An axis keeps its alarms until they are reset there: what it does not show any more is gone.
    for (const auto& fact : axis.active_alarms())
        if (const auto* info = find_alarm(axes::axis_alarms, fact.id); info != nullptr && !follows_from_another(fact))
            body_.log.raise(fact, axis.config().reactions.of_machine(static_cast<axes::AxisAlarm>(fact.id)), ResetRule::self_clearing,
                            body_.now);
    before_fault_.note(index);
    AlarmFact fetched;
    while (axis.fetch_alarm(fetched)) {}
}

// The axes behind a bus that is gone, and those that stopped by an alarm that is listed, say nothing new: one cause is one alarm. What stays
// when the cause has been acknowledged and is no longer listed is said then, but not while both are just being reset.
bool Supervisor::follows_from_another(const AlarmFact& fact) noexcept {
    const bool by_emergency = fact.id == axes::id(axes::AxisAlarm::emergency_stop);
    const bool stopped = by_emergency || fact.id == axes::id(axes::AxisAlarm::stopped_by_machine);
    if (!stopped && fact.id != axes::id(axes::AxisAlarm::axis_feedback_lost)) return false;
    if (!stopped && groups_.speaks_for(fact.index)) return true;
    const auto cause = by_emergency ? id(MachineAlarm::emergency_stop) : static_cast<AlarmId>(fact.a);
    bool explained = stopped && body_.log.find(cause) != nullptr;
    for (const auto& alarm : body_.log.alarms()) {
        const bool bus_alarm = alarm_range::bus.has(alarm.fact.id) && alarm.reaction >= Reaction::stop_machine;
        explained = explained || (stopped && bus_alarm && ecat::is_followed(cause));
        const bool same_slave = alarm.fact.source != AlarmSource::slave || alarm.fact.id == ecat::id(ecat::BusAlarm::cable_broken) ||
                                alarm.fact.index == drives_.slave_of(fact.index);
        explained = explained || (!stopped && drives_.on_bus(fact.index) && bus_alarm && same_slave);
    }
    if (explained) explained_until_[fact.index] = body_.now + reset_takes;
    return body_.now < explained_until_[fact.index];
}

void Supervisor::stop_axes_of_slaves() noexcept {
    for (const auto& alarm : body_.log.alarms()) {
        if (alarm.reaction != Reaction::stop_axis || alarm.fact.source != AlarmSource::slave || !alarm_range::bus.has(alarm.fact.id))
            continue;
        for (std::size_t i = 0; i < body_.axes.size(); ++i)
            if (drives_.on_bus(i) && drives_.slave_of(i) == alarm.fact.index) body_.axes[i].stop_for_error(alarm.fact.id, false);
    }
}

void Supervisor::stop_axes_of_programs() noexcept {
    for (const auto& alarm : body_.log.alarms())
        if (alarm.reaction == Reaction::stop_axis && alarm.fact.source == AlarmSource::program && alarm_range::programs.has(alarm.fact.id))
            programs_.stop_axes_of(alarm.fact.index, alarm.fact.id);
}

void Supervisor::react() noexcept {
    if (body_.emergency) return;  // the axes' own business: a level that each of them holds
    const ActiveAlarm* cause = nullptr;
    for (const auto& alarm : body_.log.alarms()) {
        // An emergency stop that waits for its acknowledgement has stopped the axes already; the end of the run stops them otherwise.
        if (alarm.fact.id == id(MachineAlarm::stopped_by_signal) || alarm.fact.id == id(MachineAlarm::emergency_stop)) continue;
        if (alarm.reaction >= Reaction::stop_machine && (!cause || alarm.reaction > cause->reaction)) cause = &alarm;
    }
    stop_axes_of_slaves();
    stop_axes_of_programs();
    if (!cause) return;
    for (auto& axis : body_.axes) axis.stop_for_error(cause->fact.id, cause->reaction == Reaction::power_off);
}

}  // namespace taktwerk::runtime

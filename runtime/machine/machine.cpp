#include "runtime/machine/machine.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "axes/axis/plan_order.hpp"
#include "axes/drives/cia402/homing_startup.hpp"
#include "axes/sim/virtual_drive.hpp"
#include "runtime/check/machine_check.hpp"
#include "runtime/check/program_check.hpp"
#include "runtime/machine/machine_impl.hpp"
#include "runtime/present_slaves.hpp"
#include "runtime/recording/inbox_record.hpp"
#include "runtime/stop_time.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::size_t inbox_size = 64;
constexpr unsigned relaxed_factor = 100;                       // as Supervision documents
constexpr Duration shutdown_margin = std::chrono::seconds{5};  // for a drive that does not answer
constexpr auto no_slave = std::numeric_limits<std::size_t>::max();

/// What the axes need of the bus beyond what the file says: SDOs of drive homing, and no slave for an axis that is simulated.
ecat::BusConfig bus_of(const MachineConfig& config) {
    auto bus = config.bus;
    bus.cycle = config.cycle;
    bus.slaves = present_slaves(config);
    for (const auto& binding : config.axes) {
        if (binding.slave.empty() || !binding.profile || binding.axis.disabled) continue;
        for (auto& slave : bus.slaves) {
            if (slave.name != binding.slave) continue;
            const auto more = axes::cia402::homing_startup(binding.axis, *binding.profile, binding.drive_axis);
            slave.startup.insert(slave.startup.end(), more.begin(), more.end());
        }
    }
    // Without real time a stall of the host must not trip the slaves' watchdogs before it is even counted.
    if (config.simulation.supervision == Supervision::relaxed) {
        bus.lost_frames_limit = static_cast<std::uint16_t>(std::min(bus.lost_frames_limit * relaxed_factor, 60000u));
        for (auto& slave : bus.slaves)
            if (slave.sm_watchdog == Duration{}) slave.sm_watchdog = relaxed_watchdog;
        bus.lock_required = false;
    }
    return bus;
}

std::vector<std::vector<std::size_t>> drives_of_several_axes(const std::vector<std::size_t>& axis_slave, std::size_t slaves) {
    std::vector<std::vector<std::size_t>> out(slaves);
    for (std::size_t axis = 0; axis < axis_slave.size(); ++axis)
        if (axis_slave[axis] != no_slave) out[axis_slave[axis]].push_back(axis);
    std::erase_if(out, [](const auto& drive) { return drive.size() < 2; });
    return out;
}

}  // namespace

Machine::Impl::Impl(MachineConfig machine, ecat::Transport& transport, const std::vector<modbus::SerialLine*>& serial_lines,
                    std::vector<Error>& errors)
    : config(std::move(machine)),
      bus(transport, bus_of(config)),
      io(config.io),
      mode(config.start_mode),
      inbox(inbox_size),
      answers(inbox_size * 2),
      snapshots(),
      steps([] {
          std::array<std::string_view, step_count - 1> names{};
          for (std::size_t i = 0; i < names.size(); ++i) names[i] = name(static_cast<Step>(i));
          return names;
      }()),
      levels(config.axes.size()),
      stopped_at(config.axes.size()) {
    const auto on_bus = bus_of(config);
    build_lines(serial_lines, errors);
    axes.reserve(config.axes.size());
    stall_before_fault = std::make_unique<std::atomic<std::int64_t>[]>(config.axes.size());
    gap_before_fault = std::make_unique<std::atomic<std::uint32_t>[]>(config.axes.size());
    for (std::size_t i = 0; i < config.axes.size(); ++i) stall_before_fault[i].store(-1);
    views.resize(config.axes.size());
    drive_emergencies.resize(bus.slave_count());
    explained_until.resize(config.axes.size());
    for (std::size_t i = 0; i < config.axes.size(); ++i) {
        const auto& binding = config.axes[i];
        std::size_t slave = no_slave;
        for (std::size_t s = 0; s < bus.slave_count(); ++s)
            if (!binding.slave.empty() && bus.slave(s).name == binding.slave) slave = s;
        axis_slave.push_back(slave);
        if (serial_drive(binding) != nullptr) {
            // It stands in `ports`.
        } else if (slave == no_slave) {
            ports.push_back(std::make_unique<axes::sim::VirtualDrive>(config.cycle));
        } else {
            auto drive = std::make_unique<axes::cia402::Cia402Drive>(
                bus, slave, binding.drive_axis, binding.profile, ecat::exchange_period(on_bus, bus.slave(slave)),
                axes::cia402::AxisWants{binding.axis.gearing.counts_per_revolution, binding.stored});
            drives.push_back(drive.get());
            ports.push_back(std::move(drive));
        }
        auto axis_config = binding.axis;
        axis_config.stale_limit = static_cast<std::uint16_t>(std::min<std::uint32_t>(limit(axis_config.stale_limit), 60000));
        axes.emplace_back(axis_config, *ports.back(), config.cycle, static_cast<std::uint16_t>(i), &views[i]);
    }
    shared_drives = drives_of_several_axes(axis_slave, bus.slave_count());
    if (!config.retain.empty()) {
        positions = std::make_unique<PositionKeeper>(config.retain, config.axes, errors);
        positions->restore(axes);
    }
    operator_power.resize(axes.size());
    outputs_by_hand.resize(io.outputs().size());
    requests = WatchedRequests{axes};
    axis_claims.resize(axes.size());
    start_after.resize(config.programs.size());
    for (std::size_t p = 0; p < config.programs.size(); ++p)
        program_requests.emplace_back(requests, axis_claims, static_cast<std::uint16_t>(p));
    if (!config.emergency_stop.input.empty()) {
        estop_input = io.find(IoDirection::input, config.emergency_stop.input);
        if (!config.emergency_stop.restart.empty()) restart_input = io.find(IoDirection::input, config.emergency_stop.restart);
        const auto& terminal = io.point(IoDirection::input, static_cast<std::size_t>(estop_input)).slave;
        while (estop_slave < bus.slave_count() && bus.slave(estop_slave).name != terminal) ++estop_slave;
    }
    double longest_stop = 0;
    for (const auto& binding : config.axes) longest_stop = std::max(longest_stop, stop_seconds(binding.axis.limits));
    shutdown_patience = shutdown_margin + 2 * from_seconds(longest_stop);

    host = std::make_unique<ProgramHost>(config, io, tables, errors);
    for (auto& axis : axes) axis.bind({axes.data(), axes.size(), &tables, io.inputs()});  // the programs have declared their tables
    objects = std::make_unique<ObjectRequests>(config.programs.size(), bus.slave_count());
    program_states.assign(config.programs.size(), ProgramState::stopped);
    program_faults.resize(config.programs.size());
    program_undeclared.resize(config.programs.size());
    handshakes = std::make_unique<std::atomic<Handshake>[]>(config.programs.size());
    has_base_task.assign(config.programs.size(), 0);
    for (const auto& task : host->tasks())
        if (task.config.divisor == 1) has_base_task[task.program] = 1;
    for (std::size_t i = 0; i < host->tasks().size(); ++i) {
        const auto& task = host->tasks()[i];
        if (task.config.divisor == 1) {
            base_tasks.push_back(i);
            continue;
        }
        std::vector<ProgramHost::Variable> variables;
        if (!has_base_task[task.program])
            for (const auto& variable : host->variables())
                if (variable.program == task.program) variables.push_back(variable);
        slow_task_places.push_back(i);
        slow_tasks.push_back(std::make_unique<SlowTask>(task, host->programs()[task.program].instance.get(), std::move(variables),
                                                        axes.size(), io.inputs().size(), io.outputs().size(), host->parameters().size(),
                                                        objects->of(task.program), tables));
    }
    task_overruns.assign(slow_tasks.size(), 0);
    base_scans.assign(base_tasks.size(), 0);
    for (const auto& variable : host->variables()) variable_values.push_back(ProgramHost::read(variable));
    task_statistics.resize(host->tasks().size());

    layout.machine = config.name;
    layout.cycle = config.cycle;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto& binding = config.axes[i];
        const bool on_line = !binding.drive.empty() && !binding.axis.simulated;
        layout.axes.push_back({binding.axis.name, binding.axis.unit, binding.axis.disabled, axis_slave[i] == no_slave && !on_line,
                               views[i].manual_slow, views[i].manual_fast, "", "", binding.drive_axis});
        auto& info = layout.axes.back();
        if (axis_slave[i] != no_slave) info.drive = binding.slave;
        else if (on_line && !lines.empty()) info.drive = binding.drive;
        if (!info.drive.empty() && binding.profile) info.profile = binding.profile->name;
    }
    layout.interface = config.bus.interface;
    for (const auto& line : config.serial)
        if (!line.device.empty()) layout.serial_devices.push_back(line.device);
    for (std::size_t s = 0; s < bus.slave_count(); ++s) layout.slaves.push_back(bus.slave(s).name);
    layout.inputs = io.names(IoDirection::input);
    layout.outputs = io.names(IoDirection::output);
    host->describe(layout);
}

Result<void> Machine::Impl::arm() {
    for (auto* drive : drives)
        if (auto ok = drive->resolve(); !ok) return ok;
    if (!outputs_laid_out.load(std::memory_order_relaxed))
        if (auto ok = io.resolve(bus); !ok) return ok;
    for (auto& task : slow_tasks) task->learn_outputs(io.output_bits());

    Snapshot prototype;
    prototype.slaves.resize(bus.slave_count());
    prototype.axes.resize(axes.size());
    prototype.inputs.resize(io.inputs().size());
    prototype.outputs.resize(io.outputs().size());
    prototype.parameters.resize(host->parameters().size());
    prototype.variables.resize(host->variables().size());
    prototype.programs.resize(config.programs.size());
    prototype.tasks.resize(task_statistics.size());
    prototype.alarms.resize(AlarmLog::capacity);
    prototype.simulated = config.bus.interface.empty();
    for (int i = 0; i < 3; ++i) {  // each of the three buffers gets its full size once
        snapshots.back() = prototype;
        snapshots.publish();
        (void)snapshots.read();
    }
    const auto operating = mode == Mode::automatic ? axes::OperatingMode::automatic
                           : mode == Mode::setup   ? axes::OperatingMode::setup
                                                   : axes::OperatingMode::manual;
    for (auto& axis : axes) axis.set_mode(operating);
    if (mode == Mode::automatic)
        for (std::size_t p = 0; p < config.programs.size(); ++p)
            if (config.programs[p].autostart) (void)start_program(p, 0);
    phase.store(MachinePhase::running, std::memory_order_release);
    armed.store(true, std::memory_order_release);
    return {};
}

void Machine::Impl::lay_out_outputs() {
    using Phase = ecat::Master::Phase;
    const auto at = bus.phase();
    const bool planned = at == Phase::configuring || at == Phase::safeop || at == Phase::operational;
    if (!planned || armed.load(std::memory_order_relaxed) || outputs_laid_out.load(std::memory_order_relaxed)) return;
    // What cannot be resolved is told by arm().
    if (io.resolve(bus)) outputs_laid_out.store(true, std::memory_order_release);
}

void Machine::Impl::cycle(const CycleTick& tick) noexcept {
    const Stopwatch whole;
    const bool runs = armed.load(std::memory_order_acquire);
    if (recorder) record_tick(*recorder, tick);
    if (runs) now = tick.scheduled;
    const bool at_tick = config.send == SendMode::at_tick;
    steps.begin();

    bus.receive(tick.scheduled);
    if (at_tick) bus.send(tick.scheduled);  // what the cycle before has computed, always at the same instant
    steps.done(static_cast<std::size_t>(Step::receive));

    if (runs) {
        objects->take_answers(recorder, now);
        take_levels(now);
        requests.speak_for(no_program, now);
        drain_inbox(now);
        steps.done(static_cast<std::size_t>(Step::inbox));

        io.read(bus.inputs());
        steps.done(static_cast<std::size_t>(Step::decode));

        for (std::size_t i = 0; i < axes.size(); ++i) axes[i].update(now);
        if (recorder) record_samples();
        steps.done(static_cast<std::size_t>(Step::update));

        supervise(now, tick);
        steps.done(static_cast<std::size_t>(Step::supervise));

        requests.speak_for(no_program, now);
        renew_operator_power();
        run_tasks();
        hold_watchdog_outputs();
        steps.done(static_cast<std::size_t>(Step::tasks));

        axes::plan_axes(axes, now, config.cycle);
        requests.end_of_cycle(now, emergency || shutting_down, program_states);
        steps.done(static_cast<std::size_t>(Step::plan));

        const Instant send_time = at_tick ? now + config.cycle : now;
        for (auto& axis : axes) axis.encode(send_time);
        io.write(bus.outputs());
        steps.done(static_cast<std::size_t>(Step::encode));
    } else {
        take_levels(tick.scheduled);
        if (shutdown_taken) phase.store(MachinePhase::stopped, std::memory_order_release);
        if (outputs_laid_out.load(std::memory_order_acquire)) io.write(bus.outputs());
    }

    if (!at_tick) bus.send(tick.scheduled);
    steps.done(static_cast<std::size_t>(Step::send));

    if (runs) {
        statistics.cycles = ++cycles;
        statistics.missed_ticks += tick.missed;
        if (tick.missed > 0) ++statistics.overruns;
        statistics.lateness = tick.woken - tick.scheduled;
        statistics.lateness_max = std::max(statistics.lateness_max, statistics.lateness);
        take_snapshot();
        if (trace) take_trace();
        if (positions) positions->watch(axes, now, shutting_down);
    }
    steps.done(static_cast<std::size_t>(Step::snapshot));
    steps.end();
    statistics.compute = Stopwatch{whole}.lap();
    statistics.compute_max = std::max(statistics.compute_max, statistics.compute);
    pulse_cycles.fetch_add(1, std::memory_order_relaxed);
}

// --- the public face --------------------------------------------------------------------------------------------------------

Machine::Machine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Machine::~Machine() = default;

std::variant<std::unique_ptr<Machine>, std::vector<Error>> Machine::build(MachineConfig config, ecat::Transport& transport,
                                                                          std::vector<modbus::SerialLine*> lines) {
    auto errors = check(config);
    if (!errors.empty()) {
        // What the programs have wrong is told in the same breath: nobody wants to mend a file twice.
        const auto of_programs = check_programs(config);
        errors.insert(errors.end(), of_programs.begin(), of_programs.end());
        return errors;
    }
    auto impl = std::make_unique<Impl>(std::move(config), transport, lines, errors);
    if (!errors.empty()) return errors;
    return std::unique_ptr<Machine>(new Machine(std::move(impl)));
}

void Machine::start_bus() {
    if (!impl_->armed.load(std::memory_order_relaxed)) impl_->outputs_laid_out.store(false, std::memory_order_release);
    impl_->bus.start();
}
void Machine::stop_bus() { impl_->bus.stop(); }
void Machine::service(Instant now) {
    service_bus(now);
    service_programs();
    service_disk(now);
}
void Machine::service_bus(Instant now) {
    impl_->bus.step(now);
    impl_->lay_out_outputs();
    for (auto& line : impl_->lines)
        if (line) line->step(now);
    for (auto& port : impl_->ports) port->step(now);
    impl_->objects->step(impl_->bus);
}
void Machine::service_programs() { impl_->service_programs(); }
void Machine::service_disk(Instant now) {
    if (impl_->positions) impl_->positions->step(now);
}
Result<void> Machine::arm() { return impl_->arm(); }
bool Machine::bus_operational() const noexcept { return impl_->bus.phase() == ecat::Master::Phase::operational; }
std::optional<Error> Machine::bus_failure() const {
    if (impl_->bus.phase() == ecat::Master::Phase::failed) return impl_->bus.failure();
    return std::nullopt;
}
std::string Machine::bus_progress() const { return impl_->bus.progress(); }
void Machine::cycle(const CycleTick& tick) noexcept { impl_->cycle(tick); }
void Machine::pump(Instant now) noexcept { impl_->bus.pump(now); }
void Machine::run_slow_tasks() noexcept {
    for (auto& task : impl_->slow_tasks) task->run_if_released();
}
std::size_t Machine::slow_task_count() const noexcept { return impl_->slow_tasks.size(); }
bool Machine::run_slow_task(std::size_t index) noexcept { return impl_->slow_tasks[index]->run_if_released(); }
bool Machine::submit(const OperatorCommand& command) noexcept { return impl_->inbox.try_push(command); }
std::optional<CommandAnswer> Machine::next_answer() noexcept {
    CommandAnswer answer;
    if (!impl_->answers.try_pop(answer)) return std::nullopt;
    return answer;
}
const Snapshot* Machine::latest() noexcept {
    const auto reading = impl_->snapshots.read();
    return reading.value->cycle > 0 ? reading.value : nullptr;
}
StopLevels::Ticket Machine::request_stop(std::uint16_t axis) noexcept { return impl_->levels.stop(axis); }
StopLevels::Ticket Machine::release_jog(std::uint16_t axis) noexcept { return impl_->levels.release_jog(axis); }
StopLevels::Ticket Machine::request_shutdown() noexcept {
    impl_->shutdown_asked.store(true, std::memory_order_release);
    return impl_->levels.shutdown();
}
bool Machine::taken(StopLevels::Ticket ticket) const noexcept { return impl_->levels.taken(ticket); }
std::uint64_t Machine::levels_raised() const noexcept { return impl_->levels.raised(); }
bool Machine::shutdown_asked() const noexcept { return impl_->shutdown_asked.load(std::memory_order_acquire); }
Duration Machine::longest_stop() const noexcept { return impl_->shutdown_patience; }
Machine::Pulse Machine::pulse() const noexcept {
    return {impl_->pulse_cycles.load(std::memory_order_relaxed), impl_->pulse_task.load(std::memory_order_relaxed)};
}
Machine::TaskNames Machine::task_names(std::size_t task) const {
    const auto& found = impl_->host->tasks()[task];
    return {found.config.program, found.config.name};
}
std::string Machine::program_at_work() const {
    for (const auto& task : impl_->slow_tasks)
        if (!task->finished()) return fmt::format("task '{}' of program '{}'", task->config().name, task->config().program);
    if (const auto program = impl_->at_hooks.load(std::memory_order_relaxed); program >= 0)
        return fmt::format("start() or stop() of program '{}'", impl_->config.programs[static_cast<std::size_t>(program)].name);
    return {};
}
bool Machine::disk_at_work() const noexcept { return impl_->positions && impl_->positions->writing(); }
axes::DrivePort* Machine::drive_port(std::size_t axis) noexcept {
    const bool on_drive = axis < impl_->ports.size() && !impl_->layout.axes[axis].drive.empty();
    return on_drive ? impl_->ports[axis].get() : nullptr;
}
MachinePhase Machine::phase() const noexcept { return impl_->phase.load(std::memory_order_acquire); }
std::string Machine::program_fault(std::size_t program) const {
    const std::lock_guard lock{impl_->fault_words};
    return impl_->host->programs()[program].fault;
}
void Machine::record(Recorder& recorder) noexcept {
    impl_->recorder = &recorder;
    impl_->bus.set_tap(&record_frame, &recorder);
}
TraceRing& Machine::enable_trace(std::size_t rows) {
    impl_->trace = std::make_unique<TraceRing>(impl_->trace_columns(), rows);
    return *impl_->trace;
}
const StepStatistics<step_count - 1>& Machine::step_statistics() const noexcept { return impl_->steps; }
void Machine::reset_step_statistics() noexcept { impl_->steps.reset(); }
const MachineConfig& Machine::config() const noexcept { return impl_->config; }
const MachineLayout& Machine::layout() const noexcept { return impl_->layout; }
const ecat::Master& Machine::bus() const noexcept { return impl_->bus; }
ecat::Master& Machine::bus() noexcept { return impl_->bus; }

}  // namespace taktwerk::runtime

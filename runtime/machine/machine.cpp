// The public face of a machine: who is asked what.

#include "runtime/machine/machine.hpp"

#include <new>

#include <fmt/format.h>

#include "runtime/check/machine_check.hpp"
#include "runtime/check/program_check.hpp"
#include "runtime/machine/machine_impl.hpp"

namespace taktwerk::runtime {

Machine::Machine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Machine::~Machine() = default;

std::variant<std::unique_ptr<Machine>, std::vector<Error>> Machine::build(MachineConfig config, ecat::Transport& transport,
                                                                          std::vector<modbus::SerialLine*> lines,
                                                                          std::vector<modbus::tcp::Exchange*> exchanges) {
    auto errors = check(config);
    if (!errors.empty()) {
        // What the programs have wrong is told in the same breath: nobody wants to mend a file twice.
        const auto of_programs = check_programs(config);
        errors.insert(errors.end(), of_programs.begin(), of_programs.end());
        return errors;
    }
    const auto depth = config.recording.depth;
    std::unique_ptr<Impl> impl;
    try {
        impl = std::make_unique<Impl>(std::move(config), transport, lines, exchanges, errors);
    } catch (const std::bad_alloc&) {  // by far the most of it is what is recorded
        errors.push_back({"recording.memory", "recording.depth",
                          fmt::format("this computer has no memory for {:g} s of every signal of every cycle", to_seconds(depth)),
                          "write a shorter `recording: {depth: ...}`"});
    }
    if (!errors.empty()) return errors;
    return std::unique_ptr<Machine>(new Machine(std::move(impl)));
}

// --- service side -----------------------------------------------------------------------------------------------------------

void Machine::start_bus() {
    impl_->note(Call::start_bus);
    if (!impl_->body.armed.load(std::memory_order_relaxed)) impl_->outputs_laid_out.store(false, std::memory_order_release);
    impl_->body.bus.start();
}
void Machine::stop_bus() {
    impl_->note(Call::stop_bus);
    impl_->body.bus.stop();
}
void Machine::service(Instant now) {
    impl_->note(Call::service, now);
    impl_->service_bus(now);
    impl_->body.axis_groups.service();
    impl_->programs.call_hooks();
    impl_->service_disk(now);
    for (std::size_t i = 0; i < modbus_count(); ++i) service_modbus(i, now);
}
void Machine::service_bus(Instant now) {
    impl_->note(Call::bus, now);
    impl_->service_bus(now);
    if (impl_->in_order()) impl_->body.axis_groups.service();
}
void Machine::service_groups() {
    if (!impl_->in_order()) impl_->body.axis_groups.service();
}
std::size_t Machine::group_count() const noexcept { return impl_->body.axis_groups.size(); }
void Machine::service_programs() {
    impl_->note_beside(Call::programs);
    impl_->programs.call_hooks();
}
void Machine::service_disk(Instant now) { impl_->service_disk(now); }
std::size_t Machine::modbus_count() const noexcept { return impl_->modbus.count(); }
void Machine::service_modbus(std::size_t device, Instant now) {
    if (!impl_->body.replayed) impl_->modbus.step(device, now);
}
bool Machine::end_modbus(std::size_t device, Instant now) { return impl_->modbus.finish(device, now); }
Result<void> Machine::arm() {
    auto done = impl_->arm();
    impl_->note(Call::arm, {}, done.ok() ? 1 : 0);
    return done;
}
bool Machine::bus_operational() const noexcept { return bus().phase() == ecat::Master::Phase::operational; }
std::optional<Error> Machine::bus_failure() const {
    if (bus().phase() == ecat::Master::Phase::failed) return bus().failure();
    return std::nullopt;
}
std::string Machine::bus_progress() const { return bus().progress(); }
AlarmText Machine::describe(const AlarmFact& fact) const { return impl_->words.describe(fact); }
axes::DrivePort* Machine::drive_port(std::size_t axis) noexcept {
    const bool on_drive = axis < impl_->layout.axes.size() && !impl_->layout.axes[axis].drive.empty();
    return on_drive ? &impl_->asked.port(axis) : nullptr;
}
BusLook& Machine::bus_look() noexcept { return impl_->look; }
std::string Machine::program_fault(std::size_t program) const { return impl_->programs.fault(program); }

// --- cycle ------------------------------------------------------------------------------------------------------------------

void Machine::cycle(const CycleTick& tick) noexcept { impl_->cycle(tick); }
void Machine::pump(Instant now) noexcept {
    impl_->note(Call::pump, now);
    impl_->body.bus.pump(now);
}
void Machine::run_slow_tasks() noexcept {
    for (std::size_t i = 0; i < slow_task_count(); ++i) (void)run_slow_task(i);
}
std::size_t Machine::slow_task_count() const noexcept { return impl_->programs.slow_task_count(); }
bool Machine::run_slow_task(std::size_t index) noexcept {
    const bool ran = impl_->programs.run_slow_task(index);
    if (ran) impl_->note_beside(Call::slow_task, index);
    return ran;
}

// --- between the two ----------------------------------------------------------------------------------------------------------

bool Machine::submit(const OperatorCommand& command) noexcept { return impl_->desk.submit(command); }
std::optional<CommandAnswer> Machine::next_answer() noexcept { return impl_->desk.next_answer(); }
const Snapshot* Machine::latest() noexcept { return impl_->snapshots.latest(); }
StopLevels::Ticket Machine::request_stop(std::uint16_t axis) noexcept { return impl_->desk.levels().stop(axis); }
bool Machine::next_measure_sample(axes::MeasureSample& out) noexcept { return impl_->measuring.next_sample(out); }
StopLevels::Ticket Machine::release_jog(std::uint16_t axis) noexcept { return impl_->desk.levels().release_jog(axis); }
StopLevels::Ticket Machine::request_shutdown() noexcept { return impl_->desk.request_shutdown(); }
bool Machine::taken(StopLevels::Ticket ticket) const noexcept { return impl_->desk.levels().taken(ticket); }
std::uint64_t Machine::levels_raised() const noexcept { return impl_->desk.levels().raised(); }
bool Machine::shutdown_asked() const noexcept { return impl_->desk.shutdown_asked(); }
void Machine::tell_page_faults(const FaultsSeen& seen) noexcept { impl_->supervisor.page_faults().tell(seen); }
Duration Machine::longest_stop() const noexcept { return impl_->supervisor.longest_stop(); }
Machine::Pulse Machine::pulse() const noexcept {
    return {impl_->pulse_cycles.load(std::memory_order_relaxed), impl_->programs.base_task_at_work()};
}
Machine::TaskNames Machine::task_names(std::size_t task) const {
    const auto& found = impl_->programs.host().tasks()[task];
    return {found.config.program, found.config.name};
}
std::string Machine::program_at_work() const { return impl_->programs.at_work(); }
std::span<const RetainNote> Machine::retain_notes() const noexcept {
    return impl_->retain ? std::span<const RetainNote>{impl_->retain->notes()} : std::span<const RetainNote>{};
}
bool Machine::disk_at_work() const noexcept { return impl_->retain && impl_->retain->writing(); }
MachinePhase Machine::phase() const noexcept { return impl_->body.phase.load(std::memory_order_acquire); }
void Machine::record(Recorder& recorder, RecordedThreads threads) {
    impl_->outcome.begin();
    impl_->body.recorder = &recorder;
    impl_->body.calls = &recorder;
    impl_->body.threads_beside = threads == RecordedThreads::several;
    impl_->body.wire.record(recorder);
    record_wire(recorder, impl_->body.wire.mac(), impl_->body.wire.ring() != nullptr);
}
ReplayedInbox& Machine::replayed() noexcept { return impl_->replayed; }
SignalRing& Machine::signals() noexcept { return impl_->rows.ring(); }
const SignalRing& Machine::signals() const noexcept { return impl_->rows.ring(); }
const StepStatistics<step_count - 1>& Machine::step_statistics() const noexcept { return impl_->steps; }
void Machine::reset_step_statistics() noexcept { impl_->steps.reset(); }
MachineTimes Machine::times() const noexcept {
    const auto& tasks = impl_->programs.times();
    return {&impl_->times, &tasks.runs(), &tasks.lateness()};
}
void Machine::tell_measured_times() noexcept { impl_->programs.times().tell_measured(); }
const TaskConfig& Machine::slow_task(std::size_t index) const noexcept { return impl_->programs.slow_task(index).config(); }
Instant Machine::slow_task_released(std::size_t index) const noexcept { return impl_->programs.slow_task(index).last_release(); }
const MachineConfig& Machine::config() const noexcept { return impl_->body.config; }
const MachineLayout& Machine::layout() const noexcept { return impl_->layout; }
const ecat::Master& Machine::bus() const noexcept { return impl_->body.bus; }
ecat::Master& Machine::bus() noexcept { return impl_->body.bus; }

}  // namespace taktwerk::runtime

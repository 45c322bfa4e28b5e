// Step 6: the programs' tasks. The base tasks run here, inline; slower ones are applied and released. And what programs have to say: their
// alarms, their variables. Real-time safe.

#include <algorithm>

#include "core/stopwatch.hpp"
#include "runtime/machine/alarm_ranges.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

void ProgramRunner::run_base_task(BaseTask& base, std::uint32_t missed_ticks) noexcept {
    const auto& task = host_.tasks()[base.place];
    auto& program = host_.programs()[task.program];
    auto& record = programs_[task.program];
    TaskContext context;
    context.now = body_.now;
    context.period = body_.config.cycle;
    context.cycle = base.scans++;
    context.axes = body_.views;
    context.requests = &record.requests;
    context.groups = &record.groups;
    body_.requests.speak_for(static_cast<std::uint16_t>(task.program), body_.now);
    context.objects = &objects_.of(task.program);
    context.owner = axes::Owner::program;
    context.tables = &body_.tables;
    context.inputs = body_.io.inputs();
    context.input_values = body_.io.input_values();
    context.output_lines = body_.io.output_lines();
    context.outputs = body_.io.outputs();
    context.output_bits = body_.io.output_bits();
    context.parameters = host_.parameters();
    context.alarms = program.alarms;
    context.first_scan = context.cycle == 0;
    const auto info = times_.info(base.place, body_.config.cycle, missed_ticks);
    context.task_info = &info;
    values_.apply(base.place);
    for (const auto& block : base.warm) block.type->warm_start(block.address, context.now);
    base.warm.clear();
    pulse_task_.store(static_cast<std::int32_t>(base.place), std::memory_order_relaxed);
    try {
        const ProgramCode code{task.config.program.c_str(), task.config.name.c_str()};
        task.function(program.instance.get(), context);
        program.alarms = context.alarms;
        if (context.undeclared.what != TaskContext::Undeclared::What::nothing) record.undeclared = context.undeclared;
    } catch (...) {  // a program is foreign code: what it throws ends here, and the axes stop
        FaultText why;
        why.take_current();
        failed(task.program, why);
    }
    pulse_task_.store(-1, std::memory_order_relaxed);
    if (context.task_asked) record_times(base.place, info);
}

void ProgramRunner::record_times(std::size_t place, const TaskInfo& told) noexcept {
    if (body_.recorder == nullptr || !body_.threads_beside) return;  // in virtual time it is 0
    record_task_times(*body_.recorder, body_.now, TaskTimesRecord::of(static_cast<std::uint16_t>(place), told));
}

void ProgramRunner::release_slow_task(SlowPlace& slow) noexcept {
    auto& task = *slow.task;
    const auto p = task.program();
    auto& program = programs_[p];
    const bool runs = program.running();
    body_.requests.speak_for(static_cast<std::uint16_t>(p), body_.now);
    if (runs) task.renew(program.requests);
    if (!task.due(body_.cycles)) return;
    if (!slow.finished) {
        if (!runs) return;  // there is no release to miss
        times_.overrun(slow.place);
        slow.watch.missed();
        return;
    }
    const auto missed = slow.watch.overruns();
    slow.watch.in_time();
    if (!runs) {
        task.forget();
        return;
    }
    if (task.threw()) {
        failed(p, task.fault());
        task.forget();
        return;
    }
    if (task.undeclared().what != TaskContext::Undeclared::What::nothing) program.undeclared = task.undeclared();
    auto& alarms = host_.programs()[p].alarms;
    auto& io = body_.io;
    const auto applied = task.applied();
    task.apply(program.requests, io.outputs(), alarms);
    if (task.applied() != applied)                                                         // at its first release there is no run before
        times_.book(slow.place, task.last_run(), task.last_lateness(), body_.cycles + 1);  // of this cycle, which is not over
    task.set_write_count(values_.take(slow.place, task.writes()));
    CycleContext context;
    context.now = body_.now;
    context.period = body_.config.cycle;
    task.tell(times_.info(slow.place, body_.config.cycle * static_cast<Duration::rep>(task.config().divisor), missed));
    slow.finished = false;
    slow.watch.begin(body_.cycles);
    task.release(context, body_.views, {io.inputs(), io.input_values()}, io.outputs(), host_.parameters(), alarms);
}

// Its image is its own: what it still does reaches nobody. The axes that its program powers or moves stop along their ramps, the outputs that no
// other program drives become safe, everything else goes on.
void ProgramRunner::judge(SlowPlace& slow) noexcept {
    const auto p = slow.task->program();
    auto& program = programs_[p];
    if (program.state == ProgramState::stopped && !slow.finished) slow.watch.left_behind();
    const auto verdict = slow.watch.verdict(body_.cycles);
    if (verdict == TaskVerdict::in_time) return;
    if (!program.running()) {
        // A person has stopped it: who asks why it does not start again is to find the task that has not come back.
        if (program.state != ProgramState::stopped || slow.finished || verdict != TaskVerdict::watchdog || program.stopped_by.task())
            return;
        program.stopped_by.set(slow.place, verdict);
        slow.taken = milliseconds(slow.watch.cycles_taken(body_.cycles));
        return;
    }
    program.stopped_by.set(slow.place, verdict);
    slow.taken = verdict == TaskVerdict::late ? slow.watch.overruns() : milliseconds(slow.watch.cycles_taken(body_.cycles));
    objects_.close(p);
    stop(p, ProgramState::fault);
}

// Only while neither a task nor start() nor stop() of the program is at work: they have its variables then.
void ProgramRunner::write_values_at_rest() noexcept {
    for (std::size_t p = 0; p < programs_.size(); ++p) {
        const auto& program = programs_[p];
        if (program.running() || program.handshake.load(std::memory_order_acquire) != Handshake::none || !slow_tasks_at_rest(p)) continue;
        if (!values_.apply_at_rest(p, variable_values_)) continue;
        for (auto& slow : slow_tasks_)
            if (slow.task->program() == p) slow.task->show_variables();
    }
}

void ProgramRunner::run_tasks(std::uint32_t missed_ticks) noexcept {
    take_handshakes();
    if (body_.emergency) values_.let_go_all();
    values_.end_leases(body_.now);
    write_values_at_rest();
    for (auto& slow : slow_tasks_) {
        release_slow_task(slow);
        judge(slow);
    }
    longest_base_task_ = {};
    for (auto& base : base_tasks_) {
        if (!programs_[host_.tasks()[base.place].program].running()) continue;
        const Stopwatch watch;
        run_base_task(base, missed_ticks);
        const auto run = Stopwatch{watch}.lap();
        times_.book(base.place, run, body_.statistics.lateness, body_.cycles + 1);
        if (run > body_.config.cycle) times_.overrun(base.place);
        if (run > longest_base_task_.run) longest_base_task_ = {base.place, run};
    }
}

void ProgramRunner::raise_alarms_of(std::size_t p) noexcept {
    using Undeclared = TaskContext::Undeclared;
    const auto index = static_cast<std::uint16_t>(p);
    const auto& program = host_.programs()[p];
    const auto& record = programs_[p];
    if (record.state == ProgramState::fault && !record.stopped_by.task())
        body_.raise(MachineAlarm::program_fault, AlarmSource::program, index);
    auto undeclared = record.undeclared;
    for (std::size_t n = 0; n < program.alarm_texts.size(); ++n) {
        const auto& text = program.alarm_texts[n];
        if (!((program.alarms >> n) & 1u)) continue;
        if (!text.declared) {
            undeclared = {Undeclared::What::alarm, static_cast<std::uint8_t>(n)};
            continue;
        }
        body_.log.raise({alarm_range::programs.id(n), AlarmSource::program, index, 0, 0}, text.reaction, ResetRule::self_clearing,
                        body_.now);
    }
    if (undeclared.what == Undeclared::What::not_a_number && record.running())
        body_.raise(MachineAlarm::output_no_number, AlarmSource::program, index);
    else if (undeclared.what != Undeclared::What::nothing && record.running())
        body_.raise(MachineAlarm::undeclared_use, AlarmSource::program, index, undeclared.number,
                    undeclared.what == Undeclared::What::alarm ? 1 : 0);
}

double ProgramRunner::milliseconds(std::uint64_t cycles) const noexcept {
    return static_cast<double>(cycles) * to_seconds(body_.config.cycle) * 1e3;
}

void ProgramRunner::raise_alarms_of_task(const SlowPlace& slow) noexcept {
    const auto& task = slow.task->config();
    const auto place = static_cast<std::uint16_t>(slow.place);
    const auto& program = programs_[slow.task->program()];
    const auto overruns = slow.watch.overruns();
    if (task.overrun == OverrunReaction::stop_machine && overruns > slow.watch.overruns_allowed() && program.running())
        body_.raise(MachineAlarm::task_overrun, AlarmSource::task, place, overruns, slow.watch.overruns_allowed());
    // Also behind a reset, for as long as its thread has not come back: its program cannot be started, and this says why.
    if (program.stopped_by.task() != slow.place || (program.state != ProgramState::fault && slow.finished)) return;
    if (program.stopped_by.verdict() == TaskVerdict::late)
        body_.raise(MachineAlarm::task_late, AlarmSource::task, place, slow.taken, slow.watch.overruns_allowed());
    else body_.raise(MachineAlarm::task_watchdog, AlarmSource::task, place, slow.taken, milliseconds(slow.watch.watchdog()));
}

void ProgramRunner::raise_alarms() noexcept {
    for (const auto& slow : slow_tasks_) raise_alarms_of_task(slow);
    for (std::size_t p = 0; p < programs_.size(); ++p) raise_alarms_of(p);
}

// Variables of a program that does not run keep their last values here: start() and stop() may be writing them on the service side.
void ProgramRunner::read_variables() noexcept {
    const auto& variables = host_.variables();
    for (std::size_t i = 0; i < variables.size(); ++i) {
        const auto& program = programs_[variables[i].program];
        if (!shown_by_slow_[i] && program.running()) variable_values_[i] = ProgramHost::read(variables[i]);
    }
    for (const auto& slow : slow_tasks_) {  // as its last applied run left them
        const auto values = slow.task->variables();
        if (slow.task->applied() == 0) continue;
        for (std::size_t i = 0; i < values.size(); ++i) variable_values_[slow.shows[i]] = values[i];
    }
}

// A program at rest is read directly: nothing of it is at work, so that what its stop() has done is kept, too.
void ProgramRunner::read_retained() noexcept {
    const auto& items = host_.retained();
    const auto at_rest = [&](std::size_t p) {
        return !programs_[p].running() && programs_[p].handshake.load(std::memory_order_acquire) == Handshake::none &&
               slow_tasks_at_rest(p);
    };
    for (std::size_t i = 0; i < items.size(); ++i) {
        const auto p = items[i].program;
        const bool between_scans = programs_[p].running() && !kept_by_slow_[i];
        if (between_scans || at_rest(p)) retained_.take(i, items[i].address, items[i].size);
    }
    for (const auto& slow : slow_tasks_) {
        const auto bytes = slow.task->kept();
        if (bytes.empty() || !programs_[slow.task->program()].running()) continue;
        const auto* from = bytes.data();
        for (const auto place : slow.keeps) {
            retained_.take(place, from, items[place].size);
            from += items[place].size;
        }
    }
}

}  // namespace taktwerk::runtime

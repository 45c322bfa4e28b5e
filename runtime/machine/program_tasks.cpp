// Step 6: the programs' tasks. The base tasks run here, inline; slower ones are applied and released. And what programs have to say: their
// alarms, their variables. Real-time safe.

#include <algorithm>

#include "core/stopwatch.hpp"
#include "runtime/machine/alarm_ranges.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

void ProgramRunner::run_base_task(BaseTask& base) noexcept {
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
}

void ProgramRunner::book(std::size_t place, Duration run) noexcept {
    auto& numbers = task_statistics_[place];
    numbers.run = run;
    numbers.run_max = std::max(numbers.run_max, run);
    ++numbers.releases;
    task_times_[place].record(run, body_.cycles + 1);  // of this cycle, which is not over
}

void ProgramRunner::reset_statistics() noexcept {
    for (auto& numbers : task_statistics_) numbers.run_max = {};
    for (auto& times : task_times_) times.reset();
}

void ProgramRunner::release_slow_task(SlowPlace& slow) noexcept {
    auto& task = *slow.task;
    const auto p = task.program();
    auto& program = programs_[p];
    const bool runs = program.running();
    body_.requests.speak_for(static_cast<std::uint16_t>(p), body_.now);
    if (runs) task.renew(program.requests);
    if (!task.due(body_.cycles)) return;
    auto& numbers = task_statistics_[slow.place];
    if (!slow.finished) {
        ++numbers.overruns;
        if (slow.overruns < 0xFFFF) ++slow.overruns;
        return;
    }
    slow.overruns = 0;
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
    task.apply(program.requests, io.outputs(), alarms);
    book(slow.place, task.last_run());
    task.set_write_count(values_.take(slow.place, task.writes()));
    CycleContext context;
    context.now = body_.now;
    context.period = body_.config.cycle;
    slow.finished = false;
    task.release(context, body_.views, {io.inputs(), io.input_values()}, io.outputs(), host_.parameters(), alarms);
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

void ProgramRunner::run_tasks() noexcept {
    take_handshakes();
    if (body_.emergency) values_.let_go_all();
    values_.end_leases(body_.now);
    write_values_at_rest();
    for (auto& slow : slow_tasks_) release_slow_task(slow);
    longest_base_task_ = {};
    for (auto& base : base_tasks_) {
        if (!programs_[host_.tasks()[base.place].program].running()) continue;
        const Stopwatch watch;
        run_base_task(base);
        auto& numbers = task_statistics_[base.place];
        book(base.place, Stopwatch{watch}.lap());
        if (numbers.run > body_.config.cycle) ++numbers.overruns;
        if (numbers.run > longest_base_task_.run) longest_base_task_ = {base.place, numbers.run};
    }
}

void ProgramRunner::raise_alarms_of(std::size_t p) noexcept {
    using Undeclared = TaskContext::Undeclared;
    const auto index = static_cast<std::uint16_t>(p);
    const auto& program = host_.programs()[p];
    const auto& record = programs_[p];
    if (record.state == ProgramState::fault) body_.raise(MachineAlarm::program_fault, AlarmSource::program, index);
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

void ProgramRunner::raise_alarms() noexcept {
    for (const auto& slow : slow_tasks_) {
        const auto& task = slow.task->config();
        if (task.overrun == OverrunReaction::stop_machine && slow.overruns > task.overruns_allowed)
            body_.raise(MachineAlarm::task_overrun, AlarmSource::task, static_cast<std::uint16_t>(slow.place), slow.overruns,
                        task.overruns_allowed);
    }
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

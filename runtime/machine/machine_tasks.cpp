// Step 6: the programs' tasks. The base tasks run here, inline; slower ones are applied and released. Real-time safe.

#include <algorithm>
#include <string>

#include "runtime/machine/machine_impl.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

void Machine::Impl::program_failed(std::size_t program, const FaultText& why) noexcept {
    program_faults[program] = why;
    stop_program(program, ProgramState::fault);
}

void Machine::Impl::run_base_task(std::size_t index) noexcept {
    const auto& task = host->tasks()[base_tasks[index]];
    auto& program = host->programs()[task.program];
    TaskContext context;
    context.now = now;
    context.period = config.cycle;
    context.cycle = base_scans[index]++;
    context.axes = views;
    context.requests = &program_requests[task.program];
    requests.speak_for(static_cast<std::uint16_t>(task.program), now);
    context.objects = &objects->of(task.program);
    context.owner = axes::Owner::program;
    context.tables = &tables;
    context.inputs = io.inputs();
    context.outputs = io.outputs();
    context.output_bits = io.output_bits();
    context.parameters = host->parameters();
    context.alarms = program.alarms;
    context.first_scan = context.cycle == 0;
    pulse_task.store(static_cast<std::int32_t>(base_tasks[index]), std::memory_order_relaxed);
    try {
        const ProgramCode code{task.config.program.c_str(), task.config.name.c_str()};
        task.function(program.instance.get(), context);
        program.alarms = context.alarms;
        if (context.undeclared.what != TaskContext::Undeclared::What::nothing) program_undeclared[task.program] = context.undeclared;
    } catch (...) {  // a program is foreign code: what it throws ends here, and the axes stop
        FaultText why;
        why.take_current();
        program_failed(task.program, why);
    }
    pulse_task.store(-1, std::memory_order_relaxed);
}

void Machine::Impl::run_slow_releases() noexcept {
    for (std::size_t i = 0; i < slow_tasks.size(); ++i) {
        auto& task = *slow_tasks[i];
        const auto program = task.program();
        const bool runs = program_states[program] == ProgramState::running;
        requests.speak_for(static_cast<std::uint16_t>(program), now);
        if (runs) task.renew(program_requests[program]);
        if (!task.due(cycles)) continue;
        auto& numbers = task_statistics[slow_task_places[i]];
        if (!task.finished()) {
            ++numbers.overruns;
            if (task_overruns[i] < 0xFFFF) ++task_overruns[i];
            continue;
        }
        task_overruns[i] = 0;
        if (!runs) {
            task.forget();
            continue;
        }
        if (task.threw()) {
            program_failed(program, task.fault());
            task.forget();
            continue;
        }
        if (task.undeclared().what != TaskContext::Undeclared::What::nothing) program_undeclared[program] = task.undeclared();
        auto& alarms = host->programs()[program].alarms;
        task.apply(program_requests[program], io.outputs(), alarms);
        numbers.run = task.last_run();
        numbers.run_max = std::max(numbers.run_max, numbers.run);
        ++numbers.releases;
        CycleContext context;
        context.now = now;
        context.period = config.cycle;
        task.release(context, views, io.inputs(), io.outputs(), host->parameters(), alarms);
    }
}

void Machine::Impl::take_handshakes() noexcept {
    for (std::size_t p = 0; p < program_states.size(); ++p) {
        auto expected = Handshake::started;
        // Its start() may have taken any time: what was given before a stop moves nothing behind it, a program neither.
        if (handshakes[p].load(std::memory_order_acquire) == Handshake::started && start_after[p] < stopped_axes_of(p)) {
            stop_program(p, ProgramState::stopped);
            raise(MachineAlarm::start_withdrawn, AlarmSource::program, static_cast<std::uint16_t>(p), 0, 0);
        }
        if (handshakes[p].compare_exchange_strong(expected, Handshake::none, std::memory_order_acquire)) {
            program_states[p] = ProgramState::running;
            program_faults[p] = {};
            program_undeclared[p] = {};
            objects->release_all(p);
            for (auto& task : slow_tasks)
                if (task->program() == p) task->restart();
            for (std::size_t i = 0; i < base_tasks.size(); ++i)
                if (host->tasks()[base_tasks[i]].program == p) base_scans[i] = 0;
        }
        expected = Handshake::failed;
        if (handshakes[p].compare_exchange_strong(expected, Handshake::none, std::memory_order_acquire))
            program_states[p] = ProgramState::fault;
    }
}

void Machine::Impl::run_tasks() noexcept {
    take_handshakes();
    run_slow_releases();
    longest_base_task = {};
    for (std::size_t i = 0; i < base_tasks.size(); ++i) {
        if (program_states[host->tasks()[base_tasks[i]].program] != ProgramState::running) continue;
        const Stopwatch watch;
        run_base_task(i);
        auto& numbers = task_statistics[base_tasks[i]];
        numbers.run = Stopwatch{watch}.lap();
        numbers.run_max = std::max(numbers.run_max, numbers.run);
        ++numbers.releases;
        if (numbers.run > config.cycle) ++numbers.overruns;
        if (numbers.run > longest_base_task.run) longest_base_task = {base_tasks[i], numbers.run};
    }
}

// Variables of a program that does not run keep their last values here: start() and stop() may be writing them on the service side.

}  // namespace taktwerk::runtime

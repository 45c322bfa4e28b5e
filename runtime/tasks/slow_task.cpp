#include "runtime/tasks/slow_task.hpp"

#include <algorithm>

#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

SlowTask::SlowTask(const ProgramHost::Task& task, Program* program, std::vector<ProgramHost::Variable> variables, std::size_t axes,
                   std::size_t inputs, std::size_t outputs, std::size_t parameters, ObjectAccess& objects, axes::MotionTables& tables,
                   std::size_t writes, std::vector<MemoryCopy::Source> kept)
    : task_(task),
      program_(program),
      divisor_(task.config.divisor),
      left_{VariableCopy(std::move(variables)), MemoryCopy(std::move(kept))},
      requests_(axes),
      objects_(objects),
      tables_(tables),
      views_(axes),
      inputs_(inputs),
      outputs_(outputs),
      outputs_at_release_(outputs),
      input_values_(inputs),
      parameters_(parameters),
      given_{std::vector<Write>(writes), 0, {}} {
    requests_.bind(views_);
}

void SlowTask::apply(axes::AxisRequests& axes, std::span<std::int64_t> outputs, std::uint64_t& program_alarms) noexcept {
    if (state_.load(std::memory_order_acquire) != State::done) return;
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (outputs_[i] != outputs_at_release_[i]) outputs[i] = outputs_[i];
    requests_.apply(axes);
    ++applied_;
    const auto changed = alarms_ ^ alarms_at_release_;
    program_alarms = (program_alarms & ~changed) | (alarms_ & changed);
    left_.variables.apply();
    left_.kept.apply();
    left_.kept_fresh = true;
    state_.store(State::idle, std::memory_order_relaxed);
}

void SlowTask::release(const CycleContext& now, std::span<const axes::AxisView> views, const Inputs& inputs,
                       std::span<const std::int64_t> outputs, std::span<const double> parameters, std::uint64_t program_alarms) noexcept {
    requests_.latch(views, views_);
    std::ranges::copy(inputs.words, inputs_.begin());
    std::ranges::copy(inputs.values, input_values_.begin());
    std::copy(outputs.begin(), outputs.end(), outputs_.begin());
    std::copy(outputs.begin(), outputs.end(), outputs_at_release_.begin());
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    context_ = now;
    context_.period = now.period * static_cast<Duration::rep>(divisor_);
    context_.cycle = runs_++;
    alarms_ = alarms_at_release_ = program_alarms;
    times_.since_release.restart();
    state_.store(State::released, std::memory_order_release);
}

bool SlowTask::run_if_released() noexcept {
    auto expected = State::released;
    if (!state_.compare_exchange_strong(expected, State::running, std::memory_order_acquire)) return false;
    times_.lateness = times_.since_release.lap();
    times_.released = context_.now;
    const Stopwatch watch;
    TaskContext context;
    static_cast<CycleContext&>(context) = context_;
    context.axes = views_;
    context.requests = &requests_;
    context.objects = &objects_;
    context.tables = &tables_;
    context.inputs = inputs_;
    context.outputs = outputs_;
    context.input_values = input_values_;
    context.output_bits = image_.bits;
    context.output_lines = image_.lines;
    context.parameters = parameters_;
    context.alarms = alarms_;
    context.first_scan = context_.cycle == 0;
    context.task_info = &times_.told;
    for (std::size_t i = 0; i < given_.count; ++i)
        ProgramHost::write(given_.writes[i].type, given_.writes[i].address, given_.writes[i].value);
    given_.count = 0;
    for (const auto& block : given_.warm) block.type->warm_start(block.address, context.now);
    given_.warm.clear();
    try {
        const ProgramCode code{task_.config.program.c_str(), task_.config.name.c_str()};
        task_.function(program_, context);
    } catch (...) {
        threw_ = true;
        fault_.take_current();
    }
    alarms_ = context.alarms;
    undeclared_ = context.undeclared;
    times_.asked = context.task_asked;
    left_.variables.read();
    left_.kept.read();
    times_.run = Stopwatch{watch}.lap();
    state_.store(State::done, std::memory_order_release);
    return true;
}

void SlowTask::forget() noexcept {
    requests_.clear();
    threw_ = false;
    state_.store(State::idle, std::memory_order_relaxed);
}

void SlowTask::restart() noexcept {
    forget();
    left_.kept_fresh = false;
    runs_ = 0;
}

}  // namespace taktwerk::runtime

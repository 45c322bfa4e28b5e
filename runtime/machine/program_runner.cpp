// Starting and stopping programs, and what ends with one: its axes, its outputs. Real-time safe except what other threads call.

#include "runtime/machine/program_runner.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/recording/inbox_record.hpp"
#include "runtime/stop_levels.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

namespace {

/// Named while it runs: what never returns from here is told by name, and so is what crashes.
class HookAtWork {
public:
    HookAtWork(std::atomic<std::int32_t>& at, std::size_t program, const char* name, const char* part) : at_(at), code_(name, part) {
        at_.store(static_cast<std::int32_t>(program), std::memory_order_relaxed);
    }
    ~HookAtWork() { at_.store(-1, std::memory_order_relaxed); }
    HookAtWork(const HookAtWork&) = delete;
    HookAtWork& operator=(const HookAtWork&) = delete;

private:
    std::atomic<std::int32_t>& at_;
    ProgramCode code_;
};

}  // namespace

ProgramRunner::ProgramRunner(MachineBody& body, HandMotion& hands, std::vector<Error>& errors)
    : body_(body),
      hands_(hands),
      host_(body.config, body.io, body.tables, errors),
      values_(host_),
      retained_(host_.retained()),
      kept_by_slow_(host_.retained().size()),
      claims_(body.config.axes.size()),
      groups_(body.axis_groups, body.requests),
      objects_(body.config.programs.size(), body.bus.slave_count()),
      times_(host_.tasks().size()) {
    for (std::size_t p = 0; p < body.config.programs.size(); ++p)
        programs_.emplace_back(body.requests, groups_, claims_, static_cast<std::uint16_t>(p));
    build_tasks();
    for (const auto& variable : host_.variables()) variable_values_.push_back(ProgramHost::read(variable));
}

void ProgramRunner::build_tasks() {
    const auto& tasks = host_.tasks();
    shown_by_slow_.resize(host_.variables().size());
    for (const auto& task : tasks)
        if (task.config.divisor == 1) programs_[task.program].has_base_task = true;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const auto& task = tasks[i];
        if (task.config.divisor == 1) {
            base_tasks_.push_back({i, 0, {}});
            continue;
        }
        auto shows = variables_of(i);
        std::vector<ProgramHost::Variable> variables;
        for (const auto place : shows) {
            variables.push_back(host_.variables()[place]);
            shown_by_slow_[place] = true;
        }
        auto keeps = kept_of(i);
        std::vector<MemoryCopy::Source> kept;
        for (const auto place : keeps) {
            kept.push_back({host_.retained()[place].address, host_.retained()[place].size});
            kept_by_slow_[place] = true;
        }
        auto& io = body_.io;
        slow_tasks_.push_back(
            {std::make_unique<SlowTask>(task, host_.programs()[task.program].instance.get(), std::move(variables), body_.axes.size(),
                                        io.inputs().size(), io.outputs().size(), host_.parameters().size(), objects_.of(task.program),
                                        body_.tables, values_.count_of(i), std::move(kept)),
             i,
             TaskWatch{task.config, body_.config},
             true,
             {},
             std::move(shows),
             std::move(keeps)});
    }
}

/// Those that are read after the runs of this slow task: the operator values that are its own, and where no base task is all that no other
/// task has as its own.
std::vector<std::size_t> ProgramRunner::variables_of(std::size_t task) const {
    const auto program = host_.tasks()[task].program;
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < host_.variables().size(); ++i) {
        if (host_.variables()[i].program != program) continue;
        bool mine = !programs_[program].has_base_task;
        for (const auto& value : host_.operator_values())
            if (value.variable == i) mine = value.task == task;
        if (mine) out.push_back(i);
    }
    return out;
}

/// Whose memory a kept item is: the task that its declaration names, else the program's base task, else its first one.
std::size_t ProgramRunner::keeper_of(const RetainedItem& item) const noexcept {
    if (item.task != RetainedItem::no_task) return item.task;
    std::size_t first = RetainedItem::no_task;
    for (std::size_t i = 0; i < host_.tasks().size(); ++i) {
        if (host_.tasks()[i].program != item.program) continue;
        if (host_.tasks()[i].config.divisor == 1) return i;
        if (first == RetainedItem::no_task) first = i;
    }
    return first;
}

std::vector<std::size_t> ProgramRunner::kept_of(std::size_t task) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < host_.retained().size(); ++i)
        if (keeper_of(host_.retained()[i]) == task) out.push_back(i);
    return out;
}

void ProgramRunner::restored(std::span<const std::size_t> warm_blocks) {
    for (std::size_t i = 0; i < host_.variables().size(); ++i) variable_values_[i] = ProgramHost::read(host_.variables()[i]);
    for (auto& slow : slow_tasks_) slow.task->show_variables();
    for (const auto place : warm_blocks) {
        const auto& item = host_.retained()[place];
        const auto task = keeper_of(item);
        for (auto& base : base_tasks_)
            if (base.place == task) base.warm.push_back({item.block, item.address});
        for (auto& slow : slow_tasks_)
            if (slow.place == task) slow.task->add_warm_block({item.block, item.address});
    }
    read_retained();
    (void)retained_.take_changed();
}

void ProgramRunner::learn_outputs() noexcept {
    for (auto& slow : slow_tasks_) slow.task->learn_outputs(body_.io.output_bits(), body_.io.output_lines());
}

void ProgramRunner::take_answers() noexcept {
    auto* recorder = body_.threads_beside ? body_.recorder : nullptr;  // else they are calls
    for (std::size_t p = 0; p < programs_.size(); ++p)
        programs_[p].hook.take([&](Handshake asked, Handshake next) {
            if (recorder != nullptr) record_hook(*recorder, body_.now, static_cast<std::uint16_t>(p), asked == Handshake::stop_asked);
            programs_[p].handshake.compare_exchange_strong(asked, next, std::memory_order_acq_rel);
        });
    for (std::size_t i = 0; i < slow_tasks_.size(); ++i) {
        auto& slow = slow_tasks_[i];
        if (slow.finished || !slow.task->finished()) continue;
        slow.finished = true;
        slow.watch.end(body_.cycles);
        if (slow.task->times_asked()) record_times(slow.place, slow.task->info());
        if (recorder != nullptr) record_slow(*recorder, body_.now, static_cast<std::uint16_t>(i));
    }
    objects_.take_answers(body_.recorder, body_.now);
}

bool ProgramRunner::start(std::size_t program, std::uint64_t after) noexcept {
    auto& record = programs_[program];
    record.start_after = after;
    auto expected = Handshake::none;
    return record.handshake.compare_exchange_strong(expected, Handshake::start_asked, std::memory_order_release) ||
           expected == Handshake::start_asked || expected == Handshake::started;
}

void ProgramRunner::stop(std::size_t program, ProgramState state) noexcept {
    programs_[program].state = state;
    values_.let_go(program);
    host_.programs()[program].alarms = 0;
    programs_[program].handshake.store(Handshake::stop_asked, std::memory_order_release);
    const bool others = std::any_of(programs_.begin(), programs_.end(), [](const ProgramRecord& other) { return other.running(); });
    let_go_of_groups(program);
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        auto& claims = claims_[i];
        const bool powers = claims.power == program, moves = claims.motion == program;
        if (powers) claims.power = no_program;
        if (moves) claims.motion = no_program;
        auto& axis = body_.axes[i];
        if (axis.view().owner != axes::Owner::program) continue;
        if (powers || !others) body_.shut_down(i);  // its power wishes end with it: the axis ramps down, then its power goes off
        else if (moves) end_motion(i);
    }
    release_outputs_of(program, others);
}

void ProgramRunner::release_outputs_of(std::size_t program, bool others_run) noexcept {
    for (const auto output : host_.outputs_of(program)) {
        bool driven = false;
        for (std::size_t p = 0; p < programs_.size(); ++p) driven = driven || (programs_[p].running() && host_.drives(p, output));
        if (!driven) body_.io.make_safe(output);
    }
    if (!others_run) body_.io.make_safe();
}

// A group that another program commands goes on, and what a person holds he holds on.
void ProgramRunner::let_go_of_groups(std::size_t program) noexcept {
    for (std::size_t i = 0; i < body_.axis_groups.size(); ++i) {
        if (groups_.commander(i) != program) continue;
        groups_.forget_commander(i);
        const auto& members = body_.axis_groups[i].view().members;
        const bool its = std::any_of(members.begin(), members.end(), [this](axes::AxisRef axis) {
            return axis.valid() && body_.axes[axis.index].view().owner == axes::Owner::program;
        });
        if (its) body_.axis_groups[i].let_go();
    }
}

// The program that moved the axis is gone, the one that powers it is not. What a group leads comes to rest with that, or is another program's.
void ProgramRunner::end_motion(std::size_t axis) noexcept {
    if (body_.axis_groups.leader_of(axes::AxisRef{static_cast<std::uint16_t>(axis)}) != nullptr) return;
    (void)hands_.let_go(axis);
    if (const auto lock = body_.axes[axis].view().lock; lock != 0)
        body_.requests.release_stop(axes::AxisRef{static_cast<std::uint16_t>(axis)}, lock, axes::Owner::program);
}

void ProgramRunner::failed(std::size_t program, const FaultText& why) noexcept {
    programs_[program].fault = why;
    stop(program, ProgramState::fault);
}

void ProgramRunner::stop_all() noexcept {
    for (std::size_t p = 0; p < programs_.size(); ++p)
        if (programs_[p].running() || programs_[p].start_pending()) stop(p, ProgramState::stopped);
}

void ProgramRunner::reset() noexcept {
    for (auto& slow : slow_tasks_) {
        slow.watch.forgive();
        body_.log.reset_with_cause(id(MachineAlarm::task_overrun), AlarmSource::task, static_cast<std::uint16_t>(slow.place));
    }
    for (std::size_t p = 0; p < programs_.size(); ++p) reset(p);
}

void ProgramRunner::reset(std::size_t p) noexcept {
    if (programs_[p].state != ProgramState::fault) return;
    programs_[p].state = ProgramState::stopped;
    body_.log.reset_with_cause(id(MachineAlarm::program_fault), AlarmSource::program, static_cast<std::uint16_t>(p));
    for (const auto& slow : slow_tasks_) {
        if (slow.task->program() != p || !slow.finished) continue;
        for (const auto alarm : {MachineAlarm::task_late, MachineAlarm::task_watchdog})
            body_.log.reset_with_cause(id(alarm), AlarmSource::task, static_cast<std::uint16_t>(slow.place));
    }
}

void ProgramRunner::stop_axes_of(std::size_t program, AlarmId reason) noexcept {
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        const bool its = claims_[i].power == program || claims_[i].motion == program;
        if (its && body_.axes[i].view().owner == axes::Owner::program) body_.axes[i].stop_for_error(reason, false);
    }
}

bool ProgramRunner::any_runs_or_starts() const noexcept {
    return std::any_of(programs_.begin(), programs_.end(),
                       [](const ProgramRecord& program) { return program.running() || program.start_pending(); });
}

Verdict ProgramRunner::write_value(const OperatorCommand& command) noexcept {
    const auto program = values_.program_of(command.index);
    return values_.write(command, body_.now, program >= 0 && programs_[static_cast<std::size_t>(program)].running(), body_.emergency);
}

void ProgramRunner::let_go_for_stop(std::uint16_t axis) noexcept {
    for (std::size_t p = 0; p < programs_.size(); ++p)
        if (axis == StopLevels::all_axes || host_.uses(p, axis)) values_.let_go(p);
}

std::uint64_t ProgramRunner::newest_stop_of(std::size_t program) const noexcept {
    std::uint64_t newest = 0;
    for (std::size_t i = 0; i < body_.axes.size(); ++i)
        if (host_.uses(program, i)) newest = std::max(newest, hands_.newest_stop(i));
    return newest;
}

void ProgramRunner::take_handshakes() noexcept {
    for (std::size_t p = 0; p < programs_.size(); ++p) {
        auto& program = programs_[p];
        auto expected = Handshake::started;
        // Its start() may have taken any time: what was given before a stop moves nothing behind it, a program neither.
        if (program.handshake.load(std::memory_order_acquire) == Handshake::started && program.start_after < newest_stop_of(p)) {
            stop(p, ProgramState::stopped);
            body_.raise(MachineAlarm::start_withdrawn, AlarmSource::program, static_cast<std::uint16_t>(p));
        }
        if (program.handshake.compare_exchange_strong(expected, Handshake::none, std::memory_order_acquire)) {
            program.state = ProgramState::running;
            program.fault = {};
            program.undeclared = {};
            program.stopped_by.clear();
            objects_.open(p);
            for (auto& slow : slow_tasks_) {
                if (slow.task->program() != p) continue;
                slow.task->restart();
                slow.watch.forgive();
            }
            for (auto& base : base_tasks_)
                if (host_.tasks()[base.place].program == p) base.scans = 0;
        }
        expected = Handshake::failed;
        if (program.handshake.compare_exchange_strong(expected, Handshake::none, std::memory_order_acquire))
            program.state = ProgramState::fault;
    }
}

bool ProgramRunner::slow_tasks_at_rest(std::size_t program) const noexcept {
    return std::all_of(slow_tasks_.begin(), slow_tasks_.end(),
                       [&](const SlowPlace& slow) { return slow.task->program() != program || slow.finished; });
}

bool ProgramRunner::slow_tasks_finished(std::size_t program) const noexcept {
    return std::all_of(slow_tasks_.begin(), slow_tasks_.end(),
                       [&](const SlowPlace& slow) { return slow.task->program() != program || slow.task->finished(); });
}

void ProgramRunner::tell_fault(std::size_t program, std::string words) {
    const std::lock_guard lock{fault_words_};
    host_.programs()[program].fault = std::move(words);
}

void ProgramRunner::call_hook(std::size_t p) {
    const auto asked = programs_[p].handshake.load(std::memory_order_acquire);
    if (asked == Handshake::start_asked || (asked == Handshake::stop_asked && slow_tasks_finished(p)))
        if (!programs_[p].hook.waits_for(asked)) run_hook(p, asked);
}

bool ProgramRunner::replay_hook(std::size_t program, bool stop) {
    if (program >= programs_.size() || !host_.programs()[program].instance) return false;
    run_hook(program, stop ? Handshake::stop_asked : Handshake::start_asked);
    return true;
}

bool ProgramRunner::replay_times(const TaskTimesRecord& record) noexcept {
    if (record.task >= host_.tasks().size()) return false;
    for (auto& slow : slow_tasks_)
        if (slow.place == record.task) return slow.task->tell_again(record), true;
    times_.replay(record);
    return true;
}

void ProgramRunner::run_hook(std::size_t p, Handshake asked) {
    auto& record = programs_[p];
    auto& loaded = host_.programs()[p];
    auto next = asked;
    try {
        if (asked == Handshake::start_asked) {
            tell_fault(p, {});
            next = Handshake::started;
            const HookAtWork hook{at_hooks_, p, loaded.config.name.c_str(), "start()"};
            loaded.instance->start();
        } else {
            // Written by the cycle before it asked; a program stopped by a person leaves it as it was.
            if (const auto why = record.fault.text(); !why.empty()) tell_fault(p, std::string(why));
            next = Handshake::none;
            const HookAtWork hook{at_hooks_, p, loaded.config.name.c_str(), "stop()"};
            loaded.instance->stop();
        }
    } catch (...) {
        FaultText why;
        why.take_current();
        tell_fault(p, std::string(asked == Handshake::start_asked ? "start() threw: " : "stop() threw: ") + std::string(why.text()));
        next = Handshake::failed;
    }
    record.hook.put(asked, next);
}

void ProgramRunner::call_hooks() {
    for (std::size_t p = 0; p < programs_.size(); ++p)
        if (host_.programs()[p].instance) call_hook(p);
}

std::string ProgramRunner::at_work() const {
    for (const auto& slow : slow_tasks_)
        if (const auto& task = *slow.task; !task.finished())
            return fmt::format("task '{}' of program '{}'", task.config().name, task.config().program);
    if (const auto program = at_hooks_.load(std::memory_order_relaxed); program >= 0)
        return fmt::format("start() or stop() of program '{}'", body_.config.programs[static_cast<std::size_t>(program)].name);
    return {};
}

std::string ProgramRunner::fault(std::size_t program) const {
    if (const auto task = programs_[program].stopped_by.task()) {
        const auto& config = host_.tasks()[*task].config;
        return programs_[program].stopped_by.verdict() == TaskVerdict::watchdog
                   ? fmt::format("task '{}' did not end within its watchdog time", config.name)
                   : fmt::format("task '{}' missed more than {} releases in a row", config.name,
                                 TaskWatch::overruns_allowed(config, body_.config));
    }
    const std::lock_guard lock{fault_words_};
    return host_.programs()[program].fault;
}

}  // namespace taktwerk::runtime

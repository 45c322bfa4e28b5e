// Starting and stopping programs, and what ends with one: its axes, its outputs. Real-time safe except service_programs().

#include <algorithm>

#include "runtime/machine/machine_impl.hpp"
#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::runtime {

using axes::ErrorId;
using axes::Owner;

Machine::Impl::Verdict Machine::Impl::execute_program(const OperatorCommand& command) noexcept {
    if (command.index >= program_states.size()) return {Answer::unknown_name};
    auto& state = program_states[command.index];
    switch (command.action) {
        case OperatorAction::program_start:
            if (mode != Mode::automatic) return {Answer::wrong_mode};
            if (emergency) return {Answer::not_possible_now, ErrorId::interlocked};
            if (log.lists(id(MachineAlarm::emergency_stop)) || axes_to_reset()) return {Answer::not_possible_now, ErrorId::in_error_stop};
            if (state == ProgramState::running) {
                program_requests[command.index].go_on();
                return {};
            }
            if (state == ProgramState::fault) return {Answer::not_possible_now};
            if (!start_program(command.index, command.after)) return {Answer::not_possible_now};  // its stop() is still to come
            program_requests[command.index].go_on();
            return {};
        case OperatorAction::program_stop:
            if (state == ProgramState::running || start_pending(command.index)) stop_program(command.index, ProgramState::stopped);
            return {};
        default:
            if (state == ProgramState::fault) state = ProgramState::stopped;
            return {};
    }
}

bool Machine::Impl::start_pending(std::size_t program) const noexcept {
    const auto asked = handshakes[program].load(std::memory_order_relaxed);
    return asked == Handshake::start_asked || asked == Handshake::started;
}

bool Machine::Impl::start_program(std::size_t program, std::uint64_t after) noexcept {
    start_after[program] = after;
    auto expected = Handshake::none;
    return handshakes[program].compare_exchange_strong(expected, Handshake::start_asked, std::memory_order_release) ||
           expected == Handshake::start_asked || expected == Handshake::started;
}

void Machine::Impl::stop_program(std::size_t program, ProgramState state) noexcept {
    program_states[program] = state;
    host->programs()[program].alarms = 0;
    handshakes[program].store(Handshake::stop_asked, std::memory_order_release);
    bool others = false;
    for (const auto other : program_states) others = others || other == ProgramState::running;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        auto& claims = axis_claims[i];
        const bool powers = claims.power == program, moves = claims.motion == program;
        if (powers) claims.power = no_program;
        if (moves) claims.motion = no_program;
        if (axes[i].view().owner != Owner::program) continue;
        if (powers || !others) axes[i].shut_down();  // its power wishes end with it: the axis ramps down, then its power goes off
        else if (moves) end_motion(i);
    }
    for (const auto output : host->outputs_of(program)) {
        bool driven = false;
        for (std::size_t p = 0; p < program_states.size(); ++p)
            driven = driven || (program_states[p] == ProgramState::running && host->drives(p, output));
        if (!driven) io.make_safe(output);
    }
    if (!others) io.make_safe();
}

// The program that moved the axis is gone, the one that powers it is not.
void Machine::Impl::end_motion(std::size_t axis) noexcept {
    (void)stop(axis);
    if (const auto lock = axes[axis].view().lock; lock != 0)
        requests.release_stop(axes::AxisRef{static_cast<std::uint16_t>(axis)}, lock, Owner::program);
}

void Machine::Impl::stop_programs() noexcept {
    for (std::size_t p = 0; p < program_states.size(); ++p)
        if (program_states[p] == ProgramState::running || start_pending(p)) stop_program(p, ProgramState::stopped);
}

bool Machine::Impl::slow_tasks_finished(std::size_t program) const noexcept {
    for (const auto& task : slow_tasks)
        if (task->program() == program && !task->finished()) return false;
    return true;
}

void Machine::Impl::service_programs() {
    for (std::size_t p = 0; p < program_states.size(); ++p) {
        auto& loaded = host->programs()[p];
        if (!loaded.instance) continue;
        auto asked = handshakes[p].load(std::memory_order_acquire);
        auto next = asked;
        const auto tell = [&](std::string words) {
            const std::lock_guard lock{fault_words};
            loaded.fault = std::move(words);
        };
        // Named while it runs: what never returns from here is told by name, and so is what crashes.
        struct Hooks {
            Hooks(std::atomic<std::int32_t>& at, std::size_t program, const char* name, const char* part) : at_(at), code_(name, part) {
                at_.store(static_cast<std::int32_t>(program), std::memory_order_relaxed);
            }
            ~Hooks() { at_.store(-1, std::memory_order_relaxed); }
            std::atomic<std::int32_t>& at_;
            ProgramCode code_;
        };
        try {
            if (asked == Handshake::start_asked) {
                tell({});
                next = Handshake::started;
                const Hooks hooks{at_hooks, p, loaded.config.name.c_str(), "start()"};
                loaded.instance->start();
            } else if (asked == Handshake::stop_asked && slow_tasks_finished(p)) {
                // Written by the cycle before it asked; a program stopped by a person leaves it as it was.
                if (const auto why = program_faults[p].text(); !why.empty()) tell(std::string(why));
                next = Handshake::none;
                const Hooks hooks{at_hooks, p, loaded.config.name.c_str(), "stop()"};
                loaded.instance->stop();
            }
        } catch (...) {
            FaultText why;
            why.take_current();
            tell(std::string(asked == Handshake::start_asked ? "start() threw: " : "stop() threw: ") + std::string(why.text()));
            next = Handshake::failed;
        }
        if (next != asked) handshakes[p].compare_exchange_strong(asked, next, std::memory_order_release);
    }
}

}  // namespace taktwerk::runtime

// Operator commands inside the cycle: authority, modes, manual motion, programs. Real-time safe except service_programs().

#include <cmath>

#include "runtime/machine_impl.hpp"

namespace taktwerk::runtime {

using axes::AxisCommand;
using axes::AxisState;
using axes::CommandKind;
using axes::ErrorId;
using axes::Owner;

namespace {

constexpr std::uint16_t all = 0xFFFF;

axes::OperatingMode operating(Mode mode) noexcept {
    switch (mode) {
        case Mode::automatic: return axes::OperatingMode::automatic;
        case Mode::setup: return axes::OperatingMode::setup;
        case Mode::manual: break;
    }
    return axes::OperatingMode::manual;
}

}  // namespace

void Machine::Impl::answer(const OperatorCommand& command, Answer verdict, ErrorId error) noexcept {
    CommandAnswer reply;
    reply.client = command.client;
    reply.sequence = command.sequence;
    reply.answer = verdict;
    reply.error = error;
    if (command.axis < axes.size()) reply.owner = axes[command.axis].view().owner;
    if (verdict != Answer::accepted) ++statistics.commands_refused;
    answers.try_push(reply);  // a full ring means nobody reads: the client's own time-out tells it
}

void Machine::Impl::drain_inbox(Instant at) noexcept {
    OperatorCommand command;
    for (std::uint8_t i = 0; i < config.commands_per_cycle && inbox.try_pop(command); ++i) {
        if (command.expires != Instant{} && command.expires < at) answer(command, Answer::stale);
        else if (shutting_down) answer(command, Answer::not_possible_now);
        else execute(command);
    }
}

void Machine::Impl::execute(const OperatorCommand& command) noexcept {
    switch (command.action) {
        case OperatorAction::none: answer(command, Answer::unknown_name); return;
        case OperatorAction::set_mode:
            set_mode(command.mode);
            answer(command, Answer::accepted);
            return;
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset: execute_program(command); return;
        case OperatorAction::set_parameter: {
            if (command.index >= host->parameters().size()) return answer(command, Answer::unknown_name);
            const auto& info = host->parameter(command.index);
            if (!(command.value >= info.minimum && command.value <= info.maximum)) return answer(command, Answer::bad_value);
            host->parameters()[command.index] = command.value;
            return answer(command, Answer::accepted);
        }
        case OperatorAction::set_output: {
            if (command.index >= io.outputs().size()) return answer(command, Answer::unknown_name);
            for (const auto state : program_states)
                if (state == ProgramState::running) return answer(command, Answer::not_possible_now);
            if (mode == Mode::automatic) return answer(command, Answer::wrong_mode);
            io.outputs()[command.index] = static_cast<std::int64_t>(command.value);
            return answer(command, Answer::accepted);
        }
        case OperatorAction::acknowledge_alarms:
            log.acknowledge();
            for (auto& axis : axes) axis.acknowledge_alarms();
            return answer(command, Answer::accepted);
        case OperatorAction::shutdown:
            shutdown_wanted.store(true, std::memory_order_relaxed);
            return answer(command, Answer::accepted);
        case OperatorAction::reset:
            if (command.axis == all) {
                log.reset();
                for (auto& count : task_overruns) count = 0;
                for (std::size_t p = 0; p < program_states.size(); ++p)
                    if (program_states[p] == ProgramState::fault) program_states[p] = ProgramState::stopped;
            }
            break;
        case OperatorAction::take_control:
        case OperatorAction::release_control:
        case OperatorAction::power:
        case OperatorAction::home:
        case OperatorAction::jog:
        case OperatorAction::move_absolute:
        case OperatorAction::stop: break;
    }
    if (command.axis == all) {
        const bool for_all = command.action == OperatorAction::stop || command.action == OperatorAction::reset ||
                             command.action == OperatorAction::power || command.action == OperatorAction::take_control ||
                             command.action == OperatorAction::release_control;
        if (!for_all) return answer(command, Answer::unknown_name);
        // One answer for all: the first refusal, if any. execute_axis answers each; so it is told apart by the axis.
        ErrorId first = ErrorId::none;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if (config.axes[i].axis.disabled) continue;
            if (command.action == OperatorAction::reset) {
                const auto error = requests.reset(axes::AxisRef{static_cast<std::uint16_t>(i)}, command.owner);
                if (first == ErrorId::none) first = error;
            } else if (command.action == OperatorAction::stop) {
                AxisCommand halt;
                halt.kind = CommandKind::halt;
                requests.submit(axes::AxisRef{static_cast<std::uint16_t>(i)}, halt, axes[i].view().owner);
            } else if (command.action == OperatorAction::power) {
                if (mode == Mode::automatic) return answer(command, Answer::wrong_mode);
                operator_power[i].held = command.flag;
                operator_power[i].owner = command.owner;
                if (!command.flag) axes[i].shut_down();
            } else if (command.action == OperatorAction::take_control) {
                axes[i].take_control(command.owner);
            } else {
                axes[i].release_control(command.owner);
            }
        }
        return answer(command, first == ErrorId::none ? Answer::accepted : Answer::refused_by_axis, first);
    }
    if (command.axis >= axes.size() || config.axes[command.axis].axis.disabled) return answer(command, Answer::unknown_name);
    execute_axis(command, command.axis);
}

void Machine::Impl::submit_axis(const OperatorCommand& command, std::size_t axis, const AxisCommand& wanted) noexcept {
    const auto submitted = requests.submit(axes::AxisRef{static_cast<std::uint16_t>(axis)}, wanted, command.owner);
    if (submitted.error == ErrorId::owned_by_other) answer(command, Answer::no_control, submitted.error);
    else if (submitted.error != ErrorId::none) answer(command, Answer::refused_by_axis, submitted.error);
    else answer(command, Answer::accepted);
}

void Machine::Impl::jog(const OperatorCommand& command, std::size_t axis) noexcept {
    auto& power = operator_power[axis];
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    if (!std::isfinite(command.value)) return answer(command, Answer::bad_value);
    const auto status = axes[axis].view().status(power.jog);
    const bool jogging = status == axes::CommandStatus::active || status == axes::CommandStatus::in_target;
    if (command.value == 0) {
        if (jogging) {
            AxisCommand halt;
            halt.kind = CommandKind::halt;
            requests.submit(ref, halt, command.owner);
        }
        power.jog = 0;
        return answer(command, Answer::accepted);
    }
    if (jogging) {
        const auto error = requests.renew_jog(ref, power.jog, command.value, command.owner);
        if (error == ErrorId::none) return answer(command, Answer::accepted);
        return answer(command, error == ErrorId::owned_by_other ? Answer::no_control : Answer::refused_by_axis, error);
    }
    // A heartbeat of a jog whose lease has run out must not start the axis anew: it takes a fresh press (flag).
    if (!command.flag) return answer(command, Answer::stale);
    AxisCommand wanted;
    wanted.kind = CommandKind::jog;
    wanted.velocity = command.value;
    const auto submitted = requests.submit(ref, wanted, command.owner);
    power.jog = submitted.id;
    if (submitted.error == ErrorId::owned_by_other) answer(command, Answer::no_control, submitted.error);
    else if (submitted.error != ErrorId::none) answer(command, Answer::refused_by_axis, submitted.error);
    else answer(command, Answer::accepted);
}

void Machine::Impl::execute_axis(const OperatorCommand& command, std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    switch (command.action) {
        case OperatorAction::take_control:
            axes[axis].take_control(command.owner);
            return answer(command, Answer::accepted);
        case OperatorAction::release_control:
            axes[axis].release_control(command.owner);
            return answer(command, Answer::accepted);
        case OperatorAction::power: {
            // The wish itself is given in each cycle, where programs give theirs (renew_operator_power).
            const auto& view = axes[axis].view();
            if (view.owner != command.owner) return answer(command, Answer::no_control, ErrorId::owned_by_other);
            if (command.flag && emergency) return answer(command, Answer::refused_by_axis, ErrorId::interlocked);
            if (command.flag && view.state == AxisState::ErrorStop) return answer(command, Answer::refused_by_axis, ErrorId::in_error_stop);
            operator_power[axis].held = command.flag;
            operator_power[axis].owner = command.owner;
            if (!command.flag) axes[axis].shut_down();
            return answer(command, Answer::accepted);
        }
        case OperatorAction::home: {
            AxisCommand wanted;
            wanted.kind = CommandKind::home;
            wanted.position = config.axes[axis].axis.homing.offset;
            return submit_axis(command, axis, wanted);
        }
        case OperatorAction::jog: return jog(command, axis);
        case OperatorAction::move_absolute: {
            AxisCommand wanted;
            wanted.kind = CommandKind::move_absolute;
            wanted.position = command.value;
            wanted.velocity = command.value2;
            return submit_axis(command, axis, wanted);
        }
        case OperatorAction::stop: {
            // Stopping is everybody's right: it is carried out in the owner's name.
            AxisCommand wanted;
            wanted.kind = CommandKind::halt;
            const auto submitted = requests.submit(ref, wanted, axes[axis].view().owner);
            const bool stands = submitted.error == ErrorId::not_powered || submitted.error == ErrorId::in_error_stop;
            return answer(command, submitted.error == ErrorId::none || stands ? Answer::accepted : Answer::refused_by_axis, submitted.error);
        }
        case OperatorAction::reset: {
            const auto error = requests.reset(ref, command.owner);
            return answer(command, error == ErrorId::none ? Answer::accepted : Answer::refused_by_axis, error);
        }
        case OperatorAction::none:
        case OperatorAction::set_mode:
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset:
        case OperatorAction::set_parameter:
        case OperatorAction::set_output:
        case OperatorAction::acknowledge_alarms:
        case OperatorAction::shutdown: break;
    }
    answer(command, Answer::unknown_name);
}

void Machine::Impl::execute_program(const OperatorCommand& command) noexcept {
    if (command.index >= program_states.size()) return answer(command, Answer::unknown_name);
    auto& state = program_states[command.index];
    switch (command.action) {
        case OperatorAction::program_start:
            if (mode != Mode::automatic) return answer(command, Answer::wrong_mode);
            if (state == ProgramState::running) return answer(command, Answer::accepted);
            if (state == ProgramState::fault) return answer(command, Answer::not_possible_now);
            start_program(command.index);
            return answer(command, Answer::accepted);
        case OperatorAction::program_stop:
            if (state == ProgramState::running) stop_program(command.index, ProgramState::stopped);
            return answer(command, Answer::accepted);
        default:
            if (state == ProgramState::fault) state = ProgramState::stopped;
            return answer(command, Answer::accepted);
    }
}

void Machine::Impl::start_program(std::size_t program) noexcept {
    auto expected = Handshake::none;
    handshakes[program].compare_exchange_strong(expected, Handshake::start_asked, std::memory_order_release);
}

void Machine::Impl::stop_program(std::size_t program, ProgramState state) noexcept {
    program_states[program] = state;
    host->programs()[program].alarms = 0;
    handshakes[program].store(Handshake::stop_asked, std::memory_order_release);
    for (auto& axis : axes) {
        if (axis.view().owner != Owner::program) continue;
        axis.shut_down();  // its power wishes end with it: the axis ramps down, then its power goes off
    }
    bool any = false;
    for (const auto other : program_states) any = any || other == ProgramState::running;
    if (!any) io.make_safe();
}

void Machine::Impl::service_programs() {
    for (std::size_t p = 0; p < program_states.size(); ++p) {
        auto* program = host->programs()[p].instance.get();
        if (!program) continue;
        const auto asked = handshakes[p].load(std::memory_order_acquire);
        try {
            if (asked == Handshake::start_asked) {
                program->start();
                auto expected = Handshake::start_asked;
                handshakes[p].compare_exchange_strong(expected, Handshake::started, std::memory_order_release);
            } else if (asked == Handshake::stop_asked) {
                program->stop();
                auto expected = Handshake::stop_asked;
                handshakes[p].compare_exchange_strong(expected, Handshake::none, std::memory_order_release);
            }
        } catch (...) {
            host->programs()[p].fault = "start() or stop() threw an exception";
            handshakes[p].store(Handshake::none, std::memory_order_release);
        }
    }
}

void Machine::Impl::set_mode(Mode wanted) noexcept {
    if (wanted == mode) return;
    if (mode == Mode::automatic)
        for (std::size_t p = 0; p < program_states.size(); ++p)
            if (program_states[p] == ProgramState::running) stop_program(p, ProgramState::stopped);
    mode = wanted;
    if (wanted == Mode::automatic) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if (operator_power[i].held) axes[i].shut_down();
            operator_power[i] = {};
        }
    }
    for (auto& axis : axes) axis.set_mode(operating(wanted));
}

void Machine::Impl::renew_operator_power() noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (operator_power[i].held) axes[i].power(true, true, true, operator_power[i].owner);
}

}  // namespace taktwerk::runtime

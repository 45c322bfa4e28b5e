// Operator commands inside the cycle: authority, modes, manual motion, outputs by hand; programs in machine_programs.cpp. Real-time safe.
// Who may do what, and when, stands in operator_command.hpp.

#include <algorithm>
#include <cmath>

#include "runtime/machine/machine_impl.hpp"
#include "runtime/recording/inbox_record.hpp"

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

Machine::Impl::Verdict Machine::Impl::verdict(ErrorId error) noexcept {
    if (error == ErrorId::none) return {};
    return {error == ErrorId::owned_by_other ? Answer::no_control : Answer::refused_by_axis, error};
}

void Machine::Impl::answer(const OperatorCommand& command, Answer verdict, ErrorId error) noexcept {
    CommandAnswer reply;
    reply.client = command.client;
    reply.sequence = command.sequence;
    reply.answer = verdict;
    reply.error = error;
    if (command.axis < axes.size()) {
        reply.owner = axes[command.axis].view().owner;
        reply.holder = axes[command.axis].view().holder;
    }
    if (verdict == Answer::accepted && command.axis < axes.size()) tell_limit(command, reply);
    if (verdict != Answer::accepted) ++statistics.commands_refused;
    answers.try_push(reply);  // a full ring means nobody reads: the client's own time-out tells it
}

// One place for what comes from outside: a level is recorded as the command that it is. Nobody waits for an answer in the ring.
void Machine::Impl::take_levels(Instant at) noexcept {
    levels.take([&](StopLevel what, std::uint16_t axis, std::uint64_t number) {
        OperatorCommand command;
        command.axis = axis;
        command.sequence = number;
        command.action = what == StopLevel::stop          ? OperatorAction::stop
                         : what == StopLevel::release_jog ? OperatorAction::jog
                                                          : OperatorAction::shutdown;
        if (recorder) record_command(*recorder, at, command);
        if (what == StopLevel::shutdown) {
            shutdown_taken = true;
            return;
        }
        const bool moves =
            armed.load(std::memory_order_relaxed);  // before that nothing does; a program that starts by itself shall not then
        for (std::size_t i = axis == all ? 0 : axis; i < (axis == all ? axes.size() : axis + std::size_t{1}); ++i) {
            stopped_at[i] = std::max(stopped_at[i], number);
            if (!moves) continue;
            // A program's axis was never jogged: that press was refused.
            const bool spared = what == StopLevel::release_jog && axes[i].view().owner == Owner::program;
            if (!config.axes[i].axis.disabled && !spared) (void)stop(i);
        }
    });
}

std::uint64_t Machine::Impl::stopped_axes_of(std::size_t program) const noexcept {
    std::uint64_t newest = 0;
    for (std::size_t i = 0; i < stopped_at.size(); ++i)
        if (host->uses(program, i)) newest = std::max(newest, stopped_at[i]);
    return newest;
}

/// Given before a stop of its axis (a program: of one of its axes), and only now at its turn: it must not start what that stop has ended.
bool Machine::Impl::overtaken(const OperatorCommand& command) const noexcept {
    if (command.action == OperatorAction::program_start)
        return command.index < program_states.size() && command.after < stopped_axes_of(command.index);
    const bool starts_motion = command.action == OperatorAction::home || command.action == OperatorAction::move_absolute ||
                               (command.action == OperatorAction::jog && command.value != 0);
    return starts_motion && command.axis < stopped_at.size() && command.after < stopped_at[command.axis];
}

// Who asked for more than the axis gives now is told so: a slow axis must not look like a granted wish.
void Machine::Impl::tell_limit(const OperatorCommand& command, CommandAnswer& reply) const noexcept {
    const bool moves = command.action == OperatorAction::jog || command.action == OperatorAction::move_absolute;
    if (!moves) return;
    const double wanted = std::abs(command.action == OperatorAction::jog ? command.value : command.value2);
    const auto& view = axes[command.axis].view();
    const auto& limits = config.axes[command.axis].axis;
    double most = limits.limits.velocity;
    Mode by = Mode::automatic;
    const double of_mode = mode == Mode::manual  ? view.manual_fast
                           : mode == Mode::setup ? (limits.manual.setup_velocity > 0 ? limits.manual.setup_velocity : view.manual_slow)
                                                 : most;
    if (mode != Mode::automatic && of_mode < most) {
        most = of_mode;
        by = mode;
    }
    if (!(wanted > most)) return;
    reply.limited_to = most;
    reply.limited_in = by;
}

void Machine::Impl::drain_inbox(Instant at) noexcept {
    OperatorCommand command;
    for (std::uint8_t i = 0; i < config.commands_per_cycle && inbox.try_pop(command); ++i) {
        if (recorder) record_command(*recorder, at, command);
        // A stop is never too late, and while the run ends everything stops anyway.
        const bool stops = command.action == OperatorAction::stop || command.action == OperatorAction::shutdown;
        if (!stops && command.expires != Instant{} && command.expires < at) answer(command, Answer::stale);
        else if (overtaken(command)) answer(command, Answer::stale);
        else if (!stops && shutting_down) answer(command, Answer::not_possible_now);
        else execute(command);
    }
}

void Machine::Impl::execute(const OperatorCommand& command) noexcept {
    Verdict result;
    const bool a_person = command.owner == Owner::operator_panel || command.owner == Owner::commissioning;
    switch (command.action) {
        case OperatorAction::none:
        case OperatorAction::set_mode:
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset:
        case OperatorAction::set_parameter:
        case OperatorAction::set_output:
        case OperatorAction::acknowledge_alarms:
        case OperatorAction::release_outputs:
        case OperatorAction::shutdown: result = execute_machine(command); break;
        case OperatorAction::take_control:
        case OperatorAction::release_control:
        case OperatorAction::power:
        case OperatorAction::home:
        case OperatorAction::jog:
        case OperatorAction::move_absolute:
        case OperatorAction::stop:
        case OperatorAction::reset:
            if (!a_person && command.action != OperatorAction::stop) result = {Answer::no_control, ErrorId::owned_by_other};
            else if (command.axis == all) result = execute_all(command);
            else if (command.axis >= axes.size() || config.axes[command.axis].axis.disabled) result = {Answer::unknown_name};
            else result = execute_axis(command, command.axis);
            break;
        default: result = {Answer::unknown_name};  // a number that no enumerator has
    }
    answer(command, result.answer, result.error);
}

Machine::Impl::Verdict Machine::Impl::execute_machine(const OperatorCommand& command) noexcept {
    switch (command.action) {
        case OperatorAction::set_mode:
            if (command.mode > Mode::automatic) return {Answer::bad_value};
            if (command.mode == Mode::automatic && emergency) return {Answer::not_possible_now, ErrorId::interlocked};
            set_mode(command.mode);
            return {};
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset: return execute_program(command);
        case OperatorAction::set_parameter: {
            if (command.index >= host->parameters().size()) return {Answer::unknown_name};
            const auto& info = host->parameter(command.index);
            if (!info.takes(command.value)) return {Answer::bad_value};
            host->parameters()[command.index] = command.value;
            return {};
        }
        case OperatorAction::set_output:
            if (command.index >= io.outputs().size()) return {Answer::unknown_name};
            if (!io.fits(command.index, command.value)) return {Answer::bad_value};
            if (mode == Mode::automatic) return {Answer::wrong_mode};
            if (emergency) return {Answer::not_possible_now, ErrorId::interlocked};
            for (std::size_t p = 0; p < program_states.size(); ++p)
                if (program_states[p] == ProgramState::running || start_pending(p)) return {Answer::not_possible_now};
            io.outputs()[command.index] = static_cast<std::int64_t>(command.value);
            outputs_by_hand[command.index] = {true, command.client};
            return {};
        case OperatorAction::release_outputs: release_outputs(command.client); return {};
        case OperatorAction::acknowledge_alarms:
            log.acknowledge();
            for (auto& axis : axes) axis.acknowledge_alarms();
            return {};
        case OperatorAction::shutdown:
            shutdown_taken = true;
            shutdown_asked.store(true, std::memory_order_release);
            return {};
        default: return {Answer::unknown_name};
    }
}

void Machine::Impl::reset_machine() noexcept {
    log.reset();
    for (auto& count : task_overruns) count = 0;
    for (auto& state : program_states)
        if (state == ProgramState::fault) state = ProgramState::stopped;
}

// Every axis is asked, whatever the others say; the answer is the first refusal.
Machine::Impl::Verdict Machine::Impl::execute_all(const OperatorCommand& command) noexcept {
    switch (command.action) {
        case OperatorAction::stop:
        case OperatorAction::power:
        case OperatorAction::take_control:
        case OperatorAction::release_control: break;
        case OperatorAction::reset: reset_machine(); break;
        default: return {Answer::unknown_name};
    }
    Verdict first;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (config.axes[i].axis.disabled) continue;
        const auto each = execute_axis(command, i);
        if (first.answer == Answer::accepted) first = each;
    }
    return first;
}

Machine::Impl::Verdict Machine::Impl::execute_axis(const OperatorCommand& command, std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    AxisCommand wanted;
    switch (command.action) {
        case OperatorAction::take_control:
            // Manual speed limits hold outside automatic mode only, and the program's sequence would go on without its axis.
            if (mode == Mode::automatic) return {Answer::wrong_mode};
            axes[axis].take_control(command.owner);
            return {};
        case OperatorAction::release_control:
            if (axes[axis].view().owner != command.owner) return verdict(ErrorId::owned_by_other);
            axes[axis].release_control(command.owner);
            return {};
        case OperatorAction::power: return power(command, axis);
        case OperatorAction::home:
            wanted.kind = CommandKind::home;
            wanted.position = config.axes[axis].axis.homing.offset;
            return verdict(requests.submit(ref, wanted, command.owner).error);
        case OperatorAction::jog: return jog(command, axis);
        case OperatorAction::move_absolute:
            wanted.kind = CommandKind::move_absolute;
            wanted.position = command.value;
            wanted.velocity = command.value2;
            return verdict(requests.submit(ref, wanted, command.owner).error);
        case OperatorAction::stop: return stop(axis);
        case OperatorAction::reset: return verdict(requests.reset(ref, command.owner));
        default: return {Answer::unknown_name};
    }
}

// The wish itself is given in each cycle, where programs give theirs (renew_operator_power).
Machine::Impl::Verdict Machine::Impl::power(const OperatorCommand& command, std::size_t axis) noexcept {
    const auto& view = axes[axis].view();
    if (view.owner != command.owner) return verdict(ErrorId::owned_by_other);
    if (command.flag && emergency) return verdict(ErrorId::interlocked);
    if (command.flag && view.state == AxisState::ErrorStop) return verdict(ErrorId::in_error_stop);
    // Else the wish would wait, and the motor be switched on whenever the drive comes. A program's wish waits: it sees what it waits for.
    if (command.flag && !view.online) return verdict(ErrorId::drive_not_ready);
    operator_power[axis].held = command.flag;
    if (!command.flag) axes[axis].shut_down();  // ramps down first
    return {};
}

// Stopping is everybody's right: it is carried out in the owner's name.
Machine::Impl::Verdict Machine::Impl::stop(std::size_t axis) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    const auto owner = axes[axis].view().owner;
    operator_power[axis].jog = 0;
    switch (axes[axis].view().state) {
        case AxisState::Disabled:
        case AxisState::Stopping:
        case AxisState::ErrorStop: return {};  // it stands, or stops already
        default: break;
    }
    AxisCommand wanted;
    wanted.kind = CommandKind::halt;
    auto submitted = requests.submit(ref, wanted, owner);
    if (submitted.error == ErrorId::state_forbids) {  // the state diagram has no halt out of Homing
        wanted.kind = CommandKind::stop;
        submitted = requests.submit(ref, wanted, owner);
        if (submitted.error == ErrorId::none) requests.release_stop(ref, submitted.id, owner);
    }
    return verdict(submitted.error == ErrorId::interlocked ? ErrorId::none : submitted.error);  // an emergency stop is under way
}

Machine::Impl::Verdict Machine::Impl::jog(const OperatorCommand& command, std::size_t axis) noexcept {
    auto& power = operator_power[axis];
    const axes::AxisRef ref{static_cast<std::uint16_t>(axis)};
    if (!std::isfinite(command.value)) return {Answer::bad_value};
    auto ended_by = axes::ErrorId::none;
    const auto status = axes[axis].view().status(power.jog, &ended_by);
    const bool jogging = status == axes::CommandStatus::active || status == axes::CommandStatus::in_target;
    if (command.value == 0) return jogging ? stop(axis) : Verdict{};
    if (jogging) {
        const auto error = requests.renew_jog(ref, power.jog, command.value, command.owner);
        const bool lease_over = error == ErrorId::state_forbids;
        if (!(lease_over && command.flag)) return lease_over ? Verdict{Answer::stale} : verdict(error);
    }
    // A heartbeat of a jog that is over must not start the axis anew: it takes a fresh press (flag). Why it is over is not always its lease.
    if (!command.flag) {
        using enum axes::CommandStatus;
        if (status == done) return verdict(axes::ErrorId::beyond_software_limit);  // it went as far as the axis may
        if (status == aborted) return verdict(axes::ErrorId::aborted_by_command);
        if (status == error && ended_by != static_cast<axes::ErrorId>(axes::AxisAlarm::jog_lease_expired)) return verdict(ended_by);
        return {Answer::stale};
    }
    AxisCommand wanted;
    wanted.kind = CommandKind::jog;
    wanted.velocity = command.value;
    const auto submitted = requests.submit(ref, wanted, command.owner);
    power.jog = submitted.id;
    return verdict(submitted.error);
}

void Machine::Impl::set_mode(Mode wanted) noexcept {
    if (wanted == mode) return;
    if (mode == Mode::automatic) stop_programs();
    release_outputs();
    mode = wanted;
    if (wanted == Mode::automatic) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            if (operator_power[i].held) axes[i].shut_down();
            operator_power[i] = {};
        }
    }
    for (auto& axis : axes) axis.set_mode(operating(wanted));
}

void Machine::Impl::release_outputs() noexcept {
    for (std::size_t i = 0; i < outputs_by_hand.size(); ++i) {
        if (outputs_by_hand[i].held) io.make_safe(i);
        outputs_by_hand[i] = {};
    }
}

void Machine::Impl::release_outputs(std::uint32_t client) noexcept {
    for (std::size_t i = 0; i < outputs_by_hand.size(); ++i) {
        if (!outputs_by_hand[i].held || outputs_by_hand[i].client != client) continue;
        io.make_safe(i);
        outputs_by_hand[i] = {};
    }
}

void Machine::Impl::renew_operator_power() noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        auto& power = operator_power[i];
        if (!power.held) continue;
        const auto& view = axes[i].view();
        // After an emergency stop, or once an error has taken power away, a person must switch on again: a reset does not.
        const bool fell = view.state == AxisState::ErrorStop && view.drive_state != axes::PowerState::enabled;
        if (emergency || fell) {
            power.held = false;
            axes[i].shut_down();
        } else {
            axes[i].power(true, true, true, view.owner);  // whoever has taken control of the axis has taken its power, too
        }
    }
}

}  // namespace taktwerk::runtime

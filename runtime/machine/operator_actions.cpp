// What each command of an operator does. Real-time safe.

#include <algorithm>

#include "runtime/machine/after_emergency.hpp"
#include "runtime/machine/operator_desk.hpp"

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

void OperatorDesk::begin() noexcept {
    groups_.hand().set_mode(operating(body_.mode));
    if (body_.mode != Mode::automatic) return;
    for (std::size_t p = 0; p < body_.config.programs.size(); ++p)
        if (body_.config.programs[p].autostart) (void)programs_.start(p, 0);
}

Verdict OperatorDesk::execute(const OperatorCommand& command) noexcept {
    const bool a_person = command.owner == Owner::operator_panel || command.owner == Owner::commissioning;
    switch (command.action) {
        case OperatorAction::group_halt:
        case OperatorAction::group_interrupt:
        case OperatorAction::group_continue:
        case OperatorAction::group_override:
        case OperatorAction::group_reset:
        case OperatorAction::group_enable:
        case OperatorAction::group_jog:
        case OperatorAction::group_disable: return execute_group(command);
        case OperatorAction::none:
        case OperatorAction::set_mode:
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset:
        case OperatorAction::set_parameter:
        case OperatorAction::set_output:
        case OperatorAction::acknowledge_alarms:
        case OperatorAction::release_outputs:
        case OperatorAction::force:
        case OperatorAction::unforce:
        case OperatorAction::release_forces:
        case OperatorAction::override_velocity:
        case OperatorAction::reset_peaks:
        case OperatorAction::reset_statistics:
        case OperatorAction::set_value:
        case OperatorAction::release_values:
        case OperatorAction::shutdown: return execute_machine(command);
        case OperatorAction::take_control:
        case OperatorAction::release_control:
        case OperatorAction::power:
        case OperatorAction::home:
        case OperatorAction::jog:
        case OperatorAction::move_absolute:
        case OperatorAction::stop:
        case OperatorAction::measure:
        case OperatorAction::reset:
            if (!a_person && command.action != OperatorAction::stop) return {Answer::no_control, ErrorId::owned_by_other};
            if (command.action == OperatorAction::stop) programs_.let_go_for_stop(command.axis);
            if (command.axis == all) return execute_all(command);
            if (command.axis >= body_.axes.size() || body_.config.axes[command.axis].axis.disabled) return {Answer::unknown_name};
            return execute_axis(command, command.axis);
    }
    return {Answer::unknown_name};  // a number that no enumerator has
}

Verdict OperatorDesk::execute_machine(const OperatorCommand& command) noexcept {
    switch (command.action) {
        case OperatorAction::set_mode:
            if (command.mode > Mode::automatic) return {Answer::bad_value};
            if (command.mode == Mode::automatic && body_.emergency) return {Answer::not_possible_now, ErrorId::interlocked};
            set_mode(command.mode);
            return {};
        case OperatorAction::program_start:
        case OperatorAction::program_stop:
        case OperatorAction::program_reset: return execute_program(command);
        case OperatorAction::set_parameter: return set_parameter(command);
        case OperatorAction::set_output: return set_output(command);
        case OperatorAction::release_outputs: release_outputs_of(command.client); return {};
        case OperatorAction::force:
        case OperatorAction::unforce: return force(command);
        case OperatorAction::release_forces:
            if (command.flag) body_.io.release_forces_of(command.client);
            else body_.io.release_forces();
            return {};
        case OperatorAction::override_velocity: return override_velocity(command);
        case OperatorAction::reset_peaks: return reset_peaks(command);
        case OperatorAction::reset_statistics: statistics_reset_ = true; return {};
        case OperatorAction::set_value: return programs_.write_value(command);
        case OperatorAction::release_values: programs_.values().let_go_of(command.client); return {};
        case OperatorAction::acknowledge_alarms:
            body_.log.acknowledge();
            for (auto& axis : body_.axes) axis.acknowledge_alarms();
            return {};
        case OperatorAction::shutdown:
            shutdown_taken_ = true;
            shutdown_asked_.store(true, std::memory_order_release);
            return {};
        default: return {Answer::unknown_name};
    }
}

Verdict OperatorDesk::execute_group(const OperatorCommand& command) noexcept {
    const bool a_person = command.owner == Owner::operator_panel || command.owner == Owner::commissioning;
    if (!a_person && command.action != OperatorAction::group_halt) return {Answer::no_control, ErrorId::owned_by_other};
    return groups_.execute(command);
}

Verdict OperatorDesk::set_parameter(const OperatorCommand& command) noexcept {
    auto& parameters = programs_.parameters();
    if (command.index >= parameters.size()) return {Answer::unknown_name};
    if (!programs_.host().parameter(command.index).takes(command.value)) return {Answer::bad_value};
    parameters[command.index] = command.value;
    return {};
}

Verdict OperatorDesk::set_output(const OperatorCommand& command) noexcept {
    auto& io = body_.io;
    if (command.index >= io.outputs().size()) return {Answer::unknown_name};
    if (!io.fits(command.index, command.value)) return {Answer::bad_value};
    if (body_.mode == Mode::automatic) return {Answer::wrong_mode};
    if (body_.emergency) return {Answer::not_possible_now, ErrorId::interlocked};
    if (programs_.any_runs_or_starts()) return {Answer::not_possible_now};
    io.set_output(command.index, command.value);
    outputs_by_hand_[command.index] = {true, command.client};
    return {};
}

Verdict OperatorDesk::force(const OperatorCommand& command) noexcept {
    auto& io = body_.io;
    const auto direction = command.flag ? IoDirection::output : IoDirection::input;
    const auto& kept = command.flag ? body_.kept.outputs : body_.kept.inputs;
    if (command.index >= kept.size()) return {Answer::unknown_name};
    if (command.action == OperatorAction::unforce) {
        io.release_force(direction, command.index);
        return {};
    }
    if (!kept[command.index].empty()) return {Answer::not_possible_now, ErrorId::not_supported};
    if (!io.can_force(direction, command.index, command.value)) return {Answer::bad_value};
    if (command.flag && body_.emergency) return {Answer::not_possible_now, ErrorId::interlocked};
    if (!io.force(direction, command.index, command.value, command.client)) return {Answer::not_possible_now, ErrorId::queue_full};
    return {};
}

Verdict OperatorDesk::override_velocity(const OperatorCommand& command) noexcept {
    if (!(command.value >= 0 && command.value <= 1)) return {Answer::bad_value};
    if (command.axis != all && (command.axis >= body_.axes.size() || body_.config.axes[command.axis].axis.disabled))
        return {Answer::unknown_name};
    for (std::size_t i = 0; i < body_.axes.size(); ++i)
        if (command.axis == all || command.axis == i) (void)body_.axes[i].set_operators_override(command.value);
    return {};
}

Verdict OperatorDesk::reset_peaks(const OperatorCommand& command) noexcept {
    if (command.axis != all && command.axis >= body_.axes.size()) return {Answer::unknown_name};
    for (std::size_t i = 0; i < body_.axes.size(); ++i)
        if (command.axis == all || command.axis == i) body_.following_peaks[i] = {};
    return {};
}

Verdict OperatorDesk::execute_program(const OperatorCommand& command) noexcept {
    if (command.index >= programs_.programs().size()) return {Answer::unknown_name};
    auto& program = programs_.programs()[command.index];
    switch (command.action) {
        case OperatorAction::program_start: return start_program(command);
        case OperatorAction::program_stop:
            if (program.running() || program.start_pending()) programs_.stop(command.index, ProgramState::stopped);
            return {};
        default: programs_.reset(command.index); return {};
    }
}

Verdict OperatorDesk::start_program(const OperatorCommand& command) noexcept {
    auto& program = programs_.programs()[command.index];
    if (body_.mode != Mode::automatic) return {Answer::wrong_mode};
    if (body_.emergency) return {Answer::not_possible_now, ErrorId::interlocked};
    if (body_.log.lists(id(MachineAlarm::emergency_stop)) || axes_to_reset(body_.axes))
        return {Answer::not_possible_now, ErrorId::in_error_stop};
    if (program.state == ProgramState::fault) return {Answer::not_possible_now};
    // What runs and waits goes on; else its stop() may still be to come.
    if (!program.running() && !programs_.start(command.index, command.after)) return {Answer::not_possible_now, ErrorId::state_forbids};
    program.requests.go_on();
    return {};
}

// Every axis is asked, whatever the others say; the answer is the first refusal.
Verdict OperatorDesk::execute_all(const OperatorCommand& command) noexcept {
    switch (command.action) {
        case OperatorAction::stop:
        case OperatorAction::power:
        case OperatorAction::take_control:
        case OperatorAction::release_control: break;
        case OperatorAction::reset:
            body_.log.reset();
            programs_.reset();
            break;
        default: return {Answer::unknown_name};
    }
    Verdict first;
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        if (body_.config.axes[i].axis.disabled) continue;
        if (command.action == OperatorAction::power && command.flag && !connected(body_.views[i].presence))
            continue;  // none of those that are here
        const auto each = execute_axis(command, i);
        if (first.answer == Answer::accepted) first = each;
    }
    if (command.action == OperatorAction::reset) {  // their members are under way now
        for (std::uint16_t i = 0; i < body_.axis_groups.size(); ++i) {
            const auto each = verdict_of(body_.axis_groups.reset({i}, command.owner));
            if (first.answer == Answer::accepted) first = each;
        }
    }
    return first;
}

Verdict OperatorDesk::execute_axis(const OperatorCommand& command, std::size_t index) noexcept {
    const axes::AxisRef ref{static_cast<std::uint16_t>(index)};
    auto& axis = body_.axes[index];
    AxisCommand wanted;
    switch (command.action) {
        case OperatorAction::take_control:
            // Manual speed limits hold outside automatic mode only, and the program's sequence would go on without its axis.
            if (body_.mode == Mode::automatic) return {Answer::wrong_mode};
            axis.take_control(command.owner);
            return {};
        case OperatorAction::release_control:
            if (axis.view().owner != command.owner) return verdict_of(ErrorId::owned_by_other);
            axis.release_control(command.owner);
            return {};
        case OperatorAction::power: return power(command, index);
        case OperatorAction::home:
            wanted.kind = CommandKind::home;
            wanted.position = body_.config.axes[index].axis.homing.offset;
            return verdict_of(body_.requests.submit(ref, wanted, command.owner).error);
        case OperatorAction::jog: return hands_.jog(command, index);
        case OperatorAction::measure: return measuring_.command(command, index);
        case OperatorAction::move_absolute:
            wanted.kind = CommandKind::move_absolute;
            wanted.position = command.value;
            wanted.velocity = command.value2;
            return verdict_of(body_.requests.submit(ref, wanted, command.owner).error);
        case OperatorAction::stop: return hands_.stop(index);
        case OperatorAction::reset: return verdict_of(body_.requests.reset(ref, command.owner));
        default: return {Answer::unknown_name};
    }
}

// The wish itself is given in each cycle, where programs give theirs (renew_power).
Verdict OperatorDesk::power(const OperatorCommand& command, std::size_t index) noexcept {
    auto& axis = body_.axes[index];
    const auto& view = axis.view();
    if (view.owner != command.owner) return verdict_of(ErrorId::owned_by_other);
    if (command.flag && body_.emergency) return verdict_of(ErrorId::interlocked);
    if (command.flag && view.state == AxisState::ErrorStop) return verdict_of(ErrorId::in_error_stop);
    if (command.flag && !connected(view.presence)) return verdict_of(ErrorId::not_connected);
    // Else the wish would wait, and the motor be switched on whenever the drive comes. A program's wish waits: it sees what it waits for.
    if (command.flag && !view.online) return verdict_of(ErrorId::drive_not_ready);
    power_held_[index] = command.flag;
    if (!command.flag) axis.shut_down();  // ramps down first
    return {};
}

void OperatorDesk::set_mode(Mode wanted) noexcept {
    if (wanted == body_.mode) return;
    if (body_.mode == Mode::automatic) programs_.stop_all();
    release_outputs();
    body_.mode = wanted;
    if (wanted == Mode::automatic) {
        for (std::size_t i = 0; i < body_.axes.size(); ++i) {
            if (power_held_[i]) body_.shut_down(i);
            power_held_[i] = false;
            hands_.forget_jog(i);
        }
    }
    groups_.hand().set_mode(operating(wanted));
}

void OperatorDesk::release_outputs() noexcept {
    for (std::size_t i = 0; i < outputs_by_hand_.size(); ++i) {
        if (outputs_by_hand_[i].held) body_.io.make_safe(i);
        outputs_by_hand_[i] = {};
    }
}

void OperatorDesk::release_outputs_of(std::uint32_t client) noexcept {
    for (std::size_t i = 0; i < outputs_by_hand_.size(); ++i) {
        if (!outputs_by_hand_[i].held || outputs_by_hand_[i].client != client) continue;
        body_.io.make_safe(i);
        outputs_by_hand_[i] = {};
    }
}

void OperatorDesk::renew_power() noexcept {
    for (std::size_t i = 0; i < body_.axes.size(); ++i) {
        if (!power_held_[i]) continue;
        auto& axis = body_.axes[i];
        const auto& view = axis.view();
        // After an emergency stop, or once an error has taken power away, a person must switch on again: a reset does not.
        const bool fell = view.state == AxisState::ErrorStop && view.drive_state != axes::PowerState::enabled;
        if (body_.emergency || fell) {
            power_held_[i] = false;
            axis.shut_down();
        } else {
            axis.power(true, true, true, view.owner);  // whoever has taken control of the axis has taken its power, too
        }
    }
}

void OperatorDesk::drop_power() noexcept { std::fill(power_held_.begin(), power_held_.end(), std::uint8_t{0}); }

}  // namespace taktwerk::runtime

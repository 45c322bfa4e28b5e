#include "runtime/machine/operator_values.hpp"

namespace taktwerk::runtime {

using axes::ErrorId;

OperatorValues::OperatorValues(const ProgramHost& host)
    : host_(host), by_variable_(host.variables().size(), -1), of_task_(host.tasks().size()) {
    for (const auto& value : host.operator_values()) {
        by_variable_[value.variable] = static_cast<std::int32_t>(values_.size());
        // A task that is not there is an error of the declaration, and this machine will not be built.
        if (value.task < of_task_.size()) of_task_[value.task].push_back(static_cast<std::uint16_t>(values_.size()));
        const auto& variable = host.variables()[value.variable];
        values_.push_back({value, variable.type, variable.program, 0, false, false, false, 0, {}});
    }
}

std::int32_t OperatorValues::program_of(std::size_t variable) const noexcept {
    if (variable >= by_variable_.size() || by_variable_[variable] < 0) return -1;
    return static_cast<std::int32_t>(values_[static_cast<std::size_t>(by_variable_[variable])].program);
}

Verdict OperatorValues::write(const OperatorCommand& command, Instant now, bool runs, bool emergency) noexcept {
    if (program_of(command.index) < 0) return {Answer::unknown_name};
    auto& value = values_[static_cast<std::size_t>(by_variable_[command.index])];
    if (!host_.variable(command.index).takes(command.value)) return {Answer::bad_value};
    if (command.value == 0 && value.of.momentary) {
        lift(value);  // letting go is everybody's right, and never too late
        return {};
    }
    const bool puts_on = value.type == VariableType::boolean && command.value != 0;
    if (puts_on && emergency) return {Answer::not_possible_now, ErrorId::interlocked};
    if (value.of.momentary) {
        const bool other = value.held && value.client != command.client;
        if (other) return {Answer::no_control, ErrorId::owned_by_other};
        if (!command.flag && !value.held) return {Answer::stale};  // what was let go is not pressed by a heartbeat
        if (!runs) return {Answer::not_possible_now};
        value.until = now + lease;
        if (value.held) return {};  // renewed; what the program made of it meanwhile stands
        value.held = true;
        value.falls = false;
        value.client = command.client;
    }
    value.given = command.value;
    value.waits = true;
    return {};
}

// A press that its task has not seen yet is taken back: what ends it is a stop, or nobody knows what the hand wants.
void OperatorValues::release(Value& value) noexcept {
    if (!value.held && !value.falls) return;
    value.held = value.falls = false;
    value.given = 0;
    value.waits = true;
}

// By the hand that pressed: a tap shorter than the period of its task was meant, and one run sees it.
void OperatorValues::lift(Value& value) noexcept {
    if (value.held && value.waits) {
        value.held = false;
        value.falls = true;
        return;
    }
    if (value.held) release(value);
}

/// Taken by its task: what was let go meanwhile falls with the next run.
void OperatorValues::taken(Value& value) noexcept {
    value.waits = value.falls;
    if (value.falls) value.given = 0;
    value.falls = false;
}

void OperatorValues::let_go(std::size_t program) noexcept {
    for (auto& value : values_)
        if (value.program == program) release(value);
}

void OperatorValues::let_go_of(std::uint32_t client) noexcept {
    for (auto& value : values_)
        if (value.held && value.client == client) release(value);
}

void OperatorValues::let_go_all() noexcept {
    for (auto& value : values_) release(value);
}

void OperatorValues::end_leases(Instant now) noexcept {
    for (auto& value : values_)
        if (value.held && value.until < now) release(value);
}

void OperatorValues::apply(std::size_t task) noexcept {
    for (const auto place : of_task_[task]) {
        auto& value = values_[place];
        if (!value.waits) continue;
        ProgramHost::write(value.type, value.of.address, value.given);
        taken(value);
    }
}

std::size_t OperatorValues::take(std::size_t task, std::span<SlowTask::Write> out) noexcept {
    std::size_t count = 0;
    for (const auto place : of_task_[task]) {
        auto& value = values_[place];
        if (!value.waits || count == out.size()) continue;
        out[count++] = {value.type, value.of.address, value.given};
        taken(value);
    }
    return count;
}

bool OperatorValues::apply_at_rest(std::size_t program, std::span<double> shown) noexcept {
    bool any = false;
    for (auto& value : values_) {
        if (!value.waits || value.program != program) continue;
        ProgramHost::write(value.type, value.of.address, value.given);
        shown[value.of.variable] = value.given;
        value.waits = false;
        any = true;
    }
    return any;
}

}  // namespace taktwerk::runtime

#include "runtime/machine/operator_desk.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::size_t inbox_size = 64;

}  // namespace

OperatorDesk::OperatorDesk(MachineBody& body, HandMotion& hands, Measuring& measuring, GroupDesk& groups, ProgramRunner& programs)
    : body_(body),
      hands_(hands),
      measuring_(measuring),
      groups_(groups),
      programs_(programs),
      inbox_(inbox_size),
      answers_(inbox_size * 2),
      levels_(body.config.axes.size()),
      power_held_(body.config.axes.size()),
      outputs_by_hand_(body.io.outputs().size()) {}

std::optional<CommandAnswer> OperatorDesk::next_answer() noexcept {
    CommandAnswer answer;
    if (!answers_.try_pop(answer)) return std::nullopt;
    return answer;
}

StopLevels::Ticket OperatorDesk::request_shutdown() noexcept {
    shutdown_asked_.store(true, std::memory_order_release);
    return levels_.shutdown();
}

// One place for what comes from outside. Nobody waits for an answer in the ring.
void OperatorDesk::take_levels(Instant at) noexcept {
    levels_.take([&](StopLevel what, std::uint16_t axis, std::uint64_t number) {
        if (body_.recorder) record_level(*body_.recorder, at, what, axis, number);
        if (what == StopLevel::shutdown) {
            shutdown_taken_ = true;
            return;
        }
        // Before that nothing moves; a program that starts by itself shall not then.
        const bool moves = body_.armed.load(std::memory_order_relaxed);
        const bool all = axis == StopLevels::all_axes;
        if (what == StopLevel::stop) programs_.let_go_for_stop(axis);
        for (std::size_t i = all ? 0 : axis; i < (all ? body_.axes.size() : axis + std::size_t{1}); ++i) {
            hands_.note_stop(i, number);
            if (!moves) continue;
            // A program's axis was never jogged: that press was refused.
            const bool spared = what == StopLevel::release_jog && body_.axes[i].view().owner == axes::Owner::program;
            if (body_.config.axes[i].axis.disabled || spared) continue;
            (void)(what == StopLevel::stop ? hands_.stop(i) : hands_.let_go(i));
        }
    });
}

/// Given before a stop of its axis (a program: of one of its axes), and only now at its turn: it must not start what that stop has ended.
bool OperatorDesk::overtaken(const OperatorCommand& command) const noexcept {
    if (command.action == OperatorAction::program_start)
        return command.index < programs_.programs().size() && command.after < programs_.newest_stop_of(command.index);
    // What puts something on may start a motion; what it does is the program's.
    if (command.action == OperatorAction::set_value && command.value != 0) {
        const auto program = programs_.values().program_of(command.index);
        return program >= 0 && command.after < programs_.newest_stop_of(static_cast<std::size_t>(program));
    }
    if (command.action == OperatorAction::group_continue || (command.action == OperatorAction::group_jog && command.value != 0))
        return command.after < groups_.newest_stop(command.index);
    const bool starts_motion = command.action == OperatorAction::home || command.action == OperatorAction::move_absolute ||
                               command.action == OperatorAction::measure || (command.action == OperatorAction::jog && command.value != 0);
    return starts_motion && command.axis < body_.axes.size() && command.after < hands_.newest_stop(command.axis);
}

void OperatorDesk::drain_inbox(Instant at) noexcept {
    groups_.hand().settle_mode();
    OperatorCommand command;
    for (std::uint8_t i = 0; i < body_.config.commands_per_cycle && inbox_.try_pop(command); ++i) {
        if (body_.recorder) record_command(*body_.recorder, at, command);
        // A stop is never too late, and while the run ends everything stops anyway.
        const bool stops = command.action == OperatorAction::stop || command.action == OperatorAction::shutdown ||
                           command.action == OperatorAction::group_halt;
        const bool expired = !stops && command.expires != Instant{} && command.expires < at;
        if (expired || overtaken(command)) answer(command, {Answer::stale});
        else if (!stops && body_.shutting_down) answer(command, {Answer::not_possible_now});
        else answer(command, execute(command));
    }
}

void OperatorDesk::answer(const OperatorCommand& command, Verdict verdict) noexcept {
    CommandAnswer reply;
    reply.client = command.client;
    reply.sequence = command.sequence;
    reply.answer = verdict.answer;
    reply.error = verdict.error;
    reply.jog_end = verdict.jog_end;
    reply.limiting = verdict.limiting;
    reply.room = verdict.room;
    reply.waits_for_program = verdict.waits_for_program;
    if (command.axis < body_.axes.size()) {
        reply.owner = body_.axes[command.axis].view().owner;
        reply.holder = body_.axes[command.axis].view().holder;
        if (verdict.answer == Answer::accepted) tell_limit(command, reply);
    }
    if (is_of_a_group(command.action) && command.index < body_.axis_groups.size())
        reply.owner = groups_.owner_against(command.index, command.owner);
    if (verdict.answer != Answer::accepted) ++body_.statistics.commands_refused;
    answers_.try_push(reply);  // a full ring means nobody reads: the client's own time-out tells it
}

// Who asked for more than the axis gives now is told so: a slow axis must not look like a granted wish.
void OperatorDesk::tell_limit(const OperatorCommand& command, CommandAnswer& reply) const noexcept {
    const bool moves = command.action == OperatorAction::jog || command.action == OperatorAction::move_absolute;
    if (!moves) return;
    const double wanted = std::abs(command.action == OperatorAction::jog ? command.value : command.value2);
    const auto& view = body_.axes[command.axis].view();
    const auto& limits = body_.config.axes[command.axis].axis;
    const auto mode = body_.mode;
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

}  // namespace taktwerk::runtime

#include "hmi_bridge/gateway/gateway.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "hmi_bridge/gateway/request_age.hpp"
#include "hmi_bridge/words/answer_text.hpp"
#include "hmi_bridge/words/target_names.hpp"

namespace taktwerk::hmi {

using runtime::Answer;
using runtime::OperatorAction;
using runtime::OperatorCommand;

namespace {

/// Stops that wait for their answer; far beyond what people and their retries give.
constexpr std::size_t most_levels = 1024;
/// Above this a double skips whole numbers.
constexpr double largest_exact_integer = 9007199254740992.0;

double milliseconds(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

std::string with_unit(double value, std::string_view unit) { return fmt::format("{:g}{}{}", value, unit.empty() ? "" : " ", unit); }

Error bad_value(std::string what, std::string remedy) { return {"command.bad_value", "", std::move(what), std::move(remedy)}; }

/// Lives by renewals.
bool is_held(CommandKind kind) noexcept {
    return kind == CommandKind::jog || kind == CommandKind::group_jog || kind == CommandKind::measure;
}

bool lets_go(const CommandRequest& request) noexcept {
    return (request.kind == CommandKind::jog || request.kind == CommandKind::group_jog) && request.value == 0;
}
/// Of a button, or a switch that is put off: never too late either, but in its turn.
bool puts_off(const CommandRequest& request) noexcept { return request.kind == CommandKind::set_value && request.value == 0; }

/// Bit by bit, so that a repeated NaN is the same NaN.
bool same(double a, double b) noexcept { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

std::optional<Error> check_jog_velocity(const runtime::MachineLayout::AxisInfo& axis, double velocity) {
    if (axis.jog_fast > 0 && std::abs(velocity) > axis.jog_fast)
        return bad_value(fmt::format("{:g} {}/s is faster than this axis may jog", velocity, axis.unit),
                         fmt::format("Give at most {:g} {}/s.", axis.jog_fast, axis.unit));
    return std::nullopt;
}

/// Of a point. What has a unit is no word: the machine knows how far its line goes (IoImage::fits).
std::optional<Error> check_whole(const std::vector<std::string>& units, std::uint16_t point, double value) {
    if (point < units.size() && !units[point].empty()) return std::nullopt;
    if (value != std::floor(value) || std::abs(value) > largest_exact_integer)
        return bad_value(fmt::format("{:g} is not a whole number", value), "Give 0 or 1, or a whole number for a word.");
    return std::nullopt;
}

std::optional<Error> check_value(const runtime::MachineLayout::Variable& variable, const CommandRequest& request) {
    if (request.press && !variable.momentary)
        return bad_value("only a button is pressed, and this is none", "Leave `press` out: the value stays until it is written again.");
    if (variable.takes(request.value)) return std::nullopt;
    if (variable.type == VariableType::boolean) return bad_value(fmt::format("{:g} is neither off nor on", request.value), "Give 0 or 1.");
    if (request.value < variable.minimum || request.value > variable.maximum)
        return bad_value(fmt::format("{} is outside its range", with_unit(request.value, variable.unit)),
                         fmt::format("Give {:g} to {}.", variable.minimum, with_unit(variable.maximum, variable.unit)));
    return bad_value(fmt::format("{:g} is not a whole number, and the program counts with it", request.value),
                     fmt::format("Give {:g} or {:g}.", std::floor(request.value), std::ceil(request.value)));
}

/// Numbers that mean something for this command, in its range.
std::optional<Error> check_values(const CommandWord& word, const CommandRequest& request, const OperatorCommand& command,
                                  const runtime::MachineLayout& layout) {
    for (const auto& [key, value] : {std::pair{word.value, request.value}, std::pair{word.value2, request.value2}})
        if (!key.empty() && !std::isfinite(value)) return bad_value(fmt::format("{} is not a finite number", key), "Give a finite number.");
    switch (word.kind) {
        case CommandKind::jog:
            if (request.press && request.value == 0)
                return bad_value("a jog is pressed with velocity 0", "Give a velocity; 0 is for letting go.");
            return check_jog_velocity(layout.axes[command.axis], request.value);
        case CommandKind::group_jog:
            if (request.press && request.value == 0)
                return bad_value("a jog is pressed with velocity 0", "Give a velocity; 0 is for letting go.");
            if (request.value < 0 || request.value > 1)
                return bad_value(fmt::format("{:g} is no part of the jogging velocity", request.value),
                                 "Give a part above 0 and up to 1; the sense stands in `direction`.");
            return std::nullopt;
        case CommandKind::move:
            if (request.value2 <= 0)
                return bad_value("a move to a position needs a velocity above 0",
                                 "Give `velocity`; the direction comes from the position.");
            return std::nullopt;
        case CommandKind::set_parameter: {
            const auto& parameter = layout.parameters[command.index];
            if (request.value < parameter.minimum || request.value > parameter.maximum)
                return bad_value(fmt::format("{} is outside its range", with_unit(request.value, parameter.unit)),
                                 fmt::format("Give {:g} to {}.", parameter.minimum, with_unit(parameter.maximum, parameter.unit)));
            if (!parameter.takes(request.value))
                return bad_value(fmt::format("{:g} is not a whole number, and the program counts with this parameter", request.value),
                                 fmt::format("Give {:g} or {:g}.", std::floor(request.value), std::ceil(request.value)));
            return std::nullopt;
        }
        case CommandKind::override_velocity:
        case CommandKind::group_override:
            if (request.value < 0 || request.value > 1)
                return bad_value(fmt::format("{:g} is no part of a velocity", request.value), "Give 0 (halt) to 1 (as commanded).");
            return std::nullopt;
        case CommandKind::set_value: return check_value(layout.variables[command.index], request);
        case CommandKind::force:
            if (const auto& kept = request.output ? layout.kept_outputs : layout.kept_inputs;
                command.index < kept.size() && !kept[command.index].empty())
                return Error{"command.not_possible_now", "", fmt::format("nobody may force it: {}", kept[command.index]),
                             "Force what a program reads or writes; do this at the machine."};
            return check_whole(request.output ? layout.output_units : layout.input_units, command.index, request.value);
        case CommandKind::set_output: return check_whole(layout.output_units, command.index, request.value);
        default: return std::nullopt;
    }
}

}  // namespace

bool CommandRequest::same_as(const CommandRequest& other) const noexcept {
    return kind == other.kind && target == other.target && output == other.output && press == other.press &&
           commissioning == other.commissioning && mode == other.mode && same(value, other.value) && same(value2, other.value2) &&
           measure == other.measure && group_jog == other.group_jog;
}

TargetKind target_kind(const CommandWord& word, const CommandRequest& request) noexcept {
    if (word.target != TargetKind::point) return word.target;
    return request.output ? TargetKind::output : TargetKind::input;
}

std::string_view Gateway::name_of(ClientId id) const noexcept {
    const auto client = clients_.find(id);
    return client == clients_.end() ? std::string_view{} : std::string_view(client->second.name);
}

Gateway::Entry* Gateway::Client::find(std::uint64_t sequence) noexcept {
    for (auto& entry : entries)
        if (entry.state != Entry::State::empty && entry.request.sequence == sequence) return &entry;
    return nullptr;
}

ClientId Gateway::open(Source source, std::string name, Rights rights) {
    if (clients_.size() >= max_clients) return 0;
    while (next_client_ == 0 || clients_.count(next_client_) != 0) ++next_client_;
    auto& client = clients_[next_client_];
    client.source = source;
    client.name = std::move(name);
    client.rights = rights;
    return next_client_++;
}

void Gateway::close(ClientId id) {
    if (const auto client = clients_.find(id); client != clients_.end()) note_end(id, client->second);
    hands_.lift_all(id);
    clients_.erase(id);
    for (auto jog = jogs_.begin(); jog != jogs_.end();) {
        if (jog->second.client != id) {
            ++jog;
            continue;
        }
        machine_.release_jog(jog->first);
        jog = jogs_.erase(jog);
    }
}

std::optional<Gateway::Refusal> Gateway::check_age(const CommandRequest& request, Instant now) const {
    RequestAge given{request.valid_for, request.age, request.arrival.at};
    if (auto error = given.refuse_validity(is_held(request.kind) ? longest_jog_validity : RequestAge::longest_validity))
        return Refusal{Answer::bad_value, std::move(*error)};
    given.valid_for = validity_of(request);
    if (auto error = given.refuse_age(now)) return Refusal{Answer::stale, std::move(*error)};
    return std::nullopt;
}

bool Gateway::is_button(const CommandRequest& request) const {
    if (request.kind != CommandKind::set_value) return false;
    const auto& layout = machine_.layout();
    const auto variable = find_target(layout, TargetKind::variable, request.target);
    return variable && layout.variables[*variable].momentary;
}

// Of a button no longer than of a jog: an old press is not what the hand does now.
Duration Gateway::validity_of(const CommandRequest& request) const {
    return is_button(request) ? std::min(request.valid_for, longest_jog_validity) : request.valid_for;
}

std::optional<Gateway::Refusal> Gateway::check_jog(const CommandRequest& request, const OperatorCommand& command, Instant now) const {
    const bool moves = request.kind == CommandKind::move || request.kind == CommandKind::home;
    if (!moves && (!is_held(request.kind) || lets_go(request))) return std::nullopt;
    bool holds = true;  // all of it
    for (const auto axis : axes_of(request)) {
        const auto found = jogs_.find(axis);
        const bool mine = found != jogs_.end() && found->second.client == request.client;
        const bool alive = found != jogs_.end() && now - found->second.renewed <= jog_session;
        holds = holds && mine && alive;
        if (!alive || mine) continue;
        const auto other = clients_.find(found->second.client);
        const auto which =
            command.axis < machine_.layout().axes.size() ? std::string("this axis") : "axis " + machine_.layout().axes[axis].name;
        return Refusal{
            Answer::no_control,
            {"command.no_control", "",
             fmt::format("{} is jogging or measuring {}", other == clients_.end() ? "another client" : other->second.name, which),
             "Wait until it lets go."}};
    }
    if (!moves && !request.press && !holds) {
        runtime::CommandAnswer stale;
        stale.answer = Answer::stale;
        return Refusal{Answer::stale, explain(stale, request.kind, "", {})};
    }
    return std::nullopt;
}

std::optional<Gateway::Refusal> Gateway::translate(const Client& client, const CommandRequest& request, Instant now,
                                                   OperatorCommand& command) const {
    const auto* word = find_command(request.kind);
    if (!word)
        return Refusal{
            Answer::unknown_name,
            {"command.unknown_name", "", fmt::format("there is no command with number {}", static_cast<std::int32_t>(request.kind)),
             "Use a command of this version; view and runtime may be of different versions."}};
    command.action = word->action;
    command.client = request.client;
    command.sequence = request.sequence;
    const bool of_a_point = word->target == TargetKind::point;
    command.flag = request.kind == CommandKind::enable ||
                   ((is_held(request.kind) || request.kind == CommandKind::set_value) && request.press) || (of_a_point && request.output);
    command.measure = request.measure;
    command.mode = request.mode;
    command.value = request.value;
    command.value2 = request.value2;
    if (request.commissioning && client.rights != Rights::commissioning)
        return Refusal{Answer::no_control,
                       {"command.no_control", "", "commissioning commands are taken from the local socket only",
                        "Use the command line on this computer."}};
    if (request.commissioning) command.owner = axes::Owner::commissioning;
    if (client.source == Source::lcm && (request.kind == CommandKind::shutdown || request.kind == CommandKind::set_output ||
                                         request.kind == CommandKind::measure || request.kind == CommandKind::group_jog || of_a_point))
        return Refusal{
            Answer::no_control,
            {"command.no_control", "", fmt::format("{} is not taken over LCM, where nobody knows who asks and who is gone", word->word),
             "Use the local socket."}};
    if (request.mode > runtime::Mode::automatic)
        return Refusal{Answer::bad_value, bad_value("there is no such mode", "Give manual, setup or automatic.")};

    const bool all_by_default = request.kind == CommandKind::stop || request.kind == CommandKind::reset;
    const auto kind = target_kind(*word, request);
    const auto target =
        find_target(machine_.layout(), kind, request.target.empty() && all_by_default ? "all" : std::string_view(request.target));
    if (!target) return Refusal{Answer::unknown_name, target.error()};
    const bool axis = kind == TargetKind::axis || kind == TargetKind::axis_or_all;
    (axis ? command.axis : command.index) = *target;

    const bool never_late = lets_go(request) || puts_off(request);
    auto refusal = never_late ? std::nullopt : check_age(request, now);
    if (!refusal)
        if (auto error = check_values(*word, request, command, machine_.layout()))
            refusal =
                Refusal{error->code == code(Answer::not_possible_now) ? Answer::not_possible_now : Answer::bad_value, std::move(*error)};
    if (request.kind == CommandKind::group_jog && !lets_go(request) && !refusal) {
        const auto order = read_group_jog(request.group_jog, machine_.layout(), command.index);
        if (order) command.group_jog = *order;
        else
            refusal =
                Refusal{order.error().code == code(Answer::not_possible_now) ? Answer::not_possible_now : Answer::bad_value, order.error()};
        command.value2 = request.group_jog.distance;
    }
    if (!refusal) refusal = check_jog(request, command, now);
    if (const auto stuck = machine_.stuck(); !refusal && !lets_go(request) && stuck)
        refusal = Refusal{Answer::not_possible_now,
                          {"command.not_possible_now", "", *stuck, "Use the emergency stop; end the runtime and mend that program."}};
    if (!refusal && !cycling_)
        refusal = Refusal{Answer::not_possible_now,
                          {"command.not_possible_now", "", "the machine is still starting: its bus is not operational yet",
                           "Wait until it runs (taktwerk monitor shows the progress), then give the command again."}};
    if (refusal && refusal->error.subject.empty())
        refusal->error.subject = subject_of(machine_.layout(), kind, command.axis, command.index);
    command.expires = puts_off(request)
                          ? Instant{}
                          : now + (validity_of(request) - RequestAge{.age = request.age, .arrived = request.arrival.at}.at(now));
    command.after = request.arrival.after;
    return refusal;
}

void Gateway::settle(Client& client, Entry& entry, Answer answer, axes::ErrorId axis_error, Error error, std::string note) {
    entry.reply = {entry.request.client, client.source,    entry.request.sequence, entry.request.kind, answer,
                   axis_error,           std::move(error), std::move(note)};
    entry.state = answer == Answer::queue_full ? Entry::State::open_again : Entry::State::answered;
    replies_.push_back(entry.reply);
}

void Gateway::handle(const CommandRequest& request, Instant now) {
    const auto found = clients_.find(request.client);
    if (found == clients_.end()) return;
    auto& client = found->second;
    const auto refuse = [&](Answer answer, std::string what, std::string remedy) {
        replies_.push_back({request.client,
                            client.source,
                            request.sequence,
                            request.kind,
                            answer,
                            axes::ErrorId::none,
                            {std::string(code(answer)), "", std::move(what), std::move(remedy)}});
    };

    const bool may_shut_down = request.kind == CommandKind::shutdown && client.source != Source::lcm;  // the others are refused below
    if (request.kind == CommandKind::stop || may_shut_down) {
        const auto target = request.kind == CommandKind::shutdown || request.target.empty()
                                ? Result<std::uint16_t>(all_axes)
                                : find_target(machine_.layout(), TargetKind::axis_or_all, request.target);
        if (!target) return refuse(Answer::unknown_name, target.error().what, target.error().remedy);
        client.highest = std::max(client.highest, request.sequence);
        note(request.client, client, request, now);
        return raise(client, request, *target, now);
    }
    if (request.kind == CommandKind::group_halt) {
        const auto target = find_target(machine_.layout(), TargetKind::group, request.target);
        if (!target) return refuse(Answer::unknown_name, target.error().what, target.error().remedy);
        client.highest = std::max(client.highest, request.sequence);
        note(request.client, client, request, now);
        return raise_of_group(client, request, *target, now);
    }
    if (lets_go(request)) let_go(request);  // done, whatever the answer will be
    if (request.sequence == 0) return refuse(Answer::bad_value, "the sequence number is 0", "Count from 1.");
    Entry* entry = client.find(request.sequence);
    if (entry && !entry->request.same_as(request))
        return refuse(Answer::duplicate, fmt::format("sequence {} was used for another command", request.sequence),
                      "Use a new sequence number for each command.");
    if (entry && entry->state == Entry::State::waiting) return;  // its answer is on the way
    if (entry && entry->state == Entry::State::answered) return replies_.push_back(entry->reply);
    if (!entry && request.sequence <= client.highest)
        return refuse(Answer::duplicate, fmt::format("sequence {} comes after {}", request.sequence, client.highest),
                      "Sequence numbers increase; a client that starts anew takes a new client id.");
    if (!entry) {
        entry = &client.entries[0];  // the oldest gives way
        for (auto& candidate : client.entries) {
            if (candidate.state == Entry::State::empty) {
                entry = &candidate;
                break;
            }
            if (candidate.request.sequence < entry->request.sequence) entry = &candidate;
        }
        if (entry->state == Entry::State::waiting)
            return refuse(Answer::queue_full, fmt::format("{} commands of this client wait for their answers", remembered),
                          "Wait for an answer, then give it again.");
        client.highest = request.sequence;
    }
    entry->request = request;
    entry->submitted = now;

    OperatorCommand command;
    if (auto refusal = translate(client, request, now, command))
        return settle(client, *entry, refusal->answer, axes::ErrorId::none, std::move(refusal->error));
    if (lets_go(request)) {
        note(request.client, client, request, now);
        return settle(client, *entry, Answer::accepted, axes::ErrorId::none, {});
    }
    if (!machine_.submit(command)) {
        runtime::CommandAnswer full;
        full.answer = Answer::queue_full;
        return settle(client, *entry, Answer::queue_full, axes::ErrorId::none, explain(full, request.kind, "", {}));
    }
    entry->state = Entry::State::waiting;
    client.set_outputs = client.set_outputs || request.kind == CommandKind::set_output;
    client.wrote_values = client.wrote_values || (request.kind == CommandKind::set_value && request.press);
    client.forces = client.forces || request.kind == CommandKind::force;
    if (!is_held(request.kind)) return;
    for (const auto axis : axes_of(request)) {
        auto& jog = jogs_[axis];
        // What is held already stays what it is until the machine has said what became of another key under the same hand.
        const bool live = jog.client == request.client && jog.live && now - jog.renewed <= jog_session;
        if (live && !jog.is_of(request)) continue;
        jog = {request.client, now, live, request.kind, request.target};
    }
}

std::vector<std::uint16_t> Gateway::axes_of(const CommandRequest& request) const {
    const auto& layout = machine_.layout();
    const bool of_a_group = request.kind == CommandKind::group_jog;
    const auto target = find_target(layout, of_a_group ? TargetKind::group : TargetKind::axis, request.target);
    if (!target) return {};
    if (of_a_group) return layout.groups[*target].members;
    return {*target};
}

void Gateway::let_go(const CommandRequest& request) {
    for (const auto axis : axes_of(request)) {
        const auto jog = jogs_.find(axis);
        if (jog == jogs_.end() || jog->second.client != request.client) continue;
        if (!request.arrival.level_raised) machine_.release_jog(axis);
        jogs_.erase(jog);
    }
}

// A level for each of its axes, as they are configured. The cycle takes them by their number: when the first axis' has been taken, which was raised
// last, all have.
void Gateway::raise_of_group(const Client& client, const CommandRequest& request, std::uint16_t group, Instant now) {
    auto members = machine_.layout().groups[group].members;
    std::sort(members.rbegin(), members.rend());
    runtime::StopLevels::Ticket last;
    for (const auto member : members) last = machine_.request_stop(member);
    wait_for(client, request, last, now);
}

void Gateway::raise(const Client& client, const CommandRequest& request, std::uint16_t axis, Instant now) {
    wait_for(client, request, request.kind == CommandKind::stop ? machine_.request_stop(axis) : machine_.request_shutdown(), now);
}

void Gateway::wait_for(const Client& client, const CommandRequest& request, runtime::StopLevels::Ticket ticket, Instant now) {
    if (levels_.size() >= most_levels) {  // the level stands; only who asks without end is told so before the cycle has said it
        replies_.push_back({request.client, client.source, request.sequence, request.kind, Answer::accepted, axes::ErrorId::none, {}});
        return;
    }
    levels_.push_back({request.client, request.sequence, request.kind, ticket, now});
}

void Gateway::settle_levels(Instant now) {
    for (auto level = levels_.begin(); level != levels_.end();) {
        const bool taken = machine_.taken(level->ticket);
        if (!taken && now - level->since <= answer_patience) {
            ++level;
            continue;
        }
        if (const auto client = clients_.find(level->client); client != clients_.end()) {
            CommandReply reply{
                level->client, client->second.source, level->sequence, level->kind, Answer::accepted, axes::ErrorId::none, {}};
            if (!taken) {
                reply.answer = Answer::not_possible_now;
                reply.error = {"command.no_answer", "", machine_.stuck().value_or("the cycle has not taken it yet"),
                               "It stands and acts in the next cycle, if one comes. Use the emergency stop."};
            }
            replies_.push_back(std::move(reply));
        }
        level = levels_.erase(level);
    }
}

// A refusal ends what it is of, and no other key that the same client holds on one of these axes: who lets go of that is heard. A value that is none
// (bad_value) changes nothing in the cycle.
void Gateway::keep_jog_session(const Entry& entry, Answer answer) {
    const auto& request = entry.request;
    if (!is_held(request.kind)) return;
    for (const auto axis : axes_of(request)) {
        const auto found = jogs_.find(axis);
        if (found == jogs_.end() || found->second.client != request.client) continue;
        auto& jog = found->second;
        if (answer == Answer::accepted) jog = {request.client, std::max(jog.renewed, entry.submitted), true, request.kind, request.target};
        else if (!jog.live || (jog.is_of(request) && answer != Answer::bad_value)) jogs_.erase(found);
    }
}

void Gateway::step(Instant now) {
    now_ = now;
    send_endings();
    settle_levels(now);
    while (const auto answer = machine_.next_answer()) {
        const auto client = clients_.find(answer->client);
        if (client == clients_.end()) continue;
        auto* entry = client->second.find(answer->sequence);
        if (!entry || entry->state != Entry::State::waiting) continue;
        keep_jog_session(*entry, answer->answer);
        if (answer->answer == Answer::accepted) {
            note(answer->client, client->second, entry->request, now);
            const auto axis = find_target(machine_.layout(), TargetKind::axis, entry->request.target);
            std::string remark;
            if (answer->waits_for_program) remark = waits_for_program_note;
            if (answer->limited_to > 0 && axis && *axis < machine_.layout().axes.size())
                remark = limit_note(*answer, machine_.layout().axes[*axis].unit);
            settle(client->second, *entry, Answer::accepted, axes::ErrorId::none, {}, std::move(remark));
            continue;
        }
        const auto* word = find_command(entry->request.kind);
        const auto kind = target_kind(*word, entry->request);
        const auto target = find_target(machine_.layout(), kind, entry->request.target);
        const auto index = target ? *target : all_axes;
        settle(client->second, *entry, answer->answer, answer->error,
               explain(*answer, entry->request.kind, subject_of(machine_.layout(), kind, index, index),
                       machine_.layout().block_at(answer->holder), met_by(*answer, machine_.layout(), index)));
    }
    for (auto& [id, client] : clients_)
        for (auto& entry : client.entries)
            if (entry.state == Entry::State::waiting && now - entry.submitted > answer_patience)
                settle(client, entry, Answer::not_possible_now, axes::ErrorId::none,
                       {"command.no_answer", "",
                        fmt::format("the cycle gave no answer within {:g} ms; the command may still have been carried out",
                                    milliseconds(answer_patience)),
                        "Look at the machine's state before giving it again."});
}

std::optional<CommandReply> Gateway::next_reply() {
    if (replies_.empty()) return std::nullopt;
    auto reply = std::move(replies_.front());
    replies_.pop_front();
    return reply;
}

}  // namespace taktwerk::hmi

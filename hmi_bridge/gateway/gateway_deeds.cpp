// What the gateway tells the log of its clients, whose hand is on which axis, and what ends with a client.

#include <fmt/format.h>

#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/words/answer_text.hpp"
#include "hmi_bridge/words/target_names.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {

using runtime::OperatorAction;
using runtime::OperatorCommand;

namespace {

/// The axis that a command means; nothing: none, or all of them.
std::optional<std::uint16_t> one_axis(const runtime::MachineLayout& layout, const CommandWord& word, const std::string& name) {
    if (word.target != TargetKind::axis && word.target != TargetKind::axis_or_all) return std::nullopt;
    const auto found = find_target(layout, word.target, name);
    if (!found || *found >= layout.axes.size()) return std::nullopt;
    return *found;
}

}  // namespace

/// "move axis x to 20 mm at 10 mm/s"
std::string Gateway::deed(const CommandRequest& request) const {
    const auto* word = find_command(request.kind);
    if (word == nullptr) return "something unknown";
    const auto& layout = machine_.layout();
    const auto kind = target_kind(*word, request);
    const auto target = find_target(layout, kind, request.target.empty() ? "all" : std::string_view(request.target));
    const auto place = target ? *target : all_axes;
    const auto subject = subject_of(layout, kind, place, place);
    std::string text = fmt::format("{}{}{}", word->word, subject.empty() ? "" : " ", subject);
    const auto axis = one_axis(layout, *word, request.target);
    if (request.kind == CommandKind::jog && axis)
        text += request.value == 0 ? ": let go" : fmt::format(" at {:g} {}/s", request.value, layout.axes[*axis].unit);
    if (request.kind == CommandKind::move && axis)
        text += fmt::format(" to {:g} {} at {:g} {}/s", request.value, layout.axes[*axis].unit, request.value2, layout.axes[*axis].unit);
    if (request.kind == CommandKind::group_jog) {
        const auto& jog = request.group_jog;
        text += request.value == 0 ? ": let go" : fmt::format(" {} in {} at {:g} %", jog.direction, jog.frame, 100 * request.value);
        if (request.value != 0 && jog.distance > 0) text += fmt::format(", by {:g}", jog.distance);
    }
    if (request.kind == CommandKind::measure) text += fmt::format(": {}", name(request.measure.kind));
    if (request.kind == CommandKind::mode) text += fmt::format(" {}", hmi::word(request.mode));
    if (request.kind == CommandKind::override_velocity || request.kind == CommandKind::group_override)
        text += fmt::format(" {:g} %", 100 * request.value);
    if (request.kind == CommandKind::set_parameter || request.kind == CommandKind::set_output || request.kind == CommandKind::force ||
        request.kind == CommandKind::set_value)
        text += fmt::format(" = {:g}", request.value);
    if (request.kind == CommandKind::set_value && place < layout.variables.size() && !layout.variables[place].unit.empty())
        text += " " + layout.variables[place].unit;
    if (request.kind == CommandKind::set_parameter && place < layout.parameters.size()) text += " " + layout.parameters[place].unit;
    return request.commissioning ? text + ", as commissioning" : text;
}

/// A command that the machine has accepted.
void Gateway::note(ClientId id, const Client& client, const CommandRequest& request, Instant now) {
    const auto* word = find_command(request.kind);
    if (word == nullptr) return;
    const auto& layout = machine_.layout();
    const auto axis = one_axis(layout, *word, request.target);
    for (std::uint16_t i = 0; i < static_cast<std::uint16_t>(layout.axes.size()); ++i) {
        if (axis ? *axis != i : word->target != TargetKind::axis_or_all) continue;
        switch (request.kind) {
            case CommandKind::take_control:
            case CommandKind::enable:
            case CommandKind::home:
            case CommandKind::jog:
            case CommandKind::measure:
            case CommandKind::move: hands_.lay(i, id, client.name); break;
            case CommandKind::disable:
            case CommandKind::release_control: hands_.lift(i, id); break;
            default: break;
        }
    }
    if (request.value != 0 && !request.press && is_button(request)) return;  // a renewal
    if (request.kind == CommandKind::jog && axis) {                          // begin and end, not what keeps it alive
        if (request.value == 0 && told_jogs_.erase(*axis) == 0) return;
        if (request.value != 0 && !request.press) return;
        if (request.value != 0) told_jogs_[*axis] = id;
    }
    if (request.kind == CommandKind::group_jog) {
        const auto group = find_target(layout, TargetKind::group, request.target);
        if (group && request.value == 0 && told_group_jogs_.erase(*group) == 0) return;
        if (request.value != 0 && !request.press) return;
        if (group && request.value != 0) {
            told_group_jogs_[*group] = id;
            for (const auto member : layout.groups[*group].members) hands_.lay(member, id, client.name);
        }
    }
    if (request.kind == CommandKind::measure && !request.press) return;
    deeds_.say(client.name, deed(request), now);
}

/// The client goes: what it has asked for last, and what ends with it.
void Gateway::note_end(ClientId id, const Client& client) {
    for (const auto& entry : client.entries)
        if (entry.state == Entry::State::waiting && entry.request.kind != CommandKind::jog &&
            entry.request.kind != CommandKind::group_jog && entry.request.kind != CommandKind::measure)
            deeds_.say(client.name, deed(entry.request) + "; it was gone before the answer", now_);
    for (auto jog = told_jogs_.begin(); jog != told_jogs_.end();) {
        if (jog->second != id) {
            ++jog;
            continue;
        }
        deeds_.say(client.name, fmt::format("is gone while it jogs axis {}: the axis stops", machine_.layout().axes[jog->first].name),
                   now_);
        jog = told_jogs_.erase(jog);
    }
    for (auto jog = told_group_jogs_.begin(); jog != told_group_jogs_.end();) {
        if (jog->second != id) {
            ++jog;
            continue;
        }
        deeds_.say(client.name, fmt::format("is gone while it jogs group {}: it stops", machine_.layout().groups[jog->first].name), now_);
        jog = told_group_jogs_.erase(jog);
    }
    const auto end = [&](OperatorAction what) {
        OperatorCommand command;
        command.action = what;
        command.client = id;
        command.flag = true;
        endings_.push_back(command);
    };
    if (client.wrote_values) end(OperatorAction::release_values);
    if (client.set_outputs) {
        deeds_.say(client.name, "is gone: outputs that it was the last to set go to their safe values", now_);
        end(OperatorAction::release_outputs);
    }
    if (client.forces) {
        deeds_.say(client.name, "is gone: points that it was the last to force are their own again", now_);
        end(OperatorAction::release_forces);
    }
    send_endings();
}

void Gateway::send_endings() {
    while (!endings_.empty() && machine_.submit(endings_.front())) endings_.pop_front();  // a full inbox: again in the next step
}

}  // namespace taktwerk::hmi

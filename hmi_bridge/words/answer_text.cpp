#include "hmi_bridge/words/answer_text.hpp"

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "hmi_bridge/words/place_text.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {

using runtime::Answer;

namespace {

std::string_view spoken(axes::Owner owner) {
    switch (owner) {
        case axes::Owner::none: return "nobody";
        case axes::Owner::program: return "a program";
        case axes::Owner::operator_panel: return "the operator panel";
        case axes::Owner::commissioning: return "commissioning";
    }
    return "another party";
}

/// The same refusals in the words of a person at the machine, who has no blocks: cause and remedy. The rest keeps the words of
/// error_texts.hpp.
struct OperatorWords {
    axes::ErrorId error;
    std::string_view cause, remedy;  ///< {} stands for the axis
};
constexpr OperatorWords operator_words[] = {
    {axes::ErrorId::not_powered, "its drive's power stage is off", "Enable it: `taktwerk enable {}`."},
    {axes::ErrorId::in_error_stop, "an error of the axis or its drive stopped it",
     "See its alarm (`taktwerk monitor`), remove the cause, then `taktwerk reset {}`."},
    {axes::ErrorId::not_homed, "it has not found its zero since it was switched on", "Home it first: `taktwerk home {}`."},
    {axes::ErrorId::interlocked,
     "an emergency stop holds, the axis stands on the limit switch of this direction, or a program forbids this direction; with both limit "
     "switches on their wiring or polarity is wrong",
     "Release the emergency stop, or move the other way: `taktwerk monitor` shows limit- and limit+ of {}."},
    {axes::ErrorId::drive_not_ready,
     "its drive is offline: the bus or the serial line does not reach it, it has no supply, or the file leaves it out (`disabled: true`)",
     "Check cable and supply, on a serial line also station, baud and format; `taktwerk monitor` shows whether {} is offline, and an alarm "
     "why."},
    {axes::ErrorId::state_forbids, "it is stopping or homing, or something holds it",
     "Wait until it stands; `taktwerk monitor` shows what {} does."},
    {axes::ErrorId::not_connected, "the group that its drive is in (`hot_connect`) is away, or still coming up",
     "Connect it: `taktwerk monitor` shows with {} which group, and its input GROUP.present."},
    {axes::ErrorId::queue_full, "too many commands wait for it", "Wait until {} stands, then give it again."},
};

/// The same of a group of axes, with a text of its own where the table speaks of one axis.
struct GroupWords {
    axes::ErrorId error;
    std::string_view text, cause, remedy;  ///< {} stands for the group
};
constexpr GroupWords group_words[] = {
    {axes::ErrorId::group_disabled, "", "it takes no commands before it is enabled", "Enable it: `taktwerk group enable {}`."},
    {axes::ErrorId::in_error_stop, "The group is in GroupErrorStop, or an axis of it in ErrorStop",
     "an error of an axis or of the path stopped it", "See why (`taktwerk monitor`), remove the cause, then `taktwerk group reset {}`."},
    {axes::ErrorId::nothing_interrupted, "",
     "nobody has interrupted it from a panel; what a program has interrupted, it goes on with by itself",
     "Look with `taktwerk monitor` what {} does."},
    {axes::ErrorId::not_at_interruption, "", "its axes were moved since",
     "Move the axes of {} back to where it stood, or stop its program."},
    {axes::ErrorId::not_powered, "An axis of the group is disabled", "an axis of it has no power",
     "Enable its axes; `taktwerk monitor` shows with {} which they are."},
    {axes::ErrorId::no_members, "", "it has no axes", "Its program, or `members` of {} in the file, gives it some."},
    {axes::ErrorId::state_forbids, "The command is not allowed in the present state of the group", "it is stopping, or interrupted already",
     "Wait until it stands; `taktwerk monitor` shows what {} does."},
    {axes::ErrorId::invalid_position, "The distance cannot be used",
     "it is less than any way from where the group stands: nothing would move", "Give {} a longer one."},
    {axes::ErrorId::beyond_software_limit, "", "it went as far as its axes may, or an axis of it stands outside its software limits",
     "Jog {} the other way; an axis outside its limits alone: `taktwerk jog AXIS`."},
    {axes::ErrorId::out_of_reach, "", "it went as far as its arm reaches in this direction",
     "Jog {} another way, or its axes (`--frame acs`)."},
    {axes::ErrorId::outside_workspace, "The tool came to a wall of its workspace",
     "it went as far as its `workspace` allows in this direction",
     "Jog {} another way; out of a room that it may not be in it is let at any time."},
    {axes::ErrorId::singular_path, "",
     "its arm comes too near to a singularity in this direction: its axes would have to turn much faster than its tool moves",
     "Jog the axes of {} (`--frame acs`), which always leads out."},
    {axes::ErrorId::no_kinematics, "", "it has no arm whose tool could be moved", "Jog the axes of {}: `--frame acs`."},
    {axes::ErrorId::interlocked, "", "an emergency stop holds, or an axis of it may not move in this direction",
     "Release the emergency stop, reset {}; `taktwerk monitor` shows the limit switches of its axes."},
    {axes::ErrorId::drive_not_ready, "A drive of the group is not reachable or not ready", "the drive of an axis of it is offline",
     "Check cable and supply; `taktwerk monitor` shows which axis of {} is offline, and an alarm why."},
    {axes::ErrorId::not_connected, "The drive of an axis of the group is not connected",
     "the group that its drive is in (`hot_connect`) is away, or still coming up",
     "Connect it: `taktwerk monitor` shows which axis of {} it is, and its input GROUP.present."},
    {axes::ErrorId::not_at_standstill, "", "an axis of it moves by itself", "Stop it first: `taktwerk group halt {}`."},
    {axes::ErrorId::aborted_by_command, "", "somebody or something else has stopped it", "Let go and press again."},
};

bool is_of_a_group(CommandKind kind) noexcept {
    const auto* word = find_command(kind);
    return word != nullptr && word->target == TargetKind::group;
}

const OperatorWords* words_for_operator(axes::ErrorId error) {
    for (const auto& words : operator_words)
        if (words.error == error) return &words;
    return nullptr;
}

const GroupWords* words_of_group(axes::ErrorId error) {
    for (const auto& words : group_words)
        if (words.error == error) return &words;
    return nullptr;
}

/// What a jog met, where it has a name.
std::string met_cause(const runtime::CommandAnswer& answer, std::string_view met) {
    if (answer.jog_end == axes::JogEnd::orientation)
        return "its arm cannot turn its tool about this direction: a SCARA, a palletizer or a delta turns it about one axis alone";
    if (met.empty()) return {};
    if (answer.jog_end == axes::JogEnd::workspace) return fmt::format("the room '{}' ends there, or is kept free", met);
    return answer.jog_end == axes::JogEnd::member_limit ? fmt::format("axis {} is at its limit in this direction", met)
                                                        : fmt::format("axis {} stands outside its limits", met);
}

void explain_of_group(Error& error, const runtime::CommandAnswer& answer, const GroupWords& words, std::string_view group,
                      std::string_view met) {
    const auto* text = axes::find_error(answer.error);
    const auto named = met_cause(answer, met);
    error.what = fmt::format("{} ({}): {}", words.text.empty() ? text->english.text : words.text, text->name,
                             named.empty() ? words.cause : std::string_view(named));
    error.remedy = fmt::format(fmt::runtime(words.remedy), group);
    if (answer.jog_end == axes::JogEnd::orientation)
        error.remedy = fmt::format("Jog {} about another direction, or its axes (`--frame acs`).", group);
    else if (answer.error == axes::ErrorId::beyond_software_limit && answer.jog_end == axes::JogEnd::none && !met.empty())
        error.remedy = fmt::format("Bring it back alone: `taktwerk jog {}`.", met);
}

}  // namespace

std::string_view code(Answer answer) noexcept {
    switch (answer) {
        case Answer::accepted: return "";
        case Answer::unknown_name: return "command.unknown_name";
        case Answer::bad_value: return "command.bad_value";
        case Answer::stale: return "command.stale";
        case Answer::no_control: return "command.no_control";
        case Answer::wrong_mode: return "command.wrong_mode";
        case Answer::refused_by_axis: return "command.refused_by_axis";
        case Answer::not_possible_now: return "command.not_possible_now";
        case Answer::queue_full: return "command.queue_full";
        case Answer::duplicate: return "command.duplicate";
    }
    return "command.refused";
}

std::string subject_of(const runtime::MachineLayout& layout, TargetKind target, std::uint16_t axis, std::uint16_t index) {
    switch (target) {
        case TargetKind::none: return "";
        case TargetKind::axis:
        case TargetKind::axis_or_all: return axis < layout.axes.size() ? "axis " + layout.axes[axis].name : "all axes";
        case TargetKind::program: return index < layout.programs.size() ? "program " + layout.programs[index] : "";
        case TargetKind::parameter:
            return index < layout.parameters.size() ? "parameter " + layout.parameters[index].program + "." + layout.parameters[index].name
                                                    : "";
        case TargetKind::output: return index < layout.outputs.size() ? "output " + layout.outputs[index] : "";
        case TargetKind::input: return index < layout.inputs.size() ? "input " + layout.inputs[index] : "";
        case TargetKind::point: break;
        case TargetKind::variable:
            return index < layout.variables.size() ? "variable " + layout.variables[index].program + "." + layout.variables[index].name
                                                   : "";
        case TargetKind::group: return index < layout.groups.size() ? "group " + layout.groups[index].name : "";
    }
    return "";
}

std::string limit_note(const runtime::CommandAnswer& answer, std::string_view unit) {
    const auto by = answer.limited_in == runtime::Mode::automatic ? std::string("the limit of the axis")
                                                                  : fmt::format("{} mode", word(answer.limited_in));
    return fmt::format("limited to {:g} {}/s by {}", answer.limited_to, unit, by);
}

std::string_view met_by(const runtime::CommandAnswer& answer, const runtime::MachineLayout& layout, std::uint16_t index) {
    if (answer.limiting.valid() && answer.limiting.index < layout.axes.size()) return layout.axes[answer.limiting.index].name;
    return room_name(answer.room, layout, index);
}

Error explain(const runtime::CommandAnswer& answer, CommandKind kind, std::string subject, std::string_view holder, std::string_view met) {
    Error error{std::string(code(answer.answer)), std::move(subject), "", ""};
    const bool of_a_point = kind == CommandKind::set_output || kind == CommandKind::force;
    switch (answer.answer) {
        case Answer::accepted: break;
        case Answer::unknown_name:
            error.what = "the machine does not know the target, or it is disabled by the configuration";
            error.remedy = "Look at the names the machine has (taktwerk monitor), and at `disabled:` in the configuration.";
            break;
        case Answer::bad_value:
            if (kind == CommandKind::group_jog) {  // of numbers that are none the gateway has told already
                error.what = "a renewal says another frame or distance than its press";
                error.remedy = "Let go, and press again with the other one.";
                break;
            }
            error.what = !of_a_point                  ? "the value is outside its range"
                         : kind == CommandKind::force ? "the value is beyond what its channel has"
                                                      : "the value is beyond what its channel gives";
            error.remedy = of_a_point ? "Give a value that its terminal has (docs/reference/devices.md), through its `scale`."
                                      : "Give a value inside the range.";
            break;
        case Answer::stale:
            if (kind == CommandKind::measure) {
                error.what = "the measurement is over: it was let go or stopped, or its lease ran out before the renewal came";
                error.remedy = "Ask for its result (measure_result), which says how it ended; press again to begin anew.";
            } else if (kind == CommandKind::jog || kind == CommandKind::group_jog) {
                error.what = "the jog is over: it was let go, or its lease ran out before the renewal came (then there is an alarm)";
                error.remedy = "Let go and press again; if its lease runs out again, the connection or this computer is too slow.";
            } else if (kind == CommandKind::set_value) {
                error.what =
                    "it came too late, or the button is not held any more: it was let go, its renewal stayed out, or an axis of its "
                    "program "
                    "was stopped";
                error.remedy = "Press again.";
            } else {
                error.what = "the command came too late and was not carried out";
                error.remedy = "Give it again.";
            }
            break;
        case Answer::no_control:
            if (kind == CommandKind::set_value) {
                error.what = "somebody else holds this button";
                error.remedy = "Wait until it is let go.";
                break;
            }
            error.what = fmt::format("{} has control", spoken(answer.owner));
            if (!holder.empty()) error.what += fmt::format("; its block '{}' moves or holds the axis", holder);
            error.remedy = is_of_a_group(kind) && answer.owner == axes::Owner::program
                               ? "Stop the program or change to manual mode; or take control of its axes (they stop first)."
                           : answer.owner == axes::Owner::program
                               ? "Stop the program or change to manual mode; or take control (the axis stops first)."
                               : "Wait until it is released, or take control (the axis stops first).";
            break;
        case Answer::wrong_mode:
            error.what = "the mode of the machine does not allow it";
            error.remedy = kind == CommandKind::program_start ? "Change to automatic mode first." : "Change to manual or setup mode first.";
            break;
        case Answer::refused_by_axis:
            // Neither has a direction: nothing else interlocks them.
            if (answer.error == axes::ErrorId::interlocked && (kind == CommandKind::enable || kind == CommandKind::reset)) {
                error.what = "the emergency stop is pressed, or its circuit is open";
                error.remedy = kind == CommandKind::reset ? "Release it when nobody is in danger, then reset."
                                                          : "Release it when nobody is in danger, reset, then give the command again.";
            } else if (const auto* of_group = is_of_a_group(kind) ? words_of_group(answer.error) : nullptr) {
                const auto blank = error.subject.find(' ');
                explain_of_group(error, answer, *of_group, blank == std::string::npos ? "the group" : error.subject.substr(blank + 1), met);
            } else if (const auto* words = is_of_a_group(kind) ? nullptr : words_for_operator(answer.error)) {
                const auto blank = error.subject.find(' ');
                const auto axis = blank == std::string::npos ? std::string("the axis") : error.subject.substr(blank + 1);
                const auto* text = axes::find_error(answer.error);
                error.what = fmt::format("{} ({}): {}", text->english.text, text->name, words->cause);
                error.remedy = fmt::format(fmt::runtime(words->remedy), axis);
            } else if (const auto* text = axes::find_error(answer.error); text && answer.error != axes::ErrorId::none) {
                error.what = fmt::format("{} ({}): {}", text->english.text, text->name, text->english.cause);
                error.remedy = fmt::format("{}.", text->english.remedy);
            } else if (const auto* alarm = find_alarm(axes::axis_alarms, static_cast<AlarmId>(answer.error))) {
                error.what = is_of_a_group(kind)
                                 ? fmt::format("one of its axes stopped, and its alarm '{}' has ended it: {}", alarm->name, alarm->cause)
                                 : fmt::format("its alarm '{}' has ended it: {}", alarm->name, alarm->cause);
                error.remedy = fmt::format("{}. `taktwerk monitor` shows the alarm.", alarm->remedy);
            } else {
                error.what = fmt::format("the axis refused it with error {}", static_cast<unsigned>(answer.error));
                error.remedy = "See the alarms of the axis.";
            }
            if (!holder.empty()) error.what += fmt::format("; the block '{}' moves or holds the axis", holder);
            break;
        case Answer::not_possible_now:
            if (answer.error == axes::ErrorId::interlocked) {
                error.what = "the emergency stop is pressed, or its circuit is open";
                error.remedy = "Release it when nobody is in danger, reset, then give the command again.";
            } else if (kind == CommandKind::program_start && answer.error == axes::ErrorId::in_error_stop) {
                error.what =
                    "an emergency stop is not reset yet: its alarm waits, or an axis is still in ErrorStop by it, and a start given "
                    "now would leave the motion to whoever resets later";
                error.remedy = "When nobody is in danger: `taktwerk reset --wait`, then start again.";
            } else if (kind == CommandKind::force && answer.error == axes::ErrorId::queue_full) {
                error.what = fmt::format("{} points are forced already", runtime::max_forces);
                error.remedy = "Release those that are not needed any more.";
            } else if (kind == CommandKind::force && answer.error == axes::ErrorId::not_supported) {
                error.what = "nobody may force this point";
                error.remedy = "Look for it in `layout`, which says why.";
            } else if (kind == CommandKind::measure) {
                error.what = "another axis or another client is being measured: one at a time";
                error.remedy = "Wait until it is over.";
            } else if (kind == CommandKind::set_output) {
                error.what = "a program is running, and it drives the outputs";
                error.remedy = "Stop the programs first.";
            } else if (kind == CommandKind::set_value) {
                error.what = "its program does not run, or the machine is shutting down: nobody would see the press";
                error.remedy = "Start the program, then press again.";
            } else if (kind == CommandKind::program_start && answer.error == axes::ErrorId::state_forbids) {
                error.what =
                    "the program has not ended yet: its stop() is still to come, or a task of it has not come back (its alarm names it)";
                error.remedy = "Wait for it; where it never comes back, end the run, mend the program and start it again.";
            } else if (kind == CommandKind::program_start) {
                error.what = "the program is in fault, or the machine is shutting down";
                error.remedy = "Reset the program, then start it.";
            } else {
                error.what = "the machine is shutting down";
                error.remedy = "Start it again for further commands.";
            }
            break;
        case Answer::queue_full:
            error.what = "too many commands at once; this one was not taken";
            error.remedy = "Give it again.";
            break;
        case Answer::duplicate:
            error.what = "the sequence number was used before";
            error.remedy = "Use a new one for each command.";
            break;
    }
    return error;
}

}  // namespace taktwerk::hmi

#include "hmi_bridge/words/event_text.hpp"

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "axes/group/group_words.hpp"
#include "hmi_bridge/words/place_text.hpp"
#include "hmi_bridge/words/words.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::hmi {

using runtime::CommandEvent;
using runtime::CommandGiver;
using What = CommandEvent::What;

namespace {

bool nobody(const CommandGiver& giver) {
    return giver.kind == axes::CommandKind::none && giver.group_kind == axes::GroupCommandKind::none && giver.owner == axes::Owner::none &&
           giver.program == runtime::no_program;
}

std::string_view block_type(const CommandGiver& giver) {
    if (giver.group_kind != axes::GroupCommandKind::none) return name(giver.group_kind);
    const auto name = word(giver.kind);
    return name.empty() ? std::string_view{"MC_Power"} : name;
}

/// By the instance's name where its program gave it one; by program and block type where not.
std::string named(const CommandGiver& giver, const runtime::MachineLayout& layout) {
    if (nobody(giver)) return {};
    const auto type = block_type(giver);
    const auto block = giver.block ? layout.block_at(giver.block) : std::string_view{};
    const auto program = giver.program < layout.programs.size() ? layout.programs[giver.program] : std::string{};
    if (!block.empty()) return fmt::format("'{}' ({})", block, type);
    if (!program.empty()) return fmt::format("{} of program {}", type, program);
    if (giver.owner == axes::Owner::operator_panel) return fmt::format("{} of the operator", type);
    if (giver.owner == axes::Owner::commissioning) return fmt::format("{} of commissioning", type);
    return fmt::format("{} of a program", type);
}

std::string sentence(std::string_view text) { return text.empty() || text.back() == '.' ? std::string(text) : fmt::format("{}.", text); }

const AlarmInfo* alarm_of(std::uint16_t id) {
    if (const auto* info = find_alarm(axes::axis_alarms, id)) return info;
    return find_alarm(runtime::machine_alarms, id);
}

}  // namespace

std::string_view word(What what) noexcept { return what == What::refused ? "refused" : "aborted"; }

namespace {

/// What led the group to GroupErrorStop, and whose that is.
std::string reason_of(const CommandEvent& event, const runtime::MachineLayout& layout) {
    const auto* alarm = alarm_of(event.axis_error);
    const auto* error = axes::find_error(static_cast<axes::ErrorId>(event.axis_error));
    const auto reason = alarm ? alarm->name : error ? error->name : std::string_view{"?"};
    return event.error_axis < layout.axes.size() ? of_axis(reason, layout.axes[event.error_axis].name) : std::string(reason);
}

EventText aborted_of_group(const CommandEvent& event, const runtime::MachineLayout& layout, EventText out) {
    const auto* text = axes::find_error(event.error);
    const auto* alarm = event.axis_error != 0 ? alarm_of(event.axis_error) : nullptr;
    if (event.axis_error != 0) {
        out.what = fmt::format("{} was ended: the group went into GroupErrorStop ({})", out.who, reason_of(event, layout));
        out.remedy = alarm ? sentence(alarm->remedy) : text ? sentence(text->english.remedy) : std::string{};
    } else if (!out.by.empty()) {
        const bool by_person = event.by.program == runtime::no_program && event.by.owner != axes::Owner::program;
        out.what = fmt::format("{} was aborted by {}", out.who, out.by);
        const bool of_person =
            event.given.owner == axes::Owner::operator_panel && event.given.group_kind == axes::GroupCommandKind::interrupt && !by_person;
        out.remedy = of_person   ? "Who disables a group ends what a person has interrupted: an override of 0 holds it, too."
                     : by_person ? "A person has stopped the group: give the command again when it may go on."
                     : event.by.program != event.given.program ? "Two programs command this group: let one of them do it."
                                                               : "If that is not meant: wait for Done of the first, or give the second "
                                                                 "BufferMode mcBuffered.";
    } else {
        out.what = fmt::format("{} was ended by the group itself", out.who);
        out.remedy = "A person has stopped it, or the mode or the owner of its axes has changed: see what stands beside this in the log.";
    }
    return out;
}

EventText describe_of_group(const CommandEvent& event, const runtime::MachineLayout& layout) {
    EventText out;
    out.who = named(event.given, layout);
    if (out.who.empty()) out.who = "A command";
    out.by = named(event.by, layout);
    if (event.what == What::aborted) return aborted_of_group(event, layout, out);
    const auto* text = axes::find_error(event.error);
    out.what = text ? fmt::format("{} was refused: {} ({})", out.who, text->english.text, text->name)
                    : fmt::format("{} was refused with error {:04X}h", out.who, static_cast<unsigned>(event.error));
    if (const auto where = place_text(event.place, layout, event.group, members_of(layout, event.group)); !where.empty())
        out.what += fmt::format(". Where: {}", where);
    out.remedy = text ? sentence(text->english.remedy) : std::string{};
    if (event.error == axes::ErrorId::in_error_stop && event.axis_error != 0) out.what += fmt::format(", by {}", reason_of(event, layout));
    return out;
}

}  // namespace

std::string of_axis(std::string_view error, std::string_view axis) { return fmt::format("{} of axis {}", error, axis); }

std::string event_subject(const CommandEvent& event, const runtime::MachineLayout& layout) {
    if (event.group < layout.groups.size()) return fmt::format("group {}", layout.groups[event.group].name);
    return event.axis < layout.axes.size() ? fmt::format("axis {}", layout.axes[event.axis].name) : std::string{};
}

EventText describe(const CommandEvent& event, const runtime::MachineLayout& layout) {
    if (event.group != runtime::no_group) return describe_of_group(event, layout);
    EventText out;
    out.who = named(event.given, layout);
    if (out.who.empty()) out.who = "A command";
    out.by = named(event.by, layout);
    const bool two_programs =
        event.by.program != runtime::no_program && event.given.program != runtime::no_program && event.by.program != event.given.program;
    const auto* alarm = event.axis_error != 0 ? alarm_of(event.axis_error) : nullptr;
    const auto* error = axes::find_error(event.error);
    if (event.what == What::aborted) {
        if (!out.by.empty()) {
            const bool person_stopped = event.by.program == runtime::no_program && event.by.owner != axes::Owner::program &&
                                        (event.by.kind == axes::CommandKind::halt || event.by.kind == axes::CommandKind::stop);
            out.what = fmt::format("{} was aborted by {}", out.who, out.by);
            out.remedy = person_stopped ? "A person has stopped the axis: give the command again when it may go on."
                         : two_programs ? "Two programs command this axis: let one of them do it."
                                        : "If that is not meant: wait for Done of the first, or give the second BufferMode mcBuffered.";
        } else if (alarm) {
            out.what = fmt::format("{} was ended: the axis went into ErrorStop ({})", out.who, alarm->name);
            out.remedy = sentence(alarm->remedy);
        } else if (error && event.error != axes::ErrorId::none) {
            out.what = fmt::format("{} was ended: {} ({})", out.who, error->english.text, error->name);
            out.remedy = sentence(error->english.remedy);
        } else {
            out.what = fmt::format("{} was ended by the axis itself, which is {} now", out.who, axes::name(event.state));
            out.remedy = "Its power was taken away, its mode or its owner changed: see what stands beside this in the log.";
        }
        return out;
    }
    out.what = error ? fmt::format("{} was refused: {} ({})", out.who, error->english.text, error->name)
                     : fmt::format("{} was refused with error {:04X}h", out.who, static_cast<unsigned>(event.error));
    out.remedy = error ? sentence(error->english.remedy) : std::string{};
    if (event.held) {
        out.what += fmt::format("; {} holds the axis", out.by.empty() ? std::string("an MC_Stop") : out.by);
        out.remedy =
            fmt::format("Let Execute of {} fall, then give the command again.", out.by.empty() ? std::string("that MC_Stop") : out.by);
    } else if (event.error == axes::ErrorId::in_error_stop && alarm) {
        out.what += fmt::format(", by {}", alarm->name);
        out.remedy = fmt::format("{} Then MC_Reset, or `taktwerk reset`.", sentence(alarm->remedy));
    } else if (!out.by.empty() && (event.error == axes::ErrorId::owned_by_other || event.error == axes::ErrorId::state_forbids ||
                                   event.error == axes::ErrorId::queue_full || event.error == axes::ErrorId::power_conflict)) {
        out.what += fmt::format("; {} has the axis", out.by);
    }
    if (two_programs) out.remedy += " Two programs command this axis: let one of them do it.";
    return out;
}

}  // namespace taktwerk::hmi

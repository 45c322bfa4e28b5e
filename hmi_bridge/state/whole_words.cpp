// Alarms and events: what a snapshot has as facts, in words.
#include "axes/axis/error_table.hpp"
#include "axes/group/group_words.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/state/lcm_text.hpp"
#include "hmi_bridge/state/whole_state.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

void fill(taktwerk_lcm::whole_giver_v1_t& out, const runtime::CommandGiver& giver, const runtime::MachineLayout& layout) {
    put_text(out.command, giver.group_kind != axes::GroupCommandKind::none ? name(giver.group_kind) : word(giver.kind));
    put_text(out.owner, name(giver.owner));
    put_text(out.program, giver.program < layout.programs.size() ? std::string_view(layout.programs[giver.program]) : std::string_view{});
    put_text(out.block, giver.block ? layout.block_at(giver.block) : std::string_view{});
}

}  // namespace

void fill(whole_alarm_v1_t& out, const runtime::ActiveAlarm& alarm, const MachineLink& machine) {
    const auto words = machine.describe(alarm.fact);
    out.id = alarm.fact.id;
    put_text(out.name, words.name);
    put_text(out.source, words.source);
    out.since_ns = count(alarm.since);
    out.count = alarm.count;
    out.standing = alarm.standing;
    out.acknowledged = alarm.acknowledged;
    put_text(out.reaction, word(alarm.reaction));
    put_text(out.english, words.english);
    put_text(out.chinese, words.chinese);
    put_text(out.cause, words.cause);
    put_text(out.remedy, words.remedy);
    put_text(out.reset, words.reset);
    put_text(out.manual, words.manual);
    put_text(out.recording, machine.recording_of(alarm.fact, alarm.since));
}

void fill(whole_event_v2_t& out, const runtime::CommandEvent& event, const runtime::MachineLayout& layout) {
    const auto words = describe(event, layout);
    const auto* error = axes::find_error(event.error);
    out.number = count(event.number);
    out.time_ns = count(event.at);
    put_text(out.event, word(event.what));
    put_text(out.axis, event.axis < layout.axes.size() ? std::string_view(layout.axes[event.axis].name) : std::string_view{});
    const bool of_group = event.group != runtime::no_group;
    put_text(out.group,
             of_group && event.group < layout.groups.size() ? std::string_view(layout.groups[event.group].name) : std::string_view{});
    fill(out.given, event.given, layout);
    fill(out.by, event.by, layout);
    out.held_by_stop = event.held;
    put_text(out.axis_state, of_group ? std::string_view{} : name(event.state));
    put_text(out.error, error && event.error != axes::ErrorId::none ? error->name : std::string_view{});
    out.times = event.times;
    put_text(out.english, words.what);
    put_text(out.remedy, words.remedy);
}

}  // namespace taktwerk::hmi

#include "hmi_bridge/socket/json_state.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "axes/axis/error_table.hpp"
#include "ecat/wire/al_status.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/json_number.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

std::string text(Json json) {
    spell_out_numbers(json);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json axis_json(const axes::AxisView& axis, const runtime::MachineLayout& layout, const runtime::MachineLayout::AxisInfo& info) {
    return Json{
        {"name", info.name},
        {"unit", info.unit},
        {"state", name(axis.state)},
        {"owner", name(axis.owner)},
        {"disabled", info.disabled},
        {"simulated", axis.simulated},
        {"online", axis.online},
        {"group", info.group},  // of hot connect; empty: always there
        {"presence", name(axis.presence)},
        {"powered", axis.powered},
        {"homed", axis.homed},
        {"in_position", axis.in_position},
        {"has_job", axis.active != 0},
        {"command", word(axis.active_kind)},      // what moves it ...
        {"block", layout.block_at(axis.holder)},  // ... and whose it is: who blocks, when another is refused
        {"held_by_stop", axis.lock != 0},
        {"queued", axis.queued_count},
        {"resetting", axis.resetting},
        {"warning", axis.warning},
        {"error", axis.error},
        {"drive_error", axis.drive_error},
        {"actual_position", axis.actual_position},
        {"actual_velocity", axis.actual_velocity},
        {"actual_torque", axis.actual_torque},
        {"set_position", axis.set_position},
        {"set_velocity", axis.set_velocity},
        {"set_acceleration", axis.set_acceleration},
        {"set_jerk", axis.set_jerk},
        {"target_position", axis.target_position},
        {"following_error", axis.following_error},
        {"following_window", axis.following_window},
        {"velocity_limiter", word(axis.limiter)},
        {"override", axis.override_factors.velocity},
        {"turns", axis.turns},
        {"drive_state", name(axis.drive_state)},
        {"drive_mode", name(axis.drive_mode)},
        {"status_word", axis.status_word},
        {"negative_limit_switch", axis.negative_limit_switch},
        {"positive_limit_switch", axis.positive_limit_switch},
        {"home_switch", axis.home_switch},
    };
}

Json alarm_array(const runtime::Snapshot& snapshot, const MachineLink& machine) {
    auto out = Json::array();
    for (std::size_t i = 0; i < snapshot.alarm_count && i < snapshot.alarms.size(); ++i) {
        const auto& alarm = snapshot.alarms[i];
        const auto words = machine.describe(alarm.fact);
        out.push_back(Json{
            {"id", alarm.fact.id},
            {"name", words.name},
            {"source", words.source},
            {"since_ns", count(alarm.since)},
            {"count", alarm.count},
            {"standing", alarm.standing},
            {"acknowledged", alarm.acknowledged},
            {"reaction", word(alarm.reaction)},
            {"english", words.english},
            {"chinese", words.chinese},
            {"cause", words.cause},
            {"remedy", words.remedy},
            {"reset", words.reset},
        });
    }
    return out;
}

Json giver_json(const runtime::CommandGiver& giver, const runtime::MachineLayout& layout) {
    return Json{{"command", word(giver.kind)},
                {"owner", name(giver.owner)},
                {"program", giver.program < layout.programs.size() ? layout.programs[giver.program] : std::string{}},
                {"block", giver.block ? layout.block_at(giver.block) : std::string_view{}}};
}

Json event_array(const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    auto out = Json::array();
    for (std::size_t i = 0; i < s.event_count && i < s.events.size(); ++i) {
        const auto& event = s.events[i];
        const auto words = describe(event, layout);
        const auto* error = axes::find_error(event.error);
        out.push_back(Json{
            {"number", event.number},
            {"time_ns", count(event.at)},
            {"event", word(event.what)},
            {"axis", event.axis < layout.axes.size() ? layout.axes[event.axis].name : std::string{}},
            {"given", giver_json(event.given, layout)},
            {"by", giver_json(event.by, layout)},
            {"held_by_stop", event.held},
            {"axis_state", name(event.state)},
            {"error", error && event.error != axes::ErrorId::none ? error->name : std::string_view{}},
            {"times", event.times},
            {"english", words.what},
            {"remedy", words.remedy},
        });
    }
    return out;
}

/// A point with a unit in it, another as the number that the terminal carries.
Json points(const std::vector<std::string>& names, const Json& units, const std::vector<std::int64_t>& words, const auto& value_of) {
    auto out = Json::object();
    for (std::size_t i = 0; i < names.size() && i < words.size(); ++i)
        out[names[i]] = units.contains(names[i]) ? Json(value_of(i)) : Json(words[i]);
    return out;
}

Json units_of(const std::vector<std::string>& names, const std::vector<std::string>& units) {
    auto out = Json::object();
    for (std::size_t i = 0; i < names.size() && i < units.size(); ++i)
        if (!units[i].empty()) out[names[i]] = units[i];
    return out;
}

}  // namespace

std::string state_json(const runtime::Snapshot& s, const MachineLink& machine) {
    const auto& layout = machine.layout();
    Json out{
        {"machine", layout.machine}, {"cycle", s.cycle},     {"time_ns", count(s.at)},
        {"phase", word(s.phase)},    {"mode", word(s.mode)}, {"emergency_stop", s.emergency_stop},
        {"simulated", s.simulated},
    };
    out["statistics"] = Json{
        {"cycles", s.statistics.cycles},
        {"overruns", s.statistics.overruns},
        {"missed_ticks", s.statistics.missed_ticks},
        {"lateness_ns", count(s.statistics.lateness)},
        {"lateness_max_ns", count(s.statistics.lateness_max)},
        {"compute_ns", count(s.statistics.compute)},
        {"compute_max_ns", count(s.statistics.compute_max)},
        {"snapshots_dropped", s.statistics.snapshots_dropped},
        {"commands_refused", s.statistics.commands_refused},
    };
    out["bus"] = Json{
        {"phase", word(s.bus_phase)},
        {"frames_sent", s.bus.frames_sent},
        {"frames_received", s.bus.frames_received},
        {"frames_lost", s.bus.frames_lost},
        {"frames_late", s.bus.frames_late},
        {"frames_rejected", s.bus.frames_rejected},
        {"working_counter_errors", s.bus.working_counter_errors},
        {"send_errors", s.bus.send_errors},
        {"dc_difference_ns", s.bus.dc_difference_ns},
        {"round_trip_ns", count(s.bus.round_trip)},
        {"dc_lock", ecat::name(s.bus.dc_lock)},
        {"dc_phase_error_ns", s.bus.dc_phase_error_ns},
        {"dc_offset_ns", s.bus.dc_offset_ns},
        {"dc_drift_ppb", s.bus.dc_drift_ppb},
        {"dc_rejected", s.bus.dc_rejected},
        {"ring", ecat::name(s.bus.ring.shape)},
        {"ring_before_break", s.bus.ring.before_break},
        {"ring_behind_break", s.bus.ring.behind_break},
        {"ring_opened", s.bus.ring.opened},
        {"sync0_margin_ns", s.bus.sync0_margin_ns},
        {"sync0_margin_least_ns", s.bus.sync0_margin_least_ns},
    };
    auto& slaves = out["slaves"] = Json::array();
    for (std::size_t i = 0; i < s.slaves.size() && i < layout.slaves.size(); ++i)
        slaves.push_back(Json{{"name", layout.slaves[i]},
                              {"state", ecat::name(s.slaves[i].al_state)},
                              {"al_status_code", s.slaves[i].al_status_code},
                              {"fresh", s.slaves[i].fresh},
                              {"age", s.slaves[i].age}});
    auto& axes = out["axes"] = Json::array();
    for (std::size_t i = 0; i < s.axes.size() && i < layout.axes.size(); ++i) axes.push_back(axis_json(s.axes[i], layout, layout.axes[i]));
    auto& programs = out["programs"] = Json::array();
    for (std::size_t i = 0; i < s.programs.size() && i < layout.programs.size(); ++i)
        programs.push_back(Json{{"name", layout.programs[i]}, {"state", word(s.programs[i])}});
    auto& tasks = out["tasks"] = Json::array();
    for (std::size_t i = 0; i < s.tasks.size() && i < layout.tasks.size(); ++i)
        tasks.push_back(Json{{"name", layout.tasks[i]},
                             {"releases", s.tasks[i].releases},
                             {"overruns", s.tasks[i].overruns},
                             {"run_ns", count(s.tasks[i].run)},
                             {"run_max_ns", count(s.tasks[i].run_max)}});
    out["input_units"] = units_of(layout.inputs, layout.input_units);
    out["output_units"] = units_of(layout.outputs, layout.output_units);
    out["inputs"] = points(layout.inputs, out["input_units"], s.inputs, [&](std::size_t i) { return s.input_values[i].value; });
    out["outputs"] = points(layout.outputs, out["output_units"], s.outputs, [&](std::size_t i) { return s.output_values[i]; });
    auto& doubtful = out["doubtful_inputs"] = Json::array();
    for (std::size_t i = 0; i < s.input_values.size() && i < layout.inputs.size(); ++i)
        if (!s.input_values[i].good) doubtful.push_back(layout.inputs[i]);
    auto& variables = out["variables"] = Json::array();
    for (std::size_t i = 0; i < s.variables.size() && i < layout.variables.size(); ++i)
        variables.push_back(Json{{"program", layout.variables[i].program},
                                 {"name", layout.variables[i].name},
                                 {"unit", layout.variables[i].unit},
                                 {"value", s.variables[i]}});
    auto& parameters = out["parameters"] = Json::array();
    for (std::size_t i = 0; i < s.parameters.size() && i < layout.parameters.size(); ++i)
        parameters.push_back(Json{{"program", layout.parameters[i].program},
                                  {"name", layout.parameters[i].name},
                                  {"unit", layout.parameters[i].unit},
                                  {"value", s.parameters[i]}});
    out["alarms"] = alarm_array(s, machine);
    out["events"] = event_array(s, layout);
    out["events_dropped"] = s.events_dropped;
    return text(std::move(out));
}

std::string layout_json(const runtime::MachineLayout& layout) {
    Json out{{"machine", layout.machine}, {"cycle_ns", count(layout.cycle)}};
    auto& axes = out["axes"] = Json::array();
    for (const auto& axis : layout.axes)
        axes.push_back(Json{{"name", axis.name},
                            {"unit", axis.unit},
                            {"disabled", axis.disabled},
                            {"simulated", axis.simulated},
                            {"jog_slow", axis.jog_slow},
                            {"jog_fast", axis.jog_fast},
                            {"drive", axis.drive},
                            {"profile", axis.profile},
                            {"drive_axis", axis.drive_axis + 1}});
    out["slaves"] = layout.slaves;
    out["inputs"] = layout.inputs;
    out["outputs"] = layout.outputs;
    out["input_units"] = units_of(layout.inputs, layout.input_units);
    out["output_units"] = units_of(layout.outputs, layout.output_units);
    out["programs"] = layout.programs;
    out["tasks"] = layout.tasks;
    auto& variables = out["variables"] = Json::array();
    for (const auto& v : layout.variables) {
        Json one{{"program", v.program}, {"name", v.name},       {"unit", v.unit},
                 {"doc", v.doc},         {"type", word(v.type)}, {"writable", v.writable}};
        if (v.writable) one.update(Json{{"minimum", v.minimum}, {"maximum", v.maximum}, {"whole", v.whole()}, {"momentary", v.momentary}});
        variables.push_back(std::move(one));
    }
    auto& parameters = out["parameters"] = Json::array();
    for (const auto& p : layout.parameters)
        parameters.push_back(Json{{"program", p.program},
                                  {"name", p.name},
                                  {"unit", p.unit},
                                  {"doc", p.doc},
                                  {"minimum", p.minimum},
                                  {"maximum", p.maximum},
                                  {"whole", p.whole},
                                  {"value", p.value}});
    return text(std::move(out));
}

std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine) { return text(alarm_array(snapshot, machine)); }

}  // namespace taktwerk::hmi

#include "hmi_bridge/socket/json_state.hpp"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "axes/axis/parameters.hpp"
#include "ecat/wire/al_status.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/json_number.hpp"
#include "hmi_bridge/socket/json_writer.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "hmi_bridge/words/words.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

using Json = nlohmann::ordered_json;

std::string text(Json json) {
    spell_out_numbers(json);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Limits as they hold now (axes/axis/parameters.hpp); null: none.
void put_limit(JsonWriter& json, std::string_view key, const axes::AxisView& axis, axes::Parameter enabled, axes::Parameter limit) {
    json.key(key);
    if (axis.parameters[axes::place_of(enabled)] != 0) json.value(axis.parameters[axes::place_of(limit)]);
    else json.value(std::nullopt);
}

/// What stopped the axis: its alarm may be gone long before somebody resets.
void put_error(JsonWriter& json, AlarmId error) {
    const auto* info = find_alarm(axes::axis_alarms, error);
    if (!info) info = find_alarm(runtime::machine_alarms, error);
    if (!info) return;
    json.field("error_name", info->name);
    json.field("error_cause", info->cause);
    json.field("error_remedy", info->remedy);
}

/// Nobody pressed it: the slave with its input is not exchanged.
bool emergency_stop_is_unread(const runtime::Snapshot& s) {
    for (std::size_t i = 0; i < s.alarm_count && i < s.alarms.size(); ++i) {
        const auto& alarm = s.alarms[i];
        if (alarm.standing && alarm.fact.id == id(runtime::MachineAlarm::emergency_stop))
            return alarm.fact.a == runtime::emergency_stop_unread;
    }
    return false;
}

void put_axis(JsonWriter& json, const axes::AxisView& axis, const runtime::FollowingPeak& peak, const runtime::MachineLayout& layout,
              const runtime::MachineLayout::AxisInfo& info) {
    json.open('{');
    json.field("name", info.name);
    json.field("unit", info.unit);
    json.field("state", name(axis.state));
    json.field("owner", name(axis.owner));
    json.field("disabled", info.disabled);
    json.field("simulated", axis.simulated);
    json.field("online", axis.online);
    json.field("group", info.group);  // of hot connect; empty: always there
    json.field("presence", name(axis.presence));
    json.field("powered", axis.powered);
    json.field("enable", axis.enable);  // wanted; and what whoever wants it permits
    json.field("enable_positive", axis.enable_positive);
    json.field("enable_negative", axis.enable_negative);
    json.field("homed", axis.homed);
    json.field("homing_busy", axis.state == axes::AxisState::Homing);
    json.field("in_position", axis.in_position);
    json.field("not_moving", axis.set_velocity == 0);
    json.field("positive_direction", axis.set_velocity > 0);
    json.field("negative_direction", axis.set_velocity < 0);
    json.field("constant_velocity", axis.set_velocity != 0 && axis.set_acceleration == 0);
    json.field("has_job", axis.active != 0);
    json.field("command", word(axis.active_kind));      // what moves it ...
    json.field("block", layout.block_at(axis.holder));  // ... and whose it is: who blocks, when another is refused
    json.field("held_by_stop", axis.lock != 0);
    json.field("queued", axis.queued_count);
    json.field("resetting", axis.resetting);
    json.field("warning", axis.warning);
    json.field("error", axis.error);
    put_error(json, axis.error);
    json.field("drive_error", axis.drive_error);
    json.field("actual_position", axis.actual_position);
    json.field("actual_velocity", axis.actual_velocity);
    json.field("actual_torque", axis.actual_torque);
    json.field("set_position", axis.set_position);
    json.field("set_velocity", axis.set_velocity);
    json.field("set_acceleration", axis.set_acceleration);
    json.field("set_jerk", axis.set_jerk);
    json.field("target_position", axis.target_position);
    json.field("distance_to_go", axis.active != 0 ? axis.target_position - axis.set_position : 0.0);
    json.field("following_error", axis.following_error);
    json.field("following_error_min", peak.minimum);
    json.field("following_error_max", peak.maximum);
    json.field("following_window", axis.following_window);
    json.field("velocity_limiter", word(axis.limiter));
    json.field("override", axis.override_factors.velocity);
    json.field("override_acceleration", axis.override_factors.acceleration);
    json.field("override_jerk", axis.override_factors.jerk);
    json.field("operators_override", axis.operators_override);
    put_limit(json, "position_min", axis, axes::enable_limit_negative, axes::software_limit_negative);
    put_limit(json, "position_max", axis, axes::enable_limit_positive, axes::software_limit_positive);
    json.field("velocity_limit", axis.parameters[axes::place_of(axes::velocity_of_application)]);
    json.field("manual_slow", axis.manual_slow);
    json.field("manual_fast", axis.manual_fast);
    json.field("turns", axis.turns);
    json.field("brake", word(axis.brake));
    json.field("torque_limit_positive", axis.torque_limit_positive);
    json.field("torque_limit_negative", axis.torque_limit_negative);
    json.field("skew", axis.skew);
    json.field("load_difference", axis.load_difference);
    json.field("superimposed_covered", axis.superimposed_covered);
    json.field("phase_shift", axis.phase_shift);
    json.field("master",
               axis.master.index < layout.axes.size() ? std::string_view(layout.axes[axis.master.index].name) : std::string_view{});
    json.field("sync_started", axis.sync_started);
    json.field("drive_state", name(axis.drive_state));
    json.field("drive_mode", name(axis.drive_mode));
    json.field("status_word", axis.status_word);
    json.field("digital_inputs", axis.digital_inputs);
    json.field("digital_outputs", axis.digital_outputs);
    json.field("negative_limit_switch", axis.negative_limit_switch);
    json.field("positive_limit_switch", axis.positive_limit_switch);
    json.field("home_switch", axis.home_switch);
    json.close('}');
}

bool any_alarm(const AlarmFact&) { return true; }
bool of_the_bus(const AlarmFact& fact) { return fact.source == AlarmSource::bus || fact.source == AlarmSource::slave; }

void put_alarms(JsonWriter& json, const runtime::Snapshot& snapshot, const MachineLink& machine,
                bool (*wanted)(const AlarmFact& fact) = any_alarm) {
    for (std::size_t i = 0; i < snapshot.alarm_count && i < snapshot.alarms.size(); ++i) {
        const auto& alarm = snapshot.alarms[i];
        if (!wanted(alarm.fact)) continue;
        const auto words = machine.describe(alarm.fact);
        json.open('{');
        json.field("id", alarm.fact.id);
        json.field("name", words.name);
        json.field("source", words.source);
        json.field("since_ns", count(alarm.since));
        json.field("count", alarm.count);
        json.field("standing", alarm.standing);
        json.field("acknowledged", alarm.acknowledged);
        json.field("reaction", word(alarm.reaction));
        json.field("english", words.english);
        json.field("chinese", words.chinese);
        json.field("cause", words.cause);
        json.field("remedy", words.remedy);
        json.field("reset", words.reset);
        json.field("manual", words.manual);
        if (const auto recording = machine.recording_of(alarm.fact, alarm.since); !recording.empty()) json.field("recording", recording);
        json.close('}');
    }
}

void put_giver(JsonWriter& json, std::string_view key, const runtime::CommandGiver& giver, const runtime::MachineLayout& layout) {
    json.open(key, '{');
    json.field("command", word(giver.kind));
    json.field("owner", name(giver.owner));
    json.field("program", giver.program < layout.programs.size() ? std::string_view(layout.programs[giver.program]) : std::string_view{});
    json.field("block", giver.block ? layout.block_at(giver.block) : std::string_view{});
    json.close('}');
}

void put_events(JsonWriter& json, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    for (std::size_t i = 0; i < s.event_count && i < s.events.size(); ++i) {
        const auto& event = s.events[i];
        const auto words = describe(event, layout);
        const auto* error = axes::find_error(event.error);
        json.open('{');
        json.field("number", event.number);
        json.field("time_ns", count(event.at));
        json.field("event", word(event.what));
        json.field("axis", event.axis < layout.axes.size() ? std::string_view(layout.axes[event.axis].name) : std::string_view{});
        put_giver(json, "given", event.given, layout);
        put_giver(json, "by", event.by, layout);
        json.field("held_by_stop", event.held);
        json.field("axis_state", name(event.state));
        json.field("error", error && event.error != axes::ErrorId::none ? error->name : std::string_view{});
        json.field("times", event.times);
        json.field("english", words.what);
        json.field("remedy", words.remedy);
        json.close('}');
    }
}

/// A point with a unit in it, another as the number that the terminal carries.
template <class ValueOf>
void put_points(JsonWriter& json, std::string_view key, const std::vector<std::string>& names, const std::vector<std::string>& units,
                const std::vector<std::int64_t>& words, const ValueOf& value_of) {
    json.open(key, '{');
    for (std::size_t i = 0; i < names.size() && i < words.size(); ++i) {
        json.name(names[i]);
        if (i < units.size() && !units[i].empty()) json.value(value_of(i));
        else json.value(words[i]);
    }
    json.close('}');
}

void put_force(JsonWriter& json, const runtime::ForcedPoint& force, const runtime::MachineLayout& layout, std::string_view by) {
    const bool output = force.direction == runtime::IoDirection::output;
    const auto& names = output ? layout.outputs : layout.inputs;
    json.open('{');
    json.field("point", force.index < names.size() ? std::string_view(names[force.index]) : std::string_view{});
    json.field("direction", output ? "output" : "input");
    json.field("value", force.value);
    json.field("by", by);
    json.close('}');
}

void put_units(JsonWriter& json, std::string_view key, const std::vector<std::string>& names, const std::vector<std::string>& units) {
    json.open(key, '{');
    for (std::size_t i = 0; i < names.size() && i < units.size(); ++i) {
        if (units[i].empty()) continue;
        json.name(names[i]);
        json.value(units[i]);
    }
    json.close('}');
}

void put_statistics(JsonWriter& json, const runtime::CycleStatistics& cycle) {
    json.open("statistics", '{');
    json.field("cycles", cycle.cycles);
    json.field("overruns", cycle.overruns);
    json.field("missed_ticks", cycle.missed_ticks);
    json.field("lateness_ns", count(cycle.lateness));
    json.field("lateness_max_ns", count(cycle.lateness_max));
    json.field("compute_ns", count(cycle.compute));
    json.field("compute_max_ns", count(cycle.compute_max));
    json.field("snapshots_dropped", cycle.snapshots_dropped);
    json.field("commands_refused", cycle.commands_refused);
    json.close('}');
}

void put_bus(JsonWriter& json, const runtime::Snapshot& s) {
    json.open('{');
    json.field("phase", word(s.bus_phase));
    json.field("frames_sent", s.bus.frames_sent);
    json.field("frames_received", s.bus.frames_received);
    json.field("frames_lost", s.bus.frames_lost);
    json.field("frames_late", s.bus.frames_late);
    json.field("frames_rejected", s.bus.frames_rejected);
    json.field("working_counter_errors", s.bus.working_counter_errors);
    json.field("send_errors", s.bus.send_errors);
    json.field("dc_difference_ns", s.bus.dc_difference_ns);
    json.field("round_trip_ns", count(s.bus.round_trip));
    json.field("dc_lock", ecat::name(s.bus.dc_lock));
    json.field("dc_phase_error_ns", s.bus.dc_phase_error_ns);
    json.field("dc_offset_ns", s.bus.dc_offset_ns);
    json.field("dc_drift_ppb", s.bus.dc_drift_ppb);
    json.field("dc_rejected", s.bus.dc_rejected);
    json.field("ring", ecat::name(s.bus.ring.shape));
    json.field("ring_before_break", s.bus.ring.before_break);
    json.field("ring_behind_break", s.bus.ring.behind_break);
    json.field("ring_opened", s.bus.ring.opened);
    json.field("sync0_margin_ns", s.bus.sync0_margin_ns);
    json.field("sync0_margin_least_ns", s.bus.sync0_margin_least_ns);
    json.close('}');
}

void put_slaves(JsonWriter& json, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    json.open("slaves", '[');
    for (std::size_t i = 0; i < s.slaves.size() && i < layout.slaves.size(); ++i) {
        json.open('{');
        json.field("name", layout.slaves[i]);
        json.field("state", ecat::name(s.slaves[i].al_state));
        json.field("al_status_code", s.slaves[i].al_status_code);
        json.field("fresh", s.slaves[i].fresh);
        json.field("age", s.slaves[i].age);
        json.close('}');
    }
    json.close(']');
}

void put_measurement(JsonWriter& json, const runtime::MeasureState& m, const runtime::MachineLayout& layout) {
    json.key("measure");
    if (m.run == 0 || m.axis >= layout.axes.size()) return json.value(std::nullopt);
    json.open('{');
    json.field("run", m.run);
    json.field("axis", layout.axes[m.axis].name);
    json.field("kind", name(m.plan.order().kind));
    json.field("running", m.running);
    json.field("end", name(m.end));
    json.field("elapsed_s", m.elapsed);
    json.field("duration_s", m.plan.duration());
    json.close('}');
}

void put_programs(JsonWriter& json, const runtime::Snapshot& s, const runtime::MachineLayout& layout) {
    json.open("programs", '[');
    for (std::size_t i = 0; i < s.programs.size() && i < layout.programs.size(); ++i) {
        json.open('{');
        json.field("name", layout.programs[i]);
        json.field("state", word(s.programs[i]));
        json.close('}');
    }
    json.close(']');
    json.open("tasks", '[');
    for (std::size_t i = 0; i < s.tasks.size() && i < layout.tasks.size(); ++i) {
        json.open('{');
        json.field("name", layout.tasks[i]);
        json.field("releases", s.tasks[i].releases);
        json.field("overruns", s.tasks[i].overruns);
        json.field("run_ns", count(s.tasks[i].run));
        json.field("run_max_ns", count(s.tasks[i].run_max));
        json.close('}');
    }
    json.close(']');
}

/// `named`: of the layout, in the order of `values`.
template <class Named>
void put_values(JsonWriter& json, std::string_view key, const Named& named, const std::vector<double>& values) {
    json.open(key, '[');
    for (std::size_t i = 0; i < values.size() && i < named.size(); ++i) {
        json.open('{');
        json.field("program", named[i].program);
        json.field("name", named[i].name);
        json.field("unit", named[i].unit);
        json.field("value", values[i]);
        json.close('}');
    }
    json.close(']');
}

/// By the name of the point; those with nothing are left out.
Json texts_of(const std::vector<std::string>& names, const std::vector<std::string>& units) {
    auto out = Json::object();
    for (std::size_t i = 0; i < names.size() && i < units.size(); ++i)
        if (!units[i].empty()) out[names[i]] = units[i];
    return out;
}

Json finite_or_null(double limit) { return std::isfinite(limit) ? Json(limit) : Json(nullptr); }

}  // namespace

std::string state_json(const runtime::Snapshot& s, const MachineLink& machine,
                       const std::function<std::string_view(std::uint32_t client)>& who) {
    const auto& layout = machine.layout();
    constexpr std::size_t of_an_axis = 2048, of_a_value = 96, of_the_rest = 8192;
    JsonWriter json(of_the_rest + s.axes.size() * of_an_axis +
                    (s.inputs.size() + s.outputs.size() + s.variables.size() + s.parameters.size() + s.slaves.size()) * of_a_value);
    json.open('{');
    json.field("machine", layout.machine);
    json.field("cycle", s.cycle);
    json.field("time_ns", count(s.at));
    json.field("phase", word(s.phase));
    json.field("mode", word(s.mode));
    json.field("emergency_stop", s.emergency_stop);
    json.field("emergency_stop_unread", emergency_stop_is_unread(s));
    json.field("simulated", s.simulated);
    put_statistics(json, s.statistics);
    json.key("bus");
    put_bus(json, s);
    put_slaves(json, s, layout);
    json.open("axes", '[');
    for (std::size_t i = 0; i < s.axes.size() && i < layout.axes.size(); ++i)
        put_axis(json, s.axes[i], i < s.following_peaks.size() ? s.following_peaks[i] : runtime::FollowingPeak{}, layout, layout.axes[i]);
    json.close(']');
    put_programs(json, s, layout);
    put_units(json, "input_units", layout.inputs, layout.input_units);
    put_units(json, "output_units", layout.outputs, layout.output_units);
    put_points(json, "inputs", layout.inputs, layout.input_units, s.inputs, [&](std::size_t i) { return s.input_values[i].value; });
    put_points(json, "outputs", layout.outputs, layout.output_units, s.outputs, [&](std::size_t i) { return s.output_values[i]; });
    json.open("doubtful_inputs", '[');
    for (std::size_t i = 0; i < s.input_values.size() && i < layout.inputs.size(); ++i)
        if (!s.input_values[i].good) json.value(layout.inputs[i]);
    json.close(']');
    json.open("forced", '[');
    for (std::size_t i = 0; i < s.force_count && i < s.forces.size(); ++i) put_force(json, s.forces[i], layout, who(s.forces[i].client));
    json.close(']');
    put_values(json, "variables", layout.variables, s.variables);
    put_values(json, "parameters", layout.parameters, s.parameters);
    put_measurement(json, s.measure, layout);
    json.open("alarms", '[');
    put_alarms(json, s, machine);
    json.close(']');
    json.open("events", '[');
    put_events(json, s, layout);
    json.close(']');
    json.field("events_dropped", s.events_dropped);
    json.close('}');
    return json.take();
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
                            {"position_min", finite_or_null(axis.position_min)},
                            {"position_max", finite_or_null(axis.position_max)},
                            {"velocity_limit", axis.velocity_limit},
                            {"acceleration_limit", axis.acceleration_limit},
                            {"deceleration", axis.deceleration},
                            {"jerk_limit", finite_or_null(axis.jerk_limit)},
                            {"following_window", finite_or_null(axis.following_window)},
                            {"in_position_window", axis.in_position_window},
                            {"modulo", axis.modulo},
                            {"homing", word(axis.homing)},
                            {"group", axis.group},
                            {"programs", axis.programs},
                            {"drive", axis.drive},
                            {"profile", axis.profile},
                            {"drive_axis", axis.drive_axis + 1}});
    out["slaves"] = layout.slaves;
    out["inputs"] = layout.inputs;
    out["outputs"] = layout.outputs;
    out["input_units"] = texts_of(layout.inputs, layout.input_units);
    out["output_units"] = texts_of(layout.outputs, layout.output_units);
    out["kept_inputs"] = texts_of(layout.inputs, layout.kept_inputs);  // why nobody may force them
    out["kept_outputs"] = texts_of(layout.outputs, layout.kept_outputs);
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

std::string bus_alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine) {
    JsonWriter json;
    json.open('[');
    put_alarms(json, snapshot, machine, of_the_bus);
    json.close(']');
    return json.take();
}

std::string bus_statistics_json(const runtime::Snapshot& snapshot) {
    JsonWriter json;
    put_bus(json, snapshot);
    return json.take();
}

std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine) {
    JsonWriter json;
    json.open('[');
    put_alarms(json, snapshot, machine);
    json.close(']');
    return json.take();
}

}  // namespace taktwerk::hmi

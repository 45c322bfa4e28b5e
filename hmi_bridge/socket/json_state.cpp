#include "hmi_bridge/socket/json_state.hpp"

#include <vector>

#include "hmi_bridge/socket/json_writer.hpp"
#include "hmi_bridge/state/whole_state.hpp"

namespace taktwerk::hmi {
namespace {

using namespace taktwerk_lcm;

/// null: there is none.
void put_limit(JsonWriter& json, std::string_view key, bool there, double limit) {
    json.key(key);
    if (there) json.value(limit);
    else json.value(std::nullopt);
}

void put(JsonWriter& json, const whole_axis_v1_t& axis) {
    json.open('{');
    json.field("name", axis.name);
    json.field("unit", axis.unit);
    json.field("state", axis.state);
    json.field("owner", axis.owner);
    json.field("disabled", axis.disabled != 0);
    json.field("simulated", axis.simulated != 0);
    json.field("online", axis.online != 0);
    json.field("group", axis.group);
    json.field("presence", axis.presence);
    json.field("powered", axis.powered != 0);
    json.field("enable", axis.enable != 0);
    json.field("enable_positive", axis.enable_positive != 0);
    json.field("enable_negative", axis.enable_negative != 0);
    json.field("homed", axis.homed != 0);
    json.field("homing_busy", axis.homing_busy != 0);
    json.field("in_position", axis.in_position != 0);
    json.field("not_moving", axis.not_moving != 0);
    json.field("positive_direction", axis.positive_direction != 0);
    json.field("negative_direction", axis.negative_direction != 0);
    json.field("constant_velocity", axis.constant_velocity != 0);
    json.field("has_job", axis.has_job != 0);
    json.field("command", axis.command);
    json.field("block", axis.block);
    json.field("held_by_stop", axis.held_by_stop != 0);
    json.field("queued", axis.queued);
    json.field("resetting", axis.resetting != 0);
    json.field("warning", axis.warning != 0);
    json.field("error", axis.error);
    if (!axis.error_name.empty()) {
        json.field("error_name", axis.error_name);
        json.field("error_cause", axis.error_cause);
        json.field("error_remedy", axis.error_remedy);
    }
    json.field("drive_error", axis.drive_error);
    json.field("actual_position", axis.actual_position);
    json.field("actual_velocity", axis.actual_velocity);
    json.field("actual_torque", axis.actual_torque);
    json.field("set_position", axis.set_position);
    json.field("set_velocity", axis.set_velocity);
    json.field("set_acceleration", axis.set_acceleration);
    json.field("set_jerk", axis.set_jerk);
    json.field("target_position", axis.target_position);
    json.field("distance_to_go", axis.distance_to_go);
    json.field("following_error", axis.following_error);
    json.field("following_error_min", axis.following_error_min);
    json.field("following_error_max", axis.following_error_max);
    json.field("following_window", axis.following_window);
    json.field("velocity_limiter", axis.velocity_limiter);
    json.field("override", axis.override_velocity);
    json.field("override_acceleration", axis.override_acceleration);
    json.field("override_jerk", axis.override_jerk);
    json.field("operators_override", axis.operators_override);
    put_limit(json, "position_min", axis.has_position_min, axis.position_min);
    put_limit(json, "position_max", axis.has_position_max, axis.position_max);
    json.field("velocity_limit", axis.velocity_limit);
    json.field("manual_slow", axis.manual_slow);
    json.field("manual_fast", axis.manual_fast);
    json.field("turns", axis.turns);
    json.field("brake", axis.brake);
    json.field("torque_limit_positive", axis.torque_limit_positive);
    json.field("torque_limit_negative", axis.torque_limit_negative);
    json.field("skew", axis.skew);
    json.field("load_difference", axis.load_difference);
    json.field("superimposed_covered", axis.superimposed_covered);
    json.field("phase_shift", axis.phase_shift);
    json.field("master", axis.master);
    json.field("sync_started", axis.sync_started != 0);
    json.field("drive_state", axis.drive_state);
    json.field("drive_mode", axis.drive_mode);
    json.field("status_word", axis.status_word);
    json.field("digital_inputs", axis.digital_inputs);
    json.field("digital_outputs", axis.digital_outputs);
    json.field("negative_limit_switch", axis.negative_limit_switch != 0);
    json.field("positive_limit_switch", axis.positive_limit_switch != 0);
    json.field("home_switch", axis.home_switch != 0);
    json.close('}');
}

void put(JsonWriter& json, const whole_group_member_v1_t& member) {
    json.open('{');
    json.field("axis", member.axis);
    json.field("ident", member.ident);
    json.field("unit", member.unit);
    json.field("set_position", member.set_position);
    json.field("actual_position", member.actual_position);
    json.field("set_velocity", member.set_velocity);
    json.field("velocity_use", member.velocity_use);
    json.field("acceleration_use", member.acceleration_use);
    json.field("jerk_use", member.jerk_use);
    json.close('}');
}

/// X Y Z RX RY RZ.
template <std::size_t Count>
void put_numbers(JsonWriter& json, std::string_view key, const double (&numbers)[Count]) {
    json.open(key, '[');
    for (const double number : numbers) json.value(number);
    json.close(']');
}

template <class Part>
void put_list(JsonWriter& json, std::string_view key, const std::vector<Part>& parts);

void put(JsonWriter& json, const whole_group_frame_v1_t& frame) {
    json.open('{');
    json.field("frame", frame.frame);
    json.field("axis", frame.axis);
    put_numbers(json, "tool_set", frame.tool_set);
    put_numbers(json, "tool_actual", frame.tool_actual);
    json.close('}');
}

/// Only while there is one.
void put_refusal(JsonWriter& json, const taktwerk_lcm::whole_refusal_v1_t& refusal) {
    if (refusal.error.empty()) return;
    json.open("refusal", '{');
    json.field("number", refusal.number);
    json.field("error", refusal.error);
    json.field("text", refusal.text);
    json.field("remedy", refusal.remedy);
    json.field("command", refusal.command);
    json.field("block", refusal.block);
    json.field("where", refusal.where);
    json.field("room", refusal.room);
    json.field("room_kept_free", refusal.room_kept_free != 0);
    json.field("axis", refusal.axis);
    json.field("limit_known", refusal.limit_known != 0);
    json.field("position", refusal.position);
    json.field("limit", refusal.limit);
    json.field("on_path", refusal.on_path != 0);
    json.field("part", refusal.part);
    json.field("length", refusal.length);
    json.field("in_space", refusal.in_space != 0);
    put_numbers(json, "point", refusal.point);
    json.field("line", refusal.line);
    json.close('}');
}

void put(JsonWriter& json, const whole_group_v3_t& group) {
    json.open('{');
    json.field("name", group.name);
    json.field("unit", group.unit);
    json.field("state", group.state);
    json.field("interrupted", group.interrupted != 0);
    json.field("held", group.held != 0);
    json.field("resetting", group.resetting != 0);
    json.field("powered", group.powered != 0);
    json.field("online", group.online != 0);
    json.field("in_position", group.in_position != 0);
    json.field("error", group.error);
    if (!group.error_name.empty()) {
        json.field("error_name", group.error_name);
        json.field("error_text", group.error_text);
        json.field("error_cause", group.error_cause);
        json.field("error_remedy", group.error_remedy);
    }
    put_list(json, "members", group.members);
    json.field("tool_known", group.tool_known != 0);
    put_numbers(json, "tool_set", group.tool_set);
    put_numbers(json, "tool_actual", group.tool_actual);
    put_list(json, "frames", group.frames);
    put_refusal(json, group.refusal);
    json.field("tool_speed", group.tool_speed);
    json.field("tool_actual_speed", group.tool_actual_speed);
    json.field("path_unit", group.path_unit);
    json.field("path_velocity", group.path_velocity);
    json.field("path_acceleration", group.path_acceleration);
    json.field("path_deviation", group.path_deviation);
    json.field("track", group.track);
    json.field("track_axis", group.track_axis);
    json.field("track_in_sync", group.track_in_sync != 0);
    json.field("track_lag", group.track_lag);
    json.field("tool_limit", group.tool_limit);
    json.field("limiter", group.limiter);
    json.field("limiting_axis", group.limiting_axis);
    json.field("command", group.command);
    json.field("block", group.block);
    json.field("command_id", group.command_id);
    json.field("progress", group.progress);
    json.field("distance_to_go", group.distance_to_go);
    json.field("remaining_s", group.remaining_s);
    json.field("queued", group.queued);
    json.field("override", group.override_velocity);
    json.field("operators_override", group.operators_override);
    json.close('}');
}

void put(JsonWriter& json, const whole_alarm_v1_t& alarm) {
    json.open('{');
    json.field("id", alarm.id);
    json.field("name", alarm.name);
    json.field("source", alarm.source);
    json.field("since_ns", alarm.since_ns);
    json.field("count", alarm.count);
    json.field("standing", alarm.standing != 0);
    json.field("acknowledged", alarm.acknowledged != 0);
    json.field("reaction", alarm.reaction);
    json.field("english", alarm.english);
    json.field("chinese", alarm.chinese);
    json.field("cause", alarm.cause);
    json.field("remedy", alarm.remedy);
    json.field("reset", alarm.reset);
    json.field("manual", alarm.manual);
    if (!alarm.recording.empty()) json.field("recording", alarm.recording);
    json.close('}');
}

void put_giver(JsonWriter& json, std::string_view key, const whole_giver_v1_t& giver) {
    json.open(key, '{');
    json.field("command", giver.command);
    json.field("owner", giver.owner);
    json.field("program", giver.program);
    json.field("block", giver.block);
    json.close('}');
}

void put(JsonWriter& json, const whole_event_v2_t& event) {
    json.open('{');
    json.field("number", event.number);
    json.field("time_ns", event.time_ns);
    json.field("event", event.event);
    json.field("axis", event.axis);
    if (!event.group.empty()) json.field("group", event.group);
    put_giver(json, "given", event.given);
    put_giver(json, "by", event.by);
    json.field("held_by_stop", event.held_by_stop != 0);
    json.field("axis_state", event.axis_state);
    json.field("error", event.error);
    json.field("times", event.times);
    json.field("english", event.english);
    json.field("remedy", event.remedy);
    json.close('}');
}

void put(JsonWriter& json, const whole_force_v1_t& force) {
    json.open('{');
    json.field("point", force.point);
    json.field("direction", force.direction);
    json.field("value", force.value);
    json.field("by", force.by);
    json.close('}');
}

void put(JsonWriter& json, const whole_slave_v1_t& slave) {
    json.open('{');
    json.field("name", slave.name);
    json.field("state", slave.state);
    json.field("al_status_code", slave.al_status_code);
    json.field("fresh", slave.fresh != 0);
    json.field("age", slave.age);
    json.close('}');
}

void put(JsonWriter& json, const whole_program_v1_t& program) {
    json.open('{');
    json.field("name", program.name);
    json.field("state", program.state);
    json.close('}');
}

void put(JsonWriter& json, const whole_task_v1_t& task) {
    json.open('{');
    json.field("name", task.name);
    json.field("releases", task.releases);
    json.field("overruns", task.overruns);
    json.field("run_ns", task.run_ns);
    json.field("run_max_ns", task.run_max_ns);
    json.close('}');
}

void put(JsonWriter& json, const whole_value_v1_t& value) {
    json.open('{');
    json.field("program", value.program);
    json.field("name", value.name);
    json.field("unit", value.unit);
    json.field("value", value.value);
    json.close('}');
}

template <class Part>
void put_list(JsonWriter& json, std::string_view key, const std::vector<Part>& parts) {
    json.open(key, '[');
    for (const auto& part : parts) put(json, part);
    json.close(']');
}

void put_units(JsonWriter& json, std::string_view key, const std::vector<whole_point_v1_t>& points) {
    json.open(key, '{');
    for (const auto& point : points) {
        if (point.unit.empty()) continue;
        json.name(point.name);
        json.value(point.unit);
    }
    json.close('}');
}

/// A point with a unit in it, another as the number that the terminal carries.
void put_points(JsonWriter& json, std::string_view key, const std::vector<whole_point_v1_t>& points) {
    json.open(key, '{');
    for (const auto& point : points) {
        json.name(point.name);
        if (!point.unit.empty()) json.value(point.value);
        else json.value(point.raw);
    }
    json.close('}');
}

void put_doubtful(JsonWriter& json, const std::vector<whole_point_v1_t>& inputs) {
    json.open("doubtful_inputs", '[');
    for (const auto& point : inputs)
        if (point.good == 0) json.value(point.name);
    json.close(']');
}

void put_statistics(JsonWriter& json, const whole_statistics_v2_t& cycle) {
    json.open("statistics", '{');
    json.field("cycles", cycle.cycles);
    json.field("overruns", cycle.overruns);
    json.field("missed_ticks", cycle.missed_ticks);
    json.field("lateness_ns", cycle.lateness_ns);
    json.field("lateness_max_ns", cycle.lateness_max_ns);
    json.field("compute_ns", cycle.compute_ns);
    json.field("compute_max_ns", cycle.compute_max_ns);
    json.field("snapshots_dropped", cycle.snapshots_dropped);
    json.field("commands_refused", cycle.commands_refused);
    json.field("page_faults", cycle.page_faults);
    json.field("disk_page_faults", cycle.disk_page_faults);
    json.close('}');
}

void put(JsonWriter& json, const whole_bus_v1_t& bus) {
    json.open('{');
    json.field("phase", bus.phase);
    json.field("frames_sent", bus.frames_sent);
    json.field("frames_received", bus.frames_received);
    json.field("frames_lost", bus.frames_lost);
    json.field("frames_late", bus.frames_late);
    json.field("frames_rejected", bus.frames_rejected);
    json.field("working_counter_errors", bus.working_counter_errors);
    json.field("send_errors", bus.send_errors);
    json.field("dc_difference_ns", bus.dc_difference_ns);
    json.field("round_trip_ns", bus.round_trip_ns);
    json.field("dc_lock", bus.dc_lock);
    json.field("dc_phase_error_ns", bus.dc_phase_error_ns);
    json.field("dc_offset_ns", bus.dc_offset_ns);
    json.field("dc_drift_ppb", bus.dc_drift_ppb);
    json.field("dc_rejected", bus.dc_rejected);
    json.field("ring", bus.ring);
    json.field("ring_before_break", bus.ring_before_break);
    json.field("ring_behind_break", bus.ring_behind_break);
    json.field("ring_opened", bus.ring_opened);
    json.field("sync0_margin_ns", bus.sync0_margin_ns);
    json.field("sync0_margin_least_ns", bus.sync0_margin_least_ns);
    json.close('}');
}

void put_measurement(JsonWriter& json, const whole_measure_v1_t& measured) {
    json.key("measure");
    if (measured.run == 0) return json.value(std::nullopt);
    json.open('{');
    json.field("run", measured.run);
    json.field("axis", measured.axis);
    json.field("kind", measured.kind);
    json.field("running", measured.running != 0);
    json.field("end", measured.end);
    json.field("elapsed_s", measured.elapsed_s);
    json.field("duration_s", measured.duration_s);
    json.close('}');
}

bool any_alarm(const AlarmFact&) { return true; }
bool of_the_bus(const AlarmFact& fact) { return fact.source == AlarmSource::bus || fact.source == AlarmSource::slave; }

std::string alarms_text(const runtime::Snapshot& snapshot, const MachineLink& machine, bool (*wanted)(const AlarmFact& fact)) {
    JsonWriter json;
    whole_alarm_v1_t words{};
    json.open('[');
    for (std::size_t i = 0; i < snapshot.alarm_count && i < snapshot.alarms.size(); ++i) {
        if (!wanted(snapshot.alarms[i].fact)) continue;
        fill(words, snapshot.alarms[i], machine);
        put(json, words);
    }
    json.close(']');
    return json.take();
}

}  // namespace

std::string state_json(const whole_state_v5_t& s) {
    constexpr std::size_t of_an_axis = 2048, of_a_group = 4096, of_a_value = 96, of_the_rest = 8192;
    JsonWriter json(of_the_rest + s.axes.size() * of_an_axis + s.groups.size() * of_a_group +
                    (s.inputs.size() + s.outputs.size() + s.variables.size() + s.parameters.size() + s.slaves.size()) * of_a_value);
    json.open('{');
    json.field("machine", s.machine);
    json.field("cycle", s.cycle_count);
    json.field("time_ns", s.cycle_time_ns);
    json.field("phase", s.phase);
    json.field("mode", s.mode);
    json.field("emergency_stop", s.emergency_stop != 0);
    json.field("emergency_stop_unread", s.emergency_stop_unread != 0);
    json.field("simulated", s.simulated != 0);
    put_statistics(json, s.statistics);
    json.key("bus");
    put(json, s.bus);
    put_list(json, "slaves", s.slaves);
    put_list(json, "axes", s.axes);
    put_list(json, "groups", s.groups);
    put_list(json, "programs", s.programs);
    put_list(json, "tasks", s.tasks);
    put_units(json, "input_units", s.inputs);
    put_units(json, "output_units", s.outputs);
    put_points(json, "inputs", s.inputs);
    put_points(json, "outputs", s.outputs);
    put_doubtful(json, s.inputs);
    put_list(json, "forced", s.forced);
    put_list(json, "variables", s.variables);
    put_list(json, "parameters", s.parameters);
    put_measurement(json, s.measure);
    put_list(json, "alarms", s.alarms);
    put_list(json, "events", s.events);
    json.field("events_dropped", s.events_dropped);
    json.close('}');
    return json.take();
}

std::string state_json(const runtime::Snapshot& snapshot, const MachineLink& machine, const NameOfClient& who) {
    whole_state_v5_t all{};
    fill(all, snapshot, machine, who);
    return state_json(all);
}

std::string bus_alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine) {
    return alarms_text(snapshot, machine, of_the_bus);
}

std::string bus_statistics_json(const runtime::Snapshot& snapshot) {
    whole_bus_v1_t bus{};
    fill(bus, snapshot);
    JsonWriter json;
    put(json, bus);
    return json.take();
}

std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine) { return alarms_text(snapshot, machine, any_alarm); }

}  // namespace taktwerk::hmi

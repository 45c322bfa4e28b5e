#include "hmi_bridge/socket/machine_questions.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/port/parameter_text.hpp"
#include "hmi_bridge/socket/json_bus.hpp"
#include "hmi_bridge/socket/json_times.hpp"
#include "hmi_bridge/socket/json_writer.hpp"
#include "hmi_bridge/words/target_names.hpp"

namespace taktwerk::hmi {
namespace {

std::string_view word(axes::ParameterEffect effect) {
    switch (effect) {
        case axes::ParameterEffect::at_once: return "at_once";
        case axes::ParameterEffect::at_standstill: return "at_standstill";
        case axes::ParameterEffect::when_enabled: return "when_enabled";
        case axes::ParameterEffect::after_restart: return "after_restart";
        case axes::ParameterEffect::after_saving: return "after_saving";
    }
    return "at_once";
}

std::string_view word(axes::ParameterChange change) {
    switch (change) {
        case axes::ParameterChange::any_time: return "any_time";
        case axes::ParameterChange::disabled: return "disabled";
        case axes::ParameterChange::never: return "never";
    }
    return "never";
}

void put_limit(JsonWriter& json, std::string_view key, const std::optional<std::int64_t>& limit, double scale) {
    json.key(key);
    if (limit) json.value(static_cast<double>(*limit) * scale);
    else json.value(std::nullopt);
}

void put_parameter(JsonWriter& json, const axes::DriveParameter& parameter) {
    const bool number = parameter.bits != 0;
    const bool factory = number && parameter.factory != axes::FactoryValue::unknown;
    json.open('{');
    json.field("id", axes::name_of(parameter));
    json.field("object", parameter.reach == axes::ParameterReach::bus ? axes::object_text(parameter.address) : std::string{});
    json.field("english", parameter.name);
    json.field("chinese", parameter.chinese);
    json.field("unit", parameter.unit);
    json.field("scale", parameter.scale);
    put_limit(json, "minimum", number ? parameter.minimum : std::nullopt, parameter.scale);
    put_limit(json, "maximum", number ? parameter.maximum : std::nullopt, parameter.scale);
    json.field("factory_is", axes::name(parameter.factory));
    put_limit(json, "factory", factory ? std::optional(parameter.value) : std::nullopt, parameter.scale);
    json.field("factory_shown", factory ? axes::value_text(parameter, parameter.value) : std::string{});
    json.field("meaning", parameter.meaning);
    json.field("readable", parameter.reach == axes::ParameterReach::bus);
    json.field("writable",
               parameter.reach == axes::ParameterReach::bus && parameter.change != axes::ParameterChange::never && !parameter.action);
    json.field("action", parameter.action);
    json.field("change", word(parameter.change));
    json.field("effective", word(parameter.effect));
    json.field("manual", parameter.section);
    json.close('}');
}

}  // namespace

MachineQuestions::~MachineQuestions() = default;

bool MachineQuestions::knows(std::string_view cmd) noexcept { return std::find(words.begin(), words.end(), cmd) != words.end(); }

void MachineQuestions::ask(std::string_view cmd, ConnectionId connection, const std::string& id, JsonFields& fields,
                           const runtime::Snapshot* snapshot, Instant now) {
    fields.integer("utime");
    const auto axis = cmd == "drive_parameters" ? fields.text("axis", true) : std::string{};
    constexpr auto most = static_cast<std::int64_t>(most_log_lines);
    const std::int64_t after = cmd == "log" ? fields.integer("after") : 0;
    const std::int64_t limit = cmd == "log" && fields.has("limit") ? fields.integer("limit") : most;
    fields.finish();
    const auto answer = [&](Result<std::string> body) { answers_.push_back({connection, id, std::move(body)}); };
    if (fields.error()) return answer(*fields.error());
    if (cmd == "histograms") {
        const auto times = machine_.times();
        if (times.cycle == nullptr) return answer(Error{"state.not_yet", "", "this machine measures no times", "Ask a machine that runs."});
        return answer("\"histograms\":" + times_json(machine_.layout(), times));
    }
    if (cmd == "drive_parameters") return answer(drive_parameters(axis));
    if (cmd == "log") {
        if (after < 0 || limit < 1)
            return answer(request_error("wrong_type", "\"after\" counts from 0, \"limit\" from 1",
                                        "Give the number of the last line that you have."));
        return answer(log_lines(static_cast<std::uint64_t>(after), static_cast<std::size_t>(std::min(limit, most))));
    }
    waiting_.push_back({connection, id});
    look(now);
    step(snapshot, now);
}

Result<std::string> MachineQuestions::drive_parameters(const std::string& axis) const {
    const auto found = find_target(machine_.layout(), TargetKind::axis, axis);
    if (!found) return found.error();
    const auto drive = machine_.drive(*found);
    if (drive.profile == nullptr)
        return Error{"drive.none", "axis " + axis, "has no drive: it is virtual, or simulated: true", "Ask for an axis that has one."};
    const auto& profile = *drive.profile;
    JsonWriter json(profile.parameters.size() * 512 + 256);
    json.open('{');
    json.field("axis", axis);
    json.field("profile", profile.name);
    json.field("vendor", profile.vendor);
    json.field("title", profile.title);
    json.open("parameters", '[');
    for (const auto& parameter : profile.parameters) put_parameter(json, parameter);
    json.close(']');
    json.close('}');
    return "\"drive_parameters\":" + json.take();
}

std::string MachineQuestions::log_lines(std::uint64_t after, std::size_t most) const {
    JsonWriter json(8192);
    json.open('{');
    json.field("last", log_ ? log_->last() : std::uint64_t{0});
    json.open("lines", '[');
    if (log_)
        for (const auto& line : log_->after(after, most)) {
            json.open('{');
            json.field("number", line.number);
            json.field("text", line.text);
            json.close('}');
        }
    json.close(']');
    json.close('}');
    return "\"log\":" + json.take();
}

void MachineQuestions::forget(ConnectionId connection) {
    std::erase_if(waiting_, [&](const Waiting& waiting) { return waiting.connection == connection; });
}

/// A new look, unless one is under way, or the last is young.
void MachineQuestions::look(Instant now) {
    auto* bus_look = machine_.bus_look();
    if (bus_look == nullptr || looks_ || (looked_ && now - *looked_ < look_period)) return;
    bus_look->begin();
    looks_ = true;
}

void MachineQuestions::step(const runtime::Snapshot* snapshot, Instant now) {
    auto* bus = machine_.bus();
    const auto* bus_look = machine_.bus_look();
    if (looks_ && !bus_look->under_way()) {
        looks_ = false;
        looked_ = now;
    }
    if (waiting_.empty() || looks_) return;
    const auto body = bus != nullptr && looked_
                          ? Result<std::string>("\"bus\":" + bus_json(*bus, bus_look->survey(), snapshot, machine_))
                          : Result<std::string>(Error{"state.not_yet", "", "this machine has no bus", "Ask a machine that has one."});
    for (auto& waiting : waiting_) answers_.push_back({waiting.connection, std::move(waiting.id), body});
    waiting_.clear();
}

std::optional<MachineQuestions::Answer> MachineQuestions::next_answer() {
    if (answers_.empty()) return std::nullopt;
    auto answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
}

}  // namespace taktwerk::hmi

#include "hmi_bridge/socket/json_requests.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/nearest_name.hpp"
#include "hmi_bridge/gateway/request_age.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/socket/answer_line.hpp"
#include "hmi_bridge/socket/json_history.hpp"
#include "hmi_bridge/socket/json_layout.hpp"
#include "hmi_bridge/socket/json_measure.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "hmi_bridge/socket/peer_name.hpp"
#include "hmi_bridge/words/target_names.hpp"
#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

constexpr std::array<std::string_view, 10> questions{"hello",    "layout",       "state",          "alarms", "alarm_history",
                                                     "simulate", "measure_plan", "measure_result", "views",  "view_image"};
struct DriveWord {
    std::string_view word;
    DriveRequestKind kind;
};
constexpr std::array<DriveWord, 4> drive_words{{
    {"drive_read", DriveRequestKind::read},
    {"drive_write", DriveRequestKind::write},
    {"drive_store", DriveRequestKind::store},
    {"drive_clear_turns", DriveRequestKind::clear_turns},
}};
constexpr std::size_t most_keys = 64;  ///< of one request; no command has ten

Result<nlohmann::json> parse(std::string_view line) {
    bool too_deep = false;
    std::vector<std::string> keys;
    std::optional<std::string> twice;  // the last one would win, and whoever looks at the first sees another request
    const auto bounded = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
        too_deep = too_deep || depth > deepest_nesting;
        if (event == nlohmann::json::parse_event_t::key && depth == 1 && keys.size() < most_keys) {
            const auto& key = value.get_ref<const std::string&>();
            if (!twice && std::find(keys.begin(), keys.end(), key) != keys.end()) twice = key;
            keys.push_back(key);
        }
        return !too_deep;
    };
    auto json = nlohmann::json::parse(line, bounded, false);
    if (too_deep)
        return request_error("too_deep", fmt::format("the request is nested deeper than {} levels", deepest_nesting),
                             "Send one flat JSON object a line.");
    if (json.is_discarded())
        return request_error("not_json", fmt::format("the line is not JSON: {}", shown(line)),
                             R"(Send one JSON object a line: {"id":1,"cmd":"state"}.)");
    if (!json.is_object())
        return request_error("not_an_object", "the request is not a JSON object",
                             R"(Send one JSON object a line: {"id":1,"cmd":"state"}.)");
    if (keys.size() >= most_keys)
        return request_error("unknown_key", fmt::format("the request has {} keys or more", most_keys), "Send the keys of one command.");
    if (twice)
        return request_error("duplicate_key",
                             fmt::format("the key {} stands in the line twice, and nobody can tell which one is meant", shown(*twice)),
                             "Give each key once. A line that asks for a stop stops all axes all the same.");
    return json;
}

std::optional<runtime::Mode> find_mode(std::string_view text) {
    for (const auto mode : {runtime::Mode::manual, runtime::Mode::setup, runtime::Mode::automatic})
        if (word(mode) == text) return mode;
    return std::nullopt;
}

Error unknown_command(std::string_view cmd) {
    std::vector<std::string> words(questions.begin(), questions.end());
    for (const auto& entry : command_words) words.emplace_back(entry.word);
    for (const auto& entry : drive_words) words.emplace_back(entry.word);
    for (const auto entry : ScopeRequests::words()) words.emplace_back(entry);
    words.insert(words.end(), MachineQuestions::words.begin(), MachineQuestions::words.end());
    const auto near = nearest_name(cmd.substr(0, 64), words);
    return request_error("unknown_command", fmt::format("there is no command {}", shown(cmd)),
                         near.empty() ? fmt::format("Use one of: {}.", fmt::join(words, ", ")) : fmt::format("Did you mean \"{}\"?", near));
}

/// "valid_ms" and "utime": what every command may say.
RequestAge read_age(JsonFields& fields, std::int64_t wall_utime, Duration valid_for = RequestAge{}.valid_for) {
    RequestAge given{.valid_for = valid_for};
    // A validity beyond what fits is as wrong as one beyond the gateway's limit.
    if (const auto ms = fields.maybe_integer("valid_ms"))
        given.valid_for = std::chrono::milliseconds{std::clamp<std::int64_t>(*ms, -1, 1'000'000)};
    if (const auto utime = fields.maybe_integer("utime")) {
        constexpr std::int64_t day = 86'400'000'000;
        const bool far = *utime < wall_utime - day || *utime > wall_utime + day || *utime < 0;
        given.age = std::chrono::microseconds{far ? (*utime < wall_utime ? day : -day) : wall_utime - *utime};
    }
    return given;
}

/// Of what is carried out here and now, without the gateway.
std::optional<Error> too_late(RequestAge given, const Arrival& arrival, Instant now) {
    given.arrived = arrival.at;
    if (auto error = given.refuse_validity()) return error;
    return given.refuse_age(now);
}

Result<CommandRequest> read_command(const CommandWord& entry, JsonFields& fields, std::int64_t wall_utime) {
    CommandRequest request;
    request.kind = entry.kind;
    if (entry.target == TargetKind::point) {
        request.output = fields.has("output");
        request.target = fields.text(request.output ? "output" : "input", true);
        // Without a value the point is its own again.
        if (entry.kind == CommandKind::force && !fields.has("value")) request.kind = CommandKind::unforce;
    } else if (entry.target != TargetKind::none) {
        const bool optional = entry.kind == CommandKind::stop || entry.kind == CommandKind::reset;
        request.target = fields.text(noun(entry.target), !optional);
        // An empty name is a name that somebody forgot to fill in. A stop then stops everything; a reset must not reset everything.
        if (entry.kind == CommandKind::reset && request.target.empty() && fields.has("axis") && !fields.error())
            return Error{"command.unknown_name", "", "\"axis\" is empty",
                         "Name the axis; to reset all axes and the machine leave \"axis\" out."};
    }
    if (!entry.value.empty() && request.kind == entry.kind) request.value = fields.number(entry.value, true);
    if (!entry.value2.empty()) request.value2 = fields.number(entry.value2, true);
    if (entry.kind == CommandKind::jog) {
        request.press = fields.flag("press");
        request.valid_for = std::chrono::milliseconds{250};
    }
    if (entry.kind == CommandKind::group_jog) {
        request.press = fields.flag("press");
        request.valid_for = std::chrono::milliseconds{250};
        const bool needed = request.value != 0;  // who lets go need not say of what
        request.group_jog.direction = fields.text("direction", needed);
        if (auto frame = fields.text("frame", false); !frame.empty()) request.group_jog.frame = std::move(frame);
        request.group_jog.distance = fields.number("distance", false);
    }
    if (entry.kind == CommandKind::measure) {
        request.press = fields.flag("press");
        request.valid_for = std::chrono::milliseconds{250};
        if (request.press) request.measure = read_measure_order(fields);
    }
    if (entry.kind == CommandKind::set_value) request.press = fields.flag("press");
    std::optional<Error> mode_error;
    if (entry.kind == CommandKind::mode) {
        const auto wanted = fields.text("mode", true);
        if (const auto mode = find_mode(wanted)) request.mode = *mode;
        else
            mode_error =
                Error{"command.bad_value", "", fmt::format("there is no mode {}", shown(wanted)), "Give manual, setup or automatic."};
    }
    request.commissioning = fields.flag("commissioning");
    const auto given = read_age(fields, wall_utime, request.valid_for);
    request.valid_for = given.valid_for;
    request.age = given.age;
    fields.finish();
    if (fields.error()) return *fields.error();
    if (mode_error) return *mode_error;
    return request;
}

}  // namespace

JsonRequests::JsonRequests(Gateway& gateway, MachineLink& machine, std::function<std::int64_t()> wall_utime,
                           std::function<void(std::string_view)> log)
    : gateway_(gateway),
      machine_(machine),
      drives_(machine, std::move(log), &gateway.hands()),
      scope_(machine),
      questions_(machine),
      measurements_(machine),
      wall_utime_(std::move(wall_utime)) {}

void JsonRequests::on_open(ConnectionId connection, const Peer& peer) {
    names_[connection] = peer_name(peer);
    const auto client = gateway_.open(Source::socket, names_[connection], Rights::commissioning);
    if (client == 0) return;  // questions are still answered
    clients_[connection] = client;
    connections_[client] = connection;
}

void JsonRequests::on_close(ConnectionId connection) {
    drives_.forget(connection);
    scope_.forget(connection);
    questions_.forget(connection);
    names_.erase(connection);
    const auto found = clients_.find(connection);
    if (found == clients_.end()) return;
    gateway_.close(found->second);
    connections_.erase(found->second);
    clients_.erase(found);
}

void JsonRequests::refuse(ConnectionId connection, const std::string& id, const Error& error) {
    lines_.push_back({connection, refusal_line(id, error), id});
}

void JsonRequests::on_request(ConnectionId connection, std::string_view line, Instant now, const Arrival& arrival) {
    const auto json = parse(line);
    if (!json) return refuse(connection, "null", json.error());
    JsonFields fields(*json);
    const auto id = fields.integer("id");
    const auto id_text = id > 0 ? std::to_string(id) : std::string("null");
    const auto cmd = fields.text("cmd", true);
    if (fields.error()) return refuse(connection, id_text, *fields.error());

    if (const auto* entry = find_command(cmd)) {
        if (id <= 0)
            return refuse(connection, "null",
                          request_error("missing_key", "a command needs an \"id\" of 1 or more", "Count \"id\" up with each command."));
        auto request = read_command(*entry, fields, wall_utime_());
        if (!request) return refuse(connection, id_text, request.error());
        const auto client = clients_.find(connection);
        if (client == clients_.end())
            return refuse(connection, id_text,
                          {"command.not_possible_now", "", "too many clients give commands", "Close some of them and connect again."});
        if (entry->kind == CommandKind::measure && request->press && snapshot_) {  // the cycle decides; here are the words
            const auto axis = find_target(machine_.layout(), TargetKind::axis, request->target);
            const auto plan = axis ? measurements_.plan(*axis, request->measure, *snapshot_) : Result<axes::ExcitationPlan>(axis.error());
            if (!plan) return refuse(connection, id_text, plan.error());
        }
        request->client = client->second;
        request->arrival = arrival;
        request->sequence = static_cast<std::uint64_t>(id);
        return gateway_.handle(*request, now);
    }
    for (const auto& entry : drive_words)
        if (entry.word == cmd) return ask_drive(entry.kind, connection, id_text, fields, now, arrival);
    if (ScopeRequests::knows(cmd)) {
        fields.integer("utime");
        if (const auto begun = scope_.handle(connection, id_text, cmd, fields, now); !begun) refuse(connection, id_text, begun.error());
        return;
    }
    if (MachineQuestions::knows(cmd)) return questions_.ask(cmd, connection, id_text, fields, snapshot_, now);
    if (cmd == "alarm_history") return ask_history(connection, id_text, fields, now);
    if (std::find(questions.begin(), questions.end(), cmd) == questions.end()) return refuse(connection, id_text, unknown_command(cmd));

    if (answer_measure(cmd, connection, id_text, fields)) return;
    if (cmd == "simulate") return simulate(connection, id_text, fields, now, arrival);
    fields.integer("utime");
    const auto image = cmd == "view_image" ? fields.text("image", true) : std::string{};
    fields.finish();
    if (fields.error()) return refuse(connection, id_text, *fields.error());
    const auto with = [&](std::string_view key, std::string_view value) {
        answer(connection, fmt::format(R"({{"id":{},"ok":true,"{}":{}}})", id_text, key, value));
    };
    const auto stuck = machine_.stuck();
    if (cmd == "hello") return with("hello", hello(stuck, now));
    if (cmd == "views") return with("views", views_.views());
    if (cmd == "view_image") return answer_image(connection, id_text, image);
    if (cmd == "layout") return with("layout", layout_json(machine_.layout()));
    if (!snapshot_)
        return refuse(connection, id_text,
                      {"state.not_yet", "", "the machine has not executed a cycle yet" + (progress_.empty() ? "" : ": " + progress_),
                       "Ask again in a moment."});
    // What the cycle has published last goes on looking alive: nobody may take it for the machine.
    if (stuck)
        return refuse(connection, id_text, {"state.stuck", "", *stuck, "Use the emergency stop; end the runtime and mend that program."});
    if (cmd == "state") return with("state", state_json(*snapshot_, machine_, [&](ClientId client) { return gateway_.name_of(client); }));
    with("alarms", alarms_json(*snapshot_, machine_));
}

void JsonRequests::simulate(ConnectionId connection, const std::string& id, JsonFields& fields, Instant now, const Arrival& arrival) {
    const auto given = read_age(fields, wall_utime_());
    const auto happening = fields.text("line", true);
    fields.finish();
    if (fields.error()) return refuse(connection, id, *fields.error());
    if (!simulate_)
        return refuse(connection, id,
                      {"simulate.real_machine", machine_.layout().machine, "this machine is not simulated: its inputs and faults are real",
                       "Start it with `taktwerk run FILE --simulate`."});
    if (const auto late = too_late(given, arrival, now)) return refuse(connection, id, *late);
    if (const auto done = simulate_(happening); !done) return refuse(connection, id, done.error());
    answer(connection, accepted_line(id));
}

std::string JsonRequests::hello(const std::optional<std::string>& stuck, Instant now) const {
    nlohmann::ordered_json hello{{"protocol_version", protocol_version},
                                 {"machine", machine_.layout().machine},
                                 {"interface", machine_.layout().interface},
                                 {"serial_devices", machine_.layout().serial_devices},
                                 {"pid", ::getpid()},
                                 {"cycling", snapshot_ != nullptr && !stuck},
                                 {"progress", stuck ? *stuck : progress_},
                                 {"version", about_.version},
                                 {"uptime_s", began_ ? to_seconds(now - *began_) : 0.0}};
    hello["lcm"] = {{"url", lcm_.url}, {"why", lcm_.why}, {"rate_hz", lcm_.rate_hz}, {"run", lcm_.run}};
    auto& libraries = hello["libraries"] = nlohmann::ordered_json::array();
    for (const auto& part : about_.libraries)
        libraries.push_back({{"name", part.name}, {"version", part.version}, {"licence", part.licence}});
    return hello.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool JsonRequests::answer_measure(std::string_view cmd, ConnectionId connection, const std::string& id, JsonFields& fields) {
    const bool plans = cmd == "measure_plan";
    if (!plans && cmd != "measure_result") return false;
    fields.integer("utime");
    const auto name = fields.text("axis", true);
    const auto order = plans ? read_measure_order(fields) : axes::MeasureOrder{};
    double window = plans ? 0 : fields.number("window", false);
    fields.finish();
    const auto with = [&](const std::string& value) {
        answer(connection, fmt::format(R"({{"id":{},"ok":true,"{}":{}}})", id, cmd, value));
        return true;
    };
    const auto refused = [&](const Error& error) {
        refuse(connection, id, error);
        return true;
    };
    if (fields.error()) return refused(*fields.error());
    const auto axis = find_target(machine_.layout(), TargetKind::axis, name);
    if (!axis) return refused(axis.error());
    const auto& unit = machine_.layout().axes[*axis].unit;
    if (!snapshot_) return refused({"state.not_yet", "", "the machine has not executed a cycle yet", "Ask again in a moment."});
    if (plans) {
        const auto plan = measurements_.plan(*axis, order, *snapshot_);
        return plan ? with(plan_json(*plan, unit)) : refused(plan.error());
    }
    const auto* run = measurements_.newest(*axis);
    const auto* config = machine_.axis_config(*axis);
    if (run == nullptr || config == nullptr)
        return refused({"measure.none", "axis " + name, "it was not measured since the machine was started", "Measure it first."});
    if (run->forgotten)
        return refused({"measure.forgotten", "axis " + name, "the samples of its measurement have made room for newer ones of other axes",
                        "Measure it again."});
    if (run->state.running) return with(result_json(*run, *config, window));
    // Asked again and again, it is worked out once: what is asked here holds up everybody else's.
    auto& told = measured_[*axis];
    if (told.run != run->state.run || told.samples != run->samples.samples.size() || told.window != window)
        told = {run->state.run, run->samples.samples.size(), window, result_json(*run, *config, window)};
    return with(told.text);
}

void JsonRequests::ask_history(ConnectionId connection, const std::string& id, JsonFields& fields, Instant now) {
    auto query = read_history_query(fields);
    if (!query) return refuse(connection, id, query.error());
    if (history_ == nullptr)
        return refuse(connection, id,
                      {"history.off", machine_.layout().machine, "this machine keeps no alarm history",
                       "Give it rows: `history: {rows: 10000}` in the machine file."});
    history_->ask(connection, id, std::move(*query), now);
}

void JsonRequests::answer_image(ConnectionId connection, const std::string& id, const std::string& name) {
    if (const auto members = views_.image(name)) return answer(connection, fmt::format(R"({{"id":{},"ok":true,{}}})", id, *members));
    const auto near = nearest_name(name.substr(0, 64), views_.images());
    refuse(connection, id,
           {"view.no_image", "", fmt::format("no view of this machine shows the picture {}", shown(name)),
            near.empty() ? "Ask \"views\" for their names." : fmt::format("Did you mean '{}'?", near)});
}

void JsonRequests::ask_drive(DriveRequestKind kind, ConnectionId connection, const std::string& id, JsonFields& fields, Instant now,
                             const Arrival& arrival) {
    DriveRequest request;
    request.kind = kind;
    request.axis = fields.text("axis", true);
    if (kind == DriveRequestKind::read || kind == DriveRequestKind::write) request.parameter = fields.text("parameter", true);
    if (kind == DriveRequestKind::write) {
        request.value = fields.text("value", true);
        request.store = fields.flag("store");
    }
    const bool asks_only = kind == DriveRequestKind::read;
    if (asks_only) fields.integer("utime");
    const auto given = asks_only ? RequestAge{} : read_age(fields, wall_utime_());
    fields.finish();
    if (fields.error()) return refuse(connection, id, *fields.error());
    if (!asks_only)
        if (const auto late = too_late(given, arrival, now)) return refuse(connection, id, *late);
    request.who = names_[connection];
    if (const auto client = clients_.find(connection); client != clients_.end()) request.client = client->second;
    request.tag = connection;
    request.id = id;
    drives_.handle(std::move(request), snapshot_, now);
}

void JsonRequests::step(Instant now) {
    scope_.step(snapshot_, now);
    while (auto done = scope_.next_answer()) {
        if (done->error) refuse(done->connection, done->id, *done->error);
        else answer(done->connection, std::move(done->text));
    }
    if (!began_) began_ = now;
    questions_.step(snapshot_, now);
    while (auto answered = questions_.next_answer()) {
        if (!answered->body) refuse(answered->connection, answered->id, answered->body.error());
        else answer(answered->connection, fmt::format(R"({{"id":{},"ok":true,{}}})", answered->id, *answered->body));
    }
    drives_.step(now);
    measurements_.step(snapshot_);
    while (history_ != nullptr) {
        const auto done = history_->next_answer(now);
        if (!done) break;
        if (!done->page) refuse(done->tag, done->id, done->page.error());
        else answer(done->tag, history_line(done->id, *done->page));
    }
    while (const auto done = drives_.next_answer()) {
        if (done->error) {
            refuse(done->tag, done->id, *done->error);
            continue;
        }
        nlohmann::ordered_json line{{"id", nlohmann::json::parse(done->id)}, {"ok", true}};
        if (!done->parameter.empty()) line["parameter"] = done->parameter;
        if (!done->bytes.empty()) {
            line["shown"] = done->shown;
            auto& bytes = line["bytes"] = nlohmann::ordered_json::array();
            for (const auto b : done->bytes) bytes.push_back(std::to_integer<int>(b));
        }
        answer(done->tag, line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
}

void JsonRequests::deliver(const CommandReply& reply) {
    const auto found = connections_.find(reply.client);
    if (found == connections_.end()) return;
    const auto id = std::to_string(reply.sequence);
    if (reply.accepted() && !reply.note.empty())
        answer(found->second, fmt::format(R"({{"id":{},"ok":true,"note":{}}})", id, nlohmann::json(reply.note).dump()));
    else if (reply.accepted()) answer(found->second, accepted_line(id));
    else refuse(found->second, id, reply.error);
}

std::optional<JsonRequests::Line> JsonRequests::next_line() {
    if (lines_.empty()) return std::nullopt;
    auto line = std::move(lines_.front());
    lines_.pop_front();
    return line;
}

}  // namespace taktwerk::hmi

#include "hmi_bridge/socket/scope_requests.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/nearest_name.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/answer_line.hpp"
#include "hmi_bridge/socket/base64.hpp"
#include "hmi_bridge/socket/unknown_signal.hpp"
#include "runtime/run_memory/run_memory.hpp"

namespace taktwerk::hmi {
namespace {

using runtime::RecordedSignal;
using runtime::SignalRows;
using runtime::ThinnedRead;

constexpr std::array<std::string_view, 11> scope_words{"scope_signals",  "scope_read",  "scope_arm",         "scope_state",
                                                       "scope_disarm",   "recordings",  "recording_signals", "recording_read",
                                                       "recording_part", "replay_keep", "replay_state"};
constexpr std::uint64_t usual_points = 1000;
static_assert(std::endian::native == std::endian::little, "the numbers of an answer are little-endian");

std::string_view word(runtime::SignalKind kind) {
    constexpr std::array<std::string_view, 5> words{"real", "bit", "state", "whole", "word"};
    return words[static_cast<std::size_t>(kind)];
}
std::string_view word(runtime::SignalGroup group) {
    constexpr std::array<std::string_view, 8> words{"axis", "input", "output", "variable", "machine", "bus", "task", "group"};
    return words[static_cast<std::size_t>(group)];
}

/// How many cycles share a pair, so that there are at most `points` of each signal and most_numbers of all.
std::uint64_t cycles_per_pair(std::uint64_t cycles, std::uint64_t points, std::size_t signals) {
    const auto room = ScopeRequests::most_numbers / signals;
    if (cycles <= std::min<std::uint64_t>(points, room)) return 1;
    const auto pairs = std::clamp<std::uint64_t>(points, 1, room / 2);
    return std::max<std::uint64_t>((cycles + pairs - 1) / pairs, 2);
}

Error slow(const std::string& recording) {
    return {"recording.slow", recording, "the disk has not given it yet", "Ask again; look at that disk."};
}

}  // namespace

Error unknown_signal(const SignalRows& rows, const std::string& name) {
    std::vector<std::string> names;
    for (const auto& signal : rows.signals()) names.push_back(signal.name);
    const auto near = nearest_name(std::string_view(name).substr(0, 64), names);
    return {"scope.unknown_signal", "", fmt::format("there is no signal {}", shown(name)),
            near.empty() ? "`scope_signals` lists them." : fmt::format("Did you mean \"{}\"? `scope_signals` lists all.", near)};
}

std::string signals_json(const SignalRows& rows) {
    using Json = nlohmann::ordered_json;
    const auto there = rows.span();
    Json out{{"cycle_ns", count(rows.cycle())}, {"first", there.first}, {"last", there.last}, {"depth", rows.depth()}};
    auto& signals = out["signals"] = Json::array();
    for (const auto& s : rows.signals()) {
        Json one{{"name", s.name}, {"unit", s.unit}, {"kind", word(s.kind)}, {"group", word(s.group)}, {"of", s.of}};
        if (s.kind == runtime::SignalKind::state) {
            auto& states = one["states"] = Json::object();
            for (const auto& [number, text] : s.states) states[std::to_string(number)] = text;
        }
        one["en"] = s.english;
        one["zh"] = s.chinese;
        signals.push_back(std::move(one));
    }
    return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::span<const std::string_view> ScopeRequests::words() { return scope_words; }

bool ScopeRequests::knows(std::string_view cmd) { return std::find(scope_words.begin(), scope_words.end(), cmd) != scope_words.end(); }

void ScopeRequests::say(ConnectionId connection, const std::string& id, std::string_view key, std::string_view value) {
    answers_.push_back({connection, id, fmt::format(R"({{"id":{},"ok":true,"{}":{}}})", id, key, value)});
}

Result<void> ScopeRequests::handle(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields, Instant now) {
    if (cmd.starts_with("recording")) return handle_recordings(connection, id, cmd, fields, now);
    if (cmd.starts_with("replay")) return handle_replay(connection, id, cmd, fields, now);
    const auto* live = machine_.signals();
    if (live == nullptr) return Error{"scope.none", "", "this machine keeps no signals", "Ask a machine that `taktwerk run` runs."};
    if (cmd == "scope_read") {
        const auto asked = read_asked(fields);
        fields.finish();
        if (fields.error()) return *fields.error();
        return begin_read(connection, id, asked, *live, nullptr);
    }
    if (cmd == "scope_arm") {
        if (auto armed = trigger_.arm(connection, fields); !armed) return armed;
        answers_.push_back({connection, id, accepted_line(id)});
        return {};
    }
    fields.finish();
    if (fields.error()) return *fields.error();
    if (cmd == "scope_signals") say(connection, id, "scope", signals_json(*live));
    else if (cmd == "scope_state") say(connection, id, "scope", trigger_.state_json(connection));
    else {
        trigger_.disarm(connection);
        answers_.push_back({connection, id, accepted_line(id)});
    }
    return {};
}

ScopeRequests::Asked ScopeRequests::read_asked(JsonFields& fields) {
    Asked asked;
    asked.signals = fields.texts("signals", most_signals);
    asked.from = fields.maybe_count("from");
    asked.to = fields.maybe_count("to");
    asked.points = fields.maybe_count("points");
    return asked;
}

Result<void> ScopeRequests::handle_recordings(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields,
                                              Instant now) {
    if (cmd == "recordings") {
        fields.finish();
        if (fields.error()) return *fields.error();
        auto list = nlohmann::ordered_json::array();
        if (recorder_ != nullptr)
            for (const auto& kept : recorder_->kept())
                list.push_back({{"name", kept.name},
                                {"alarm", kept.alarm},
                                {"source", kept.source},
                                {"utime", kept.utime},
                                {"from", kept.from},
                                {"to", kept.to},
                                {"alarm_cycle", kept.alarm_cycle},
                                {"bytes", kept.bytes},
                                {"complete", kept.complete}});
        say(connection, id, "recordings", list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        return {};
    }
    Loading loading{connection, id, fields.text("recording", true), {}, now};
    if (cmd == "recording_read") loading.asked = read_asked(fields);
    if (cmd == "recording_part") loading.part = fields.maybe_count("from").value_or(0);
    fields.finish();
    if (fields.error()) return *fields.error();
    if (recorder_ == nullptr)
        return Error{"recording.unknown", "", "this machine keeps no recordings", "Start it with `taktwerk run FILE --recordings FOLDER`."};
    if (auto ok = may_begin(connection); !ok) return ok;
    loading_.push_back(std::move(loading));
    return {};
}

Result<void> ScopeRequests::handle_replay(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields,
                                          Instant now) {
    fields.finish();
    if (fields.error()) return *fields.error();
    if (run_memory_ == nullptr)
        return Error{"replay.not_recorded", "", "this run is not recorded: there is nothing to keep",
                     "Start it with `recording: {replay: true}` in the machine file, and a folder for recordings that can be written; "
                     "below a cycle of 1 ms, and "
                     "where real time is required, with `run --record`."};
    if (cmd == "replay_keep")
        if (auto kept = run_memory_->keep(now); !kept) return std::move(kept).error();
    const auto state = run_memory_->state();
    nlohmann::ordered_json said{{"seconds", to_seconds(state.covered)},
                                {"memory", state.memory},
                                {"disk", state.disk},
                                {"file", state.file},
                                {"waits", state.waits},
                                {"asked_waits", state.asked_waits},
                                {"ended", state.ended ? state.ended->text() : std::string{}}};
    say(connection, id, "replay", said.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return {};
}

Result<void> ScopeRequests::may_begin(ConnectionId connection) const {
    const auto mine = [&](const auto& one) { return one.connection == connection; };
    const auto waiting = std::count_if(reads_.begin(), reads_.end(), mine) + std::count_if(loading_.begin(), loading_.end(), mine);
    if (static_cast<std::size_t>(waiting) < most_reads) return {};
    return Error{"scope.busy", "", fmt::format("{} readings of this client are under way already", most_reads),
                 "Wait for their answers, then ask again."};
}

Result<void> ScopeRequests::begin_read(ConnectionId connection, const std::string& id, const Asked& asked, const SignalRows& rows,
                                       runtime::FlightRecorder::Rows kept) {
    std::vector<const RecordedSignal*> signals;
    for (const auto& name : asked.signals) {
        signals.push_back(rows.find(name));
        if (signals.back() == nullptr) return unknown_signal(rows, name);
    }
    if (auto ok = may_begin(connection); !ok) return ok;
    const auto there = rows.span();
    ThinnedRead::Window window;
    window.to = asked.to.value_or(there.last + 1);
    const auto newest = asked.points.value_or(usual_points);
    const auto before = window.to > newest ? window.to - newest : 0;
    window.from = asked.from.value_or(std::min(std::max(before, there.first), window.to));
    if (window.from > window.to)
        return Error{"scope.window", "", fmt::format("\"from\" ({}) is later than \"to\" ({})", window.from, window.to),
                     "Give the cycles [from, to); without \"to\": until the newest."};
    // What is not there costs nothing, and does not make what is there coarser.
    const auto cycles = std::clamp(window.to, there.first, there.last + 1) - std::clamp(window.from, there.first, there.last + 1);
    window.per = cycles_per_pair(cycles, asked.points.value_or(cycles), signals.size());
    reads_.push_back({connection, id, &rows, std::move(kept), ThinnedRead{rows, std::move(signals), window}, {}, 0});
    return {};
}

bool ScopeRequests::give_part(const Loading& loading, Instant now) {
    const auto part = recorder_->part(loading.recording, *loading.part);
    if (!part && now - loading.since < patience) return false;
    std::optional<Error> error;
    if (!part) error = slow(loading.recording);
    else if (!*part) error = part->error();
    else {
        std::string data;
        append_base64(data, std::as_bytes(std::span{(**part).bytes}));
        answers_.push_back(
            {loading.connection, loading.id,
             fmt::format(R"({{"id":{},"ok":true,"size":{},"from":{},"data":"{}"}})", loading.id, (**part).size, *loading.part, data)});
    }
    if (error) answers_.push_back({loading.connection, loading.id, {}, std::move(error)});
    return true;
}

void ScopeRequests::look_for_loaded(Instant now) {
    for (auto one = loading_.begin(); one != loading_.end();) {
        if (one->part) {
            one = give_part(*one, now) ? loading_.erase(one) : std::next(one);
            continue;
        }
        const auto rows = recorder_->rows(one->recording);
        if (!rows && now - one->since < patience) {
            ++one;
            continue;
        }
        const auto done = std::move(*one);
        one = loading_.erase(one);  // now: it no longer counts as one that waits
        std::optional<Error> error;
        if (!rows) error = slow(done.recording);
        else if (!*rows) error = rows->error();
        else if (done.asked.signals.empty()) say(done.connection, done.id, "scope", signals_json(***rows));
        else if (auto begun = begin_read(done.connection, done.id, done.asked, ***rows, **rows); !begun) error = begun.error();
        if (error) answers_.push_back({done.connection, done.id, {}, std::move(error)});
    }
}

void ScopeRequests::forget(ConnectionId connection) {
    trigger_.disarm(connection);
    std::erase_if(loading_, [&](const Loading& one) { return one.connection == connection; });
    std::erase_if(reads_, [&](const Read& read) { return read.connection == connection; });
    std::erase_if(answers_, [&](const Answer& answer) { return answer.connection == connection; });
}

bool ScopeRequests::go_on(Read& read, std::size_t& cells) {
    auto& r = read.read;
    if (!r.step(cells)) return false;
    for (; read.encoded < r.values().size(); ++read.encoded) {
        if (cells == 0) return false;
        const auto& values = r.values()[read.encoded];
        cells -= std::min(cells, values.size());
        read.data += read.encoded == 0 ? "\"" : ",\"";
        append_base64(read.data, std::as_bytes(std::span{values}));
        read.data += '"';
    }
    const auto there = read.rows->span();
    answers_.push_back(
        {read.connection, read.id,
         fmt::format(R"({{"id":{},"ok":true,"from":{},"to":{},"per":{},"first":{},"last":{},"time_ns":{},"missing":{},"data":[{}]}})",
                     read.id, r.from(), r.to(), r.per(), there.first, there.last, count(r.time()), r.missing(), read.data)});
    return true;
}

void ScopeRequests::step(const runtime::Snapshot* snapshot, Instant now) {
    trigger_.step(snapshot);
    if (recorder_ != nullptr) look_for_loaded(now);
    for (std::size_t cells = cells_per_step; cells > 0 && !reads_.empty();) {
        if (go_on(reads_.front(), cells)) reads_.pop_front();
        else reads_.splice(reads_.end(), reads_, reads_.begin());  // each in turn
    }
}

std::optional<ScopeRequests::Answer> ScopeRequests::next_answer() {
    if (answers_.empty()) return std::nullopt;
    auto answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
}

}  // namespace taktwerk::hmi

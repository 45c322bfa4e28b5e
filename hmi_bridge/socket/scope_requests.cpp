#include "hmi_bridge/socket/scope_requests.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/nearest_name.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/socket/base64.hpp"

namespace taktwerk::hmi {
namespace {

using runtime::RecordedSignal;
using runtime::SignalRows;
using runtime::ThinnedRead;

constexpr std::array<std::string_view, 2> scope_words{"scope_signals", "scope_read"};
constexpr std::uint64_t usual_points = 1000;
static_assert(std::endian::native == std::endian::little, "the numbers of an answer are little-endian");

std::string_view word(runtime::SignalKind kind) {
    constexpr std::array<std::string_view, 5> words{"real", "bit", "state", "whole", "word"};
    return words[static_cast<std::size_t>(kind)];
}
std::string_view word(runtime::SignalGroup group) {
    constexpr std::array<std::string_view, 7> words{"axis", "input", "output", "variable", "machine", "bus", "task"};
    return words[static_cast<std::size_t>(group)];
}

Error unknown_signal(const SignalRows& rows, const std::string& name) {
    std::vector<std::string> names;
    for (const auto& signal : rows.signals()) names.push_back(signal.name);
    const auto near = nearest_name(std::string_view(name).substr(0, 64), names);
    return {"scope.unknown_signal", "", fmt::format("there is no signal {}", shown(name)),
            near.empty() ? "`scope_signals` lists them." : fmt::format("Did you mean \"{}\"? `scope_signals` lists all.", near)};
}

/// How many cycles share a pair, so that there are at most `points` of each signal and most_numbers of all.
std::uint64_t cycles_per_pair(std::uint64_t cycles, std::uint64_t points, std::size_t signals) {
    const auto room = ScopeRequests::most_numbers / signals;
    if (cycles <= std::min<std::uint64_t>(points, room)) return 1;
    const auto pairs = std::clamp<std::uint64_t>(points, 1, room / 2);
    return std::max<std::uint64_t>((cycles + pairs - 1) / pairs, 2);
}

}  // namespace

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

Result<void> ScopeRequests::handle(ConnectionId connection, const std::string& id, std::string_view cmd, JsonFields& fields) {
    if (live_ == nullptr) return Error{"scope.none", "", "this machine keeps no signals", "Ask a machine that `taktwerk run` runs."};
    if (cmd == "scope_read") return begin_read(connection, id, fields, *live_);
    fields.finish();
    if (fields.error()) return *fields.error();
    answers_.push_back({connection, fmt::format(R"({{"id":{},"ok":true,"scope":{}}})", id, signals_json(*live_))});
    return {};
}

Result<void> ScopeRequests::begin_read(ConnectionId connection, const std::string& id, JsonFields& fields, const SignalRows& rows) {
    const auto names = fields.texts("signals", most_signals);
    const auto from = fields.maybe_count("from"), to = fields.maybe_count("to"), points = fields.maybe_count("points");
    fields.finish();
    if (fields.error()) return *fields.error();
    std::vector<const RecordedSignal*> signals;
    for (const auto& name : names) {
        signals.push_back(rows.find(name));
        if (signals.back() == nullptr) return unknown_signal(rows, name);
    }
    const auto waiting = std::count_if(reads_.begin(), reads_.end(), [&](const Read& r) { return r.connection == connection; });
    if (static_cast<std::size_t>(waiting) >= most_reads)
        return Error{"scope.busy", "", fmt::format("{} readings of this client are under way already", most_reads),
                     "Wait for their answers, then ask again."};
    const auto there = rows.span();
    ThinnedRead::Window window;
    window.to = to.value_or(there.last + 1);
    const auto newest = points.value_or(usual_points);
    window.from = from.value_or(window.to > newest + there.first ? window.to - newest : std::min(there.first, window.to));
    if (window.from > window.to)
        return Error{"scope.window", "", fmt::format("\"from\" ({}) is later than \"to\" ({})", window.from, window.to),
                     "Give the cycles [from, to); without \"to\": until the newest."};
    // What is not there costs nothing, and does not make what is there coarser.
    const auto cycles = std::clamp(window.to, there.first, there.last + 1) - std::clamp(window.from, there.first, there.last + 1);
    window.per = cycles_per_pair(cycles, points.value_or(cycles), signals.size());
    reads_.push_back({connection, id, &rows, ThinnedRead{rows, std::move(signals), window}, {}, 0});
    return {};
}

void ScopeRequests::forget(ConnectionId connection) {
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
        {read.connection,
         fmt::format(R"({{"id":{},"ok":true,"from":{},"to":{},"per":{},"first":{},"last":{},"time_ns":{},"missing":{},"data":[{}]}})",
                     read.id, r.from(), r.to(), r.per(), there.first, there.last, count(r.time()), r.missing(), read.data)});
    return true;
}

void ScopeRequests::step() {
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

#include "runtime/scope_file/scope_head.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/json/json_fields.hpp"

namespace taktwerk::runtime {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> kinds{"real", "bit", "state", "whole", "word"};
constexpr std::array<std::string_view, 8> groups{"axis", "input", "output", "variable", "machine", "bus", "task", "group"};
constexpr std::array<std::string_view, 3> codings{"real", "natural", "integer"};

Json signal_json(const RecordedSignal& s) {
    Json out{{"name", s.name},
             {"unit", s.unit},
             {"kind", kinds[static_cast<std::size_t>(s.kind)]},
             {"group", groups[static_cast<std::size_t>(s.group)]},
             {"of", s.of},
             {"en", s.english},
             {"zh", s.chinese},
             {"word", s.cell.word},
             {"first_bit", s.cell.first_bit},
             {"bits", s.cell.bits},
             {"coding", codings[static_cast<std::size_t>(s.cell.coding)]},
             {"per", s.cell.per},
             {"in_trace", s.in_trace}};
    auto& states = out["states"] = Json::array();
    for (const auto& [number, word] : s.states) states.push_back(Json::array({number, word}));
    return out;
}

RecordedSignal signal_of(const Json& json, std::size_t words, std::string& problem) {
    JsonFields fields(json, problem);
    RecordedSignal s;
    s.name = fields.text("name");
    s.unit = fields.text("unit");
    s.kind = static_cast<SignalKind>(fields.word("kind", kinds));
    s.group = static_cast<SignalGroup>(fields.word("group", groups));
    s.of = fields.text("of");
    s.english = fields.text("en");
    s.chinese = fields.text("zh");
    s.cell.word = static_cast<std::uint16_t>(fields.number("word", 0, words - 1));
    s.cell.bits = static_cast<std::uint8_t>(fields.number("bits", 1, 64));
    s.cell.first_bit = static_cast<std::uint8_t>(fields.number("first_bit", 0, 64u - s.cell.bits));
    s.cell.coding = static_cast<SignalCell::Coding>(fields.word("coding", codings));
    s.cell.per = fields.positive("per");
    s.in_trace = fields.flag("in_trace");
    for (const auto& state : fields.list("states")) {
        if (!state.is_array() || state.size() != 2 || !state[0].is_number_integer() || !state[1].is_string()) {
            fields.wrong("states", "a list of numbers and words");
            break;
        }
        s.states.emplace_back(state[0].get<int>(), state[1].get<std::string>());
    }
    return s;
}

}  // namespace

std::string head_json(const ScopeHead& head) {
    Json out{{"machine", head.machine}, {"cycle_ns", head.cycle.count()},
             {"words", head.words},     {"first_cycle", head.first_cycle},
             {"utime", head.utime},     {"cut", head.cut}};
    auto& alarms = out["alarms"] = Json::array();
    for (const auto& a : head.alarms)
        alarms.push_back(
            Json{{"id", a.id}, {"name", a.name}, {"source", a.source}, {"english", a.english}, {"chinese", a.chinese}, {"cycle", a.cycle}});
    auto& signals = out["signals"] = Json::array();
    for (const auto& s : head.signals) signals.push_back(signal_json(s));
    return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<ScopeHead> parse_head(std::string_view text, const std::string& subject) {
    const auto damaged = [&](const std::string& what) {
        return Error{"recording.damaged", subject, "its head cannot be used: " + what, "Take another recording; this file was changed."};
    };
    constexpr int deepest = 6;
    bool too_deep = false;
    const auto json = Json::parse(
        text,
        [&](int depth, Json::parse_event_t, Json&) {
            too_deep = too_deep || depth > deepest;
            return !too_deep;
        },
        false);
    if (too_deep || json.is_discarded()) return damaged("it is no JSON of this kind");
    std::string problem;
    JsonFields fields(json, problem);
    constexpr auto many = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 4);
    ScopeHead head;
    head.machine = fields.text("machine");
    head.cycle = Duration{static_cast<std::int64_t>(fields.number("cycle_ns", 1, many))};
    head.words = fields.number("words", 1, 65535);
    head.first_cycle = fields.number("first_cycle", 1, many);
    head.utime = fields.any_number("utime");
    head.cut = fields.flag("cut");
    for (const auto& alarm : fields.list("alarms")) {
        JsonFields of_alarm(alarm, problem);
        head.alarms.push_back({static_cast<std::uint16_t>(of_alarm.number("id", 0, 65535)), of_alarm.text("name"), of_alarm.text("source"),
                               of_alarm.text("english"), of_alarm.text("chinese"), of_alarm.number("cycle", 0, many)});
        if (!problem.empty()) break;
    }
    for (const auto& signal : fields.list("signals")) {
        head.signals.push_back(signal_of(signal, head.words, problem));
        if (!problem.empty()) break;
    }
    if (!problem.empty()) return damaged(problem);
    return head;
}

}  // namespace taktwerk::runtime

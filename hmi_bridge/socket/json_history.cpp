#include "hmi_bridge/socket/json_history.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/words/words.hpp"

namespace taktwerk::hmi {
namespace {

constexpr std::size_t longest_filter = 256;

nlohmann::ordered_json time_or_null(std::int64_t utime) { return utime != 0 ? nlohmann::ordered_json(utime) : nlohmann::ordered_json(); }

std::string row_text(const AlarmRow& row) {
    return nlohmann::ordered_json{
        {"id", row.id},
        {"utime", row.utime},
        {"cleared_utime", time_or_null(row.cleared_utime)},
        {"acknowledged_utime", time_or_null(row.acknowledged_utime)},
        {"state", word(row.state)},
        {"count", row.count},
        {"alarm", row.alarm},
        {"name", row.name},
        {"source", row.source},
        {"reaction", word(row.reaction)},
        {"english", row.english},
        {"chinese", row.chinese},
        {"cause", row.cause},
        {"remedy", row.remedy},
        {"manual", row.manual},
        {"recording", row.recording},
    }
        .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

Result<HistoryQuery> read_history_query(JsonFields& fields) {
    HistoryQuery query;
    const auto limit = fields.maybe_integer("limit");
    const auto before = fields.maybe_integer("before");
    query.text = fields.text("text", false);
    query.source = fields.text("source", false);
    query.since_utime = fields.maybe_integer("since_utime").value_or(query.since_utime);
    query.until_utime = fields.maybe_integer("until_utime").value_or(query.until_utime);
    fields.integer("utime");
    fields.finish();
    if (fields.error()) return *fields.error();
    const auto bad = [](std::string what, std::string remedy) {
        return Error{"command.bad_value", "", std::move(what), std::move(remedy)};
    };
    if (limit && (*limit < 1 || *limit > most_rows))
        return bad(fmt::format("\"limit\" is {}, and an answer has 1 to {} alarms", *limit, most_rows),
                   "Ask for the next page with the last \"id\" as \"before\".");
    if (before && *before < 1) return bad(fmt::format("\"before\" is {}, and ids begin with 1", *before), "Give the \"id\" of an alarm.");
    if (query.text.size() > longest_filter || query.source.size() > longest_filter)
        return bad(fmt::format("\"text\" and \"source\" have at most {} bytes", longest_filter), "Give a shorter one.");
    query.limit = static_cast<int>(limit.value_or(query.limit));
    query.before = before.value_or(query.before);
    return query;
}

std::string history_line(const std::string& id, const HistoryPage& page) {
    std::string alarms;
    bool more = page.more;
    for (const auto& row : page.rows) {
        auto text = row_text(row);
        if (alarms.size() + text.size() > longest_history_answer) {
            more = true;
            break;
        }
        if (!alarms.empty()) alarms += ',';
        alarms += text;
    }
    return fmt::format(R"({{"id":{},"ok":true,"more":{},"alarms":[{}]}})", id, more, alarms);
}

}  // namespace taktwerk::hmi

// taktwerk alarms: what a running machine complains of, and what it has complained of.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/machine/remote.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/text_table.hpp"
#include "hmi_bridge/wall_clock.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr int rows_of_an_answer = 500;
constexpr int rows_unless_told = 20;

struct AlarmsOptions {
    RemoteOptions remote;
    bool history = false, chinese = false, why = false;
    std::string text, source;
    double since_s = 0;
    int limit = rows_unless_told;
    std::int64_t before = 0;
};

/// 2026-11-25 22:27:26.125, in the time of this computer.
std::string time_text(std::int64_t utime) {
    const std::time_t seconds = utime / 1'000'000;
    std::tm parts{};
    ::localtime_r(&seconds, &parts);
    return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}.{:03}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday, parts.tm_hour,
                       parts.tm_min, parts.tm_sec, utime % 1'000'000 / 1000);
}

/// How it went on, in a word or a time.
std::string course(const Json& row) {
    const auto state = row.value("state", "");
    if (state == "stands") return "stands";
    if (state == "waits") return "waits for reset";
    if (!row.contains("cleared_utime") || !row["cleared_utime"].is_number()) return "unknown";
    const auto held = static_cast<double>(row["cleared_utime"].get<std::int64_t>() - row["utime"].get<std::int64_t>()) / 1e6;
    return held < 60     ? fmt::format("{:.3g} s", held)
           : held < 3600 ? fmt::format("{:.0f} min", held / 60)
                         : fmt::format("{:.1f} h", held / 3600);
}

Tone tone_of(const std::string& reaction) {
    if (reaction == "none") return Tone::faint;
    return reaction == "warn" ? Tone::warning : Tone::bad;
}

void print_why(const Json& row, bool why) {
    if (!why) return;
    for (const char* key : {"cause", "remedy", "manual", "recording"})
        if (const auto text = row.value(key, std::string{}); !text.empty())
            fmt::print("{}\n", "    " + std::string(key) + ": " + wrapped(text, 6, 100));
}

/// One by one rather than as a table where causes stand between them.
void print_rows(const std::vector<Json>& rows, const AlarmsOptions& options) {
    const auto colours = colours_of_output();
    const char* words = options.chinese ? "chinese" : "english";
    const auto table = [] {
        return TextTable{{{"id", TextTable::Column::Side::right},
                          {"raised"},
                          {"held"},
                          {"times", TextTable::Column::Side::right},
                          {"source"},
                          {"alarm"},
                          {"text", {}, 90}}};
    };
    auto all = table();
    for (const auto& row : rows) {
        all.add({std::to_string(row.value("id", std::int64_t{0})), time_text(row.value("utime", std::int64_t{0})), course(row),
                 std::to_string(row.value("count", 1)), row.value("source", ""),
                 Cell{row.value("name", ""), tone_of(row.value("reaction", ""))}, row.value(words, "")});
        if (!options.why) continue;
        fmt::print("{}", all.text(colours));
        print_why(row, true);
        all = table();
    }
    if (!all.empty()) fmt::print("{}", all.text(colours));
}

int show_standing(const AlarmsOptions& options, hmi::Client& client) {
    const auto answer = client.request({{"cmd", "alarms"}});
    if (!answer) return report(options.remote, answer.error());
    if (options.remote.json) {
        fmt::print("{}\n", answer->dump(-1, ' ', false, Json::error_handler_t::replace));
        return exit_ok;
    }
    const auto& alarms = answer->at("alarms");
    if (alarms.empty()) fmt::print("no alarm is listed; `taktwerk alarms --history` shows those that were\n");
    TextTable table{{{"source"}, {"alarm"}, {"times", TextTable::Column::Side::right}, {""}, {"text", {}, 100}}};
    for (const auto& alarm : alarms)
        table.add({alarm.value("source", ""), Cell{alarm.value("name", ""), tone_of(alarm.value("reaction", ""))},
                   std::to_string(alarm.value("count", 1)),
                   alarm.value("standing", false) ? "stands" : "waits for " + alarm.value("reset", std::string("a reset")),
                   alarm.value(options.chinese ? "chinese" : "english", "")});
    if (!table.empty()) fmt::print("{}", table.text(colours_of_output()));
    for (const auto& alarm : alarms) {
        if (!options.why) break;
        fmt::print("{}, {}\n", alarm.value("source", ""), alarm.value("name", ""));
        print_why(alarm, true);
    }
    return exit_ok;
}

int show_history(const AlarmsOptions& options, hmi::Client& client) {
    std::vector<Json> rows;
    bool more = true;
    nlohmann::json request{{"cmd", "alarm_history"}, {"text", options.text}, {"source", options.source}};
    if (options.before > 0) request["before"] = options.before;
    if (options.since_s > 0) request["since_utime"] = hmi::wall_utime() - static_cast<std::int64_t>(options.since_s * 1e6);
    while (more && static_cast<int>(rows.size()) < options.limit) {
        request["limit"] = std::min(options.limit - static_cast<int>(rows.size()), rows_of_an_answer);
        const auto answer = client.request(request, std::chrono::seconds{8});
        if (!answer) return report(options.remote, answer.error());
        const auto& page = answer->at("alarms");
        rows.insert(rows.end(), page.begin(), page.end());
        more = answer->value("more", false) && !page.empty();
        if (more) request["before"] = page.back().at("id");
    }
    if (options.remote.json) {
        fmt::print("{}\n", Json{{"more", more}, {"alarms", rows}}.dump(-1, ' ', false, Json::error_handler_t::replace));
        return exit_ok;
    }
    if (rows.empty())
        fmt::print("the alarm history has none{}\n",
                   request.size() > 4 || !options.text.empty() || !options.source.empty() ? " of these" : "");
    print_rows(rows, options);
    if (more) fmt::print("there are older ones: --before {}, or --limit N\n", rows.back().value("id", std::int64_t{0}));
    return exit_ok;
}

}  // namespace

void add_alarms(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("alarms", "the alarms of a running machine; --history: those that were, over restarts");
    auto options = std::make_shared<AlarmsOptions>();
    add_remote_options(*sub, options->remote);
    sub->add_flag("--history", options->history, "newest first");
    sub->add_option("--text", options->text, "only those in whose name, source or words this stands")->needs("--history");
    sub->add_option("--source", options->source, "only of this: \"axis x\"")->needs("--history");
    add_duration(*sub, "--since", options->since_s, "only those raised within this time")->needs("--history");
    sub->add_option("--before", options->before, "only those with a lower id")->needs("--history")->check(CLI::PositiveNumber);
    sub->add_option("-n,--limit", options->limit, "so many (20)")->needs("--history")->check(CLI::Range(1, 1'000'000));
    sub->add_flag("--why", options->why, "with cause, remedy, section of the manual, recording");
    sub->add_flag("--chinese", options->chinese, "their Chinese words");
    sub->callback([&action, options] {
        action = [options] {
            return with_machine(options->remote, [&](hmi::Client& client) {
                return options->history ? show_history(*options, client) : show_standing(*options, client);
            });
        };
    });
}

}  // namespace taktwerk::apps
